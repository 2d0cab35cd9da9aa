//! Smallest lengths and tractions that decide on contact, as a solve in the present state resolves them.

use zelus_core::model::ModelPart;
use zelus_core::vector3::{norm, sub};

use crate::interface::SlaveIndex;
use crate::law::StepParameters;
use crate::pairs::{Formulation, Multiplier};
use crate::slave_nodes::{SlaveState, SlaveStates};
use crate::tolerances::Tolerances;

/// Smallest lengths and tractions that decide at the `nodes` of the interfaces.
///
/// Tractions are known as well as a solve leaves multipliers, and as the round-off of displacements leaves forces.
pub(crate) fn tolerances(
    part: &ModelPart,
    nodes: &[u32],
    states: &SlaveStates,
    formulation: &Formulation,
    parameters: &StepParameters,
) -> Tolerances {
    let motion = farthest(nodes, |at| norm(sub(part.nodes.current[at], part.nodes.initial[at])));
    let traction = |slave: SlaveIndex, state: &SlaveState| match formulation.multiplier {
        Multiplier::Body => norm(state.law.trial),
        Multiplier::None => {
            let by_area = if state.kinematics.area > 0.0 && !parameters.weighted_penalty {
                state.kinematics.area.recip()
            } else {
                1.0
            };
            state.parameters.penalty * state.counted_gap(parameters).min(0.0).abs() * by_area
        }
        multiplier => parameters.scale_factor * norm(multiplier.value(&part.slave_nodes, states.owner(slave))),
    };
    let in_contact = states.iter().filter(|(_, state)| state.law.active);
    let largest = in_contact.map(|(slave, state)| traction(slave, state)).fold(0.0, f64::max);
    let mut found = Tolerances::of(extent(part, nodes), largest, parameters.stiffness * motion);
    if matches!(formulation.multiplier, Multiplier::Body) {
        // Where points decide, a length makes a pressure.
        found.traction += parameters.nitsche.factor * parameters.stiffness * found.length;
    }
    found
}

/// Lengths at these nodes up to this are none.
pub(crate) fn length_tolerance(part: &ModelPart, nodes: &[u32]) -> f64 {
    Tolerances::of(extent(part, nodes), 0.0, 0.0).length
}

fn extent(part: &ModelPart, nodes: &[u32]) -> f64 {
    farthest(nodes, |at| norm(part.nodes.current[at]).max(norm(part.nodes.initial[at])))
}

fn farthest(nodes: &[u32], reach: impl Fn(usize) -> f64) -> f64 {
    nodes.iter().map(|&n| reach(n as usize)).fold(0.0, f64::max)
}
