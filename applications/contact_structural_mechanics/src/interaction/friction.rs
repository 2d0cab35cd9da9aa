//! Friction at the nodes: coefficients of a run, stick at step start, the direction of sliding in every iteration.

use std::collections::BTreeMap;

use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::flags::SLIP;
use zelus_core::model::{ModelPart, variables::NORMAL};
use zelus_core::vector3::{dot, norm};

use crate::active_set::SlipRule;
use crate::formulations::NodeState;
use crate::friction_law::{COULOMB, FrictionLaw};
use crate::interface::Interface;
use crate::mortar::tangential;
use crate::pairs::{Friction, Multiplier};
use crate::variables::{NODAL_AREA, NODAL_H, WEIGHTED_SLIP};

/// Slip, in mesh sizes, below which its direction says nothing.
const LEAST_SLIP: f64 = 1e-6;

/// What a deck chooses about friction.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionSettings {
    /// The law (`frictional_law`).
    pub law: &'static FrictionLaw,
    /// Coefficient by key of the pair, for surfaces whose properties have none.
    pub coefficients: BTreeMap<String, f64>,
    /// Weight of the slip in the trial traction of nodes that slide (`slip_augmentation_coefficient`).
    pub slip_augmentation: f64,
    /// Relative margin below the bound at which a sliding node sticks again (`slip_threshold`).
    pub slip_threshold: f64,
    /// Every so many steps all nodes start in stick; `None` for never (`slip_step_reset_frequency`).
    pub reset_frequency: Option<usize>,
}

impl Default for FrictionSettings {
    fn default() -> Self {
        let (coefficients, reset_frequency) = (BTreeMap::new(), None);
        Self { law: &COULOMB, coefficients, slip_augmentation: 0.0, slip_threshold: 0.0, reset_frequency }
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
    if friction == Friction::PureSlip || largest <= 0.0 {
        SlipRule::Pure
    } else {
        SlipRule::Bounded { augmentation: settings.slip_augmentation, threshold: settings.slip_threshold }
    }
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

/// The warning that friction pushes sliding nodes along the slip of the accepted step: it took its direction from the
/// first, sticking iterate, and the normals have turned by more than the angle of friction since.
pub(super) fn warn_of_pushing(
    part: &ModelPart,
    slaves: &[u32],
    multiplier: Multiplier,
    law: &FrictionLaw,
) -> Option<Diagnostic> {
    let Multiplier::Vector(variable) = multiplier else { return None };
    let vector_of = |name: &str, at: usize| part.nodes.history.get(name).map_or([0.0; 3], |f| f.vector(0, at));
    let (areas, sizes) = (part.nodes.values.values(&NODAL_AREA, 0), part.nodes.values.values(&NODAL_H, 0));
    let pushed = |at: &usize| {
        let slip = vector_of(WEIGHTED_SLIP.name(), *at);
        let traction = tangential(vector_of(variable.name(), *at), vector_of(NORMAL.name(), *at));
        NodeState::of_flags(&part.nodes.flags, *at) == NodeState::Slip
            && !law.bound_at(&part.nodes, *at).is_smooth()
            && norm(slip) > LEAST_SLIP * sizes[*at] * areas[*at]
            && dot(slip, traction) < 0.0
    };
    let nodes: Vec<usize> = slaves.iter().map(|&n| n as usize).filter(pushed).map(|at| part.nodes.ids[at]).collect();
    let first = nodes.first()?;
    let fact = format!(
        "step {}: friction pushes {} sliding nodes along their motion, e.g. node {first}",
        part.info.step,
        nodes.len()
    );
    Some(
        Diagnostic::warning("friction-direction", fact)
            .remedy("shorten \"time_step\": the surfaces turn too far in it"),
    )
}
