//! A pair as it was in the last accepted state, and what has happened since.

use super::{Kinematics, SlaveNode};
use crate::mortar::{PairGeometry, Turn, tangential, turned_slip};
use zelus_core::scalar::Real;
use zelus_core::vector3::constant;

/// A pair as it was in the last accepted state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LastState<const NS: usize, const NM: usize> {
    /// Positions of the slave nodes.
    pub slave: [[f64; 3]; NS],
    /// Positions of the master nodes.
    pub master: [[f64; 3]; NM],
}

impl<const NS: usize, const NM: usize> LastState<NS, NM> {
    /// From the pair at the positions of that state.
    pub fn new(last: &PairGeometry<f64, NS, NM>) -> Self {
        Self { slave: last.slave, master: last.master }
    }

    /// Weighted slips s of a pair since its last accepted state.
    pub fn slip<T: Real>(&self, pair: &Kinematics<T, NS, NM>) -> [[T; 3]; NS] {
        turned_slip(&pair.operators, (&pair.slave, &self.slave), (&pair.master, &self.master), &pair.normals)
    }

    /// Tractions P R t° that the slave nodes of a pair have from its last accepted state.
    pub fn carried<T: Real>(&self, pair: &Kinematics<T, NS, NM>, nodes: &[SlaveNode; NS]) -> [[T; 3]; NS] {
        let turn = Turn::of_facet(&pair.slave, &self.slave);
        std::array::from_fn(|j| tangential(turn.apply(constant(nodes[j].carried)), pair.normals[j]))
    }
}
