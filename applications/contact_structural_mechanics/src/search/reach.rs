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

/// What is said when facets that the searches of the step left out have come through each other by its end.
pub fn warn_of_late_pairs(count: usize, depth: f64) -> Diagnostic {
    let fact = format!(
        "{count} pairs of facets that were apart when the step began are deeper in each other than {depth:.1e} at its end; \
         contact is missing there in this step"
    );
    Diagnostic::warning("late-contact", fact).remedy("shorten the step, or raise \"search_parameters.search_factor\"")
}
