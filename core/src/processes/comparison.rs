//! When numbers count as equal, and how differences are told: for the processes that check results.

/// Whether two numbers differ by no more than one of the tolerances, of which the relative one is of the larger.
pub(super) fn is_close(a: f64, b: f64, tolerance: f64, relative_tolerance: f64) -> bool {
    (a - b).abs() <= (relative_tolerance * a.abs().max(b.abs())).max(tolerance)
}

/// The first `most` differences, a line each, and how many more there are.
pub(super) fn told(differences: &[String], most: usize) -> String {
    let first = differences[..differences.len().min(most)].join("\n    ");
    match differences.len().saturating_sub(most) {
        0 => first,
        more => format!("{first}\n    and {more} more"),
    }
}
