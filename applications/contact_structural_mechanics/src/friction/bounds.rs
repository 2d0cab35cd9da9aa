//! Stick at the start of steps, and tractions of accepted steps against their bounds.

use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::{ModelPart, SlaveNodes};
use zelus_core::vector3::{add, dot, norm, scale};

use super::coefficients::FrictionSettings;
use super::step_slip::slip;
use crate::interface::SlaveIndex;
use crate::law::{Multiplier, NodeState, SlipRule, StepParameters};
use crate::mortar::tangential;
use crate::slave_nodes::{SlaveState, SlaveStates};
use crate::variables::NODAL_H;

/// Slip, in mesh sizes, below which its direction says nothing.
const LEAST_SLIP: f64 = 1e-6;

/// Step start: every so many steps the nodes with friction begin in stick.
pub(crate) fn start_in_stick(step: usize, states: &mut SlaveStates, rule: SlipRule, settings: &FrictionSettings) {
    if rule != SlipRule::Pure && settings.reset_frequency.is_some_and(|frequency| step.is_multiple_of(frequency)) {
        states.for_each(|_, state| state.law.slides = Some(state.parameters.friction.is_smooth()));
    }
}

/// Puts the tractions of sliding nodes exactly at their bound: tolerances leave a little more or less, which is much where
/// the pressure is small.
pub(crate) fn meet_bounds(
    slave_nodes: &mut SlaveNodes,
    states: &SlaveStates,
    multiplier: Multiplier,
    parameters: &StepParameters,
) {
    let (scale_factor, ellipse) = (parameters.scale_factor, parameters.ellipse);
    if !matches!(multiplier, Multiplier::Vector(_)) {
        return;
    }
    for (slave, state) in states.iter().filter(|(_, state)| state.contact() == NodeState::Slip) {
        let whole = multiplier.value(slave_nodes, states.owner(slave));
        let (pressure, along) = (dot(whole, state.kinematics.normal), tangential(whole, state.kinematics.normal));
        let limit = state.parameters.friction.at(scale_factor * pressure).max(0.0) / scale_factor;
        let size = norm(ellipse.inverse_root(along, state.kinematics.normal));
        if size > 0.0 {
            let met = add(scale(state.kinematics.normal, pressure), scale(along, limit / size));
            multiplier.set(slave_nodes, states.owner(slave), met);
        }
    }
}

/// The warning that friction pushes sliding nodes along the slip of the accepted step, as where no contact states fulfil all
/// conditions.
pub(crate) fn warn_of_pushing(
    part: &ModelPart,
    states: &SlaveStates,
    multiplier: Multiplier,
    parameters: &StepParameters,
) -> Option<Diagnostic> {
    if !matches!(multiplier, Multiplier::Vector(_)) {
        return None;
    }
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let pushed = |(slave, state): &(SlaveIndex, &SlaveState)| {
        let slip = slip(part, states, *slave, multiplier, parameters);
        let traction = tangential(multiplier.value(&part.slave_nodes, states.owner(*slave)), state.kinematics.normal);
        state.contact() == NodeState::Slip
            && !state.parameters.friction.is_smooth()
            && norm(slip) > LEAST_SLIP * sizes[states.mesh_node(*slave) as usize]
            && dot(slip, traction) < 0.0
    };
    let nodes: Vec<usize> =
        states.iter().filter(pushed).map(|(slave, _)| part.nodes.ids[states.mesh_node(slave) as usize]).collect();
    let first = nodes.first()?;
    let fact = format!(
        "step {}: friction pushes {} sliding nodes along their motion, e.g. node {first}",
        part.info.step,
        nodes.len()
    );
    Some(Diagnostic::warning("friction-direction", fact).remedy(
        "look at the nodes named: their tractions are wrong; a finer mesh or another \"time_step\" may avoid it",
    ))
}
