//! `Constraints` blocks of a mesh, by the registered constraints they name.

use std::ops::Range;

use rustc_hash::FxHashMap;

use super::Import;
use crate::diagnostics::{Diagnostic, Result};
use crate::entities::{ConstraintEntry, ConstraintRow};
use crate::io::variable_names::unknown_variable;
use crate::model::{ModelPart, Named, ScalarVariable, VariableKind, named};
use crate::registry;

/// The unknown of that name.
///
/// # Errors
/// No such variable, or one of several numbers.
fn unknown_called(name: &str) -> Result<ScalarVariable, Diagnostic> {
    match named(name) {
        Some(Named::Component(scalar)) => Ok(scalar),
        Some(Named::Whole(column, VariableKind::Scalar)) => Ok(ScalarVariable { column, component: None }),
        Some(Named::Whole(..)) => {
            let fact = format!("a constraint relates single numbers, {name} is more");
            Err(Diagnostic::error("wrong-type", fact).remedy("name a component, as …_X"))
        }
        None => Err(unknown_variable(name)),
    }
}

impl Import<'_> {
    /// Adds the constraints; gives their indices by the ids of their rows.
    pub(super) fn constraints(&mut self, part: &mut ModelPart) -> FxHashMap<u32, Range<u32>> {
        let mut indices = FxHashMap::default();
        for block in &self.document.constraints {
            let entry = match registry::require::<ConstraintEntry>(&block.name) {
                Ok(entry) => entry,
                Err(problem) => {
                    self.push(block.line, problem);
                    continue;
                }
            };
            let used = if entry.mixes_variables { block.variables.len() } else { 1 };
            let variables = block.variables[..used].iter().map(|name| unknown_called(name));
            let variables: Vec<ScalarVariable> = match variables.collect() {
                Ok(variables) => variables,
                Err(problem) => {
                    self.push(block.line, problem);
                    continue;
                }
            };
            if block.variables[used..].iter().any(|name| *name != block.variables[0]) {
                let fact = format!("only the first variable of the heading is used ({}), as Kratos does", variables[0]);
                self.push(block.line, Diagnostic::warning("mixed-constraint", fact));
            }
            for row in &block.rows {
                let index = |&id: &u32| part.nodes.find(id as usize).expect("checked by the reader");
                let masters: Vec<u32> = row.masters.iter().map(index).collect();
                let made = (entry.build)(&ConstraintRow {
                    id: row.id as usize,
                    variables: &variables,
                    constant: row.constant,
                    weights: &row.weights,
                    slave: index(&row.slave),
                    masters: &masters,
                    nodes: &part.nodes,
                });
                let first = part.constraints.len() as u32;
                match made {
                    Ok(made) => part.constraints.extend(made),
                    Err(fact) => {
                        let fact = format!("{} {}: {fact}", entry.name, row.id);
                        self.push(block.line, Diagnostic::error("constraint", fact));
                    }
                }
                indices.insert(row.id, first..part.constraints.len() as u32);
            }
        }
        indices
    }
}
