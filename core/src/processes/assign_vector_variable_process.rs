//! Prescribes components of a vector variable on the nodes of a part.

use super::assign_to_nodes::{AssignToNodes, NodalComponent};
use super::local_axes::LocalAxes;
use super::process::{Process, ProcessRequest};
use super::scalar_value::ScalarValue;
use super::target::{Target, vector_variable};
use crate::diagnostics::{Diagnostic, Result};
use crate::parameters::Settings;
use crate::processes::ProcessEntry;
use crate::register;

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings =
        &request.settings_with(|defaults| defaults.require(&["model_part_name", "variable_name", "value"]))?;
    let variables = vector_variable(settings)?;
    let values = component_values(settings)?;
    let fixed = constrained(settings)?;
    let component = |i: usize| {
        let (variable, fixed) = (variables[i], fixed[i]);
        values[i].clone().map(|value| NodalComponent { variable, value: Some(value), fixed })
    };
    let components = (0..3).filter_map(component).collect();
    let axes = LocalAxes::from_settings(settings)?;
    Ok(Box::new(AssignToNodes::new(Target::new(settings, request.model)?, components, axes)))
}

/// `"value"`: three values, of which `null` means that the component is left alone.
pub(super) fn component_values(settings: &Settings) -> Result<[Option<ScalarValue>; 3]> {
    let node = settings.get("value")?;
    let Some([x, y, z]) = node.as_array() else {
        let problem = settings.error("value", "wrong-type", format!("\"value\" must have three entries, found {node}"));
        return Err(problem.remedy("write e.g. [0.0, \"0.1*t\", null]; null leaves a component alone").into());
    };
    let read = |node: &crate::parameters::Node| (!node.is_null()).then(|| ScalarValue::from_node(node)).transpose();
    Ok([read(x)?, read(y)?, read(z)?])
}

/// `"constrained"`: one answer for all components, or three.
pub(super) fn constrained(settings: &Settings) -> Result<[bool; 3]> {
    let node = settings.get("constrained")?;
    if node.is_null() && !node.is_given() {
        return Ok([true; 3]);
    }
    if let Some(all) = node.as_bool() {
        return Ok([all; 3]);
    }
    let three = node.as_array().and_then(|items| match items {
        [x, y, z] => Some([x.as_bool()?, y.as_bool()?, z.as_bool()?]),
        _ => None,
    });
    let wrong = || {
        let fact = format!("\"constrained\" must be true, false or three of them, found {node}");
        Diagnostic::error("wrong-type", fact).at(node.place()).remedy("write e.g. [true, false, true]")
    };
    three.ok_or_else(|| wrong().into())
}

register! { ProcessEntry "assign_vector_variable_process",
    aliases: &["AssignVectorVariableProcess"],
    about: "prescribes components of a vector variable on the nodes of a part",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_vector_variable_process.json")),
    build: build,
}
