//! Settings that all processes of interfaces share, and their checks.

use std::collections::BTreeMap;

use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, Severity, did_you_mean};
use zelus_core::model::ModelPart;
use zelus_core::parameters::{Defaults, Settings};

use crate::mortar::{IntegrationOrder, SegmentationSettings};

/// Names of the reference program's searches; one bounding-volume tree serves them all.
const SEARCHES: [&str; 10] = [
    "in_radius",
    "in_box",
    "in_radius_with_obb",
    "in_box_with_obb",
    "octree_with_obb",
    "InRadius",
    "InBox",
    "InRadiusWithOBB",
    "InBoxWithOBB",
    "OctreeWithOBB",
];

/// Refuses numbers that must be positive and are not.
///
/// # Errors
/// The first of them.
pub(super) fn check_positive(settings: &Settings, keys: &[&str]) -> Result<()> {
    for key in keys {
        let value = settings.get_f64(key)?;
        if value <= 0.0 {
            let fact = format!("\"{key}\" is {value}, it must be positive");
            return Err(settings.error(key, "invalid-value", fact).remedy("write a number above 0").into());
        }
    }
    Ok(())
}

/// Checks `search_parameters`.
///
/// # Errors
/// A search that does not exist.
pub(super) fn check_search(settings: &Settings) -> Result<()> {
    let type_search = settings.get_str("search_parameters.type_search")?;
    if SEARCHES.contains(&type_search) {
        return Ok(());
    }
    let fact = format!("there is no search \"{type_search}\"");
    let known = || format!("use one of {}", SEARCHES.join(", "));
    Err(settings
        .error("search_parameters.type_search", "unknown-search", fact)
        .remedy(did_you_mean(type_search, SEARCHES).unwrap_or_else(known))
        .into())
}

/// Accepts the name of a computed part, which decks of earlier Kratos versions give.
pub(super) fn without_computing_part(defaults: Defaults) -> Defaults {
    defaults.dropped("computing_model_part_name", "the whole root part is computed")
}

/// Contact needs iterations: one solve cannot decide which nodes are active.
///
/// # Errors
/// A solver whose `analysis_type` is `linear`.
pub(super) fn check_analysis(settings: &Settings, part: &ModelPart) -> Result<()> {
    if !part.info.solver.linear {
        return Ok(());
    }
    let fact = "\"analysis_type\" of the solver is \"linear\", and one solve cannot decide which nodes are in contact";
    let problem = settings.error("contact_type", "linear-contact", fact);
    Err(problem.remedy("set \"analysis_type\" to \"non_linear\"").into())
}

/// The warning that surfaces of bodies of revolution are taken for plane, or the reverse, by the setting `key`: areas then lack the
/// factor 2πr, or have one too many.
///
/// # Errors
/// A `key` that is neither true nor false.
pub(super) fn warn_of_revolution(part: &ModelPart, settings: &Settings, key: &str) -> Result<Option<Diagnostic>> {
    let around = settings.get_bool(key)?;
    let plane = part.info.domain_size == 2;
    let mut kinds = part.elements.kinds.iter().filter(|kind| plane && kind.cell.is_some_and(|cell| cell.dim() == 2));
    let Some(kind) = kinds.find(|kind| kind.of_revolution != around) else { return Ok(None) };
    let fact = format!("\"{key}\" is {around}, and bodies are made of {}: areas are off by 2πr", kind.name);
    let warning = Diagnostic { severity: Severity::Warning, ..settings.error(key, "contact-of-revolution", fact) };
    Ok(Some(warning.remedy(format!("set \"{key}\" to {}", !around))))
}

/// Every pair needs a slave side.
///
/// # Errors
/// No pair at all, or the first one without slaves.
pub(super) fn check_slaves(
    settings: &Settings,
    key: &str,
    parts: &BTreeMap<String, Vec<String>>,
    slaves: &BTreeMap<String, Vec<String>>,
) -> Result<()> {
    let named: Vec<&String> = parts.iter().filter(|(_, list)| !list.is_empty()).map(|(pair, _)| pair).collect();
    if named.is_empty() {
        let fact = format!("\"{key}\" names no part");
        return Err(settings.error(key, "missing-key", fact).remedy("name the surfaces, {\"0\": [\"Part\"]}").into());
    }
    match named.into_iter().find(|pair| slaves.get(*pair).is_none_or(Vec::is_empty)) {
        None => Ok(()),
        Some(pair) => {
            let fact = format!("pair \"{pair}\" has no part in \"assume_master_slave\"");
            Err(settings
                .error("assume_master_slave", "missing-key", fact)
                .remedy("name the parts on the slave side")
                .into())
        }
    }
}

/// The Gauss rule `integration_order` on the cells of overlaps.
///
/// # Errors
/// One that does not exist.
pub(super) fn integration_order(settings: &Settings) -> Result<IntegrationOrder> {
    let order = settings.get_usize("integration_order")?;
    IntegrationOrder::new(order).ok_or_else(|| {
        let fact = format!("\"integration_order\" is {order}, it must be 1 to 5");
        settings.error("integration_order", "integration-order", fact).into()
    })
}

/// How `integration_order`, `zero_tolerance_factor` and `count_slivers` cut and integrate overlaps.
///
/// # Errors
/// As [`integration_order`].
pub(super) fn segmentation(settings: &Settings) -> Result<SegmentationSettings> {
    let integration_order = integration_order(settings)?;
    let zero_tolerance_factor = settings.get_f64("zero_tolerance_factor")?;
    let slivers = settings.get_bool("count_slivers")?;
    let defaults = SegmentationSettings::default();
    Ok(SegmentationSettings { integration_order, zero_tolerance_factor, slivers, ..defaults })
}
