//! Names every card and parameter that the reader has not used: nothing of a file is left out without a word.

use std::collections::BTreeMap;

use zelus_core::diagnostics::{Diagnostic, Place, Report};

use super::cards::Card;

/// Keywords without a meaning for mesh, material and loads: headings, brackets, output and control of the solver.
const WITHOUT_MEANING: [&str; 42] = [
    "ASSEMBLY",
    "CONTACT FILE",
    "CONTACT OUTPUT",
    "CONTACT PRINT",
    "CONTROLS",
    "EL FILE",
    "EL PRINT",
    "ELEMENT OUTPUT",
    "END ASSEMBLY",
    "END INSTANCE",
    "END PART",
    "END STEP",
    "ENERGY OUTPUT",
    "ENERGY PRINT",
    "FACE PRINT",
    "FILE FORMAT",
    "FILE OUTPUT",
    "HEADING",
    "INCREMENTATION OUTPUT",
    "INSTANCE",
    "INTEGRATED OUTPUT",
    "INTEGRATED OUTPUT SECTION",
    "MONITOR",
    "NODE FILE",
    "NODE OUTPUT",
    "NODE PRINT",
    "OUTPUT",
    "PART",
    "PHYSICAL CONSTANTS",
    "PREPRINT",
    "PRINT",
    "RADIATION FILE",
    "RESTART",
    "SECTION FILE",
    "SECTION PRINT",
    "SOLVER",
    "SYSTEM UNITS",
    "TIME POINTS",
    "UNITS",
    "USER OUTPUT VARIABLES",
    "VIEWFACTOR",
    "DIAGNOSTICS",
];

/// Parameters without a meaning for mesh, material and loads, of all keywords or of those in the second list.
const NAMES: [&str; 4] = ["NAME", "INTERNAL", "UNSORTED", "DESCRIPTION"];
const PARAMETERS: [(&str, &str); 19] = [
    ("CONTACT PAIR", "CPSET"),
    ("STATIC", "SOLVER"),
    ("STATIC", "STABILIZE"),
    ("STATIC", "ALLSDTOL"),
    ("STATIC", "CONTINUE"),
    ("STEP", "INC"),
    ("STEP", "UNSYMM"),
    ("STEP", "EXTRAPOLATION"),
    ("STEP", "CONVERT SDI"),
    ("STEP", "INCF"),
    ("STATIC", "FULLY PLASTIC"),
    ("SURFACE BEHAVIOR", "AUGMENTED LAGRANGE"),
    ("SURFACE BEHAVIOR", "PENALTY"),
    ("SURFACE BEHAVIOR", "DIRECT"),
    ("FRICTION", "LAGRANGE"),
    ("FRICTION", "ELASTIC SLIP"),
    ("FRICTION", "SLIP TOLERANCE"),
    ("FRICTION", "FRACTION"),
    ("SURFACE", "TRIM"),
];

/// The most lines that one message lists.
const LINES: usize = 8;

/// Warns of cards and of parameters that are not read, each keyword once with its lines.
pub(super) fn report(cards: &[&Card], report: &mut Report) {
    let mut unread: BTreeMap<&str, Vec<Place>> = BTreeMap::new();
    let mut parameters: BTreeMap<(&str, &str), Vec<Place>> = BTreeMap::new();
    for card in cards.iter().filter(|card| !WITHOUT_MEANING.contains(&card.keyword.as_str())) {
        let keyword = card.keyword.as_str();
        if !card.is_read.get() {
            unread.entry(keyword).or_default().push(card.place());
            continue;
        }
        let is_known = |name: &str| NAMES.contains(&name) || PARAMETERS.contains(&(keyword, name));
        for own in card.parameters.iter().filter(|own| !own.is_read.get() && !is_known(&own.name)) {
            parameters.entry((keyword, &own.name)).or_default().push(card.place());
        }
    }
    for (keyword, places) in unread {
        report.push(warning(&format!("*{keyword} is not read"), &places));
    }
    for ((keyword, parameter), places) in parameters {
        report.push(warning(&format!("{parameter} of *{keyword} is not read"), &places));
    }
}

fn warning(fact: &str, places: &[Place]) -> Diagnostic {
    let lines: Vec<String> = places.iter().take(LINES).map(|place| place.line.to_string()).collect();
    let more = if places.len() > LINES { ", …" } else { "" };
    let also = if places.len() > 1 { format!(" (lines {}{more})", lines.join(", ")) } else { String::new() };
    let remedy = "state its meaning in the deck, or go on without it";
    Diagnostic::warning("not-taken-over", format!("{fact}{also}")).at(places[0].clone()).remedy(remedy)
}
