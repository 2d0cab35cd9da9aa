//! Where an instance of a part is.

use zelus_core::diagnostics::Result;
use zelus_core::vector3::{add, cross, dot, norm, scale, sub};

use super::cards::Card;

/// A translation, then a rotation about an axis.
#[derive(Debug, Clone, Default)]
pub(super) struct Placement {
    translation: [f64; 3],
    /// A point of the axis, its direction of length 1, the angle in radians.
    rotation: Option<([f64; 3], [f64; 3], f64)>,
}

impl Placement {
    /// Placement in the data of `*INSTANCE`.
    pub(super) fn of(card: &Card) -> Result<Self> {
        let mut out = Self::default();
        if let Some(row) = card.rows.first() {
            let given = card.numbers(row)?;
            out.translation.iter_mut().zip(given).for_each(|(to, from)| *to = from);
        }
        if let Some(row) = card.rows.get(1) {
            let given = card.numbers(row)?;
            let Ok([ax, ay, az, bx, by, bz, angle]) = <[f64; 7]>::try_from(given) else {
                return Err(card.wrong("a rotation is two points and an angle: seven numbers"));
            };
            let along = sub([bx, by, bz], [ax, ay, az]);
            if norm(along) == 0.0 {
                return Err(card.wrong("the two points of the axis are the same"));
            }
            out.rotation = Some(([ax, ay, az], scale(along, 1.0 / norm(along)), angle.to_radians()));
        }
        Ok(out)
    }

    /// Where a point of the part is in the assembly.
    pub(super) fn place(&self, point: [f64; 3]) -> [f64; 3] {
        let moved = add(point, self.translation);
        let Some((start, axis, angle)) = self.rotation else { return moved };
        // Rodrigues' formula
        let arm = sub(moved, start);
        let along = scale(axis, dot(axis, arm) * (1.0 - angle.cos()));
        add(start, add(add(scale(arm, angle.cos()), scale(cross(axis, arm), angle.sin())), along))
    }
}
