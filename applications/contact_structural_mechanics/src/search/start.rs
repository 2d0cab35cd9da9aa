//! How the sides of contact lie to each other before anything runs: nodes inside other bodies, and moving them out without strain.

use zelus_core::diagnostics::{Diagnostic, coordinates, counted};
use zelus_core::model::ModelPart;
use zelus_core::parallel;
use zelus_core::vector3::{add, dot, norm, scale, sub};

use super::candidates::AT_A_TIME;
use super::direct_check::met_along;
use super::inside::inside;
use super::tree::{Bounds, Tree};
use crate::interface::{Facet, Interface, Roles, find_nodal_h};
use crate::variables::{INITIAL_CLEARANCE, NODAL_H};

/// Cosine beyond which a node and a facet face each other.
const FACING: f64 = 0.1;
/// Mesh sizes around a node in which its master is looked for first.
const NEAR: f64 = 2.0;
/// Depth in mesh sizes that goes without a word: facets of curved surfaces overlap by as much.
const SILENT: f64 = 0.02;
/// Distance in mesh sizes that is none.
const ROUND_OFF: f64 = 1e-12;

/// A slave node before the first step.
struct StartingNode {
    node: u32,
    /// A node of its master.
    master: u32,
    /// Unit normal out of its body.
    normal: [f64; 3],
    /// Way along the normal to the master (length), negative inside it.
    distance: f64,
    /// Clearance that the deck gives it.
    clearance: f64,
    size: f64,
}

impl StartingNode {
    /// Distance beyond its clearance.
    fn excess(&self) -> f64 {
        self.distance - self.clearance
    }
}

/// An interface before the first step.
#[derive(Default)]
pub struct StartingInterface {
    /// Message of nodes that were moved, or of a mistake.
    pub message: Option<Diagnostic>,
    /// Whether slave nodes lie inside the master by more than round-off, so that contact loads the bodies by itself.
    pub overlaps: bool,
}

/// Moves or reports the slave nodes of an interface, named `name`, before the first step; nodes are of `bodies`.
///
/// Where `tolerance` is given, nodes whose distance is at most that many mesh sizes are moved onto the master, with their initial
/// positions: without strain. Deeper ones, and all without it, are told; beyond a mesh size as an error where `refuses` holds.
/// Collective.
pub fn settle(
    part: &mut ModelPart,
    interface: &Interface,
    bodies: &[Option<usize>],
    name: &str,
    tolerance: Option<f64>,
    refuses: bool,
) -> StartingInterface {
    if interface.open || part.info.step > 0 {
        return StartingInterface { message: None, overlaps: true };
    }
    find_nodal_h(part);
    let places = places(part, interface);
    let overlaps = places.iter().any(|at| at.distance < -ROUND_OFF * at.size);
    let message = if let Some(problem) = one_body(part, interface, bodies, &places, name, refuses) {
        Some(problem)
    } else if let Some(tolerance) = tolerance {
        adjust(part, &places, name, tolerance)
    } else {
        penetration(part, &places, name, refuses)
    };
    StartingInterface { message, overlaps }
}

/// The warning of slave nodes that lie inside the other body, an error where `refuses` holds and one lies deeper than a mesh size.
/// Collective.
fn penetration(part: &ModelPart, places: &[StartingNode], name: &str, refuses: bool) -> Option<Diagnostic> {
    let deep: Vec<&StartingNode> = places.iter().filter(|at| at.excess() < -SILENT * at.size).collect();
    let points: Vec<_> = deep.iter().map(|at| (at.node, part.nodes.current[at.node as usize], at.size)).collect();
    let mut inside = inside(part, &points);
    part.ranks.any_of(&mut inside);
    let deep: Vec<&StartingNode> =
        deep.into_iter().zip(inside).filter_map(|(at, inside)| inside.then_some(at)).collect();
    let deepest = deep.iter().min_by(|a, b| a.distance.total_cmp(&b.distance).then(a.node.cmp(&b.node)))?;
    let fact = format!(
        "contact pair {name}: {} inside the other body before the first step, node {} at {} deepest, by {:.3e}: {:.2} of its mesh size",
        counted(deep.len(), "slave node lies", "slave nodes lie"),
        part.nodes.ids[deepest.node as usize],
        coordinates(part.nodes.initial[deepest.node as usize]),
        -deepest.distance,
        -deepest.distance / deepest.size
    );
    let is_lost = refuses && -deepest.distance > deepest.size;
    let make = if is_lost { Diagnostic::error } else { Diagnostic::warning };
    let remedy = if -deepest.distance > deepest.size {
        "move the bodies apart in the mesh: contact may not detect nodes that are deeper than an element; \"largest_penetration\": 0 in \
         \"contact_settings\" allows the run"
    } else {
        "the first step pushes them out, which strains the bodies: leave it where a press fit is meant, else set \
         \"adjust_initial\": true in \"contact_settings\", or mend the mesh"
    };
    Some(make("initial-penetration", fact).remedy(remedy))
}

/// The problem that both sides are faces of one body, and that none faces the other but through the body: an error where
/// `refuses` holds and there are such.
fn one_body(
    part: &ModelPart,
    interface: &Interface,
    bodies: &[Option<usize>],
    places: &[StartingNode],
    name: &str,
    refuses: bool,
) -> Option<Diagnostic> {
    let of_role = |role| {
        let mut found: Vec<_> = interface.nodes_of(role).into_iter().map(|node| bodies[node as usize]).collect();
        found.dedup();
        found
    };
    let [slave, master] = [Roles::Slave, Roles::Master].map(of_role);
    let &[Some(body)] = &slave[..] else { return None };
    if master != slave || places.iter().any(|at| at.distance >= -SILENT * at.size) {
        return None;
    }
    let through = places.iter().find(|at| at.distance < -at.size).map(|at| {
        let place = coordinates(part.nodes.initial[at.node as usize]);
        format!("; node {} at {place} faces the master through it", part.nodes.ids[at.node as usize])
    });
    let make = if refuses && through.is_some() { Diagnostic::error } else { Diagnostic::warning };
    let fact = format!(
        "contact pair {name}: both sides are faces of one body, that of node {body}, and no slave node has the master before it{}",
        through.unwrap_or_default()
    );
    let remedy =
        "name faces of the two bodies that meet; a body that is to meet itself needs no \"assume_master_slave\"";
    Some(make("one-body", fact).remedy(remedy))
}

/// Moves nodes along their normals to their clearance, without strain.
fn move_all(part: &mut ModelPart, moved: &[&StartingNode]) {
    for at in moved {
        let node = at.node as usize;
        let to = add(part.nodes.initial[node], scale(at.normal, at.excess()));
        (part.nodes.initial[node], part.nodes.current[node]) = (to, to);
    }
}

/// Gives the slave nodes within so many mesh sizes of the master a clearance, negative for an interference, and moves them there without
/// strain; the note that says so, `None` where there are no such nodes. Collective.
pub fn set_clearance(
    part: &mut ModelPart,
    interface: &Interface,
    clearance: f64,
    tolerance: f64,
) -> Option<Diagnostic> {
    find_nodal_h(part);
    part.nodes.values.add(&INITIAL_CLEARANCE);
    let mut places = places(part, interface);
    places.retain(|at| at.distance.abs() <= tolerance * at.size);
    for at in &mut places {
        at.clearance = clearance;
        part.nodes.values.values_mut(&INITIAL_CLEARANCE, 0)[at.node as usize] = clearance;
    }
    let moved: Vec<&StartingNode> = places.iter().collect();
    move_all(part, &moved);
    let farthest = moved.iter().max_by(|a, b| a.excess().abs().total_cmp(&b.excess().abs()))?;
    let fact = format!(
        "{} to the clearance {clearance:e} without strain, node {} farthest, by {:.3e}",
        counted(moved.len(), "slave node is moved", "slave nodes are moved"),
        part.nodes.ids[farthest.node as usize],
        farthest.excess().abs()
    );
    Some(Diagnostic::note("initial-clearance", fact))
}

fn adjust(part: &mut ModelPart, places: &[StartingNode], name: &str, tolerance: f64) -> Option<Diagnostic> {
    let moves = |at: &&StartingNode| (ROUND_OFF * at.size..=tolerance * at.size).contains(&at.excess().abs());
    let moved: Vec<&StartingNode> = places.iter().filter(moves).collect();
    move_all(part, &moved);
    let farthest = moved.iter().max_by(|a, b| a.distance.abs().total_cmp(&b.distance.abs()))?;
    let [inside, gaps] = [true, false].map(|is| moved.iter().filter(|at| (at.distance < 0.0) == is).count());
    let fact = format!(
        "contact pair {name}: slave nodes are moved onto the master without strain, {inside} from inside it and {gaps} across a gap, node {} \
         farthest, by {:.3e}",
        part.nodes.ids[farthest.node as usize],
        farthest.distance.abs()
    );
    Some(Diagnostic::note("adjusted-initial", fact))
}

/// Slave nodes of an interface that face a master along their normals: the node, one of the master, the normal.
pub fn facing(part: &ModelPart, interface: &Interface) -> Vec<([u32; 2], [f64; 3])> {
    places(part, interface).into_iter().map(|at| ([at.node, at.master], at.normal)).collect()
}

/// The slave nodes that face a master facet along their normals, ascending.
fn places(part: &ModelPart, interface: &Interface) -> Vec<StartingNode> {
    let of_role = |role: Roles| interface.facets.iter().filter(move |facet| facet.role == role);
    let masters: Vec<&Facet> = of_role(Roles::Master).collect();
    let bounds: Vec<Bounds> = masters.iter().map(|facet| Bounds::of(&facet.positions(part))).collect();
    let all: Vec<[f64; 3]> = interface.nodes.iter().map(|&node| part.nodes.current[node as usize]).collect();
    let whole = Bounds::of(&all);
    let extent = norm(sub(whole.high, whole.low));
    let tree = Tree::new(bounds);
    let nodes = interface.normals_of(part, Roles::Slave);
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let clearances = part.nodes.values.get(INITIAL_CLEARANCE.name()).map(|field| &field.levels[0]);
    let place = |at: usize| {
        let (node, normal) = nodes[at];
        let (x, size) = (part.nodes.current[node as usize], sizes[node as usize]);
        let way = |length: f64| {
            let line = Bounds::of(&[add(x, scale(normal, -length)), add(x, scale(normal, length))]);
            let line = line.grown(ROUND_OFF * extent);
            let faces = |facet: &Facet, of_facet| dot(of_facet, normal) < -FACING && !facet.nodes.contains(&node);
            let met = met_along(part, (&tree, |at| masters[at as usize]), &line, (x, normal), faces);
            met.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
        };
        let (distance, master) = way(NEAR * size).or_else(|| way(extent))?;
        let clearance = clearances.map_or(0.0, |of| of[node as usize]);
        let found = StartingNode { node, master: master.nodes[0], normal, distance, clearance, size };
        distance.is_finite().then_some(found)
    };
    parallel::map(nodes.len(), AT_A_TIME, place).into_iter().flatten().collect()
}
