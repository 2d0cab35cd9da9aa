//! Boxes along facets, by which a search sorts out pairs whose centres are within reach.

use zelus_core::vector3::{cross, dot, norm, sub};

/// Margin of a box in largest nodal sizes of the interface.
pub const MARGIN: f64 = 0.1;

/// A box along the diagonal of the axis-aligned box of a facet, as the reference program builds it.
///
/// In space it holds the facet. In the plane it lies along the *rising* diagonal whichever way the facet goes, so that the
/// box of a steep falling facet does not hold it and pairs that overlap may be sorted out.
#[derive(Debug, Clone, Copy)]
pub struct OrientedBox {
    centre: [f64; 3],
    axes: [[f64; 3]; 3],
    half: [f64; 3],
}

impl OrientedBox {
    /// The box of two points (in the plane) or more (in space), `margin` wider on every side.
    pub fn of(points: &[[f64; 3]], margin: f64) -> Self {
        let low: [f64; 3] = std::array::from_fn(|c| points.iter().map(|p| p[c]).fold(f64::INFINITY, f64::min));
        let high: [f64; 3] = std::array::from_fn(|c| points.iter().map(|p| p[c]).fold(f64::NEG_INFINITY, f64::max));
        let diagonal = sub(high, low);
        let length = norm(diagonal).max(f64::MIN_POSITIVE);
        let along = diagonal.map(|c| c / length);
        if points.len() == 2 {
            let centre = std::array::from_fn(|c| 0.5 * (low[c] + high[c]));
            let axes = [along, [along[1], -along[0], 0.0], [0.0, 0.0, 1.0]];
            return Self { centre, axes, half: [0.5 * length + margin, margin, margin] };
        }
        let centre = std::array::from_fn(|c| points.iter().map(|p| p[c]).sum::<f64>() / points.len() as f64);
        let across =
            if along[0].abs() > along[2].abs() { [along[1], -along[0], 0.0] } else { [0.0, along[2], -along[1]] };
        let across = across.map(|c| c / norm(across).max(f64::MIN_POSITIVE));
        let axes = [along, across, cross(along, across)];
        let half =
            axes.map(|axis| points.iter().map(|&p| dot(sub(p, centre), axis).abs()).fold(0.0, f64::max) + margin);
        Self { centre, axes, half }
    }

    /// Whether no axis of either box, nor of a pair of theirs, separates them.
    pub fn meets(&self, other: &Self) -> bool {
        let apart = sub(other.centre, self.centre);
        let separates = |axis: [f64; 3]| {
            let reach = |b: &Self| (0..3).map(|i| dot(b.axes[i], axis).abs() * b.half[i]).sum::<f64>();
            dot(apart, axis).abs() > reach(self) + reach(other)
        };
        let crossed = self.axes.iter().flat_map(|&a| other.axes.iter().map(move |&b| cross(a, b)));
        !self.axes.iter().chain(&other.axes).copied().chain(crossed).any(separates)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_meet_across_a_gap_of_two_margins() {
        let lower = OrientedBox::of(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], 0.1);
        let at = |y: f64| OrientedBox::of(&[[1.0, y, 0.0], [0.0, y, 0.0]], 0.1);
        assert!(lower.meets(&at(0.199)) && !lower.meets(&at(0.201)));
        let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
        let lower = OrientedBox::of(&square(0.0), 0.1);
        assert!(
            lower.meets(&OrientedBox::of(&square(0.199), 0.1)) && !lower.meets(&OrientedBox::of(&square(0.201), 0.1))
        );
    }

    #[test]
    fn a_falling_facet_of_the_plane_is_not_in_its_box() {
        let falling = [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]];
        let near_its_end = OrientedBox::of(&[[0.0, 1.05, 0.0], [0.1, 1.05, 0.0]], 0.1);
        assert!(!OrientedBox::of(&falling, 0.1).meets(&near_its_end));
        let rising = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
        let near_its_end = OrientedBox::of(&[[0.9, 1.05, 0.0], [1.0, 1.05, 0.0]], 0.1);
        assert!(OrientedBox::of(&rising, 0.1).meets(&near_its_end));
    }
}
