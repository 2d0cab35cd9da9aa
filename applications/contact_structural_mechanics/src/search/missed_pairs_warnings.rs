//! Warnings of overlaps beyond the search radius, and of pairs found too late.

use zelus_core::diagnostics::{Diagnostic, counted};

/// The warning that the deck's search radius leaves out overlaps: nothing acts there.
pub fn warn_of_search_radius(lost: usize) -> Diagnostic {
    let pairs = counted(lost, "pair of facets overlaps", "pairs of facets overlap");
    let fact = format!("{pairs} beyond the search radius; contact has gaps there");
    Diagnostic::warning("search-reach", fact)
        .remedy("set \"search_parameters.search_distance\" to \"between_facets\", or raise \"search_factor\"")
}

/// The warning that searches within a step went on to find pairs.
pub fn warn_of_missed_pairs(count: usize, searches: usize) -> Diagnostic {
    let fact =
        format!("after {searches} searches within the step {count} more facet pairs are found; they are left out");
    Diagnostic::warning("late-contact", fact).remedy("shorten the step")
}
