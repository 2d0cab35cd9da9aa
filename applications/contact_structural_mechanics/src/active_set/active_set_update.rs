//! The active set within a step: decided in every iteration, frozen where it cycles, settled in converged states.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{ComplementaryCondition, OuterLoop, Responses, SetChange};
use zelus_core::model::ModelPart;

use super::cycling::{CycleGuard, SetOutcome};
use super::decision::Rules;
use super::forced_points;
use super::joint_decision;
use super::sliding::find_tangents;
use crate::interface::SlaveIndex;
use crate::settings::Setup;
use crate::slave_nodes::SlaveStates;

/// Joint decisions of a step at most: in motions that are not small each is a linear step towards the set.
const MOST_JOINT: usize = 10;

/// History of the active set within a step.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct ActiveSetUpdate {
    cycles: CycleGuard,
    /// Nodes that were pushed along their motion and stick since.
    #[serde(skip)]
    released: BTreeSet<SlaveIndex>,
    /// How often nodes that always slide have turned back.
    #[serde(skip)]
    reversals: BTreeMap<SlaveIndex, usize>,
    /// Joint decisions of the step.
    #[serde(skip)]
    joint: JointDecisions,
}

/// Joint decisions of a step: how many, and whether there are no more.
#[derive(Debug, Clone, Copy, Default)]
struct JointDecisions {
    made: usize,
    ended: bool,
}

impl ActiveSetUpdate {
    /// A step begins.
    pub(crate) fn begin_step(&mut self) {
        self.forget_sets();
        self.released.clear();
        self.reversals.clear();
        self.joint = JointDecisions::default();
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
        states.count_iteration();
        rules.follow(part, states, setup);
        let (mut decisions, before) = rules.decide(part, states, &mut self.released);
        if !setup.by_points() {
            self.cycles.restrict(&mut decisions, &before);
            messages.extend(self.cycles.keep(&decisions, &ids(part, states), part.info.step));
        } else if setup.settings.formulation.frictional() {
            // With decisions at integration points each evaluation of forces decides: nodes only report it.
            forced_points::hold_turned(states, &mut decisions, &before, setup.tolerances);
        }
        let change = rules.apply(part, states, &decisions, &before);
        // Surfaces without bond carry what their new states say.
        setup.find_bonds(states);
        change
    }

    /// Before an iteration: friction follows the temperature, which may have changed since the last one, and bonds follow the motion.
    pub(crate) fn follow(&self, part: &ModelPart, states: &mut SlaveStates, setup: &Setup) {
        if setup.has_warm_friction() {
            Rules::of(setup).follow(part, states, setup);
        } else {
            setup.find_bonds(states);
        }
    }

    /// Finds pressures and tractions in the present state, and holds the set.
    pub(crate) fn find_tractions(&self, part: &ModelPart, states: &mut SlaveStates, setup: &Setup) {
        let rules = Rules::of(setup);
        rules.follow(part, states, setup);
        let (decisions, _) = rules.decide(part, states, &mut self.released.clone());
        rules.press(part, states, &decisions);
    }

    /// Lets the rules decide in a converged state, where the set was frozen.
    pub(crate) fn settle(&mut self, part: &mut ModelPart, states: &mut SlaveStates, setup: &Setup) -> OuterLoop {
        if !self.cycles.holds() {
            return OuterLoop::Done;
        }
        let rules = Rules::of(setup);
        let (mut decisions, before) = rules.decide(part, states, &mut self.released);
        let changes = decisions.iter().zip(&before).any(|((_, decision), was)| decision.state != *was);
        if changes && !self.joint.ended && self.joint.made < MOST_JOINT && rules.decides_jointly() {
            return OuterLoop::DecideTogether;
        }
        let largest = decisions.iter().map(|(_, decision)| -decision.pressure).fold(0.0, f64::max);
        let settled = self.cycles.settle(&mut decisions, &before, largest, &ids(part, states));
        match settled {
            SetOutcome::Done => OuterLoop::Done,
            SetOutcome::Failed(why) => OuterLoop::Failed(why),
            SetOutcome::Change => {
                rules.apply(part, states, &decisions, &before);
                setup.find_bonds(states);
                self.find_tangents(part, states, setup);
                OuterLoop::Continue
            }
        }
    }

    /// The slave nodes that are decided on together.
    pub(crate) fn decided_together(states: &SlaveStates) -> Vec<SlaveIndex> {
        joint_decision::slave_nodes(states)
    }

    /// Their conditions.
    pub(crate) fn conditions(part: &ModelPart, states: &SlaveStates, setup: &Setup) -> Vec<ComplementaryCondition> {
        let multiplier = setup.settings.formulation.multiplier;
        joint_decision::conditions(part, states, multiplier, &Self::decided_together(states))
    }

    /// Decides on slave nodes together in a converged state, where their `responses` are known and lead to another set, and says so;
    /// otherwise they are decided on one by one from here on.
    pub(crate) fn decide_together(
        &mut self,
        part: &mut ModelPart,
        states: &mut SlaveStates,
        setup: &Setup,
        responses: Option<&Responses>,
    ) -> Option<String> {
        self.joint.ended = true;
        let count = Self::decided_together(states).len();
        let change = self.decide_states(part, states, setup, responses?).count();
        if change == 0 {
            return None;
        }
        self.joint = JointDecisions { made: self.joint.made + 1, ended: false };
        Some(format!(
            "the states of {count} slave nodes are decided together, as one complementarity problem; {change} change"
        ))
    }

    /// Decides on slave nodes together by their `responses`; where these have no solution, on the one that violates its condition most.
    pub(crate) fn decide_states(
        &mut self,
        part: &mut ModelPart,
        states: &mut SlaveStates,
        setup: &Setup,
        responses: &Responses,
    ) -> SetChange {
        let rules = Rules::of(setup);
        let (mut decisions, before) = rules.decide(part, states, &mut self.released);
        let slaves = Self::decided_together(states);
        if !joint_decision::decide(rules, part, states, &slaves, responses, &mut decisions) {
            joint_decision::keep_one(&mut decisions, &before);
        }
        rules.apply(part, states, &decisions, &before)
    }

    /// Whether slave nodes of a formulation can be decided on together.
    pub(crate) fn decides_jointly(setup: &Setup) -> bool {
        Rules::of(setup).decides_jointly()
    }

    /// Whether states change by joint decisions and in converged states only.
    pub(crate) fn hold(&mut self, held: bool) {
        self.cycles.hold(held);
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
