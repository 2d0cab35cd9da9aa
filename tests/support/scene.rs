//! Decks of bodies that touch and are tied, at corners that belong to several faces, written from code.
#![allow(dead_code, reason = "each test binary uses its part")]

use std::path::Path;

use serde_json::{Map, Value, json};

use crate::blocks::{Mesh, Sides, Vec3};
use crate::support::{Results, said, zelus};

const DECK: &str = "ProjectParameters.json";

/// How a part of a deck presses: a condition of contact and the process that makes it.
pub type Kind = (&'static str, &'static str);
pub const FRICTIONLESS: Kind = ("ALMContactFrictionless", "Frictionless");
pub const COMPONENTS: Kind = ("ALMContactFrictionlessComponents", "FrictionlessComponents");
pub const FRICTIONAL: Kind = ("ALMContactFrictional", "Frictional");

/// Bodies that touch and are tied.
pub struct Scene {
    pub mesh: Mesh,
    pub bodies: Vec<&'static str>,
    /// Parts that do not move, and those that are moved.
    pub supports: Vec<(&'static str, [Value; 3])>,
    /// Parts with tractions (stress).
    pub loads: Vec<(&'static str, Vec3)>,
    pub loaded: Vec<usize>,
    /// Slave and master of pairs and of ties.
    pub pairs: Vec<[&'static str; 2]>,
    pub ties: Vec<[&'static str; 2]>,
    pub kind: Kind,
    /// Coefficient of friction of the pairs, where the kind has one.
    pub friction: f64,
    pub steps: usize,
    pub young: f64,
    pub poisson: f64,
}

impl Scene {
    pub fn new(space: usize) -> Self {
        Self {
            mesh: Mesh::new(space),
            bodies: Vec::new(),
            supports: Vec::new(),
            loads: Vec::new(),
            loaded: Vec::new(),
            pairs: Vec::new(),
            ties: Vec::new(),
            kind: FRICTIONLESS,
            friction: 0.0,
            steps: 1,
            young: 1e3,
            poisson: 0.3,
        }
    }

    /// A box between two corners, each place moved by `place` at last.
    pub fn add(
        &mut self,
        name: &'static str,
        [low, high]: [Vec3; 2],
        count: usize,
        place: &dyn Fn(Vec3) -> Vec3,
    ) -> Sides {
        self.bodies.push(name);
        self.mesh.block(name, [count; 3], |x| place(std::array::from_fn(|c| low[c] + (high[c] - low[c]) * x[c])))
    }

    /// A part of some sides.
    pub fn part(&mut self, name: &str, sides: &Sides, of: &[(usize, usize)]) {
        let nodes: Vec<usize> = of.iter().flat_map(|side| sides[side].0.clone()).collect();
        let facets: Vec<usize> = of.iter().flat_map(|side| sides[side].1.clone()).collect();
        self.mesh.part(name, nodes, facets);
    }

    /// A part of one side that carries a traction.
    pub fn load(&mut self, name: &'static str, sides: &Sides, side: (usize, usize), traction: Vec3) {
        self.part(name, sides, &[side]);
        self.loaded.extend(&sides[&side].1);
        self.loads.push((name, traction));
    }

    pub fn write(&self, folder: &Path) {
        let space = self.mesh.space;
        let law = if space == 2 { "LinearElasticPlaneStrain2DLaw" } else { "LinearElastic3DLaw" };
        let material = |(at, name): (usize, &&str)| {
            json!({"model_part_name": format!("Structure.{name}"), "properties_id": at + 1, "Material": {
                "constitutive_law": {"name": law},
                "Variables": {"YOUNG_MODULUS": self.young, "POISSON_RATIO": self.poisson}, "Tables": {}}})
        };
        let materials: Vec<Value> = self.bodies.iter().enumerate().map(material).collect();
        let process = |module: &str, mut parameters: Value| {
            parameters["interval"] = json!([0.0, "End"]);
            json!({"python_module": module, "kratos_module": "KratosMultiphysics", "Parameters": parameters})
        };
        let support = |(part, value): &(&str, [Value; 3])| {
            let name = format!("Structure.{part}");
            process(
                "assign_vector_variable_process",
                json!({"model_part_name": name, "variable_name": "DISPLACEMENT",
                    "constrained": value.each_ref().map(|v| !v.is_null()), "value": value}),
            )
        };
        let load = |(part, traction): &(&str, Vec3)| {
            let name = format!("Structure.{part}");
            let size = traction.iter().map(|t| t * t).sum::<f64>().sqrt();
            process(
                "assign_vector_by_direction_to_condition_process",
                json!({"model_part_name": name, "variable_name": if space == 2 { "LINE_LOAD" } else { "SURFACE_LOAD" },
                    "modulus": format!("{size:e}*t"), "direction": traction}),
            )
        };
        let sides = |key: &str, pairs: &[[&str; 2]]| {
            let keyed = |of: &dyn Fn(&[&str; 2]) -> Value| {
                let entries = pairs.iter().enumerate().map(|(at, pair)| (at.to_string(), of(pair)));
                Value::Object(entries.collect::<Map<_, _>>())
            };
            json!({"model_part_name": "Structure", key: keyed(&|pair| json!(pair)),
                "assume_master_slave": keyed(&|pair| json!([pair[0]]))})
        };
        let mut contact = Vec::new();
        let (mut mortar, mut criterion) = ("ComponentsMeshTying", "residual_criterion");
        if !self.ties.is_empty() {
            contact.push(process("mesh_tying_process", sides("mesh_tying_model_part", &self.ties)));
        }
        if !self.pairs.is_empty() {
            let mut parameters = sides("contact_model_part", &self.pairs);
            parameters["contact_type"] = json!(self.kind.1);
            if self.friction > 0.0 {
                let keyed = (0..self.pairs.len()).map(|at| (at.to_string(), json!(self.friction)));
                parameters["friction_coefficients"] = Value::Object(keyed.collect::<Map<_, _>>());
            }
            contact.push(process("alm_contact_process", parameters));
            (mortar, criterion) = (self.kind.0, "contact_residual_criterion");
        }
        let mut settings = json!({"mortar_type": mortar});
        if !self.pairs.is_empty() {
            settings["contact_residual_relative_tolerance"] = json!(1e-10);
        }
        let deck = json!({
            "problem_data": {"problem_name": "corners", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1.0},
            "solver_settings": {"solver_type": "Static", "model_part_name": "Structure", "domain_size": space,
                "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
                "material_import_settings": {"materials_filename": "StructuralMaterials.json"},
                "time_stepping": {"time_step": 1.0 / self.steps as f64}, "convergence_criterion": criterion,
                "residual_relative_tolerance": 1e-10, "contact_settings": settings},
            "processes": {
                "constraints_process_list": self.supports.iter().map(support).collect::<Vec<_>>(),
                "loads_process_list": self.loads.iter().map(load).collect::<Vec<_>>(),
                "contact_process_list": contact,
                "json_output_process_list": [json!({"python_module": "json_output_process",
                    "kratos_module": "KratosMultiphysics", "Parameters": {"output_file_name": "results.json",
                    "model_part_name": "Structure", "output_variables": ["DISPLACEMENT", "REACTION"],
                    "time_frequency": 0.0}})]}
        });
        let write = |name: &str, text: String| std::fs::write(folder.join(name), text).expect("a file");
        write("mesh.mdpa", self.mesh.text(&self.loaded));
        write("StructuralMaterials.json", json!({ "properties": materials }).to_string());
        write(DECK, deck.to_string());
    }

    /// Runs the deck; returns the exit code, the output, and the fields of the last step by node.
    pub fn run(&self) -> (Option<i32>, String, Fields) {
        let folder = tempfile::tempdir().expect("a scratch folder");
        self.write(folder.path());
        let output = zelus(folder.path(), &["run", DECK, "--threads", "1"]);
        let field = |name: &str| {
            let Ok(results) = Results::read(&folder.path().join("results.json")) else { return Vec::new() };
            let last = results.len() - 1;
            let columns = ["X", "Y", "Z"].map(|letter| results.nodal(&format!("{name}_{letter}"), last));
            let node = |at: usize| columns.each_ref().map(|of| of.get(&(at as u64 + 1)).copied().unwrap_or(0.0));
            (0..self.mesh.nodes.len()).map(node).collect()
        };
        let fields = Fields { displacement: field("DISPLACEMENT"), reaction: field("REACTION") };
        (output.status.code(), said(&output), fields)
    }

    /// The fields of a run that must end with 0.
    pub fn results(&self) -> Fields {
        let (status, said, fields) = self.run();
        assert_eq!(status, Some(0), "{said}");
        fields
    }

    /// Nodes at a place, numbered from 1.
    pub fn nodes_at(&self, place: Vec3) -> Vec<usize> {
        let close = |x: &Vec3| x.iter().zip(place).all(|(a, b)| (a - b).abs() < 1e-9);
        (1..=self.mesh.nodes.len()).filter(|&node| close(&self.mesh.nodes[node - 1])).collect()
    }
}

/// Of the last step, by node.
pub struct Fields {
    pub displacement: Vec<Vec3>,
    pub reaction: Vec<Vec3>,
}

impl Fields {
    /// Sum of the reactions of nodes, numbered from 1.
    pub fn force(&self, nodes: &[usize]) -> Vec3 {
        std::array::from_fn(|c| nodes.iter().map(|&node| self.reaction[node - 1][c]).sum())
    }
}

/// All sides of a block together.
pub fn all_nodes(sides: &Sides) -> Vec<usize> {
    let mut nodes: Vec<usize> = sides.values().flat_map(|side| side.0.clone()).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

pub fn held(space: usize) -> [Value; 3] {
    std::array::from_fn(|c| if c < space { json!(0.0) } else { Value::Null })
}

pub fn turned(angle: f64) -> impl Fn(Vec3) -> Vec3 {
    let (sin, cos) = angle.sin_cos();
    move |[x, y, z]| [cos * x - sin * y, sin * x + cos * y, z]
}

/// A block in a rigid die with walls around it, pressed from above: uniaxial strain.
pub fn die(space: usize, angle: f64, size: f64, kind: Kind, block_is_slave: bool) -> (Scene, Vec<usize>) {
    let mut scene = Scene::new(space);
    (scene.kind, scene.young) = (kind, 1e3 / (size * size));
    let up = space - 1;
    let turn = turned(angle);
    let place = move |x: Vec3| turn(x.map(|c| size * c));
    let zero = |mut x: Vec3| {
        if space == 2 {
            x[2] = 0.0;
        }
        x
    };
    let block = scene.add("Block", [[0.0; 3], zero([2.0; 3])], 4, &place);
    let lateral: Vec<(usize, usize)> = (0..up).flat_map(|axis| [(axis, 0), (axis, 1)]).collect();
    let skin: Vec<(usize, usize)> = lateral.iter().copied().chain([(up, 0)]).collect();
    scene.part("Skin", &block, &skin);
    let down: Vec3 = std::array::from_fn(|c| if c == up { -1.0 } else { 0.0 });
    let down = turned(angle)(down).map(|c| c / (size * size));
    scene.load("Top", &block, (up, 1), down);
    let (mut nodes, mut facets) = (Vec::new(), Vec::new());
    let names = ["Floor", "West", "East", "South", "North"];
    for (name, (axis, end)) in names.into_iter().zip([(up, 0)].into_iter().chain(lateral)) {
        // A die that is the slave ends where the block does: a slave node beside the block would be in no contact.
        let beyond = if block_is_slave { 1.0 } else { 0.0 };
        let (mut low, mut high) = ([-beyond; 3], [2.0 + beyond; 3]);
        if axis != up {
            low[up] = 0.0;
        }
        (low[axis], high[axis]) = [(-1.0, 0.0), (2.0, 3.0)][end];
        let body = scene.add(name, [zero(low), zero(high)], 5, &place);
        nodes.extend(&body[&(axis, 1 - end)].0);
        facets.extend(&body[&(axis, 1 - end)].1);
        scene.supports.push((name, held(space)));
    }
    scene.mesh.part("Die", nodes, facets);
    scene.pairs.push(if block_is_slave { ["Skin", "Die"] } else { ["Die", "Skin"] });
    let nodes = all_nodes(&block);
    (scene, nodes)
}

/// The block of the corner tests, on a floor and beside a wall that is a body of its own.
pub struct Corner {
    pub scene: Scene,
    pub floor: Vec<usize>,
    pub wall: Vec<usize>,
}

/// A block of 2 × 2 on a floor and at a wall; cells of floor and wall are `fine` to a side, those of the block 4.
pub fn corner(fine: usize) -> Corner {
    let mut scene = Scene::new(2);
    scene.poisson = 0.0;
    let still = |x: Vec3| x;
    let block = scene.add("Block", [[0.0; 3], [2.0, 2.0, 0.0]], 4, &still);
    scene.part("Bottom", &block, &[(1, 0)]);
    scene.part("Left", &block, &[(0, 0)]);
    scene.part("Right", &block, &[(0, 1)]);
    scene.part("Top", &block, &[(1, 1)]);
    let floor = scene.add("Floor", [[0.0, -1.0, 0.0], [2.0, 0.0, 0.0]], fine, &still);
    scene.part("FloorTop", &floor, &[(1, 1)]);
    scene.part("FloorBase", &floor, &[(1, 0)]);
    let wall = scene.add("Wall", [[-1.0, 0.0, 0.0], [0.0, 2.0, 0.0]], fine, &still);
    scene.part("WallFace", &wall, &[(0, 1)]);
    scene.part("WallBack", &wall, &[(0, 0)]);
    scene.supports = vec![("FloorBase", held(2)), ("WallBack", held(2))];
    let (floor, wall) = (floor[&(1, 0)].0.clone(), wall[&(0, 0)].0.clone());
    scene.loads = Vec::new();
    let right = block[&(0, 1)].1.clone();
    let top = block[&(1, 1)].1.clone();
    scene.loaded = [right, top].concat();
    Corner { scene, floor, wall }
}
