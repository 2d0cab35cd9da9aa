//! Which slave nodes are in contact: at step start by their gap, in every iteration by the augmented pressure.

use std::collections::BTreeSet;

use zelus_core::entities::SetChange;
use zelus_core::model::flags::{ACTIVE, ISOLATED, SLIP};
use zelus_core::model::{ModelPart, variables::NORMAL};
use zelus_core::vector3::{add, dot, norm, scale, sub};

use super::cycling::ALLOWED;
use super::holding::held_at;
use super::step_parameters::StepParameters;
use crate::active_set::{self, Decision, SlaveNumbers, SlipRule};
use crate::formulations::held::along_free_tangents;
use crate::formulations::{Augmentation, Held, NodeState};
use crate::friction_law::FrictionLaw;
use crate::interface::{Interface, Roles};
use crate::mortar::{tangent, tangential};
use crate::pairs::{Family, Friction, Multiplier};
use crate::resolution::Resolution;
use crate::variables::{
    AUGMENTED_NORMAL_CONTACT_PRESSURE, AUGMENTED_TANGENT_CONTACT_PRESSURE, FRICTION_TRACTION, INITIAL_PENALTY,
    KEPT_CONTACT_PRESSURE, MEAN_WEIGHTED_GAP, MULTIPLIER_WEIGHT, NODAL_AREA, NODAL_H, NORMAL_GAP, TANGENT_XI,
    TRIAL_TRACTION, WEIGHTED_GAP, WEIGHTED_SLIP,
};

/// Gap, in mesh sizes, of the simple activation.
const SIMPLE_REACH: f64 = 2e-3;
/// Gap of a node that nothing faces.
const FAR: f64 = 1e12;

/// Sets the multipliers of inactive nodes to zero and what is kept of them, or the tractions that the penalty method carries.
pub(super) fn clear_inactive_multipliers(part: &mut ModelPart, multiplier: Multiplier, slaves: &[u32]) {
    let inactive: Vec<u32> = slaves.iter().copied().filter(|&n| !part.nodes.flags.is(ACTIVE, n as usize)).collect();
    let history = &mut part.nodes.history;
    match multiplier {
        Multiplier::Body => {}
        Multiplier::None => {
            if let Some(carried) = history.get_mut(FRICTION_TRACTION.name()) {
                inactive.iter().for_each(|&n| carried.levels[0][3 * n as usize..3 * n as usize + 3].fill(0.0));
            }
        }
        Multiplier::Scalar(variable) => {
            let column = history.values_mut(variable, 0);
            inactive.iter().for_each(|&n| column[n as usize] = 0.0);
            if let Some(kept) = history.get_mut(KEPT_CONTACT_PRESSURE.name()) {
                inactive.iter().for_each(|&n| kept.levels[0][n as usize] = 0.0);
            }
        }
        Multiplier::Vector(variable) => {
            let column = history.values_mut(variable, 0);
            inactive.iter().for_each(|&n| column[3 * n as usize..3 * n as usize + 3].fill(0.0));
        }
    }
}

/// What decides at step start whether a node is in contact.
#[derive(Debug, Clone, Copy)]
pub(super) enum Start<'a> {
    /// A gap below this length.
    Reach(f64),
    /// A gap below a small share of the mesh size of the node.
    ShareOfMeshSize,
    /// These nodes, and those that are in contact already.
    Touching(&'a BTreeSet<u32>),
}

/// Step start: which nodes are active. Gaps are weighted gaps over areas, so they are those of the mortar mapping.
pub(super) fn start(part: &mut ModelPart, slaves: &[u32], start: Start<'_>, friction: (&FrictionLaw, SlipRule)) {
    let gaps: Vec<f64> = {
        let weighted = part.nodes.history.values(&WEIGHTED_GAP, 0);
        let areas = part.nodes.values.values(&NODAL_AREA, 0);
        slaves.iter().map(|&n| n as usize).map(|n| if areas[n] > 0.0 { weighted[n] / areas[n] } else { FAR }).collect()
    };
    let near: Vec<bool> = {
        let sizes = part.nodes.values.values(&NODAL_H, 0);
        let near = |(&n, gap): (&u32, &f64)| match start {
            Start::Reach(reach) => *gap < reach,
            Start::ShareOfMeshSize => *gap < SIMPLE_REACH * sizes[n as usize],
            Start::Touching(nodes) => nodes.contains(&n) || part.nodes.flags.is(ACTIVE, n as usize),
        };
        slaves.iter().zip(&gaps).map(near).collect()
    };
    let slides: Vec<bool> = {
        let (law, rule) = friction;
        let smooth = |n: u32| law.bound_at(&part.nodes, n as usize).is_smooth();
        slaves.iter().map(|&n| rule == SlipRule::Pure || smooth(n)).collect()
    };
    for (at, &node) in slaves.iter().enumerate() {
        let node = node as usize;
        let active = near[at] && !part.nodes.flags.is(ISOLATED, node);
        part.nodes.flags.set(ACTIVE, node, active);
        if active && slides[at] {
            part.nodes.flags.set(SLIP, node, true);
        } else if active && part.nodes.flags.get(SLIP, node).is_none() {
            part.nodes.flags.set(SLIP, node, false);
        }
    }
    let column = part.nodes.values.values_mut(&NORMAL_GAP, 0);
    for (at, &node) in slaves.iter().enumerate() {
        column[node as usize] = if near[at] { gaps[at] } else { 0.0 };
    }
}

/// The slave nodes of interfaces without contact that are at most `reach` mesh sizes farther from a master than the nearest
/// of their interface, where those are not in contact yet. `open` keeps the interfaces that had none when it was empty.
pub(super) fn nearest(
    part: &ModelPart,
    interfaces: &[Interface],
    reach: f64,
    open: &mut BTreeSet<usize>,
) -> BTreeSet<u32> {
    let weighted = part.nodes.history.values(&WEIGHTED_GAP, 0);
    let (areas, sizes) = (part.nodes.values.values(&NODAL_AREA, 0), part.nodes.values.values(&NODAL_H, 0));
    let is_active = |n: &u32| part.nodes.flags.is(ACTIVE, *n as usize);
    let nodes: Vec<Vec<u32>> = interfaces.iter().map(|interface| interface.nodes_of(Roles::Slave)).collect();
    if open.is_empty() {
        open.extend((0..nodes.len()).filter(|&at| !nodes[at].iter().any(is_active)));
    }
    let mut found = BTreeSet::new();
    for own in open.iter().map(|&at| &nodes[at]) {
        let facing = || own.iter().filter(|&&n| !part.nodes.flags.is(ISOLATED, n as usize));
        let gap = |n: u32| weighted[n as usize] / areas[n as usize];
        let least = facing().map(|&n| gap(n)).fold(f64::INFINITY, f64::min);
        found.extend(facing().filter(|&&n| gap(n) - least <= reach * sizes[n as usize] && !is_active(&n)));
    }
    found
}

/// What the rules of [`active_set`] want of every slave node, and the states the nodes are in.
///
/// Nodes that nothing overlaps are not in contact. When nothing changes at all, nodes that slide on within a margin and that
/// friction pushes along their motion stick, each once a step: those in `released` did before.
pub(super) fn decide(
    part: &ModelPart,
    slaves: &[u32],
    family: &Family,
    parameters: &StepParameters,
    resolution: Resolution,
    released: &mut BTreeSet<u32>,
) -> (Vec<(u32, Decision)>, Vec<NodeState>) {
    let mut decisions = Vec::with_capacity(slaves.len());
    let mut states = Vec::with_capacity(slaves.len());
    let mut pushed = Vec::new();
    for &node in slaves {
        let at = node as usize;
        let numbers = numbers(part, at, family, parameters, resolution);
        let mut decision = match (family.friction, family.penalty) {
            _ if matches!(family.multiplier, Multiplier::Body) => active_set::of_points(&numbers),
            (Friction::None, _) => active_set::frictionless(&numbers),
            (_, false) => active_set::alm_frictional(&numbers, parameters.slip_rule),
            (_, true) => active_set::penalty_frictional(&numbers, parameters.slip_rule),
        };
        if part.nodes.flags.is(ISOLATED, at) {
            decision = active_set::inactive(&numbers, decision.pressure);
        }
        let multipliers = family.frictional() && family.multiplier.is_unknown();
        if multipliers && !released.contains(&node) && active_set::is_pushed(&numbers, parameters.slip_rule) {
            pushed.push(decisions.len());
        }
        decisions.push((node, decision));
        states.push(numbers.state);
    }
    if decisions.iter().zip(&states).all(|((_, decision), was)| decision.state == *was) {
        for at in pushed {
            decisions[at].1.stay(NodeState::Stick, NodeState::Slip);
            released.insert(decisions[at].0);
        }
    }
    (decisions, states)
}

/// Why a converged state is none: slave nodes that face the master are in it without contact, by more than where no set
/// fulfils all conditions. Rules that decide otherwise have lost sight of what is small.
pub(super) fn passed_through(
    part: &ModelPart,
    slaves: &[u32],
    family: &Family,
    parameters: &StepParameters,
    resolution: Resolution,
) -> Option<String> {
    let facing = slaves.iter().copied().filter(|&n| !part.nodes.flags.is(ISOLATED, n as usize));
    let nodes: Vec<(u32, SlaveNumbers)> =
        facing.map(|n| (n, numbers(part, n as usize, family, parameters, resolution))).collect();
    let pressed = nodes.iter().filter(|(_, numbers)| numbers.state.is_active());
    let largest = pressed.map(|(_, numbers)| -numbers.pressure()).fold(0.0, f64::max);
    let inside: Vec<_> = nodes.iter().filter(|(_, numbers)| numbers.has_passed_through(ALLOWED * largest)).collect();
    let deepest = inside.iter().min_by(|(_, a), (_, b)| a.gap.total_cmp(&b.gap))?;
    Some(format!(
        "{} nodes without contact are in the master, node {} by {:.3e}",
        inside.len(),
        part.nodes.ids[deepest.0 as usize],
        -deepest.1.gap
    ))
}

/// Makes the decisions of an iteration the active set.
///
/// A node that becomes active starts from its augmented pressure; one that becomes inactive keeps its multiplier, which the
/// next solve drives to zero.
pub(super) fn apply(
    part: &mut ModelPart,
    decisions: &[(u32, Decision)],
    before: &[NodeState],
    family: &Family,
    parameters: &StepParameters,
) -> SetChange {
    let mut change = SetChange::default();
    write_pressures(part, decisions, family, parameters);
    for ((node, decision), &was) in decisions.iter().zip(before) {
        let at = *node as usize;
        let (id, active) = (part.nodes.ids[at], decision.state.is_active());
        match (decision.changed, active) {
            (true, true) => change.activated.push(id),
            (true, false) => change.deactivated.push(id),
            (false, _) if decision.slip_changed => change.stick_slip.push(id),
            (false, _) => {}
        }
        part.nodes.flags.set(ACTIVE, at, active);
        if active {
            part.nodes.flags.set(SLIP, at, decision.state == NodeState::Slip);
        } else if decision.changed && family.frictional() {
            part.nodes.flags.undefine(SLIP, at);
            part.nodes.history.values_mut(&WEIGHTED_SLIP, 0)[3 * at..3 * at + 3].fill(0.0);
        }
        let slides = decision.state == NodeState::Slip && was != NodeState::Slip;
        if slides && family.frictional() && decision.traction != [0.0; 3] {
            let normal = part.nodes.history.get(NORMAL.name()).map_or([0.0; 3], |field| field.vector(0, at));
            let direction = tangent(decision.traction, normal, part.info.domain_size);
            part.nodes.values.values_mut(&TANGENT_XI, 0)[3 * at..3 * at + 3].copy_from_slice(&direction);
        }
        if let Some(multiplier) = decision.multiplier {
            match family.multiplier {
                Multiplier::None | Multiplier::Body => {}
                Multiplier::Scalar(variable) => {
                    part.nodes.history.values_mut(variable, 0)[at] = decision.pressure / parameters.scale_factor;
                }
                Multiplier::Vector(variable) => {
                    part.nodes.history.values_mut(variable, 0)[3 * at..3 * at + 3].copy_from_slice(&multiplier);
                }
            }
        }
    }
    if family.frictional() {
        let tractions = part.nodes.values.values_mut(&AUGMENTED_TANGENT_CONTACT_PRESSURE, 0);
        for (n, decision) in decisions {
            tractions[3 * *n as usize..3 * *n as usize + 3].copy_from_slice(&decision.traction);
        }
        if let Some(carried) = part.nodes.history.get_mut(FRICTION_TRACTION.name()) {
            for (n, decision) in decisions {
                carried.levels[0][3 * *n as usize..3 * *n as usize + 3].copy_from_slice(&decision.traction);
            }
        }
    }
    change
}

/// Writes the pressure that acts at the slave nodes: k λ·n + ε g̃ where pairs augment, else that of the decision.
fn write_pressures(part: &mut ModelPart, decisions: &[(u32, Decision)], family: &Family, parameters: &StepParameters) {
    let augmented = |(node, decision): &(u32, Decision)| {
        let at = *node as usize;
        let penalty = part.nodes.values.values(&INITIAL_PENALTY, 0)[at];
        let augmentation = penalty * part.nodes.history.values(&WEIGHTED_GAP, 0)[at];
        match (family.multiplier, parameters.augmentation) {
            (Multiplier::None | Multiplier::Body, _) | (_, Augmentation::Node) => decision.pressure,
            _ => parameters.scale_factor * dot(multiplier(part, at, family), normal(part, at)) + augmentation,
        }
    };
    let pressures: Vec<f64> = decisions.iter().map(augmented).collect();
    let column = part.nodes.values.values_mut(&AUGMENTED_NORMAL_CONTACT_PRESSURE, 0);
    decisions.iter().zip(pressures).for_each(|((node, _), pressure)| column[*node as usize] = pressure);
}

fn normal(part: &ModelPart, at: usize) -> [f64; 3] {
    part.nodes.history.get(NORMAL.name()).map_or([0.0; 3], |field| field.vector(0, at))
}

/// Multiplier of a slave node; a scalar one along its normal, none without.
fn multiplier(part: &ModelPart, at: usize, family: &Family) -> [f64; 3] {
    match family.multiplier {
        Multiplier::None | Multiplier::Body => [0.0; 3],
        Multiplier::Scalar(variable) => scale(normal(part, at), part.nodes.history.values(variable, 0)[at]),
        Multiplier::Vector(variable) => {
            part.nodes.history.get(variable.name()).map_or([0.0; 3], |field| field.vector(0, at))
        }
    }
}

/// What the rules look at, of one slave node.
///
/// The penalty method states tractions ε WG, those of all others are multipliers. By Uzawa's iteration p° + ε g decides: p° is
/// kept until the next update, also of a node that is not in contact meanwhile.
fn numbers(
    part: &ModelPart,
    at: usize,
    family: &Family,
    parameters: &StepParameters,
    resolution: Resolution,
) -> SlaveNumbers {
    let history = &part.nodes.history;
    let vector_of = |name: &str| history.get(name).map_or([0.0; 3], |field| field.vector(0, at));
    let normal = normal(part, at);
    let area = part.nodes.values.values(&NODAL_AREA, 0)[at];
    let by_area = if area > 0.0 { area.recip() } else { 0.0 };
    let penalty = part.nodes.values.values(&INITIAL_PENALTY, 0)[at];
    let kept = history.get(KEPT_CONTACT_PRESSURE.name()).map_or(0.0, |field| field.levels[0][at] / penalty);
    let held = held_at(part, at);
    let slip = resolution.vector_of(slip(part, at, family.multiplier, parameters));
    let stiffness = match family.multiplier {
        Multiplier::Scalar(_) | Multiplier::Vector(_) => parameters.nodal_stiffness(penalty, area),
        Multiplier::None if parameters.weighted_penalty => penalty * area,
        Multiplier::None | Multiplier::Body => penalty,
    };
    let multiplier = match family.multiplier {
        // No multiplier holds what supports move: the slip itself says what would.
        Multiplier::Vector(variable) if held.contains(&Held::KeptInStick) => {
            add(vector_of(variable.name()), scale(slip, stiffness / parameters.scale_factor))
        }
        Multiplier::Vector(variable) => {
            // What slides, slides along what is free.
            let whole = vector_of(variable.name());
            add(scale(normal, dot(whole, normal)), along_free_tangents(tangential(whole, normal), normal, held))
        }
        _ => multiplier(part, at, family),
    };
    SlaveNumbers {
        state: NodeState::of_flags(&part.nodes.flags, at),
        normal,
        multiplier,
        solved: family.multiplier.is_unknown(),
        gap: resolution.length_of(counted_gap(part, at, parameters) * by_area + kept),
        slip,
        trial: vector_at(part.nodes.values.values(&TRIAL_TRACTION, 0), at),
        tangent: vector_at(part.nodes.values.values(&TANGENT_XI, 0), at),
        stiffness,
        friction: parameters.friction_law.bound_at(&part.nodes, at),
        scale_factor: parameters.scale_factor,
        tangent_factor: parameters.tangent_factor,
        resolution,
    }
}

/// Slip of a node in this step (length). Where surfaces give way, that of a node in contact without its elastic part:
/// (q − k P λ)/(κ ε), with the trial traction q.
pub(super) fn slip(part: &ModelPart, at: usize, multiplier: Multiplier, parameters: &StepParameters) -> [f64; 3] {
    let history = &part.nodes.history;
    let vector_of = |name: &str| history.get(name).map_or([0.0; 3], |field| field.vector(0, at));
    match multiplier {
        Multiplier::Vector(variable)
            if parameters.compliant && NodeState::of_flags(&part.nodes.flags, at).is_active() =>
        {
            let (normal, trial) = (normal(part, at), vector_at(part.nodes.values.values(&TRIAL_TRACTION, 0), at));
            let traction = scale(tangential(vector_of(variable.name()), normal), parameters.scale_factor);
            let elastic = parameters.tangent_factor * part.nodes.values.values(&INITIAL_PENALTY, 0)[at];
            along_free_tangents(scale(sub(trial, traction), elastic.recip()), normal, held_at(part, at))
        }
        _ => {
            let area = part.nodes.values.values(&NODAL_AREA, 0)[at];
            if area > 0.0 { scale(vector_of(WEIGHTED_SLIP.name()), area.recip()) } else { [0.0; 3] }
        }
    }
}

/// Weighted gap that the pressure of a node counts. Where a penalty counts weighted gaps each pair acts by its own, and
/// their mean is what the node bears.
fn counted_gap(part: &ModelPart, at: usize, parameters: &StepParameters) -> f64 {
    match parameters.weighted_penalty {
        true => part.nodes.values.values(&MEAN_WEIGHTED_GAP, 0)[at],
        false => part.nodes.history.values(&WEIGHTED_GAP, 0)[at],
    }
}

pub(super) fn vector_at(column: &[f64], at: usize) -> [f64; 3] {
    column.get(3 * at..3 * at + 3).map_or([0.0; 3], |v| [v[0], v[1], v[2]])
}

/// Writes k² A/c of the slave nodes, where rows of multipliers state tractions: the criteria measure them by it.
pub(super) fn weigh_multipliers(part: &mut ModelPart, slaves: &[u32], family: &Family, parameters: &StepParameters) {
    if !family.frictional() || !family.multiplier.is_unknown() {
        return;
    }
    let areas = part.nodes.values.values(&NODAL_AREA, 0);
    let penalties = part.nodes.values.values(&INITIAL_PENALTY, 0);
    let weight = |&n: &u32| {
        let (area, penalty) = (areas[n as usize], penalties[n as usize]);
        parameters.scale_factor.powi(2) * area / parameters.nodal_stiffness(penalty, area)
    };
    let weights: Vec<f64> = slaves.iter().map(weight).collect();
    let column = part.nodes.values.values_mut(&MULTIPLIER_WEIGHT, 0);
    slaves.iter().zip(weights).for_each(|(&n, weight)| column[n as usize] = weight);
}

/// What is too small to decide on at these interface nodes: `nodes` all of them, `slaves` those that may be in contact.
///
/// Tractions are known as well as a solve leaves multipliers, and as the round-off of displacements leaves forces.
pub(super) fn resolution(
    part: &ModelPart,
    nodes: &[u32],
    slaves: &[u32],
    family: &Family,
    parameters: &StepParameters,
) -> Resolution {
    let in_contact: Vec<u32> = slaves.iter().copied().filter(|&n| part.nodes.flags.is(ACTIVE, n as usize)).collect();
    let motion = farthest(nodes, |at| norm(sub(part.nodes.current[at], part.nodes.initial[at])));
    let history = &part.nodes.history;
    let traction = |at: usize| match family.multiplier {
        Multiplier::Body => norm(vector_at(part.nodes.values.values(&TRIAL_TRACTION, 0), at)),
        Multiplier::None => {
            let area = part.nodes.values.values(&NODAL_AREA, 0)[at];
            let by_area = if area > 0.0 && !parameters.weighted_penalty { area.recip() } else { 1.0 };
            let gap = counted_gap(part, at, parameters).min(0.0).abs();
            part.nodes.values.values(&INITIAL_PENALTY, 0)[at] * gap * by_area
        }
        Multiplier::Scalar(variable) => parameters.scale_factor * history.values(variable, 0)[at].abs(),
        Multiplier::Vector(variable) => {
            parameters.scale_factor * history.get(variable.name()).map_or(0.0, |field| norm(field.vector(0, at)))
        }
    };
    let mut found = Resolution::of(extent(part, nodes), farthest(&in_contact, traction), parameters.stiffness * motion);
    if matches!(family.multiplier, Multiplier::Body) {
        // Where points decide, a length makes a pressure.
        found.traction += parameters.nitsche.factor * parameters.stiffness * found.length;
    }
    found
}

/// Lengths at these nodes up to this are none.
pub(super) fn resolved_length(part: &ModelPart, nodes: &[u32]) -> f64 {
    Resolution::of(extent(part, nodes), 0.0, 0.0).length
}

fn extent(part: &ModelPart, nodes: &[u32]) -> f64 {
    farthest(nodes, |at| norm(part.nodes.current[at]).max(norm(part.nodes.initial[at])))
}

fn farthest(nodes: &[u32], reach: impl Fn(usize) -> f64) -> f64 {
    nodes.iter().map(|&n| reach(n as usize)).fold(0.0, f64::max)
}
