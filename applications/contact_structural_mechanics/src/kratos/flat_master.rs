//! How the reference program lets points move on a master facet in space: the derivative, not the place.
//!
//! The point on the master follows from the slave's by a projection along the normal, so it slides on a tilted master when
//! either side moves along the normal. The reference program leaves that out and finds the change of local coordinates from
//! changes within the slave's plane, by least squares on the master's tangents:
//! δξ = (GᵀG)⁻¹ Gᵀ (P δx + n δl − Σ N²_l P δx²_l), with G the tangents of the master and P = I − n⊗n. Its vertices keep
//! a share of the normal motion of the slave nodes they lie on, as the centre of the slave moves with them: the lift l.

use crate::mortar::{MasterMotion, PairGeometry};
use zelus_core::geometry::{FacetShape, Nodal};
use zelus_core::scalar::Real;
use zelus_core::vector3::{dot, value};

/// The slave's plane, as the reference program lets it carry points of the master.
///
/// The values of D and M are those of the exact motion.
pub struct FlatMaster<T: Real> {
    normal: [f64; 3],
    /// Share of the heights of the slave nodes by which vertices on them are lifted (length).
    lift: Nodal<T>,
}

impl<T: Real> FlatMaster<T> {
    /// Flat master of a pair of facets of first order.
    pub fn new(pair: &PairGeometry<T>) -> Self {
        let (normal, count) = (value(pair.slave_normal), pair.slave.len() as f64);
        let lift = pair.slave.map(|x| {
            let mut height = T::zero();
            (0..3).for_each(|c| height.add_scaled(x[c], normal[c] / count));
            height
        });
        Self { normal, lift }
    }
}

impl<T: Real> MasterMotion<T> for FlatMaster<T> {
    fn lift(&self) -> Option<&[T]> {
        Some(&self.lift)
    }

    fn local(&self, shape: &FacetShape, master: &[[T; 3]], place: [T; 3], x: [T; 3], lift: T) -> [T; 2] {
        let nodes = Nodal::of(master).map(value);
        let at = shape.closest_point(&nodes, value(place), shape.centre);
        let weights = shape.values(at);
        let tangent = shape.tangents(&nodes, at);
        let mut motion: [T; 3] = std::array::from_fn(|c| {
            let mut sum = x[c];
            (0..master.len()).for_each(|l| sum.add_scaled(master[l][c], -weights[l]));
            sum - sum.value()
        });
        let mut height = T::zero();
        (0..3).for_each(|c| height.add_scaled(motion[c], self.normal[c]));
        let out_of_plane = lift - lift.value() - height;
        (0..3).for_each(|c| motion[c].add_scaled(out_of_plane, self.normal[c]));

        let metric = [dot(tangent[0], tangent[0]), dot(tangent[0], tangent[1]), dot(tangent[1], tangent[1])];
        let determinant = metric[0] * metric[2] - metric[1] * metric[1];
        let along = [0, 1].map(|a| {
            let mut sum = T::zero();
            (0..3).for_each(|c| sum.add_scaled(motion[c], tangent[a][c]));
            sum
        });
        let mut local = at.map(T::constant);
        local[0].add_scaled(along[0], metric[2] / determinant);
        local[0].add_scaled(along[1], -metric[1] / determinant);
        local[1].add_scaled(along[1], metric[0] / determinant);
        local[1].add_scaled(along[0], -metric[1] / determinant);
        local
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mortar::{
        Active, Choices, LANES, Operators, PairPoints, SegmentationSettings, find_operators, operators,
    };
    use zelus_core::geometry::QUADRILATERAL_4;

    /// A unit square below one shifted aside whose far side is higher by `rise`.
    fn pair(rise: f64) -> PairGeometry<f64> {
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let place = |[x, y]: [f64; 2]| [x + 0.3, y + 0.2, x * rise];
        PairGeometry {
            slave_shape: &QUADRILATERAL_4,
            master_shape: &QUADRILATERAL_4,
            slave: [a, b, c, d].map(|[x, y]| [x, y, 0.0]).into(),
            master: [d, c, b, a].map(place).into(),
            nodal_normals: [[0.0, 0.0, 1.0]; 4].into(),
            slave_normal: [0.0, 0.0, 1.0],
            master_normal: zelus_core::vector3::normalised([rise, 0.0, -1.0]),
            exact: None,
            choices: Choices::default(),
        }
    }

    /// The largest differences of D, M and of their derivatives, exact against those on a flat master.
    fn differences(rise: f64) -> [f64; 2] {
        let (plain, settings) = (pair(rise), SegmentationSettings::default());
        let mut most = [0.0; 2];
        for first in (0..plain.unknowns()).step_by(LANES) {
            let seeded = plain.seeded_from(first);
            let exact = operators(&seeded, &settings).cells().expect("they overlap");
            let mut flat = Operators::<Active>::zero(&QUADRILATERAL_4, &QUADRILATERAL_4);
            let points = PairPoints::new(&plain, &settings);
            let found = find_operators(&seeded, &settings, &points, &FlatMaster::new(&seeded), &mut flat);
            found.cells().expect("they overlap");
            let rows = exact.m.iter().zip(flat.m.iter()).chain(exact.d.iter().zip(flat.d.iter()));
            let entries = rows.flat_map(|(a, b)| a.iter().copied().zip(b.iter().copied()).collect::<Vec<_>>());
            most = entries.fold(most, |[value, gradient], (a, b)| {
                let apart = a.gradient.iter().zip(&b.gradient).map(|(a, b)| (a - b).abs()).fold(gradient, f64::max);
                [value.max((a.value - b.value).abs()), apart]
            });
        }
        most
    }

    #[test]
    fn only_derivatives_on_tilted_masters_differ() {
        let [values, gradients] = differences(0.0);
        assert!(values < 1e-14 && gradients < 1e-12, "{values:e} {gradients:e}");
        let [values, gradients] = differences(0.4);
        assert!(values < 1e-14 && gradients > 1e-2, "{values:e} {gradients:e}");
    }
}
