//! Slip of a slave node in a step.

use zelus_core::model::ModelPart;
use zelus_core::vector3::{scale, sub};

use crate::interface::SlaveIndex;
use crate::law::constrained_multiplier::along_free_tangents;
use crate::law::{Multiplier, StepParameters};
use crate::mortar::tangential;
use crate::slave_nodes::SlaveStates;

/// Slip of a node in this step (length). In the regularised methods the slip of a node in contact is without its elastic part: (q − k P
/// λ)/(κ ε), with the trial traction q.
pub(crate) fn slip(
    part: &ModelPart,
    states: &SlaveStates,
    slave: SlaveIndex,
    multiplier: Multiplier,
    parameters: &StepParameters,
) -> [f64; 3] {
    let state = &states[slave];
    match multiplier {
        Multiplier::Vector(_) if parameters.regularised && state.law.active => {
            let whole = multiplier.value(&part.slave_nodes, states.owner(slave));
            let traction = scale(tangential(whole, state.kinematics.normal), parameters.scale_factor);
            let elastic = parameters.tangent_factor * state.parameters.penalty;
            along_free_tangents(
                scale(sub(state.law.trial, traction), elastic.recip()),
                state.kinematics.normal,
                state.law.constraints,
            )
        }
        _ if state.kinematics.area > 0.0 => scale(state.kinematics.weighted_slip, state.kinematics.area.recip()),
        _ => [0.0; 3],
    }
}
