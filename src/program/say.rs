//! Lines on the standard output.

use std::io::Write;

/// Prints a line; when nobody reads any more (`zelus list | head`) it is lost, and the run goes on.
pub(super) fn say(text: &str) {
    let _ = writeln!(std::io::stdout(), "{text}");
}

/// Ending of a noun after a number.
pub(super) fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
