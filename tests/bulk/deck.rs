//! Decks of one body on a [`Grid`], written to a scratch folder and run.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};
use zelus::{RunOptions, RunReport, Silent, Simulation};
use zelus_core::geometry::Shape;

use super::grid::{Grid, Vec3};
use super::thread_ranks::on_threads;

/// A deck under construction.
pub struct Deck<'a> {
    grid: &'a Grid,
    dim: usize,
    element: String,
    solver: Value,
    end_time: f64,
    material: Value,
    parts: Vec<(String, Vec<usize>)>,
    elements: Vec<(String, Vec<usize>)>,
    outputs: Vec<String>,
    conditions: Vec<(String, String, Vec<Vec<usize>>)>,
    processes: Vec<Value>,
    gauss: Vec<String>,
    /// Heat beside the structure: its conductivity, and how both are coupled.
    heat: Option<(f64, String)>,
}

/// Outcome of a run.
pub struct Ran {
    json: Value,
    /// Report of the run.
    pub report: RunReport,
}

impl<'a> Deck<'a> {
    /// A static, nonlinear deck of elements whose names begin with `element`, with a law and its properties.
    pub fn new(grid: &'a Grid, element: &str, law: &str, variables: Value) -> Self {
        let dim = grid.shape.dim();
        let solver = json!({
            "solver_type": "Static", "model_part_name": "Structure", "domain_size": dim, "echo_level": 0,
            "analysis_type": "non_linear",
            "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
            "material_import_settings": {"materials_filename": "materials.json"},
            "time_stepping": {"time_step": 1.0}, "convergence_criterion": "residual_criterion",
            "residual_relative_tolerance": 1e-10, "residual_absolute_tolerance": 1e-12, "max_iteration": 20
        });
        let material = json!({"properties": [{"model_part_name": "Structure", "properties_id": 1,
            "Material": {"constitutive_law": {"name": law}, "Variables": variables, "Tables": {}}}]});
        Self {
            grid,
            dim,
            element: format!("{element}{}", grid.shape.cell().suffix(dim)),
            solver,
            end_time: 1.0,
            material,
            parts: Vec::new(),
            elements: Vec::new(),
            outputs: vec!["DISPLACEMENT".to_owned(), "REACTION".to_owned()],
            conditions: Vec::new(),
            processes: Vec::new(),
            gauss: Vec::new(),
            heat: None,
        }
    }

    /// Steady heat of a conductivity in a part `Heat` beside the structure, coupled by a strategy.
    pub fn with_heat(&mut self, conductivity: f64, strategy: &str) -> &mut Self {
        self.heat = Some((conductivity, strategy.to_owned()));
        self
    }

    /// Sets a key of the solver.
    pub fn set(&mut self, key: &str, value: Value) -> &mut Self {
        self.solver[key] = value;
        self
    }

    /// Steps of length `step` up to `end`.
    pub fn steps(&mut self, step: f64, end: f64) -> &mut Self {
        self.end_time = end;
        self.set("time_stepping", json!({"time_step": step}))
    }

    /// Asks for a quantity at Gauss points.
    pub fn gauss(&mut self, name: &str) -> &mut Self {
        self.gauss.push(name.to_owned());
        self
    }

    fn part(&mut self, nodes: Vec<usize>) -> String {
        assert!(!nodes.is_empty(), "a part without nodes");
        let name = format!("Part{}", self.parts.len());
        self.parts.push((name.clone(), nodes));
        name
    }

    /// Prescribes components of DISPLACEMENT, `null` leaving one free; numbers or expressions of x, y, z, t.
    pub fn fix(&mut self, wanted: impl Fn(Vec3) -> bool, value: [Value; 3]) -> &mut Self {
        let constrained: Vec<bool> = value.iter().map(|v| !v.is_null()).collect();
        self.assign(wanted, "DISPLACEMENT", &constrained, value)
    }

    /// Sets a nodal vector without constraining it.
    pub fn nodal(&mut self, variable: &str, value: [Value; 3]) -> &mut Self {
        self.assign(|_| true, variable, &[false; 3], value)
    }

    fn assign(
        &mut self,
        wanted: impl Fn(Vec3) -> bool,
        variable: &str,
        constrained: &[bool],
        value: [Value; 3],
    ) -> &mut Self {
        let part = self.part(self.grid.nodes_where(wanted));
        self.process(
            "assign_vector_variable_process",
            json!({
            "model_part_name": format!("Structure.{part}"), "variable_name": variable, "constrained": constrained,
            "value": value, "interval": [0.0, "End"]}),
        )
    }

    /// Adds a process.
    pub fn process(&mut self, module: &str, parameters: Value) -> &mut Self {
        self.processes.push(json!({
            "python_module": module, "kratos_module": "KratosMultiphysics", "Parameters": parameters}));
        self
    }

    /// The processes so far.
    pub fn processes_mut(&mut self) -> &mut [Value] {
        &mut self.processes
    }

    /// Parameters of the process that was added last.
    pub fn last_process(&mut self) -> &mut Value {
        &mut self.processes.last_mut().expect("a process")["Parameters"]
    }

    /// A part with nodes alone; its name below the root part.
    pub fn nodes(&mut self, wanted: impl Fn(Vec3) -> bool) -> String {
        self.part(self.grid.nodes_where(wanted))
    }

    /// A part with the elements all of whose nodes are wanted; its name below the root part.
    pub fn cells(&mut self, wanted: impl Fn(Vec3) -> bool) -> String {
        let is_wanted = |nodes: &[usize]| nodes.iter().all(|&node| wanted(self.grid.reference[node]));
        let cells: Vec<usize> = (0..self.grid.cells.len()).filter(|&at| is_wanted(&self.grid.cells[at])).collect();
        let mut nodes: Vec<usize> = cells.iter().flat_map(|&at| self.grid.cells[at].clone()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let name = self.part(nodes);
        self.elements.push((name.clone(), cells));
        name
    }

    /// Asks for further vectors at the nodes.
    pub fn output(&mut self, names: &[&str]) -> &mut Self {
        self.outputs.extend(names.iter().map(|&name| name.to_owned()));
        self
    }

    /// Puts conditions of a kind on facets and gives them a scalar.
    pub fn scalar_load(
        &mut self,
        wanted: impl Fn(Vec3) -> bool,
        kind: &str,
        variable: &str,
        value: Value,
    ) -> &mut Self {
        let part = self.facets(wanted, kind);
        self.process(
            "assign_scalar_variable_to_conditions_process",
            json!({
            "model_part_name": format!("Structure.{part}"), "variable_name": variable, "value": value,
            "interval": [0.0, "End"]}),
        )
    }

    /// Puts conditions of a kind on facets and gives them a vector.
    pub fn vector_load(
        &mut self,
        wanted: impl Fn(Vec3) -> bool,
        kind: &str,
        variable: &str,
        value: [Value; 3],
    ) -> &mut Self {
        let part = self.facets(wanted, kind);
        self.process(
            "assign_vector_variable_to_conditions_process",
            json!({
            "model_part_name": format!("Structure.{part}"), "variable_name": variable, "value": value,
            "interval": [0.0, "End"]}),
        )
    }

    /// Puts conditions of a kind on facets; the path of their part.
    pub fn facets(&mut self, wanted: impl Fn(Vec3) -> bool, kind: &str) -> String {
        self.conditions_on(self.grid.facets_where(wanted), kind)
    }

    /// As [`Deck::facets`], on one of the two sides of facets within the body: that of the first element.
    pub fn facets_once(&mut self, wanted: impl Fn(Vec3) -> bool, kind: &str) -> String {
        let mut known = std::collections::BTreeSet::new();
        let mut facets = self.grid.facets_where(wanted);
        facets.retain(|(_, nodes)| {
            let mut sorted = nodes.clone();
            sorted.sort_unstable();
            known.insert(sorted)
        });
        self.conditions_on(facets, kind)
    }

    /// Puts a condition of a kind on a node; the path of its part.
    pub fn point(&mut self, node: usize, kind: &str) -> String {
        self.conditions_on(vec![(Shape::Point1, vec![node])], kind)
    }

    fn conditions_on(&mut self, facets: Vec<(Shape, Vec<usize>)>, kind: &str) -> String {
        let shape: Shape = facets.first().expect("a facet").0;
        let name = format!("{kind}{}", shape.cell().suffix(self.dim));
        let nodes: Vec<Vec<usize>> = facets.into_iter().map(|(_, nodes)| nodes).collect();
        let mut all: Vec<usize> = nodes.concat();
        all.sort_unstable();
        all.dedup();
        let part = self.part(all);
        self.conditions.push((part.clone(), name, nodes));
        part
    }

    fn mesh(&self) -> String {
        let mut out = String::from("Begin Properties 0\nEnd Properties\nBegin Nodes\n");
        for (node, x) in self.grid.nodes.iter().enumerate() {
            let _ = writeln!(out, "{} {:?} {:?} {:?}", node + 1, x[0], x[1], x[2]);
        }
        let _ = writeln!(out, "End Nodes\nBegin Elements {}", self.element);
        let ids = |nodes: &[usize]| nodes.iter().map(|n| (n + 1).to_string()).collect::<Vec<_>>().join(" ");
        for (at, nodes) in self.grid.cells.iter().enumerate() {
            let _ = writeln!(out, "{} 0 {}", at + 1, ids(nodes));
        }
        out.push_str("End Elements\n");
        let mut next = 1;
        let mut members = Vec::new();
        for (part, name, facets) in &self.conditions {
            let _ = writeln!(out, "Begin Conditions {name}");
            for nodes in facets {
                let _ = writeln!(out, "{next} 0 {}", ids(nodes));
                members.push((part, next));
                next += 1;
            }
            out.push_str("End Conditions\n");
        }
        for (name, nodes) in &self.parts {
            let _ = write!(
                out,
                "Begin SubModelPart {name}\nBegin SubModelPartNodes\n{}\nEnd SubModelPartNodes\n",
                ids(nodes).replace(' ', "\n")
            );
            if let Some((_, cells)) = self.elements.iter().find(|(part, _)| part == name) {
                let _ = writeln!(out, "Begin SubModelPartElements\n{}", ids(cells).replace(' ', "\n"));
                out.push_str("End SubModelPartElements\n");
            }
            out.push_str("Begin SubModelPartConditions\n");
            members.iter().filter(|(part, _)| *part == name).for_each(|(_, id)| {
                let _ = writeln!(out, "{id}");
            });
            out.push_str("End SubModelPartConditions\nEnd SubModelPart\n");
        }
        out
    }

    /// Runs the deck; fails the test when it does not run through.
    pub fn run(&self) -> Ran {
        let (result, ran) = self.attempt();
        if let Err(problem) = result {
            panic!("{}: {problem}", self.element);
        }
        ran
    }

    /// Runs the deck; returns the result, and the files on disk.
    pub fn attempt(&self) -> (zelus_core::Result<()>, Ran) {
        let folder = self.write();
        let path = folder.path().join("ProjectParameters.json");
        let mut simulation = Simulation::open(&path, &RunOptions::default()).expect("a deck");
        let result = simulation.run(&mut Silent);
        let ran = self.ran(folder.path(), simulation.into_report(), &result);
        (result, ran)
    }

    fn ran(&self, folder: &Path, report: RunReport, result: &zelus_core::Result<()>) -> Ran {
        let text = std::fs::read_to_string(folder.join("results.json"));
        let text = text.unwrap_or_else(|_| panic!("{}: no results: {result:?}", self.element));
        Ran { json: serde_json::from_str(&text).expect("JSON"), report }
    }

    /// As [`Deck::run`], on so many ranks, which are threads.
    pub fn run_on_ranks(&self, count: usize) -> Ran {
        let folder = self.write();
        let path = folder.path().join("ProjectParameters.json");
        let reports = on_threads(count, |ranks| {
            let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
            let mut simulation = Simulation::open(&path, &options).expect("a deck");
            simulation.run(&mut Silent).expect("a run");
            simulation.into_report()
        });
        self.ran(folder.path(), reports.into_iter().next().expect("a rank"), &Ok(()))
    }

    /// Problem of a deck that must not pass its check.
    pub fn problem(&self) -> String {
        let folder = self.write();
        let path = folder.path().join("ProjectParameters.json");
        let checked = Simulation::open(&path, &RunOptions::default()).and_then(|mut run| run.check(&mut Silent));
        checked.expect_err("a problem").to_string()
    }

    /// The files of the deck.
    pub fn write(&self) -> tempfile::TempDir {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let mut processes = self.processes.clone();
        processes.push(json!({
            "python_module": "json_output_process", "kratos_module": "KratosMultiphysics", "Parameters": {
                "output_file_name": "results.json", "model_part_name": "Structure", "time_frequency": 0.0,
                "output_variables": self.outputs, "gauss_points_output_variables": self.gauss}}));
        let mut deck = json!({
            "problem_data": {"problem_name": "bulk", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                "end_time": self.end_time},
            "solver_settings": self.solver,
            "processes": {"list": processes}});
        let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).expect("a file");
        if let Some((conductivity, strategy)) = &self.heat {
            let solver = deck["solver_settings"].take();
            deck["solver_settings"] = json!({"solver_type": "ThermoMechanicallyCoupled", "domain_size": self.dim,
                "coupling_settings": {"strategy": strategy}, "structural_solver_settings": solver,
                "thermal_solver_settings": {"solver_type": "stationary", "stores_heat": false, "model_part_name": "Heat",
                    "domain_size": self.dim, "model_import_settings": {"input_type": "use_input_model_part"},
                    "material_import_settings": {"materials_filename": "heat.json"},
                    "time_stepping": self.solver["time_stepping"].clone()}});
            let variables = json!({"CONDUCTIVITY": conductivity, "DENSITY": 1.0, "SPECIFIC_HEAT": 1.0});
            let heat = json!({"properties": [{"model_part_name": "Heat", "properties_id": 1,
                "Material": {"Variables": variables, "Tables": {}}}]});
            write("heat.json", heat.to_string());
        }
        write("ProjectParameters.json", deck.to_string());
        write("materials.json", self.material.to_string());
        write("mesh.mdpa", self.mesh());
        folder
    }
}

impl Ran {
    /// A number of the report of a step (from 0) by name.
    pub fn number(&self, name: &str, step: usize) -> f64 {
        let numbers = &self.report.steps[step].interactions;
        let found = numbers.iter().find(|(known, _)| known == name);
        found.unwrap_or_else(|| panic!("no {name:?} among {numbers:?}")).1
    }

    /// A number of the report of the last step by name.
    pub fn last_number(&self, name: &str) -> f64 {
        self.number(name, self.report.steps.len() - 1)
    }

    /// Times that were written.
    pub fn times(&self) -> Vec<f64> {
        self.json["TIME"].as_array().expect("TIME").iter().filter_map(Value::as_f64).collect()
    }

    /// A vector at a node (from 0) at a step (from 0).
    pub fn vector(&self, name: &str, node: usize, step: usize) -> Vec3 {
        let series = &self.json[format!("NODE_{}", node + 1)];
        ["X", "Y", "Z"].map(|axis| series[format!("{name}_{axis}")][step].as_f64().expect("a number"))
    }

    /// A scalar at a node (from 0) at the end.
    pub fn scalar(&self, name: &str, node: usize) -> f64 {
        let series = self.json[format!("NODE_{}", node + 1)][name].as_array().expect("a series");
        series.last().and_then(Value::as_f64).expect("a number")
    }

    /// A vector at a node (from 0) at the end.
    pub fn last(&self, name: &str, node: usize) -> Vec3 {
        self.vector(name, node, self.times().len() - 1)
    }

    /// DISPLACEMENT of all nodes at the end.
    pub fn displacements(&self, grid: &Grid) -> Vec<Vec3> {
        (0..grid.nodes.len()).map(|node| self.last("DISPLACEMENT", node)).collect()
    }

    /// Sum of the reactions of some nodes at a step.
    pub fn reaction(&self, nodes: &[usize], step: usize) -> Vec3 {
        nodes.iter().fold([0.0; 3], |sum, &node| {
            let r = self.vector("REACTION", node, step);
            std::array::from_fn(|a| sum[a] + r[a])
        })
    }

    /// Values at all Gauss points at a step: element (from 0) and components.
    pub fn gauss(&self, name: &str, step: usize) -> Vec<(usize, Vec<f64>)> {
        let mut out = Vec::new();
        for element in 0.. {
            let Some(points) = self.json[format!("ELEMENT_{}", element + 1)][name].as_object() else { break };
            for series in points.values() {
                let value = &series[step];
                let values = match value.as_array() {
                    Some(list) => list.iter().filter_map(Value::as_f64).collect(),
                    None => value.as_f64().into_iter().collect(),
                };
                out.push((element, values));
            }
        }
        assert!(!out.is_empty(), "no {name}");
        out
    }
}

/// Whether two numbers agree relative to the second.
pub fn assert_close(found: f64, expected: f64, relative: f64, what: &str) {
    let error = (found - expected).abs() / expected.abs();
    assert!(error <= relative, "{what}: {found} instead of {expected}, off by {error:.2e}, allowed {relative:.0e}");
}
