//! The surfaces that processes of contact name, for those who share out a mesh.

use zelus_core::parameters::Node;
use zelus_core::processes::NamedSurface;

/// The parts of each pair in `contact_model_part`, e.g. `{"0": ["Contact_Part"]}`; the whole skin where none is named.
pub(super) fn contact(parameters: Option<&Node>) -> Vec<NamedSurface> {
    by_pair(parameters, "contact_model_part")
}

/// As [`contact`], of `mesh_tying_model_part`.
pub(super) fn ties(parameters: Option<&Node>) -> Vec<NamedSurface> {
    by_pair(parameters, "mesh_tying_model_part")
}

/// Both sides of a mapping; values arrive at the destination.
pub(super) fn mapping(parameters: Option<&Node>) -> Vec<NamedSurface> {
    let side = |key| parameters.and_then(|parameters| parameters.get(key)).map(names);
    let (Some(origin), Some(slaves)) = (side("origin_model_part_name"), side("destination_model_part_name")) else {
        return Vec::new();
    };
    vec![NamedSurface::Parts { both: [origin, slaves.clone()].concat(), slaves }]
}

/// The part of which penalty and scale factor are estimated.
pub(super) fn estimated(parameters: Option<&Node>) -> Vec<NamedSurface> {
    let part = parameters.and_then(|parameters| parameters.get("model_part_name")).map(names);
    part.into_iter().map(|both| NamedSurface::Parts { both, slaves: Vec::new() }).collect()
}

/// The parts of each pair under a key of the settings; the whole skin where none is named.
fn by_pair(parameters: Option<&Node>, key: &str) -> Vec<NamedSurface> {
    let pairs = parameters.and_then(|parameters| parameters.get(key)).and_then(Node::as_object);
    let slaves_of = |pair: &str| parameters?.get("assume_master_slave")?.get(pair).map(names);
    let filled = pairs.into_iter().flat_map(|pairs| pairs.iter()).map(|pair| (names(&pair.node), &pair.key));
    let filled = filled.filter(|(both, _)| !both.is_empty());
    let named = |(both, pair): (Vec<String>, &String)| {
        let slaves = slaves_of(pair).unwrap_or_default();
        NamedSurface::Parts { both, slaves }
    };
    let out: Vec<NamedSurface> = filled.map(named).collect();
    if out.is_empty() { vec![NamedSurface::WholeSkin] } else { out }
}

/// A name or a list of names.
fn names(node: &Node) -> Vec<String> {
    let all = node.as_array().unwrap_or(std::slice::from_ref(node));
    all.iter().filter_map(Node::as_str).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use zelus_core::parameters::Document;

    use super::*;

    fn read(of: fn(Option<&Node>) -> Vec<NamedSurface>, parameters: &str) -> Vec<NamedSurface> {
        of(Some(&Document::from_str(parameters, "deck.json").unwrap().root))
    }

    fn parts(both: &[&str], slaves: &[&str]) -> NamedSurface {
        let [both, slaves] = [both, slaves].map(|list| list.iter().map(|name| (*name).to_owned()).collect());
        NamedSurface::Parts { both, slaves }
    }

    #[test]
    fn pairs_name_their_parts_and_slaves() {
        let text =
            r#"{"contact_model_part": {"0": ["A", "B"], "1": [], "2": ["C"]}, "assume_master_slave": {"0": ["A"]}}"#;
        assert_eq!(read(contact, text), [parts(&["A", "B"], &["A"]), parts(&["C"], &[])]);
        let text = r#"{"origin_model_part_name": "O", "destination_model_part_name": "D"}"#;
        assert_eq!(read(mapping, text), [parts(&["O", "D"], &["D"])]);
    }

    #[test]
    fn no_part_means_the_whole_skin() {
        assert_eq!(read(contact, r#"{"contact_model_part": {"0": []}}"#), [NamedSurface::WholeSkin]);
        assert_eq!(read(ties, "{}"), [NamedSurface::WholeSkin]);
        assert_eq!(contact(None), [NamedSurface::WholeSkin]);
    }
}
