//! The surfaces of a deck that may touch each other, as its processes say.

use super::listed_processes::each_process;
use crate::model::ModelPart;
use crate::parameters::Node;
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
    let mut out = Vec::new();
    if let Some(lists) = deck.get("processes") {
        each_process(lists, &mut |entry, parameters| {
            out.extend((entry.surfaces)(parameters).iter().map(|surface| Surface::new(surface, part)));
        });
    }
    out
}

impl Surface {
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
