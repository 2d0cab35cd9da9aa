//! Prescribed unknowns of nodes.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::variable::ScalarVariable;

/// Marks of nodes by variable, whether a system solves for it or not.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fixities {
    columns: BTreeMap<ScalarVariable, Vec<bool>>,
}

impl Fixities {
    /// Fixes or frees a variable at some of `count` nodes.
    pub fn set(&mut self, variable: ScalarVariable, nodes: &[u32], fixed: bool, count: usize) {
        let column = self.columns.entry(variable).or_insert_with(|| vec![false; count]);
        column.resize(count, false);
        nodes.iter().for_each(|&node| column[node as usize] = fixed);
    }

    /// Whether a variable is fixed at a node.
    pub fn holds(&self, variable: ScalarVariable, node: u32) -> bool {
        self.columns.get(&variable).is_some_and(|column| column[node as usize])
    }

    /// Adds the marks of `more` nodes after those of `count`.
    pub(super) fn append(&mut self, count: usize, other: &Self, more: usize) {
        for (variable, marks) in &other.columns {
            let column = self.columns.entry(*variable).or_default();
            column.resize(count, false);
            column.extend(marks);
        }
        self.columns.values_mut().for_each(|column| column.resize(count + more, false));
    }

    /// Whether they can be those of `count` nodes.
    pub(super) fn is_sound(&self, count: usize) -> bool {
        let known = |variable: &ScalarVariable| variable.component.is_none_or(|component| component < 3);
        self.columns.iter().all(|(variable, column)| known(variable) && column.len() == count)
    }

    /// Fixities of the chosen nodes.
    pub fn pick(&self, nodes: &[u32]) -> Self {
        let pick = |column: &Vec<bool>| nodes.iter().map(|&at| column[at as usize]).collect();
        Self { columns: self.columns.iter().map(|(variable, column)| (*variable, pick(column))).collect() }
    }
}
