//! Histories of nodes and Gauss points in a JSON file.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use super::control::TimeCounter;
use super::gauss;
use super::part_path::{NO_STEP, NO_VARIABLE, PartPath, file_of, no_output};
use super::quantity::{GaussQuantity, Quantity, flag_setting};
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Place, Report, Result, unfit};
use crate::entities::Gauss;
use crate::io::{FileUse, Mark, replace_file};
use crate::model::{EntityRole, Flags, Model, ModelPart, SubPart};
use crate::parameters::Defaults;
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;

/// Its registered name.
const NAME: &str = "json_output_process";

/// How often at most the file is rewritten while the run goes on; at its end it is in any case.
const REWRITE: Duration = Duration::from_secs(10);

/// Keeps histories in memory and writes them as one file.
struct JsonOutput {
    part: PartPath,
    /// Where the deck names what is written.
    place: Place,
    file: PathBuf,
    counter: TimeCounter,
    quantities: Vec<Quantity>,
    gauss: Vec<GaussQuantity>,
    flag: Option<&'static str>,
    history: bool,
    resultant: bool,
    by_coordinates: bool,
    series: Histories,
    last_write: Option<Instant>,
    messages: Vec<Diagnostic>,
}

/// Samples so far.
#[derive(Clone, Default, Serialize, Deserialize)]
struct Histories {
    /// Nodes of this rank that have passed the filter, ascending.
    known: Vec<u32>,
    /// Elements of this rank whose Gauss points are followed.
    followed: Vec<u32>,
    times: Vec<f64>,
    /// By id; of several ranks the first has them all.
    nodes: BTreeMap<usize, NodeSeries>,
    /// By id; of several ranks the first has them all.
    elements: BTreeMap<usize, Vec<Vec<Gauss>>>,
    resultants: Vec<Vec<f64>>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct JsonOutputState {
    counter: f64,
    series: Histories,
    /// Whether the ranks are others than those that have sampled.
    #[serde(skip)]
    repartitioned: bool,
}

stored_as_bytes!(JsonOutputState);

#[typetag::serde(name = "json_output")]
impl State for JsonOutputState {
    /// Every rank gets the complete list of the first one.
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {
        self.repartitioned = true;
    }
}

/// The history of one node: all quantities of a step one after another.
#[derive(Clone, Default, Serialize, Deserialize)]
struct NodeSeries {
    key: String,
    values: Vec<f64>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let required = ["model_part_name", "output_file_name"];
    let settings = &request.settings_with(|defaults: Defaults| defaults.require(&required))?;
    Ok(Box::new(JsonOutput {
        part: PartPath::new(settings)?,
        place: settings.key_place("output_variables"),
        file: file_of(settings, "output_file_name", request.results, "")?,
        counter: TimeCounter::new(settings)?,
        quantities: Quantity::list(settings, "output_variables", request.report)?,
        gauss: GaussQuantity::list(settings, "gauss_points_output_variables", request.report)?,
        flag: flag_setting(settings, "check_for_flag")?,
        history: settings.get_bool("historical_value")?,
        resultant: settings.get_bool("resultant_solution")?,
        by_coordinates: settings.get_bool("use_node_coordinates")?,
        series: Histories::default(),
        last_write: None,
        messages: Vec::new(),
    }))
}

/// Whether an item passes the filter.
pub(super) fn passes(flags: &Flags, flag: Option<&'static str>, item: u32) -> bool {
    flag.is_none_or(|flag| flags.is(flag, item as usize))
}

/// The key of a node, by its id.
pub(super) fn node_key(id: usize) -> String {
    format!("NODE_{id}")
}

impl JsonOutput {
    /// Whether all its lists of variables are empty.
    fn names_nothing(&self) -> bool {
        self.quantities.is_empty() && self.gauss.is_empty()
    }

    /// Makes keys for the nodes and elements that pass the filter and have none yet; collective.
    fn keys(&mut self, part: &ModelPart, selection: &SubPart) {
        let is_new = |node: &&u32| {
            self.series.known.binary_search(node).is_err()
                && part.owns_node(**node as usize)
                && passes(&part.nodes.flags, self.flag, **node)
        };
        let new: Vec<u32> = selection.nodes.iter().filter(is_new).copied().collect();
        let row = |&node: &u32| {
            let [x, y, z] = part.nodes.initial[node as usize];
            [part.nodes.ids[node as usize] as f64, x, y, z]
        };
        for row in rows(part.ranks.to_root(new.iter().flat_map(row).collect()), 4) {
            let id = row[0] as usize;
            let key = match self.by_coordinates {
                true => format!("NODE_X_{:.6}_Y_{:.6}_Z_{:.6}", row[1], row[2], row[3]),
                false => node_key(id),
            };
            self.series.nodes.insert(id, NodeSeries { key, ..NodeSeries::default() });
        }
        self.series.known.extend(new);
        self.series.known.sort_unstable();
        if self.gauss.is_empty() || part.ranks.any(!self.series.followed.is_empty()) {
            return;
        }
        let follows =
            |&&e: &&u32| part.evaluates(EntityRole::Element, e as usize) && passes(&part.elements.flags, self.flag, e);
        self.series.followed = selection.elements.iter().filter(follows).copied().collect();
        let ids = self.series.followed.iter().map(|&element| part.elements.ids[element as usize] as f64).collect();
        for id in part.ranks.to_root(ids).concat() {
            self.series.elements.insert(id as usize, vec![Vec::new(); self.gauss.len()]);
        }
    }

    /// Numbers that each quantity takes.
    fn sizes(&self, part: &ModelPart) -> Vec<usize> {
        self.quantities.iter().map(|quantity| quantity.components(quantity.fields(part, self.history))).collect()
    }

    /// Takes the values of this moment; collective.
    fn sample(&mut self, part: &ModelPart, system: &System, selection: &SubPart) {
        self.keys(part, selection);
        self.series.times.push(part.info.time);
        let sizes = self.sizes(part);
        let width: usize = sizes.iter().sum();
        let mut own = Vec::new();
        for &node in self.series.known.iter().filter(|&&node| passes(&part.nodes.flags, self.flag, node)) {
            own.push(part.nodes.ids[node as usize] as f64);
            let start = own.len();
            own.resize(start + width, 0.0);
            let mut rest = &mut own[start..];
            for (quantity, &size) in self.quantities.iter().zip(&sizes) {
                let (values, others) = rest.split_at_mut(size);
                quantity.read(quantity.fields(part, self.history), node, values);
                rest = others;
            }
        }
        let mut sum = vec![0.0; width];
        let mut sampled = rows(part.ranks.to_root(own), width + 1);
        sampled.sort_by(|a, b| a[0].total_cmp(&b[0]));
        for row in sampled {
            self.series.nodes.entry(row[0] as usize).or_default().values.extend_from_slice(&row[1..]);
            sum.iter_mut().zip(&row[1..]).for_each(|(sum, value)| *sum += value);
        }
        if self.resultant {
            self.series.resultants.push(sum);
        }
        for (at, quantity) in self.gauss.iter().enumerate() {
            let mut own = Vec::new();
            gauss::each(part, system, EntityRole::Element, &self.series.followed, quantity, |row, gauss| {
                let element = self.series.followed[row];
                if passes(&part.elements.flags, self.flag, element) {
                    let id = part.elements.ids[element as usize];
                    own.extend([id as f64, gauss.components as f64, gauss.values.len() as f64]);
                    own.extend(&gauss.values);
                }
            });
            for message in part.ranks.to_root(own) {
                let mut rest = &message[..];
                while let [id, components, count, more @ ..] = rest {
                    let (values, more) = more.split_at(*count as usize);
                    rest = more;
                    let only_values =
                        Gauss { components: *components as usize, values: values.to_vec(), ..Gauss::default() };
                    let series = self.series.elements.entry(*id as usize);
                    series.or_insert_with(|| vec![Vec::new(); self.gauss.len()])[at].push(only_values);
                }
            }
        }
    }

    fn write(&mut self, model: &Model) -> Result<()> {
        let (part, _) = self.part.find(model)?;
        let sizes = self.sizes(part);
        replace_file(&part.ranks, &self.file, |out| self.text(out, &sizes))?;
        self.last_write = Some(Instant::now());
        Ok(())
    }

    fn text(&self, out: &mut impl Write, sizes: &[usize]) -> io::Result<()> {
        let mut json = Json { out, depth: 0, first: true };
        json.open('{')?;
        json.key("TIME")?;
        json.numbers(self.series.times.iter().copied())?;
        if self.resultant {
            json.key("RESULTANT")?;
            self.series(&mut json, &self.series.resultants.concat(), sizes)?;
        } else {
            for series in self.series.nodes.values() {
                json.key(&series.key)?;
                self.series(&mut json, &series.values, sizes)?;
            }
        }
        for (id, series) in &self.series.elements {
            json.key(&format!("ELEMENT_{id}"))?;
            json.open('{')?;
            for (quantity, steps) in self.gauss.iter().zip(series) {
                let Some(first) = steps.first() else { continue };
                json.key(&quantity.name)?;
                json.open('{')?;
                for point in 0..first.values.len() / first.components.max(1) {
                    json.key(&point.to_string())?;
                    let rows = steps.iter().map(|step| &step.values[point * step.components..][..step.components]);
                    json.rows(rows, first.components)?;
                }
                json.close('}')?;
            }
            json.close('}')?;
        }
        json.close('}')?;
        writeln!(json.out)
    }

    /// The quantities of one node, each with its list; vectors by component.
    fn series<W: Write>(&self, json: &mut Json<'_, W>, values: &[f64], sizes: &[usize]) -> io::Result<()> {
        let width: usize = sizes.iter().sum();
        let mut offset = 0;
        json.open('{')?;
        for (quantity, &size) in self.quantities.iter().zip(sizes) {
            let rows = || values.chunks_exact(width).map(|row| &row[offset..offset + size]);
            if size == 3 {
                for (component, letter) in ["X", "Y", "Z"].iter().enumerate() {
                    json.key(&format!("{}_{letter}", quantity.name))?;
                    json.numbers(rows().map(|row| row[component]))?;
                }
            } else {
                json.key(&quantity.name)?;
                json.rows(rows(), size)?;
            }
            offset += size;
        }
        json.close('}')
    }
}

/// The rows of the messages of all ranks.
fn rows(messages: Vec<Vec<f64>>, width: usize) -> Vec<Vec<f64>> {
    messages.iter().flat_map(|message| message.chunks_exact(width).map(<[f64]>::to_vec).collect::<Vec<_>>()).collect()
}

/// Writes JSON with an indentation of two.
struct Json<'a, W: Write> {
    out: &'a mut W,
    depth: usize,
    first: bool,
}

impl<W: Write> Json<'_, W> {
    fn line(&mut self) -> io::Result<()> {
        if !self.first {
            self.out.write_all(b",")?;
        }
        self.first = false;
        self.new_line()
    }

    fn new_line(&mut self) -> io::Result<()> {
        write!(self.out, "\n{:width$}", "", width = 2 * self.depth)
    }

    fn open(&mut self, bracket: char) -> io::Result<()> {
        (self.depth, self.first) = (self.depth + 1, true);
        write!(self.out, "{bracket}")
    }

    fn close(&mut self, bracket: char) -> io::Result<()> {
        self.depth -= 1;
        if !self.first {
            self.new_line()?;
        }
        self.first = false;
        write!(self.out, "{bracket}")
    }

    fn key(&mut self, key: &str) -> io::Result<()> {
        self.line()?;
        write!(self.out, "\"{key}\": ")
    }

    fn number(&mut self, value: f64) -> io::Result<()> {
        self.line()?;
        // JSON has no word for a value that is not a number.
        if value.is_finite() { write!(self.out, "{value:?}") } else { write!(self.out, "null") }
    }

    fn numbers(&mut self, values: impl Iterator<Item = f64>) -> io::Result<()> {
        self.open('[')?;
        for value in values {
            self.number(value)?;
        }
        self.close(']')
    }

    /// A list of numbers, or of lists where a row has several.
    fn rows<'v>(&mut self, rows: impl Iterator<Item = &'v [f64]>, size: usize) -> io::Result<()> {
        if size == 1 {
            return self.numbers(rows.map(|row| row[0]));
        }
        self.open('[')?;
        for row in rows {
            self.line()?;
            self.numbers(row.iter().copied())?;
        }
        self.close(']')
    }
}

impl Process for JsonOutput {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        self.part.find(model).map(|_| ())
    }

    fn check(&self, _model: &Model, _system: &System, warnings: &mut Report) -> Result<()> {
        let idle = self.names_nothing().then(|| no_output(NAME, NO_VARIABLE, &self.place));
        idle.into_iter().for_each(|warning| warnings.push(warning));
        Ok(())
    }

    fn before_loop(&mut self, model: &mut Model) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        self.keys(part, selection);
        Ok(())
    }

    fn end_step(&mut self, model: &mut Model, system: &System) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        if self.counter.acts(&part.info) {
            if self.series.times.is_empty() {
                let missing = self.quantities.iter().filter_map(|quantity| quantity.missing_at_nodes(part, NAME));
                self.messages = missing.map(|warning| warning.at(self.place.clone())).collect();
            }
            self.sample(part, system, selection);
            if self.last_write.is_none_or(|last| last.elapsed() > REWRITE) {
                self.write(model)?;
            }
        }
        Ok(())
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn last_messages(&self, model: &Model) -> Vec<Diagnostic> {
        let Histories { times, nodes, elements, resultants, .. } = &self.series;
        let is_empty = resultants.iter().all(Vec::is_empty)
            && nodes.values().all(|node| node.values.is_empty())
            && elements.values().flatten().all(Vec::is_empty);
        let why = if times.is_empty() { NO_STEP } else { "no node or element of its part and flag has such values" };
        let is_idle = is_empty && !self.names_nothing() && model.ranks.is_root();
        is_idle.then(|| no_output(NAME, why, &self.place)).into_iter().collect()
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(JsonOutputState {
            counter: self.counter.counter,
            series: self.series.clone(),
            repartitioned: false,
        }))
    }

    fn resume(&mut self, model: &mut Model, state: Box<dyn State>) -> Result<()> {
        let JsonOutputState { counter, mut series, repartitioned } = state.take()?;
        if repartitioned {
            let (part, selection) = self.part.find(model)?;
            let known = |&&node: &&u32| {
                part.owns_node(node as usize) && series.nodes.contains_key(&part.nodes.ids[node as usize])
            };
            let followed = |&&element: &&u32| {
                let id = part.elements.ids[element as usize];
                part.evaluates(EntityRole::Element, element as usize) && series.elements.contains_key(&id)
            };
            series.known = selection.nodes.iter().filter(known).copied().collect();
            series.followed = selection.elements.iter().filter(followed).copied().collect();
            if !part.ranks.is_root() {
                (series.nodes, series.elements) = Default::default();
            }
        }
        let part = self.part.find(model)?.0;
        let known = series.known.iter().all(|&node| (node as usize) < part.nodes.len())
            && series.followed.iter().all(|&element| (element as usize) < part.elements.len());
        let alike = |steps: &Vec<Gauss>| {
            let size = |gauss: &Gauss| (gauss.components, gauss.values.len());
            steps.iter().all(|gauss| {
                gauss.components > 0 && gauss.values.len() % gauss.components == 0 && size(gauss) == size(&steps[0])
            })
        };
        let whole = series.elements.values().all(|of| of.len() == self.gauss.len() && of.iter().all(alike));
        if !(known && whole && series.known.is_sorted()) {
            return Err(unfit(format!("the histories of {} are not of this mesh", self.file.display())));
        }
        (self.counter.counter, self.series) = (counter, series);
        Ok(())
    }

    /// A run that fails before the first step leaves the file of an earlier one.
    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        if self.series.times.is_empty() && self.file.exists() { Ok(()) } else { self.write(model) }
    }

    fn files(&self) -> Vec<FileUse> {
        vec![FileUse::Writes(self.file.clone(), Mark::Holds("\"TIME\""))]
    }

    fn outputs(&self) -> Vec<PathBuf> {
        vec![self.file.clone()]
    }
}

register! { ProcessEntry NAME,
    aliases: &["JsonOutputProcess"],
    about: "writes histories of nodes and Gauss points to a JSON file",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/json_output_process.json")),
    build: build,
}
