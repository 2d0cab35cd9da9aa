//! Results compared with those of a JSON file; a difference ends the run.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use super::control::TimeCounter;
use super::gauss;
use super::json_output_process::{node_key, passes};
use super::part_path::{PartPath, file_of};
use super::quantity::{GaussQuantity, Quantity, flag_setting};
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Error, Place, Result};
use crate::io::FileUse;
use crate::model::{EntityRole, Model, ModelPart, SubPart, Table};
use crate::parameters::Defaults;
use crate::processes::comparison::{is_close, told};
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;

/// Differences told in full; more are counted.
const TOLD: usize = 10;

/// Compares at each point in time that the counter gives.
struct FromJsonCheck {
    part: PartPath,
    file: PathBuf,
    place: Place,
    reference: Value,
    times: Vec<f64>,
    counter: TimeCounter,
    quantities: Vec<Quantity>,
    gauss: Vec<GaussQuantity>,
    flag: Option<&'static str>,
    history: bool,
    tolerance: f64,
    relative_tolerance: f64,
    reference_uncertainty: f64,
    messages: Vec<Diagnostic>,
}

/// Values that differ, in words: beyond all bounds, and only within the uncertainty of the reference.
#[derive(Default)]
struct Differences {
    wrong: Vec<String>,
    uncertain: Vec<String>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let required = ["model_part_name", "input_file_name"];
    let settings = &request.settings_with(|defaults: Defaults| defaults.require(&required))?;
    let file = file_of(settings, "input_file_name", request.folder, "")?;
    let place = settings.key_place("input_file_name");
    let text = std::fs::read_to_string(&file).map_err(|e| {
        Diagnostic::error("missing-file", format!("the reference results {} cannot be read: {e}", file.display()))
            .at(place.clone())
            .remedy("\"input_file_name\" is relative to the deck; a json_output_process writes such a file")
    })?;
    let problem = |fact: String| Diagnostic::error("invalid-json", fact).at(Place::file(&file));
    let reference: Value = serde_json::from_str(&text).map_err(|e| problem(format!("not JSON: {e}")))?;
    let times = numbers(&reference["TIME"]).ok_or_else(|| problem("there is no list \"TIME\"".to_owned()))?;
    Ok(Box::new(FromJsonCheck {
        part: PartPath::new(settings)?,
        file,
        place,
        reference,
        messages: Vec::new(),
        times,
        counter: TimeCounter::new(settings)?,
        quantities: Quantity::list(settings, "check_variables", request.report)?,
        gauss: GaussQuantity::list(settings, "gauss_points_check_variables", request.report)?,
        flag: flag_setting(settings, "check_for_flag")?,
        history: settings.get_bool("historical_value")?,
        tolerance: settings.get_f64("tolerance")?,
        relative_tolerance: settings.get_f64("relative_tolerance")?,
        reference_uncertainty: settings.get_f64("reference_uncertainty")?,
    }))
}

fn numbers(list: &Value) -> Option<Vec<f64>> {
    list.as_array()?.iter().map(Value::as_f64).collect()
}

/// The numbers of a list, of component `at` where it is a list of lists.
fn component(list: &Value, at: usize) -> Option<Vec<f64>> {
    let pick = |item: &Value| if item.is_array() { item[at].as_f64() } else { item.as_f64().filter(|_| at == 0) };
    list.as_array()?.iter().map(pick).collect()
}

impl FromJsonCheck {
    /// The reference of component `at` of a quantity in `entry` at `time`: linear between the times of the file.
    fn expected(&self, entry: &Value, name: &str, at: usize, size: usize, time: f64) -> Option<f64> {
        let named = (size == 3).then(|| entry.get(format!("{name}_{}", ["X", "Y", "Z"][at]))).flatten();
        let values = match named {
            Some(list) => numbers(list),
            None => component(entry.get(name)?, at),
        }?;
        let points: Vec<[f64; 2]> = self.times.iter().zip(values).map(|(&t, v)| [t, v]).collect();
        (!points.is_empty()).then(|| Table::new(points).value(time))
    }

    /// Differences on any rank; collective.
    fn compare(&self, part: &ModelPart, system: &System, selection: &SubPart) -> Differences {
        let mut found = Differences::default();
        let time = part.info.time;
        let mut values = Vec::new();
        let wanted = |&&node: &&u32| part.owns_node(node as usize) && passes(&part.nodes.flags, self.flag, node);
        for &node in selection.nodes.iter().filter(wanted) {
            let key = node_key(part.nodes.ids[node as usize]);
            for quantity in &self.quantities {
                // References of Kratos hold the columns that were asked for, zeros where they lack the quantity.
                let fields = if self.history { &part.nodes.history } else { &part.nodes.values };
                values.resize(quantity.components(fields), 0.0);
                quantity.read(fields, node, &mut values);
                self.judge(&self.reference[&key], &key, &quantity.name, &values, time, &mut found);
            }
        }
        for quantity in &self.gauss {
            gauss::each(part, system, EntityRole::Element, &selection.elements, quantity, |row, gauss| {
                let element = selection.elements[row];
                if !passes(&part.elements.flags, self.flag, element) {
                    return;
                }
                let key = format!("ELEMENT_{}", part.elements.ids[element as usize]);
                for (point, values) in gauss.values.chunks_exact(gauss.components).enumerate() {
                    let entry = &self.reference[&key][&quantity.name][point.to_string()];
                    let place = format!("{key} point {point}");
                    // The lists of a point stand directly below it: named like the entry they are looked up in.
                    let entry = serde_json::json!({ &quantity.name: entry });
                    self.judge(&entry, &place, &quantity.name, values, time, &mut found);
                }
            });
        }
        Differences { wrong: part.ranks.lines_of_all(found.wrong), uncertain: part.ranks.lines_of_all(found.uncertain) }
    }

    fn judge(&self, entry: &Value, key: &str, name: &str, values: &[f64], time: f64, found: &mut Differences) {
        for (at, &value) in values.iter().enumerate() {
            match self.expected(entry, name, at, values.len(), time) {
                Some(expected) if is_close(value, expected, self.tolerance, self.relative_tolerance) => {}
                Some(expected) => {
                    let letter = if values.len() > 1 { format!(" component {at}") } else { String::new() };
                    let told = format!("{key} {name}{letter}: {value:e}, expected {expected:e}");
                    let open = self.reference_uncertainty * value.abs().max(expected.abs());
                    let list = if (value - expected).abs() <= open { &mut found.uncertain } else { &mut found.wrong };
                    list.push(told);
                }
                None => {
                    found.wrong.push(format!("{key} {name}: not in the file"));
                    return;
                }
            }
        }
    }
}

/// Time since the last comparison.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct SavedCounter(f64);

stored_as_bytes!(SavedCounter);

#[typetag::serde(name = "from_json_check_result")]
impl State for SavedCounter {
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
}

impl Process for FromJsonCheck {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(SavedCounter(self.counter.counter)))
    }

    fn resume(&mut self, _model: &mut Model, state: Box<dyn State>) -> Result<()> {
        self.counter.counter = state.take::<SavedCounter>()?.0;
        Ok(())
    }

    fn files(&self) -> Vec<FileUse> {
        vec![FileUse::Reads(self.file.clone())]
    }

    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        self.part.find(model).map(|_| ())
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn end_step(&mut self, model: &mut Model, system: &System) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        if !self.counter.acts(&part.info) {
            return Ok(());
        }
        let found = self.compare(part, system, selection);
        let time = part.info.time;
        if !found.wrong.is_empty() {
            return Err(Error::System(format!("{}: {}", self.place, self.tell(&found.wrong, time))));
        }
        if !found.uncertain.is_empty() {
            let fact = self.tell(&found.uncertain, time);
            self.messages.push(
                Diagnostic::warning("check-uncertain", fact)
                    .at(self.place.clone())
                    .remedy("the differences are within \"reference_uncertainty\"; set it to 0 to make them errors"),
            );
        }
        Ok(())
    }
}

impl FromJsonCheck {
    fn tell(&self, differences: &[String], time: f64) -> String {
        format!(
            "results at time {time} differ from {} in {} values (tolerance {:e}, relative {:e}):\n    {}",
            self.file.display(),
            differences.len(),
            self.tolerance,
            self.relative_tolerance,
            told(differences, TOLD)
        )
    }
}

register! { ProcessEntry "from_json_check_result_process",
    aliases: &["FromJsonCheckResultProcess"],
    about: "compares results with those of a JSON file; a difference ends the run",
    defaults: include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../configs/processes/from_json_check_result_process.json"
    )),
    build: build,
}
