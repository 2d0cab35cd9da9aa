//! Writes the path of the iteration: chosen values and the residual norm of every iterate, the starting one included.

use std::io::Write;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::entities::{Interaction, Observer};
use zelus_core::io::{FileUse, Mark, replace_file};
use zelus_core::model::{Model, ModelPart, Named, ScalarVariable, VariableKind, named};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::register;
use zelus_core::{State, StateMapper};

/// A column of the table.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Column {
    name: String,
    variable: String,
    node: usize,
}

/// A row of the table.
#[derive(Clone, Serialize, Deserialize)]
struct Row {
    step: usize,
    iteration: usize,
    values: Vec<f64>,
    residual_norm: f64,
}

type Table = Arc<Mutex<Vec<Row>>>;

/// The rows so far.
#[derive(Serialize, Deserialize)]
struct SavedRows(Vec<Row>);

#[typetag::serde(name = "iterate_output")]
impl State for SavedRows {
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
}

struct IterateOutput {
    root: String,
    file: PathBuf,
    columns: Vec<Column>,
    place: Place,
    table: Table,
}

/// Watches the iteration; adds nothing to it.
struct Watch {
    columns: Vec<(ScalarVariable, u32)>,
    table: Table,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings =
        request.settings_with(|defaults| defaults.require(&["model_part_name", "output_file_name", "columns"]))?;
    Ok(Box::new(IterateOutput {
        root: settings.get_str("model_part_name")?.to_owned(),
        file: request.results.join(settings.get_str("output_file_name")?),
        columns: settings.get("columns")?.parse("columns")?,
        place: settings.key_place("columns"),
        table: Table::default(),
    }))
}

impl Column {
    fn find(&self, part: &ModelPart) -> Result<(ScalarVariable, u32)> {
        let variable = match named(&self.variable) {
            Some(Named::Component(variable)) => Some(variable),
            Some(Named::Whole(column, VariableKind::Scalar)) => Some(ScalarVariable { column, component: None }),
            _ => None,
        };
        let variable = variable.ok_or_else(|| {
            let fact = format!("column \"{}\": {} is no scalar variable", self.name, self.variable);
            Diagnostic::error("unknown-variable", fact).remedy("`zelus list variable` shows the known ones")
        })?;
        let node = part.nodes.find(self.node).ok_or_else(|| {
            let fact = format!("column \"{}\": there is no node {}", self.name, self.node);
            Diagnostic::error("unknown-node", fact).remedy("use the id of a node of the mesh")
        })?;
        Ok((variable, node))
    }
}

impl Process for IterateOutput {
    fn interaction(&mut self, model: &mut Model) -> Result<Option<(String, Box<dyn Interaction>)>> {
        let part = model.root(&self.root)?;
        let found: Result<_> = self.columns.iter().map(|column| column.find(part)).collect();
        let columns = found.map_err(|error| error.at(&self.place))?;
        Ok(Some((self.root.clone(), Box::new(Watch { columns, table: Arc::clone(&self.table) }))))
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(SavedRows(self.table.lock().unwrap_or_else(PoisonError::into_inner).clone())))
    }

    fn resume(&mut self, _model: &mut Model, state: Box<dyn State>) -> Result<()> {
        let SavedRows(rows) = state.take()?;
        *self.table.lock().unwrap_or_else(PoisonError::into_inner) = rows;
        Ok(())
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        let table = self.table.lock().unwrap_or_else(PoisonError::into_inner);
        let names: Vec<&str> = self.columns.iter().map(|column| column.name.as_str()).collect();
        replace_file(&model.ranks, &self.file, |out| {
            writeln!(out, "{{\n\"columns\": {},\n\"iterates\": [", serde_json::json!(names))?;
            for (at, row) in table.iter().enumerate() {
                let row_text = serde_json::json!({
                    "step": row.step, "iteration": row.iteration, "values": row.values,
                    "residual_norm": row.residual_norm,
                });
                writeln!(out, "{row_text}{}", if at + 1 < table.len() { "," } else { "" })?;
            }
            writeln!(out, "]\n}}")
        })
    }

    fn files(&self) -> Vec<FileUse> {
        vec![FileUse::Writes(self.file.clone(), Mark::Holds("\"iterates\""))]
    }

    fn outputs(&self) -> Vec<PathBuf> {
        vec![self.file.clone()]
    }
}

impl Interaction for Watch {
    fn name(&self) -> &str {
        "iterate output"
    }

    fn observer(&mut self) -> Option<&mut dyn Observer> {
        Some(self)
    }
}

impl Observer for Watch {
    fn observe(&mut self, part: &ModelPart, iteration: usize, residual: &[f64]) {
        let nodes = &part.nodes;
        let value = |&(variable, node): &(ScalarVariable, u32)| {
            let node = node as usize;
            nodes.history.scalar(variable, node).or_else(|| nodes.values.scalar(variable, node)).unwrap_or(f64::NAN)
        };
        self.table.lock().unwrap_or_else(PoisonError::into_inner).push(Row {
            step: part.info.step,
            iteration,
            values: self.columns.iter().map(value).collect(),
            residual_norm: residual.iter().map(|r| r * r).sum::<f64>().sqrt(),
        });
    }
}

register! { ProcessEntry "iterate_output_process",
    about: "writes chosen values and the residual norm of every Newton iterate to a JSON file",
    defaults: include_str!("../../../configs/processes/iterate_output_process.json"),
    build: build,
}
