//! Where the values of a rank stand in the whole mesh.

use zelus_linear_algebra::Unknowns;

use crate::model::ModelPart;

/// Nodes of a rank by their places in the whole mesh, and its unknowns.
pub(super) struct RankLayout {
    /// Places of its nodes in the whole mesh.
    pub places: Vec<u32>,
    /// Whether it owns each of them.
    pub owned: Vec<bool>,
    /// Its unknowns.
    pub unknowns: Unknowns,
}

impl RankLayout {
    /// The layout of a rank that has its share of the part, or all of it.
    pub(super) fn new(part: &ModelPart, rank: usize, unknowns: Unknowns) -> Self {
        let (places, owned) = match &part.share {
            Some(share) => (share.places.clone(), share.owners.iter().map(|&owner| owner as usize == rank).collect()),
            None => ((0..part.nodes.len() as u32).collect(), vec![true; part.nodes.len()]),
        };
        Self { places, owned, unknowns }
    }
}
