//! Roles of facets whose sides a deck leaves open: each facet that meets others becomes a slave, those masters.

use std::cmp::Ordering;
use std::collections::{BTreeMap, VecDeque};

use zelus_core::model::ModelPart;
use zelus_core::vector3::{dot, sub};

use super::candidates::{FacetExtent, SearchSettings, among};
use crate::interface::{Interface, Roles};

/// Gives every facet of an open interface its role for this configuration.
///
/// Facets are visited along shared nodes, in an order given by where they are (the reference program's is that of their
/// numbers). One without a role that faces others becomes a slave, and
/// those of them that share no node with it nor with another slave become masters. A facet some of whose nodes are masters
/// is a master; one that meets nothing stays open.
pub fn assign_roles(part: &ModelPart, interface: &mut Interface, settings: &SearchSettings) {
    let count = interface.facets.len() as u32;
    let all: Vec<u32> = (0..count).collect();
    interface.facets.iter_mut().for_each(|f| f.role = Roles::Open);
    let mut facing: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for candidate in among(part, interface, &all, &all, settings, false).into_iter().filter(|c| c.within_reach) {
        let (a, b) = (&interface.facets[candidate.slave as usize], &interface.facets[candidate.master as usize]);
        let apart = a.nodes.iter().all(|n| !b.nodes.contains(n));
        let (from, to) = (FacetExtent::of(part, a), FacetExtent::of(part, b));
        // the two sides of one body look away from each other, farther behind than a facet that has come through
        let ahead = dot(sub(to.centre, from.centre), from.normal) > -from.radius;
        if apart && ahead && dot(from.normal, to.normal) < 0.0 {
            facing.entry(candidate.slave).or_default().push(candidate.master);
        }
    }
    let mut side: BTreeMap<u32, Roles> = BTreeMap::new();
    for facet in walk(part, interface) {
        let nodes = interface.facets[facet as usize].nodes.clone();
        if interface.facets[facet as usize].role != Roles::Open
            || nodes.iter().any(|n| side.get(n) == Some(&Roles::Master))
        {
            continue;
        }
        let found: Vec<u32> = facing
            .get(&facet)
            .into_iter()
            .flatten()
            .copied()
            .filter(|&other| {
                interface.facets[other as usize]
                    .nodes
                    .iter()
                    .all(|n| side.get(n) != Some(&Roles::Slave) && !nodes.contains(n))
            })
            .collect();
        if found.is_empty() {
            continue;
        }
        interface.facets[facet as usize].role = Roles::Slave;
        nodes.iter().for_each(|&n| _ = side.insert(n, Roles::Slave));
        for other in found {
            let other = &mut interface.facets[other as usize];
            other.role = Roles::Master;
            other.nodes.iter().for_each(|&n| _ = side.insert(n, Roles::Master));
        }
    }
    for facet in &mut interface.facets {
        let is = |role| facet.nodes.iter().any(|n| side.get(n) == Some(&role));
        if facet.role == Roles::Slave && is(Roles::Master) {
            facet.role = Roles::Open;
        }
    }
}

/// Facets in the order in which they are reached over shared nodes, from that with the largest coordinates on.
///
/// The order comes from initial coordinates alone, so that numbering a mesh otherwise changes no role.
fn walk(part: &ModelPart, interface: &Interface) -> Vec<u32> {
    let mut of_node: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let in_space = order_in_space(part, interface);
    for &facet in &in_space {
        interface.facets[facet as usize].nodes.iter().for_each(|&n| of_node.entry(n).or_default().push(facet));
    }
    let mut place = vec![0u32; in_space.len()];
    in_space.iter().enumerate().for_each(|(at, &facet)| place[facet as usize] = at as u32);
    let mut seen = vec![false; in_space.len()];
    let mut order = Vec::with_capacity(in_space.len());
    let mut next: Vec<u32> = Vec::new();
    for start in in_space {
        let mut queue = VecDeque::from([start]);
        while let Some(facet) = queue.pop_front() {
            if std::mem::replace(&mut seen[facet as usize], true) {
                continue;
            }
            order.push(facet);
            next.clear();
            next.extend(interface.facets[facet as usize].nodes.iter().flat_map(|node| &of_node[node]));
            next.retain(|&f| !seen[f as usize]);
            next.sort_unstable_by_key(|&f| place[f as usize]);
            next.dedup();
            queue.extend(&next);
        }
    }
    order
}

/// Facets sorted by their nodes' initial coordinates, the largest first, those on the same points by their normals.
fn order_in_space(part: &ModelPart, interface: &Interface) -> Vec<u32> {
    let descending = |a: &[f64; 3], b: &[f64; 3]| {
        a.iter().zip(b).map(|(a, b)| b.total_cmp(a)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
    };
    let keys: Vec<(Vec<[f64; 3]>, [f64; 3])> = interface
        .facets
        .iter()
        .map(|facet| {
            let mut points: Vec<[f64; 3]> = facet.nodes.iter().map(|&n| part.nodes.initial[n as usize]).collect();
            points.sort_unstable_by(descending);
            (points, FacetExtent::of(part, facet).normal)
        })
        .collect();
    let mut order: Vec<u32> = (0..keys.len() as u32).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (&keys[a as usize], &keys[b as usize]);
        let points = a.0.iter().zip(&b.0).map(|(a, b)| descending(a, b)).find(|o| o.is_ne());
        points.unwrap_or_else(|| a.0.len().cmp(&b.0.len()).then_with(|| descending(&a.1, &b.1)))
    });
    order
}
