//! How a facet has turned since an earlier state.

use zelus_core::scalar::Real;
use zelus_core::vector3::{cross, dot, normalised, sub};

/// Rotation R that takes the frame of a facet, its first edge and its normal, from an earlier state to the present one.
#[derive(Debug, Clone, Copy)]
pub struct Turn<T> {
    now: [[T; 3]; 3],
    before: [[f64; 3]; 3],
}

impl<T: Real> Turn<T> {
    /// From the nodes of a facet now and before.
    pub fn of_facet<const N: usize>(now: &[[T; 3]; N], before: &[[f64; 3]; N]) -> Self {
        Self { now: frame(now), before: frame(before) }
    }

    /// R v for a vector of the earlier state.
    pub fn apply(&self, vector: [T; 3]) -> [T; 3] {
        let mut turned = [T::zero(); 3];
        for (now, before) in self.now.iter().zip(&self.before) {
            let along = vector[0] * before[0] + vector[1] * before[1] + vector[2] * before[2];
            (0..3).for_each(|c| turned[c].add_product(now[c], along));
        }
        turned
    }
}

/// Right-handed unit vectors: along the first edge, across it, normal to the facet; of a line those in its plane.
fn frame<T: Real, const N: usize>(x: &[[T; 3]; N]) -> [[T; 3]; 3] {
    let edge = normalised(sub(x[1], x[0]));
    let normal = if N == 2 {
        [T::zero(), T::zero(), T::one()]
    } else {
        // The diagonals of a quadrilateral, two edges of a triangle.
        let normal = normalised(cross(sub(x[2], x[0]), sub(x[N - 1], x[1])));
        normalised(sub(normal, edge.map(|e| e * dot(normal, edge))))
    };
    [edge, cross(normal, edge), normal]
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::vector3::norm;

    #[test]
    fn a_facet_takes_vectors_along() {
        let (s, c) = 0.7_f64.sin_cos();
        // About the axis (0, 0.6, 0.8) by Rodrigues' formula, and moved away.
        let axis = [0.0, 0.6, 0.8];
        let turn = |v: [f64; 3]| -> [f64; 3] {
            let across = cross(axis, v);
            std::array::from_fn(|i| v[i] * c + across[i] * s + axis[i] * dot(axis, v) * (1.0 - c))
        };
        let move_on = |v: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| turn(v)[i] + [3.0, -1.0, 2.0][i]) };
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.2, 0.1], [0.3, 0.9, -0.2]];
        let quadrilateral = [[0.0, 0.0, 0.0], [1.0, 0.2, 0.1], [1.1, 1.3, 0.3], [0.3, 0.9, -0.2]];
        let vector = [0.3, -0.5, 0.7];
        let by_triangle = Turn::of_facet(&triangle.map(move_on), &triangle).apply(vector);
        let by_quadrilateral = Turn::of_facet(&quadrilateral.map(move_on), &quadrilateral).apply(vector);
        for found in [by_triangle, by_quadrilateral] {
            assert!(norm(sub(found, turn(vector))) < 1e-14, "{found:?}");
        }
        let line = Turn::of_facet(&[[0.0; 3], [c, s, 0.0]], &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
        assert!(norm(sub(line.apply([0.0, 2.0, 0.0]), [-2.0 * s, 2.0 * c, 0.0])) < 1e-15);
    }
}
