//! Conditions that carry loads and lie on no outer face of a body.

use rustc_hash::FxHashMap;

use crate::diagnostics::{Diagnostic, Report, counted};
use crate::geometry::Facet;
use crate::model::ModelPart;

/// Warns of faces with loads whose nodes belong to bodies, but to no element in common, or to two: their loads act within or across
/// bodies.
///
/// On several ranks the element of a face may be elsewhere: there nothing is said.
pub(super) fn warn_of_loose_loads(part: &ModelPart, problems: &mut Report) {
    let (conditions, elements, space) = (&part.conditions, &part.elements, part.info.domain_size);
    let is_face = |at: &u32| {
        let kind = conditions.kinds[*at as usize];
        kind.loads.is_some_and(|loads| !loads.is_empty()) && kind.cell.is_some_and(|cell| cell.dim() + 1 == space)
    };
    let faces: Vec<u32> = (0..conditions.len() as u32).filter(is_face).collect();
    if faces.is_empty() || part.share.is_some() {
        return;
    }
    let nodes = faces.iter().flat_map(|&face| conditions.nodes(face)).copied();
    let mut elements_of: FxHashMap<u32, Vec<u32>> = nodes.map(|node| (node, Vec::new())).collect();
    for at in 0..elements.len() as u32 {
        if elements.kinds[at as usize].cell.is_some_and(|cell| cell.dim() == space) {
            let own = elements.nodes(at).iter();
            own.for_each(|node| elements_of.get_mut(node).into_iter().for_each(|of_node| of_node.push(at)));
        }
    }
    // Elements of a face, where all of its nodes are of elements.
    let owners = |face: u32| {
        let own = conditions.nodes(face);
        let of_face = |at: &&u32| {
            let (nodes, cell) = (elements.nodes(**at), elements.kinds[**at as usize].cell.map(|shape| shape.cell()));
            let sides = cell.map_or(&[][..], |cell| if cell.dim == 3 { cell.faces } else { cell.edges });
            let has = |side: &Facet, node: &u32| side.nodes.iter().any(|&at| nodes[at] == *node);
            sides.iter().any(|side| own.iter().all(|node| has(side, node)))
        };
        let belongs = own.iter().all(|node| !elements_of[node].is_empty());
        belongs.then(|| elements_of[&own[0]].iter().filter(of_face).count())
    };
    let kinds = faces.iter().map(|&face| (face, owners(face)));
    let (loose, inner): (Vec<_>, Vec<_>) =
        kinds.filter(|(_, count)| count.is_some_and(|count| count != 1)).partition(|(_, count)| *count == Some(0));
    for (found, word, where_it_acts) in [
        (loose, "on no face of an element", "the load acts within or across bodies: check the nodes of the condition"),
        (
            inner,
            "on a face between two elements",
            "the load acts within the body: take the condition out, or check its nodes",
        ),
    ] {
        let Some(&(first, _)) = found.first() else { continue };
        let count = counted(found.len(), "condition with a load is", "conditions with loads are");
        let ids: Vec<String> =
            conditions.nodes(first).iter().map(|&node| part.nodes.ids[node as usize].to_string()).collect();
        let fact = format!(
            "{count} {word}, the first is {} {} with nodes {}",
            conditions.kinds[first as usize].name,
            conditions.ids[first as usize],
            ids.join(" ")
        );
        problems.push(Diagnostic::warning("loose-load", fact).remedy(where_it_acts));
    }
}
