//! The surfaces of a deck that may touch each other, found in the settings of its processes.

use super::common::each_process;
use crate::model::ModelPart;
use crate::parameters::{Node, Value};

/// Nodes of the surfaces of one pair, both sides together.
///
/// With `whole_skin` they are all outer faces, whatever the lists say.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surface {
    /// Whether the surface is everything outside.
    pub whole_skin: bool,
    /// Node indices of both sides, ascending.
    pub nodes: Vec<u32>,
    /// Node indices of the side where pairs are evaluated, ascending; none when that is not known.
    pub slaves: Vec<u32>,
}

/// Settings that name surfaces by pair, as `{"0": ["Contact_Part"]}`.
const BY_PAIR: [&str; 2] = ["contact_model_part", "mesh_tying_model_part"];

/// Surfaces named by the processes of a stage, in the order of the deck.
///
/// Parts that the mesh does not have are left out: the process that names them says so.
pub fn surfaces(deck: &Node, part: &ModelPart) -> Vec<Surface> {
    let mut out = Vec::new();
    if let Some(lists) = deck.get("processes") {
        walk(lists, part, &mut out);
        // What is left out of the deck is the whole skin, as by default.
        each_process(lists, &mut |entry, parameters| {
            let named = |key: &&str| entry.defaults.contains(&format!("\"{key}\""));
            let given = |key: &&str| parameters.is_some_and(|parameters| parameters.get(key).is_some());
            if BY_PAIR.iter().any(named) && !BY_PAIR.iter().any(given) {
                out.push(Surface { whole_skin: true, ..Surface::default() });
            }
        });
    }
    out
}

fn walk(node: &Node, part: &ModelPart, out: &mut Vec<Surface>) {
    match &node.value {
        Value::Array(items) => items.iter().for_each(|item| walk(item, part, out)),
        Value::Object(members) => {
            for pairs in BY_PAIR.iter().filter_map(|key| members.get(key).and_then(Node::as_object)) {
                let before = out.len();
                let filled = |list: &Node| list.as_array().is_some_and(|names| !names.is_empty());
                for pair in pairs.iter().filter(|pair| filled(&pair.node)) {
                    let slaves = members.get("assume_master_slave").and_then(|slaves| slaves.get(&pair.key));
                    let slaves = slaves.map_or(Vec::new(), |names| nodes_of(&[names], part));
                    out.push(Surface { whole_skin: false, nodes: nodes_of(&[&pair.node], part), slaves });
                }
                if out.len() == before {
                    out.push(Surface { whole_skin: true, ..Surface::default() });
                }
            }
            if let (Some(origin), Some(destination)) =
                (members.get("origin_model_part_name"), members.get("destination_model_part_name"))
            {
                let slaves = nodes_of(&[destination], part);
                out.push(Surface { whole_skin: false, nodes: nodes_of(&[origin, destination], part), slaves });
            }
            members.iter().for_each(|member| walk(&member.node, part, out));
        }
        _ => {}
    }
}

/// Nodes of the parts that names or lists of names stand for, ascending.
fn nodes_of(names: &[&Node], part: &ModelPart) -> Vec<u32> {
    let mut out = Vec::new();
    for names in names {
        for name in names.as_array().unwrap_or(std::slice::from_ref(*names)).iter().filter_map(Node::as_str) {
            let Ok(found) = part.part(name) else { continue };
            out.extend(&found.nodes);
            for &condition in &found.conditions {
                out.extend(part.conditions.nodes(condition));
            }
        }
    }
    out.sort_unstable();
    out.dedup();
    out
}
