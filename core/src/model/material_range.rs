//! Ranges of the constants of materials.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::parameters::Range;

/// Constants of materials that accept numbers in a range alone; an application registers its own by [`crate::register_material_range`].
pub struct MaterialRange {
    /// The interval, as [`Range::parse`] reads it.
    pub range: &'static str,
    /// Names of the variables.
    pub variables: &'static [&'static str],
}

inventory::collect!(MaterialRange);

static RANGES: LazyLock<BTreeMap<&'static str, Range>> = LazyLock::new(|| {
    let each = |own: &'static MaterialRange| {
        let range = Range::parse(own.range).expect("a registered range is an interval");
        own.variables.iter().map(move |name| (*name, range))
    };
    inventory::iter::<MaterialRange>().flat_map(each).collect()
});

impl MaterialRange {
    /// The range of a constant, where its numbers are limited.
    pub fn of(variable: &str) -> Option<Range> {
        RANGES.get(variable).copied()
    }
}

/// Registers the range of constants of materials.
///
/// ```
/// use zelus_core::model::MaterialRange;
///
/// zelus_core::register_material_range! { "[0, inf)": ["DENSITY"] }
/// let range = MaterialRange::of("DENSITY").expect("the one above");
/// assert!(range.holds(0.0) && !range.holds(-1.0));
/// ```
#[macro_export]
macro_rules! register_material_range {
    ($range:literal: [$($variable:literal),*]) => {
        $crate::inventory::submit! { $crate::model::MaterialRange { range: $range, variables: &[$($variable),*] } }
    };
}
