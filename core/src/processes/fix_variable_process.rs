//! Fixes unknowns on the nodes of a part during each step and leaves their values as they are.

use super::assign_to_nodes::{AssignToNodes, NodalComponent};
use super::assign_vector_variable_process::constrained;
use super::process::{Process, ProcessRequest};
use super::target::{Target, scalar_variable, vector_variable};
use crate::diagnostics::Result;
use crate::model::ScalarVariable;
use crate::parameters::Settings;
use crate::processes::ProcessEntry;
use crate::register;

fn settings(request: &mut ProcessRequest<'_>) -> Result<Settings> {
    request.settings_with(|defaults| defaults.require(&["model_part_name", "variable_name"]))
}

fn fix(target: Target, wanted: impl Iterator<Item = (ScalarVariable, bool)>) -> Result<Box<dyn Process>> {
    let components = wanted.filter(|w| w.1).map(|(variable, fixed)| NodalComponent { variable, value: None, fixed });
    let mut worker = AssignToNodes::new(target, components.collect(), None);
    worker.before_loop = false;
    Ok(Box::new(worker))
}

fn build_scalar(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = settings(request)?;
    let wanted = (scalar_variable(&settings)?, settings.get_bool("constrained")?);
    fix(Target::new(&settings, request.model)?, std::iter::once(wanted))
}

fn build_vector(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = settings(request)?;
    let wanted = vector_variable(&settings)?.into_iter().zip(constrained(&settings)?);
    fix(Target::new(&settings, request.model)?, wanted)
}

register! { ProcessEntry "fix_scalar_variable_process",
    aliases: &["FixScalarVariableProcess"],
    about: "fixes a scalar variable or a component on the nodes of a part at its present value",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/fix_scalar_variable_process.json")),
    build: build_scalar,
}

register! { ProcessEntry "fix_vector_variable_process",
    aliases: &["FixVectorVariableProcess"],
    about: "fixes components of a vector variable on the nodes of a part at their present values",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/fix_vector_variable_process.json")),
    build: build_vector,
}
