//! Conditions at nodes that a process makes, one a node.

use std::ops::Range;

use zelus_core::diagnostics::Result;
use zelus_core::entities::require_kind;
use zelus_core::model::flags::NEW_ENTITY;
use zelus_core::model::{EntityRole, ModelPart};

/// Adds a condition at each of these nodes, which every rank has; gives their places among the conditions. `name` is that of the
/// kind without its suffix. Collective.
pub(super) fn add_conditions(part: &mut ModelPart, name: &str, nodes: &[u32]) -> Result<Range<usize>> {
    // All ranks make the same conditions, with the same ids.
    let largest = part.ranks.gather_numbers(&[part.conditions.max_id() as f64]).concat();
    let next = largest.into_iter().fold(0.0, f64::max) as usize + 1;
    let made = push_conditions(part, name, nodes, next)?;
    if let Some(share) = &mut part.share {
        let owners: Vec<u32> = nodes.iter().map(|&node| share.owners[node as usize]).collect();
        share.whole.conditions += owners.len();
        share.conditions.extend(owners);
    }
    Ok(made)
}

/// As [`add_conditions`], to a mesh that ranks do not share yet.
pub(super) fn add_conditions_to_mesh(part: &mut ModelPart, name: &str, nodes: &[u32]) -> Result<Range<usize>> {
    push_conditions(part, name, nodes, part.conditions.max_id() + 1)
}

fn push_conditions(part: &mut ModelPart, name: &str, nodes: &[u32], next: usize) -> Result<Range<usize>> {
    let kind = require_kind(EntityRole::Condition, &format!("{name}{}D1N", part.info.domain_size))?;
    let properties = part.properties.keys().next().copied().unwrap_or(0);
    let first = part.conditions.len();
    for (id, &node) in (next..).zip(nodes) {
        let made = part.conditions.push(id, kind, properties, &[node]);
        part.conditions.flags.set(NEW_ENTITY, made as usize, true);
    }
    part.conditions.finish();
    let made = first..part.conditions.len();
    part.tree.conditions.extend(made.start as u32..made.end as u32);
    part.tree.normalise();
    Ok(made)
}
