//! Names of the sets of slave nodes of an interaction.

use std::collections::BTreeMap;

/// Name of the sets of slave nodes of an interaction of a kind: that of the parts of its pairs by key.
pub(crate) fn owners_name(
    kind: &str,
    slaves: &BTreeMap<String, Vec<String>>,
    parts: &BTreeMap<String, Vec<String>>,
) -> String {
    let names: Vec<&str> = slaves.values().chain(parts.values()).flatten().map(String::as_str).collect();
    format!("{kind} of {}", names.join(" "))
}
