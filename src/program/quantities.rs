//! Names of quantities in words, their units by dimension, and their components, as the page and pictures show them.

use zelus_core::model::variables;

/// Fields that the page and pictures show first, the first that a run has.
pub(super) const FIRST_FIELDS: [&str; 4] = ["VON_MISES_STRESS", "CONTACT_PRESSURE", "TEMPERATURE", "DISPLACEMENT"];

/// Name, words and unit.
const KNOWN: [(&str, &str, &str); 22] = [
    ("DISPLACEMENT", "displacement", "length"),
    ("REACTION", "reaction", "force"),
    ("TEMPERATURE", "temperature", "degrees"),
    ("REACTION_FLUX", "reaction flux", "power"),
    ("CAUCHY_STRESS_VECTOR", "Cauchy stress", "force/area"),
    ("GREEN_LAGRANGE_STRAIN_VECTOR", "Green–Lagrange strain", "–"),
    ("VON_MISES_STRESS", "von Mises stress", ""),
    ("MAX_PRINCIPAL_STRESS", "largest principal stress", ""),
    ("MIN_PRINCIPAL_STRESS", "smallest principal stress", ""),
    ("TRESCA_STRESS", "Tresca stress", ""),
    ("HYDROSTATIC_PRESSURE", "hydrostatic pressure", ""),
    ("EQUIVALENT_PLASTIC_STRAIN", "equivalent plastic strain", "–"),
    ("EQUIVALENT_CREEP_STRAIN", "equivalent creep strain", "–"),
    ("DAMAGE", "damage", "–"),
    ("SAFETY_FACTOR", "safety factor to yield", "–"),
    ("CONTACT_PRESSURE", "contact pressure", "force/area"),
    ("CONTACT_TRACTION", "contact traction", "force/area"),
    ("CONTACT_GAP", "contact gap", "length"),
    ("CONTACT_SLIP", "contact slip", "length"),
    ("CONTACT_STATUS", "contact status", "0 open, 1 stick, 2 slip"),
    ("CONTACT_FORCE", "contact force", "force"),
    ("WEAR_DEPTH", "wear depth", "length"),
];

fn known(name: &str) -> Option<&'static (&'static str, &'static str, &'static str)> {
    KNOWN.iter().find(|(own, ..)| *own == name)
}

/// Names that have words of their own.
pub(super) fn names() -> [&'static str; KNOWN.len()] {
    KNOWN.map(|(name, ..)| name)
}

/// The name as words.
pub(super) fn in_words(name: &str) -> String {
    known(name).map_or_else(|| name.to_lowercase().replace('_', " "), |(_, words, _)| (*words).to_owned())
}

/// The unit: that of the table, or the one in brackets at the end of the description of the variable.
pub(super) fn unit(name: &str) -> String {
    if let Some((_, _, unit)) = known(name).filter(|(_, _, unit)| !unit.is_empty()) {
        return (*unit).to_owned();
    }
    let about = variables().get(name).map_or("", |variable| variable.about);
    let inner = about.trim_end_matches('.').strip_suffix(')').and_then(|text| text.rsplit_once('('));
    inner.map_or_else(String::new, |(_, unit)| unit.replace("force per area", "force/area"))
}

/// Names of the components of a field, the size of a vector first.
pub(super) fn components(name: &str, count: usize) -> Vec<String> {
    let is_tensor = name.ends_with("_STRESS_VECTOR") || name.ends_with("_STRAIN_VECTOR");
    let axes: &[&str] = match (is_tensor, count) {
        (_, 1) => &["value"],
        (true, 3) => &["xx", "yy", "xy"],
        (true, 4) => &["xx", "yy", "zz", "xy"],
        (true, 6) => &["xx", "yy", "zz", "xy", "yz", "xz"],
        (false, 3) => &["size", "x", "y", "z"],
        _ => return (1..=count).map(|at| at.to_string()).collect(),
    };
    axes.iter().map(|own| (*own).to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_have_words_and_units() {
        let of = |name: &str| (in_words(name), unit(name));
        assert_eq!(of("VON_MISES_STRESS"), ("von Mises stress".to_owned(), "force/area".to_owned()));
        assert_eq!(of("CONTACT_GAP"), ("contact gap".to_owned(), "length".to_owned()));
        assert_eq!(of("NO_SUCH_FIELD"), ("no such field".to_owned(), String::new()));
        assert_eq!(components("CAUCHY_STRESS_VECTOR", 3), ["xx", "yy", "xy"]);
        assert_eq!(components("DISPLACEMENT", 3), ["size", "x", "y", "z"]);
        assert_eq!(components("ANY", 2), ["1", "2"]);
    }
}
