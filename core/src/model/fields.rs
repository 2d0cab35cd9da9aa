//! Columns of numbers over nodes or entities, with one array a time level.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::level::Level;
use super::variable::{ColumnType, ScalarVariable, Variable};
use crate::diagnostics::{Diagnostic, Result};
use crate::names;

/// One variable over all nodes (or entities): `levels[0]` is the present, `levels[1]` the previous step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// Numbers a value takes: 1 or 3.
    pub components: usize,
    /// `count * components` numbers a time level, newest first.
    pub levels: Vec<Level>,
}

impl Field {
    fn new(components: usize, levels: usize, count: usize) -> Self {
        Self { components, levels: vec![Level::zeros(count * components); levels] }
    }

    /// The three numbers of `index` at a time level of a vector column.
    pub fn vector(&self, level: usize, index: usize) -> [f64; 3] {
        let at = 3 * index;
        [self.levels[level][at], self.levels[level][at + 1], self.levels[level][at + 2]]
    }
}

/// Named columns of one length and one number of time levels.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Fields {
    #[serde(deserialize_with = "names::read_keys")]
    columns: BTreeMap<&'static str, Field>,
    levels: usize,
    count: usize,
}

impl Fields {
    /// No columns yet, for `count` items and `levels` time levels.
    pub fn new(count: usize, levels: usize) -> Self {
        Self { columns: BTreeMap::new(), levels: levels.max(1), count }
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Number of time levels.
    pub fn levels(&self) -> usize {
        self.levels
    }

    /// Lengthens every column with zeros to `count` items.
    pub fn grow(&mut self, count: usize) {
        self.count = count;
        for field in self.columns.values_mut() {
            field.levels.iter_mut().for_each(|level| level.grow(count * field.components));
        }
    }

    /// The values of the chosen items, in their order.
    pub fn pick(&self, items: &[u32]) -> Self {
        let pick = |field: &Field| {
            let size = field.components;
            let level =
                |values: &Level| items.iter().flat_map(|&at| &values[at as usize * size..][..size]).copied().collect();
            Field { components: size, levels: field.levels.iter().map(level).collect() }
        };
        let columns = self.columns.iter().map(|(name, field)| (*name, pick(field))).collect();
        Self { columns, levels: self.levels, count: items.len() }
    }

    /// Adds the items of others after its own; a column that is missing on one side is zero there.
    pub(super) fn append(&mut self, other: &Self) {
        let (own, all) = (self.count, self.count + other.count);
        for (name, field) in &other.columns {
            self.add_named(name, field.components);
        }
        self.grow(all);
        for (name, field) in &mut self.columns {
            let Some(more) = other.columns.get(name) else { continue };
            let from = own * field.components;
            field.levels.iter_mut().zip(&more.levels).for_each(|(level, more)| level[from..].copy_from_slice(more));
        }
    }

    /// Sets the number of time levels; new ones copy the oldest.
    pub fn set_levels(&mut self, levels: usize) {
        self.levels = levels.max(1);
        for field in self.columns.values_mut() {
            let oldest = field.levels.last().cloned().unwrap_or_default();
            field.levels.resize(self.levels, oldest);
        }
    }

    /// Adds a column of zeros unless it is there.
    pub fn add<T: ColumnType>(&mut self, variable: &Variable<T>) {
        self.add_named(variable.name(), T::COMPONENTS);
    }

    /// Adds a column of zeros by name unless it is there; `components` is 1 or 3.
    pub fn add_named(&mut self, name: &'static str, components: usize) {
        let (levels, count) = (self.levels.max(1), self.count);
        self.columns.entry(name).or_insert_with(|| Field::new(components, levels, count));
    }

    /// Whether there is a column of that name.
    pub fn has(&self, name: &str) -> bool {
        self.columns.contains_key(name)
    }

    /// Names and columns.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &Field)> {
        self.columns.iter().map(|(name, field)| (*name, field))
    }

    /// The column of that name.
    pub fn get(&self, name: &str) -> Option<&Field> {
        self.columns.get(name)
    }

    /// The column of that name, to change.
    pub fn get_mut(&mut self, name: &str) -> Option<&mut Field> {
        self.columns.get_mut(name)
    }

    /// The column of that name.
    ///
    /// # Errors
    /// When there is none: a piece of the deck uses a variable that nothing has added.
    pub fn field(&self, name: &str) -> Result<&Field> {
        self.get(name).ok_or_else(|| missing(name, self.columns.keys().copied()))
    }

    /// The column of that name, to change.
    ///
    /// # Errors
    /// As [`Fields::field`].
    pub fn field_mut(&mut self, name: &str) -> Result<&mut Field> {
        if !self.columns.contains_key(name) {
            return Err(missing(name, self.columns.keys().copied()));
        }
        Ok(self.columns.get_mut(name).expect("checked above"))
    }

    /// Numbers of a column at a time level (0 the present); empty when the column is absent.
    pub fn values<T: ColumnType>(&self, variable: &Variable<T>, level: usize) -> &[f64] {
        self.level(variable.name(), level)
    }

    /// As [`Fields::values`], by name.
    pub fn level(&self, name: &str, level: usize) -> &[f64] {
        self.columns.get(name).map_or(&[], |field| &field.levels[level])
    }

    /// Puts numbers into a level of a column that is there.
    pub fn write_level(&mut self, name: &str, level: usize, values: &[f64]) {
        if let Some(field) = self.columns.get_mut(name) {
            field.levels[level].copy_from_slice(values);
        }
    }

    /// Numbers of a column at a time level, to change; the column is added when absent.
    pub fn values_mut<T: ColumnType>(&mut self, variable: &Variable<T>, level: usize) -> &mut [f64] {
        self.add(variable);
        &mut self.columns.get_mut(variable.name()).expect("added above").levels[level]
    }

    /// One number at the present level.
    pub fn scalar(&self, variable: ScalarVariable, index: usize) -> Option<f64> {
        let field = self.columns.get(variable.column)?;
        Some(field.levels[0][index * field.components + variable.offset()])
    }

    /// One number at a time level; `None` where there is no such column or level.
    pub fn value(&self, variable: ScalarVariable, index: usize, level: usize) -> Option<f64> {
        let field = self.columns.get(variable.column)?;
        field.levels.get(level).map(|values| values[index * field.components + variable.offset()])
    }

    /// Puts one number into a level of a column, where both are there.
    pub fn set_value(&mut self, variable: ScalarVariable, index: usize, level: usize, value: f64) {
        let Some(field) = self.columns.get_mut(variable.column) else { return };
        let at = index * field.components + variable.offset();
        field.levels.get_mut(level).into_iter().for_each(|values| values[at] = value);
    }

    /// A new time level: each column moves back by one, the present starts as a copy of the previous.
    pub fn advance(&mut self) {
        for field in self.columns.values_mut() {
            field.levels.rotate_right(1);
            if let [present, previous, ..] = field.levels.as_mut_slice() {
                present.take_over(previous);
            }
        }
    }
}

fn missing(name: &str, known: impl Iterator<Item = &'static str>) -> crate::diagnostics::Error {
    let known: Vec<_> = known.collect();
    let hint = crate::diagnostics::did_you_mean(name, known.iter().copied());
    let remedy = hint.unwrap_or_else(|| format!("present are: {}", known.join(", ")));
    Diagnostic::error("variable-not-in-model", format!("the variable {name} is not stored in this model"))
        .remedy(remedy)
        .into()
}
