//! Prescribes the displacement along a direction: n · u = value at the nodes of a part, free at right angles to n.
//!
//! With n given it is a roller or a symmetry plane, with the normal of the surface a support that lets it slide, with directions of a
//! cylinder or a sphere a cylindrical or spherical support. Directions are those of the initial geometry.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::ModelPart;
use zelus_core::parameters::Settings;
use zelus_core::processes::{DirectionalSupports, Process, ProcessEntry, ProcessRequest, ScalarValue, Target};
use zelus_core::register;
use zelus_core::vector3::{cross, dot, norm, scale, sub};

use super::outward_faces::{nodal_normals, outward_faces};
use crate::variables::DISPLACEMENT;

/// Shorter directions count as zero.
const SMALLEST: f64 = 1e-12;
/// Distance from an axis or a centre, over that of the farthest node, at which a node has no direction.
const AT_CENTRE: f64 = 1e-9;
/// Length of a sum of normals, over that of the largest, below which they cancel.
const CANCELLED: f64 = 1e-6;

/// Words for directions that depend on the node.
const WORDS: &str = "\"surface_normal\", \"radial\", \"tangential\", \"axial\" or \"spherical\"";

/// A direction as the deck gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Direction {
    Vector([f64; 3]),
    SurfaceNormal,
    Radial,
    Tangential,
    Axial,
    Spherical,
}

fn direction(settings: &Settings) -> Result<Direction> {
    let node = settings.get("direction")?;
    match node.as_str() {
        Some("surface_normal") => return Ok(Direction::SurfaceNormal),
        Some("radial") => return Ok(Direction::Radial),
        Some("tangential") => return Ok(Direction::Tangential),
        Some("axial") => return Ok(Direction::Axial),
        Some("spherical") => return Ok(Direction::Spherical),
        _ => {}
    }
    node.parse("direction").map(Direction::Vector).map_err(|_| {
        let fact = format!("a direction must be three numbers or a word, found {node}");
        let remedy = format!("write e.g. [0.6, 0.8, 0.0], {WORDS}");
        Diagnostic::error("invalid-direction", fact).at(node.place()).remedy(remedy).into()
    })
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = &request.settings_with(|defaults| defaults.require(&["model_part_name", "direction"]))?;
    let target = Target::new(settings, request.model)?;
    let value = match settings.get("value")? {
        node if node.is_null() => ScalarValue::Number(0.0),
        node => ScalarValue::from_node(node)?,
    };
    let part = request.model.root(&target.path)?;
    let nodes = target.selection(&part.tree)?.nodes.clone();
    if nodes.is_empty() {
        let fact = format!("{} has no nodes", target.path);
        let problem = Diagnostic::error("empty-part", fact).at(target.place.clone());
        return Err(problem.remedy("name a part with the nodes of the support").into());
    }
    let directions = directions(settings, direction(settings)?, &target, part, &nodes)?;
    Ok(Box::new(DirectionalSupports::new(target, DISPLACEMENT.name(), value, directions)))
}

/// The unit vector of each node.
fn directions(
    settings: &Settings,
    direction: Direction,
    target: &Target,
    part: &ModelPart,
    nodes: &[u32],
) -> Result<Vec<(u32, [f64; 3])>> {
    let planar = part.info.domain_size == 2;
    let flat = |v: [f64; 3]| if planar { [v[0], v[1], 0.0] } else { v };
    let origin: [f64; 3] = settings.get("origin")?.parse("origin")?;
    let arm = |node: u32| flat(sub(part.nodes.initial[node as usize], origin));
    match direction {
        Direction::Vector(vector) => {
            let unit = unit(settings, "direction", flat(vector))?;
            Ok(nodes.iter().map(|&node| (node, unit)).collect())
        }
        Direction::SurfaceNormal => surface_normals(target, part, nodes),
        Direction::Spherical => radial(settings, target, part, nodes, "centre", arm),
        Direction::Radial | Direction::Tangential | Direction::Axial => {
            let axis = unit(settings, "axis", settings.get("axis")?.parse("axis")?)?;
            if planar && (direction == Direction::Axial || norm(flat(axis)) > SMALLEST) {
                let (key, fact) = match direction {
                    Direction::Axial => ("direction", "a planar model has no displacement along the axis z"),
                    _ => ("axis", "the axis of a planar model is z"),
                };
                let problem = settings.error(key, "invalid-direction", fact);
                return Err(problem.remedy("write \"radial\" or \"tangential\", and leave \"axis\" out").into());
            }
            if direction == Direction::Axial {
                return Ok(nodes.iter().map(|&node| (node, axis)).collect());
            }
            let across = |node: u32| {
                let arm = arm(node);
                sub(arm, scale(axis, dot(arm, axis)))
            };
            let mut found = radial(settings, target, part, nodes, "axis", across)?;
            if direction == Direction::Tangential {
                found.iter_mut().for_each(|(_, direction)| *direction = cross(axis, *direction));
            }
            Ok(found)
        }
    }
}

/// A unit vector of the settings.
fn unit(settings: &Settings, key: &str, vector: [f64; 3]) -> Result<[f64; 3]> {
    let length = norm(vector);
    if length.is_finite() && length >= SMALLEST {
        return Ok(scale(vector, length.recip()));
    }
    let problem = settings.error(key, "invalid-direction", format!("\"{key}\" has no length"));
    Err(problem.remedy("write a vector that is not zero, in planar models with a part in the plane").into())
}

/// Unit vectors of the arms of nodes from an axis or a centre.
fn radial(
    settings: &Settings,
    target: &Target,
    part: &ModelPart,
    nodes: &[u32],
    from: &str,
    arm: impl Fn(u32) -> [f64; 3],
) -> Result<Vec<(u32, [f64; 3])>> {
    let farthest = nodes.iter().map(|&node| norm(arm(node))).fold(0.0, f64::max);
    let unit = |&node: &u32| {
        let arm = arm(node);
        let length = norm(arm);
        if length > AT_CENTRE * farthest {
            return Ok((node, scale(arm, length.recip())));
        }
        let id = part.nodes.ids[node as usize];
        let fact = format!("node {id} of {} lies on the {from}: it has no radial direction", target.path);
        let remedy =
            format!("take it out of the part, or correct \"{}\"", if from == "axis" { "axis" } else { "origin" });
        Err(settings.error("model_part_name", "invalid-direction", fact).remedy(remedy).into())
    };
    nodes.iter().map(unit).collect()
}

/// Unit normals of the surface at each node.
fn surface_normals(target: &Target, part: &ModelPart, nodes: &[u32]) -> Result<Vec<(u32, [f64; 3])>> {
    let faces = outward_faces(part, target.selection(&part.tree)?);
    let sums = nodal_normals(part, &faces);
    let largest = sums.values().map(|sum| norm(*sum)).fold(0.0, f64::max);
    let unit = |&node: &u32| match sums.get(&node).map(|sum| (sum, norm(*sum))) {
        Some((sum, length)) if length > CANCELLED * largest => Ok((node, scale(*sum, length.recip()))),
        found => {
            let id = part.nodes.ids[node as usize];
            let why = if found.is_some() { "its normals cancel" } else { "it belongs to no face of the part" };
            let fact = format!("node {id} of {} has no surface normal: {why}", target.path);
            let remedy = "name a part with the nodes or conditions of one smooth surface";
            Err(Diagnostic::error("invalid-direction", fact).at(target.place.clone()).remedy(remedy).into())
        }
    };
    nodes.iter().map(unit).collect()
}

register! { ProcessEntry "assign_displacement_along_direction_process",
    aliases: &["AssignDisplacementAlongDirectionProcess"],
    about: "prescribes the displacement of the nodes of a part along a direction: roller, symmetry plane, cylindrical or spherical support",
    source: "n · u = value; eqs. D.12a–e",
    common: &["model_part_name"],
    defaults: include_str!("../../../../configs/processes/assign_displacement_along_direction_process.json"),
    build: build,
}
