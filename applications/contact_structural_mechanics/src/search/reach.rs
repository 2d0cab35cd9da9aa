//! What is said of overlaps that the reach of the search leaves out.

use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::ModelPart;

/// Overlaps that the deck's reach leaves out are said once: nothing acts there.
pub fn warn_of_reach(part: &mut ModelPart, lost: usize, warned: &mut bool) {
    if lost > 0 && !std::mem::replace(warned, true) {
        let fact =
            format!("{lost} pairs of facets overlap but lie beyond the reach of the search; contact has gaps there");
        part.messages.push(
            Diagnostic::warning("search-reach", fact)
                .remedy("set \"search_parameters.search_distance\" to \"between_facets\", or raise \"search_factor\""),
        );
    }
}

/// What is said when searches within a step went on to find pairs.
pub fn warn_of_late_pairs(count: usize, searches: usize) -> Diagnostic {
    let fact = format!("after {searches} searches within the step {count} pairs more are found; they are left out");
    Diagnostic::warning("late-contact", fact).remedy("shorten the step")
}
