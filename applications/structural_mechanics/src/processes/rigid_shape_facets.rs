//! Facets of a rigid shape in the mesh: nodes, conditions and apexes, and what each condition knows of the exact surface.
//!
//! Conditions and nodes of a shape have consecutive ids. The part keeps the first of both, from which each rank and each stage finds again
//! which condition is which facet of the shape.

use zelus_core::diagnostics::Result;
use zelus_core::entities::require_kind;
use zelus_core::geometry::ExactFacet;
use zelus_core::model::{EntityRole, ModelPart, PropertyValue, RigidFacet, SubPart};

use super::nodal_conditions::add_conditions_to_mesh;
use crate::rigid_shapes::ShapeFacets;

/// Data of the part of a shape: ids of its first node and of its first condition.
const FIRST_NODE: &str = "RIGID_SHAPE_FIRST_NODE";
const FIRST_CONDITION: &str = "RIGID_SHAPE_FIRST_CONDITION";

/// Adds the facets of a shape, at their places in the model, as a new part; `facets` go round outwards.
pub(super) fn add_to_mesh(part: &mut ModelPart, path: &str, facets: &ShapeFacets) -> Result<()> {
    let space = part.info.domain_size;
    let (above, name) = path.rsplit_once('.').unwrap_or(("", path));
    let mut own = SubPart::new(name);
    let places = facets.points.iter().chain(&facets.apexes);
    own.nodes = places.map(|&x| part.add_node(x)).collect();
    let Some(&first) = own.nodes.first() else { return Ok(()) };
    // Loads bring the unknowns; there are none.
    let kind = require_kind(
        EntityRole::Condition,
        if space == 2 { "LineLoadCondition2D2N" } else { "SurfaceLoadCondition3D3N" },
    )?;
    let apexes = own.nodes[facets.points.len()..].to_vec();
    add_conditions_to_mesh(part, "PointLoadCondition", &apexes)?;
    let properties = part.properties.keys().next().copied().unwrap_or(0);
    let next = part.conditions.max_id() + 1;
    for (id, facet) in (next..).zip(&facets.facets) {
        let nodes = facet.points.map(|at| first + at);
        own.conditions.push(part.conditions.push(id, kind, properties, &nodes[..space]));
    }
    part.conditions.finish();
    let ids = [(FIRST_NODE, part.nodes.ids[first as usize]), (FIRST_CONDITION, next)];
    own.data.extend(ids.map(|(key, id)| (key.to_owned(), PropertyValue::Number(id as f64))));
    part.along(above, |parent| {
        parent.nodes.extend(&own.nodes);
        parent.conditions.extend(&own.conditions);
    });
    part.part_mut(above)?.children.insert(name.to_owned(), own);
    part.tree.normalise();
    Ok(())
}

/// Says of the conditions of a shape's part which facets of it they are; `local` are the facets in the axes of the shape.
pub(super) fn tell(part: &mut ModelPart, path: &str, local: &ShapeFacets) {
    let Ok(own) = part.part(path) else { return };
    let first = |key: &str| match own.data.get(key) {
        Some(PropertyValue::Number(id)) => Some(*id as usize),
        _ => None,
    };
    let (Some(first_node), Some(first_condition)) = (first(FIRST_NODE), first(FIRST_CONDITION)) else { return };
    let mut found = Vec::new();
    for &at in &own.conditions {
        let number = part.conditions.ids[at as usize].checked_sub(first_condition);
        let Some(facet) = number.and_then(|number| local.facets.get(number)) else { continue };
        let exact = facet.exact.and_then(|(surface, apex)| {
            let node = part.nodes.find(first_node + local.points.len() + apex as usize)?;
            let corners = facet.points.map(|at| local.points[at as usize]);
            Some((ExactFacet { surface, corners, apex: local.apexes[apex as usize] }, node))
        });
        found.push((at, RigidFacet { exact }));
    }
    part.rigid_facets.extend(found);
}
