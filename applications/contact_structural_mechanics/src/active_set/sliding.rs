//! The direction in which nodes slide, anew in every iteration, and how it turns.

use std::collections::BTreeMap;

use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, norm, normalised, scale};

use super::decision::Rules;
use crate::friction::slip;
use crate::interface::SlaveIndex;
use crate::law::constrained_multiplier::along_free_tangents;
use crate::law::{Augmentation, DirectionRotation, NodeState, SlipRule, StepParameters, TURNED};
use crate::mortar::{tangent, tangential};
use crate::pairs::Multiplier;
use crate::slave_nodes::{SlaveState, SlaveStates};

/// Times in a step that a node which always slides may turn back.
const MOST_REVERSALS: usize = 4;
/// Length of the free part of a unit tangent below which a node cannot slide.
const LEAST_FREE: f64 = 1e-3;

/// Finds the tangents of the slave nodes, and how they turn.
///
/// Directions are those in the plane in which the limit of friction is a circle. The direction is that of the tangential multiplier of
/// an active node. Where contact always slides it is that of the weighted slip. For sliding nodes in space, whose direction is more than
/// a sign, and without multipliers it is that of the
/// trial traction. A node that has none of them above round-off keeps the direction it had: at step start that is a far
/// better guess than any fixed tangent; so does one that always slides and turned back [`MOST_REVERSALS`] times in the step
/// (`reversals` counts them): it stands still, and friction of either sign moves it the other way. In the plane sliding nodes
/// keep theirs, where `keeps_direction`.
pub(crate) fn find_tangents(
    part: &ModelPart,
    states: &mut SlaveStates,
    rules: Rules<'_>,
    keeps_direction: bool,
    reversals: &mut BTreeMap<SlaveIndex, usize>,
) {
    let Rules { formulation, parameters, tolerances } = rules;
    let dimension = part.info.domain_size;
    let pure = parameters.slip_rule == SlipRule::Pure;
    let decided = |traction: [f64; 3]| if tolerances.exceeds(norm(traction), 0.0, false) { traction } else { [0.0; 3] };
    for slave in states.slaves().iter().copied() {
        let state = &states[slave];
        let (contact, normal, before) = (state.contact(), state.kinematics.normal, state.law.tangent);
        let by_slip = || {
            let slip = tolerances.vector_of(slip(part, states, slave, formulation.multiplier, parameters));
            let slip = parameters.ellipse.root(slip, normal);
            // Bodies that stand still keep the direction in which they came.
            let pressure = match formulation.multiplier {
                Multiplier::Vector(_) => {
                    parameters.scale_factor
                        * dot(formulation.multiplier.value(&part.slave_nodes, states.owner(slave)), normal)
                }
                _ => 0.0,
            };
            let least = TURNED * state.parameters.friction.at(pressure);
            if parameters.nodal_stiffness(state.parameters.penalty, state.kinematics.area) * norm(slip) > least {
                slip
            } else {
                [0.0; 3]
            }
        };
        let mut rotation = DirectionRotation::default();
        let direction = match formulation.multiplier {
            Multiplier::Vector(_) => {
                let whole = formulation.multiplier.value(&part.slave_nodes, states.owner(slave));
                let sliding = along_free_tangents(tangential(whole, normal), normal, state.law.constraints);
                let multiplier = add(scale(normal, dot(whole, normal)), sliding);
                match contact {
                    NodeState::Slip if dimension == 3 => {
                        let slip = slip(part, states, slave, formulation.multiplier, parameters);
                        let trial = TrialTraction::new(state, slip, parameters, multiplier);
                        rotation = trial.rotation(state.kinematics.pairs, pure, parameters);
                        if pure { by_slip() } else { decided(trial.traction) }
                    }
                    NodeState::Inactive if !pure => [0.0; 3],
                    // The multiplier of an iterate lags behind the normal, which may have turned by more than friction does.
                    NodeState::Slip if !pure && keeps_direction => [0.0; 3],
                    NodeState::Stick | NodeState::Slip if !pure => {
                        let along = parameters.ellipse.inverse_root(tangential(multiplier, normal), normal);
                        decided(scale(along, parameters.scale_factor))
                    }
                    _ => by_slip(),
                }
            }
            Multiplier::None if !pure => {
                let trial = decided(state.law.trial);
                if contact == NodeState::Slip && dimension == 3 && trial != [0.0; 3] {
                    rotation.by_slip = norm(trial).recip();
                }
                trial
            }
            _ => by_slip(),
        };
        let mut kept = norm(tangential(direction, normal)) <= f64::EPSILON * norm(direction);
        if pure && !kept && dot(direction, before) < 0.0 {
            let count = reversals.entry(slave).or_default();
            *count += 1;
            kept = *count > MOST_REVERSALS;
        }
        let any = tangent(if kept { before } else { direction }, normal, dimension);
        let free = along_free_tangents(any, normal, state.law.constraints);
        let tangent = if norm(free) > LEAST_FREE { normalised(free) } else { any };
        (states[slave].law.tangent, states[slave].law.rotation) = (tangent, rotation);
    }
}

/// Trial traction q̂ = k P λ + κ c s of a node with slip s, in the plane in which the limit of friction is a circle, and its bound.
struct TrialTraction {
    traction: [f64; 3],
    of_slip: [f64; 3],
    bound: f64,
}

impl TrialTraction {
    fn new(state: &SlaveState, slip: [f64; 3], parameters: &StepParameters, multiplier: [f64; 3]) -> Self {
        let stiffness = parameters.nodal_stiffness(state.parameters.penalty, state.kinematics.area);
        let (normal, ellipse) = (state.kinematics.normal, parameters.ellipse);
        let of_slip = scale(ellipse.root(slip, normal), parameters.tangent_factor * stiffness);
        let pressure = parameters.scale_factor * dot(multiplier, normal);
        let of_multiplier = ellipse.inverse_root(tangential(multiplier, normal), normal);
        Self {
            traction: add(scale(of_multiplier, parameters.scale_factor), of_slip),
            of_slip,
            bound: state.parameters.friction.at(pressure),
        }
    }

    /// Trial tractions within the bound belong to nodes about to stick; there the direction turns as at the bound.
    fn rotation(&self, pairs: u32, pure: bool, parameters: &StepParameters) -> DirectionRotation {
        let size = norm(if pure { self.of_slip } else { self.traction }).max(self.bound);
        if size <= 0.0 || self.bound <= 0.0 {
            return DirectionRotation::default();
        }
        // Where pairs augment, each states the law for the whole area.
        let times = if parameters.augmentation == Augmentation::Pair { f64::from(pairs.max(1)) } else { 1.0 };
        DirectionRotation {
            by_slip: times * parameters.tangent_factor * self.bound / size,
            by_multiplier: if pure { 0.0 } else { parameters.scale_factor / size },
        }
    }
}
