//! The history of quantities at one point of space, as a text file of columns.

use std::io::Write;
use std::path::PathBuf;

use super::json_output_process::fields;
use super::place::{PartPath, one_of};
use super::quantity::Quantity;
use crate::diagnostics::{Diagnostic, Place, Result};
use crate::geometry::{mapping, shape_functions};
use crate::io::{append_to_file, replace_file};
use crate::model::{EntityTable, Model, ModelPart, SubPart};
use crate::parameters::{Defaults, Interval, Node};
use crate::processes::{Process, ProcessRequest};
use crate::register;
use crate::registry::Build;

/// Interpolates in the cell that holds the point; the cell is found once, before the first step.
struct PointOutput {
    part: PartPath,
    file: PathBuf,
    interval: Interval,
    position: [f64; 3],
    place: Place,
    entity: usize,
    is_current: bool,
    tolerance: f64,
    history: bool,
    quantities: Vec<Quantity>,
    /// Nodes and their weights.
    weights: Vec<(u32, f64)>,
}

const ENTITIES: [&str; 3] = ["node", "element", "condition"];

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let required = ["model_part_name", "position", "output_variables", "output_file_settings"];
    let settings = &request.settings_with(|defaults: Defaults| defaults.require(&required))?;
    let numbers = settings.items("position")?.iter().map(Node::f64).collect::<Result<Vec<f64>>>()?;
    let position = numbers.try_into().map_err(|_| {
        settings.error("position", "wrong-size", "\"position\" is not three numbers").remedy("write [x, y, z]")
    })?;
    let mut file = request.folder.join(settings.get_str("output_file_settings.output_path")?);
    let name = settings.get_str("output_file_settings.file_name")?;
    if name.is_empty() {
        let fact = "\"file_name\" of \"output_file_settings\" must name a file";
        return Err(settings.error("output_file_settings", "missing-key", fact).into());
    }
    let ending = settings.get_str("output_file_settings.file_extension")?;
    file.push(if name.contains('.') { name.to_owned() } else { format!("{name}.{ending}") });
    Ok(Box::new(PointOutput {
        part: PartPath::new(settings)?,
        file,
        interval: Interval::from_node(settings.get("interval")?)?,
        position,
        place: settings.key_place("position"),
        entity: one_of(settings, "entity_type", &ENTITIES)?,
        is_current: one_of(settings, "search_configuration", &["initial", "current"])? == 1,
        tolerance: settings.get_f64("search_tolerance")?,
        history: settings.get_bool("historical_value")?,
        quantities: Quantity::list(settings, "output_variables", request.report)?,
        weights: Vec::new(),
    }))
}

impl PointOutput {
    /// The nodes whose values are mixed, with their weights; `None` when the point is nowhere.
    fn find(&self, part: &ModelPart, selection: &SubPart) -> Option<Vec<(u32, f64)>> {
        let positions = if self.is_current { &part.nodes.current } else { &part.nodes.initial };
        match self.entity {
            0 => {
                let distance = |node: u32| {
                    let x = positions[node as usize];
                    x.iter().zip(&self.position).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
                };
                let found = selection.nodes.iter().copied().min_by(|&a, &b| distance(a).total_cmp(&distance(b)))?;
                (distance(found) <= self.tolerance).then(|| vec![(found, 1.0)])
            }
            1 => self.in_cells(positions, &part.elements, &selection.elements),
            _ => self.in_cells(positions, &part.conditions, &selection.conditions),
        }
    }

    fn in_cells(&self, positions: &[[f64; 3]], table: &EntityTable, cells: &[u32]) -> Option<Vec<(u32, f64)>> {
        cells.iter().find_map(|&cell| {
            let shape = table.kinds[cell as usize].cell?;
            let nodes = table.nodes(cell);
            let x: Vec<[f64; 3]> = nodes.iter().map(|&node| positions[node as usize]).collect();
            let is_near = (0..3).all(|axis| {
                let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x[axis]), h.max(x[axis])));
                let slack = self.tolerance + 0.1 * (high - low);
                (low - slack..=high + slack).contains(&self.position[axis])
            });
            let found = is_near.then(|| mapping::local_coordinates(shape, &x, self.position)).flatten()?;
            if found.distance > self.tolerance || !shape.cell().contains(found.xi, self.tolerance) {
                return None;
            }
            let mut values = [0.0; 27];
            shape_functions(shape, found.xi, &mut values);
            Some(nodes.iter().copied().zip(values).collect())
        })
    }

    fn line(&self, part: &ModelPart) -> String {
        let fields = fields(part, self.history);
        let mut line = format!("{:?}", part.info.time);
        for quantity in &self.quantities {
            let mut sum = vec![0.0; quantity.components(fields)];
            let mut value = sum.clone();
            for &(node, weight) in &self.weights {
                quantity.read(fields, node, &mut value);
                sum.iter_mut().zip(&value).for_each(|(sum, value)| *sum += weight * value);
            }
            sum.iter().for_each(|number| line.push_str(&format!(" {number:?}")));
        }
        line
    }

    fn head(&self, part: &ModelPart) -> String {
        let [x, y, z] = self.position;
        let mut head =
            format!("# Results for \"{}\" at position: x: {x:?}; y: {y:?}; z: {z:?}\n# time", ENTITIES[self.entity]);
        let fields = fields(part, self.history);
        for quantity in &self.quantities {
            match quantity.components(fields) {
                1 => head.push_str(&format!(" {}", quantity.name)),
                3 => ["X", "Y", "Z"].iter().for_each(|c| head.push_str(&format!(" {}_{c}", quantity.name))),
                n => (0..n).for_each(|c| head.push_str(&format!(" {}_{c}", quantity.name))),
            }
        }
        head
    }
}

impl Process for PointOutput {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        let nowhere = || {
            let [x, y, z] = self.position;
            let fact = format!("no {} of {:?} holds the point ({x}, {y}, {z})", ENTITIES[self.entity], self.part.path);
            let remedy = "move the point into the part, or enlarge \"search_tolerance\"";
            Diagnostic::error("point-outside", fact).at(self.place.clone()).remedy(remedy)
        };
        self.weights = self.find(part, selection).ok_or_else(nowhere)?;
        Ok(())
    }

    fn before_loop(&mut self, model: &mut Model) -> Result<()> {
        let (part, _) = self.part.find(model)?;
        replace_file(&self.file, |out| writeln!(out, "{}", self.head(part)))
    }

    fn end_step(&mut self, model: &mut Model) -> Result<()> {
        let (part, _) = self.part.find(model)?;
        if !self.interval.contains(part.info.time) {
            return Ok(());
        }
        append_to_file(&self.file, |out| writeln!(out, "{}", self.line(part)))
    }

    fn outputs(&self) -> Vec<PathBuf> {
        vec![self.file.clone()]
    }
}

register! { Process "point_output_process",
    aliases: &["PointOutputProcess"],
    about: "writes the history of quantities at one point of space, a line a step",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/point_output_process.json")),
    build: Build::Process(build),
}
