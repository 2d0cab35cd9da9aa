//! Update of the active set: the numbers of every slave node, their decision by the [`rules`], and the states
//! that follow from it.

use std::collections::BTreeSet;

use zelus_core::entities::SetChange;
use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, norm, scale, sub};

use super::cycling::ALLOWED;
use crate::friction::slip;
use crate::interface::SlaveIndex;
use crate::law::constrained_multiplier::along_free_tangents;
use crate::law::rules::{self, Decision, SlaveNumbers};
use crate::law::{
    Augmentation, FrictionLaw, MultiplierConstraint, NodeState, OverclosureLaw, Sliding, SoftTangent, StepParameters,
};
use crate::mortar::{tangent, tangential};
use crate::pairs::{Formulation, Multiplier};
use crate::settings::Setup;
use crate::slave_nodes::SlaveStates;
use crate::tolerances::Tolerances;

/// The rules of a formulation, with the numbers of the step.
#[derive(Clone, Copy)]
pub(crate) struct Rules<'a> {
    /// The formulation.
    pub formulation: &'a Formulation,
    /// Settings and numbers of the step.
    pub parameters: &'a StepParameters,
    /// Smallest lengths and tractions that decide.
    pub tolerances: Tolerances,
}

impl<'a> Rules<'a> {
    /// Rules with the settings and numbers of a setup.
    pub(crate) fn of(setup: &'a Setup) -> Self {
        Self { formulation: setup.settings.formulation, parameters: &setup.parameters, tolerances: setup.tolerances }
    }

    /// Takes what laws of friction that depend on the sliding or the temperature, and of soft contact and of bonds, say in the present
    /// state of every slave node.
    pub(super) fn follow(self, part: &ModelPart, states: &mut SlaveStates, setup: &Setup) {
        let friction = Some(self.parameters.friction_law);
        let friction = friction.filter(|law| law.depends_on_sliding && self.formulation.frictional());
        let soft = setup.settings.overclosure.as_deref();
        if friction.is_some() || soft.is_some() {
            self.follow_laws(part, states, (friction, soft));
        }
        setup.find_bonds(states);
    }

    /// Takes what these laws of friction and of soft contact say in the present state of every slave node.
    fn follow_laws(
        self,
        part: &ModelPart,
        states: &mut SlaveStates,
        (friction, soft): (Option<&FrictionLaw>, Option<&dyn OverclosureLaw>),
    ) {
        let slaves = states.slaves();
        let all: Vec<SlaveNumbers> = slaves.iter().map(|&slave| self.numbers(part, states, slave)).collect();
        for (&slave, numbers) in slaves.iter().zip(&all) {
            let pressure = numbers.pressure().min(0.0);
            if let Some(law) = friction {
                let (speed, temperature) =
                    (norm(numbers.slip) / part.info.delta_time, states[slave].parameters.temperature);
                let sliding = Sliding { pressure, speed, temperature };
                let node = states.mesh_node(slave) as usize;
                states[slave].parameters.friction = law.bound_at(&part.nodes, node, sliding);
            }
            if let Some(law) = soft {
                let pressure = if numbers.state.is_active() { -pressure } else { 0.0 };
                states[slave].parameters.soft = Some(SoftTangent::of(law, pressure));
            }
        }
    }

    /// The decision for every slave node, and the states the nodes are in.
    ///
    /// Nodes that nothing overlaps are not in contact. When nothing changes at all, nodes that slide on within a margin and that
    /// friction pushes along their motion stick, each once a step: those in `released` did before.
    pub(crate) fn decide(
        self,
        part: &ModelPart,
        states: &SlaveStates,
        released: &mut BTreeSet<SlaveIndex>,
    ) -> (Vec<(SlaveIndex, Decision)>, Vec<NodeState>) {
        let rule = self.parameters.slip_rule;
        let (mut decisions, mut before, mut pushed) = (Vec::new(), Vec::new(), Vec::new());
        for (node, state) in states.iter() {
            let numbers = self.numbers(part, states, node);
            let mut decision = (self.formulation.decide)(&numbers, rule);
            if state.kinematics.isolated {
                decision = rules::inactive(&numbers, decision.pressure);
            }
            let multipliers = self.formulation.frictional() && self.formulation.multiplier.is_unknown();
            if multipliers && !released.contains(&node) && rules::is_pushed(&numbers, rule) {
                pushed.push(decisions.len());
            }
            decisions.push((node, decision));
            before.push(numbers.state);
        }
        if decisions.iter().zip(&before).all(|((_, decision), was)| decision.state == *was) {
            for at in pushed {
                decisions[at].1.stay(NodeState::Stick, NodeState::Slip);
                released.insert(decisions[at].0);
            }
        }
        (decisions, before)
    }

    /// Whether open and closed slave nodes can be decided on together: without friction they have one condition each.
    pub(super) fn decides_jointly(self) -> bool {
        self.formulation.multiplier.is_unknown() && !self.formulation.frictional()
    }

    /// Why a converged state is not accepted: slave nodes penetrate the master without being in contact, by more than
    /// [`ALLOWED`] of the largest pressure.
    pub(crate) fn passed_through(self, part: &ModelPart, states: &SlaveStates) -> Option<String> {
        let facing = states.iter().filter(|(_, state)| !state.kinematics.isolated);
        let facing: Vec<(SlaveIndex, SlaveNumbers)> = facing.map(|(n, _)| (n, self.numbers(part, states, n))).collect();
        let in_contact = facing.iter().filter(|(_, numbers)| numbers.state.is_active());
        let largest = in_contact.map(|(_, numbers)| -numbers.pressure()).fold(0.0, f64::max);
        let inside: Vec<_> =
            facing.iter().filter(|(_, numbers)| numbers.has_passed_through(ALLOWED * largest)).collect();
        let deepest = inside.iter().min_by(|(_, a), (_, b)| a.gap.total_cmp(&b.gap))?;
        Some(format!(
            "{} nodes without contact are in the master, node {} by {:.3e}",
            inside.len(),
            part.nodes.ids[states.mesh_node(deepest.0) as usize],
            -deepest.1.gap
        ))
    }

    /// Makes the decisions of an iteration the active set.
    ///
    /// A node that becomes active starts from its augmented pressure; one that becomes inactive keeps its multiplier, which the
    /// next solve drives to zero.
    pub(crate) fn apply(
        self,
        part: &mut ModelPart,
        states: &mut SlaveStates,
        decisions: &[(SlaveIndex, Decision)],
        before: &[NodeState],
    ) -> SetChange {
        let mut change = SetChange::default();
        let frictional = self.formulation.frictional();
        for ((node, decision), &was) in decisions.iter().zip(before) {
            let (id, active) = (part.nodes.ids[states.mesh_node(*node) as usize], decision.state.is_active());
            match (decision.changed, active) {
                (true, true) => change.activated.push(id),
                (true, false) => change.deactivated.push(id),
                (false, _) if decision.slip_changed => change.stick_slip.push(id),
                (false, _) => {}
            }
            let pressure = self.acting_pressure(part, states, *node, decision);
            let state = &mut states[*node];
            state.law.pressure = pressure;
            state.law.active = active;
            if active {
                state.law.slides = Some(decision.state == NodeState::Slip);
            } else if decision.changed && frictional {
                state.law.slides = None;
                state.kinematics.weighted_slip = [0.0; 3];
            }
            let slides = decision.state == NodeState::Slip && was != NodeState::Slip;
            if slides && frictional && decision.traction != [0.0; 3] {
                let traction = self.parameters.ellipse.inverse_root(decision.traction, state.kinematics.normal);
                state.law.tangent = tangent(traction, state.kinematics.normal, part.info.domain_size);
            }
            if frictional {
                state.law.traction = decision.traction;
                // With Nitsche's method points carry the tractions of the integration.
                if !matches!(self.formulation.multiplier, Multiplier::Body) {
                    state.law.history_traction = decision.traction;
                }
            }
            if let Some(multiplier) = decision.multiplier {
                let along_normal = [decision.pressure / self.parameters.scale_factor, 0.0, 0.0];
                let scalar = matches!(self.formulation.multiplier, Multiplier::Scalar(_));
                let value = if scalar { along_normal } else { multiplier };
                self.formulation.multiplier.set(&mut part.slave_nodes, states.owner(*node), value);
            }
        }
        change
    }

    /// Takes pressures and tractions from decisions, and nothing else.
    pub(crate) fn press(self, part: &ModelPart, states: &mut SlaveStates, decisions: &[(SlaveIndex, Decision)]) {
        for (node, decision) in decisions {
            let pressure = self.acting_pressure(part, states, *node, decision);
            let state = &mut states[*node];
            state.law.pressure = pressure;
            if self.formulation.frictional() {
                state.law.traction = decision.traction;
            }
        }
    }

    /// The pressure that acts at a slave node: k λ·n + ε g̃ where pairs augment, else that of the decision.
    fn acting_pressure(self, part: &ModelPart, states: &SlaveStates, slave: SlaveIndex, decision: &Decision) -> f64 {
        let state = &states[slave];
        match (self.formulation.multiplier, self.parameters.augmentation) {
            (Multiplier::None | Multiplier::Body, _) | (_, Augmentation::Node) => decision.pressure,
            (multiplier, Augmentation::Pair) => {
                let augmentation = state.parameters.penalty * state.kinematics.weighted_gap;
                let whole = multiplier.vector(&part.slave_nodes, states.owner(slave), state.kinematics.normal);
                let pressure = dot(whole, state.kinematics.normal);
                self.parameters.scale_factor * pressure + augmentation
            }
        }
    }

    /// The numbers of one slave node that the rules take.
    ///
    /// The penalty method states tractions ε WG, those of all others are multipliers. By Uzawa's iteration p° + ε g decides: p° is
    /// kept until the next update, also of a node that is not in contact meanwhile.
    pub(super) fn numbers(self, part: &ModelPart, states: &SlaveStates, slave: SlaveIndex) -> SlaveNumbers {
        let Self { formulation, parameters, tolerances } = self;
        let (state, owner) = (&states[slave], states.owner(slave));
        let (normal, area, penalty, constraints) =
            (state.kinematics.normal, state.kinematics.area, state.parameters.penalty, state.law.constraints);
        let by_area = if area > 0.0 { area.recip() } else { 0.0 };
        let kept = if state.law.uzawa_pressure == 0.0 { 0.0 } else { state.law.uzawa_pressure / penalty };
        let slip = tolerances.vector_of(slip(part, states, slave, formulation.multiplier, parameters));
        let stiffness = match formulation.multiplier {
            Multiplier::Scalar(_) | Multiplier::Vector(_) => parameters.nodal_stiffness(penalty, area),
            Multiplier::None if parameters.weighted_penalty => penalty * area,
            Multiplier::None | Multiplier::Body => penalty,
        };
        let whole = formulation.multiplier.vector(&part.slave_nodes, owner, normal);
        let driven = constraints.rules.contains(&MultiplierConstraint::ConstantInStick);
        let is_held =
            state.contact() == NodeState::Stick && constraints.rules.contains(&MultiplierConstraint::HeldByOtherFace);
        let multiplier = match formulation.multiplier {
            // No multiplier restrains motion that supports prescribe: the slip itself gives the traction that would.
            Multiplier::Vector(_) if driven => {
                let rules = constraints.rules;
                let along = |c: usize| rules[c] == MultiplierConstraint::ConstantInStick && norm(slip) > 0.0;
                let normal_part = scale(normal, dot(whole, normal));
                let kept = sub(whole, normal_part);
                let kept = constraints.axes.components(kept);
                let free = constraints.axes.vector(std::array::from_fn(|c| if along(c) { 0.0 } else { kept[c] }));
                add(add(normal_part, free), scale(slip, stiffness / parameters.scale_factor))
            }
            // Where another face holds the node, slip is to begin by the traction that would stop it.
            Multiplier::Vector(_) if is_held => {
                let own = constraints.axes.components(slip);
                let along = |c: usize| constraints.rules[c] == MultiplierConstraint::HeldByOtherFace;
                let stopped = constraints.axes.vector(std::array::from_fn(|c| if along(c) { own[c] } else { 0.0 }));
                add(whole, scale(stopped, stiffness / parameters.scale_factor))
            }
            // A sliding node slides along the directions that are free.
            Multiplier::Vector(_) => add(
                scale(normal, dot(whole, normal)),
                along_free_tangents(tangential(whole, normal), normal, constraints),
            ),
            _ => whole,
        };
        let begin = state.parameters.soft.map_or(0.0, |soft| soft.begin);
        SlaveNumbers {
            state: state.contact(),
            normal,
            multiplier,
            solved: formulation.multiplier.is_unknown(),
            gap: tolerances.length_of(state.counted_gap(parameters) * by_area + kept + begin),
            slip,
            trial: state.law.trial,
            tangent: state.law.tangent,
            stiffness,
            driven,
            stays: state.stays(),
            friction: state.parameters.friction,
            ellipse: parameters.ellipse,
            scale_factor: parameters.scale_factor,
            tangent_factor: parameters.tangent_factor,
            tolerances,
            bond: states.bond(slave).and_then(|bond| bond.numbers(normal)),
        }
    }
}
