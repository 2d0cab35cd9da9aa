//! `zelus diff`: two result sets by node and field.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use zelus_core::Result;
use zelus_core::io::results::{Column, Dataset};

use super::matching::{By, match_points};
use super::results::{Series, find};
use super::say::say;

/// The command line of `zelus diff`.
#[derive(Debug, clap::Args)]
pub(super) struct DiffArguments {
    /// A folder with results (.pvd, .vtu, .json of json_output_process), one such file, or the report of a run.
    first: PathBuf,
    /// Results to compare with the first.
    second: PathBuf,
    /// Largest difference of equal numbers, relative to the largest value of the field over all steps.
    #[arg(long, default_value_t = 0.0)]
    tolerance: f64,
    /// Largest difference of equal numbers, in the unit of the field.
    #[arg(long, default_value_t = 0.0)]
    absolute: f64,
}

/// Compares; exit code 0 where all is equal within the tolerance, 1 where not.
///
/// # Errors
/// Results that cannot be read.
pub(super) fn run(arguments: &DiffArguments) -> Result<ExitCode> {
    let (first, second) = (find(&arguments.first)?, find(&arguments.second)?);
    let mut comparison =
        Comparison { tolerance: arguments.tolerance, absolute: arguments.absolute, ..Comparison::default() };
    if let ([(name, own)], [(_, other)]) =
        (&first.iter().collect::<Vec<_>>()[..], &second.iter().collect::<Vec<_>>()[..])
    {
        comparison.series(name, own, other)?;
    } else {
        for (name, own) in &first {
            match second.get(name) {
                Some(other) => comparison.series(name, own, other)?,
                None => comparison.differs(format!("{name} is only in {}", arguments.first.display())),
            }
        }
        for name in second.keys().filter(|name| !first.contains_key(*name)) {
            comparison.differs(format!("{name} is only in {}", arguments.second.display()));
        }
    }
    comparison.notes.iter().for_each(|note| say(note));
    let word = if comparison.is_different { "different" } else { "equal" };
    say(&format!("{word}: {} numbers of {} steps compared", comparison.numbers, comparison.steps));
    Ok(ExitCode::from(u8::from(comparison.is_different)))
}

/// Findings of a comparison.
#[derive(Debug, Default)]
struct Comparison {
    tolerance: f64,
    absolute: f64,
    is_different: bool,
    numbers: usize,
    steps: usize,
    notes: Vec<String>,
}

/// The worst of a field.
#[derive(Debug, Default)]
struct Field {
    /// Largest number of both runs, over all steps.
    largest: f64,
    difference: f64,
    /// Where and when the difference is.
    place: String,
}

impl Comparison {
    fn differs(&mut self, why: String) {
        self.is_different = true;
        self.notes.push(why);
    }

    fn series(&mut self, name: &str, first: &Series, second: &Series) -> Result<()> {
        if first.len() != second.len() {
            self.differs(format!("{name}: {} steps and {}", first.len(), second.len()));
        }
        let mut fields: BTreeMap<String, Field> = BTreeMap::new();
        let mut how = By::Order;
        for (step, (own, other)) in first.iter().zip(second).enumerate() {
            self.steps += 1;
            let times = own.time.zip(other.time);
            if let Some((t, u)) =
                times.filter(|(t, u)| (t - u).abs() > self.tolerance.max(1e-12) * t.abs().max(u.abs()))
            {
                self.differs(format!("{name}: step {} is at time {t}, and at {u}", step + 1));
            }
            let when = own.time.map_or_else(String::new, |time| format!(", time {time}"));
            let when = format!("step {}{when}", step + 1);
            let (own, other) = (own.read()?, other.read()?);
            let Some((by, places)) = match_points(&own, &other) else {
                self.differs(format!(
                    "{name}, {when}: {} points and {} that are not the same",
                    own.points.len(),
                    other.points.len()
                ));
                continue;
            };
            how = by;
            self.fields(&own, &other, &places, &when, &mut fields);
            if by == By::Order && own.cells == other.cells {
                let same: Vec<usize> = (0..own.cells.len()).collect();
                let cell = |at: usize| match own.cells.ids.get(at) {
                    Some(id) if *id > 0 => format!("cell {id}, {when}"),
                    _ => format!("cell number {}, {when}", at + 1),
                };
                self.columns([&own.cell_data, &other.cell_data], &same, &cell, &mut fields);
            } else if !own.cell_data.is_empty() {
                let note = format!("{name}: points are numbered otherwise, so that fields of cells are not compared");
                if !self.notes.contains(&note) {
                    self.notes.push(note);
                }
            }
        }
        match how {
            By::Order => {}
            By::Place => self.notes.push(format!("{name}: points are told by their places")),
            By::Id => self.notes.push(format!("{name}: points are told by their ids")),
        }
        self.judge(name, fields);
        Ok(())
    }

    fn fields(
        &mut self,
        own: &Dataset,
        other: &Dataset,
        places: &[usize],
        when: &str,
        fields: &mut BTreeMap<String, Field>,
    ) {
        let node = |at: usize| {
            let who =
                own.point_ids.get(at).map_or_else(|| format!("point number {}", at + 1), |id| format!("node {id}"));
            let [x, y, z] = own.points[at];
            if x.is_nan() { format!("{who}, {when}") } else { format!("{who} ({x:.6}, {y:.6}, {z:.6}), {when}") }
        };
        self.columns([&own.point_data, &other.point_data], places, &node, fields);
    }

    fn columns(
        &mut self,
        [own, other]: [&[Column]; 2],
        places: &[usize],
        place: &dyn Fn(usize) -> String,
        fields: &mut BTreeMap<String, Field>,
    ) {
        let is_field = |column: &&Column| !column.name.starts_with("KRATOS_") && column.name != "PROPERTIES_ID";
        let find = |columns: &[Column], like: &Column| {
            columns.iter().position(|column| column.name == like.name && column.components == like.components)
        };
        for column in other.iter().filter(is_field).filter(|column| find(own, column).is_none()) {
            self.differs(format!("{} is only in the second", column.name));
        }
        for column in own.iter().filter(is_field) {
            let Some(same) = find(other, column) else {
                self.differs(format!("{} is only in the first", column.name));
                continue;
            };
            let field = fields.entry(column.name.clone()).or_default();
            for (at, &there) in places.iter().enumerate() {
                for component in 0..column.components {
                    let x = column.values.get(at * column.components + component);
                    let y = other[same].values.get(there * column.components + component);
                    self.numbers += 1;
                    let size = x.abs().max(y.abs());
                    field.largest = if size.is_nan() { field.largest } else { field.largest.max(size) };
                    let difference = if x.is_nan() && y.is_nan() || x == y { 0.0 } else { (x - y).abs() };
                    let difference = if difference.is_nan() { f64::INFINITY } else { difference };
                    if difference > field.difference {
                        let which = if column.components > 1 {
                            format!("component {}, ", component + 1)
                        } else {
                            String::new()
                        };
                        (field.difference, field.place) = (difference, format!("{which}{}", place(at)));
                    }
                }
            }
        }
    }

    fn judge(&mut self, name: &str, fields: BTreeMap<String, Field>) {
        for (field, Field { largest, difference, place }) in fields {
            let relative = if difference == 0.0 { 0.0 } else { difference / largest };
            let is_equal = difference <= self.absolute || relative <= self.tolerance;
            let mark = if is_equal { ' ' } else { '*' };
            let place = if difference > 0.0 { format!(" at {place}") } else { String::new() };
            let line =
                format!("{mark} {name} {field}: largest difference {difference:.3e}, relative {relative:.3e}{place}");
            if is_equal { self.notes.push(line) } else { self.differs(line) }
        }
    }
}
