//! Contact by constraints on bodies in motion: nodes whose mass others carry, and the work of the constraints.
//!
//! The mass of a slave node that a constraint stops within a step would be stopped with it, as in the other formulations
//! (docs/theory/time_integration.md, "Impacts"); so both sides are massless here too, and the same two checks judge a step.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{MasslessNodes, OuterLoop};
use zelus_core::model::ModelPart;
use zelus_core::{Result, StateMapper};

use super::mpc_friction::MpcFriction;
use super::mpc_results::find_forces;
use super::relations::Relations;
use crate::interface::{Interface, SlaveIndex, check_nodes};
use crate::safeguards::{ContactWork, coarse_impact, near_nodes};
use crate::slave_nodes::SlaveStates;
use crate::solver::ContactSolverSettings;

/// State of motion with inertia.
#[derive(Clone, Default, Serialize, Deserialize)]
pub(super) struct MpcImpact {
    /// Whether steps have inertia.
    #[serde(skip)]
    dynamic: bool,
    /// Nodes close to contact, which are massless in this step.
    near: Vec<u32>,
    /// Weighted gap and pressure of each slave node at the start of the step.
    start: Vec<[f64; 2]>,
    /// Share of the energy of motion that the last attempt at the step made, where that was too much.
    impact_error: f64,
    /// Work of contact on bodies in motion.
    work: ContactWork,
}

impl MpcImpact {
    /// Whether it can be that of as many nodes.
    ///
    /// # Errors
    /// Others.
    pub(super) fn check(&self, nodes: usize) -> Result<()> {
        check_nodes(nodes, self.near.iter().copied())?;
        self.work.check(nodes)
    }

    /// See [`State::remap`](zelus_core::State::remap).
    pub(super) fn remap(&mut self, mapper: &mut dyn StateMapper) {
        mapper.nodes(&mut self.near);
        self.work.remap(mapper);
    }

    /// A step begins: keeps the gaps there are, and the pressures of the last accepted step.
    pub(super) fn keep_start(&mut self, states: &SlaveStates) {
        let of = |slave| [states[slave].kinematics.weighted_gap, states[slave].law.pressure.abs()];
        self.start = states.all().map(of).collect();
    }

    /// A step with inertia begins: finds the nodes close to contact.
    pub(super) fn begin_dynamic_step(
        &mut self,
        part: &ModelPart,
        interfaces: &[Interface],
        states: &SlaveStates,
        relations: &Relations,
    ) {
        self.dynamic = true;
        let masters = |slaves: &BTreeSet<u32>| {
            let relations = slaves.iter().filter_map(|node| relations.nodes.get(node));
            relations.flat_map(|relation| relation.weights.iter().map(|(master, _)| *master)).collect()
        };
        self.near = near_nodes(part, &all_nodes(interfaces), states, masters, &self.near);
    }

    /// The nodes that are massless in this step.
    pub(super) fn massless_nodes(&self, interfaces: &[Interface]) -> MasslessNodes {
        MasslessNodes { surface: all_nodes(interfaces), near: self.near.clone() }
    }

    /// Whether the energy that contact makes lets the converged step be accepted; collective.
    ///
    /// # Errors
    /// None of its own.
    pub(super) fn judge(
        &mut self,
        part: &ModelPart,
        states: &mut SlaveStates,
        relations: &Relations,
        friction: &MpcFriction,
        solver: &ContactSolverSettings,
    ) -> Result<OuterLoop> {
        if !self.dynamic {
            return Ok(OuterLoop::Done);
        }
        self.work.of_step(part, |out| Ok(find_forces(part, states, &relations.nodes, friction, out)))?;
        if let Some(why) = self.work.too_much(part, solver) {
            return Ok(OuterLoop::Failed(why));
        }
        let (gaps, pressures): (Vec<f64>, Vec<f64>) = self.start.iter().map(|&[gap, pressure]| (gap, pressure)).unzip();
        let pressure = |slave: SlaveIndex, level: usize| match level {
            0 => states[slave].law.pressure.abs(),
            _ => pressures.get(slave.place()).copied().unwrap_or(0.0),
        };
        Ok(coarse_impact(part, states, pressure, solver.impact_tolerance, (&gaps, &mut self.impact_error)))
    }

    /// The step is accepted; `conserves` says that contact cannot take energy.
    pub(super) fn accept(&mut self, part: &ModelPart, conserves: bool) -> Option<Diagnostic> {
        self.impact_error = 0.0;
        self.dynamic.then(|| self.work.accept(part, conserves)).flatten()
    }
}

/// Nodes of all interfaces, ascending.
fn all_nodes(interfaces: &[Interface]) -> Vec<u32> {
    let nodes: BTreeSet<u32> = interfaces.iter().flat_map(|interface| interface.nodes.iter().copied()).collect();
    nodes.into_iter().collect()
}
