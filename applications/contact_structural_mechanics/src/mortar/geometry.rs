//! The two facets of a contact pair as they stand, and the normals that go with them.

use super::choices::Choices;
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::{constant, value};

/// Coordinates and normals of a slave facet with `NS` nodes and a master facet with `NM` nodes.
/// Current configuration; unit normals point out of their bodies. Planar problems use two-node facets and z = 0.
#[derive(Debug, Clone, Copy)]
pub struct PairGeometry<T, const NS: usize, const NM: usize> {
    /// Slave nodes.
    pub slave: [[T; 3]; NS],
    /// Master nodes.
    pub master: [[T; 3]; NM],
    /// Averaged unit normals at the slave nodes.
    pub nodal_normals: [[T; 3]; NS],
    /// Unit normal of the plane on which the overlap is cut; it may lag behind the slave facet.
    pub slave_normal: [T; 3],
    /// Unit normal of the plane of the master onto which points are projected; it may lag behind the master facet.
    pub master_normal: [T; 3],
    /// Choices of the integration that the pair has frozen.
    pub choices: Choices,
}

/// Number of space dimensions of a pair whose slave has `ns` nodes.
#[inline]
pub const fn dimension(ns: usize) -> usize {
    if ns == 2 { 2 } else { 3 }
}

impl<const NS: usize, const NM: usize> PairGeometry<f64, NS, NM> {
    /// Number of displacement unknowns: those of the master nodes, then those of the slave nodes.
    pub const UNKNOWNS: usize = dimension(NS) * (NS + NM);

    /// The same pair with its coordinates as the first variables in the order master, slave, node by node; normals are constant.
    /// Replace a normal by one with a gradient to include its variation.
    #[inline]
    pub fn seeded<const NU: usize>(&self) -> PairGeometry<Dual<NU>, NS, NM> {
        const { assert!(NU >= Self::UNKNOWNS, "one variable per displacement component of the pair") };
        let dim = dimension(NS);
        let seed = |x: [f64; 3], first: usize| {
            std::array::from_fn(|c| if c < dim { Dual::variable(x[c], first + c) } else { Dual::constant(x[c]) })
        };
        PairGeometry {
            slave: std::array::from_fn(|n| seed(self.slave[n], dim * (NM + n))),
            master: std::array::from_fn(|n| seed(self.master[n], dim * n)),
            ..self.as_constants()
        }
    }

    /// The same pair in another scalar, without derivatives.
    #[inline]
    pub fn as_constants<T: Real>(&self) -> PairGeometry<T, NS, NM> {
        PairGeometry {
            slave: self.slave.map(constant),
            master: self.master.map(constant),
            nodal_normals: self.nodal_normals.map(constant),
            slave_normal: constant(self.slave_normal),
            master_normal: constant(self.master_normal),
            choices: self.choices,
        }
    }
}

impl<T: Real, const NS: usize, const NM: usize> PairGeometry<T, NS, NM> {
    /// The same pair without derivatives.
    #[inline]
    pub fn values(&self) -> PairGeometry<f64, NS, NM> {
        PairGeometry {
            slave: self.slave.map(value),
            master: self.master.map(value),
            nodal_normals: self.nodal_normals.map(value),
            slave_normal: value(self.slave_normal),
            master_normal: value(self.master_normal),
            choices: self.choices,
        }
    }
}
