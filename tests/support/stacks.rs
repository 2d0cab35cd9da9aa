//! Two blocks on each other, written as a deck: the interface tilted, with a gap, turned, on or off supports, in the plane and
//! in space.
#![allow(dead_code, reason = "each test binary uses its part")]

use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;

/// Two blocks in a box of size one, the lower one held at its bottom (guided ones across it only), the upper one under a pressure on its top.
#[derive(Debug, Clone, Copy)]
pub struct Stack {
    /// Dimensions, 2 or 3.
    pub space: usize,
    /// Elements along the interface, of the lower block, the slave, and of the upper one.
    pub divisions: [usize; 2],
    /// Tilt of the interface (degrees).
    pub tilt: f64,
    /// Gap between the blocks.
    pub gap: f64,
    /// Turn of everything (degrees).
    pub turn: f64,
    /// In space, the axis of the turn (along, across, up), of any length.
    pub axis: [f64; 3],
    /// Factor of all lengths.
    pub size: f64,
    /// Whether the sides x = 0 of both blocks, interface included, are held across; in space the sides y = 0 too.
    pub guided: bool,
    /// Contact formulation, its process and the coefficient of friction.
    pub formulation: (&'static str, &'static str),
    pub friction: f64,
    /// Pressure over Young's modulus.
    pub load: f64,
}

/// Young's modulus of both blocks.
pub const YOUNG: f64 = 1e9;

/// One block: how its nodes and cells are numbered.
struct Block {
    base: usize,
    along: usize,
    across: usize,
    layers: usize,
}

impl Block {
    fn node(&self, i: usize, j: usize, k: usize) -> usize {
        self.base + i + (self.along + 1) * (j + (self.across + 1) * k)
    }

    /// The nodes of a cell, or of its lower side, in the order of the shapes.
    fn corners(&self, space: usize, [i, j, k]: [usize; 3], side: bool) -> Vec<usize> {
        let n = |a, b, c| self.node(i + a, j + b, k + c);
        match (space, side) {
            (2, true) => vec![n(0, 0, 0), n(1, 0, 0)],
            (2, false) => vec![n(0, 0, 0), n(1, 0, 0), n(1, 0, 1), n(0, 0, 1)],
            (_, true) => vec![n(0, 0, 0), n(0, 1, 0), n(1, 1, 0), n(1, 0, 0)],
            (_, false) => [0, 1].into_iter().flat_map(|c| [n(0, 0, c), n(1, 0, c), n(1, 1, c), n(0, 1, c)]).collect(),
        }
    }

    fn columns(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        (0..self.across.max(1)).flat_map(|j| (0..self.along).map(move |i| [i, j]))
    }

    /// The facets of layer `k` that look down, or up.
    fn facets(&self, space: usize, k: usize, up: bool) -> Vec<Vec<usize>> {
        let facet = |[i, j]: [usize; 2]| {
            let mut nodes = self.corners(space, [i, j, k], true);
            if up {
                nodes.reverse();
            }
            nodes
        };
        self.columns().map(facet).collect()
    }

    fn nodes(&self, wanted: impl Fn(usize, usize, usize) -> bool) -> Vec<usize> {
        let mut found = Vec::new();
        for k in 0..=self.layers {
            for j in 0..=self.across {
                found.extend((0..=self.along).filter(|&i| wanted(i, j, k)).map(|i| self.node(i, j, k)));
            }
        }
        found
    }
}

impl Stack {
    /// Force of the pressure, per thickness in the plane.
    pub fn force(&self) -> f64 {
        self.load * YOUNG * self.size.powi(self.space as i32 - 1)
    }

    /// Direction in which the pressure acts.
    pub fn down(&self) -> [f64; 3] {
        self.turned([0.0, 0.0, -1.0])
    }

    /// A point (along, across, up), turned and in the axes of the deck. In the plane the turn is anticlockwise.
    fn turned(&self, x: [f64; 3]) -> [f64; 3] {
        let (sin, cos) = self.turn.to_radians().sin_cos();
        if self.space == 2 {
            return [cos * x[0] - sin * x[2], sin * x[0] + cos * x[2], 0.0];
        }
        // Rodrigues' formula.
        let length = self.axis.iter().map(|c| c * c).sum::<f64>().sqrt();
        let a = self.axis.map(|c| c / length);
        let along: f64 = (0..3).map(|c| a[c] * x[c]).sum();
        std::array::from_fn(|c| {
            let (d, e) = ((c + 1) % 3, (c + 2) % 3);
            cos * x[c] + sin * (a[d] * x[e] - a[e] * x[d]) + (1.0 - cos) * along * a[c]
        })
    }

    /// Writes mesh, materials and deck into a folder; `change` has the last word on the deck.
    pub fn write(&self, folder: &Path, change: impl FnOnce(&mut Value)) {
        let [lower, upper] = self.blocks();
        std::fs::write(folder.join("mesh.mdpa"), self.mesh(&lower, &upper)).expect("the mesh");
        let material = |(at, name): (usize, &str)| {
            let law = if self.space == 2 { "LinearElasticPlaneStrain2DLaw" } else { "LinearElastic3DLaw" };
            json!({"model_part_name": format!("Structure.{name}"), "properties_id": at + 1, "Material": {
                "constitutive_law": {"name": law},
                "Variables": {"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": 0.3}, "Tables": {}}})
        };
        let materials: Vec<Value> = ["Lower", "Upper"].into_iter().enumerate().map(material).collect();
        let mut deck = self.deck();
        change(&mut deck);
        for (name, value) in
            [("StructuralMaterials.json", json!({"properties": materials})), ("ProjectParameters.json", deck)]
        {
            std::fs::write(folder.join(name), serde_json::to_string_pretty(&value).expect("JSON")).expect("a file");
        }
    }

    fn blocks(&self) -> [Block; 2] {
        let block = |base, n: usize| {
            let across = if self.space == 2 { 0 } else { n };
            Block { base, along: n, across, layers: (n / 2).max(2) }
        };
        let lower = block(1, self.divisions[0]);
        let upper = block(lower.node(0, 0, lower.layers + 1), self.divisions[1]);
        [lower, upper]
    }

    fn mesh(&self, lower: &Block, upper: &Block) -> String {
        let mut out = String::from(
            "Begin Properties 0\nEnd Properties\nBegin Properties 1\nEnd Properties\nBegin Properties 2\nEnd Properties\nBegin Nodes\n",
        );
        let middle = |x: f64| 0.5 + (x - 0.5) * self.tilt.to_radians().tan();
        for (block, is_upper) in [(lower, false), (upper, true)] {
            for k in 0..=block.layers {
                for j in 0..=block.across {
                    for i in 0..=block.along {
                        let [x, w] = [i, j].map(|i| i as f64 / block.along as f64);
                        let (from, to) = if is_upper { (middle(x), 1.0) } else { (0.0, middle(x)) };
                        let h = from + (to - from) * k as f64 / block.layers as f64;
                        let lift = if is_upper { self.gap } else { 0.0 };
                        let [x, y, z] = self.turned([x, w, h + lift]).map(|c| c * self.size);
                        writeln!(out, "{} {x:e} {y:e} {z:e}", block.node(i, j, k)).expect("a string");
                    }
                }
            }
        }
        let shape = if self.space == 2 { "2D4N" } else { "3D8N" };
        writeln!(out, "End Nodes\nBegin Elements SmallDisplacementElement{shape}").expect("a string");
        let mut counts = [0; 2];
        let mut id = 0;
        for (at, block) in [lower, upper].into_iter().enumerate() {
            for k in 0..block.layers {
                for [i, j] in block.columns() {
                    id += 1;
                    counts[at] += 1;
                    line(&mut out, id, at + 1, &block.corners(self.space, [i, j, k], false));
                }
            }
        }
        out += "End Elements\n";
        let sides = [
            (lower.facets(self.space, lower.layers, true), 1),
            (upper.facets(self.space, 0, false), 2),
            (upper.facets(self.space, upper.layers, true), 0),
        ];
        let mut ranges = Vec::new();
        let mut id = 0;
        for (facets, properties) in &sides {
            let (kind, load) = if self.space == 2 { ("Line", "2D2N") } else { ("Surface", "3D4N") };
            let kind = if *properties == 0 { format!("{kind}Load") } else { kind.to_owned() };
            writeln!(out, "Begin Conditions {kind}Condition{load}").expect("a string");
            ranges.push(id + 1..id + 1 + facets.len());
            for facet in facets {
                id += 1;
                line(&mut out, id, *properties, facet);
            }
            out += "End Conditions\n";
        }
        let all = |block: &Block| block.nodes(|_, _, _| true);
        let both = |wanted: &dyn Fn(usize, usize) -> bool| {
            [lower, upper].into_iter().flat_map(|b| b.nodes(|i, j, _| wanted(i, j))).collect::<Vec<_>>()
        };
        let (top, bottom) = (lower.nodes(|_, _, k| k == lower.layers), upper.nodes(|_, _, k| k == 0));
        let elements = [1..counts[0] + 1, counts[0] + 1..counts[0] + counts[1] + 1];
        let of = |ranges: &[std::ops::Range<usize>]| ranges.iter().cloned().flatten().collect::<Vec<usize>>();
        for (name, nodes, elements, conditions) in [
            ("Lower", all(lower), of(&elements[..1]), of(&ranges[..1])),
            ("Upper", all(upper), of(&elements[1..]), of(&ranges[1..])),
            ("Bottom", lower.nodes(|_, _, k| k == 0), vec![], vec![]),
            ("Left", both(&|i, _| i == 0), vec![], vec![]),
            ("Front", both(&|_, j| j == 0), vec![], vec![]),
            ("Top", upper.nodes(|_, _, k| k == upper.layers), vec![], of(&ranges[2..])),
            ("Slave", top.clone(), vec![], of(&ranges[..1])),
            ("Interface", [top, bottom].concat(), vec![], of(&ranges[..2])),
        ] {
            writeln!(out, "Begin SubModelPart {name}").expect("a string");
            for (what, ids) in [("Nodes", nodes), ("Elements", elements), ("Conditions", conditions)] {
                let ids: String = ids.iter().map(|id| format!("{id}\n")).collect();
                write!(out, "Begin SubModelPart{what}\n{ids}End SubModelPart{what}\n").expect("a string");
            }
            out += "End SubModelPart\n";
        }
        out
    }

    fn deck(&self) -> Value {
        let fixed = |part: &str, axes: [bool; 3]| {
            let value = axes.map(|fixed| if fixed { json!(0.0) } else { Value::Null });
            json!({"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics", "Parameters": {
                "model_part_name": format!("Structure.{part}"), "variable_name": "DISPLACEMENT",
                "constrained": axes, "value": value, "interval": [0.0, "End"]}})
        };
        let mut supports = vec![fixed("Bottom", [!self.guided, !self.guided || self.space == 2, self.space == 3])];
        if self.guided {
            supports.push(fixed("Left", [true, false, false]));
            if self.space == 3 {
                supports.push(fixed("Front", [false, true, false]));
            }
        }
        let load = json!({"python_module": "assign_vector_by_direction_to_condition_process",
            "kratos_module": "KratosMultiphysics", "Parameters": {"model_part_name": "Structure.Top",
            "variable_name": if self.space == 2 { "LINE_LOAD" } else { "SURFACE_LOAD" },
            "modulus": format!("{:e}*t", self.load * YOUNG), "direction": self.down(), "interval": [0.0, "End"]}});
        let (formulation, process) = self.formulation;
        let mut contact = json!({"model_part_name": "Structure", "contact_model_part": {"0": ["Interface"]},
            "assume_master_slave": {"0": ["Slave"]}, "contact_type": "Frictionless"});
        if !formulation.ends_with("Frictionless") {
            contact["contact_type"] = json!("Frictional");
            contact["friction_coefficients"] = json!({"0": self.friction});
        }
        let output = json!({"python_module": "json_output_process", "kratos_module": "KratosMultiphysics", "Parameters": {
            "output_file_name": "results.json", "model_part_name": "Structure",
            "output_variables": ["DISPLACEMENT", "REACTION"], "time_frequency": 0.0}});
        json!({
            "problem_data": {"problem_name": "mesh", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0, "end_time": 1.0},
            "solver_settings": {"solver_type": "Static", "model_part_name": "Structure", "domain_size": self.space,
                "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
                "material_import_settings": {"materials_filename": "StructuralMaterials.json"},
                "time_stepping": {"time_step": 1.0}, "convergence_criterion": "contact_residual_criterion",
                "contact_settings": {"mortar_type": formulation}},
            "processes": {"constraints_process_list": supports, "loads_process_list": [load],
                "contact_process_list": [{"python_module": process,
                    "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication", "Parameters": contact}],
                "output_process_list": [output]}
        })
    }
}

fn line(out: &mut String, id: usize, properties: usize, nodes: &[usize]) {
    let nodes: String = nodes.iter().map(|node| format!(" {node}")).collect();
    writeln!(out, "{id} {properties}{nodes}").expect("a string");
}
