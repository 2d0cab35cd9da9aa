//! Friction at the nodes: coefficients of a run, stick at step start, the direction of sliding in every iteration.

use std::collections::BTreeMap;

use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::flags::SLIP;
use zelus_core::model::{ModelPart, variables::NORMAL};
use zelus_core::vector3::{cross, dot, norm, scale};

use crate::active_set::SlipRule;
use crate::formulations::NodeState;
use crate::interface::Interface;
use crate::mortar::{tangent, tangential};
use crate::pairs::{Family, Friction, Multiplier};
use crate::variables::{FRICTION_COEFFICIENT, NODAL_AREA, NODAL_H, TANGENT_ETA, TANGENT_XI, WEIGHTED_SLIP};

/// Slip, in mesh sizes, below which its direction says nothing.
const LEAST_SLIP: f64 = 1e-6;

/// What a deck chooses about friction.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FrictionSettings {
    /// Coefficient by key of the pair, for surfaces whose properties have none.
    pub coefficients: BTreeMap<String, f64>,
    /// Weight of the slip in the trial traction of nodes that slide (`slip_augmentation_coefficient`).
    pub slip_augmentation: f64,
    /// Relative margin below the bound at which a sliding node sticks again (`slip_threshold`).
    pub slip_threshold: f64,
    /// Every so many steps all nodes start in stick; `None` for never (`slip_step_reset_frequency`).
    pub reset_frequency: Option<usize>,
}

/// Writes FRICTION_COEFFICIENT, the mean over the facets of a node, and says how stick and slip are told apart.
/// Without a coefficient anywhere, contact always slides.
pub(super) fn prepare(
    part: &mut ModelPart,
    interfaces: &[Interface],
    settings: &FrictionSettings,
    friction: Friction,
) -> SlipRule {
    let mut sums = vec![(0.0, 0_usize); part.nodes.len()];
    let mut largest = 0.0_f64;
    for interface in interfaces {
        let given = settings.coefficients.get(&interface.key).copied().unwrap_or(0.0);
        for facet in &interface.facets {
            let own = part.properties.get(&facet.properties).and_then(|p| p.number(FRICTION_COEFFICIENT.name()));
            let coefficient = own.unwrap_or(given);
            largest = largest.max(coefficient);
            for &node in &facet.nodes {
                let (sum, count) = &mut sums[node as usize];
                *sum += coefficient;
                *count += 1;
            }
        }
    }
    let column = part.nodes.values.values_mut(&FRICTION_COEFFICIENT, 0);
    for (slot, (sum, count)) in column.iter_mut().zip(sums) {
        *slot = sum / count.max(1) as f64;
    }
    if friction == Friction::PureSlip || largest < f64::EPSILON {
        SlipRule::Pure
    } else {
        SlipRule::Coulomb { augmentation: settings.slip_augmentation, threshold: settings.slip_threshold }
    }
}

/// Step start: every so many steps the nodes with friction begin in stick.
pub(super) fn start_in_stick(part: &mut ModelPart, slaves: &[u32], rule: SlipRule, frequency: Option<usize>) {
    if rule == SlipRule::Pure || frequency.is_none_or(|f| !part.info.step.is_multiple_of(f)) {
        return;
    }
    for &node in slaves {
        let smooth = part.nodes.values.values(&FRICTION_COEFFICIENT, 0)[node as usize] < f64::EPSILON;
        part.nodes.flags.set(SLIP, node as usize, smooth);
    }
}

/// Writes TANGENT_XI of the slave nodes.
///
/// The direction is that of the tangential multiplier of an active node. Where contact always slides, without multipliers,
/// and for sliding nodes in space, whose direction is more than a sign, it is that of the weighted slip. A node that has neither above round-off keeps the direction it had: at step
/// start that is a far better guess than any fixed tangent.
pub(super) fn write_tangents(part: &mut ModelPart, slaves: &[u32], family: &Family, rule: SlipRule) {
    let dimension = part.info.domain_size;
    let old = part.nodes.values.values(&TANGENT_XI, 0);
    let before = |at: usize| old.get(3 * at..3 * at + 3).map_or([0.0; 3], |t| [t[0], t[1], t[2]]);
    let mut tangents = Vec::with_capacity(slaves.len());
    for &node in slaves {
        let at = node as usize;
        let history = &part.nodes.history;
        let vector_of = |name: &str| history.get(name).map_or([0.0; 3], |field| field.vector(0, at));
        let by_slip = || {
            let (area, size) =
                (part.nodes.values.values(&NODAL_AREA, 0)[at], part.nodes.values.values(&NODAL_H, 0)[at]);
            let slip = vector_of(WEIGHTED_SLIP.name());
            if norm(slip) > f64::EPSILON * size * area { scale(slip, area.recip()) } else { [0.0; 3] }
        };
        let direction = match family.multiplier {
            Multiplier::Vector(variable) if rule != SlipRule::Pure => {
                let multiplier = vector_of(variable.name());
                match NodeState::of_flags(&part.nodes.flags, at) {
                    NodeState::Inactive => [0.0; 3],
                    NodeState::Slip if dimension == 3 => {
                        Some(by_slip()).filter(|s| *s != [0.0; 3]).unwrap_or(multiplier)
                    }
                    NodeState::Stick | NodeState::Slip => multiplier,
                }
            }
            _ => by_slip(),
        };
        let normal = vector_of(NORMAL.name());
        let kept = norm(tangential(direction, normal)) <= f64::EPSILON * norm(direction);
        tangents.push(tangent(if kept { before(at) } else { direction }, normal, dimension));
    }
    let across: Vec<[f64; 3]> = {
        let normals = part.nodes.history.values(&NORMAL, 0);
        let normal = |n: u32| std::array::from_fn(|c| normals[3 * n as usize + c]);
        slaves.iter().zip(&tangents).map(|(&n, tangent)| cross(normal(n), *tangent)).collect()
    };
    for (variable, vectors) in [(&TANGENT_XI, &tangents), (&TANGENT_ETA, &across)] {
        let column = part.nodes.values.values_mut(variable, 0);
        for (&node, vector) in slaves.iter().zip(vectors) {
            column[3 * node as usize..3 * node as usize + 3].copy_from_slice(vector);
        }
    }
}

/// The warning that friction pushes sliding nodes along the slip of the accepted step: it took its direction from the first,
/// sticking iterate, and the normals have turned by more than the angle of friction since.
pub(super) fn warn_of_pushing(part: &ModelPart, slaves: &[u32], multiplier: Multiplier) -> Option<Diagnostic> {
    let Multiplier::Vector(variable) = multiplier else { return None };
    let vector_of = |name: &str, at: usize| part.nodes.history.get(name).map_or([0.0; 3], |f| f.vector(0, at));
    let friction = part.nodes.values.values(&FRICTION_COEFFICIENT, 0);
    let (areas, sizes) = (part.nodes.values.values(&NODAL_AREA, 0), part.nodes.values.values(&NODAL_H, 0));
    let pushed = |at: &usize| {
        let slip = vector_of(WEIGHTED_SLIP.name(), *at);
        let traction = tangential(vector_of(variable.name(), *at), vector_of(NORMAL.name(), *at));
        NodeState::of_flags(&part.nodes.flags, *at) == NodeState::Slip
            && friction[*at] >= f64::EPSILON
            && norm(slip) > LEAST_SLIP * sizes[*at] * areas[*at]
            && dot(slip, traction) < 0.0
    };
    let nodes: Vec<usize> = slaves.iter().map(|&n| n as usize).filter(pushed).map(|at| part.nodes.ids[at]).collect();
    let first = nodes.first()?;
    let fact = format!(
        "step {}: friction pushes {} sliding nodes along their motion, e.g. node {first}",
        part.info.step,
        nodes.len()
    );
    Some(
        Diagnostic::warning("friction-direction", fact)
            .remedy("shorten \"time_step\": the surfaces turn too far in it"),
    )
}
