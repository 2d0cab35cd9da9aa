//! Decks of bodies in contact as a new user writes them: no variant is named, tolerances are the defaults.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};
use zelus_core::geometry::Shape;

use crate::grid::{Grid, Vec3};
use crate::outcome::Outcome;
use crate::support::{said, zelus};

const CONTACT: &str = "KratosMultiphysics.ContactStructuralMechanicsApplication";

/// Facets of one side of a body; nodes count from 0 over the whole mesh.
pub type Facets = Vec<Vec<usize>>;

/// A body of the mesh.
pub struct Body {
    reference: Vec<Vec3>,
    of_grid: Vec<usize>,
    facets: Grid,
}

impl Body {
    /// Nodes whose place in the unit square or cube is wanted.
    pub fn nodes(&self, wanted: impl Fn(Vec3) -> bool) -> Vec<usize> {
        let mut found: Vec<usize> =
            (0..self.reference.len()).filter(|&n| wanted(self.reference[n])).map(|n| self.of_grid[n]).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Facets all of whose nodes are wanted.
    pub fn facets(&self, wanted: impl Fn(Vec3) -> bool) -> Facets {
        let found = self.facets.facets_where(wanted).into_iter();
        found.map(|(_, nodes)| nodes.into_iter().map(|n| self.of_grid[n]).collect()).collect()
    }
}

/// Sides of the unit square or cube.
pub fn low(axis: usize) -> impl Fn(Vec3) -> bool {
    move |x| x[axis] < 1e-9
}

/// See [`low`].
pub fn high(axis: usize) -> impl Fn(Vec3) -> bool {
    move |x| x[axis] > 1.0 - 1e-9
}

/// Variant of a problem: position, size, numbering, formulation; its solution does not change with it.
#[derive(Clone, Copy)]
pub struct Look {
    /// Angle by which everything is turned.
    pub turn: f64,
    /// The axis about which it is; a unit vector.
    pub about: Vec3,
    /// Factor of lengths.
    pub size: f64,
    /// Whether nodes and elements are numbered backwards.
    pub backwards: bool,
    /// Whether contact is by penalty, in the place of multipliers.
    pub penalty: bool,
}

/// As it is.
pub const PLAIN: Look = Look { turn: 0.0, about: [0.0, 0.0, 1.0], size: 1.0, backwards: false, penalty: false };

impl Look {
    /// Rows of the rotation (Rodrigues); round-off of zero is set to zero.
    fn rows(&self) -> [Vec3; 3] {
        let ([x, y, z], (s, c)) = (self.about, self.turn.sin_cos());
        let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let unit = f64::from(u8::from(i == j));
                let entry = c * unit + s * cross[i][j] + (1.0 - c) * self.about[i] * self.about[j];
                if (entry - entry.round()).abs() < 1e-12 { entry.round() } else { entry }
            })
        })
    }

    /// A vector turned.
    pub fn turned(&self, v: Vec3) -> Vec3 {
        self.rows().map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }

    /// A vector turned back.
    pub fn back(&self, v: Vec3) -> Vec3 {
        Self { turn: -self.turn, ..*self }.turned(v)
    }

    /// The number of a node or element in the files, of so many.
    pub fn id(&self, at: usize, count: usize) -> usize {
        if self.backwards { count - at } else { at + 1 }
    }

    /// Components of a displacement in terms of X, Y and t, turned. A quarter turn takes free components along, others none.
    fn value(&self, value: &[Value; 3]) -> [Value; 3] {
        let rows = self.rows();
        let place = |axis: usize| {
            let terms = ["U", "V", "W"].into_iter().zip(&rows).filter(|(_, row)| row[axis] != 0.0);
            let terms: Vec<String> = terms.map(|(name, row)| format!("({:?})*{name}", row[axis] / self.size)).collect();
            format!("({})", terms.join("+"))
        };
        let text = |v: &Value| {
            let text = v.as_str().map_or_else(|| v.to_string(), str::to_owned);
            let text = text.replace('X', &place(0)).replace('Y', &place(1));
            text.replace('U', "X").replace('V', "Y").replace('W', "Z")
        };
        rows.map(|row| {
            let terms: Vec<(f64, &Value)> = row.into_iter().zip(value).filter(|(factor, _)| *factor != 0.0).collect();
            assert!(
                terms.len() == 1 || terms.iter().all(|(_, v)| !v.is_null()),
                "free components turn by right angles only"
            );
            match terms.iter().any(|(_, v)| v.is_null()) {
                true => Value::Null,
                false => {
                    let terms: Vec<String> =
                        terms.iter().map(|(factor, v)| format!("({:?})*({})", factor * self.size, text(v))).collect();
                    json!(terms.join("+"))
                }
            }
        })
    }
}

/// A deck under construction.
pub struct Model {
    pub dim: usize,
    /// Positions.
    pub nodes: Vec<Vec3>,
    /// Facets of slave and master, one pair of lists an interface.
    pub pairs: Vec<[Facets; 2]>,
    /// Nodes with prescribed displacements.
    pub supported: Vec<usize>,
    /// Coefficient of friction, `None` for frictionless contact.
    pub friction: Option<f64>,
    /// Steps over the time from 0 to 1.
    pub steps: usize,
    /// How the deck shows the problem.
    pub look: Look,
    /// Whether bodies are of triangles or tetrahedra.
    pub simplices: bool,
    elements: Vec<(String, Vec<usize>)>,
    bodies: Vec<(Vec<usize>, Vec<usize>, [f64; 2])>,
    constraints: Vec<(Vec<usize>, [Value; 3])>,
    loads: Vec<(Facets, Vec3, String)>,
}

impl Model {
    /// An empty mesh.
    pub fn new(dim: usize, friction: Option<f64>, steps: usize) -> Self {
        Self {
            dim,
            nodes: Vec::new(),
            pairs: Vec::new(),
            supported: Vec::new(),
            friction,
            steps,
            look: PLAIN,
            simplices: false,
            elements: Vec::new(),
            bodies: Vec::new(),
            constraints: Vec::new(),
            loads: Vec::new(),
        }
    }

    /// The largest Young's modulus of the bodies.
    pub fn largest_young(&self) -> f64 {
        self.bodies.iter().map(|(_, _, [young, _])| *young).fold(0.0, f64::max)
    }

    /// A body of quadrilaterals or hexahedra, or of simplices, mapped from the unit square or cube; sides that meet are joined.
    pub fn body(&mut self, divisions: &[usize], young: f64, poisson: f64, map: impl Fn(Vec3) -> Vec3) -> Body {
        let corners = if self.simplices { self.dim + 1 } else { 1 << self.dim };
        let shape = Shape::of(self.dim, corners).expect("a shape");
        let grid = Grid::new(shape, divisions, map);
        let size = grid.nodes.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        let mut known: BTreeMap<[i64; 3], usize> = BTreeMap::new();
        let of_grid: Vec<usize> = grid
            .nodes
            .iter()
            .map(|x| {
                let key = x.map(|x| (x / size * 1e8).round() as i64);
                *known.entry(key).or_insert_with(|| {
                    self.nodes.push(*x);
                    self.nodes.len() - 1
                })
            })
            .collect();
        let first = self.elements.len();
        let name = format!("TotalLagrangianElement{}D{}N", self.dim, shape.cell().corners());
        for cell in &grid.cells {
            self.elements.push((name.clone(), cell.iter().map(|&n| of_grid[n]).collect()));
        }
        let own: Vec<usize> = known.into_values().collect();
        self.bodies.push((own, (first..self.elements.len()).collect(), [young, poisson]));
        Body { reference: grid.reference.clone(), of_grid, facets: grid }
    }

    /// Prescribes components of the displacement: numbers or expressions of t, `null` leaves one free.
    pub fn fix(&mut self, nodes: &[usize], value: [Value; 3]) {
        self.supported.extend(nodes);
        self.constraints.push((nodes.to_vec(), value));
    }

    /// A traction on facets, times a function of t.
    pub fn load(&mut self, facets: Facets, traction: Vec3, of_time: &str) {
        self.loads.push((facets, traction, of_time.to_owned()));
    }

    /// Two sides that may touch.
    pub fn contact(&mut self, slave: Facets, master: Facets) {
        self.pairs.push([slave, master]);
    }

    /// Writes the deck into a folder.
    pub fn write(&self, folder: &Path) {
        let mut parts = Parts::default();
        let line = if self.dim == 2 { "Line" } else { "Surface" };
        let (mut processes, mut loads, mut contact, mut materials) =
            (Vec::new(), Vec::new(), [json!({}), json!({})], Vec::new());
        let mut of_bodies: Vec<Vec<usize>> = vec![Vec::new(); self.bodies.len()];
        for (number, [slave, master]) in self.pairs.iter().enumerate() {
            let kind = format!("{line}Condition{}D", self.dim);
            let first = parts.conditions(&kind, slave);
            let second = parts.conditions(&kind, master);
            for (facets, ids) in [(slave, &first), (master, &second)] {
                let body = self.bodies.iter().position(|(nodes, ..)| nodes.contains(&facets[0][0])).expect("a body");
                of_bodies[body].extend(ids);
            }
            parts.part(&format!("Slave{number}"), &slave.concat(), &[], &first);
            let (nodes, ids) = ([slave.concat(), master.concat()].concat(), [first, second].concat());
            parts.part(&format!("Contact{number}"), &nodes, &[], &ids);
            contact[0][number.to_string()] = json!([format!("Contact{number}")]);
            contact[1][number.to_string()] = json!([format!("Slave{number}")]);
        }
        for (number, (nodes, elements, [young, poisson])) in self.bodies.iter().enumerate() {
            let name = format!("Body{number}");
            parts.part(&name, nodes, elements, &of_bodies[number]);
            let law = if self.dim == 2 { "KirchhoffSaintVenantPlaneStrain2DLaw" } else { "KirchhoffSaintVenant3DLaw" };
            materials.push(json!({"model_part_name": format!("Structure.{name}"), "properties_id": number + 1,
                "Material": {"constitutive_law": {"name": law},
                    "Variables": {"YOUNG_MODULUS": young, "POISSON_RATIO": poisson}, "Tables": {}}}));
        }
        for (number, (nodes, value)) in self.constraints.iter().enumerate() {
            let name = format!("Support{number}");
            parts.part(&name, nodes, &[], &[]);
            let value = self.look.value(value);
            let constrained: Vec<bool> = value.iter().map(|v| !v.is_null()).collect();
            processes.push(process(
                "assign_vector_variable_process",
                json!({"model_part_name": format!("Structure.{name}"), "variable_name": "DISPLACEMENT",
                    "constrained": constrained, "value": value, "interval": [0.0, "End"]}),
            ));
        }
        for (number, (facets, traction, of_time)) in self.loads.iter().enumerate() {
            let name = format!("Load{number}");
            let ids = parts.conditions(&format!("SmallDisplacement{line}LoadCondition{}D", self.dim), facets);
            parts.part(&name, &facets.concat(), &[], &ids);
            let size = traction.iter().map(|x| x * x).sum::<f64>().sqrt();
            loads.push(process(
                "assign_vector_by_direction_to_condition_process",
                json!({"model_part_name": format!("Structure.{name}"),
                    "variable_name": format!("{}_LOAD", line.to_uppercase()), "modulus": format!("{size:?}*({of_time})"),
                    "direction": self.look.turned(*traction), "interval": [0.0, "End"]}),
            ));
        }
        let kind = if self.friction.is_some() { "Frictional" } else { "Frictionless" };
        let (method, module) =
            if self.look.penalty { ("Penalty", "penalty_contact_process") } else { ("ALM", "alm_contact_process") };
        let formulation = format!("{method}Contact{kind}");
        let [contacts, slaves] = contact;
        let mut settings = json!({"model_part_name": "Structure", "contact_type": kind, "contact_model_part": contacts,
            "assume_master_slave": slaves});
        if let Some(friction) = self.friction {
            for number in 0..self.pairs.len() {
                settings["friction_coefficients"][number.to_string()] = json!(friction);
            }
        }
        let step = 1.0 / self.steps as f64;
        let multiplier = self.multiplier();
        let output = |file: &str, variables: &[&str], historical: bool| {
            process(
                "json_output_process",
                json!({"output_file_name": file, "model_part_name": "Structure", "time_frequency": 0.0,
                    "historical_value": historical, "output_variables": variables}),
            )
        };
        let mut variables = vec!["DISPLACEMENT", "REACTION", "NORMAL", "WEIGHTED_GAP", multiplier];
        variables.extend(self.friction.map(|_| "WEIGHTED_SLIP"));
        let deck = json!({
            "problem_data": {"problem_name": "everyday", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                "end_time": 1.0},
            "solver_settings": {
                "solver_type": "Static", "model_part_name": "Structure", "domain_size": self.dim,
                "analysis_type": "non_linear", "time_stepping": {"time_step": step},
                "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
                "material_import_settings": {"materials_filename": "materials.json"},
                "convergence_criterion": "contact_residual_criterion",
                "contact_settings": {"mortar_type": formulation}},
            "processes": {
                "constraints_process_list": processes,
                "loads_process_list": loads,
                "contact_process_list": [{"python_module": module, "kratos_module": CONTACT, "Parameters": settings}],
                "json_output_process_list": [output("results.json", &variables, true), output("areas.json", &["NODAL_AREA"], false)]}});
        let pretty = |value: &Value| serde_json::to_string_pretty(value).expect("JSON");
        let write = |name: &str, text: String| std::fs::write(folder.join(name), text).expect("a file");
        write("ProjectParameters.json", pretty(&deck));
        write("materials.json", pretty(&json!({"properties": materials})));
        write("mesh.mdpa", self.mesh(&parts));
    }

    /// The variable of the multiplier.
    pub fn multiplier(&self) -> &'static str {
        if self.friction.is_some() { "VECTOR_LAGRANGE_MULTIPLIER" } else { "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE" }
    }

    fn mesh(&self, parts: &Parts) -> String {
        let mut out = String::from("Begin Properties 0\nEnd Properties\nBegin Nodes\n");
        let count = self.nodes.len();
        for (node, x) in self.nodes.iter().enumerate() {
            let [x, y, z] = self.look.turned(*x).map(|x| x * self.look.size);
            let _ = writeln!(out, "{} {x:?} {y:?} {z:?}", self.look.id(node, count));
        }
        out.push_str("End Nodes\n");
        let ids = |list: &[usize], count: usize| {
            list.iter().map(|&at| self.look.id(at, count).to_string()).collect::<Vec<_>>().join(" ")
        };
        for (what, rows) in [("Elements", &self.elements), ("Conditions", &parts.conditions)] {
            let mut last = "";
            for (at, (name, nodes)) in rows.iter().enumerate() {
                if name != last {
                    let end = if last.is_empty() { String::new() } else { format!("End {what}\n") };
                    let _ = writeln!(out, "{end}Begin {what} {name}");
                    last = name;
                }
                let _ = writeln!(out, "{} 0 {}", self.look.id(at, rows.len()), ids(nodes, count));
            }
            let _ = writeln!(out, "End {what}");
        }
        let counts = [count, self.elements.len(), parts.conditions.len()];
        for (name, lists) in &parts.parts {
            let _ = writeln!(out, "Begin SubModelPart {name}");
            for ((kind, list), count) in ["Nodes", "Elements", "Conditions"].iter().zip(lists).zip(counts) {
                let ids = ids(list, count).replace(' ', "\n");
                let _ = writeln!(out, "Begin SubModelPart{kind}\n{ids}\nEnd SubModelPart{kind}");
            }
            out.push_str("End SubModelPart\n");
        }
        out
    }

    /// Runs the deck in a scratch folder. With `ZELUS_EVERYDAY=FOLDER` in the environment it is kept there under `name`.
    ///
    /// # Errors
    /// Outcome of the run, or the output of the program when it did not end with 0.
    pub fn run(&self, name: &str) -> Result<Outcome, String> {
        let scratch = tempfile::tempdir().expect("a scratch folder");
        let kept = std::env::var_os("ZELUS_EVERYDAY").map(|folder| Path::new(&folder).join(name));
        let folder = kept.as_deref().unwrap_or(scratch.path());
        std::fs::create_dir_all(folder).expect("a folder");
        self.write(folder);
        let output = zelus(folder, &["run", "ProjectParameters.json", "--report", "report.json", "--threads", "2"]);
        if !output.status.success() {
            let text = said(&output);
            let end: Vec<&str> = text.lines().rev().take(6).collect();
            let end: Vec<&str> = end.into_iter().rev().collect();
            return Err(format!("{name}: exit code {:?}\n{}", output.status.code(), end.join("\n")));
        }
        Outcome::read(self, folder)
    }
}

/// Parts and conditions of a mesh file; numbers from 0.
#[derive(Default)]
struct Parts {
    conditions: Vec<(String, Vec<usize>)>,
    parts: Vec<(String, [Vec<usize>; 3])>,
}

impl Parts {
    fn conditions(&mut self, kind: &str, facets: &Facets) -> Vec<usize> {
        let first = self.conditions.len();
        self.conditions.extend(facets.iter().map(|nodes| (format!("{kind}{}N", nodes.len()), nodes.clone())));
        (first..self.conditions.len()).collect()
    }

    fn part(&mut self, name: &str, nodes: &[usize], elements: &[usize], conditions: &[usize]) {
        let sorted = |list: &[usize]| {
            let mut list = list.to_vec();
            list.sort_unstable();
            list.dedup();
            list
        };
        self.parts.push((name.to_owned(), [sorted(nodes), sorted(elements), sorted(conditions)]));
    }
}

fn process(module: &str, parameters: Value) -> Value {
    json!({"python_module": module, "kratos_module": "KratosMultiphysics", "Parameters": parameters})
}
