//! Nodes of elements that stand at one place and that nothing couples: a mesh that is cut there, since its nodes were not merged.

use rustc_hash::{FxHashMap, FxHashSet};
use zelus_linear_algebra::{Components, parallel};

use crate::diagnostics::{Diagnostic, Report, coordinates, counted};
use crate::model::{ModelPart, bodies_of_nodes};
use crate::partition::Surface;
use crate::vector3::{dot, norm, sub};

/// Distance of two nodes at one place, as a share of the smaller mesh size at them.
const SAME: f64 = 1e-6;
/// Direction along which nodes are sorted: on no lattice, so that few nodes of a structured mesh have one abscissa.
const DIRECTION: [f64; 3] = [0.561_283_7, 0.614_927_1, 0.553_961_3];
/// Entities that a thread takes at a time, at least.
const ENTITIES: usize = 1 << 12;
/// Pairs of nodes that a message names.
const NAMED: usize = 3;

/// Warns of nodes at one place within one body, or on a face that two bodies share, which no surface of contact or of a tie, no
/// constraint and no element couples there; collective.
///
/// Bodies that touch at a point or along an edge only are no unmerged mesh.
pub(super) fn warn_of_coincident_nodes(part: &ModelPart, surfaces: &[Surface], problems: &mut Report) {
    let pairs = if surfaces.iter().any(|surface| surface.whole_skin) { Vec::new() } else { uncoupled(part, surfaces) };
    if !part.ranks.any(!pairs.is_empty()) {
        return;
    }
    let bodies = joined_bodies(part);
    let (mut found, apart): (Vec<[u32; 2]>, Vec<[u32; 2]>) =
        pairs.into_iter().partition(|&[a, b]| bodies[a as usize] == bodies[b as usize]);
    found.extend(on_faces(part, &bodies, &apart));
    // Of several nodes at one place, the first stands for the place.
    let others: FxHashSet<u32> = found.iter().map(|&[_, b]| b).collect();
    found.retain(|&[a, _]| part.owns_node(a as usize) && !others.contains(&a));
    found.sort_unstable();
    found.dedup_by_key(|&mut [a, _]| a);
    if found.is_empty() {
        return;
    }
    let ids = |node: u32| part.nodes.ids[node as usize];
    let named = found
        .iter()
        .take(NAMED)
        .map(|&[a, b]| format!("{} and {} at {}", ids(a), ids(b), coordinates(part.nodes.initial[a as usize])));
    let places = counted(found.len(), "place", "places");
    let more = if found.len() > NAMED { ", …" } else { "" };
    let fact = format!(
        "two nodes stand at {places} and nothing couples them: {}{more}; the mesh is cut there",
        named.collect::<Vec<String>>().join(", ")
    );
    let remedy = "merge the nodes, or put a tie or contact between the two sides, also between the lips of a crack";
    problems.push(Diagnostic::warning("coincident-nodes", fact).remedy(remedy));
}

/// The body that each node is of, where bodies that linear constraints join are one; collective.
fn joined_bodies(part: &ModelPart) -> Vec<Option<usize>> {
    let bodies = bodies_of_nodes(part);
    // A node stands for its body.
    let mut first: FxHashMap<usize, u32> = FxHashMap::default();
    for (node, body) in bodies.iter().enumerate() {
        body.iter().for_each(|&body| _ = first.entry(body).or_insert(node as u32));
    }
    let joined = Components::new(part.nodes.len());
    let node_of = |node: u32| bodies[node as usize].map(|body| first[&body]);
    for constraint in &part.constraints {
        for &((master, _), _) in &constraint.masters {
            if let (Some(one), Some(other)) = (node_of(constraint.slave.0), node_of(master)) {
                joined.join(one, other);
            }
        }
    }
    bodies.iter().map(|body| body.map(|body| joined.first(first[&body]) as usize)).collect()
}

/// Pairs of nodes at one place that nothing couples there, the first node of each place with another.
fn uncoupled(part: &ModelPart, surfaces: &[Surface]) -> Vec<[u32; 2]> {
    let pairs = at_one_place(part);
    if pairs.is_empty() {
        return pairs;
    }
    let coupled = Components::new(part.nodes.len());
    for constraint in &part.constraints {
        constraint.masters.iter().for_each(|&((master, _), _)| coupled.join(constraint.slave.0, master));
    }
    let is_in = |list: &[u32], node: u32| list.binary_search(&node).is_ok();
    for &[a, b] in &pairs {
        let faces = |surface: &Surface| {
            let both = is_in(&surface.nodes, a) && is_in(&surface.nodes, b);
            both && (surface.slaves.is_empty() || is_in(&surface.slaves, a) != is_in(&surface.slaves, b))
        };
        if surfaces.iter().any(faces) {
            coupled.join(a, b);
        }
    }
    let wanted: FxHashSet<[u32; 2]> = pairs.iter().copied().collect();
    let mut is_one = vec![false; part.nodes.len()];
    pairs.iter().flatten().for_each(|&node| is_one[node as usize] = true);
    for at in 0..part.elements.len() as u32 {
        let own: Vec<u32> = part.elements.nodes(at).iter().copied().filter(|&node| is_one[node as usize]).collect();
        for (place, &a) in own.iter().enumerate() {
            let linked = own[..place].iter().filter(|&&b| wanted.contains(&[a.min(b), a.max(b)]));
            linked.for_each(|&b| coupled.join(a, b));
        }
    }
    pairs.into_iter().filter(|&[a, b]| coupled.first(a) != coupled.first(b)).collect()
}

/// Pairs of nodes of elements at one place, each ascending.
fn at_one_place(part: &ModelPart) -> Vec<[u32; 2]> {
    let (x, elements) = (&part.nodes.initial, &part.elements);
    let mut sizes = vec![0.0_f64; part.nodes.len()];
    for at in 0..elements.len() as u32 {
        let nodes = elements.nodes(at);
        for (place, &node) in nodes.iter().enumerate() {
            let next = nodes[(place + 1) % nodes.len()];
            let length = norm(sub(x[node as usize], x[next as usize]));
            [node, next].into_iter().for_each(|end| sizes[end as usize] = sizes[end as usize].max(length));
        }
    }
    let nodes = parallel::select(sizes.len(), ENTITIES, |node| sizes[node] > 0.0);
    let mut sorted: Vec<(f64, u32)> = nodes.into_iter().map(|node| (dot(x[node as usize], DIRECTION), node)).collect();
    sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let near = |at: usize| {
        let (here, a) = sorted[at];
        let reach = SAME * sizes[a as usize];
        let ahead = sorted[at + 1..].iter().take_while(|(there, _)| there - here <= reach).map(|&(_, b)| b);
        let meets =
            |b: &u32| norm(sub(x[a as usize], x[*b as usize])) <= SAME * sizes[a as usize].min(sizes[*b as usize]);
        ahead.filter(meets).map(|b| [a.min(b), a.max(b)]).collect::<Vec<_>>()
    };
    parallel::map(sorted.len(), ENTITIES, near).concat()
}

/// The pairs of two bodies where they lie on each other along a face: one whose corners all have a node of the other body at their
/// place, or where a bar ends.
fn on_faces(part: &ModelPart, bodies: &[Option<usize>], pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut others: FxHashMap<u32, Vec<usize>> = FxHashMap::default();
    for &[a, b] in pairs {
        for (node, other) in [(a, b), (b, a)] {
            others.entry(node).or_default().extend(bodies[other as usize]);
        }
    }
    if others.is_empty() {
        return Vec::new();
    }
    // Nodes of such faces with the other body.
    let mut lie: FxHashSet<(u32, usize)> = FxHashSet::default();
    for at in 0..part.elements.len() as u32 {
        let nodes = part.elements.nodes(at);
        if !nodes.iter().any(|node| others.contains_key(node)) {
            continue;
        }
        let Some(shape) = part.elements.kinds[at as usize].cell.filter(|shape| shape.dim() == part.info.domain_size)
        else {
            let ends =
                nodes.iter().flat_map(|&node| others.get(&node).into_iter().flatten().map(move |&of| (node, of)));
            lie.extend(ends);
            continue;
        };
        for face in shape.cell().faces {
            let corners: Vec<u32> =
                face.nodes[..face.shape.cell().corners()].iter().map(|&place| nodes[place]).collect();
            for &other in corners.first().and_then(|node| others.get(node)).into_iter().flatten() {
                if corners.iter().all(|node| others.get(node).is_some_and(|of| of.contains(&other))) {
                    lie.extend(corners.iter().map(|&node| (node, other)));
                }
            }
        }
    }
    let lies = |a: u32, b: u32| bodies[b as usize].is_some_and(|other| lie.contains(&(a, other)));
    pairs.iter().copied().filter(|&[a, b]| lies(a, b) || lies(b, a)).collect()
}
