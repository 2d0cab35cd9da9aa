//! What one rank keeps of a mesh that several share: its own elements with their nodes, and all of the interfaces.
//!
//! Every rank keeps the nodes of surfaces that may touch, of constraints, and the elements at them: search, active set and
//! constraints are then decided everywhere alike. They grow with the surface of the bodies; the rest is shared out.

use super::Partition;
use crate::model::{Halo, MeshSizes, ModelPart, Share};

/// Indices of a whole mesh that a rank keeps, ascending.
pub(super) struct Kept {
    pub(super) nodes: Vec<u32>,
    pub(super) elements: Vec<u32>,
    pub(super) conditions: Vec<u32>,
    halo: Halo,
    common: Vec<bool>,
}

/// Marks the nodes that every rank has: the common ones and those of the elements and conditions at them.
pub fn everywhere(part: &ModelPart, common: &[bool]) -> Vec<bool> {
    let mut everywhere = common.to_vec();
    for table in [&part.elements, &part.conditions] {
        for at in 0..table.len() as u32 {
            let nodes = table.nodes(at);
            if nodes.iter().any(|&node| common[node as usize]) {
                nodes.iter().for_each(|&node| everywhere[node as usize] = true);
            }
        }
    }
    everywhere
}

impl Kept {
    /// What `rank` keeps where all ranks keep the `common` nodes with the elements at them.
    pub(super) fn new(part: &ModelPart, partition: &Partition, common: &[bool], rank: usize) -> Self {
        let mut kept = vec![false; part.nodes.len()];
        let lists = || vec![Vec::new(); partition.ranks];
        let mut halo = Halo { ranks: part.ranks.clone(), copied: lists(), copies: lists(), everywhere: lists() };
        let everywhere = everywhere(part, common);
        let mut elements = Vec::new();
        let mut conditions = Vec::new();
        for (table, owners, list) in [
            (&part.elements, &partition.elements, &mut elements),
            (&part.conditions, &partition.conditions, &mut conditions),
        ] {
            for (at, &owner) in owners.iter().enumerate() {
                let nodes = table.nodes(at as u32);
                let is_own = owner as usize == rank;
                if is_own || nodes.iter().any(|&node| common[node as usize]) {
                    list.push(at as u32);
                }
                for &node in nodes.iter().filter(|&&node| !everywhere[node as usize]) {
                    if is_own {
                        kept[node as usize] = true;
                    } else if partition.nodes[node as usize] as usize == rank {
                        halo.copied[owner as usize].push(node);
                    }
                }
            }
        }
        for node in 0..kept.len() as u32 {
            let (owner, at) = (partition.nodes[node as usize] as usize, node as usize);
            kept[at] |= everywhere[at] || owner == rank;
            if everywhere[at] {
                halo.everywhere[owner].push(node);
            } else if owner != rank && kept[at] {
                halo.copies[owner].push(node);
            }
        }
        for list in &mut halo.copied {
            list.sort_unstable();
            list.dedup();
        }
        let nodes = (0..kept.len() as u32).filter(|&node| kept[node as usize]).collect();
        Self { nodes, elements, conditions, halo, common: common.to_vec() }
    }

    /// The share of the rank, once the mesh has been cut down to what is kept.
    pub(super) fn share(self, partition: &Partition, whole: MeshSizes) -> Share {
        let mut new = vec![0_u32; whole.nodes];
        self.nodes.iter().enumerate().for_each(|(at, &node)| new[node as usize] = at as u32);
        let pick = |list: &[u32], kept: &[u32]| -> Vec<u32> { kept.iter().map(|&at| list[at as usize]).collect() };
        let owners = pick(&partition.nodes, &self.nodes);
        Share {
            elements: pick(&partition.elements, &self.elements),
            conditions: pick(&partition.conditions, &self.conditions),
            pairs: owners.clone(),
            owners,
            common: self.nodes.iter().map(|&node| self.common[node as usize]).collect(),
            halo: self.halo.expand(|node, out| out.push(new[node as usize])),
            places: self.nodes,
            whole,
        }
    }
}

/// Cuts `part` down to what this rank keeps of it where all keep the `common` nodes, and notes in it who has what.
pub fn keep_share(part: &mut ModelPart, partition: &Partition, common: &[bool]) {
    let whole = MeshSizes { nodes: part.nodes.len(), elements: part.elements.len(), conditions: part.conditions.len() };
    let kept = Kept::new(part, partition, common, part.ranks.rank());
    if kept.nodes.len() < whole.nodes
        || kept.elements.len() < whole.elements
        || kept.conditions.len() < whole.conditions
    {
        part.keep(&kept.nodes, &kept.elements, &kept.conditions);
    }
    part.share = Some(kept.share(partition, whole));
}
