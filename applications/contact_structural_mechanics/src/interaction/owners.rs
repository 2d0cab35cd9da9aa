//! Names of the slave nodes of an interaction, and the angle at which their patches end.

use std::collections::BTreeMap;

use zelus_core::model::ModelPart;

use crate::interface::FEATURE_ANGLE;
use crate::solver::{AVERAGED_EDGES, CONTACT_FEATURE_ANGLE};

/// Name of the sets of slave nodes of an interaction of a kind: that of the parts of its pairs by key.
pub(super) fn owners_name(
    kind: &str,
    slaves: &BTreeMap<String, Vec<String>>,
    parts: &BTreeMap<String, Vec<String>>,
) -> String {
    let names: Vec<&str> = slaves.values().chain(parts.values()).flatten().map(String::as_str).collect();
    format!("{kind} of {}", names.join(" "))
}

/// The feature angle of a model part, in degrees; `None` where all facets at a node share its normal, as in the reference program.
pub(super) fn feature_angle(part: &ModelPart) -> Option<f64> {
    (!part.info.is(AVERAGED_EDGES)).then(|| part.info.value_or(CONTACT_FEATURE_ANGLE, FEATURE_ANGLE))
}
