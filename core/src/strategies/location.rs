//! Where nodes and elements are, as messages name them.

use zelus_linear_algebra::parallel;

use crate::diagnostics::{coordinates, counted};
use crate::geometry::mapping::is_inverted;
use crate::model::{ModelPart, SubPart};

/// Place of a node in the initial mesh and the smallest part with elements that holds it: " at (x, y, z) of part Body".
pub(crate) fn location(part: &ModelPart, node: u32) -> String {
    let place = coordinates(part.nodes.initial[node as usize]);
    let of = body_of(&part.tree, node).map_or(String::new(), |name| format!(" of part {name}"));
    format!(" at {place}{of}")
}

/// The smallest part with elements that holds a node.
pub(crate) fn body_of(part: &SubPart, node: u32) -> Option<&str> {
    let holds = |part: &&SubPart| !part.elements.is_empty() && part.nodes.binary_search(&node).is_ok();
    let smallest = part.children.values().filter(holds).min_by_key(|part| part.nodes.len())?;
    body_of(smallest, node).or(Some(&smallest.name))
}

/// A body in words, by the id of its first node: its smallest part and that node; `None` on ranks that do not own the node.
pub(crate) fn body_in_words(part: &ModelPart, first: usize) -> Option<String> {
    let node = part.nodes.find(first).filter(|&node| part.owns_node(node as usize))?;
    Some(match body_of(&part.tree, node) {
        Some(name) => format!("the body of part {name} with node {first}"),
        None => format!("the body of node {first}"),
    })
}

/// The elements that are inside out in the present configuration, in words; collective.
pub(super) fn inside_out(part: &ModelPart) -> Option<String> {
    let (elements, space) = (&part.elements, part.info.domain_size);
    let is_so = |at: usize| {
        elements.kinds[at].cell.filter(|shape| shape.dim() == space).is_some_and(|shape| {
            let nodes = elements.nodes(at as u32).iter();
            let places: Vec<[f64; 3]> = nodes.map(|&node| part.nodes.current[node as usize]).collect();
            is_inverted(shape, space, &places)
        })
    };
    let found: Vec<u32> = parallel::select(elements.len(), 1024, is_so);
    let said = found.first().map(|&at| {
        let (kind, id, node) = (elements.kinds[at as usize].name, elements.ids[at as usize], elements.nodes(at)[0]);
        let elements = counted(found.len(), "element is", "elements are");
        format!("{elements} inside out, the first is {kind} {id}{}", location(part, node))
    });
    part.ranks.first_to_say(said)
}
