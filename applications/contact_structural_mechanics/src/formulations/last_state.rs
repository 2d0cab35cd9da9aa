//! A pair as it was in the last accepted state, and what has happened since.

use super::{Kinematics, PairHistory, SlaveNode};
use crate::mortar::{Operators, PairGeometry, Turn, tangential, turned_slip};
use zelus_core::scalar::Real;
use zelus_core::vector3::{add, constant, scale};

/// A pair as it was in the last accepted state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LastState<const NS: usize, const NM: usize> {
    /// Positions of the slave nodes.
    pub slave: [[f64; 3]; NS],
    /// Positions of the master nodes.
    pub master: [[f64; 3]; NM],
}

impl<const NS: usize, const NM: usize> PairHistory<NS, NM> for LastState<NS, NM> {
    fn of(_: Operators<f64, NS, NM>, last: &PairGeometry<f64, NS, NM>) -> Self {
        Self { slave: last.slave, master: last.master }
    }
}

impl<const NS: usize, const NM: usize> LastState<NS, NM> {
    /// Weighted slips s of a pair since its last accepted state.
    pub fn slip<T: Real>(&self, pair: &Kinematics<T, NS, NM>) -> [[T; 3]; NS] {
        turned_slip(&pair.operators, (&pair.slave, &self.slave), (&pair.master, &self.master), &pair.normals)
    }

    /// Tractions P R t° that the slave nodes of a pair have from its last accepted state.
    pub fn carried<T: Real>(&self, pair: &Kinematics<T, NS, NM>, nodes: &[SlaveNode; NS]) -> [[T; 3]; NS] {
        let turn = Turn::of_facet(&pair.slave, &self.slave);
        std::array::from_fn(|j| tangential(turn.apply(constant(nodes[j].carried)), pair.normals[j]))
    }

    /// A times the elastic trial tractions P R t° + κ ε s/A of the slave nodes of a pair, with κ ε their tangential penalties.
    pub fn weighted_trial<T: Real>(
        &self,
        pair: &Kinematics<T, NS, NM>,
        nodes: &[SlaveNode; NS],
        tangent_factor: f64,
    ) -> [[T; 3]; NS] {
        let (carried, slip) = (self.carried(pair, nodes), self.slip(pair));
        std::array::from_fn(|j| {
            let elastic = scale(slip[j], T::constant(tangent_factor * nodes[j].penalty));
            add(scale(carried[j], pair.area(j)), elastic)
        })
    }
}
