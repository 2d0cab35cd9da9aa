//! The rotation of a facet since an earlier state.

use zelus_core::geometry::FacetShape;
use zelus_core::scalar::Real;
use zelus_core::vector3::{constant, cross, dot, normalised, sub};

/// Rotation R that takes a facet from an earlier state to the present one: the shortest that takes its normal along, and one
/// about the normal by the mean angle of its nodes about its centre, whichever of them is the first.
#[derive(Debug, Clone, Copy)]
pub struct FacetRotation<T> {
    normal: [T; 3],
    before: [f64; 3],
    cosine: T,
    sine: T,
}

impl<T: Real> FacetRotation<T> {
    /// From the nodes of a facet now and before.
    pub fn of_facet(shape: &FacetShape, now: &[[T; 3]], before: &[[f64; 3]]) -> Self {
        let mut rotation =
            Self { normal: normal(shape, now), before: normal(shape, before), cosine: T::one(), sine: T::zero() };
        let (centre, centre_before) = (centre(now), centre(before));
        let (mut along, mut across) = (T::zero(), T::zero());
        for (x, x_before) in now.iter().zip(before) {
            let arm = rotation.tilt(constant(sub(*x_before, centre_before)));
            let arm_now = sub(*x, centre);
            along += dot(arm, arm_now) - dot(rotation.normal, arm) * dot(rotation.normal, arm_now);
            across += dot(rotation.normal, cross(arm, arm_now));
        }
        [rotation.cosine, rotation.sine, _] = normalised([along, across, T::zero()]);
        rotation
    }

    /// R v for a vector of the earlier state.
    pub fn apply(&self, vector: [T; 3]) -> [T; 3] {
        let tilted = self.tilt(vector);
        let across = cross(self.normal, tilted);
        let height = dot(self.normal, tilted) * (T::one() - self.cosine);
        std::array::from_fn(|c| tilted[c] * self.cosine + across[c] * self.sine + self.normal[c] * height)
    }

    /// The shortest rotation from the earlier normal a to the present one b: v − (a + b)·v / (1 + a·b) (a + b) + 2 (a·v) b.
    fn tilt(&self, vector: [T; 3]) -> [T; 3] {
        let before: [T; 3] = constant(self.before);
        let sum: [T; 3] = std::array::from_fn(|c| before[c] + self.normal[c]);
        let share = dot(sum, vector) / (T::one() + dot(before, self.normal));
        let height = dot(before, vector) * 2.0;
        std::array::from_fn(|c| vector[c] - sum[c] * share + self.normal[c] * height)
    }
}

fn centre<T: Real>(x: &[[T; 3]]) -> [T; 3] {
    let mut sum = [T::zero(); 3];
    x.iter().for_each(|v| (0..3).for_each(|c| sum[c] += v[c] * (1.0 / x.len() as f64)));
    sum
}

/// Unit normal: by the diagonals of a quadrilateral, two edges of a triangle; of a line that of its plane.
fn normal<T: Real>(shape: &FacetShape, x: &[[T; 3]]) -> [T; 3] {
    if shape.space == 2 {
        [T::zero(), T::zero(), T::one()]
    } else {
        normalised(cross(sub(x[2], x[0]), sub(x[shape.corners - 1], x[1])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::geometry::{LINE_2, QUADRILATERAL_4, TRIANGLE_3};
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
        let by_triangle = FacetRotation::of_facet(&TRIANGLE_3, &triangle.map(move_on), &triangle).apply(vector);
        let by_quadrilateral =
            FacetRotation::of_facet(&QUADRILATERAL_4, &quadrilateral.map(move_on), &quadrilateral).apply(vector);
        for found in [by_triangle, by_quadrilateral] {
            assert!(norm(sub(found, turn(vector))) < 1e-14, "{found:?}");
        }
        let line = FacetRotation::of_facet(&LINE_2, &[[0.0; 3], [c, s, 0.0]], &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
        assert!(norm(sub(line.apply([0.0, 2.0, 0.0]), [-2.0 * s, 2.0 * c, 0.0])) < 1e-15);
    }
}
