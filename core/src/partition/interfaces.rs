//! The surfaces of a deck that may touch each other, as its processes say.

use super::listed_processes::each_process;
use crate::diagnostics::{Diagnostic, Place};
use crate::model::ModelPart;
use crate::parameters::{Interval, Node};
use crate::processes::NamedSurface;

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

/// Surfaces named by the processes of a stage, in the order of the deck.
///
/// Parts that the mesh does not have are left out: the process that names them says so.
pub fn surfaces(deck: &Node, part: &ModelPart) -> Vec<Surface> {
    pairings(deck, part).into_iter().flat_map(|pairing| pairing.surfaces).collect()
}

/// A process of the deck with the surfaces that it names.
pub struct Pairing {
    /// Thing that it puts between them, e.g. contact; empty for nothing.
    puts: &'static str,
    name: &'static str,
    /// Place of its parameters, where it has any.
    place: Option<Place>,
    interval: Interval,
    /// The surfaces.
    pub surfaces: Vec<Surface>,
}

/// The processes of a stage with the surfaces that they name, in the order of the deck.
pub fn pairings(deck: &Node, part: &ModelPart) -> Vec<Pairing> {
    let mut out = Vec::new();
    if let Some(lists) = deck.get("processes") {
        each_process(lists, &mut |entry, parameters| {
            let interval = parameters.and_then(|node| node.get("interval"));
            let interval = interval.and_then(|node| Interval::from_node(node).ok()).unwrap_or(Interval::ALWAYS);
            let surfaces = (entry.surfaces)(parameters).iter().map(|surface| Surface::new(surface, part)).collect();
            let place = parameters.map(Node::place);
            out.push(Pairing { puts: entry.puts, name: entry.name, place, interval, surfaces });
        });
    }
    out
}

/// Warnings of pairs of surfaces between which two processes put the same, e.g. contact, at the same time.
pub fn warnings_of_repeated_pairs(pairings: &[Pairing]) -> Vec<Diagnostic> {
    let acting = pairings.iter().filter(|pairing| !pairing.puts.is_empty());
    let all: Vec<(Place, &Pairing)> = acting.filter_map(|pairing| Some((pairing.place.clone()?, pairing))).collect();
    let mut out = Vec::new();
    for (at, (place, later)) in all.iter().enumerate() {
        for (before, earlier) in &all[..at] {
            let begin = later.interval.begin.max(earlier.interval.begin);
            let together = begin < later.interval.end.min(earlier.interval.end);
            let repeats = later.surfaces.iter().any(|one| earlier.surfaces.iter().any(|other| one.is_of_pair(other)));
            if later.puts != earlier.puts || !together || !repeats {
                continue;
            }
            let fact = format!(
                "{} puts {} between surfaces that have it by {} at {before} already: both act",
                later.name, later.puts, earlier.name
            );
            let remedy = "keep one of the processes for these surfaces";
            out.push(Diagnostic::warning("pair-given-twice", fact).at(place.clone()).remedy(remedy));
        }
    }
    out
}

impl Surface {
    /// Whether most of the smaller of both pairs is of the larger one, side by side or crosswise.
    fn is_of_pair(&self, other: &Self) -> bool {
        if self.whole_skin || other.whole_skin {
            return true;
        }
        let masters = |of: &Self| -> Vec<u32> {
            of.nodes.iter().copied().filter(|node| of.slaves.binary_search(node).is_err()).collect()
        };
        let most = |one: &[u32], two: &[u32]| {
            let common = one.iter().filter(|node| two.binary_search(node).is_ok()).count();
            2 * common > one.len().min(two.len())
        };
        if self.slaves.is_empty() || other.slaves.is_empty() {
            return most(&self.nodes, &other.nodes);
        }
        let [own, their] = [masters(self), masters(other)];
        most(&self.slaves, &other.slaves) && most(&own, &their)
            || most(&self.slaves, &their) && most(&own, &other.slaves)
    }

    fn new(named: &NamedSurface, part: &ModelPart) -> Self {
        match named {
            NamedSurface::WholeSkin => Self { whole_skin: true, ..Self::default() },
            NamedSurface::Parts { both, slaves } => {
                Self { whole_skin: false, nodes: nodes_of(both, part), slaves: nodes_of(slaves, part) }
            }
        }
    }
}

/// Nodes of these parts and of their conditions, ascending.
fn nodes_of(names: &[String], part: &ModelPart) -> Vec<u32> {
    let mut out = Vec::new();
    for found in names.iter().filter_map(|name| part.part(name).ok()) {
        out.extend(&found.nodes);
        for &condition in &found.conditions {
            out.extend(part.conditions.nodes(condition));
        }
    }
    out.sort_unstable();
    out.dedup();
    out
}
