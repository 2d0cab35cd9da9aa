//! Open and closed slave nodes decided together, by the linear complementarity problem of the interface.
//!
//! Of each frictionless slave node one of two quantities is zero and the other is not negative: z = −λ·n, its pressure over k, and
//! w = b_λ·n, the row of its equation were it in contact, which is k times its weighted opening. By the responses of the tangent
//! each depends linearly on all others; nodes in contact start with z as the dependent quantity, the others with w.

use zelus_core::Complementarity;
use zelus_core::entities::{ComplementaryCondition, Responses};
use zelus_core::model::{ModelPart, Owner};
use zelus_core::vector3::{dot, scale};

use super::decision::Rules;
use crate::interface::SlaveIndex;
use crate::law::NodeState;
use crate::law::rules::{self, Decision, SlaveNumbers};
use crate::pairs::Multiplier;
use crate::slave_nodes::{SlaveState, SlaveStates};

/// The slave nodes that are decided on together: all that face a master and that no support constrains.
pub(super) fn slave_nodes(states: &SlaveStates) -> Vec<SlaveIndex> {
    let is_free = |state: &SlaveState| {
        !state.stays() && !state.kinematics.isolated && state.kinematics.area > 0.0 && state.law.constraints.are_none()
    };
    states.iter().filter(|(_, state)| is_free(state)).map(|(slave, _)| slave).collect()
}

/// The conditions of slave nodes with this multiplier: theirs along their normals.
pub(super) fn conditions(
    part: &ModelPart,
    states: &SlaveStates,
    multiplier: Multiplier,
    slaves: &[SlaveIndex],
) -> Vec<ComplementaryCondition> {
    let unknowns = multiplier.unknowns(part.info.domain_size);
    let condition = |&slave: &SlaveIndex| {
        let normal = states[slave].kinematics.normal;
        let share =
            |component: usize| if matches!(multiplier, Multiplier::Scalar(_)) { 1.0 } else { normal[component] };
        let direction = unknowns.iter().enumerate().map(|(component, &variable)| (variable, share(component)));
        ComplementaryCondition {
            owner: Owner::Slave(states.owner(slave)),
            direction: direction.collect(),
            acts: states[slave].law.active,
        }
    };
    slaves.iter().map(condition).collect()
}

/// Keeps one of the changes that each node would make on its own: that of the node under the largest pressure that enters contact, or
/// else of the one under the largest tension that leaves it. Bodies without restraint would be torn by all of them at once.
pub(super) fn keep_one(decisions: &mut [(SlaveIndex, Decision)], before: &[NodeState]) {
    let rank = |decision: &Decision| {
        (!decision.state.is_active(), if decision.state.is_active() { decision.pressure } else { -decision.pressure })
    };
    let changes = decisions.iter().enumerate().filter(|(_, (_, decision))| decision.changed);
    let order = |a: &(bool, f64), b: &(bool, f64)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1));
    let kept = changes.min_by(|(_, (_, a)), (_, (_, b))| order(&rank(a), &rank(b))).map(|(at, _)| at);
    for (at, ((_, decision), &was)) in decisions.iter_mut().zip(before).enumerate() {
        if Some(at) != kept {
            decision.stay(was, was);
        }
    }
}

/// Puts the decisions that fulfil all conditions of `slaves` into `decisions`; `false` where there are none.
pub(super) fn decide(
    rules: Rules<'_>,
    part: &ModelPart,
    states: &SlaveStates,
    slaves: &[SlaveIndex],
    responses: &Responses,
    decisions: &mut [(SlaveIndex, Decision)],
) -> bool {
    let numbers: Vec<SlaveNumbers> = slaves.iter().map(|&slave| rules.numbers(part, states, slave)).collect();
    let (n, k) = (slaves.len(), rules.parameters.scale_factor);
    let is_active = |at: usize| numbers[at].state.is_active();
    let value =
        |i: usize| if is_active(i) { -dot(numbers[i].multiplier, numbers[i].normal) } else { responses.rows[i] };
    // Of a condition (row) to a force on the row of another (column): what depends, and what is given.
    let change = |at: usize, of_multiplier: bool| {
        if of_multiplier { -responses.of_multipliers[at] } else { responses.of_rows[at] }
    };
    let given: Vec<f64> = (0..n).map(|j| change(j * n + j, !is_active(j))).collect();
    if given.contains(&0.0) {
        return false;
    }
    let m = (0..n * n).map(|at| change(at, is_active(at / n)) / given[at % n]).collect();
    let small = |(numbers, &slave): (&SlaveNumbers, &SlaveIndex)| {
        let length = numbers.tolerances.length.max(numbers.tolerances.traction / numbers.stiffness);
        let sizes = [numbers.tolerances.traction / k, k * states[slave].kinematics.area * length];
        if numbers.state.is_active() { sizes } else { [sizes[1], sizes[0]] }
    };
    let small = numbers.iter().zip(slaves).map(small).collect();
    let Some(solved) = Complementarity::new((0..n).map(value).collect(), m, small).solve() else { return false };
    for ((slave, numbers), (exchanged, value)) in slaves.iter().zip(&numbers).zip(solved) {
        let at = decisions.binary_search_by_key(slave, |(slave, _)| *slave).expect("a decision for every slave node");
        let (was, decision) = (numbers.state, &mut decisions[at].1);
        match (was.is_active(), exchanged) {
            (_, false) => decision.stay(was, was),
            (true, true) => *decision = rules::inactive(numbers, decision.pressure),
            (false, true) => {
                decision.stay(NodeState::Slip, was);
                decision.pressure = -k * value;
                decision.multiplier = Some(scale(numbers.normal, -value));
            }
        }
    }
    true
}
