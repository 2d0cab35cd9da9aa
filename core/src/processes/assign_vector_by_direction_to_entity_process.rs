//! Gives conditions, elements or nodes a vector of data by modulus and direction.

use super::assign_to_entities::{AssignToEntities, Container, EntityComponent};
use super::direction::{Direction, modulus};
use super::local_axes::LocalAxes;
use super::process::{Process, ProcessRequest};
use super::target::{Target, vector_variable};
use crate::diagnostics::Result;
use crate::parameters::Settings;
use crate::processes::ProcessEntry;
use crate::register;

/// Shorter directions count as zero.
const SMALLEST: f64 = 1e-6;

fn build(
    request: &mut ProcessRequest<'_>,
    containers: fn(&Settings) -> Result<Vec<Container>>,
) -> Result<Box<dyn Process>> {
    let settings = &request
        .settings_with(|defaults| defaults.require(&["model_part_name", "variable_name", "modulus", "direction"]))?;
    let containers = containers(settings)?;
    let target = Target::new(settings, request.model)?;
    let direction = Direction::from_node(settings.get("direction")?, 3, SMALLEST)?;
    let values = direction.components(&modulus(settings)?, &target, request.model, SMALLEST)?;
    let pairs = vector_variable(settings)?.into_iter().zip(values);
    let components = pairs.map(|(variable, value)| EntityComponent { variable, value }).collect();
    let axes = LocalAxes::from_settings(settings)?;
    Ok(Box::new(AssignToEntities { target, containers, components, axes }))
}

register! { ProcessEntry "assign_vector_by_direction_to_entity_process",
    aliases: &["AssignVectorByDirectionToEntityProcess"],
    about: "gives the listed kinds of entities of a part a vector value by modulus and direction",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_vector_by_direction_to_entity_process.json")),
    build: |request| build(request, Container::list),
}

register! { ProcessEntry "assign_vector_by_direction_to_condition_process",
    aliases: &["AssignVectorByDirectionToConditionProcess"],
    about: "gives the conditions of a part a vector value by modulus and direction",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_vector_by_direction_to_condition_process.json")),
    build: |request| build(request, |_| Ok(vec![Container::Conditions])),
}

register! { ProcessEntry "assign_vector_by_direction_to_node_process",
    aliases: &["AssignVectorByDirectionToNodeProcess"],
    about: "gives the nodes of a part a vector value without history by modulus and direction",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_vector_by_direction_to_node_process.json")),
    build: |request| build(request, |_| Ok(vec![Container::Nodes])),
}

register! { ProcessEntry "assign_vector_by_direction_to_element_process",
    aliases: &["AssignVectorByDirectionToElementProcess"],
    about: "gives the elements of a part a vector value by modulus and direction",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_vector_by_direction_to_element_process.json")),
    build: |request| build(request, |_| Ok(vec![Container::Elements])),
}
