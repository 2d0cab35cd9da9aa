//! Sub model parts: named, nested selections of nodes, elements and conditions.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::properties::PropertyValue;

/// A named selection; whatever a child holds its parents hold too.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SubPart {
    /// Its own name, without those of its parents.
    pub name: String,
    /// Node indices, ascending.
    pub nodes: Vec<u32>,
    /// Element indices, ascending.
    pub elements: Vec<u32>,
    /// Condition indices, ascending.
    pub conditions: Vec<u32>,
    /// Geometry indices, ascending.
    pub geometries: Vec<u32>,
    /// Constraint indices, ascending.
    pub constraints: Vec<u32>,
    /// Ids of tables attached to it.
    pub tables: Vec<usize>,
    /// Ids of properties attached to it.
    pub properties: Vec<usize>,
    /// Values stored on the part itself.
    pub data: BTreeMap<String, PropertyValue>,
    /// Nested parts by name.
    pub children: BTreeMap<String, SubPart>,
}

impl SubPart {
    /// An empty part.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// The part at a dotted path below this one; the empty path is this part.
    pub fn find(&self, path: &str) -> Option<&SubPart> {
        if path.is_empty() {
            return Some(self);
        }
        let (head, rest) = path.split_once('.').unwrap_or((path, ""));
        self.children.get(head)?.find(rest)
    }

    /// As [`SubPart::find`], to change.
    pub fn find_mut(&mut self, path: &str) -> Option<&mut SubPart> {
        if path.is_empty() {
            return Some(self);
        }
        let (head, rest) = path.split_once('.').unwrap_or((path, ""));
        self.children.get_mut(head)?.find_mut(rest)
    }

    /// Name of the smallest part below this one that holds an element.
    pub fn smallest_with_element(&self, element: u32) -> Option<&str> {
        let holds = |part: &&Self| part.elements.binary_search(&element).is_ok();
        let smallest = self.children.values().filter(holds).min_by_key(|part| part.elements.len())?;
        smallest.smallest_with_element(element).or(Some(&smallest.name))
    }

    /// Dotted paths of all parts below this one.
    pub fn paths(&self) -> Vec<String> {
        let mut out = Vec::new();
        for (name, child) in &self.children {
            out.push(name.clone());
            out.extend(child.paths().into_iter().map(|path| format!("{name}.{path}")));
        }
        out
    }

    /// Drops entities that are not kept and renumbers the rest, here and below; [`u32::MAX`] stands for dropped ones.
    pub fn renumber(&mut self, nodes: &[u32], elements: &[u32], conditions: &[u32]) {
        for (list, new) in
            [(&mut self.nodes, nodes), (&mut self.elements, elements), (&mut self.conditions, conditions)]
        {
            *list = list.iter().map(|&at| new[at as usize]).filter(|&at| at != u32::MAX).collect();
        }
        self.geometries.clear();
        self.children.values_mut().for_each(|child| child.renumber(nodes, elements, conditions));
    }

    /// Adds the selection of another part of the same name, here and below.
    pub(super) fn join(&mut self, other: &Self) {
        self.nodes.extend(&other.nodes);
        self.elements.extend(&other.elements);
        self.conditions.extend(&other.conditions);
        self.constraints.extend(&other.constraints);
        self.tables.clone_from(&other.tables);
        self.properties.clone_from(&other.properties);
        self.data.clone_from(&other.data);
        for (name, child) in &other.children {
            self.children.entry(name.clone()).or_insert_with(|| Self::new(name.clone())).join(child);
        }
    }

    /// Selects the geometries that another part of the same name does, here and below.
    pub(super) fn take_geometries(&mut self, other: &Self) {
        self.geometries.clone_from(&other.geometries);
        for (name, child) in &mut self.children {
            other.children.get(name).into_iter().for_each(|other| child.take_geometries(other));
        }
    }

    /// Adds the copies of its nodes, which stand after all others, here and below.
    pub(super) fn add_nodes_beside(&mut self, copy_of: &dyn Fn(u32) -> Option<u32>) {
        let copies: Vec<u32> = self.nodes.iter().filter_map(|&node| copy_of(node)).collect();
        self.nodes.extend(copies);
        self.children.values_mut().for_each(|child| child.add_nodes_beside(copy_of));
    }

    /// Sorts all lists and removes repetitions, here and below.
    pub fn normalise(&mut self) {
        let SubPart { nodes, elements, conditions, geometries, constraints, .. } = self;
        for list in [nodes, elements, conditions, geometries, constraints] {
            list.sort_unstable();
            list.dedup();
        }
        self.children.values_mut().for_each(SubPart::normalise);
    }
}
