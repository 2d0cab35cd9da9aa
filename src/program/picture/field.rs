//! The field of a picture: which of a run, which component, its values and its title.

use std::borrow::Cow;
use std::path::Path;

use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, Place, did_you_mean};
use zelus_core::io::results::{Column, Dataset};

use super::super::quantities::{FIRST_FIELDS, components, in_words, unit};
use super::super::stress_columns::with_invariants;
use super::options::wrong;

/// A field and one of its components.
pub(super) struct Field {
    name: String,
    component: String,
    /// Place among the numbers of a point; none for the size of a vector.
    at: Option<usize>,
}

impl Field {
    /// The field that is asked for, or the first of those that are usually shown.
    pub fn of(asked: Option<&str>, columns: &[Cow<'_, Column>], of: &Path) -> Result<Self> {
        let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        let (name, part) = match asked {
            Some(text) => text.split_once(':').map_or((text, None), |(name, part)| (name, Some(part))),
            None => {
                let usual = FIRST_FIELDS.into_iter().find(|name| names.contains(name));
                (usual.or(names.first().copied()).unwrap_or(""), None)
            }
        };
        let Some(column) = columns.iter().find(|column| column.name == name) else {
            let problem = Diagnostic::error("unknown-field", format!("the run has written no field {name:?} of nodes"));
            let all = || format!("fields: {}", names.join(", "));
            return Err(problem
                .at(Place::file(of))
                .remedy(did_you_mean(name, names.iter().copied()).unwrap_or_else(all))
                .into());
        };
        let parts = components(name, column.components);
        let component = part.unwrap_or(&parts[0]).to_owned();
        if !parts.contains(&component) {
            return Err(wrong(
                format!("{name} has no component {component:?}"),
                format!("components: {}", parts.join(", ")),
            ));
        }
        let shift = usize::from(parts[0] == "size");
        let at = parts.iter().position(|own| *own == component).and_then(|own| own.checked_sub(shift));
        Ok(Self { name: name.to_owned(), component, at })
    }

    /// Its value at each point; not a number where a step has no such field.
    pub fn values(&self, data: &Dataset) -> Vec<f64> {
        let columns = with_invariants(data);
        let Some(column) = columns.iter().find(|column| column.name == self.name) else {
            return vec![f64::NAN; data.points.len()];
        };
        let of = |point: usize, c: usize| column.values.get(point * column.components + c);
        let value = |point: usize| match self.at {
            Some(at) => of(point, at),
            None => (0..column.components).map(|c| of(point, c).powi(2)).sum::<f64>().sqrt(),
        };
        (0..data.points.len()).map(value).collect()
    }

    /// Name, component and unit, as the legend has them.
    pub fn title(&self, asked: Option<&str>) -> String {
        let unit = asked.map_or_else(|| unit(&self.name), str::to_owned);
        let part = if ["size", "value"].contains(&self.component.as_str()) { "" } else { &self.component };
        let words = [in_words(&self.name), part.to_owned(), if unit.is_empty() { unit } else { format!("({unit})") }];
        words.into_iter().filter(|own| !own.is_empty()).collect::<Vec<_>>().join(" ")
    }
}
