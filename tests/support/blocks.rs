//! Decks of two structured blocks on each other, mapped to any shape, written from code.
#![allow(dead_code, reason = "each test binary uses its part")]

use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use zelus_core::geometry::{Shape, shape_functions};

/// A point or a displacement.
pub type Vec3 = [f64; 3];

/// A mesh of quadrilaterals or hexahedra, or of the simplices they are cut into, with its parts.
#[derive(Default)]
pub struct Mesh {
    /// Places of the nodes; node n is number n + 1.
    pub nodes: Vec<Vec3>,
    elements: Vec<Vec<usize>>,
    facets: Vec<Vec<usize>>,
    parts: BTreeMap<String, [Vec<usize>; 3]>,
    /// Dimensions, 2 or 3.
    pub space: usize,
    simplices: bool,
}

/// Nodes and facets of the sides of a block, by axis and end.
pub type Sides = BTreeMap<(usize, usize), (Vec<usize>, Vec<usize>)>;

impl Mesh {
    /// No block yet in this number of dimensions.
    pub fn new(space: usize) -> Self {
        Self { space, ..Self::default() }
    }

    /// The same, its cells cut into triangles or tetrahedra, its facets in space into triangles.
    pub fn of_simplices(space: usize) -> Self {
        Self { simplices: true, ..Self::new(space) }
    }

    /// Whether the cells of blocks to come are cut as those of [`Mesh::of_simplices`].
    pub fn cut_cells(&mut self, cut: bool) {
        self.simplices = cut;
    }

    /// A cell as it is, or cut along the diagonals that rise in all coordinates: cells side by side agree on them.
    fn cut(&self, cell: Vec<usize>) -> Vec<Vec<usize>> {
        let parts: &[&[usize]] = match cell.len() {
            4 => &[&[0, 1, 2], &[0, 2, 3]],
            8 => &[&[0, 1, 2, 6], &[0, 2, 3, 6], &[0, 3, 7, 6], &[0, 7, 4, 6], &[0, 4, 5, 6], &[0, 5, 1, 6]],
            _ => return vec![cell],
        };
        if !self.simplices {
            return vec![cell];
        }
        parts.iter().map(|part| part.iter().map(|&n| cell[n]).collect()).collect()
    }

    /// A grid over the unit cube, mapped; the facets of its sides become conditions.
    pub fn block(&mut self, name: &str, divisions: [usize; 3], place: impl Fn(Vec3) -> Vec3) -> Sides {
        let space = self.space;
        let counts: [usize; 3] = std::array::from_fn(|c| if c < space { divisions[c] + 1 } else { 1 });
        let base = self.nodes.len() + 1;
        let id = |at: [usize; 3]| base + at[0] + counts[0] * (at[1] + counts[1] * at[2]);
        let grid = |counts: [usize; 3]| {
            (0..counts[2]).flat_map(move |k| (0..counts[1]).flat_map(move |j| (0..counts[0]).map(move |i| [i, j, k])))
        };
        for at in grid(counts) {
            let x = std::array::from_fn(|c| if c < space { at[c] as f64 / divisions[c] as f64 } else { 0.0 });
            self.nodes.push(place(x));
        }
        let corners = |at: [usize; 3], axes: &[usize]| -> Vec<usize> {
            let steps: &[[usize; 3]] = match axes.len() {
                1 => &[[0, 0, 0], [1, 0, 0]],
                2 => &[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
                _ => &[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
            };
            let moved = |step: &[usize; 3]| {
                let mut to = at;
                axes.iter().zip(step).for_each(|(&axis, s)| to[axis] += s);
                id(to)
            };
            steps.iter().map(moved).collect()
        };
        let axes: Vec<usize> = (0..space).collect();
        let cells: [usize; 3] = std::array::from_fn(|c| if c < space { divisions[c] } else { 1 });
        let first = self.elements.len() + 1;
        let solids: Vec<Vec<usize>> = grid(cells).flat_map(|at| self.cut(corners(at, &axes))).collect();
        self.elements.extend(solids);
        let mut sides = Sides::new();
        let mut own = Vec::new();
        for axis in 0..space {
            let others: Vec<usize> = axes.iter().copied().filter(|&other| other != axis).collect();
            for end in 0..2 {
                let level = end * divisions[axis];
                let nodes = grid(counts).filter(|at| at[axis] == level).map(id).collect();
                let flat: [usize; 3] = std::array::from_fn(|c| if c == axis { 1 } else { cells[c] });
                let side: Vec<Vec<usize>> = grid(flat)
                    .flat_map(|mut at| {
                        at[axis] = level;
                        self.cut(corners(at, &others))
                    })
                    .collect();
                let first = self.facets.len() + 1;
                self.facets.extend(side);
                let facets: Vec<usize> = (first..=self.facets.len()).collect();
                own.extend(&facets);
                sides.insert((axis, end), (nodes, facets));
            }
        }
        let nodes = (base..base + counts.iter().product::<usize>()).collect();
        self.parts.insert(name.to_owned(), [nodes, (first..=self.elements.len()).collect(), own]);
        sides
    }

    /// A part with these nodes and conditions.
    pub fn part(&mut self, name: &str, nodes: impl IntoIterator<Item = usize>, conditions: Vec<usize>) {
        let mut nodes: Vec<usize> = nodes.into_iter().collect();
        nodes.sort_unstable();
        nodes.dedup();
        self.parts.insert(name.to_owned(), [nodes, Vec::new(), conditions]);
    }

    /// Gives a block elements of second order with straight edges, `full` ones with nodes in the middle of faces and cells too.
    /// New nodes belong to the parts that hold all corners of their edge, face or cell.
    pub fn raise(&mut self, block: &str, full: bool) {
        let [_, elements, facets] = self.parts[block].clone();
        let mut made: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
        let solids = elements.into_iter().map(|at| (self.space, at, true));
        for (dimension, at, solid) in solids.chain(facets.into_iter().map(|at| (self.space - 1, at, false))) {
            let list = if solid { &mut self.elements } else { &mut self.facets };
            let corners = list[at - 1].clone();
            let nodes = match (dimension, corners.len()) {
                (1, _) => 3,
                (2, 3) => 6,
                (2, _) => 8 + usize::from(full),
                (_, 4) => 10,
                _ => 20 + 7 * usize::from(full),
            };
            let shape = Shape::of(dimension, nodes).expect("a shape");
            let mut all = corners.clone();
            for point in &shape.cell().points[corners.len()..] {
                let mut weights = vec![0.0; corners.len()];
                shape_functions(shape.linear(), *point, &mut weights);
                let mut between: Vec<usize> =
                    corners.iter().zip(&weights).filter(|(_, weight)| **weight > 1e-9).map(|(&n, _)| n).collect();
                between.sort_unstable();
                let next = self.nodes.len() + 1;
                let node = *made.entry(between.clone()).or_insert(next);
                if node == next {
                    let share = 1.0 / between.len() as f64;
                    let place = std::array::from_fn(|c| between.iter().map(|&n| share * self.nodes[n - 1][c]).sum());
                    self.nodes.push(place);
                }
                all.push(node);
            }
            list[at - 1] = all;
        }
        for [nodes, ..] in self.parts.values_mut() {
            let own = |between: &Vec<usize>| between.iter().all(|n| nodes.binary_search(n).is_ok());
            let new: Vec<usize> = made.iter().filter(|(between, _)| own(between)).map(|(_, &node)| node).collect();
            nodes.extend(new);
            nodes.sort_unstable();
        }
    }

    /// The mesh file; conditions in `load` are those of loads.
    pub fn text(&self, load: &[usize]) -> String {
        let mut out = String::from("Begin Properties 0\nEnd Properties\nBegin Nodes\n");
        for (at, [x, y, z]) in self.nodes.iter().enumerate() {
            writeln!(out, "{} {x:e} {y:e} {z:e}", at + 1).expect("a string");
        }
        let numbers = |list: &[usize]| list.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
        out += "End Nodes\n";
        let mut block = |sort: &str, name: String, list: &[Vec<usize>], wanted: &dyn Fn(usize) -> bool| {
            let mut sizes: Vec<usize> = list.iter().map(Vec::len).collect();
            sizes.sort_unstable();
            sizes.dedup();
            for size in sizes {
                writeln!(out, "Begin {sort} {name}{}D{size}N", self.space).expect("a string");
                for (at, nodes) in list.iter().enumerate().filter(|(at, nodes)| nodes.len() == size && wanted(at + 1)) {
                    writeln!(out, "{} 0 {}", at + 1, numbers(nodes)).expect("a string");
                }
                writeln!(out, "End {sort}").expect("a string");
            }
        };
        block("Elements", "SmallDisplacementElement".to_owned(), &self.elements, &|_| true);
        let kind = if self.space == 2 { "Line" } else { "Surface" };
        for (name, loaded) in [("", false), ("Load", true)] {
            let wanted = |at: usize| load.contains(&at) == loaded;
            block("Conditions", format!("{kind}{name}Condition"), &self.facets, &wanted);
        }
        for (name, lists) in &self.parts {
            writeln!(out, "Begin SubModelPart {name}").expect("a string");
            for (kind, list) in ["Nodes", "Elements", "Conditions"].iter().zip(lists) {
                let rows: Vec<String> = list.iter().map(ToString::to_string).collect();
                writeln!(out, "Begin SubModelPart{kind}\n{}\nEnd SubModelPart{kind}", rows.join("\n"))
                    .expect("a string");
            }
            out += "End SubModelPart\n";
        }
        out
    }
}

/// Connection between the blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Joint {
    /// Contact without friction.
    Frictionless,
    /// Contact with this coefficient of friction.
    Frictional(f64),
    /// A tie.
    Tied,
}

/// A deck of two blocks "Lower" and "Upper" that meet in the parts "Slave" and "Interface".
pub struct Deck {
    /// The mesh.
    pub mesh: Mesh,
    /// Connection between the blocks.
    pub joint: Joint,
    /// Prescribed components of parts: numbers or expressions, null where free.
    pub supports: Vec<(String, [Value; 3])>,
    /// A pressure (stress) on the conditions of the part "Top".
    pub pressure: f64,
    /// Young's modulus of both blocks.
    pub young: f64,
    /// Steps of the run.
    pub steps: usize,
}

/// Poisson's ratio of both blocks.
pub const POISSON: f64 = 0.3;

impl Deck {
    /// Writes mesh, materials and deck; `change` has the last word on the deck.
    pub fn write(&self, folder: &Path, change: impl FnOnce(&mut Value)) {
        let space = self.mesh.space;
        let load = if self.pressure == 0.0 { &[][..] } else { &self.mesh.parts["Top"][2][..] };
        std::fs::write(folder.join("mesh.mdpa"), self.mesh.text(load)).expect("the mesh");
        let law = if space == 2 { "LinearElasticPlaneStrain2DLaw" } else { "LinearElastic3DLaw" };
        let material = |(at, name): (usize, &str)| {
            json!({"model_part_name": format!("Structure.{name}"), "properties_id": at + 1, "Material": {
                "constitutive_law": {"name": law},
                "Variables": {"YOUNG_MODULUS": self.young, "POISSON_RATIO": POISSON}, "Tables": {}}})
        };
        let materials: Vec<Value> = ["Lower", "Upper"].into_iter().enumerate().map(material).collect();
        let mut deck = self.deck(space);
        change(&mut deck);
        for (name, value) in
            [("StructuralMaterials.json", json!({"properties": materials})), ("ProjectParameters.json", deck)]
        {
            std::fs::write(folder.join(name), value.to_string()).expect("a file");
        }
    }

    fn deck(&self, space: usize) -> Value {
        let support = |(part, value): &(String, [Value; 3])| {
            json!({"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics",
                "Parameters": {"model_part_name": format!("Structure.{part}"), "variable_name": "DISPLACEMENT",
                    "constrained": value.each_ref().map(|v| !v.is_null()), "value": value, "interval": [0.0, "End"]}})
        };
        let supports: Vec<Value> = self.supports.iter().map(support).collect();
        let variable = if space == 2 { "LINE_LOAD" } else { "SURFACE_LOAD" };
        let mut down = [0.0; 3];
        down[space - 1] = -1.0;
        let pressure = json!({"python_module": "assign_vector_by_direction_to_condition_process",
            "kratos_module": "KratosMultiphysics", "Parameters": {"model_part_name": "Structure.Top",
                "variable_name": variable, "modulus": self.pressure, "direction": down, "interval": [0.0, "End"]}});
        let loads = if self.pressure == 0.0 { json!([]) } else { json!([pressure]) };
        let sides = |key: &str| {
            json!({"model_part_name": "Structure", key: {"0": ["Interface"]},
            "assume_master_slave": {"0": ["Slave"]}})
        };
        let tight = |names: &[&str]| {
            let keys = names.iter().flat_map(|name| {
                [(format!("{name}_relative_tolerance"), 1e-9), (format!("{name}_absolute_tolerance"), 1e-20)]
            });
            keys.map(|(key, value)| (key, json!(value))).collect::<serde_json::Map<_, _>>()
        };
        let (mortar, module, mut process, names, variable) = match self.joint {
            Joint::Tied => (
                "ComponentsMeshTying",
                "mesh_tying_process",
                sides("mesh_tying_model_part"),
                &[][..],
                "VECTOR_LAGRANGE_MULTIPLIER",
            ),
            Joint::Frictionless => (
                "ALMContactFrictionless",
                "alm_contact_process",
                sides("contact_model_part"),
                &["contact_residual"][..],
                "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE",
            ),
            Joint::Frictional(_) => (
                "ALMContactFrictional",
                "alm_contact_process",
                sides("contact_model_part"),
                &["contact_residual", "frictional_stick_contact_residual", "frictional_slip_contact_residual"][..],
                "VECTOR_LAGRANGE_MULTIPLIER",
            ),
        };
        match self.joint {
            Joint::Tied => process["variable_name"] = json!("DISPLACEMENT"),
            Joint::Frictionless => process["contact_type"] = json!("Frictionless"),
            Joint::Frictional(coefficient) => {
                process["contact_type"] = json!("Frictional");
                process["friction_coefficients"] = json!({"0": coefficient});
            }
        }
        let mut settings = Value::Object(tight(names));
        settings["mortar_type"] = json!(mortar);
        let criterion = if self.joint == Joint::Tied { "residual_criterion" } else { "contact_residual_criterion" };
        let step = 1.0 / self.steps as f64;
        let output = |file: &str, part: &str, variable: &str| {
            json!({"python_module": "json_output_process",
            "kratos_module": "KratosMultiphysics", "Parameters": {"output_file_name": file, "model_part_name": part,
                "output_variables": [variable], "time_frequency": 0.0}})
        };
        json!({
            "problem_data": {"problem_name": "blocks", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                "end_time": 1.0},
            "solver_settings": {"solver_type": "Static", "model_part_name": "Structure", "domain_size": space,
                "echo_level": 0, "analysis_type": "non_linear",
                "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
                "material_import_settings": {"materials_filename": "StructuralMaterials.json"},
                "time_stepping": {"time_step": step}, "convergence_criterion": criterion,
                "residual_relative_tolerance": 1e-10, "residual_absolute_tolerance": 1e-20, "buffer_size": 3,
                "contact_settings": settings},
            "processes": {"constraints_process_list": supports, "loads_process_list": loads,
                "contact_process_list": [{"python_module": module,
                    "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
                    "Parameters": process}],
                "json_output_process_list": [output("results.json", "Structure", "DISPLACEMENT"),
                    output("slave.json", "Structure.Slave", variable)]}
        })
    }
}
