//! Properties: the material and other constants shared by many entities.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::table::Table;
use crate::diagnostics::{Diagnostic, Place, Result};

/// A value of a property.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum PropertyValue {
    /// One number.
    Number(f64),
    /// True or false.
    Boolean(bool),
    /// A list of numbers.
    Vector(Vec<f64>),
    /// A table of numbers, row by row.
    Matrix(Vec<Vec<f64>>),
    /// A word.
    Text(String),
}

/// Named constants and the constitutive law of a set of entities.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Properties {
    /// Number in the mesh and materials file.
    pub id: usize,
    /// Values by variable name.
    pub values: BTreeMap<String, PropertyValue>,
    /// Tables by (input, output) variable names.
    pub tables: BTreeMap<(String, String), Table>,
    /// Registered name of the constitutive law, when given.
    pub law: Option<String>,
    /// Lists of numbers beside the law's name, e.g. `combination_factors`.
    pub law_lists: BTreeMap<String, Vec<f64>>,
    /// Sub-properties, in the order of the file.
    pub parts: Vec<Properties>,
    /// Where the file defines it.
    pub place: Option<Place>,
}

impl Properties {
    /// Empty properties with that id.
    pub fn new(id: usize) -> Self {
        Self { id, ..Self::default() }
    }

    /// The table of `name` over the variable `over`, if given.
    pub fn table_over(&self, over: &str, name: &str) -> Option<&Table> {
        self.tables.get(&(over.to_owned(), name.to_owned()))
    }

    /// The number called `name`, if given.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.values.get(name) {
            Some(PropertyValue::Number(value)) => Some(*value),
            Some(PropertyValue::Boolean(value)) => Some(f64::from(u8::from(*value))),
            _ => None,
        }
    }

    /// The three numbers called `name`, if given.
    pub fn vector3(&self, name: &str) -> Option<[f64; 3]> {
        match self.values.get(name) {
            Some(PropertyValue::Vector(v)) => v.as_slice().try_into().ok(),
            _ => None,
        }
    }

    /// The number called `name`.
    ///
    /// # Errors
    /// Input error naming the properties and the missing value.
    pub fn require(&self, name: &str) -> Result<f64> {
        self.number(name).ok_or_else(|| {
            Diagnostic::error("missing-property", format!("properties {} have no {name}", self.id))
                .at(self.place.clone())
                .remedy(format!("add \"{name}\" to the \"Variables\" of this material"))
                .into()
        })
    }
}
