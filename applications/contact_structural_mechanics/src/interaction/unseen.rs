//! Bodies in each other that contact does not see: faces that no pair names, or bodies that pass each other within a step.

use zelus_core::geometry::mapping::local_coordinates;
use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, scale, sub};

use super::late_pairs::{farthest_motion, step_start};
use crate::interface::{Facet, Interface, Roles};
use crate::search::{Bounds, Tree, inside};
use crate::solver::LARGEST_PENETRATION;
use crate::variables::NODAL_H;

/// Share of the depth that counts by which nodes may move until they are looked at again.
const STILL: f64 = 0.5;

/// What is kept of the looks at an interface.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Unseen {
    /// Way of the farthest node since the last look that found nothing (length); `None` before the first.
    moved: Option<f64>,
    /// Whether the last look found what a shorter step may not have.
    pub depends_on_step: bool,
}

impl Unseen {
    /// Why a converged state cannot be accepted: bodies are in each other by more than `"largest_penetration"` of their mesh size
    /// where no node of an interface is in contact, or nodes have gone through a master in the step. Collective.
    ///
    /// `in_contact` says whether a slave node of an interface is in contact.
    pub(super) fn why(
        &mut self,
        part: &ModelPart,
        interfaces: &[Interface],
        in_contact: impl Fn(usize) -> bool,
    ) -> Option<String> {
        let most = part.info.value_or(LARGEST_PENETRATION, 0.0);
        let idle = interfaces.iter().enumerate().filter(|(at, interface)| !interface.open && !in_contact(*at));
        let idle: Vec<&Interface> = idle.map(|(_, interface)| interface).collect();
        if most <= 0.0 || idle.is_empty() {
            return None;
        }
        let sizes = part.nodes.values.values(&NODAL_H, 0);
        let nodes: Vec<u32> = idle.iter().flat_map(|interface| interface.nodes.iter().copied()).collect();
        let finest = nodes.iter().map(|&n| sizes[n as usize]).filter(|h| *h > 0.0).fold(f64::INFINITY, f64::min);
        let motion = farthest_motion(part, &nodes);
        let moved = self.moved.map_or(f64::INFINITY, |moved| moved + 2.0 * motion);
        if moved <= STILL * most * finest {
            self.moved = Some(moved);
            return None;
        }
        let crossed = if motion > finest { idle.iter().find_map(|of| passed(part, of, most)) } else { None };
        let why = crossed.or_else(|| buried(part, &idle, most));
        self.moved = why.is_none().then_some(0.0);
        self.depends_on_step = why.is_some() && motion > most * finest;
        why
    }
}

/// Nodes of idle interfaces that are in another body.
fn buried(part: &ModelPart, idle: &[&Interface], most: f64) -> Option<String> {
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let mut points = Vec::new();
    for interface in idle {
        for role in [Roles::Slave, Roles::Master] {
            for (node, normal) in interface.normals_of(part, role) {
                let (x, size) = (part.nodes.current[node as usize], sizes[node as usize]);
                if size > 0.0 {
                    points.extend([1.0, -1.0].map(|sign| (node, add(x, scale(normal, sign * most * size)), size)));
                }
            }
        }
    }
    let mut found = inside(part, &points);
    part.ranks.any_of(&mut found);
    // Elements of the node itself do not count: another body is around it both ways along its normal.
    let deep: Vec<u32> =
        (0..points.len()).step_by(2).filter(|&at| found[at] && found[at + 1]).map(|at| points[at].0).collect();
    let first = *deep.first()?;
    let x = part.nodes.initial[first as usize];
    Some(format!(
        "no node of the contact pair is in contact, and {} of its nodes are inside a body by more than {most} of their mesh size, the first is node {} at ({}, {}, {}): a shorter \"time_step\" may let contact see it; name the faces that meet in \"contact_model_part\", move bodies apart that begin in each other, or allow it by \"largest_penetration\": 0 in \"contact_settings\"",
        deep.len(),
        part.nodes.ids[first as usize],
        x[0],
        x[1],
        x[2]
    ))
}

/// Slave nodes that were before a master facet when the step began and have gone through it, by straight ways.
fn passed(part: &ModelPart, interface: &Interface, most: f64) -> Option<String> {
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let masters: Vec<&Facet> = interface.facets.iter().filter(|facet| facet.role == Roles::Master).collect();
    let at = |share: f64| move |n: u32| along(step_start(part, n), part.nodes.current[n as usize], share);
    let places = |facet: &Facet, share: f64| -> Vec<[f64; 3]> { facet.nodes.iter().map(|&n| at(share)(n)).collect() };
    let swept = masters.iter().map(|facet| Bounds::of(&[places(facet, 0.0), places(facet, 1.0)].concat()));
    let tree = Tree::new(swept.collect());
    let goes_through = |node: u32, facet: &Facet| {
        let height = |share: f64| {
            let places = places(facet, share);
            dot(sub(at(share)(node), places[0]), facet.normal_at(&places))
        };
        let (before, after) = (height(0.0), height(1.0));
        let depth = most * sizes[node as usize];
        if !(before > -depth && after < -depth) {
            return false;
        }
        let share = before.max(0.0) / (before.max(0.0) - after);
        local_coordinates(facet.shape, &places(facet, share), at(share)(node))
            .is_some_and(|found| facet.shape.cell().contains(found.xi, 0.0))
    };
    let through = |&node: &u32| {
        let way = Bounds::of(&[at(0.0)(node), at(1.0)(node)]);
        tree.meeting(&way).into_iter().any(|master| goes_through(node, masters[master as usize]))
    };
    let nodes: Vec<u32> = interface.nodes_of(Roles::Slave).into_iter().filter(through).collect();
    let first = *nodes.first()?;
    let (id, [x, y, z]) = (part.nodes.ids[first as usize], part.nodes.initial[first as usize]);
    let count = nodes.len();
    Some(format!(
        "{count} slave nodes go through the master within the step, the first is node {id} at ({x}, {y}, {z})"
    ))
}

fn along(from: [f64; 3], to: [f64; 3], share: f64) -> [f64; 3] {
    add(from, scale(sub(to, from), share))
}
