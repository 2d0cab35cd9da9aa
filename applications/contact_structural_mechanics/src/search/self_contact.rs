//! Roles of facets whose sides a deck leaves open: each facet that meets others becomes a slave, those masters.

use std::collections::BTreeMap;

use zelus_core::model::ModelPart;
use zelus_core::vector3::dot;

use super::candidates::SearchSettings;
use super::meetings::{FACING, facing};
use super::open_sides::{OpenSides, Renewal};
use super::side_order::walk;
use crate::interface::{Interface, Roles, SlaveIndex};

/// Gives the facets of an open interface their roles for this configuration; says whether any has changed.
///
/// Facets that meet another body come first, surface by surface, then the others. One that meets others and has no role becomes a slave, and
/// those it meets that share no node with it nor with another slave become masters. Facets that share a node of a patch
/// are on one side; one that meets nothing stays open. A body may be the slave on one of its faces and the master on the next.
pub fn assign_roles(
    part: &ModelPart,
    interface: &mut Interface,
    known: &OpenSides<'_>,
    settings: &SearchSettings,
    renewal: Renewal,
) -> bool {
    let facing = facing(part, interface, known.bodies, settings, renewal);
    let order = walk(part, interface, known, &facing);
    let before: Vec<Roles> = interface.facets.iter().map(|facet| facet.role).collect();
    let mut sides = Sides::new(part, interface, known);
    match renewal {
        Renewal::All => interface.facets.iter_mut().for_each(|facet| facet.role = Roles::Open),
        Renewal::Open => {
            for (at, facet) in interface.facets.iter().enumerate().filter(|(_, facet)| facet.role != Roles::Open) {
                sides.take(at as u32, &facet.nodes, facet.role);
            }
        }
    }
    for facet in order {
        let own = &interface.facets[facet as usize];
        if own.role == Roles::Master || !sides.may_be(facet, &own.nodes, Roles::Slave) {
            continue;
        }
        let may_be_master = |&at: &u32| {
            let other = &interface.facets[at as usize];
            other.nodes.iter().all(|n| !own.nodes.contains(n)) && sides.may_be(at, &other.nodes, Roles::Master)
        };
        let found: Vec<u32> = facing.get(&facet).into_iter().flatten().copied().filter(may_be_master).collect();
        if found.is_empty() {
            continue;
        }
        for (at, role) in [(facet, Roles::Slave)].into_iter().chain(found.into_iter().map(|at| (at, Roles::Master))) {
            let facet = &mut interface.facets[at as usize];
            if std::mem::replace(&mut facet.role, role) != role {
                sides.take(at, &facet.nodes, role);
            }
        }
    }
    interface.facets.iter().zip(before).any(|(facet, before)| facet.role != before)
}

/// The sides of mesh nodes by their facets.
struct Sides<'a> {
    /// Normals of facets.
    normals: Vec<[f64; 3]>,
    /// Slave nodes of facets.
    own: Vec<&'a [SlaveIndex]>,
    /// At a mesh node the facets with a role, and their slave nodes there.
    at: BTreeMap<u32, Vec<(u32, SlaveIndex, Roles)>>,
}

impl<'a> Sides<'a> {
    fn new(part: &ModelPart, interface: &Interface, known: &OpenSides<'a>) -> Self {
        Self {
            normals: interface.facets.iter().map(|facet| facet.normal(part)).collect(),
            own: (0..interface.facets.len() as u32).map(|facet| known.nodes(interface, facet)).collect(),
            at: BTreeMap::new(),
        }
    }

    /// Whether a facet with these mesh nodes may have this role: no facet of the other side shares a slave node with it, nor a mesh
    /// node where both face each other, as at the tip of a slit.
    fn may_be(&self, facet: u32, nodes: &[u32], role: Roles) -> bool {
        let normal = self.normals[facet as usize];
        let mut with_own = nodes.iter().zip(self.own[facet as usize]);
        with_own.all(|(node, own)| {
            let conflicts = |(other, at, side): &(u32, SlaveIndex, Roles)| {
                *side != role && (at == own || -dot(self.normals[*other as usize], normal) > FACING)
            };
            !self.at.get(node).is_some_and(|at| at.iter().any(conflicts))
        })
    }

    fn take(&mut self, facet: u32, nodes: &[u32], role: Roles) {
        for (&node, &own) in nodes.iter().zip(self.own[facet as usize]) {
            self.at.entry(node).or_default().push((facet, own, role));
        }
    }
}
