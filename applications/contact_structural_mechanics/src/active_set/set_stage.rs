//! The active set within a step: decided in every iteration, held where it cycles, settled in converged states.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{Outer, SetChange};
use zelus_core::model::ModelPart;

use super::cycling::{CycleGuard, SetOutcome};
use super::decision::Rules;
use super::forced_points;
use super::sliding::find_tangents;
use crate::interface::SlaveIndex;
use crate::settings::Setup;
use crate::slave_nodes::SlaveStates;

/// History of the active set within a step.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct SetStage {
    cycles: CycleGuard,
    /// Nodes that were pushed along their motion and stick since.
    #[serde(skip)]
    released: BTreeSet<SlaveIndex>,
    /// How often nodes that always slide have turned back.
    #[serde(skip)]
    reversals: BTreeMap<SlaveIndex, usize>,
}

impl SetStage {
    /// A step begins.
    pub(crate) fn begin_step(&mut self) {
        self.forget_sets();
        self.released.clear();
        self.reversals.clear();
    }

    /// The equations are others from now on: sets that come back are no cycle.
    pub(crate) fn forget_sets(&mut self) {
        self.cycles.begin_step();
    }

    /// Lets the rules decide in the present state; tells of cycles among the `messages`.
    pub(crate) fn update(
        &mut self,
        part: &mut ModelPart,
        states: &mut SlaveStates,
        setup: &Setup,
        messages: &mut Vec<Diagnostic>,
    ) -> SetChange {
        let rules = Rules::of(setup);
        let (mut decisions, before) = rules.decide(part, states, &mut self.released);
        if !setup.by_points() {
            self.cycles.restrict(&mut decisions, &before);
            messages.extend(self.cycles.keep(&decisions, &ids(part, states), part.info.step));
        } else if setup.settings.formulation.frictional() {
            // With decisions at integration points each evaluation of forces decides: nodes only report it.
            forced_points::hold_turned(states, &mut decisions, &before, setup.resolution);
        }
        rules.apply(part, states, &decisions, &before)
    }

    /// Finds pressures and tractions in the present state, and holds the set.
    pub(crate) fn find_tractions(&self, part: &ModelPart, states: &mut SlaveStates, setup: &Setup) {
        let rules = Rules::of(setup);
        let (decisions, _) = rules.decide(part, states, &mut self.released.clone());
        rules.press(part, states, &decisions);
    }

    /// Lets the rules decide in a converged state, where the set was held.
    pub(crate) fn settle(&mut self, part: &mut ModelPart, states: &mut SlaveStates, setup: &Setup) -> Outer {
        if !self.cycles.holds() {
            return Outer::Done;
        }
        let rules = Rules::of(setup);
        let (mut decisions, before) = rules.decide(part, states, &mut self.released);
        let largest = decisions.iter().map(|(_, decision)| -decision.pressure).fold(0.0, f64::max);
        let settled = self.cycles.settle(&mut decisions, &before, largest, &ids(part, states));
        match settled {
            SetOutcome::Done => Outer::Done,
            SetOutcome::Failed(why) => Outer::Failed(why),
            SetOutcome::Change => {
                rules.apply(part, states, &decisions, &before);
                self.find_tangents(part, states, setup);
                Outer::Again
            }
        }
    }

    /// Finds the directions of sliding, where nodes have them.
    pub(crate) fn find_tangents(&mut self, part: &ModelPart, states: &mut SlaveStates, setup: &Setup) {
        if setup.settings.formulation.frictional() && !setup.by_points() {
            let keeps = setup.settings.friction.keeps_direction;
            find_tangents(part, states, Rules::of(setup), keeps, &mut self.reversals);
        }
    }
}

/// Ids of the mesh nodes of slave nodes.
fn ids<'a>(part: &'a ModelPart, states: &'a SlaveStates) -> impl Fn(SlaveIndex) -> usize + use<'a> {
    |slave| part.nodes.ids[states.mesh_node(slave) as usize]
}
