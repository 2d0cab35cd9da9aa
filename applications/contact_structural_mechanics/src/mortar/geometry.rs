//! The two facets of a contact pair as they stand, and the normals that go with them.

use super::choices::Choices;
use zelus_core::geometry::FacetShape;
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::{constant, value};

/// Coordinates and normals of a slave facet and a master facet.
/// Current configuration; unit normals point out of their bodies. Planar problems have lines and z = 0.
#[derive(Debug, Clone, Copy)]
pub struct PairGeometry<T: Real, S: FacetShape, M: FacetShape> {
    /// Slave nodes.
    pub slave: S::Nodal<[T; 3]>,
    /// Master nodes.
    pub master: M::Nodal<[T; 3]>,
    /// Averaged unit normals at the slave nodes.
    pub nodal_normals: S::Nodal<[T; 3]>,
    /// Unit normal of the plane on which the overlap is cut; it may lag behind the slave facet.
    pub slave_normal: [T; 3],
    /// Unit normal of the plane of the master onto which points are projected; it may lag behind the master facet.
    pub master_normal: [T; 3],
    /// Choices of the integration that the pair has frozen.
    pub choices: Choices,
}

/// Variable `number` where it is among those from `first` on, else a constant.
#[inline]
fn variable_from<const LANES: usize>(first: usize, number: usize, value: f64) -> Dual<LANES> {
    match number.checked_sub(first) {
        Some(lane) if lane < LANES => Dual::variable(value, lane),
        _ => Dual::constant(value),
    }
}

/// The first `dim` components of a vector as the variables from `number` on, of which those from `first` on are differentiated by.
#[inline]
pub fn variables_from<const LANES: usize>(
    first: usize,
    number: usize,
    vector: [f64; 3],
    dim: usize,
) -> [Dual<LANES>; 3] {
    std::array::from_fn(
        |c| {
            if c < dim { variable_from(first, number + c, vector[c]) } else { Dual::constant(vector[c]) }
        },
    )
}

impl<S: FacetShape, M: FacetShape> PairGeometry<f64, S, M> {
    /// Number of displacement unknowns: those of the master nodes, then those of the slave nodes.
    pub const UNKNOWNS: usize = S::SPACE * (S::NODES + M::NODES);

    /// Number of components of nodal normals.
    pub const NORMALS: usize = S::SPACE * S::NODES;

    /// The same pair with its coordinates as variables in the order master, slave, node by node; normals are constant.
    /// Replace a normal by one with a gradient to include its variation.
    #[inline]
    pub fn seeded<const NU: usize>(&self) -> PairGeometry<Dual<NU>, S, M> {
        const { assert!(NU >= Self::UNKNOWNS, "one variable per displacement component of the pair") };
        self.seeded_from(0)
    }

    /// The same with `LANES` of the variables only, from the one numbered `first` on.
    #[inline]
    pub fn seeded_from<const LANES: usize>(&self, first: usize) -> PairGeometry<Dual<LANES>, S, M> {
        let dim = S::SPACE;
        PairGeometry {
            slave: S::nodal(|n| variables_from(first, dim * (M::NODES + n), self.slave[n], dim)),
            master: M::nodal(|n| variables_from(first, dim * n, self.master[n], dim)),
            ..self.as_constants()
        }
    }

    /// The same pair with `LANES` components of its nodal normals as variables, from the one numbered `first` on, node by node.
    #[inline]
    pub fn seeded_by_normals<const LANES: usize>(&self, first: usize) -> PairGeometry<Dual<LANES>, S, M> {
        let dim = S::SPACE;
        let nodal_normals = S::nodal(|j| variables_from(first, dim * j, self.nodal_normals[j], dim));
        PairGeometry { nodal_normals, ..self.as_constants() }
    }

    /// The same pair in another scalar, without derivatives.
    #[inline]
    pub fn as_constants<T: Real>(&self) -> PairGeometry<T, S, M> {
        PairGeometry {
            slave: S::map(&self.slave, constant),
            master: M::map(&self.master, constant),
            nodal_normals: S::map(&self.nodal_normals, constant),
            slave_normal: constant(self.slave_normal),
            master_normal: constant(self.master_normal),
            choices: self.choices,
        }
    }
}

impl<T: Real, S: FacetShape, M: FacetShape> PairGeometry<T, S, M> {
    /// The same pair without derivatives.
    #[inline]
    pub fn values(&self) -> PairGeometry<f64, S, M> {
        PairGeometry {
            slave: S::map(&self.slave, value),
            master: M::map(&self.master, value),
            nodal_normals: S::map(&self.nodal_normals, value),
            slave_normal: value(self.slave_normal),
            master_normal: value(self.master_normal),
            choices: self.choices,
        }
    }
}
