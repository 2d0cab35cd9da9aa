//! Prescribes a vector variable, given by modulus and direction, on the nodes of a part.
//!
//! In two dimensions only X and Y are set, and only they count for the length of the direction.

use super::assign_to_nodes::{AssignToNodes, NodalComponent};
use super::direction::{Direction, modulus};
use super::local_axes::LocalAxes;
use super::process::{Process, ProcessRequest};
use super::target::{Target, vector_variable};
use crate::diagnostics::Result;
use crate::processes::ProcessEntry;
use crate::register;

/// Shorter directions count as zero.
const SMALLEST: f64 = 1e-12;

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let required = ["model_part_name", "variable_name", "modulus", "direction"];
    let settings = &request.settings_with(|defaults| defaults.require(&required))?;
    let target = Target::new(settings, request.model)?;
    let dimensions = if request.model.root(&target.path)?.info.domain_size == 2 { 2 } else { 3 };
    let direction = Direction::from_node(settings.get("direction")?, dimensions, SMALLEST)?;
    let values = direction.components(&modulus(settings)?, &target, request.model, SMALLEST)?;
    let fixed = settings.get_bool("constrained")?;
    let pairs = vector_variable(settings)?.into_iter().zip(values).take(dimensions);
    let components = pairs.map(|(variable, value)| NodalComponent { variable, value: Some(value), fixed }).collect();
    Ok(Box::new(AssignToNodes::new(target, components, LocalAxes::from_settings(settings)?)))
}

register! { ProcessEntry "assign_vector_by_direction_process",
    aliases: &["AssignVectorByDirectionProcess"],
    about: "prescribes a vector variable by modulus and direction on the nodes of a part",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_vector_by_direction_process.json")),
    build: build,
}
