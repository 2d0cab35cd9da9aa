//! Bodies in each other that contact does not see: faces that no pair names, or bodies that pass each other within a step.

use zelus_core::diagnostics::{coordinates, counted};
use zelus_core::geometry::mapping::local_coordinates;
use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, norm, scale, sub};

use crate::interface::{Facet, Interface, Roles};
use crate::search::{Bounds, Tree, farthest_motion, inside, step_start};
use crate::variables::NODAL_H;

/// Share of the largest depth by which nodes may move until they are checked again.
const STILL: f64 = 0.5;

/// Results of the last check of an interface.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct PenetrationCheck {
    /// Way of the farthest node since the last look that found nothing (length); `None` before the first.
    moved: Option<f64>,
    /// Whether the last check found a penetration that a shorter step may avoid.
    pub depends_on_step: bool,
}

impl PenetrationCheck {
    /// Why a converged state cannot be accepted: bodies are in each other by more than `most` of their mesh size
    /// where no node of an interface is in contact, or nodes have gone through a master in the step. Collective.
    ///
    /// `in_contact` says whether a slave node of an interface is in contact.
    pub(crate) fn why(
        &mut self,
        part: &ModelPart,
        interfaces: &[Interface],
        most: f64,
        in_contact: impl Fn(usize) -> bool,
    ) -> Option<String> {
        let not_in_contact =
            interfaces.iter().enumerate().filter(|(at, interface)| !interface.open && !in_contact(*at));
        let not_in_contact: Vec<&Interface> = not_in_contact.map(|(_, interface)| interface).collect();
        if most <= 0.0 || not_in_contact.is_empty() {
            return None;
        }
        let sizes = part.nodes.values.values(&NODAL_H, 0);
        let nodes: Vec<u32> = not_in_contact.iter().flat_map(|interface| interface.nodes.iter().copied()).collect();
        let finest = nodes.iter().map(|&n| sizes[n as usize]).filter(|h| *h > 0.0).fold(f64::INFINITY, f64::min);
        let motion = farthest_motion(part, &nodes);
        let moved = self.moved.map_or(f64::INFINITY, |moved| moved + 2.0 * motion);
        if moved <= STILL * most * finest {
            self.moved = Some(moved);
            return None;
        }
        let crossed = if motion > finest { not_in_contact.iter().find_map(|of| passed(part, of, most)) } else { None };
        let why = crossed.or_else(|| buried(part, &not_in_contact, most));
        self.moved = why.is_none().then_some(0.0);
        self.depends_on_step = why.is_some() && motion > most * finest;
        why
    }
}

/// Nodes of interfaces without contact that are in another body. Collective.
fn buried(part: &ModelPart, not_in_contact: &[&Interface], most: f64) -> Option<String> {
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let both = |interface: &&Interface| [Roles::Slave, Roles::Master].map(|role| interface.normals_of(part, role));
    let mut normals: Vec<(u32, [f64; 3])> = not_in_contact.iter().flat_map(both).flatten().collect();
    normals.retain(|(node, _)| sizes[*node as usize] > 0.0);
    let mut nodes: Vec<u32> = normals.iter().map(|(node, _)| *node).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let inward = inward(part, &nodes);
    // Elements of the node itself do not count. The point towards them tells a body around the node from two beside it, as where it is
    // glued to one at an edge.
    let around = |&(node, normal): &(u32, [f64; 3])| {
        let size = sizes[node as usize];
        let inward = inward[nodes.binary_search(&node).expect("a node of an idle interface")];
        [normal, scale(normal, -1.0), inward].map(|way| {
            let x = add(part.nodes.current[node as usize], scale(way, most * size));
            (node, x, size)
        })
    };
    let points: Vec<(u32, [f64; 3], f64)> = normals.iter().flat_map(around).collect();
    let mut found = inside(part, &points);
    part.ranks.any_of(&mut found);
    let is_deep = |at: &usize| found[3 * at..3 * at + 3].iter().all(|found| *found);
    let deep: Vec<u32> = (0..normals.len()).filter(is_deep).map(|at| normals[at].0).collect();
    let first = *deep.first()?;
    let nodes = counted(deep.len(), "of its nodes is", "of its nodes are");
    Some(format!(
        "no node of the contact pair is in contact, and {nodes} inside a body by more than {most} of their mesh size, the first is node {} at {}: a shorter \"time_step\" may let contact see it; name the faces that meet in \"contact_model_part\", move bodies apart that begin in each other, or allow it by \"largest_penetration\": 0 in \"contact_settings\"",
        part.nodes.ids[first as usize],
        coordinates(part.nodes.initial[first as usize])
    ))
}

/// Unit vectors from nodes, ascending, to the centres of their elements. Collective.
fn inward(part: &ModelPart, nodes: &[u32]) -> Vec<[f64; 3]> {
    let mut sums = vec![0.0; 3 * nodes.len()];
    for element in (0..part.elements.len() as u32).filter(|&at| part.elements.kinds[at as usize].cell.is_some()) {
        let own = part.elements.nodes(element);
        let Some(count) = Some(own.len()).filter(|_| own.iter().any(|node| nodes.binary_search(node).is_ok())) else {
            continue;
        };
        let places = own.iter().map(|&node| part.nodes.current[node as usize]);
        let centre = scale(places.fold([0.0; 3], add), 1.0 / count as f64);
        for node in own {
            let Ok(at) = nodes.binary_search(node) else { continue };
            let way = sub(centre, part.nodes.current[*node as usize]);
            sums[3 * at..3 * at + 3].iter_mut().zip(way).for_each(|(sum, way)| *sum += way);
        }
    }
    part.ranks.sum(&mut sums);
    let unit = |sum: [f64; 3]| scale(sum, norm(sum).max(f64::MIN_POSITIVE).recip());
    sums.as_chunks().0.iter().map(|&sum| unit(sum)).collect()
}

/// Slave nodes that were before a master facet when the step began and have gone through it, by straight ways.
fn passed(part: &ModelPart, interface: &Interface, most: f64) -> Option<String> {
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let masters: Vec<&Facet> = interface.facets.iter().filter(|facet| facet.role == Roles::Master).collect();
    let at = |share: f64| move |n: u32| along(step_start(part, n), part.nodes.current[n as usize], share);
    let places = |facet: &Facet, share: f64| -> Vec<[f64; 3]> { facet.nodes.iter().map(|&n| at(share)(n)).collect() };
    let swept = masters.iter().map(|facet| Bounds::of(&[places(facet, 0.0), places(facet, 1.0)].concat()));
    let tree = Tree::new(swept.collect());
    let goes_through = |node: u32, facet: &Facet| {
        let height = |share: f64| {
            let places = places(facet, share);
            dot(sub(at(share)(node), places[0]), facet.normal_at(&places))
        };
        let (before, after) = (height(0.0), height(1.0));
        let depth = most * sizes[node as usize];
        if !(before > -depth && after < -depth) {
            return false;
        }
        let share = before.max(0.0) / (before.max(0.0) - after);
        local_coordinates(facet.shape, &places(facet, share), at(share)(node))
            .is_some_and(|found| facet.shape.cell().contains(found.xi, 0.0))
    };
    let through = |&node: &u32| {
        let way = Bounds::of(&[at(0.0)(node), at(1.0)(node)]);
        tree.meeting(&way).into_iter().any(|master| goes_through(node, masters[master as usize]))
    };
    let nodes: Vec<u32> = interface.nodes_of(Roles::Slave).into_iter().filter(through).collect();
    let first = *nodes.first()?;
    let count = counted(nodes.len(), "slave node goes", "slave nodes go");
    let (id, place) = (part.nodes.ids[first as usize], coordinates(part.nodes.initial[first as usize]));
    Some(format!("{count} through the master within the step, the first is node {id} at {place}"))
}

fn along(from: [f64; 3], to: [f64; 3], share: f64) -> [f64; 3] {
    add(from, scale(sub(to, from), share))
}
