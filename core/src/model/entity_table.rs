//! The elements or conditions of a model part as the mesh gives them: kind, nodes, properties, data, flags.

use serde::{Deserialize, Serialize};

use super::entity_kind::{EntityKind, read_kinds, write_kinds};
use super::fields::Fields;
use super::flags::Flags;
use super::index::Index;

/// Elements or conditions in flat arrays; an index counts them in the order they were added.
#[derive(Debug, Default, Clone, PartialEq, Serialize, Deserialize)]
pub struct EntityTable {
    /// Ids; ascending for entities of the mesh file, later ones follow.
    pub ids: Vec<usize>,
    /// Registered kind of each.
    #[serde(serialize_with = "write_kinds", deserialize_with = "read_kinds")]
    pub kinds: Vec<&'static EntityKind>,
    /// Properties id of each.
    pub properties: Vec<usize>,
    /// Columns without history (Kratos: entity data).
    pub data: Fields,
    /// Flags.
    pub flags: Flags,
    starts: Vec<u32>,
    nodes: Vec<u32>,
    #[serde(skip)]
    index: Index,
}

impl EntityTable {
    /// Adds one entity; its nodes are node indices in the kind's order. Gives its index.
    ///
    /// # Panics
    /// When the id is taken: the reader checks.
    pub fn push(&mut self, id: usize, kind: &'static EntityKind, properties: usize, nodes: &[u32]) -> u32 {
        let at = self.ids.len() as u32;
        assert!(self.find(id).is_none(), "entity id {id} is taken");
        self.index.push(id, at);
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        self.ids.push(id);
        self.kinds.push(kind);
        self.properties.push(properties);
        self.nodes.extend_from_slice(nodes);
        self.starts.push(self.nodes.len() as u32);
        at
    }

    /// The chosen entities with all they carry, their nodes renumbered by `new`.
    pub fn pick(&self, items: &[u32], new: &[u32]) -> Self {
        let mut out = Self { data: self.data.pick(items), flags: self.flags.pick(items), ..Self::default() };
        for &item in items {
            let at = item as usize;
            let nodes: Vec<u32> = self.nodes(item).iter().map(|&node| new[node as usize]).collect();
            out.push(self.ids[at], self.kinds[at], self.properties[at], &nodes);
        }
        out
    }

    /// Adds other entities after its own, whatever their ids; the first node of the others is node `offset`.
    pub(super) fn append(&mut self, other: &Self, offset: u32) {
        let (count, nodes) = (self.len(), self.nodes.len() as u32);
        self.index = Index::default();
        self.ids.extend(&other.ids);
        self.kinds.extend(&other.kinds);
        self.properties.extend(&other.properties);
        self.data.append(&other.data);
        self.flags.append(count, &other.flags);
        let starts = other.starts.iter().skip(usize::from(!self.starts.is_empty()));
        self.starts.extend(starts.map(|start| start + nodes));
        self.nodes.extend(other.nodes.iter().map(|node| node + offset));
    }

    /// Makes the data columns as long as the table; call after the last [`EntityTable::push`].
    pub fn finish(&mut self) {
        if self.data.is_empty() {
            self.data = Fields::new(self.len(), 1);
        } else {
            self.data.grow(self.len());
        }
    }

    /// Whether all lists have one length, and each entity as many of the `nodes` as its kind asks for.
    pub(super) fn is_sound(&self, nodes: usize) -> bool {
        let count = self.ids.len();
        let starts = self.starts.first().is_none_or(|&first| first == 0)
            && self.starts.last().map_or(0, |&last| last as usize) == self.nodes.len()
            && self.starts.len() == if self.starts.is_empty() { 0 } else { count + 1 }
            && self.starts.is_sorted();
        let kinds =
            self.kinds.len() == count && self.properties.len() == count && (count == 0 || !self.starts.is_empty());
        let of_kind = |(at, kind): (usize, &&EntityKind)| {
            kind.nodes() == 0 || kind.nodes() == (self.starts[at + 1] - self.starts[at]) as usize
        };
        starts
            && kinds
            && self.nodes.iter().all(|&node| (node as usize) < nodes)
            && self.kinds.iter().enumerate().all(of_kind)
            && self.flags.is_sound(count)
    }

    /// Number of entities.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Node indices of one entity.
    pub fn nodes(&self, index: u32) -> &[u32] {
        let at = index as usize;
        &self.nodes[self.starts[at] as usize..self.starts[at + 1] as usize]
    }

    /// Reverses or replaces the node order of one entity.
    pub fn nodes_mut(&mut self, index: u32) -> &mut [u32] {
        let at = index as usize;
        &mut self.nodes[self.starts[at] as usize..self.starts[at + 1] as usize]
    }

    /// Index of the entity with that id.
    pub fn find(&self, id: usize) -> Option<u32> {
        self.index.find(&self.ids, id)
    }

    /// The largest id, 0 when empty.
    pub fn max_id(&self) -> usize {
        self.ids.iter().copied().max().unwrap_or(0)
    }
}
