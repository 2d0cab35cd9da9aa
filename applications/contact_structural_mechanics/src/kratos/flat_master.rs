//! How the reference program lets points move on a master facet in space: the derivative, not the place.
//!
//! The point on the master follows from the slave's by a projection along the normal, so it slides on a tilted master when
//! either side moves along the normal. The reference program leaves that out and finds the change of local coordinates from
//! changes within the slave's plane, by least squares on the master's tangents:
//! δξ = (GᵀG)⁻¹ Gᵀ (P δx + n δl − Σ N²_l P δx²_l), with G the tangents of the master and P = I − n⊗n. Its vertices keep
//! a share of the normal motion of the slave nodes they lie on, as the centre of the slave moves with them: the lift l.

use crate::mortar::{MasterMotion, Operators, Overlap, PairGeometry, SegmentationSettings, operators_by};
use zelus_core::geometry::FacetShape;
use zelus_core::scalar::Real;
use zelus_core::vector3::{dot, value};

/// D and M with this derivative; their values are those of [`operators`](crate::mortar::operators()).
pub fn operators_on_flat_master<T: Real, S: FacetShape, M: FacetShape>(
    pair: &PairGeometry<T, S, M>,
    settings: &SegmentationSettings,
) -> Overlap<Operators<T, S, M>> {
    operators_by(pair, settings, &FlatMaster::new(pair))
}

/// The slave's plane, as the reference program lets it carry points of the master.
struct FlatMaster<T: Real, S: FacetShape> {
    normal: [f64; 3],
    /// Share of the heights of the slave nodes by which vertices on them are lifted (length).
    lift: S::Nodal<T>,
}

impl<T: Real, S: FacetShape> FlatMaster<T, S> {
    /// That of a pair.
    fn new<M: FacetShape>(pair: &PairGeometry<T, S, M>) -> Self {
        let normal = value(pair.slave_normal);
        let lift = S::map(&pair.slave, |x| {
            let mut height = T::zero();
            (0..3).for_each(|c| height.add_scaled(x[c], normal[c] / S::NODES as f64));
            height
        });
        Self { normal, lift }
    }
}

impl<T: Real, S: FacetShape> MasterMotion<T, S> for FlatMaster<T, S> {
    fn lift(&self) -> Option<&S::Nodal<T>> {
        Some(&self.lift)
    }

    /// Local coordinates on `master` of its point at `place`, moving as the slave's point `x` lifted by `lift`.
    fn local<M: FacetShape>(&self, master: &M::Nodal<[T; 3]>, place: [T; 3], x: [T; 3], lift: T) -> [T; 2] {
        let nodes = M::map(master, value);
        let at = M::closest_point(&nodes, value(place), M::CENTRE);
        let weights = M::values(at);
        let tangent = M::tangents(&nodes, at);
        let mut motion: [T; 3] = std::array::from_fn(|c| {
            let mut sum = x[c];
            (0..M::NODES).for_each(|l| sum.add_scaled(master[l][c], -weights[l]));
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
    use crate::mortar::{Choices, operators};
    use zelus_core::geometry::Quadrilateral4;

    /// A unit square below one shifted aside whose far side is higher by `rise`.
    fn pair(rise: f64) -> PairGeometry<f64, Quadrilateral4, Quadrilateral4> {
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let place = |[x, y]: [f64; 2]| [x + 0.3, y + 0.2, x * rise];
        PairGeometry {
            slave: [a, b, c, d].map(|[x, y]| [x, y, 0.0]),
            master: [d, c, b, a].map(place),
            nodal_normals: [[0.0, 0.0, 1.0]; 4],
            slave_normal: [0.0, 0.0, 1.0],
            master_normal: zelus_core::vector3::normalised([rise, 0.0, -1.0]),
            choices: Choices::default(),
        }
    }

    /// The largest differences of D, M and of their derivatives, exact against those on a flat master.
    fn differences(rise: f64) -> [f64; 2] {
        let (seeded, settings) = (pair(rise).seeded::<24>(), SegmentationSettings::default());
        let both = [operators(&seeded, &settings), operators_on_flat_master(&seeded, &settings)];
        let [Overlap::Cells(exact), Overlap::Cells(flat)] = both else { panic!("they overlap") };
        let entries = exact.m.iter().flatten().zip(flat.m.iter().flatten());
        let entries = entries.chain(exact.d.iter().flatten().zip(flat.d.iter().flatten()));
        entries.fold([0.0; 2], |[value, gradient], (a, b)| {
            let apart = a.gradient.iter().zip(&b.gradient).map(|(a, b)| (a - b).abs()).fold(gradient, f64::max);
            [value.max((a.value - b.value).abs()), apart]
        })
    }

    #[test]
    fn only_derivatives_on_tilted_masters_differ() {
        let [values, gradients] = differences(0.0);
        assert!(values < 1e-14 && gradients < 1e-12, "{values:e} {gradients:e}");
        let [values, gradients] = differences(0.4);
        assert!(values < 1e-14 && gradients > 1e-2, "{values:e} {gradients:e}");
    }
}
