//! The two facets of a contact pair as they stand, and the normals that go with them.

use super::choices::Choices;
use zelus_core::geometry::{ExactFacet, FacetShape, Nodal};
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::{constant, value};

/// Number of variables that a pair is differentiated by at once.
///
/// One number serves all shapes: mortar code is compiled for plain numbers and for [`Active`] ones, and pairs with more
/// variables are evaluated in several passes.
pub const LANES: usize = 12;

/// The scalar of derivatives.
pub type Active = Dual<LANES>;

/// Coordinates and normals of a slave facet and a master facet.
/// Current configuration; unit normals point out of their bodies. Planar problems have lines and z = 0.
#[derive(Debug, Clone, Copy)]
pub struct PairGeometry<T: Real> {
    /// Shape of the slave facet.
    pub slave_shape: &'static FacetShape,
    /// Shape of the master facet.
    pub master_shape: &'static FacetShape,
    /// Slave nodes.
    pub slave: Nodal<[T; 3]>,
    /// Master nodes.
    pub master: Nodal<[T; 3]>,
    /// Averaged unit normals at the slave nodes.
    pub nodal_normals: Nodal<[T; 3]>,
    /// Unit normal of the plane on which the overlap is cut; it may lag behind the slave facet.
    pub slave_normal: [T; 3],
    /// Unit normal of the plane of the master onto which points are projected; it may lag behind the master facet.
    pub master_normal: [T; 3],
    /// The surface that the master facet stands for, where it is given exactly; its shape then has an apex.
    pub exact: Option<ExactFacet>,
    /// Choices of the integration that the pair has frozen.
    pub choices: Choices,
}

/// Variable `number` where it is among those from `first` on, else a constant.
#[inline]
fn variable_from(first: usize, number: usize, value: f64) -> Active {
    match number.checked_sub(first) {
        Some(lane) if lane < LANES => Dual::variable(value, lane),
        _ => Dual::constant(value),
    }
}

/// The first `dim` components of a vector as the variables from `number` on, of which those from `first` on are differentiated by.
#[inline]
pub fn variables_from(first: usize, number: usize, vector: [f64; 3], dim: usize) -> [Active; 3] {
    std::array::from_fn(
        |c| {
            if c < dim { variable_from(first, number + c, vector[c]) } else { Dual::constant(vector[c]) }
        },
    )
}

impl PairGeometry<f64> {
    /// The same pair with [`LANES`] of its coordinates as variables, from the one numbered `first` on: those of master nodes,
    /// then those of slave nodes, node by node. Normals are constant; replace one by a normal with a gradient to include its
    /// variation.
    pub fn seeded_from(&self, first: usize) -> PairGeometry<Active> {
        let (dim, masters) = (self.space(), self.master.len());
        let mut out = self.as_constants();
        for (n, place) in out.master.iter_mut().chain(out.slave.iter_mut()).enumerate() {
            let values = if n < masters { self.master[n] } else { self.slave[n - masters] };
            *place = variables_from(first, dim * n, values, dim);
        }
        out
    }

    /// The same pair with [`LANES`] components of its nodal normals as variables, from the one numbered `first` on, node by node.
    pub fn seeded_by_normals(&self, first: usize) -> PairGeometry<Active> {
        let dim = self.space();
        let mut out = self.as_constants();
        for (j, (normal, values)) in out.nodal_normals.iter_mut().zip(self.nodal_normals.iter()).enumerate() {
            *normal = variables_from(first, dim * j, *values, dim);
        }
        out
    }

    /// The same pair in another scalar, without derivatives.
    #[inline]
    pub fn as_constants<T: Real>(&self) -> PairGeometry<T> {
        let mut out = PairGeometry {
            slave_shape: self.slave_shape,
            master_shape: self.master_shape,
            slave: Nodal::empty(),
            master: Nodal::empty(),
            nodal_normals: Nodal::empty(),
            slave_normal: constant(self.slave_normal),
            master_normal: constant(self.master_normal),
            exact: self.exact,
            choices: self.choices,
        };
        // In place: with derivatives they are too large to be moved about.
        out.slave.refill(self.slave.len(), |n| constant(self.slave[n]));
        out.master.refill(self.master.len(), |n| constant(self.master[n]));
        out.nodal_normals.refill(self.nodal_normals.len(), |n| constant(self.nodal_normals[n]));
        out
    }
}

impl<T: Real> PairGeometry<T> {
    /// Dimensions of space, 2 or 3.
    #[inline]
    pub fn space(&self) -> usize {
        self.slave_shape.space
    }

    /// Master nodes on the facet: without an apex.
    #[inline]
    pub fn nodes_of_master(&self) -> &[[T; 3]] {
        &self.master[..self.master.len() - usize::from(self.master_shape.apex)]
    }

    /// Whether a facet is of second order.
    #[inline]
    pub fn is_curved(&self) -> bool {
        self.slave_shape.curved || self.master_shape.curved
    }

    /// Number of displacement unknowns: those of the master nodes, then those of the slave nodes.
    #[inline]
    pub fn unknowns(&self) -> usize {
        self.space() * (self.slave.len() + self.master.len())
    }

    /// Number of components of nodal normals.
    #[inline]
    pub fn normal_components(&self) -> usize {
        self.space() * self.slave.len()
    }

    /// The same pair without derivatives.
    #[inline]
    pub fn values(&self) -> PairGeometry<f64> {
        PairGeometry {
            slave_shape: self.slave_shape,
            master_shape: self.master_shape,
            slave: self.slave.map(value),
            master: self.master.map(value),
            nodal_normals: self.nodal_normals.map(value),
            slave_normal: value(self.slave_normal),
            master_normal: value(self.master_normal),
            exact: self.exact,
            choices: self.choices,
        }
    }
}
