//! A slab along x with parts of its ends, its body and its faces, and decks of heat on it.

use serde_json::{Value, json};
use std::path::Path;

use crate::support::{Results, read_json, said, zelus};

/// A slab of cells from x = 0 to 1, `rows` of them high.
#[derive(Clone, Copy)]
pub struct Slab {
    pub cells: usize,
    pub rows: usize,
    pub height: f64,
    pub triangles: bool,
    /// Angle that the whole slab is turned by.
    pub angle: f64,
    /// Whether nodes and elements are numbered from the last to the first.
    pub reversed: bool,
    /// Name of the elements without their shape.
    pub element: &'static str,
}

impl Slab {
    pub fn new(cells: usize) -> Self {
        Self { cells, rows: 1, height: 0.1, triangles: false, angle: 0.0, reversed: false, element: "Element" }
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        (self.cells + 1) * (self.rows + 1)
    }

    /// Id of the node in a column and row.
    pub fn node(&self, column: usize, row: usize) -> usize {
        let id = column * (self.rows + 1) + row + 1;
        if self.reversed { self.nodes() + 1 - id } else { id }
    }

    fn mesh(&self) -> String {
        let mut text =
            String::from("Begin Properties 1\nEnd Properties\nBegin Properties 2\nEnd Properties\nBegin Nodes\n");
        let (s, c) = self.angle.sin_cos();
        for column in 0..=self.cells {
            for row in 0..=self.rows {
                let (x, y) = (column as f64 / self.cells as f64, self.height * row as f64 / self.rows as f64);
                text += &format!("{} {:?} {:?} 0.0\n", self.node(column, row), c * x - s * y, s * x + c * y);
            }
        }
        let (mut elements, mut near, mut far, mut middle) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for column in 0..self.cells {
            for row in 0..self.rows {
                let [a, b, c, d] = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| self.node(column + i, row + j));
                let half = if 2 * column < self.cells { &mut near } else { &mut far };
                let pieces = if self.triangles { vec![vec![a, b, c], vec![a, c, d]] } else { vec![vec![a, b, c, d]] };
                for piece in pieces {
                    half.push(elements.len() + 1);
                    middle.extend((column == self.cells / 2).then_some(elements.len() + 1));
                    elements.push(piece);
                }
            }
        }
        if self.reversed {
            let last = elements.len() + 1;
            elements.reverse();
            near.iter_mut().chain(&mut far).chain(&mut middle).for_each(|id| *id = last - *id);
        }
        text += &format!("End Nodes\nBegin Elements {}2D{}N\n", self.element, if self.triangles { 3 } else { 4 });
        for (at, nodes) in elements.iter().enumerate() {
            text += &format!("{} 1 {}\n", at + 1, words(nodes));
        }
        text += "End Elements\nBegin Conditions LineCondition2D2N\n";
        for row in 0..self.rows {
            text += &format!("{} 2 {} {}\n", row + 1, self.node(self.cells, row), self.node(self.cells, row + 1));
        }
        text += "End Conditions\n";
        let column = |at: usize| (0..=self.rows).map(|row| self.node(at, row)).collect::<Vec<_>>();
        let columns = |from: usize, to: usize| (from..=to).flat_map(column).collect::<Vec<_>>();
        let all: Vec<usize> = (1..=elements.len()).collect();
        let faces: Vec<usize> = (1..=self.rows).collect();
        text += &part("Body", &columns(0, self.cells), &all, &[]);
        text += &part("Near", &columns(0, self.cells.div_ceil(2)), &near, &[]);
        text += &part("Far", &columns(self.cells.div_ceil(2), self.cells), &far, &[]);
        text += &part("Middle", &columns(self.cells / 2, self.cells / 2 + 1), &middle, &[]);
        text += &part("Left", &column(0), &[], &[]);
        text += &part("Foot", &(0..=self.cells).map(|column| self.node(column, 0)).collect::<Vec<_>>(), &[], &[]);
        text += &part("Right", &column(self.cells), &[], &faces);
        text
    }
}

fn words(ids: &[usize]) -> String {
    ids.iter().map(usize::to_string).collect::<Vec<_>>().join(" ")
}

fn part(name: &str, nodes: &[usize], elements: &[usize], conditions: &[usize]) -> String {
    let mut text = format!("Begin SubModelPart {name}\n");
    for (word, ids) in [("Nodes", nodes), ("Elements", elements), ("Conditions", conditions)] {
        let lines: String = ids.iter().map(|id| format!("{id}\n")).collect();
        text += &format!("Begin SubModelPart{word}\n{lines}End SubModelPart{word}\n");
    }
    text + "End SubModelPart\n"
}

/// Solver, materials and processes of a run.
pub struct Deck {
    pub solver: Value,
    pub materials: Vec<Value>,
    pub processes: Vec<Value>,
    pub end: f64,
}

impl Deck {
    /// With one material, ρ = c = 1.
    pub fn new(solver_type: &str, step: f64, end: f64, conductivity: f64) -> Self {
        let solver = json!({"solver_type": solver_type, "model_part_name": "Heat", "domain_size": 2, "echo_level": 0,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "slab"},
            "material_import_settings": {"materials_filename": "materials.json"}, "time_stepping": {"time_step": step}});
        Self { solver, materials: vec![material("Body", 1, conductivity)], processes: Vec::new(), end }
    }

    pub fn set(mut self, key: &str, value: Value) -> Self {
        self.solver[key] = value;
        self
    }

    /// Prescribes a variable on a part throughout; `fixed` or not.
    pub fn assign(mut self, part: &str, variable: &str, value: Value, fixed: bool) -> Self {
        self.processes.push(assign(part, variable, value, fixed, json!([0.0, "End"])));
        self
    }

    /// The temperatures at the beginning.
    pub fn starts(mut self, value: Value) -> Self {
        self.processes.push(assign("Body", "TEMPERATURE", value, false, json!([0.0, 0.0])));
        self
    }

    pub fn process(mut self, name: &str, parameters: Value) -> Self {
        self.processes.push(json!({"python_module": name, "Parameters": parameters}));
        self
    }

    /// Writes the deck into a folder.
    pub fn write(&self, folder: &Path, slab: &Slab) {
        let mut variables = if self.solver["solver_type"] == "Static" {
            vec!["REACTION_X"]
        } else {
            vec!["TEMPERATURE", "REACTION_FLUX"]
        };
        variables.extend((slab.element != "Element").then_some("DISPLACEMENT_Y"));
        let output = json!({"python_module": "json_output_process", "Parameters": {"model_part_name": "Heat",
            "output_file_name": "results.json", "output_variables": variables, "time_frequency": 0.0}});
        let mut processes = self.processes.clone();
        processes.push(output);
        let deck = json!({"problem_data": {"problem_name": "slab", "parallel_type": "OpenMP", "echo_level": 0,
            "start_time": 0.0, "end_time": self.end}, "solver_settings": self.solver, "processes": {"list": processes}});
        let files = [("slab.mdpa", slab.mesh()), ("materials.json", json!({"properties": self.materials}).to_string())];
        for (name, text) in files.into_iter().chain([("ProjectParameters.json", deck.to_string())]) {
            std::fs::write(folder.join(name), text).expect("a file");
        }
    }

    /// Runs it and reads its results.
    pub fn run(&self, slab: &Slab) -> Results {
        self.run_with(slab, &["run", "ProjectParameters.json"])
    }

    /// As [`Deck::run`], with the report.
    pub fn run_and_report(&self, slab: &Slab) -> (Results, Value) {
        let scratch = tempfile::tempdir().expect("a scratch folder");
        self.write(scratch.path(), slab);
        let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--report", "report.json"]);
        assert!(output.status.success(), "{}", said(&output));
        let results = Results::read(&scratch.path().join("results.json")).expect("results");
        (results, read_json(&scratch.path().join("report.json")).expect("a report"))
    }

    /// As [`Deck::run`], with these arguments.
    pub fn run_with(&self, slab: &Slab, arguments: &[&str]) -> Results {
        let scratch = tempfile::tempdir().expect("a scratch folder");
        self.write(scratch.path(), slab);
        let output = zelus(scratch.path(), arguments);
        assert!(output.status.success(), "{}", said(&output));
        Results::read(&scratch.path().join("results.json")).expect("results")
    }
}

fn assign(part: &str, variable: &str, value: Value, fixed: bool, interval: Value) -> Value {
    json!({"python_module": "assign_scalar_variable_process", "Parameters": {"model_part_name": format!("Heat.{part}"),
        "variable_name": variable, "value": value, "constrained": fixed, "interval": interval}})
}

pub fn material(part: &str, id: usize, conductivity: f64) -> Value {
    json!({"model_part_name": format!("Heat.{part}"), "properties_id": id, "Material": {
        "Variables": {"DENSITY": 1.0, "SPECIFIC_HEAT": 1.0, "CONDUCTIVITY": conductivity}, "Tables": {}}})
}
