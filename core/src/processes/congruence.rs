//! Rotation about an axis and shift that carry one part onto another.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

use crate::vector3::{add, sub};

/// Component of a rotation matrix that is round-off.
const ROUND_OFF: f64 = 1e-15;

/// x ↦ R (x − c) + c + d.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Congruence {
    /// R, row by row.
    pub rotation: [[f64; 3]; 3],
    /// Axis of the rotation, of any length; it does not matter without one.
    pub axis: [f64; 3],
    centre: [f64; 3],
    shift: [f64; 3],
}

impl Congruence {
    /// Rotation by an angle (radian) about an axis through a centre, by the right-hand rule, then a shift. The axis may have any length
    /// above zero; without rotation it does not matter.
    pub fn new(centre: [f64; 3], axis: [f64; 3], angle: f64, shift: [f64; 3]) -> Self {
        let turn = Unit::try_new(Vector3::from(axis), 0.0).map(|axis| Rotation3::from_axis_angle(&axis, angle));
        let matrix = turn.filter(|_| angle != 0.0).map_or_else(Matrix3::identity, Rotation3::into_inner);
        let entry = |i, j| if matrix[(i, j)].abs() > ROUND_OFF { matrix[(i, j)] } else { 0.0 };
        Self { rotation: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))), axis, centre, shift }
    }

    /// Its inverse.
    pub fn inverse(&self) -> Self {
        let rotation = [0, 1, 2].map(|i| [0, 1, 2].map(|j| self.rotation[j][i]));
        Self { rotation, axis: self.axis, centre: add(self.centre, self.shift), shift: self.shift.map(|d| -d) }
    }

    /// Image of a point.
    pub fn image(&self, point: [f64; 3]) -> [f64; 3] {
        let r = sub(point, self.centre);
        let turned = self.rotation.map(|row| row[0] * r[0] + row[1] * r[1] + row[2] * r[2]);
        add(add(turned, self.centre), self.shift)
    }

    /// Whether it turns.
    pub fn turns(&self) -> bool {
        self.rotation != [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector3::norm;

    #[test]
    fn the_inverse_carries_images_back() {
        let way = Congruence::new([1.0, 2.0, 3.0], [0.0, 0.0, 2.0], std::f64::consts::FRAC_PI_2, [0.0, 0.0, 5.0]);
        let image = way.image([2.0, 2.0, 3.0]);
        assert!(norm(sub(image, [1.0, 3.0, 8.0])) < 1e-14, "{image:?}");
        let oblique = Congruence::new([0.5, -1.0, 2.0], [1.0, 2.0, -0.5], 0.7, [0.1, 0.2, 0.3]);
        let point = [3.0, -4.0, 5.0];
        assert!(norm(sub(oblique.inverse().image(oblique.image(point)), point)) < 1e-14);
        assert!(oblique.turns() && !Congruence::new([0.0; 3], [0.0; 3], 0.0, [1.0, 0.0, 0.0]).turns());
    }
}
