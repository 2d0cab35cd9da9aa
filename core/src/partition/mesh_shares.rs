//! Share of one rank in a distributed mesh: its own elements with their nodes, and all of the interfaces.
//!
//! Every rank keeps the nodes of surfaces that may touch, of constraints, and the elements at them: search, active set and
//! constraints are then decided everywhere alike. They grow with the surface of the bodies; the rest is shared out.

use super::Partition;
use crate::model::{Halo, MeshShare, MeshSizes, ModelPart};

/// Shares of all ranks in a mesh, listed in one pass.
pub struct Shares<'a> {
    partition: &'a Partition,
    common: &'a [bool],
    whole: MeshSizes,
    /// Elements, and conditions, that each rank evaluates; those at common nodes, which all keep.
    own: [Vec<Vec<u32>>; 2],
    of_all: [Vec<u32>; 2],
    /// Nodes that each rank owns or has elements or conditions at, but for those that all have; repeated, in no order.
    nodes: Vec<Vec<u32>>,
    /// Nodes that all have, by their owners.
    everywhere: Vec<Vec<u32>>,
    /// Nodes of each rank at which another has elements or conditions, after the number of that one; ascending.
    copied: Vec<Vec<[u32; 2]>>,
    /// Nodes of others at which each rank has elements or conditions, after the number of their owner; ascending.
    copies: Vec<Vec<[u32; 2]>>,
}

impl<'a> Shares<'a> {
    /// Shares out `part`, of which all ranks keep the `common` nodes with the elements at them.
    pub fn new(part: &ModelPart, partition: &'a Partition, common: &'a [bool]) -> Self {
        let everywhere = everywhere(part, common);
        let lists = || vec![Vec::new(); partition.ranks];
        let mut made = Self {
            partition,
            common,
            whole: MeshSizes {
                nodes: part.nodes.len(),
                elements: part.elements.len(),
                conditions: part.conditions.len(),
            },
            own: [lists(), lists()],
            of_all: Default::default(),
            nodes: lists(),
            everywhere: lists(),
            copied: vec![Vec::new(); partition.ranks],
            copies: vec![Vec::new(); partition.ranks],
        };
        for (node, &owner) in partition.nodes.iter().enumerate() {
            let list = if everywhere[node] { &mut made.everywhere } else { &mut made.nodes };
            list[owner as usize].push(node as u32);
        }
        let tables = [(&part.elements, &partition.elements), (&part.conditions, &partition.conditions)];
        for (at, (table, owners)) in tables.into_iter().enumerate() {
            for (entity, &owner) in (0..).zip(owners) {
                made.own[at][owner as usize].push(entity);
                let nodes = table.nodes(entity);
                if nodes.iter().any(|&node| common[node as usize]) {
                    made.of_all[at].push(entity);
                }
                for &node in nodes.iter().filter(|&&node| !everywhere[node as usize]) {
                    let of_node = partition.nodes[node as usize];
                    if of_node != owner {
                        made.nodes[owner as usize].push(node);
                        made.copied[of_node as usize].push([owner, node]);
                        made.copies[owner as usize].push([of_node, node]);
                    }
                }
            }
        }
        for list in made.copied.iter_mut().chain(&mut made.copies) {
            list.sort_unstable();
            list.dedup();
        }
        made
    }

    /// Share of `rank` in `part`, with the owners.
    pub fn of(&self, part: &ModelPart, rank: usize) -> ModelPart {
        let sorted = |lists: &[&[u32]]| {
            let mut all = lists.concat();
            all.sort_unstable();
            all.dedup();
            all
        };
        let everywhere = self.everywhere.concat();
        let nodes = sorted(&[&self.nodes[rank], &everywhere]);
        let [elements, conditions] = [0, 1].map(|at| sorted(&[&self.own[at][rank], &self.of_all[at]]));
        let kept = MeshSizes { nodes: nodes.len(), elements: elements.len(), conditions: conditions.len() };
        let mut own = if kept == self.whole { part.clone() } else { part.kept(&nodes, &elements, &conditions) };
        let pick = |list: &[u32], kept: &[u32]| -> Vec<u32> { kept.iter().map(|&at| list[at as usize]).collect() };
        let owners = pick(&self.partition.nodes, &nodes);
        let mut new = vec![0_u32; self.whole.nodes];
        nodes.iter().enumerate().for_each(|(at, &node)| new[node as usize] = at as u32);
        own.share = Some(MeshShare {
            elements: pick(&self.partition.elements, &elements),
            conditions: pick(&self.partition.conditions, &conditions),
            pairs: owners.clone(),
            owners,
            common: nodes.iter().map(|&node| self.common[node as usize]).collect(),
            halo: self.halo(part, rank).expand(|node, out| out.push(new[node as usize])),
            places: nodes,
            whole: self.whole,
        });
        own
    }

    /// Copies of the whole mesh's nodes that concern a rank.
    fn halo(&self, part: &ModelPart, rank: usize) -> Halo {
        let by_rank = |pairs: &[[u32; 2]]| {
            let mut lists = vec![Vec::new(); self.partition.ranks];
            pairs.iter().for_each(|&[other, node]| lists[other as usize].push(node));
            lists
        };
        let [copied, copies] = [&self.copied, &self.copies].map(|of_ranks| by_rank(&of_ranks[rank]));
        Halo { ranks: part.ranks.clone(), copied, copies, everywhere: self.everywhere.clone() }
    }
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
