//! The direction in which nodes slide, anew in every iteration, and how it turns.

use std::collections::BTreeMap;

use zelus_core::model::{ModelPart, variables::NORMAL};
use zelus_core::vector3::{add, cross, dot, norm, normalised, scale};

use super::activation;
use super::holding::held_at;
use super::step_parameters::StepParameters;
use crate::active_set::{SlipRule, TURNED};
use crate::formulations::held::along_free_tangents;
use crate::formulations::{Augmentation, NodeState, Turning};
use crate::mortar::{tangent, tangential};
use crate::pairs::{Family, Multiplier};
use crate::resolution::Resolution;
use crate::variables::{
    INITIAL_PENALTY, NODAL_AREA, TANGENT_ETA, TANGENT_XI, TRIAL_TRACTION, TURNING_BY_MULTIPLIER, TURNING_BY_SLIP,
};

/// Times in a step that a node which always slides may turn back.
const MOST_REVERSALS: usize = 4;
/// Length of the free part of a unit tangent below which a node cannot slide.
const LEAST_FREE: f64 = 1e-3;

/// Writes TANGENT_XI and TANGENT_ETA of the slave nodes, and how TANGENT_XI turns.
///
/// The direction is that of the tangential multiplier of an active node. Where contact always slides it is that of the
/// weighted slip. For sliding nodes in space, whose direction is more than a sign, and without multipliers it is that of the
/// trial traction. A node that has none of them above round-off keeps the direction it had: at step start that is a far
/// better guess than any fixed tangent; so does one that always slides and turned back [`MOST_REVERSALS`] times in the step
/// (`reversals` counts them): it stands still, and friction of either sign moves it the other way. In the plane sliding nodes
/// keep theirs, where `keeps_direction`. `pair_counts` holds the number of overlapping pairs of every node.
pub(super) fn write_tangents(
    part: &mut ModelPart,
    slaves: &[u32],
    family: &Family,
    parameters: &StepParameters,
    resolution: Resolution,
    pair_counts: &[u32],
    keeps_direction: bool,
    reversals: &mut BTreeMap<u32, usize>,
) {
    let dimension = part.info.domain_size;
    let pure = parameters.slip_rule == SlipRule::Pure;
    let old = part.nodes.values.values(&TANGENT_XI, 0);
    let before = |at: usize| old.get(3 * at..3 * at + 3).map_or([0.0; 3], |t| [t[0], t[1], t[2]]);
    let mut tangents = Vec::with_capacity(slaves.len());
    let mut turnings = vec![Turning::default(); slaves.len()];
    for (position, &node) in slaves.iter().enumerate() {
        let at = node as usize;
        let history = &part.nodes.history;
        let vector_of = |name: &str| history.get(name).map_or([0.0; 3], |field| field.vector(0, at));
        let state = NodeState::of_flags(&part.nodes.flags, at);
        let normal = vector_of(NORMAL.name());
        let by_slip = || {
            let area = part.nodes.values.values(&NODAL_AREA, 0)[at];
            let slip = resolution.vector_of(activation::slip(part, at, family.multiplier, parameters));
            // Bodies that stand still keep the direction in which they came.
            let penalty = part.nodes.values.values(&INITIAL_PENALTY, 0)[at];
            let pressure = match family.multiplier {
                Multiplier::Vector(variable) => parameters.scale_factor * dot(vector_of(variable.name()), normal),
                _ => 0.0,
            };
            let least = TURNED * parameters.friction_law.bound_at(&part.nodes, at).at(pressure);
            if parameters.nodal_stiffness(penalty, area) * norm(slip) > least { slip } else { [0.0; 3] }
        };
        let decided =
            |traction: [f64; 3]| if resolution.exceeds(norm(traction), 0.0, false) { traction } else { [0.0; 3] };
        let held = held_at(part, at);
        let direction = match family.multiplier {
            Multiplier::Vector(variable) => {
                let whole = vector_of(variable.name());
                let sliding = along_free_tangents(tangential(whole, normal), normal, held);
                let multiplier = add(scale(normal, dot(whole, normal)), sliding);
                match state {
                    NodeState::Slip if dimension == 3 => {
                        let trial = Trial::new(part, at, family.multiplier, parameters, multiplier, normal);
                        turnings[position] = trial.turning(pair_counts[at], pure, parameters);
                        if pure { by_slip() } else { decided(trial.traction) }
                    }
                    NodeState::Inactive if !pure => [0.0; 3],
                    // The multiplier of an iterate lags behind the normal, which may have turned by more than friction does.
                    NodeState::Slip if !pure && keeps_direction => [0.0; 3],
                    NodeState::Stick | NodeState::Slip if !pure => {
                        decided(scale(tangential(multiplier, normal), parameters.scale_factor))
                    }
                    _ => by_slip(),
                }
            }
            Multiplier::None if !pure => {
                let trial = decided(activation::vector_at(part.nodes.values.values(&TRIAL_TRACTION, 0), at));
                if state == NodeState::Slip && dimension == 3 && trial != [0.0; 3] {
                    turnings[position].by_slip = norm(trial).recip();
                }
                trial
            }
            _ => by_slip(),
        };
        let mut kept = norm(tangential(direction, normal)) <= f64::EPSILON * norm(direction);
        if pure && !kept && dot(direction, before(at)) < 0.0 {
            let count = reversals.entry(node).or_default();
            *count += 1;
            kept = *count > MOST_REVERSALS;
        }
        let any = tangent(if kept { before(at) } else { direction }, normal, dimension);
        let free = along_free_tangents(any, normal, held);
        tangents.push(if norm(free) > LEAST_FREE { normalised(free) } else { any });
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
    if dimension == 3 {
        let column = part.nodes.values.values_mut(&TURNING_BY_SLIP, 0);
        slaves.iter().zip(&turnings).for_each(|(&node, turning)| column[node as usize] = turning.by_slip);
        let column = part.nodes.values.values_mut(&TURNING_BY_MULTIPLIER, 0);
        slaves.iter().zip(&turnings).for_each(|(&node, turning)| column[node as usize] = turning.by_multiplier);
    }
}

/// Trial traction q̂ = k P λ + κ c s of a node with slip s, and what bounds it.
struct Trial {
    traction: [f64; 3],
    of_slip: [f64; 3],
    bound: f64,
}

impl Trial {
    fn new(
        part: &ModelPart,
        at: usize,
        kind: Multiplier,
        parameters: &StepParameters,
        multiplier: [f64; 3],
        normal: [f64; 3],
    ) -> Self {
        let slip = activation::slip(part, at, kind, parameters);
        let area = part.nodes.values.values(&NODAL_AREA, 0)[at];
        let penalty = part.nodes.values.values(&INITIAL_PENALTY, 0)[at];
        let of_slip = scale(slip, parameters.tangent_factor * parameters.nodal_stiffness(penalty, area));
        let pressure = parameters.scale_factor * dot(multiplier, normal);
        Self {
            traction: add(scale(tangential(multiplier, normal), parameters.scale_factor), of_slip),
            of_slip,
            bound: parameters.friction_law.bound_at(&part.nodes, at).at(pressure),
        }
    }

    /// Trial tractions within the bound belong to nodes about to stick; there the direction turns as at the bound.
    fn turning(&self, pairs: u32, pure: bool, parameters: &StepParameters) -> Turning {
        let size = norm(if pure { self.of_slip } else { self.traction }).max(self.bound);
        if size <= 0.0 || self.bound <= 0.0 {
            return Turning::default();
        }
        // Where pairs augment, each states the law for the whole area.
        let times = if parameters.augmentation == Augmentation::Pair { f64::from(pairs.max(1)) } else { 1.0 };
        Turning {
            by_slip: times * parameters.tangent_factor * self.bound / size,
            by_multiplier: if pure { 0.0 } else { parameters.scale_factor / size },
        }
    }
}
