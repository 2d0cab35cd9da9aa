//! Prescribes a scalar variable, or one component of a vector, on the nodes of a part.

use super::assign_to_nodes::{AssignToNodes, NodalComponent};
use super::local_axes::LocalAxes;
use super::process::{Process, ProcessRequest};
use super::scalar_value::ScalarValue;
use super::target::{Target, scalar_variable};
use crate::diagnostics::Result;
use crate::parameters::Settings;
use crate::processes::ProcessEntry;
use crate::register;

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = &request.settings_with(|defaults| defaults.require(&["model_part_name", "variable_name"]))?;
    let component = NodalComponent {
        variable: scalar_variable(settings)?,
        value: Some(optional_value(settings)?),
        fixed: settings.get_bool("constrained")?,
    };
    let axes = LocalAxes::from_settings(settings)?;
    Ok(Box::new(AssignToNodes::new(Target::new(settings, request.model)?, vec![component], axes)))
}

/// `"value"`, which is zero when the deck does not give it.
pub(super) fn optional_value(settings: &Settings) -> Result<ScalarValue> {
    if settings.is_given("value") {
        ScalarValue::from_node(settings.get("value")?)
    } else {
        Ok(ScalarValue::Number(0.0))
    }
}

register! { ProcessEntry "assign_scalar_variable_process",
    aliases: &["AssignScalarVariableProcess"],
    about: "prescribes a scalar variable or a component on the nodes of a part",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_scalar_variable_process.json")),
    build: build,
}
