//! Names of Kratos and of the specification whose work is done here by something of another name.

use std::path::Path;

use zelus_core::Result;
use zelus_core::parameters::{Document, Node};

const NAMES: &str = include_str!("../../configs/kratos_names.json");

/// Where the work of a class or file of Kratos is done here, in a sentence; a name may end in a shape, as `3D4N`.
///
/// # Errors
/// Names that are no JSON.
pub(super) fn done_here(name: &str) -> Result<Option<String>> {
    let names = Document::from_str(NAMES, Path::new("configs/kratos_names.json"))?.root;
    let found = names.get(name).or_else(|| names.get(without_shape(name)));
    Ok(found.and_then(Node::as_str).map(str::to_owned))
}

/// The name before its shape: dimensions, numbers of nodes, and whether normals vary.
pub(super) fn without_shape(name: &str) -> &str {
    let is_shape = |rest: &str| rest.chars().all(|c| c.is_ascii_digit() || "DNV".contains(c));
    let at = name.find("2D").or_else(|| name.find("3D"));
    at.filter(|&at| is_shape(&name[at..])).map_or(name, |at| &name[..at])
}
