//! Pairs sorted by the shapes of their facets, which is how they become blocks.

use std::collections::BTreeMap;

use zelus_core::geometry::Shape;

use super::pair::PairKey;
use crate::interface::Interface;

/// Pairs of the same shapes (slave, master), and their node indices: master nodes, then slave nodes.
pub type Groups<T> = BTreeMap<(Shape, Shape), (Vec<T>, Vec<u32>)>;

/// Sorts `pairs`, whose facets `key` names, by shapes.
pub fn group_by_shapes<T>(
    interfaces: &[Interface],
    pairs: impl IntoIterator<Item = T>,
    key: impl Fn(&T) -> PairKey,
) -> Groups<T> {
    let mut groups: Groups<T> = BTreeMap::new();
    for pair in pairs {
        let key = key(&pair);
        let facets = &interfaces[key.interface as usize].facets;
        let (slave, master) = (&facets[key.slave as usize], &facets[key.master as usize]);
        let (group, nodes) = groups.entry((slave.shape, master.shape)).or_default();
        nodes.extend(&master.nodes);
        nodes.extend(&slave.nodes);
        group.push(pair);
    }
    groups
}

/// Kratos' name of the condition of a pair of shapes; `stem` is the name up to the shape.
pub fn condition_name(stem: &str, slave: Shape, master: Shape) -> String {
    let dimension = if slave == Shape::Line2 { 2 } else { 3 };
    let mixed = if slave == master { String::new() } else { format!("{}N", master.nodes()) };
    format!("{stem}{dimension}D{}N{mixed}", slave.nodes())
}
