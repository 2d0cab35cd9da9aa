//! Rates of the unknowns of applications: the columns of their derivatives by time, and of related quantities.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use super::fields::Fields;

/// The columns that go with an unknown of nodes; an application registers them by [`crate::register_rates`].
///
/// An unknown without an entry has no derivative by time: no scheme moves it, and supports of it carry nothing that is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rates {
    /// The unknown, a scalar or a vector.
    pub unknown: &'static str,
    /// Its first derivative by time.
    pub first: &'static str,
    /// Its second derivative; `None` where mass does not resist the change.
    pub second: Option<&'static str>,
    /// Its first derivative half a step later, in explicit integration.
    pub middle: Option<&'static str>,
    /// Reaction of supports and constraints: minus the residual.
    pub reaction: Option<&'static str>,
    /// The residual that explicit integration accelerates.
    pub out_of_balance: Option<&'static str>,
    /// Its lumped mass, a scalar without history.
    pub mass: Option<&'static str>,
    /// Properties with Rayleigh's factors of mass and stiffness, which go before those of the solver.
    pub rayleigh: Option<[&'static str; 2]>,
    /// Whether nodes move with it, as with a displacement.
    pub moves_mesh: bool,
    /// The vector of which it is the rotation: rotations of bodies are in both.
    pub turns: Option<&'static str>,
}

/// Selector of one of the columns that go with an unknown.
pub type ColumnOf = fn(&Rates) -> Option<&'static str>;
/// The unknown itself.
pub const UNKNOWN: ColumnOf = |rates| Some(rates.unknown);
/// The first derivative by time.
pub const FIRST: ColumnOf = |rates| Some(rates.first);
/// The second derivative by time.
pub const SECOND: ColumnOf = |rates| rates.second;

inventory::collect!(Rates);

static RATES: LazyLock<BTreeMap<&'static str, &'static Rates>> =
    LazyLock::new(|| inventory::iter::<Rates>().map(|rates| (rates.unknown, rates)).collect());

impl Rates {
    /// An unknown with its first derivative and nothing else; [`crate::register_rates`] fills the rest.
    pub const fn new(unknown: &'static str, first: &'static str) -> Self {
        Self {
            unknown,
            first,
            second: None,
            middle: None,
            reaction: None,
            out_of_balance: None,
            mass: None,
            rayleigh: None,
            moves_mesh: false,
            turns: None,
        }
    }

    /// Rates of an unknown.
    pub fn of(unknown: &str) -> Option<&'static Self> {
        RATES.get(unknown).copied()
    }

    /// All that are registered, by unknown.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        RATES.values().copied()
    }

    /// Rates whose unknown has a column in these fields, with its number of components.
    pub fn within(fields: &Fields) -> Vec<(&'static Self, usize)> {
        Self::all().filter_map(|rates| Some((rates, fields.get(rates.unknown)?.components))).collect()
    }

    /// Adds these columns for all unknowns there are.
    pub fn add(fields: &mut Fields, columns: &[ColumnOf]) {
        for (rates, components) in Self::within(fields) {
            columns.iter().filter_map(|column| column(rates)).for_each(|column| fields.add_named(column, components));
        }
    }

    /// The unknown that nodes move with, where these fields have one.
    pub fn moving(fields: &Fields) -> Option<&'static str> {
        Self::all().find(|rates| rates.moves_mesh && fields.has(rates.unknown)).map(|rates| rates.unknown)
    }
}

/// Registers how an unknown moves.
///
/// ```
/// use zelus_core::model::Rates;
///
/// zelus_core::register_rates! { "TEMPERATURE", first: "TEMPERATURE_RATE", reaction: Some("REACTION_FLUX") }
/// let rates = Rates::of("TEMPERATURE").expect("those above");
/// assert_eq!((rates.first, rates.second, rates.reaction), ("TEMPERATURE_RATE", None, Some("REACTION_FLUX")));
/// ```
#[macro_export]
macro_rules! register_rates {
    ($unknown:literal, first: $first:literal $(, $field:ident : $value:expr)* $(,)?) => {
        $crate::inventory::submit! { $crate::model::Rates {
            $($field: $value,)*
            ..$crate::model::Rates::new($unknown, $first)
        } }
    };
}
