//! Histories of nodes and Gauss points in a JSON file.

use std::io::{self, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::control::TimeCounter;
use super::gauss;
use super::place::{PartPath, file_of};
use super::quantity::{GaussQuantity, Quantity, flag_setting};
use crate::diagnostics::Result;
use crate::entities::Gauss;
use crate::io::replace_file;
use crate::model::{Fields, Flags, Model, ModelPart, SubPart};
use crate::parameters::Defaults;
use crate::processes::{Process, ProcessRequest};
use crate::register;
use crate::registry::{Build, Kind};

/// How often at most the file is rewritten while the run goes on; at its end it is in any case.
const REWRITE: Duration = Duration::from_secs(10);

/// Keeps histories in memory and writes them as one file.
struct JsonOutput {
    part: PartPath,
    file: PathBuf,
    counter: TimeCounter,
    quantities: Vec<Quantity>,
    gauss: Vec<GaussQuantity>,
    flag: Option<&'static str>,
    history: bool,
    resultant: bool,
    by_coordinates: bool,
    times: Vec<f64>,
    nodes: Vec<NodeSeries>,
    elements: Vec<ElementSeries>,
    resultants: Vec<Vec<f64>>,
    last_write: Option<Instant>,
}

/// The history of one node: all quantities of a step one after another.
struct NodeSeries {
    node: u32,
    key: String,
    values: Vec<f64>,
}

/// The history of one element: for each quantity its steps.
struct ElementSeries {
    element: u32,
    key: String,
    steps: Vec<Vec<Gauss>>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let required = ["model_part_name", "output_file_name"];
    let settings = &request.settings_with(|defaults: Defaults| defaults.require(&required))?;
    Ok(Box::new(JsonOutput {
        part: PartPath::new(settings)?,
        file: file_of(settings, "output_file_name", request, "")?,
        counter: TimeCounter::new(settings)?,
        quantities: Quantity::list(settings, "output_variables", request.report)?,
        gauss: GaussQuantity::list(settings, "gauss_points_output_variables", request.report)?,
        flag: flag_setting(settings, "check_for_flag")?,
        history: settings.get_bool("historical_value")?,
        resultant: settings.get_bool("resultant_solution")?,
        by_coordinates: settings.get_bool("use_node_coordinates")?,
        times: Vec::new(),
        nodes: Vec::new(),
        elements: Vec::new(),
        resultants: Vec::new(),
        last_write: None,
    }))
}

/// Whether an item passes the filter.
pub(super) fn passes(flags: &Flags, flag: Option<&'static str>, item: u32) -> bool {
    flag.is_none_or(|flag| flags.is(flag, item as usize))
}

/// The fields a process looks at.
pub(super) fn fields(part: &ModelPart, history: bool) -> &Fields {
    if history { &part.nodes.history } else { &part.nodes.values }
}

/// The key of a node, by id or by its initial coordinates.
pub(super) fn node_key(part: &ModelPart, node: u32, by_coordinates: bool) -> String {
    let at = node as usize;
    if by_coordinates {
        let [x, y, z] = part.nodes.initial[at];
        return format!("NODE_X_{x:.6}_Y_{y:.6}_Z_{z:.6}");
    }
    format!("NODE_{}", part.nodes.ids[at])
}

impl JsonOutput {
    /// Makes keys for the nodes and elements that pass the filter and have none yet.
    fn keys(&mut self, part: &ModelPart, selection: &SubPart) {
        let known: Vec<u32> = self.nodes.iter().map(|series| series.node).collect();
        let new = |node: &&u32| known.binary_search(node).is_err() && passes(&part.nodes.flags, self.flag, **node);
        let new: Vec<u32> = selection.nodes.iter().filter(new).copied().collect();
        for node in new {
            let key = node_key(part, node, self.by_coordinates);
            self.nodes.push(NodeSeries { node, key, values: Vec::new() });
        }
        self.nodes.sort_by_key(|series| series.node);
        if self.gauss.is_empty() || !self.elements.is_empty() {
            return;
        }
        for &element in selection.elements.iter().filter(|&&e| passes(&part.elements.flags, self.flag, e)) {
            let key = format!("ELEMENT_{}", part.elements.ids[element as usize]);
            self.elements.push(ElementSeries { element, key, steps: vec![Vec::new(); self.gauss.len()] });
        }
    }

    fn sample(&mut self, part: &ModelPart, selection: &SubPart) {
        self.keys(part, selection);
        self.times.push(part.info.time);
        let fields = fields(part, self.history);
        let sizes: Vec<usize> = self.quantities.iter().map(|q| q.components(fields)).collect();
        let width = sizes.iter().sum();
        let mut sum = vec![0.0; width];
        for series in self.nodes.iter_mut().filter(|s| passes(&part.nodes.flags, self.flag, s.node)) {
            let start = series.values.len();
            series.values.resize(start + width, 0.0);
            let mut rest = &mut series.values[start..];
            for (quantity, &size) in self.quantities.iter().zip(&sizes) {
                let (own, others) = rest.split_at_mut(size);
                quantity.read(fields, series.node, own);
                rest = others;
            }
            sum.iter_mut().zip(&series.values[start..]).for_each(|(sum, value)| *sum += value);
        }
        if self.resultant {
            self.resultants.push(sum);
        }
        let elements: Vec<u32> = self.elements.iter().map(|series| series.element).collect();
        for (at, quantity) in self.gauss.iter().enumerate() {
            let series = &mut self.elements;
            gauss::each(part, Kind::Element, &elements, quantity, |row, values| {
                if passes(&part.elements.flags, self.flag, elements[row]) {
                    let only_values =
                        Gauss { components: values.components, values: values.values.clone(), ..Gauss::default() };
                    series[row].steps[at].push(only_values);
                }
            });
        }
    }

    fn write(&mut self, model: &Model) -> Result<()> {
        let (part, _) = self.part.find(model)?;
        let sizes: Vec<usize> = self.quantities.iter().map(|q| q.components(fields(part, self.history))).collect();
        replace_file(&self.file, |out| self.text(out, &sizes))?;
        self.last_write = Some(Instant::now());
        Ok(())
    }

    fn text(&self, out: &mut impl Write, sizes: &[usize]) -> io::Result<()> {
        let mut json = Json { out, depth: 0, first: true };
        json.open('{')?;
        json.key("TIME")?;
        json.numbers(self.times.iter().copied())?;
        if self.resultant {
            json.key("RESULTANT")?;
            self.series(&mut json, &self.resultants.concat(), sizes)?;
        } else {
            for series in &self.nodes {
                json.key(&series.key)?;
                self.series(&mut json, &series.values, sizes)?;
            }
        }
        for series in &self.elements {
            json.key(&series.key)?;
            json.open('{')?;
            for (quantity, steps) in self.gauss.iter().zip(&series.steps) {
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
        // JSON has no word for what is not a number.
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
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        self.part.find(model).map(|_| ())
    }

    fn before_loop(&mut self, model: &mut Model) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        self.keys(part, selection);
        self.write(model)
    }

    fn end_step(&mut self, model: &mut Model) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        if self.counter.acts(&part.info) {
            self.sample(part, selection);
            if self.last_write.is_none_or(|last| last.elapsed() > REWRITE) {
                self.write(model)?;
            }
        }
        Ok(())
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        self.write(model)
    }

    fn outputs(&self) -> Vec<PathBuf> {
        vec![self.file.clone()]
    }
}

register! { Process "json_output_process",
    aliases: &["JsonOutputProcess"],
    about: "writes histories of nodes and Gauss points to a JSON file",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/json_output_process.json")),
    build: Build::Process(build),
}
