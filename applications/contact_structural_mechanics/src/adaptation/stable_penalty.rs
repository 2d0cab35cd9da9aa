//! The stiffest penalty that explicit steps carry.
//!
//! Springs ε A of the slave nodes add to ω² of the bodies at most 2 ε max a/m over the nodes of the interfaces, with the area a of
//! their facets that is a node's and its mass m: (B x)² ≤ ‖B‖₁ Σ |B_i| x_i² for the operator B of a node, whose entries add up to
//! its area on either side. Steps Δt are stable below ω² = 4/Δt², of which the bodies take 4/Δt_c².
//!
//! A free rigid shape is one node of that kind: its area is the sum over its pairs of that of the smaller side, and its mass m, or with a
//! free rotation 1/(1/m + r²/J) with the longest arm r of its facets.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::geometry::parts;
use zelus_core::model::{MasterSlaveConstraint, ModelPart};
use zelus_core::strategies::CRITICAL_STEP;
use zelus_core::vector3::{norm, sub};
use zelus_structural_mechanics::variables::{DISPLACEMENT, NODAL_MASS, ROTATION};

use crate::flags::CONTACT;
use crate::interface::{Facet, Interface};
use crate::slave_nodes::SlaveStates;
use crate::variables::INITIAL_PENALTY;

/// Share of ω² that contact has even where bodies leave it less: longer steps are warned of anyway.
const LEAST: f64 = 0.05;

/// Loads of the nodes that limit the penalty of explicit steps.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct StablePenalty {
    /// Largest a/m and area a of the nodes that move (area by mass, area).
    load: Option<[f64; 2]>,
    said: bool,
}

impl StablePenalty {
    /// Step start: lowers the penalty of all nodes to one that is stable for the step, and never raises it: a spring that stiffens
    /// under load makes energy. A penalty that is `given`, or `weighted` and so by area, stays, with a warning.
    ///
    /// `revolution` is the area of a facet by length and radius where the plane is rotated, `stiffened` the factor by which the
    /// penalty grows with the gap, `delta_time_factor` that of steps with contact.
    pub(crate) fn begin_step(
        &mut self,
        part: &mut ModelPart,
        states: &mut SlaveStates,
        interfaces: &[Interface],
        revolution: Option<f64>,
        stiffened: f64,
        given: bool,
        weighted: bool,
        delta_time_factor: f64,
    ) -> Option<Diagnostic> {
        let [load, area] = *self.load.get_or_insert_with(|| load(part, interfaces, revolution));
        let factor = if part.info.is(CONTACT) { 1.0 } else { delta_time_factor };
        let step = part.info.delta_time * factor;
        let critical = part.info.value_or(CRITICAL_STEP, f64::INFINITY);
        let square = 4.0 / (step * step) * (1.0 - (step / critical).powi(2)).max(LEAST);
        let most = square / (2.0 * load * stiffened) / if weighted { area } else { 1.0 };
        let penalty = part.info.value_or(INITIAL_PENALTY.name(), 0.0);
        if penalty <= most {
            return None;
        }
        let fixed = given || weighted;
        if !fixed {
            part.info.values.insert(INITIAL_PENALTY.name(), most);
            states.for_all(|state| state.parameters.penalty = state.parameters.penalty.min(most));
        }
        let says = !std::mem::replace(&mut self.said, true);
        says.then(|| if fixed { warn(step, penalty, most) } else { note(step, penalty, most) })
    }
}

fn warn(step: f64, penalty: f64, most: f64) -> Diagnostic {
    let fact = format!("steps of {step:.3e} are stable up to a penalty of {most:.3e}, and it is {penalty:.3e}");
    Diagnostic::warning("contact-step", fact).remedy(
        "the motion can grow without bound while there is contact: shorten \"time_step\", or leave the penalty to the estimate",
    )
}

fn note(step: f64, penalty: f64, most: f64) -> Diagnostic {
    let fact = format!(
        "the penalty is lowered from {penalty:.3e} to {most:.3e}, the largest stable one for steps of {step:.3e}"
    );
    Diagnostic::note("contact-step", fact)
}

/// Largest a/m of the nodes and rigid shapes of the interfaces that can move, and the largest area of such nodes.
fn load(part: &ModelPart, interfaces: &[Interface], revolution: Option<f64>) -> [f64; 2] {
    let ring = |node: u32| revolution.map_or(1.0, |factor| factor * part.nodes.current[node as usize][0].abs());
    let shares = |facet: &Facet| {
        let size = facet.size(part);
        let of_node = |(local, &node): (usize, &u32)| (node, size / parts(facet.shape, local) * ring(node));
        facet.nodes.iter().enumerate().map(of_node).collect::<Vec<(u32, f64)>>()
    };
    let mut areas = vec![0.0; part.nodes.len()];
    for (node, area) in interfaces.iter().flat_map(|interface| &interface.facets).flat_map(shares) {
        areas[node as usize] += area;
    }
    let masses = part.nodes.values.values(&NODAL_MASS, 0);
    let nodes = (0..areas.len()).filter(|&at| areas[at] > 0.0 && masses[at] > 0.0);
    let nodes = nodes.filter(|&at| moves(part, at as u32));
    let [of_nodes, area] =
        nodes.fold([0.0, 0.0], |[load, area], at| [f64::max(load, areas[at] / masses[at]), f64::max(area, areas[at])]);
    let area_of = |facet: &Facet| shares(facet).iter().map(|(_, area)| area).sum();
    let of_shapes = touched_shapes(part, interfaces, area_of).into_values();
    [of_shapes.map(|shape| shape.area * shape.softness(part, masses)).fold(of_nodes, f64::max), area]
}

/// Whether a node may move.
fn moves(part: &ModelPart, node: u32) -> bool {
    (0..part.info.domain_size as u8).any(|c| !part.nodes.is_fixed(DISPLACEMENT.component(c), node))
}

/// A rigid shape in contact pairs.
#[derive(Debug, Default)]
struct TouchedShape {
    reference: u32,
    /// Nodes that follow the reference node: of facets, and of masses.
    followers: Vec<u32>,
    /// Largest distance of its facets from the reference node (length).
    arm: f64,
    /// Most that the other sides of its pairs can touch (area).
    area: f64,
}

impl TouchedShape {
    /// 1/m + r²/J of the motions that supports leave it, of a body without mass 0 (1/mass).
    fn softness(&self, part: &ModelPart, masses: &[f64]) -> f64 {
        let nodes = self.followers.iter().chain([&self.reference]);
        let [mass, moment] = nodes.fold([0.0; 2], |[mass, moment], &node| {
            let own = masses[node as usize];
            [mass + own, moment + own * arm(part, node, self.reference).powi(2)]
        });
        let mut rotations = if part.info.domain_size == 2 { 2..3 } else { 0..3 };
        let rotates = rotations.any(|c| !part.nodes.is_fixed(ROTATION.component(c), self.reference));
        let translation = if moves(part, self.reference) && mass > 0.0 { mass.recip() } else { 0.0 };
        translation + if rotates && moment > 0.0 { self.arm * self.arm / moment } else { 0.0 }
    }
}

/// Distance of two nodes in the initial geometry (length).
fn arm(part: &ModelPart, node: u32, other: u32) -> f64 {
    norm(sub(part.nodes.initial[node as usize], part.nodes.initial[other as usize]))
}

/// The rigid shapes of the interfaces, by their reference nodes, with the areas of all their pairs.
fn touched_shapes(
    part: &ModelPart,
    interfaces: &[Interface],
    area_of: impl Fn(&Facet) -> f64,
) -> BTreeMap<u32, TouchedShape> {
    let mut shapes = BTreeMap::<u32, TouchedShape>::new();
    if !interfaces.iter().flat_map(|interface| &interface.facets).any(Facet::is_rigid) {
        return shapes;
    }
    let variable = DISPLACEMENT.component(0);
    let followed = |own: &MasterSlaveConstraint| {
        let ((master, _), _) = own.masters.iter().find(|((_, of), _)| own.slave.1 == variable && *of == variable)?;
        Some((own.slave.0, *master))
    };
    let references: BTreeMap<u32, u32> = part.constraints.iter().filter_map(followed).collect();
    for interface in interfaces {
        let (rigid, others): (Vec<&Facet>, Vec<&Facet>) = interface.facets.iter().partition(|facet| facet.is_rigid());
        let mut own = BTreeMap::<u32, f64>::new();
        for facet in rigid {
            let Some(&reference) = references.get(&facet.nodes[0]) else { continue };
            let shape = shapes.entry(reference).or_default();
            shape.reference = reference;
            shape.arm = facet.nodes.iter().map(|&node| arm(part, node, reference)).fold(shape.arm, f64::max);
            *own.entry(reference).or_default() += area_of(facet);
        }
        let other: f64 = others.into_iter().map(&area_of).sum();
        for (reference, area) in own {
            shapes.entry(reference).or_default().area += area.min(other);
        }
    }
    for (&node, reference) in &references {
        shapes.entry(*reference).and_modify(|shape| shape.followers.push(node));
    }
    shapes
}
