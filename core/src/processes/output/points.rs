//! Histories of quantities at points of space, as text files of columns, one a point.

use std::io::Write;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use super::part_path::{NO_VARIABLE, PartPath, no_output, one_of};
use super::quantity::Quantity;
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Error, Place, Report, Result, coordinates};
use crate::geometry::{mapping, shape_functions};
use crate::io::{FileUse, Mark, append_to_file, cut_file, length_of, replace_file};
use crate::model::{EntityRole, Model, ModelPart, SubPart};
use crate::parameters::{Interval, Node, Settings};
use crate::processes::{Process, ProcessRequest};

/// Interpolates in the cells that hold the points; the cells are found once, before the first step.
pub(super) struct PointsOutput {
    part: PartPath,
    interval: Interval,
    place: Place,
    entity: usize,
    is_current: bool,
    tolerance: f64,
    history: bool,
    quantities: Vec<Quantity>,
    points: Vec<OutputPoint>,
    /// Where the points were read from, if they were.
    source: Option<PathBuf>,
    /// Whether the files hold their heads.
    begun: bool,
    messages: Vec<Diagnostic>,
}

struct OutputPoint {
    position: [f64; 3],
    file: PathBuf,
    /// Nodes and their weights, on the rank that writes them.
    weights: Vec<(u32, f64)>,
}

/// Where a point was found: how far away, the id of the node or entity, and the nodes to mix with their weights.
type Found = (f64, usize, Vec<(u32, f64)>);

/// Keys that every process of points must be given.
pub(super) const REQUIRED: [&str; 3] = ["model_part_name", "output_variables", "output_file_settings"];

const ENTITIES: [&str; 3] = ["node", "element", "condition"];

/// One file for the one point of `key`, or with `_1`, `_2`, … in their names one for each of several.
///
/// # Errors
/// Settings that do not fit.
pub(super) fn points_output(
    request: &mut ProcessRequest<'_>,
    settings: &Settings,
    key: &str,
    positions: &[[f64; 3]],
    several: bool,
) -> Result<Box<dyn Process>> {
    let folder = request.results.join(settings.get_str("output_file_settings.output_path")?);
    let name = settings.get_str("output_file_settings.file_name")?;
    if name.is_empty() {
        let fact = "\"file_name\" of \"output_file_settings\" must name a file";
        return Err(settings.error("output_file_settings", "missing-key", fact).into());
    }
    let ending = settings.get_str("output_file_settings.file_extension")?;
    let file = |at: usize| match (several, name.contains('.')) {
        (true, _) => folder.join(format!("{}_{}.{ending}", name.strip_suffix(".dat").unwrap_or(name), at + 1)),
        (false, true) => folder.join(name),
        (false, false) => folder.join(format!("{name}.{ending}")),
    };
    let point = |(at, &position)| OutputPoint { position, file: file(at), weights: Vec::new() };
    Ok(Box::new(PointsOutput {
        part: PartPath::new(settings)?,
        interval: Interval::from_node(settings.get("interval")?)?,
        place: settings.key_place(key),
        entity: one_of(settings, "entity_type", &ENTITIES)?,
        is_current: one_of(settings, "search_configuration", &["initial", "current"])? == 1,
        tolerance: settings.get_f64("search_tolerance")?,
        history: settings.get_bool("historical_value")?,
        quantities: Quantity::list(settings, "output_variables", request.report)?,
        points: positions.iter().enumerate().map(point).collect(),
        source: settings.node().get("csv_file_path").and_then(Node::as_str).map(|name| request.folder.join(name)),
        begun: false,
        messages: Vec::new(),
    }))
}

/// Three numbers.
///
/// # Errors
/// Anything else.
pub(super) fn position(settings: &Settings, key: &str, node: &Node) -> Result<[f64; 3]> {
    let numbers = node.array()?.iter().map(Node::f64).collect::<Result<Vec<f64>>>()?;
    numbers.try_into().map_err(|_| {
        let fact = format!("a point of \"{key}\" is not three numbers");
        settings.error(key, "wrong-size", fact).remedy("write [x, y, z]").into()
    })
}

impl PointsOutput {
    /// The nodes whose values are mixed, with their weights; empty on ranks that others go before, `None` when the point is
    /// nowhere. Collective.
    fn find(&self, part: &ModelPart, selection: &SubPart, point: [f64; 3]) -> Option<Vec<(u32, f64)>> {
        let own = self.find_here(part, selection, point);
        let offer = own.as_ref().map_or(Vec::new(), |(distance, id, _)| vec![*distance, *id as f64]);
        let offers = part.ranks.gather_numbers(&offer);
        let order = |a: &usize, b: &usize| offers[*a].partial_cmp(&offers[*b]).unwrap_or(std::cmp::Ordering::Equal);
        let best = (0..offers.len()).filter(|&rank| !offers[rank].is_empty()).min_by(order)?;
        Some(own.filter(|_| best == part.ranks.rank()).map_or(Vec::new(), |(.., weights)| weights))
    }

    fn find_here(&self, part: &ModelPart, selection: &SubPart, point: [f64; 3]) -> Option<Found> {
        let positions = if self.is_current { &part.nodes.current } else { &part.nodes.initial };
        match self.entity {
            0 => {
                let distance = |node: u32| {
                    let x = positions[node as usize];
                    x.iter().zip(&point).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
                };
                let own = selection.nodes.iter().copied().filter(|&node| part.owns_node(node as usize));
                let found = own.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))?;
                let id = part.nodes.ids[found as usize];
                (distance(found) <= self.tolerance).then(|| (distance(found), id, vec![(found, 1.0)]))
            }
            1 => self.in_cells(part, EntityRole::Element, &selection.elements, point),
            _ => self.in_cells(part, EntityRole::Condition, &selection.conditions, point),
        }
    }

    fn in_cells(&self, part: &ModelPart, kind: EntityRole, cells: &[u32], point: [f64; 3]) -> Option<Found> {
        let positions = if self.is_current { &part.nodes.current } else { &part.nodes.initial };
        let table = if kind == EntityRole::Element { &part.elements } else { &part.conditions };
        cells.iter().filter(|&&cell| part.evaluates(kind, cell as usize)).find_map(|&cell| {
            let shape = table.kinds[cell as usize].cell?;
            let nodes = table.nodes(cell);
            let x: Vec<[f64; 3]> = nodes.iter().map(|&node| positions[node as usize]).collect();
            let is_near = (0..3).all(|axis| {
                let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x[axis]), h.max(x[axis])));
                let slack = self.tolerance + 0.1 * (high - low);
                (low - slack..=high + slack).contains(&point[axis])
            });
            let found = is_near.then(|| mapping::local_coordinates(shape, &x, point)).flatten()?;
            if found.distance > self.tolerance || !shape.cell().contains(found.xi, self.tolerance) {
                return None;
            }
            let mut values = [0.0; 27];
            shape_functions(shape, found.xi, &mut values);
            Some((0.0, table.ids[cell as usize], nodes.iter().copied().zip(values).collect()))
        })
    }

    /// The values at a point that this rank has found.
    fn values(&self, part: &ModelPart, point: &OutputPoint) -> Vec<f64> {
        let mut values = Vec::new();
        for quantity in &self.quantities {
            let fields = quantity.fields(part, self.history);
            let mut sum = vec![0.0; quantity.components(fields)];
            let mut value = sum.clone();
            for &(node, weight) in &point.weights {
                quantity.read(fields, node, &mut value);
                sum.iter_mut().zip(&value).for_each(|(sum, value)| *sum += weight * value);
            }
            values.extend(sum);
        }
        values
    }

    fn head(&self, part: &ModelPart, point: &OutputPoint) -> String {
        let [x, y, z] = point.position;
        let mut head =
            format!("# Results for \"{}\" at position: x: {x:?}; y: {y:?}; z: {z:?}\n# time", ENTITIES[self.entity]);
        for quantity in &self.quantities {
            match quantity.components(quantity.fields(part, self.history)) {
                1 => head.push_str(&format!(" {}", quantity.name)),
                3 => ["X", "Y", "Z"].iter().for_each(|c| head.push_str(&format!(" {}_{c}", quantity.name))),
                n => (0..n).for_each(|c| head.push_str(&format!(" {}_{c}", quantity.name))),
            }
        }
        head
    }
}

/// Lengths of the files, once there are any.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct SavedLengths(Vec<u64>);

stored_as_bytes!(SavedLengths);

#[typetag::serde(name = "points_output")]
impl State for SavedLengths {
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
}

impl Process for PointsOutput {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        let find = |point: &OutputPoint| {
            self.find(part, selection, point.position).ok_or_else(|| {
                let place = coordinates(point.position);
                let fact = format!("no {} of {:?} holds the point {place}", ENTITIES[self.entity], self.part.path);
                let remedy = "move the point into the part, or enlarge \"search_tolerance\"";
                Error::from(Diagnostic::error("point-outside", fact).at(self.place.clone()).remedy(remedy))
            })
        };
        let found = self.points.iter().map(find).collect::<Result<Vec<_>>>()?;
        self.points.iter_mut().zip(found).for_each(|(point, weights)| point.weights = weights);
        Ok(())
    }

    fn check(&self, _model: &Model, _system: &System, warnings: &mut Report) -> Result<()> {
        let idle = self.quantities.is_empty().then(|| no_output("output at points", NO_VARIABLE, &self.place));
        idle.into_iter().for_each(|warning| warnings.push(warning));
        Ok(())
    }

    fn end_step(&mut self, model: &mut Model, _system: &System) -> Result<()> {
        let (part, _) = self.part.find(model)?;
        if !self.interval.contains(part.info.time) {
            return Ok(());
        }
        if !self.begun {
            self.points.iter().try_for_each(|point| {
                replace_file(&part.ranks, &point.file, |out| writeln!(out, "{}", self.head(part, point)))
            })?;
            self.begun = true;
            let missing =
                self.quantities.iter().filter_map(|quantity| quantity.missing_at_nodes(part, "output at points"));
            self.messages = missing.map(|warning| warning.at(self.place.clone())).collect();
        }
        let own = self.points.iter().enumerate().filter(|(_, point)| !point.weights.is_empty());
        let mut message = Vec::new();
        for (at, point) in own {
            let values = self.values(part, point);
            message.extend([at as f64, values.len() as f64]);
            message.extend(values);
        }
        for message in part.ranks.to_root(message) {
            let mut rest = &message[..];
            while let [at, count, more @ ..] = rest {
                let (values, more) = more.split_at(*count as usize);
                rest = more;
                let mut line = format!("{:?}", part.info.time);
                values.iter().for_each(|number| line.push_str(&format!(" {number:?}")));
                append_to_file(&part.ranks, &self.points[*at as usize].file, |out| writeln!(out, "{line}"))?;
            }
        }
        Ok(())
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn state(&self) -> Option<Box<dyn State>> {
        let begun = self.points.iter().filter(|_| self.begun);
        Some(Box::new(SavedLengths(begun.map(|point| length_of(&point.file)).collect())))
    }

    fn resume(&mut self, model: &mut Model, state: Box<dyn State>) -> Result<()> {
        let SavedLengths(lengths) = state.take()?;
        self.begun = !lengths.is_empty();
        self.points.iter().zip(lengths).try_for_each(|(point, length)| cut_file(&model.ranks, &point.file, length))
    }

    fn files(&self) -> Vec<FileUse> {
        let read = self.source.iter().cloned().map(FileUse::Reads);
        read.chain(self.points.iter().map(|point| FileUse::Writes(point.file.clone(), Mark::Begins(&["#"])))).collect()
    }

    fn outputs(&self) -> Vec<PathBuf> {
        self.points.iter().map(|point| point.file.clone()).collect()
    }
}
