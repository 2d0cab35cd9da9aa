//! The work that contact does on the bodies in motion, ½ Σ (f_n + f_{n+1}) · (u_{n+1} − u_n) over the nodes of its pairs.
//!
//! Contact hands work from one body to the other, springs give back the work they took, and friction only takes. A sum above
//! zero is energy from nothing, as where a corner lies in between the nodes of a coarser slave side.

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::{Diagnostic, coordinates, unfit};
use zelus_core::model::ModelPart;
use zelus_core::strategies::ENERGY_OF_MOTION;
use zelus_core::{Result, StateMapper};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use crate::slave_nodes::SlaveStates;
use crate::solver::ContactSolverSettings;

/// Share of the energy of motion that contact may have made, or lost without friction, before a warning says so.
const WORTH_A_WARNING: f64 = 0.02;

const REMEDY: &str = "make the finer of the two sides the slave, or refine the slave; shorten the step; \
     keep \"contact_stabilisation\" and \"impact_energy_tolerance\" of \"contact_settings\" at their defaults";

/// Continues a message on energy from nothing with the node in contact whose mean gap was deepest below zero, by more than `least`, as
/// its step began; `starts` has the weighted gaps then.
pub(crate) fn overlap_at_start(part: &ModelPart, states: &SlaveStates, starts: &[f64], least: f64) -> Option<String> {
    let active = states.iter().zip(starts).filter(|((_, state), _)| state.law.active && state.kinematics.area > 0.0);
    let gaps = active.map(|((slave, state), start)| (states.mesh_node(slave), start / state.kinematics.area));
    let (node, gap) = gaps.filter(|(_, gap)| *gap < -least).min_by(|a, b| a.1.total_cmp(&b.1))?;
    let place = coordinates(part.nodes.initial[node as usize]);
    Some(format!(
        ". The mean gap of node {} at {place} was {gap:.3e} as the step began, which a curved side beside coarse slave facets has where it just touches: begin the bodies {:.3e} farther apart",
        part.nodes.ids[node as usize], -gap
    ))
}

/// Sums over the present step.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
struct WorkSums {
    /// Work on all nodes.
    work: f64,
    /// Work that one body has handed to another: half the sum of absolute values.
    handed_on: f64,
}

/// Forces of contact on the nodes of a model part, and the work that they have done since the run began.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct ContactWork {
    /// Forces at the end of the last accepted step (3 a node); empty before the first one.
    before: Vec<f64>,
    /// Forces at the end of the present one.
    #[serde(skip)]
    now: Vec<f64>,
    step: WorkSums,
    /// Sums over all accepted steps.
    sum: WorkSums,
    warned: bool,
}

impl ContactWork {
    /// Whether it can be that of as many nodes.
    ///
    /// # Errors
    /// Others.
    pub(crate) fn check(&self, nodes: usize) -> Result<()> {
        let fits = [0, 3 * nodes].contains(&self.before.len());
        if fits { Ok(()) } else { Err(unfit("the forces of contact that it remembers are of other nodes")) }
    }

    /// See [`State::remap`](zelus_core::State::remap).
    pub(crate) fn remap(&mut self, mapper: &mut dyn StateMapper) {
        mapper.by_node(&mut self.before);
    }

    /// Adds up the work of the present step, at whose end these forces act (3 a node); `forces` may fill the vector it is given.
    /// Collective.
    ///
    /// # Errors
    /// Errors of `forces`.
    pub(crate) fn of_step(
        &mut self,
        part: &ModelPart,
        forces: impl FnOnce(Vec<f64>) -> Result<Vec<f64>>,
    ) -> Result<()> {
        self.now = forces(std::mem::take(&mut self.now))?;
        self.before.resize(self.now.len(), 0.0);
        let mut sums = [0.0; 2];
        let displacements = [0, 1].map(|level| part.nodes.history.values(&DISPLACEMENT, level));
        for node in (0..part.nodes.len()).filter(|&node| part.owns_node(node)) {
            let rows = 3 * node..3 * node + 3;
            let of = |i: usize| (self.now[i] + self.before[i]) * (displacements[0][i] - displacements[1][i]);
            let work = 0.5 * rows.map(of).sum::<f64>();
            sums[0] += work;
            sums[1] += 0.5 * work.abs();
        }
        part.ranks.sum(&mut sums);
        self.step = WorkSums { work: sums[0], handed_on: sums[1] };
        Ok(())
    }

    /// Energy that contact has made with the present step, as a share of the energy there was or was handed on; below zero it took some.
    fn gain(&self, part: &ModelPart) -> f64 {
        let gain = self.sum.work + self.step.work;
        let energy = part.info.value_or(ENERGY_OF_MOTION, 0.0) - gain.max(0.0);
        let scale = energy.max(self.sum.handed_on + self.step.handed_on);
        if scale > 0.0 { gain / scale } else { 0.0 }
    }

    /// Why the present step cannot be accepted, when contact has made too much energy by its end; where nodes of contact keep
    /// their mass, as a deck may ask, every step can.
    pub(crate) fn too_much(&self, part: &ModelPart, solver: &ContactSolverSettings) -> Option<String> {
        let (gain, most) = (self.gain(part), solver.largest_energy_gain);
        let fact = || format!("contact has made {:.1} % of the energy of motion from nothing: {REMEDY}", 100.0 * gain);
        (most > 0.0 && gain > most && !solver.keeps_mass).then(fact)
    }

    /// Work of contact since the run began, the present step included.
    pub(crate) fn done(&self) -> f64 {
        self.sum.work + self.step.work
    }

    /// The step is accepted: a warning when contact has made energy or, where it can only `conserve` it, lost some; once.
    pub(crate) fn accept(&mut self, part: &ModelPart, conserves: bool) -> Option<Diagnostic> {
        let gain = self.gain(part);
        std::mem::swap(&mut self.before, &mut self.now);
        let WorkSums { work, handed_on } = std::mem::take(&mut self.step);
        self.sum = WorkSums { work: self.sum.work + work, handed_on: self.sum.handed_on + handed_on };
        let change = if conserves { gain.abs() } else { gain };
        if change <= WORTH_A_WARNING || std::mem::replace(&mut self.warned, true) {
            return None;
        }
        let (time, percent) = (part.info.time, 100.0 * gain.abs());
        let how = if gain > 0.0 { "made" } else { "lost" };
        let fact = format!(
            "at time {time}, contact has {how} {percent:.1} % of the energy of motion, where it can only hand it on"
        );
        Some(Diagnostic::warning("contact-energy", fact).remedy(REMEDY))
    }
}
