//! A constant of a material, or a table of it over the temperature.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::{Properties, Table};

/// A constant, or a table over the temperature.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Quantity {
    Constant(f64),
    Table {
        table: Table,
        /// Values below it, as where the table goes on beyond its ends, are this one.
        least: f64,
    },
}

/// Share of the largest value below which one that must be positive does not fall.
const LEAST: f64 = 1e-6;

impl Quantity {
    /// Value of the properties by that name: a table over TEMPERATURE goes before a number.
    ///
    /// # Errors
    /// Neither is there.
    pub(super) fn of(properties: &Properties, name: &str) -> Result<Self> {
        let table = properties.table_over("TEMPERATURE", name);
        match table.cloned() {
            Some(table) => Ok(Self::Table { table, least: f64::NEG_INFINITY }),
            None => properties.require(name).map(Self::Constant),
        }
    }

    /// As [`Quantity::of`], above zero.
    ///
    /// # Errors
    /// Also a value that is not.
    pub(super) fn positive(properties: &Properties, name: &str) -> Result<Self> {
        let mut quantity = Self::of(properties, name)?;
        if quantity.values().all(|value| value > 0.0 && value.is_finite()) {
            let largest = quantity.values().fold(0.0, f64::max);
            if let Self::Table { least, .. } = &mut quantity {
                *least = LEAST * largest;
            }
            return Ok(quantity);
        }
        let fact = format!("{name} of properties {} has values that are not positive", properties.id);
        Err(Diagnostic::error("material-out-of-range", fact).at(properties.place.clone()).into())
    }

    /// The value at a temperature.
    pub(super) fn at(&self, temperature: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table { table, least } => table.value(temperature).max(*least),
        }
    }

    /// Whether it depends on the temperature.
    pub(super) fn varies(&self) -> bool {
        matches!(self, Self::Table { .. })
    }

    /// Its value, or those of its table.
    fn values(&self) -> impl Iterator<Item = f64> + '_ {
        let (constant, points) = match self {
            Self::Constant(value) => (Some(*value), &[][..]),
            Self::Table { table, .. } => (None, table.points.as_slice()),
        };
        constant.into_iter().chain(points.iter().map(|[_, value]| *value))
    }
}
