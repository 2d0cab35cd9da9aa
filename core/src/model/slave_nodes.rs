//! Slave nodes: owners of unknowns beside mesh nodes, several at one mesh node where several interfaces meet there.
//!
//! A slave node is a pair (set, mesh node). Its position, id, fixities and rank are those of its mesh node. Its unknowns have
//! columns of their own.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::fields::Fields;
use super::owner::Owner;

/// A named set of slave nodes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct SlaveSet {
    name: String,
    /// Slave nodes of this set and of those before it.
    end: u32,
}

/// All slave nodes of a model part, set after set; an index counts them.
///
/// Over ranks each has the slave nodes at its mesh nodes. The sets of a stage's interfaces are whole and in one order on all
/// ranks, since every rank has all nodes of these; sets of earlier stages may not be.
///
/// Columns have the time levels of the columns of nodes, see [`ModelPart::set_levels`](super::ModelPart::set_levels).
///
/// ```
/// use zelus_core::model::SlaveNodes;
///
/// let mut slave_nodes = SlaveNodes::default();
/// let floor = slave_nodes.set("floor", &[3, 7]);
/// let wall = slave_nodes.set("wall", &[7, 8]);
/// assert_eq!((floor, wall), (0..2, 2..4));
/// // The mesh node 7 has two slave nodes.
/// assert_eq!(["floor", "wall"].map(|name| slave_nodes.find(name, 7)), [Some(1), Some(2)]);
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SlaveNodes {
    sets: Vec<SlaveSet>,
    mesh_nodes: Vec<u32>,
    /// Columns with history, one entry a slave node.
    pub history: Fields,
}

impl SlaveNodes {
    /// Number of slave nodes.
    pub fn len(&self) -> usize {
        self.mesh_nodes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.mesh_nodes.is_empty()
    }

    /// Indices of the slave nodes at these mesh nodes (ascending), which form the set of that name.
    ///
    /// A set that is there with the same mesh nodes stays as it is, so that its values last from stage to stage and over a restart. A
    /// set of that name with other mesh nodes is replaced by the new one: values stay at mesh nodes that both have and are zero
    /// elsewhere. Sets of other names keep their values, but those after a set that grows or shrinks get other indices. Sets therefore
    /// change at the initialisation of a stage alone, before unknowns are numbered, and [`SlaveNodes::range`] tells the indices once
    /// all sets are made.
    ///
    /// # Panics
    /// When mesh nodes do not strictly ascend.
    pub fn set(&mut self, name: &str, mesh_nodes: &[u32]) -> Range<u32> {
        assert!(mesh_nodes.windows(2).all(|pair| pair[0] < pair[1]), "mesh nodes of a set of slave nodes ascend");
        let Some(place) = self.sets.iter().position(|set| set.name == name) else {
            self.sets.push(SlaveSet { name: name.to_owned(), end: self.len() as u32 });
            self.replace(self.sets.len() - 1, mesh_nodes);
            return self.range_at(self.sets.len() - 1);
        };
        if &self.mesh_nodes[indices(self.range_at(place))] != mesh_nodes {
            self.replace(place, mesh_nodes);
        }
        self.range_at(place)
    }

    /// Indices of the slave nodes of a set; `None` where there is no set of that name.
    pub fn range(&self, name: &str) -> Option<Range<u32>> {
        self.sets.iter().position(|set| set.name == name).map(|place| self.range_at(place))
    }

    /// Index of the slave node of a set at a mesh node.
    pub fn find(&self, name: &str, mesh_node: u32) -> Option<u32> {
        let range = self.range(name)?;
        let at = self.mesh_nodes[indices(range.clone())].binary_search(&mesh_node).ok()?;
        Some(range.start + at as u32)
    }

    /// The owner of unknowns at a mesh node: the slave node of a set, or without one the mesh node itself; `None` where the set has no
    /// slave node there.
    pub fn owner(&self, set: Option<&str>, mesh_node: u32) -> Option<Owner> {
        match set {
            Some(set) => self.find(set, mesh_node).map(Owner::Slave),
            None => Some(Owner::Node(mesh_node)),
        }
    }

    /// Mesh node of a slave node.
    pub fn mesh_node(&self, slave: u32) -> u32 {
        self.mesh_nodes[slave as usize]
    }

    /// Mesh node of each slave node.
    pub fn mesh_nodes(&self) -> &[u32] {
        &self.mesh_nodes
    }

    /// Names of the sets with the indices of their slave nodes.
    pub fn sets(&self) -> impl Iterator<Item = (&str, Range<u32>)> {
        self.sets.iter().enumerate().map(|(place, set)| (set.name.as_str(), self.range_at(place)))
    }

    /// All slave nodes in the order of their mesh nodes; those at one mesh node ascend.
    pub fn by_mesh_node(&self) -> Vec<u32> {
        let mut all: Vec<u32> = (0..self.len() as u32).collect();
        all.sort_by_key(|&slave| self.mesh_node(slave));
        all
    }

    /// Whether both have the same sets at the same mesh nodes.
    pub fn is_alike(&self, other: &Self) -> bool {
        self.sets == other.sets && self.mesh_nodes == other.mesh_nodes
    }

    fn range_at(&self, place: usize) -> Range<u32> {
        let start = place.checked_sub(1).map_or(0, |before| self.sets[before].end);
        start..self.sets[place].end
    }

    /// Gives the set at a place other mesh nodes.
    fn replace(&mut self, place: usize, mesh_nodes: &[u32]) {
        let (range, count) = (self.range_at(place), self.len() as u32);
        let old = &self.mesh_nodes[indices(range.clone())];
        // The item after the last one holds zeros.
        let item = |node: &u32| old.binary_search(node).map_or(count, |at| range.start + at as u32);
        let mut items: Vec<u32> = (0..range.start).collect();
        items.extend(mesh_nodes.iter().map(item));
        items.extend(range.end..count);
        self.history.grow(count as usize + 1);
        self.history = self.history.pick(&items);
        self.mesh_nodes.splice(indices(range.clone()), mesh_nodes.iter().copied());
        for set in &mut self.sets[place..] {
            set.end = set.end - (range.end - range.start) + mesh_nodes.len() as u32;
        }
    }

    /// Slave nodes at kept mesh nodes, whose new indices ascend as the old ones do; [`u32::MAX`] stands for nodes that are dropped.
    /// Sets that lose all their nodes stay as empty ones.
    pub(super) fn kept(&self, new_nodes: &[u32]) -> Self {
        let new = |slave: u32| Some(new_nodes[self.mesh_node(slave) as usize]).filter(|&node| node != u32::MAX);
        let kept: Vec<u32> = (0..self.len() as u32).filter(|&slave| new(slave).is_some()).collect();
        let end = |set: &SlaveSet| kept.partition_point(|&slave| slave < set.end) as u32;
        Self {
            sets: self.sets.iter().map(|set| SlaveSet { name: set.name.clone(), end: end(set) }).collect(),
            mesh_nodes: kept.iter().filter_map(|&slave| new(slave)).collect(),
            history: self.history.pick(&kept),
        }
    }

    /// The slave nodes of a mesh of which ranks have `shares`: with each the place of each of its mesh nodes in the whole mesh,
    /// and whether the rank owns it. Values are those of the owners.
    ///
    /// # Errors
    /// Shares with different sets.
    pub(super) fn merged(shares: &[(&Self, &[u32], Vec<bool>)]) -> Result<Self, String> {
        let Some((first, ..)) = shares.first() else { return Ok(Self::default()) };
        let names = |own: &Self| own.sets.iter().map(|set| set.name.clone()).collect::<Vec<_>>();
        if shares.iter().any(|(own, ..)| names(own) != names(first)) {
            return Err("its ranks have different sets of slave nodes".to_owned());
        }
        let mut all = first.history.pick(&[]);
        let mut chosen = Vec::new();
        for (own, places, owned) in shares {
            let offset = all.len() as u32;
            all.append(&own.history);
            for set in 0..own.sets.len() {
                let slaves = own.range_at(set).map(|slave| (slave, own.mesh_node(slave) as usize));
                chosen.extend(slaves.filter(|(_, node)| owned[*node]).map(|(s, node)| (set, places[node], offset + s)));
            }
        }
        chosen.sort_unstable();
        let items: Vec<u32> = chosen.iter().map(|(.., item)| *item).collect();
        let end = |set: usize| chosen.partition_point(|(of, ..)| *of <= set) as u32;
        let sets = first.sets.iter().enumerate().map(|(at, set)| SlaveSet { name: set.name.clone(), end: end(at) });
        Ok(Self {
            sets: sets.collect(),
            mesh_nodes: chosen.iter().map(|(_, place, _)| *place).collect(),
            history: all.pick(&items),
        })
    }

    /// Whether they can be those of a mesh of so many nodes.
    pub(super) fn is_sound(&self, nodes: usize) -> bool {
        let ends: Vec<u32> = self.sets.iter().map(|set| set.end).collect();
        let counted = ends.is_sorted() && ends.last().map_or(0, |&end| end as usize) == self.len();
        let ascends = |list: &[u32]| list.windows(2).all(|pair| pair[0] < pair[1]);
        counted
            && (0..self.sets.len()).all(|place| ascends(&self.mesh_nodes[indices(self.range_at(place))]))
            && self.mesh_nodes.iter().all(|&node| (node as usize) < nodes)
    }
}

fn indices(range: Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::test_variables::NORMAL;

    fn made() -> SlaveNodes {
        let mut made = SlaveNodes::default();
        made.set("floor", &[1, 4]);
        made.set("wall", &[4, 5, 9]);
        let values = made.history.values_mut(&NORMAL, 0);
        values.iter_mut().enumerate().for_each(|(at, value)| *value = at as f64);
        made
    }

    fn firsts(slave_nodes: &SlaveNodes) -> Vec<f64> {
        slave_nodes.history.values(&NORMAL, 0).iter().step_by(3).copied().collect()
    }

    #[test]
    fn a_set_that_is_there_stays() {
        let mut known = made();
        assert_eq!(known.set("wall", &[4, 5, 9]), 2..5);
        assert_eq!(known, made());
        assert_eq!((known.find("wall", 4), known.find("floor", 5), known.find("roof", 4)), (Some(2), None, None));
        assert_eq!(known.by_mesh_node(), [0, 1, 2, 3, 4]);
    }

    #[test]
    fn a_set_with_other_nodes_keeps_the_values_of_nodes_of_both() {
        let mut changed = made();
        assert_eq!(changed.set("floor", &[0, 4, 6]), 0..3);
        assert_eq!(changed.range("wall"), Some(3..6));
        assert_eq!(changed.mesh_nodes(), [0, 4, 6, 4, 5, 9]);
        assert_eq!(firsts(&changed), [0.0, 3.0, 0.0, 6.0, 9.0, 12.0]);
        assert_eq!(changed.by_mesh_node(), [0, 1, 3, 4, 2, 5]);
        assert!(changed.is_sound(10) && !changed.is_sound(9));
        changed.set("floor", &[]);
        assert_eq!((changed.range("floor"), changed.range("wall")), (Some(0..0), Some(0..3)));
    }

    #[test]
    fn shares_join_to_the_whole() {
        let whole = made();
        let new = |kept: &[u32]| {
            let mut new = vec![u32::MAX; 10];
            kept.iter().enumerate().for_each(|(at, &node)| new[node as usize] = at as u32);
            new
        };
        let places: [&[u32]; 2] = [&[1, 4, 5, 6], &[4, 5, 9]];
        let [mut a, b] = places.map(|places| whole.kept(&new(places)));
        assert_eq!(a.mesh_nodes(), [0, 1, 1, 2]);
        assert_eq!(firsts(&b), [3.0, 6.0, 9.0, 12.0]);
        // A copy counts for nothing.
        a.history.values_mut(&NORMAL, 0)[9..].fill(-1.0);
        let owned = [vec![true, true, false, true], vec![false, true, true]];
        let [of_a, of_b] = owned;
        let joined = SlaveNodes::merged(&[(&a, places[0], of_a), (&b, places[1], of_b)]).expect("a whole");
        assert_eq!(joined, whole);
    }
}
