//! Default output variables of an application, written where a deck names none.

/// Results beside the unknowns and their reactions; an application registers its own by [`crate::register_usual_results`].
pub struct UsualResults {
    /// Columns of nodes without history, written where they are.
    pub values: &'static [&'static str],
    /// Quantities at Gauss points, written at nodes where an element knows them.
    pub gauss: &'static [&'static str],
    /// Numbers at Gauss points of which a report tells the largest nodal value, with its sign.
    pub largest: &'static [&'static str],
    /// The same of the smallest one.
    pub smallest: &'static [&'static str],
}

inventory::collect!(UsualResults);

impl UsualResults {
    /// Columns without history of all applications, sorted.
    pub fn values() -> Vec<&'static str> {
        Self::sorted(|own| own.values)
    }

    /// Quantities at Gauss points of all applications, sorted.
    pub fn gauss() -> Vec<&'static str> {
        Self::sorted(|own| own.gauss)
    }

    /// Numbers at Gauss points whose largest nodal value a report tells, of all applications, sorted.
    pub fn largest() -> Vec<&'static str> {
        Self::sorted(|own| own.largest)
    }

    /// Numbers at Gauss points whose smallest nodal value a report tells, of all applications, sorted.
    pub fn smallest() -> Vec<&'static str> {
        Self::sorted(|own| own.smallest)
    }

    fn sorted(of: fn(&Self) -> &'static [&'static str]) -> Vec<&'static str> {
        let mut all: Vec<&str> = inventory::iter::<Self>().flat_map(of).copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// Registers default output variables.
///
/// ```
/// use zelus_core::model::UsualResults;
///
/// zelus_core::register_usual_results! { values: [], gauss: ["VON_MISES_STRESS"] }
/// assert_eq!(UsualResults::gauss(), ["VON_MISES_STRESS"]);
/// ```
#[macro_export]
macro_rules! register_usual_results {
    (values: [$($value:literal),*], gauss: [$($gauss:literal),*] $(, largest: [$($largest:literal),*], smallest: [$($smallest:literal),*])?) => {
        $crate::inventory::submit! {
            $crate::model::UsualResults {
                values: &[$($value),*],
                gauss: &[$($gauss),*],
                largest: &[$($($largest),*)?],
                smallest: &[$($($smallest),*)?],
            }
        }
    };
}
