//! Penalty, scale factor and search radius, from the bodies behind the interfaces and the deck.

use std::collections::BTreeSet;

use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::ModelPart;

use super::contact_settings::ContactSettings;
use crate::friction;
use crate::interface::{AlmParameters, Facet, Interface, Roles, alm_parameters};
use crate::kratos::PenaltyUnit;
use crate::law::{Augmentation, StepParameters};
use crate::mortar::{OperatorThreshold, SegmentationSettings};
use crate::search::GapCheck;
use crate::variables::{DYNAMIC_FACTOR, INITIAL_PENALTY, NODAL_H};

/// A distance beyond everything.
const FAR: f64 = 1e24;

/// Distance beyond which a search takes no facets for a pair (length); `reach` is that of [`calibrate`].
pub(crate) fn limit(settings: &ContactSettings, reach: f64) -> f64 {
    if settings.search.check == GapCheck::CheckMapping { reach } else { FAR }
}

/// Writes penalty and scale factor into the part; gives the gap below which nodes and facets count as near, before factors, the reach of a
/// search (both lengths), and the shared parameters of pairs, with those of `before` that do not come from the bodies.
///
/// # Errors
/// A coefficient of friction below zero.
pub(crate) fn calibrate(
    part: &mut ModelPart,
    interfaces: &[Interface],
    settings: &ContactSettings,
    before: &StepParameters,
    messages: &mut Vec<Diagnostic>,
) -> Result<([f64; 2], StepParameters)> {
    let estimate = alm_parameters(part, interfaces, settings.estimate[0], settings.estimate[1]);
    let unit = PenaltyUnit::of(&part.ranks, &part.nodes.initial, part.info.domain_size == 2 && !settings.axisymmetric);
    // Only penalties of weighted gaps hold an area.
    let pairwise = settings.formulation.weighted_gaps && settings.augmentation == Augmentation::Pair;
    let weighted = pairwise || settings.weighted_penalty;
    let estimated = estimate.penalty * settings.penalty_factor / if weighted { unit.measure } else { 1.0 };
    let given = settings.given;
    let mut chosen = AlmParameters {
        penalty: given.penalty.unwrap_or(estimated),
        scale_factor: given.scale_factor.unwrap_or(estimate.scale_factor),
    };
    chosen = chosen.with_floors(settings.least_penalty);
    if settings.weighted_penalty && given.penalty.is_none() {
        messages.extend(unit.warning());
    }
    // Without factors, which a deck may have chosen for their other effects.
    let of_bodies = alm_parameters(part, interfaces, 1.0, 1.0).penalty;
    let of_bodies = if of_bodies > 0.0 { of_bodies } else { chosen.penalty };
    // Kratos finds no scale factor where no side is named, and falls back to 1; multipliers would differ otherwise.
    let open = interfaces.iter().all(|interface| interface.open);
    if settings.own_scale {
        chosen.scale_factor = of_bodies;
    } else if !settings.use_scale_factor || (open && given.scale_factor.is_none()) {
        chosen.scale_factor = 1.0;
    }
    part.info.values.insert(INITIAL_PENALTY.name(), chosen.penalty);
    part.info.values.insert("SCALE_FACTOR", chosen.scale_factor);
    part.nodes.values.values_mut(&INITIAL_PENALTY, 0).fill(chosen.penalty);
    part.nodes.values.values_mut(&DYNAMIC_FACTOR, 0).fill(1.0);
    // Facets of rigid shapes have the size that draws them: they reach as far, but do not say what is near.
    let threshold = mean_size(part, interfaces, |facet| !facet.is_rigid());
    let reach = mean_size(part, interfaces, |_| true);
    let parameters = StepParameters {
        segmentation: SegmentationSettings {
            distance_threshold: if part.info.domain_size == 2 { FAR } else { limit(settings, reach) },
            axisymmetric: settings.axisymmetric.then(|| thickness(part, interfaces)),
            ..settings.segmentation
        },
        scale_factor: chosen.scale_factor,
        operator_threshold: OperatorThreshold {
            area: settings.operator_threshold.area * unit.measure,
            ..settings.operator_threshold
        },
        stiffness: of_bodies,
        slip_rule: friction::prepare(part, interfaces, &settings.friction, settings.formulation.friction, messages)?,
        ..before.clone()
    };
    Ok(([threshold, reach], parameters))
}

/// The larger of the means of NODAL_H over the nodes of both sides, of an open interface over all its nodes; over nodes of these facets
/// alone.
fn mean_size(part: &ModelPart, interfaces: &[Interface], counts: impl Fn(&Facet) -> bool) -> f64 {
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let side = |role: Roles| {
        let (mut sum, mut count) = (0.0, 0);
        for interface in interfaces {
            let of_side = |facet: &&Facet| (interface.open || facet.role == role) && counts(facet);
            let facets = interface.facets.iter().filter(of_side);
            let nodes: BTreeSet<u32> = facets.flat_map(|facet| facet.nodes.iter().copied()).collect();
            sum += nodes.iter().map(|&node| sizes[node as usize]).sum::<f64>();
            count += nodes.len();
        }
        sum / count.max(1) as f64
    };
    side(Roles::Slave).max(side(Roles::Master))
}

/// THICKNESS of the first facet that has one; 1 without.
fn thickness(part: &ModelPart, interfaces: &[Interface]) -> f64 {
    let mut facets = interfaces.iter().flat_map(|i| &i.facets);
    facets.find_map(|f| part.properties.get(&f.properties)?.number("THICKNESS")).unwrap_or(1.0)
}
