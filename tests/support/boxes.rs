//! Boxes of equal elements that move and touch: their mesh, their deck and the invariants of their motion.
#![allow(dead_code, reason = "each test binary uses its part")]

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};

use crate::support::Results;

/// Bodies of bricks, or of rectangles in the plane, with the parts of their surfaces.
#[derive(Default)]
pub struct Boxes {
    pub dimension: usize,
    pub nodes: Vec<[f64; 3]>,
    pub velocities: Vec<[f64; 3]>,
    elements: Vec<Vec<usize>>,
    conditions: Vec<Vec<usize>>,
    parts: BTreeMap<String, [Vec<usize>; 3]>,
    bodies: Vec<String>,
}

impl Boxes {
    /// Nothing yet in the plane or in space.
    pub fn new(dimension: usize) -> Self {
        Self { dimension, ..Self::default() }
    }

    /// A box from `low` to `high` of `counts` elements, turned about z by `angle` and its middle; `faces` such as `("y-", part)`
    /// have conditions in these parts. It moves with `velocity`, a function of place.
    pub fn add(
        &mut self,
        name: &str,
        [low, high]: [[f64; 3]; 2],
        counts: [usize; 3],
        angle: f64,
        faces: &[(&str, &str)],
        velocity: impl Fn([f64; 3]) -> [f64; 3],
    ) {
        let d = self.dimension;
        let counts: [usize; 3] = std::array::from_fn(|a| if a < d { counts[a] } else { 0 });
        let first = self.nodes.len();
        let number = |at: [usize; 3]| first + at[0] + (counts[0] + 1) * (at[1] + (counts[1] + 1) * at[2]);
        for k in 0..=counts[2] {
            for j in 0..=counts[1] {
                for i in 0..=counts[0] {
                    let at = [i, j, k];
                    let x: [f64; 3] = std::array::from_fn(|a| match counts[a] {
                        0 => 0.0,
                        count => low[a] + (high[a] - low[a]) * at[a] as f64 / count as f64,
                    });
                    let [cx, cy] = [0, 1].map(|a| 0.5 * (low[a] + high[a]));
                    let (sin, cos) = angle.sin_cos();
                    let (dx, dy) = (x[0] - cx, x[1] - cy);
                    let place = [cx + cos * dx - sin * dy, cy + sin * dx + cos * dy, x[2]];
                    self.nodes.push(if angle == 0.0 { x } else { place });
                    self.velocities.push(velocity(*self.nodes.last().expect("just pushed")));
                }
            }
        }
        let begin = self.elements.len();
        for k in 0..counts[2].max(1) {
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    let level = |k| [[i, j, k], [i + 1, j, k], [i + 1, j + 1, k], [i, j + 1, k]].map(number);
                    let mut nodes = level(k).to_vec();
                    if d == 3 {
                        nodes.extend(level(k + 1));
                    }
                    self.elements.push(nodes);
                }
            }
        }
        let body = self.parts.entry(name.to_owned()).or_default();
        body[0] = (first..self.nodes.len()).collect();
        body[1] = (begin..self.elements.len()).collect();
        self.bodies.push(name.to_owned());
        for &(face, part) in faces {
            let axis = "xyz".find(&face[..1]).expect("a face");
            let side = if face.ends_with('-') { 0 } else { counts[axis] };
            let across: Vec<usize> = (0..d).filter(|&a| a != axis).collect();
            let ranges = [counts[across[0]], across.get(1).map_or(1, |&a| counts[a])];
            for p in 0..ranges[0] {
                for q in 0..ranges[1] {
                    let corner = |dp: usize, dq: usize| {
                        let mut at = [0; 3];
                        at[axis] = side;
                        at[across[0]] = p + dp;
                        across.get(1).into_iter().for_each(|&a| at[a] = q + dq);
                        number(at)
                    };
                    let nodes = match d {
                        2 => vec![corner(0, 0), corner(1, 0)],
                        _ => vec![corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)],
                    };
                    let entry = self.parts.entry(part.to_owned()).or_default();
                    entry[0].extend(&nodes);
                    entry[2].push(self.conditions.len());
                    self.conditions.push(nodes);
                }
            }
        }
        self.parts.values_mut().for_each(|part| {
            part[0].sort_unstable();
            part[0].dedup();
        });
    }

    /// A block "Block" turned by `angle` that is thrown on a coarser ground "Ground": a corner goes in between the nodes of
    /// the ground.
    pub fn thrown_on_coarse_ground(angle: f64) -> Self {
        let mut boxes = Self::new(2);
        let faces = ["x-", "x+", "y-", "y+"].map(|face| (face, "Skin"));
        boxes.add("Block", [[0.0; 3], [1.0; 3]], [8; 3], angle, &faces, |_| [0.009, -0.012, 0.0]);
        let lowest = boxes.nodes.iter().map(|x| x[1]).fold(f64::INFINITY, f64::min) - 0.1;
        let ground = [[-2.0, lowest - 0.5, 0.0], [4.0, lowest, 0.0]];
        boxes.add("Ground", ground, [12, 1, 0], 0.0, &[("y+", "Top")], |_| [0.0; 3]);
        boxes
    }

    /// Writes their deck up to `end`, in which the ground is the slave.
    pub fn write_thrown(&self, folder: &Path, material: [f64; 3], end: f64, solver: &Value) {
        let (process, fixed) = (("alm_contact_process", &json!({})), [("Ground", [true; 3])]);
        self.write(folder, material, &[("Top", "Skin")], &fixed, [0.8, end], solver, process);
    }

    /// Writes mesh, materials and deck: contact of `slave` on `master`, both named when the boxes were added. The `fixed` hold
    /// parts in some directions; `solver` and `contact` are further settings.
    #[allow(clippy::too_many_arguments, reason = "a deck has many parts")]
    pub fn write(
        &self,
        folder: &Path,
        material: [f64; 3],
        pairs: &[(&str, &str)],
        fixed: &[(&str, [bool; 3])],
        [time_step, end]: [f64; 2],
        solver: &Value,
        process: (&str, &Value),
    ) {
        let element = ["TotalLagrangianElement2D4N", "TotalLagrangianElement3D8N"][self.dimension - 2];
        let condition = ["LineCondition2D2N", "SurfaceCondition3D4N"][self.dimension - 2];
        let mut mesh = String::from("Begin Properties 0\nEnd Properties\n\nBegin Nodes\n");
        for (at, [x, y, z]) in self.nodes.iter().enumerate() {
            let _ = writeln!(mesh, "{} {x:?} {y:?} {z:?}", at + 1);
        }
        mesh.push_str("End Nodes\n\n");
        for (kind, name, list) in [("Elements", element, &self.elements), ("Conditions", condition, &self.conditions)] {
            let _ = writeln!(mesh, "Begin {kind} {name}");
            for (at, nodes) in list.iter().enumerate() {
                let nodes: Vec<String> = nodes.iter().map(|n| (n + 1).to_string()).collect();
                let _ = writeln!(mesh, "{} 0 {}", at + 1, nodes.join(" "));
            }
            let _ = writeln!(mesh, "End {kind}\n");
        }
        for (component, letter) in ["X", "Y", "Z"].iter().enumerate() {
            let _ = writeln!(mesh, "Begin NodalData VELOCITY_{letter}");
            for (at, velocity) in self.velocities.iter().enumerate().filter(|(_, v)| v[component] != 0.0) {
                let _ = writeln!(mesh, "{} 0 {:?}", at + 1, velocity[component]);
            }
            mesh.push_str("End NodalData\n\n");
        }
        let both = pairs.iter().enumerate().map(|(key, pair)| (format!("Pair{key}"), pair));
        let mut parts = self.parts.clone();
        for (name, (slave, master)) in both {
            let mut whole = parts[*slave].clone();
            (0..3).for_each(|list| whole[list].extend(&self.parts[*master][list]));
            parts.insert(name, whole);
        }
        for (name, lists) in &parts {
            let _ = writeln!(mesh, "Begin SubModelPart {name}");
            for (kind, list) in ["Nodes", "Elements", "Conditions"].iter().zip(lists) {
                let ids: Vec<String> = list.iter().map(|at| (at + 1).to_string()).collect();
                let _ = writeln!(mesh, "Begin SubModelPart{kind}\n{}\nEnd SubModelPart{kind}", ids.join("\n"));
            }
            mesh.push_str("End SubModelPart\n\n");
        }
        std::fs::write(folder.join("mesh.mdpa"), mesh).expect("the mesh");
        let [young, poisson, density] = material;
        let law = ["KirchhoffSaintVenantPlaneStress2DLaw", "KirchhoffSaintVenant3DLaw"][self.dimension - 2];
        let properties: Vec<Value> = (self.bodies.iter().enumerate())
            .map(|(at, body)| {
                let variables = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": poisson, "DENSITY": density});
                let material = json!({"constitutive_law": {"name": law}, "Variables": variables, "Tables": {}});
                json!({"model_part_name": format!("Structure.{body}"), "properties_id": at + 1, "Material": material})
            })
            .collect();
        let write = |name: &str, value: &Value| std::fs::write(folder.join(name), value.to_string()).expect("a file");
        write("StructuralMaterials.json", &json!({ "properties": properties }));
        let keyed = |of: &dyn Fn(usize) -> String| -> Value {
            (0..pairs.len()).map(|key| (key.to_string(), json!([of(key)]))).collect::<serde_json::Map<_, _>>().into()
        };
        let mut contact = json!({
            "model_part_name": "Structure",
            "contact_type": "Frictionless",
            "contact_model_part": keyed(&|key| format!("Pair{key}")),
            "assume_master_slave": keyed(&|key| pairs[key].0.to_owned()),
        });
        merge(&mut contact, process.1);
        let mut settings = json!({
            "solver_type": "Dynamic", "model_part_name": "Structure", "domain_size": self.dimension,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
            "material_import_settings": {"materials_filename": "StructuralMaterials.json"},
            "time_stepping": {"time_step": time_step},
            "convergence_criterion": "contact_residual_criterion",
            "residual_relative_tolerance": 1e-9, "residual_absolute_tolerance": 1e-13,
            "contact_settings": {
                "mortar_type": "ALMContactFrictionless",
                "contact_residual_relative_tolerance": 1e-9, "contact_residual_absolute_tolerance": 1e-13
            }
        });
        merge(&mut settings, solver);
        let hold = |(part, held): &(&str, [bool; 3])| {
            let value: Vec<Value> = held.iter().map(|held| if *held { json!(0.0) } else { Value::Null }).collect();
            json!({
                "python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics",
                "Parameters": {
                    "model_part_name": format!("Structure.{part}"), "variable_name": "DISPLACEMENT",
                    "constrained": held, "value": value, "interval": [0.0, "End"]
                }
            })
        };
        let output = json!({
            "python_module": "json_output_process", "kratos_module": "KratosMultiphysics",
            "Parameters": {
                "output_file_name": "results.json", "model_part_name": "Structure",
                "output_variables": ["DISPLACEMENT", "VELOCITY"], "time_frequency": 0.0
            }
        });
        let application = "KratosMultiphysics.ContactStructuralMechanicsApplication";
        let contact = json!({"python_module": process.0, "kratos_module": application, "Parameters": contact});
        let deck = json!({
            "problem_data": {"problem_name": "boxes", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": end},
            "solver_settings": settings,
            "processes": {
                "constraints_process_list": fixed.iter().map(hold).collect::<Vec<_>>(),
                "contact_process_list": [contact], "json_output_process_list": [output]
            }
        });
        write("ProjectParameters.json", &deck);
    }

    /// State of a body at a step, from the displacements and velocities that were written; the initial state for `None`.
    pub fn state(&self, body: &str, material: [f64; 3], results: &Results, step: Option<usize>) -> State {
        let field = |name: &str, initial: &dyn Fn(usize) -> [f64; 3]| -> Vec<[f64; 3]> {
            let Some(step) = step else { return (0..self.nodes.len()).map(initial).collect() };
            let columns = ["X", "Y", "Z"].map(|letter| results.nodal(&format!("{name}_{letter}"), step));
            let at = |node: usize| std::array::from_fn(|c| columns[c].get(&(node as u64 + 1)).copied().unwrap_or(0.0));
            (0..self.nodes.len()).map(at).collect()
        };
        let u = field("DISPLACEMENT", &|_| [0.0; 3]);
        let v = field("VELOCITY", &|node| self.velocities[node]);
        let d = self.dimension;
        let mut state = State::default();
        for &element in &self.parts[body][1] {
            let nodes = &self.elements[element];
            let cell = Cell { d, x: nodes.iter().map(|&n| self.nodes[n]).collect() };
            let own = |field: &[[f64; 3]]| -> Vec<[f64; 3]> { nodes.iter().map(|&n| field[n]).collect() };
            cell.add_to(&mut state, &own(&u), &own(&v), material);
        }
        state
    }

    /// The nodes of a part, by their places in [`Boxes::nodes`].
    pub fn part(&self, name: &str) -> &[usize] {
        &self.parts[name][0]
    }
}

/// Lays one object over another.
fn merge(target: &mut Value, other: &Value) {
    match (target, other) {
        (Value::Object(target), Value::Object(other)) => {
            for (key, value) in other {
                merge(target.entry(key).or_insert(Value::Null), value);
            }
        }
        (target, other) => *target = other.clone(),
    }
}

/// Integrals over a body in motion.
#[derive(Debug, Clone, Copy, Default)]
pub struct State {
    pub mass: f64,
    pub momentum: [f64; 3],
    /// About the origin, of the present positions.
    pub spin: [f64; 3],
    pub kinetic: f64,
    pub strain: f64,
}

impl State {
    pub fn energy(&self) -> f64 {
        self.kinetic + self.strain
    }
}

/// A rectangle or brick with its mass of the initial positions and Kirchhoff–Saint-Venant's energy.
struct Cell {
    d: usize,
    x: Vec<[f64; 3]>,
}

impl Cell {
    fn add_to(&self, state: &mut State, u: &[[f64; 3]], v: &[[f64; 3]], [young, poisson, density]: [f64; 3]) {
        let p = 1.0 / 3.0_f64.sqrt();
        let points: Vec<[f64; 3]> = (0..1 << self.d)
            .map(|at: usize| {
                std::array::from_fn(|a| {
                    if a >= self.d {
                        0.0
                    } else if at >> a & 1 == 1 {
                        p
                    } else {
                        -p
                    }
                })
            })
            .collect();
        for point in points {
            let (shape, gradient, volume) = self.at(point);
            let sum = |field: &dyn Fn(usize) -> [f64; 3]| -> [f64; 3] {
                std::array::from_fn(|c| shape.iter().enumerate().map(|(n, weight)| weight * field(n)[c]).sum())
            };
            let velocity = sum(&|n| v[n]);
            let place = sum(&|n| std::array::from_fn(|c| self.x[n][c] + u[n][c]));
            let dm = density * volume;
            state.mass += dm;
            state.kinetic += 0.5 * dm * velocity.iter().map(|v| v * v).sum::<f64>();
            for c in 0..3 {
                let (b, a) = ((c + 1) % 3, (c + 2) % 3);
                state.momentum[c] += dm * velocity[c];
                state.spin[c] += dm * (place[b] * velocity[a] - place[a] * velocity[b]);
            }
            let h = |i: usize, j: usize| -> f64 { (0..u.len()).map(|n| u[n][i] * gradient[n][j]).sum() };
            let strain =
                |i: usize, j: usize| 0.5 * (h(i, j) + h(j, i) + (0..self.d).map(|k| h(k, i) * h(k, j)).sum::<f64>());
            let trace: f64 = (0..self.d).map(|i| strain(i, i)).sum();
            let square: f64 =
                (0..self.d).flat_map(|i| (0..self.d).map(move |j| (i, j))).map(|(i, j)| strain(i, j).powi(2)).sum();
            let mu = 0.5 * young / (1.0 + poisson);
            let lambda = match self.d {
                2 => young * poisson / (1.0 - poisson * poisson),
                _ => young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)),
            };
            state.strain += volume * (0.5 * lambda * trace * trace + mu * square);
        }
    }

    /// Shape functions, their gradients and the volume of a Gauss point, on a parallelepiped.
    fn at(&self, point: [f64; 3]) -> (Vec<f64>, Vec<[f64; 3]>, f64) {
        let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
        let corners = &corners[..1 << self.d];
        let sign = |n: usize, a: usize| 2.0 * f64::from(corners[n][a]) - 1.0;
        let factor = |n: usize, a: usize| if a < self.d { 0.5 * (1.0 + sign(n, a) * point[a]) } else { 1.0 };
        let shape: Vec<f64> = (0..corners.len()).map(|n| (0..self.d).map(|a| factor(n, a)).product()).collect();
        let ends = [1, 3, 4];
        let edge = |a: usize| -> [f64; 3] { std::array::from_fn(|c| self.x[ends[a]][c] - self.x[0][c]) };
        let length = |a: usize| edge(a).iter().map(|v| v * v).sum::<f64>().sqrt();
        let volume: f64 = (0..self.d).map(|a| 0.5 * length(a)).product();
        let gradient = |n: usize| -> [f64; 3] {
            std::array::from_fn(|c| {
                let along = |a: usize| {
                    let others: f64 = (0..self.d).filter(|b| *b != a).map(|b| factor(n, b)).product();
                    sign(n, a) * others * edge(a)[c] / length(a).powi(2)
                };
                (0..self.d).map(along).sum()
            })
        };
        let gradients = (0..corners.len()).map(gradient).collect();
        (shape, gradients, volume)
    }
}
