//! Friction at the nodes: coefficients of a run, stick at step start, the direction of sliding in every iteration.

use std::collections::BTreeMap;

use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::flags::SLIP;
use zelus_core::model::{ModelPart, variables::NORMAL};
use zelus_core::vector3::{add, dot, norm, scale};

use super::activation;
use super::step_parameters::StepParameters;
use crate::active_set::{Margin, SlipRule};
use crate::formulations::NodeState;
use crate::friction_law::{COULOMB, FrictionLaw};
use crate::interface::Interface;
use crate::mortar::tangential;
use crate::pairs::{Friction, Multiplier};
use crate::variables::NODAL_H;

/// Slip, in mesh sizes, below which its direction says nothing.
const LEAST_SLIP: f64 = 1e-6;

/// What a deck chooses about friction.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionSettings {
    /// The law (`frictional_law`).
    pub law: &'static FrictionLaw,
    /// Coefficient by key of the pair, for surfaces whose properties have none.
    pub coefficients: BTreeMap<String, f64>,
    /// How far below its bound a sliding node sticks again (`slip_augmentation_coefficient`, `slip_threshold`).
    pub margin: Margin,
    /// Whether in the plane a node keeps the direction in which it began to slide (`sliding_direction`).
    pub keeps_direction: bool,
    /// Every so many steps all nodes start in stick; `None` for never (`slip_step_reset_frequency`).
    pub reset_frequency: Option<usize>,
}

impl Default for FrictionSettings {
    fn default() -> Self {
        let (coefficients, reset_frequency) = (BTreeMap::new(), None);
        Self { law: &COULOMB, coefficients, margin: Margin::default(), keeps_direction: true, reset_frequency }
    }
}

/// Writes the number of the law, the mean over the facets of a node, and says how stick and slip are told apart.
/// Facets whose properties have none count with the pair's coefficient where the law takes one, else with what the node
/// has. Without a number anywhere, contact always slides.
pub(super) fn prepare(
    part: &mut ModelPart,
    interfaces: &[Interface],
    settings: &FrictionSettings,
    friction: Friction,
) -> SlipRule {
    let mut sums = vec![(0.0, 0_usize); part.nodes.len()];
    let mut largest = 0.0_f64;
    let law = settings.law;
    let written = part.nodes.values.values(law.variable, 0);
    for interface in interfaces {
        let given = settings.coefficients.get(&interface.key).copied().filter(|c| law.by_coefficients && *c > 0.0);
        for facet in &interface.facets {
            let own = part.properties.get(&facet.properties).and_then(|p| p.number(law.variable.name()));
            for &node in &facet.nodes {
                let nodal = written.get(node as usize).copied().filter(|number| *number > 0.0);
                let coefficient = own.or(given).or(nodal).unwrap_or(0.0);
                largest = largest.max(coefficient);
                let (sum, count) = &mut sums[node as usize];
                *sum += coefficient;
                *count += 1;
            }
        }
    }
    let column = part.nodes.values.values_mut(law.variable, 0);
    for (slot, (sum, count)) in column.iter_mut().zip(sums) {
        *slot = sum / count.max(1) as f64;
    }
    if friction == Friction::PureSlip || largest <= 0.0 { SlipRule::Pure } else { SlipRule::Bounded(settings.margin) }
}

/// Step start: every so many steps the nodes with friction begin in stick.
pub(super) fn start_in_stick(part: &mut ModelPart, slaves: &[u32], rule: SlipRule, settings: &FrictionSettings) {
    if rule == SlipRule::Pure || settings.reset_frequency.is_none_or(|f| !part.info.step.is_multiple_of(f)) {
        return;
    }
    for &node in slaves {
        let smooth = settings.law.bound_at(&part.nodes, node as usize).is_smooth();
        part.nodes.flags.set(SLIP, node as usize, smooth);
    }
}

/// Puts the tractions of sliding nodes exactly at their bound: tolerances leave a little more or less, which is much where
/// the pressure is small.
pub(super) fn meet_bounds(
    part: &mut ModelPart,
    slaves: &[u32],
    multiplier: Multiplier,
    law: &FrictionLaw,
    scale_factor: f64,
) {
    let Multiplier::Vector(variable) = multiplier else { return };
    for at in slaves.iter().map(|&n| n as usize) {
        if NodeState::of_flags(&part.nodes.flags, at) != NodeState::Slip {
            continue;
        }
        let normal = part.nodes.history.get(NORMAL.name()).map_or([0.0; 3], |field| field.vector(0, at));
        let bound = law.bound_at(&part.nodes, at);
        let traction = &mut part.nodes.history.values_mut(variable, 0)[3 * at..3 * at + 3];
        let whole = [traction[0], traction[1], traction[2]];
        let (pressure, along) = (dot(whole, normal), tangential(whole, normal));
        let limit = bound.at(scale_factor * pressure).max(0.0) / scale_factor;
        if norm(along) > 0.0 {
            traction.copy_from_slice(&add(scale(normal, pressure), scale(along, limit / norm(along))));
        }
    }
}

/// The warning that friction pushes sliding nodes along the slip of the accepted step, as where no contact states fulfil all
/// conditions.
pub(super) fn warn_of_pushing(
    part: &ModelPart,
    slaves: &[u32],
    multiplier: Multiplier,
    parameters: &StepParameters,
) -> Option<Diagnostic> {
    let Multiplier::Vector(variable) = multiplier else { return None };
    let vector_of = |name: &str, at: usize| part.nodes.history.get(name).map_or([0.0; 3], |f| f.vector(0, at));
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let pushed = |at: &usize| {
        let slip = activation::slip(part, *at, multiplier, parameters);
        let traction = tangential(vector_of(variable.name(), *at), vector_of(NORMAL.name(), *at));
        NodeState::of_flags(&part.nodes.flags, *at) == NodeState::Slip
            && !parameters.friction_law.bound_at(&part.nodes, *at).is_smooth()
            && norm(slip) > LEAST_SLIP * sizes[*at]
            && dot(slip, traction) < 0.0
    };
    let nodes: Vec<usize> = slaves.iter().map(|&n| n as usize).filter(pushed).map(|at| part.nodes.ids[at]).collect();
    let first = nodes.first()?;
    let fact = format!(
        "step {}: friction pushes {} sliding nodes along their motion, e.g. node {first}",
        part.info.step,
        nodes.len()
    );
    Some(Diagnostic::warning("friction-direction", fact).remedy(
        "look at the nodes named: their tractions are wrong; a finer mesh or another \"time_step\" may avoid it",
    ))
}
