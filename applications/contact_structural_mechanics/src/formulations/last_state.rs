//! A pair as it was in the last accepted state, and what has happened since.

use super::{Kinematics, PairHistory, SlaveNode};
use crate::mortar::{Operators, PairGeometry, Turn, tangential, turned_slip};
use zelus_core::geometry::FacetShape;
use zelus_core::scalar::Real;
use zelus_core::vector3::{add, constant, scale};

/// A pair as it was in the last accepted state.
#[derive(Debug, Clone, Copy)]
pub struct LastState<S: FacetShape, M: FacetShape> {
    /// Positions of the slave nodes.
    pub slave: S::Nodal<[f64; 3]>,
    /// Positions of the master nodes.
    pub master: M::Nodal<[f64; 3]>,
}

impl<S: FacetShape, M: FacetShape> PairHistory<S, M> for LastState<S, M> {
    fn of(_: Operators<f64, S, M>, last: &PairGeometry<f64, S, M>) -> Self {
        Self { slave: last.slave, master: last.master }
    }
}

impl<S: FacetShape, M: FacetShape> LastState<S, M> {
    /// Weighted slips s of a pair since its last accepted state.
    pub fn slip<T: Real>(&self, pair: &Kinematics<T, S, M>) -> S::Nodal<[T; 3]> {
        turned_slip(&pair.operators, (&pair.slave, &self.slave), (&pair.master, &self.master), &pair.normals)
    }

    /// Tractions P R t° that the slave nodes of a pair have from its last accepted state.
    pub fn carried<T: Real>(&self, pair: &Kinematics<T, S, M>, nodes: &S::Nodal<SlaveNode>) -> S::Nodal<[T; 3]> {
        let turn = Turn::of_facet::<S>(&pair.slave, &self.slave);
        S::nodal(|j| tangential(turn.apply(constant(nodes[j].carried)), pair.normals[j]))
    }

    /// A times the elastic trial tractions P R t° + κ ε s/A of the slave nodes of a pair, with κ ε their tangential penalties.
    pub fn weighted_trial<T: Real>(
        &self,
        pair: &Kinematics<T, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        tangent_factor: f64,
    ) -> S::Nodal<[T; 3]> {
        let (carried, slip) = (self.carried(pair, nodes), self.slip(pair));
        S::nodal(|j| {
            let elastic = scale(slip[j], T::constant(tangent_factor * nodes[j].penalty));
            add(scale(carried[j], pair.area(j)), elastic)
        })
    }
}
