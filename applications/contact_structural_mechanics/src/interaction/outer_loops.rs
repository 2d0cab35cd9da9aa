//! The loops around Newton's iteration: the checks of a converged state, and their changes before the next iteration.

use serde::{Deserialize, Serialize};
use zelus_core::assembly::nodal_vectors;
use zelus_core::entities::OuterLoop;
use zelus_core::model::ModelPart;
use zelus_core::vector3::norm;
use zelus_core::{Result, StateMapper};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::contact_state::ContactState;
use crate::active_set::{ActiveSetUpdate, Rules};
use crate::adaptation::{FrictionRamp, PenaltyRamp, Uzawa};
use crate::pairs::Multiplier;
use crate::safeguards::{
    ContactWork, PenetrationCheck, STIFFER, StepSearch, coarse_impact, overlap_at_start, pierced, too_deep,
};
use crate::slave_nodes::SlaveStates;

/// The loops of a step.
#[derive(Clone, Default, Serialize, Deserialize)]
pub(super) struct OuterLoops {
    /// Searches within the step.
    pub step_search: StepSearch,
    /// Updates of multipliers.
    pub uzawa: Uzawa,
    /// How much of the penalty acts, where it is all there is.
    penalty_ramp: PenaltyRamp,
    /// Whether friction waits for contact.
    friction_ramp: FrictionRamp,
    /// Weighted gaps of all slave nodes at the start of the step.
    #[serde(skip)]
    start_gaps: Vec<f64>,
    /// Share of the energy of motion that the last attempt at the step made, where that was too much.
    impact_error: f64,
    /// Work of contact on bodies in motion.
    pub work: ContactWork,
    /// Check for penetration outside of pairs.
    #[serde(skip)]
    penetration_check: PenetrationCheck,
}

impl OuterLoops {
    /// Whether it can be that of as many nodes.
    ///
    /// # Errors
    /// Others.
    pub(super) fn check(&self, nodes: usize) -> Result<()> {
        self.work.check(nodes)
    }

    /// See [`State::remap`](zelus_core::State::remap).
    pub(super) fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.work.remap(mapper);
    }

    /// Step start, before contact is searched.
    pub(super) fn begin_step(&mut self, part: &mut ModelPart, contact: &mut ContactState) {
        self.step_search.begin_step();
        self.uzawa = Uzawa::default();
        if contact.setup.ramps_penalty() {
            self.penalty_ramp.begin_step(&part.info, &mut contact.states);
        }
        if contact.setup.ramps_friction() {
            self.friction_ramp.begin_step(part, contact.setup.settings.friction.law);
        }
    }

    /// Step start, once gaps are known.
    pub(super) fn keep_start(&mut self, states: &SlaveStates) {
        self.start_gaps = states.all().map(|slave| states[slave].kinematics.weighted_gap).collect();
    }

    /// The checks of a converged state, in the order in which one needs the other.
    ///
    /// # Errors
    /// Errors of making blocks; contact that a deck asks for and that is not there.
    pub(super) fn judge(
        &mut self,
        part: &mut ModelPart,
        contact: &mut ContactState,
        set: &mut ActiveSetUpdate,
    ) -> Result<OuterLoop> {
        let (formulation, scale_factor) = (contact.setup.settings.formulation, contact.setup.parameters.scale_factor);
        let solver = contact.setup.settings.solver;
        if formulation.updated {
            let outer =
                self.uzawa.update(&part.slave_nodes, &mut contact.states, scale_factor, contact.setup.settings.uzawa);
            if outer != OuterLoop::Done {
                return Ok(outer);
            }
        }
        if contact.setup.ramps_penalty()
            && self.penalty_ramp.after_convergence(&part.info, &mut contact.states) == OuterLoop::Continue
        {
            return Ok(OuterLoop::Continue);
        }
        let settled = set.settle(part, &mut contact.states, &contact.setup);
        if settled != OuterLoop::Done {
            return Ok(settled);
        }
        contact.extend_open_roles(part)?;
        let (pairs, searched) = ((&contact.pairing, &contact.states), contact.is_searched());
        let (missed, outer) =
            self.step_search.in_converged_state(part, pairs, &contact.setup, searched, &mut contact.messages)?;
        if !missed.is_empty() {
            set.forget_sets();
            contact.take_in(part, missed)?;
            set.update(part, &mut contact.states, &contact.setup, &mut contact.messages);
            set.find_tangents(part, &mut contact.states, &contact.setup);
        }
        if outer != OuterLoop::Done {
            return Ok(outer);
        }
        let friction = &contact.setup.settings.friction;
        let (law, tolerances) = ((friction.law, friction.ellipse), contact.setup.tolerances);
        if self.friction_ramp.after_convergence(part, &mut contact.states, law, tolerances) == OuterLoop::Continue {
            set.forget_sets();
            set.find_tangents(part, &mut contact.states, &contact.setup);
            return Ok(OuterLoop::Continue);
        }
        // With Nitsche's method a penetrating point is always active, so this check is skipped.
        if !contact.setup.by_points()
            && let Some(why) = Rules::of(&contact.setup).passed_through(part, &contact.states)
        {
            return Ok(OuterLoop::Failed(why));
        }
        let least = contact.setup.tolerances.length;
        if let Some(why) = too_deep(part, &contact.states, solver.largest_penetration, least, STIFFER) {
            return Ok(OuterLoop::Failed(why));
        }
        if let Some(why) =
            self.penetration_check
                .why(part, &contact.pairing.interfaces, solver.largest_penetration, |at| contact.in_contact(at))
        {
            return Ok(OuterLoop::Failed(why));
        }
        // For bodies in motion the energy error of contact decides instead.
        if !contact.setup.parameters.dynamic
            && solver.largest_penetration > 0.0
            && let Some(why) = pierced(part, &contact.pairing, &contact.states)
        {
            return Ok(OuterLoop::Failed(why));
        }
        if solver.ensures_contact && contact.states.count_active() == 0 {
            return Err(zelus_core::Error::NotConverged(
                "no node is in contact, and \"ensure_contact\" asks for one".to_owned(),
            ));
        }
        self.friction_ramp.solve();
        if contact.setup.parameters.dynamic {
            self.work.of_step(part, |out| nodal_vectors(part, &contact.pairing.as_entities(), &DISPLACEMENT, out))?;
            if let Some(why) = self.work.too_much(part, &solver) {
                let start = overlap_at_start(part, &contact.states, &self.start_gaps, least);
                return Ok(OuterLoop::Failed([Some(why), start].into_iter().flatten().collect()));
            }
        }
        let pressure = |slave, level| match formulation.multiplier {
            Multiplier::None | Multiplier::Body => 0.0,
            multiplier => {
                scale_factor * norm(multiplier.value_at(&part.slave_nodes, contact.states.owner(slave), level))
            }
        };
        let start = (&*self.start_gaps, &mut self.impact_error);
        Ok(coarse_impact(part, &contact.states, pressure, solver.impact_tolerance, start))
    }

    /// The step is accepted.
    pub(super) fn accept(&mut self, part: &ModelPart, contact: &mut ContactState) {
        self.impact_error = 0.0;
        if contact.setup.parameters.dynamic {
            let formulation = contact.setup.settings.formulation;
            let stores = formulation.regularised || matches!(formulation.multiplier, Multiplier::None);
            let conserves = !stores && !formulation.frictional();
            contact.messages.extend(self.work.accept(part, conserves));
        }
        self.friction_ramp.accept();
    }

    /// The step is tried again.
    pub(super) fn retry(&mut self) {
        self.penalty_ramp.retry();
        self.friction_ramp.retry();
    }

    /// Whether the next attempt of a step that fails once more goes another way.
    pub(super) fn has_alternative(&self, contact: &ContactState) -> bool {
        self.penetration_check.depends_on_step || contact.setup.ramps_friction() && self.friction_ramp.comes_next()
    }
}
