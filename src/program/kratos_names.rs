//! Names of Kratos and of the specification whose work is done here by something of another name.

use std::path::Path;

use zelus_core::Result;
use zelus_core::parameters::{Document, Node};

const NAMES: &str = include_str!("../../configs/kratos_names.json");

/// Names of Kratos, each with a sentence that says where its work is done here; sorted.
///
/// # Errors
/// Names that are no JSON.
pub(super) fn names_of_kratos() -> Result<Vec<(String, String)>> {
    let names = Document::from_str(NAMES, Path::new("configs/kratos_names.json"))?.root;
    let sentence = |node: &Node| node.as_str().unwrap_or_default().to_owned();
    Ok(names.object()?.iter().map(|member| (member.key.clone(), sentence(&member.node))).collect())
}

/// Where the work of a class or file of Kratos is done here, in a sentence. A name may end in a shape, as `3D4N`; a file is named as
/// its class in small letters and with underscores.
///
/// # Errors
/// As [`names_of_kratos`].
pub(super) fn done_here(name: &str) -> Result<Option<String>> {
    let plain = |name: &str| name.replace('_', "").to_lowercase();
    let [whole, stem] = [name, without_shape(name)].map(plain);
    let names = names_of_kratos()?;
    let find =
        |wanted: &str| names.iter().find(|(known, _)| plain(known) == wanted).map(|(_, sentence)| sentence.clone());
    Ok(find(&whole).or_else(|| find(&stem)))
}

/// The name before its shape: dimensions, numbers of nodes, and whether normals vary.
pub(super) fn without_shape(name: &str) -> &str {
    let is_shape = |rest: &str| rest.chars().all(|c| c.is_ascii_digit() || "DNV".contains(c));
    let at = name.find("2D").or_else(|| name.find("3D"));
    at.filter(|&at| is_shape(&name[at..])).map_or(name, |at| &name[..at])
}
