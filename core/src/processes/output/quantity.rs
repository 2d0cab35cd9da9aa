//! Named quantities of nodes and entities, read into columns.

use super::gauss::is_known;
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Report, Result};
use crate::io::results::Column;
use crate::io::variable_names::{not_computed, unknown_variable};
use crate::model::flags::flag;
use crate::model::{EntityRole, Field, Fields, Flags, ModelPart, Named, VariableKind, named, variables};
use crate::parameters::Settings;

/// A variable, or a component of one, that a column may hold.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Quantity {
    /// The name the deck uses.
    pub(super) name: String,
    variable: Named,
}

impl Quantity {
    pub(super) fn new(name: &str) -> Result<Self, Diagnostic> {
        let variable = named(name).ok_or_else(|| unknown_variable(name))?;
        computed(name)?;
        Ok(Self { name: name.to_owned(), variable })
    }

    /// As [`Quantity::list`] for pictures, which leave out known quantities without values here, with a warning.
    pub(super) fn shown(settings: &Settings, key: &str, report: &mut Report) -> Result<Vec<Self>> {
        each(settings, key, report, true, Self::new)
    }

    /// The quantities a list of the deck names; problems go to `report`.
    pub(super) fn list(settings: &Settings, key: &str, report: &mut Report) -> Result<Vec<Self>> {
        each(settings, key, report, false, Self::new)
    }

    /// The column it is in.
    fn column<'f>(&self, fields: &'f Fields) -> Option<&'f Field> {
        fields.get(self.variable.column().0)
    }

    /// The columns of nodes that hold it: those with history where that is asked for, else those without; the others where it is
    /// in them alone.
    pub(super) fn fields<'p>(&self, part: &'p ModelPart, history: bool) -> &'p Fields {
        let (mut asked, mut other) = (&part.nodes.values, &part.nodes.history);
        if history {
            std::mem::swap(&mut asked, &mut other);
        }
        if self.column(asked).is_none() && self.column(other).is_some() { other } else { asked }
    }

    /// The warning that nodes have it in no column, so that it reads as zero; `by` names the process.
    pub(super) fn missing_at_nodes(&self, part: &ModelPart, by: &str) -> Option<Diagnostic> {
        self.missing(&[&part.nodes.history, &part.nodes.values], "nodes have", by)
    }

    /// The warning that none of the columns of `whose` hold it, e.g. "nodes have".
    pub(super) fn missing(&self, columns: &[&Fields], whose: &str, by: &str) -> Option<Diagnostic> {
        let is_there = columns.iter().any(|fields| fields.has(self.variable.column().0));
        (!is_there).then(|| no_values(&self.name, whose, by))
    }

    /// How many numbers it takes; a quantity that is nowhere stored reads as zero.
    pub(super) fn components(&self, fields: &Fields) -> usize {
        match self.variable {
            Named::Component(_) => 1,
            Named::Whole(_, kind) => {
                let natural = if kind == VariableKind::Vector3 { 3 } else { 1 };
                self.column(fields).map_or(natural, |field| field.components)
            }
        }
    }

    /// Its numbers at one item, to `out`.
    pub(super) fn read(&self, fields: &Fields, item: u32, out: &mut [f64]) {
        let Some(field) = self.column(fields) else { return out.fill(0.0) };
        self.read_from(field, item, out);
    }

    /// The same from its column.
    fn read_from(&self, field: &Field, item: u32, out: &mut [f64]) {
        let at = item as usize * field.components + self.variable.column().1;
        out.copy_from_slice(&field.levels[0][at..at + out.len()]);
    }

    /// Its numbers at many items.
    pub(super) fn gather(&self, fields: &Fields, items: &[u32]) -> Column {
        let components = self.components(fields);
        let mut values = vec![0.0; items.len() * components];
        if let Some(field) = self.column(fields) {
            for (row, &item) in values.chunks_exact_mut(components).zip(items) {
                self.read_from(field, item, row);
            }
        }
        Column::real(&self.name, components, values)
    }
}

/// A variable at Gauss points; which blocks know it is seen when they are asked.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GaussQuantity {
    /// The name the deck uses.
    pub(super) name: String,
    /// The name blocks are asked for when they do not know the first: stresses as vectors instead of tensors.
    pub(super) vector: Option<String>,
}

impl GaussQuantity {
    pub(super) fn new(name: &str) -> Result<Self, Diagnostic> {
        let vector = name.strip_suffix("_TENSOR").map(|stem| format!("{stem}_VECTOR"));
        let known = |name: &str| variables().contains_key(name);
        if !known(name) && !vector.as_deref().is_some_and(known) {
            return Err(unknown_variable(name));
        }
        computed(name)?;
        Ok(Self { name: name.to_owned(), vector })
    }

    /// The warning that no element of any rank knows it, so that it reads as zero; `by` names the process. Collective.
    pub(super) fn missing(&self, part: &ModelPart, system: &System, by: &str) -> Option<Diagnostic> {
        let is_known = part.ranks.any(is_known(system, EntityRole::Element, self));
        (!is_known).then(|| no_values(&self.name, "Gauss points of elements have", by))
    }

    /// As [`Quantity::shown`].
    pub(super) fn shown(settings: &Settings, key: &str, report: &mut Report) -> Result<Vec<Self>> {
        each(settings, key, report, true, Self::new)
    }

    /// As [`Quantity::list`].
    pub(super) fn list(settings: &Settings, key: &str, report: &mut Report) -> Result<Vec<Self>> {
        each(settings, key, report, false, Self::new)
    }
}

/// The warning that a quantity is written as zeros.
fn no_values(name: &str, whose: &str, by: &str) -> Diagnostic {
    let fact = format!("{by} writes {name} as zeros: {whose} no such values");
    let remedy = "take it out of the list, or name it in that of Gauss points if elements know it";
    Diagnostic::warning("no-values", fact).remedy(remedy)
}

/// The flags a list of the deck names; problems go to `report`.
pub(super) fn flag_list(settings: &Settings, key: &str, report: &mut Report) -> Result<Vec<&'static str>> {
    each(settings, key, report, false, flag)
}

/// The flag a setting names; `None` when it is empty.
///
/// # Errors
/// `unknown-flag`.
pub(super) fn flag_setting(settings: &Settings, key: &str) -> Result<Option<&'static str>> {
    let name = settings.get_str(key)?;
    if name.is_empty() {
        return Ok(None);
    }
    flag(name).map(Some).map_err(|problem| problem.at(settings.key_place(key)).into())
}

/// An error for a variable that is known and has no values here.
fn computed(name: &str) -> Result<(), Diagnostic> {
    let Some(why) = not_computed(name) else { return Ok(()) };
    let fact = format!("{name} has no values: {}", why.trim_end_matches('.'));
    Err(Diagnostic::error(NOT_COMPUTED, fact).remedy("take it out of the list"))
}

const NOT_COMPUTED: &str = "not-computed";

/// Applies `make` to the names of a list; problems go to `report`. With `leave_out`, known quantities without values are left out with
/// a warning.
fn each<T>(
    settings: &Settings,
    key: &str,
    report: &mut Report,
    leave_out: bool,
    make: impl Fn(&str) -> Result<T, Diagnostic>,
) -> Result<Vec<T>> {
    let mut out = Vec::new();
    for item in settings.items(key)? {
        match make(item.str()?) {
            Ok(made) => out.push(made),
            Err(problem) if leave_out && problem.code == NOT_COMPUTED => {
                let warning = Diagnostic::warning(NOT_COMPUTED, format!("{}; it is left out", problem.fact));
                report.push(warning.at(item.place()));
            }
            Err(problem) => report.push(problem.at(item.place())),
        }
    }
    Ok(out)
}

/// A flag as numbers: 1 set, 0 unset, -1 undefined.
pub(super) fn flag_column(flags: &Flags, name: &'static str, items: &[u32]) -> Column {
    let state = |&item: &u32| flags.get(name, item as usize).map_or(-1.0, |set| f64::from(u8::from(set)));
    Column::real(name, 1, items.iter().map(state).collect())
}
