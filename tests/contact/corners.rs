//! Mesh nodes on two faces of a body: corners that are pressed into corners, ties and pairs that meet at a node, edges on flats.

use std::path::Path;

use serde_json::{Map, Value, json};

use crate::blocks::{Mesh, Sides, Vec3};
use crate::support::{Results, said, zelus};

const DECK: &str = "ProjectParameters.json";

/// How a part of a deck presses: a condition of contact and the process that makes it.
type Kind = (&'static str, &'static str);
const FRICTIONLESS: Kind = ("ALMContactFrictionless", "Frictionless");
const COMPONENTS: Kind = ("ALMContactFrictionlessComponents", "FrictionlessComponents");

/// Bodies that touch and are tied.
struct Scene {
    mesh: Mesh,
    bodies: Vec<&'static str>,
    /// Parts that do not move, and those that are moved.
    supports: Vec<(&'static str, [Value; 3])>,
    /// Parts with tractions (stress).
    loads: Vec<(&'static str, Vec3)>,
    loaded: Vec<usize>,
    /// Slave and master of pairs and of ties.
    pairs: Vec<[&'static str; 2]>,
    ties: Vec<[&'static str; 2]>,
    kind: Kind,
    steps: usize,
    young: f64,
    poisson: f64,
}

impl Scene {
    fn new(space: usize) -> Self {
        Self {
            mesh: Mesh::new(space),
            bodies: Vec::new(),
            supports: Vec::new(),
            loads: Vec::new(),
            loaded: Vec::new(),
            pairs: Vec::new(),
            ties: Vec::new(),
            kind: FRICTIONLESS,
            steps: 1,
            young: 1e3,
            poisson: 0.3,
        }
    }

    /// A box between two corners, each place moved by `place` at last.
    fn add(&mut self, name: &'static str, [low, high]: [Vec3; 2], count: usize, place: &dyn Fn(Vec3) -> Vec3) -> Sides {
        self.bodies.push(name);
        self.mesh.block(name, [count; 3], |x| {
            place(std::array::from_fn(|c| if c < 3 { low[c] + (high[c] - low[c]) * x[c] } else { 0.0 }))
        })
    }

    /// A part of some sides.
    fn part(&mut self, name: &str, sides: &Sides, of: &[(usize, usize)]) {
        let nodes: Vec<usize> = of.iter().flat_map(|side| sides[side].0.clone()).collect();
        let facets: Vec<usize> = of.iter().flat_map(|side| sides[side].1.clone()).collect();
        self.mesh.part(name, nodes, facets);
    }

    /// A part of one side that carries a traction.
    fn load(&mut self, name: &'static str, sides: &Sides, side: (usize, usize), traction: Vec3) {
        self.part(name, sides, &[side]);
        self.loaded.extend(&sides[&side].1);
        self.loads.push((name, traction));
    }

    fn write(&self, folder: &Path) {
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
            contact.push(process("alm_contact_process", parameters));
            (mortar, criterion) = (self.kind.0, "contact_residual_criterion");
        }
        let deck = json!({
            "problem_data": {"problem_name": "corners", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1.0},
            "solver_settings": {"solver_type": "Static", "model_part_name": "Structure", "domain_size": space,
                "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
                "material_import_settings": {"materials_filename": "StructuralMaterials.json"},
                "time_stepping": {"time_step": 1.0 / self.steps as f64}, "convergence_criterion": criterion,
                "residual_relative_tolerance": 1e-9, "contact_settings": {"mortar_type": mortar}},
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

    /// Runs the deck; exit code and what is said, and of the last step the fields by node.
    fn run(&self) -> (Option<i32>, String, Fields) {
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
    fn results(&self) -> Fields {
        let (status, said, fields) = self.run();
        assert_eq!(status, Some(0), "{said}");
        fields
    }

    /// Nodes at a place, numbered from 1.
    fn nodes_at(&self, place: Vec3) -> Vec<usize> {
        let close = |x: &Vec3| x.iter().zip(place).all(|(a, b)| (a - b).abs() < 1e-9);
        (1..=self.mesh.nodes.len()).filter(|&node| close(&self.mesh.nodes[node - 1])).collect()
    }
}

/// Of the last step, by node.
struct Fields {
    displacement: Vec<Vec3>,
    reaction: Vec<Vec3>,
}

impl Fields {
    /// Sum of the reactions of nodes, numbered from 1.
    fn force(&self, nodes: &[usize]) -> Vec3 {
        std::array::from_fn(|c| nodes.iter().map(|&node| self.reaction[node - 1][c]).sum())
    }
}

/// All sides of a block together.
fn all_nodes(sides: &Sides) -> Vec<usize> {
    let mut nodes: Vec<usize> = sides.values().flat_map(|side| side.0.clone()).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

fn held(space: usize) -> [Value; 3] {
    std::array::from_fn(|c| if c < space { json!(0.0) } else { Value::Null })
}

fn turned(angle: f64) -> impl Fn(Vec3) -> Vec3 {
    let (sin, cos) = angle.sin_cos();
    // About the last axis of the plane, and about x too in space: no face lies along an axis.
    move |[x, y, z]| [cos * x - sin * y, sin * x + cos * y, z]
}

fn close(found: f64, right: f64, tolerance: f64, what: &str) {
    assert!((found - right).abs() <= tolerance, "{what}: {found:e} in place of {right:e}");
}

/// A block in a rigid die with walls around it, pressed from above: uniaxial strain.
fn die(space: usize, angle: f64, size: f64, kind: Kind, block_is_slave: bool) {
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
        let (mut low, mut high) = ([-1.0; 3], [3.0; 3]);
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
    let fields = scene.results();
    let (nu, young) = (scene.poisson, scene.young);
    let shortening = (1.0 + nu) * (1.0 - 2.0 * nu) / ((1.0 - nu) * young) / (size * size);
    for node in all_nodes(&block) {
        let x = turned(-angle)(scene.mesh.nodes[node - 1]);
        let u = turned(-angle)(fields.displacement[node - 1]);
        for c in 0..space {
            let right = if c == up { -shortening * x[up] } else { 0.0 };
            let what = format!("{kind:?} in {space} dimensions, turned by {angle}, size {size}: u[{c}] of node {node}");
            close(u[c], right, 1e-6 * 2.0 * size * shortening, &what);
        }
    }
}

/// ANALYTIC: uniaxial strain, u = −σ (1 + ν)(1 − 2ν) / (E (1 − ν)) y. Linear elements hold it exactly; the tolerance is that of
/// Newton's iteration.
#[test]
fn a_block_in_a_die_is_in_uniaxial_strain() {
    for kind in [FRICTIONLESS, COMPONENTS] {
        die(2, 0.0, 1.0, kind, true);
    }
    die(2, 0.0, 1.0, FRICTIONLESS, false);
    die(2, 0.7, 1.0, FRICTIONLESS, true);
    die(2, 0.0, 1e-3, FRICTIONLESS, true);
    die(3, 0.0, 1.0, FRICTIONLESS, true);
    die(3, 0.5, 1.0, FRICTIONLESS, true);
}

/// The block of the corner tests, on a floor and beside a wall that is a body of its own.
struct Corner {
    scene: Scene,
    floor: Vec<usize>,
    wall: Vec<usize>,
}

/// A block of 2 × 2 on a floor and at a wall; cells of floor and wall are `fine` to a side, those of the block 4.
fn corner(fine: usize) -> Corner {
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

/// ANALYTIC: equilibrium. Without friction the floor carries what presses down and the wall what presses sideways. Tolerance:
/// forces follow the deformed faces, which turn by 1e-3.
#[test]
fn floor_and_wall_share_the_load_of_a_corner() {
    for pairs in [
        vec![["Bottom", "FloorTop"], ["Left", "WallFace"]],
        vec![["FloorTop", "Bottom"], ["WallFace", "Left"]],
        vec![["Bottom", "FloorTop"], ["WallFace", "Left"]],
    ] {
        let Corner { mut scene, floor, wall } = corner(5);
        scene.loads = vec![("Top", [0.0, -1.0, 0.0]), ("Right", [-0.5, 0.0, 0.0])];
        (scene.pairs, scene.steps) = (pairs.clone(), 2);
        let fields = scene.results();
        for (nodes, right) in [(&floor, [0.0, 2.0]), (&wall, [1.0, 0.0])] {
            let force = fields.force(nodes);
            (0..2).for_each(|c| close(force[c], right[c], 2e-3, &format!("{pairs:?}: force {force:?}")));
        }
    }
}

/// ANALYTIC: equilibrium, as above. The floor and the wall are one body with a corner in its face.
#[test]
fn a_block_sits_in_the_corner_of_a_bracket() {
    let mut scene = Scene::new(2);
    scene.poisson = 0.0;
    let block = scene.add("Block", [[0.0; 3], [2.0, 2.0, 0.0]], 4, &|x| x);
    scene.part("Faces", &block, &[(0, 0), (1, 0)]);
    scene.load("Top", &block, (1, 1), [0.0, -1.0, 0.0]);
    scene.load("Right", &block, (0, 1), [-0.5, 0.0, 0.0]);
    // A strip that turns at half of its length: from the wall over the corner to the floor.
    let bend = |[s, t, _]: Vec3| {
        let along = 1.0 - 2.0 * s;
        let (inner, outer) = (3.0 * along.abs(), 4.0 * along.abs() - 1.0);
        let (far, off) = (inner * t + outer * (1.0 - t), t - 1.0);
        if along > 0.0 { [off, far, 0.0] } else { [far, off, 0.0] }
    };
    scene.bodies.push("Bracket");
    let bracket = scene.mesh.block("Bracket", [12, 3, 1], bend);
    scene.part("Inside", &bracket, &[(1, 1)]);
    scene.part("Outside", &bracket, &[(1, 0)]);
    scene.supports = vec![("Outside", held(2))];
    for pair in [["Faces", "Inside"], ["Inside", "Faces"]] {
        (scene.pairs, scene.steps) = (vec![pair], 2);
        let force = scene.results().force(&bracket[&(1, 0)].0);
        [1.0, 2.0].into_iter().enumerate().for_each(|(c, right)| close(force[c], right, 3e-3, &format!("{pair:?}")));
    }
}

/// Both ties hold at the node they share. ANALYTIC: with cells that match, ties are those of one body, whichever side is the
/// slave, and the corners of the three bodies move together.
#[test]
fn a_corner_may_be_tied_to_two_bodies() {
    let run = |pairs: [[&'static str; 2]; 2], fine: usize| {
        let Corner { mut scene, floor, wall } = corner(fine);
        scene.loads = vec![("Right", [1.0, 0.0, 0.0])];
        scene.ties = pairs.to_vec();
        let fields = scene.results();
        let moved: Vec<Vec3> = scene.nodes_at([0.0; 3]).iter().map(|node| fields.displacement[node - 1]).collect();
        (moved, fields.force(&floor)[0], fields.force(&wall)[0])
    };
    let block = [["Bottom", "FloorTop"], ["Left", "WallFace"]];
    let others = [["FloorTop", "Bottom"], ["WallFace", "Left"]];
    let (moved, floor, wall) = run(block, 4);
    let (same, same_floor, same_wall) = run(others, 4);
    assert_eq!((moved.len(), same.len()), (3, 3));
    for u in moved.iter().chain(&same) {
        (0..2).for_each(|c| close(u[c], moved[0][c], 1e-9 * 5e-4, "the corner"));
    }
    close(floor, same_floor, 1e-8, "the floor");
    close(wall, same_wall, 1e-8, "the wall");
    close(floor + wall, -2.0, 1e-8, "both");
    // Cells that do not match tie means: EXTERNAL, the other choice of slaves, within what the mesh tells apart.
    let (moved, floor, _) = run(block, 5);
    let (same, same_floor, _) = run(others, 5);
    for u in moved.iter().chain(&same) {
        (0..2).for_each(|c| close(u[c], same[0][c], 0.02 * same[0][0], "the corner"));
    }
    close(floor, same_floor, 2e-3 * floor.abs(), "the floor");
}

/// ANALYTIC: equilibrium. What is tied to the floor and leaves the wall hangs on the floor alone; nothing is in anything, however
/// large the load.
#[test]
fn a_tie_and_an_open_pair_meet_at_a_corner() {
    for kind in [FRICTIONLESS, COMPONENTS] {
        for load in [1.0, 1e-6] {
            let Corner { mut scene, floor, wall } = corner(5);
            scene.loads = vec![("Right", [load, 0.0, 0.0])];
            (scene.ties, scene.pairs) = (vec![["Bottom", "FloorTop"]], vec![["Left", "WallFace"]]);
            scene.kind = kind;
            let fields = scene.results();
            let (floor, wall) = (fields.force(&floor), fields.force(&wall));
            close(floor[0], -2.0 * load, 1e-6 * load, &format!("{kind:?}: floor {floor:?}"));
            (0..2).for_each(|c| close(wall[c], 0.0, 1e-8 * load, &format!("{kind:?}: wall {wall:?}")));
        }
    }
}

/// ANALYTIC: equilibrium. The same corner pressed on the wall: floor and wall carry the load together, and the tie holds.
#[test]
fn a_tie_and_a_closed_pair_meet_at_a_corner() {
    for kind in [FRICTIONLESS, COMPONENTS] {
        let Corner { mut scene, floor, wall } = corner(5);
        scene.loads = vec![("Right", [-1.0, 0.0, 0.0])];
        (scene.ties, scene.pairs) = (vec![["Bottom", "FloorTop"]], vec![["Left", "WallFace"]]);
        scene.kind = kind;
        let fields = scene.results();
        let (floor, wall) = (fields.force(&floor), fields.force(&wall));
        close(floor[0] + wall[0], 2.0, 1e-6, &format!("{kind:?}: {floor:?} {wall:?}"));
        close(wall[1], 0.0, 2e-3, &format!("{kind:?}: wall {wall:?}"));
        assert!(wall[0] > 1.0 && floor[0] > 0.0, "{kind:?}: {floor:?} {wall:?}");
        let corner: Vec<Vec3> = scene.nodes_at([0.0; 3]).iter().map(|node| fields.displacement[node - 1]).collect();
        (0..2).for_each(|c| close(corner[0][c], corner[1][c], 0.05 * 1e-3, &format!("{kind:?}: corner {corner:?}")));
    }
}

/// A block turned by `angle` whose lowest edge is pressed into a flat one. `slave` and `master` are "Face", the block's lower face,
/// "Skin", its lower faces on both sides of the edge, and "Flat".
fn edge_on_flat(space: usize, angle: f64, [slave, master]: [&'static str; 2], steps: usize) -> (Scene, Vec<usize>) {
    let mut scene = Scene::new(space);
    scene.steps = steps;
    let height = |x: f64| if space == 2 { 0.0 } else { x };
    let (low, high) = ([0.0, 0.0, 0.0], [2.0, 1.0, height(1.0)]);
    let flat = scene.add("Lower", [low, high], 4, &|x| x);
    let turn = turned(angle);
    let edge = [0.9, 1.0];
    let place = |x: Vec3| {
        let [a, b, z] = turn(x);
        [edge[0] + a, edge[1] + b, z]
    };
    let block = scene.add("Upper", [[0.0; 3], [0.8, 0.8, height(1.0)]], 3, &place);
    scene.part("Flat", &flat, &[(1, 1)]);
    scene.part("Base", &flat, &[(1, 0)]);
    scene.part("Face", &block, &[(1, 0)]);
    scene.part("Skin", &block, &[(0, 0), (1, 0)]);
    scene.part("Head", &block, &[(1, 1)]);
    scene.pairs = vec![[slave, master]];
    let down = std::array::from_fn(|c| if c >= space { Value::Null } else { json!(0.0) });
    let mut moved = down.clone();
    moved[1] = json!("-0.03*t");
    scene.supports = vec![("Base", down), ("Head", moved)];
    (scene, flat[&(1, 0)].0.clone())
}

/// ANALYTIC: without friction the force is normal to the flat face, whose middle the pressed edge indents evenly enough.
#[test]
fn an_edge_presses_along_the_normal_of_a_flat() {
    for (space, angle) in [(2, 0.5), (2, 1.1), (3, 0.5)] {
        for slave in ["Face", "Skin"] {
            let (scene, base) = edge_on_flat(space, angle, [slave, "Flat"], 4);
            let force = scene.results().force(&base);
            assert!(force[1] > 0.1, "{space} {angle} {slave}: {force:?}");
            let share = force[0].abs().max(force[2].abs()) / force[1];
            assert!(share < 0.02, "{space} {angle} {slave}: {share:e} of the force is tangential");
        }
    }
}

/// With the flat as the slave its nodes do not see the edge between them: no such state is a result.
#[test]
fn an_edge_between_the_nodes_of_a_slave_is_refused() {
    for steps in [1, 4] {
        let (scene, _) = edge_on_flat(2, 0.5, ["Flat", "Face"], steps);
        let (status, said, _) = scene.run();
        assert_eq!(status, Some(3), "{said}");
        let words = ["at an edge of a master", "slave facet", "assume_master_slave"];
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    }
}
