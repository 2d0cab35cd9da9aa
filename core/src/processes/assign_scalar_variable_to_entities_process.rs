//! Gives conditions, elements or nodes one number of data: a scalar variable or a component of a vector.

use super::assign_scalar_variable_process::optional_value;
use super::assign_to_entities::{AssignToEntities, Container, EntityComponent};
use super::face_direction;
use super::local_axes::LocalAxes;
use super::process::{Process, ProcessRequest};
use super::scalar_value::ScalarValue;
use super::target::{Target, scalar_variable};
use crate::diagnostics::Result;
use crate::parameters::Settings;
use crate::processes::ProcessEntry;
use crate::register;

fn build(
    request: &mut ProcessRequest<'_>,
    containers: fn(&Settings) -> Result<Vec<Container>>,
) -> Result<Box<dyn Process>> {
    let settings = &request.settings_with(|defaults| defaults.require(&["model_part_name", "variable_name"]))?;
    let containers = containers(settings)?;
    let components = vec![EntityComponent { variable: scalar_variable(settings)?, value: optional_value(settings)? }];
    let axes = LocalAxes::from_settings(settings)?;
    let assign = AssignToEntities { target: Target::new(settings, request.model)?, containers, components, axes };
    if assign.containers.contains(&Container::Conditions) {
        let part = request.model.root_mut(&assign.target.path)?;
        let conditions = assign.target.selection(&part.tree)?.conditions.clone();
        let EntityComponent { variable, value } = &assign.components[0];
        let constant = if let ScalarValue::Number(number) = value { Some(*number) } else { None };
        let said = face_direction::pulling(part, &conditions, *variable, constant);
        said.into_iter().for_each(|said| request.report.push(said.at(assign.target.place.clone())));
    }
    Ok(Box::new(assign))
}

register! { ProcessEntry "assign_scalar_variable_to_entities_process",
    aliases: &["AssignScalarVariableToEntitiesProcess"],
    about: "gives the listed kinds of entities of a part a scalar value",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_scalar_variable_to_entities_process.json")),
    build: |request| build(request, Container::list),
}

register! { ProcessEntry "assign_scalar_variable_to_conditions_process",
    aliases: &["AssignScalarVariableToConditionsProcess"],
    about: "gives the conditions of a part a scalar value, e.g. a pressure",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_scalar_variable_to_conditions_process.json")),
    build: |request| build(request, |_| Ok(vec![Container::Conditions])),
}

register! { ProcessEntry "assign_scalar_variable_to_elements_process",
    aliases: &["AssignScalarVariableToElementsProcess"],
    about: "gives the elements of a part a scalar value",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_scalar_variable_to_elements_process.json")),
    build: |request| build(request, |_| Ok(vec![Container::Elements])),
}

register! { ProcessEntry "assign_scalar_variable_to_nodes_process",
    aliases: &["AssignScalarVariableToNodesProcess"],
    about: "gives the nodes of a part a scalar value without history",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_scalar_variable_to_nodes_process.json")),
    build: |request| build(request, |_| Ok(vec![Container::Nodes])),
}
