//! The nodes of a deck that every rank keeps: those that decisions between bodies depend on.

use super::faces::{faces, outer_and_shared};
use super::interfaces::Surface;
use super::listed_processes::each_process;
use crate::model::{EntityKind, ModelPart};
use crate::parameters::{Node, Value};
use crate::processes::ProcessEntry;

/// Marks the nodes of surfaces that may touch, of constraints, and of parts that processes of the deck need whole
/// ([`ProcessEntry::common`]); all nodes of a mesh of points and lines, and those of elements at one node.
pub fn common_nodes(part: &ModelPart, surfaces: &[Surface], deck: &Node) -> Vec<bool> {
    let has_area = |kind: &&EntityKind| kind.cell.is_some_and(|cell| cell.cell().dim > 1);
    let mut common = vec![!part.elements.kinds.iter().any(has_area); part.nodes.len()];
    let all = 0..part.nodes.len() as u32;
    let mut mark = |node: u32| common[node as usize] = true;
    surfaces.iter().flat_map(|surface| &surface.nodes).for_each(|&node| mark(node));
    if surfaces.iter().any(|surface| surface.whole_skin) {
        outer_and_shared(&faces(part)).0.iter().flat_map(|face| face.all(part)).for_each(&mut mark);
    }
    let is_point = |at: &usize| part.elements.kinds[*at].nodes() == 1;
    let points = (0..part.elements.len()).filter(is_point).flat_map(|at| part.elements.nodes(at as u32));
    points.for_each(|&node| mark(node));
    for constraint in &part.constraints {
        let masters = constraint.masters.iter().map(|((node, _), _)| *node);
        masters.chain([constraint.slave.0]).for_each(&mut mark);
    }
    let mut needed = |entry: &'static ProcessEntry, parameters: Option<&Node>| {
        for key in entry.common {
            match parameters.and_then(|parameters| parameters.get(key)) {
                Some(value) => whole(value, part, &mut mark),
                // A part that is not named is the root.
                None if key.contains("part") => all.clone().for_each(&mut mark),
                None => {}
            }
        }
    };
    if let Some(lists) = deck.get("processes") {
        each_process(lists, &mut needed);
    }
    common
}

/// Nodes of the parts that a setting names, or the node whose id it is.
fn whole(value: &Node, part: &ModelPart, mark: &mut impl FnMut(u32)) {
    match &value.value {
        Value::Array(items) => items.iter().for_each(|item| whole(item, part, mark)),
        Value::Object(members) => members.iter().for_each(|member| whole(&member.node, part, mark)),
        _ => match value.as_str() {
            Some(name) => part.part(name).iter().flat_map(|found| &found.nodes).for_each(|&node| mark(node)),
            None => value.as_f64().and_then(|id| part.nodes.find(id as usize)).into_iter().for_each(mark),
        },
    }
}
