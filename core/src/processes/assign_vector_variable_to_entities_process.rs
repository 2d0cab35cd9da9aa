//! Gives conditions, elements or nodes a vector of data, component by component.

use super::assign_to_entities::{AssignToEntities, Container, EntityComponent};
use super::assign_vector_variable_process::component_values;
use super::local_axes::LocalAxes;
use super::process::{Process, ProcessRequest};
use super::target::{Target, vector_variable};
use crate::diagnostics::Result;
use crate::parameters::Settings;
use crate::processes::ProcessEntry;
use crate::register;

fn build(
    request: &mut ProcessRequest<'_>,
    containers: fn(&Settings) -> Result<Vec<Container>>,
) -> Result<Box<dyn Process>> {
    let settings =
        &request.settings_with(|defaults| defaults.require(&["model_part_name", "variable_name", "value"]))?;
    let containers = containers(settings)?;
    let pairs = vector_variable(settings)?.into_iter().zip(component_values(settings)?);
    let components = pairs.filter_map(|(variable, value)| Some(EntityComponent { variable, value: value? })).collect();
    let axes = LocalAxes::from_settings(settings)?;
    Ok(Box::new(AssignToEntities { target: Target::new(settings, request.model)?, containers, components, axes }))
}

register! { ProcessEntry "assign_vector_variable_to_entities_process",
    aliases: &["AssignVectorVariableToEntitiesProcess"],
    about: "gives the listed kinds of entities of a part a vector value",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_vector_variable_to_entities_process.json")),
    build: |request| build(request, Container::list),
}

register! { ProcessEntry "assign_vector_variable_to_conditions_process",
    aliases: &["AssignVectorVariableToConditionProcess", "AssignVectorVariableToConditionsProcess"],
    about: "gives the conditions of a part a vector value, e.g. a line load",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_vector_variable_to_conditions_process.json")),
    build: |request| build(request, |_| Ok(vec![Container::Conditions])),
}

register! { ProcessEntry "assign_vector_variable_to_nodes_process",
    aliases: &["AssignVectorVariableToNodesProcess"],
    about: "gives the nodes of a part a vector value without history",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_vector_variable_to_nodes_process.json")),
    build: |request| build(request, |_| Ok(vec![Container::Nodes])),
}

register! { ProcessEntry "assign_vector_variable_to_elements_process",
    aliases: &["AssignVectorVariableToElementsProcess"],
    about: "gives the elements of a part a vector value",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_vector_variable_to_elements_process.json")),
    build: |request| build(request, |_| Ok(vec![Container::Elements])),
}
