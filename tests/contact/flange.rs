//! A flange of eight bolts with clearance, tightened and then lifted and twisted, and one sector of it with cyclic symmetry (ANALYTIC: both
//! are one problem). Contact between the rings reaches the sides of the sector, whose multipliers follow each other.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use crate::thread_ranks::on_threads;
use serde_json::{Value, json};
use zelus::core::communication::Ranks;
use zelus::{RunOptions, RunReport, Silent, Simulation};

type Vec3 = [f64; 3];

const BOLTS: usize = 8;
/// Cells along the radius, around a sector and through a ring.
const CELLS: [usize; 3] = [5, 4, 2];
/// Cells of the bolt among them.
const BOLT: [[usize; 2]; 2] = [[2, 3], [1, 3]];
const RADII: [f64; 2] = [20.0, 40.0];
const HEIGHT: f64 = 8.0;

/// Lower ring, upper ring, bolt.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Body {
    Lower,
    Upper,
    Bolt,
}

#[derive(Default)]
struct Mesh {
    known: BTreeMap<(Body, [usize; 3]), usize>,
    nodes: Vec<Vec3>,
    elements: Vec<[usize; 8]>,
    conditions: Vec<[usize; 4]>,
    /// Nodes, elements and conditions by part.
    parts: BTreeMap<String, [Vec<usize>; 3]>,
    /// Sectors that it has.
    sectors: usize,
}

impl Mesh {
    /// Node of a body at its place in the grid; heads are one with the rings.
    fn node(&mut self, body: Body, [i, j, k]: [usize; 3]) -> usize {
        let around = CELLS[1] * BOLTS;
        let key = match (body, k) {
            (Body::Bolt, 0) => (Body::Lower, [i, j % around, 0]),
            (Body::Bolt, k) if k == 2 * CELLS[2] => (Body::Upper, [i, j % around, CELLS[2]]),
            _ => (body, [i, j % around, k]),
        };
        let radius = RADII[0] + (RADII[1] - RADII[0]) * i as f64 / CELLS[0] as f64;
        let angle = TAU * (j % around) as f64 / around as f64;
        let base = if body == Body::Upper { 0.0 } else { -HEIGHT };
        let place = [radius * angle.cos(), radius * angle.sin(), base + HEIGHT * k as f64 / CELLS[2] as f64];
        *self.known.entry(key).or_insert_with(|| {
            self.nodes.push(place);
            self.nodes.len()
        })
    }

    fn face(&mut self, body: Body, [i, j, k]: [usize; 3], down: bool) -> [usize; 4] {
        let mut corners = [[i, j, k], [i + 1, j, k], [i + 1, j + 1, k], [i, j + 1, k]];
        if down {
            corners.swap(1, 3);
        }
        corners.map(|at| self.node(body, at))
    }

    fn element(&mut self, body: Body, [i, j, k]: [usize; 3], part: &str) {
        let [low, high] = [k, k + 1].map(|k| self.face(body, [i, j, k], false));
        let nodes: [usize; 8] = std::array::from_fn(|n| if n < 4 { low[n] } else { high[n - 4] });
        self.elements.push(nodes);
        let own = self.parts.entry(part.to_owned()).or_default();
        own[0].extend(nodes);
        own[1].push(self.elements.len());
    }

    fn condition(&mut self, nodes: [usize; 4], parts: &[&str]) {
        self.conditions.push(nodes);
        for &part in parts {
            let own = self.parts.entry(part.to_owned()).or_default();
            own[0].extend(nodes);
            own[2].push(self.conditions.len());
        }
    }

    fn new(sectors: usize) -> Self {
        let mut mesh = Self { sectors, ..Self::default() };
        let [radial, around, through] = CELLS;
        for (j, i) in (0..around * sectors).flat_map(|j| (0..radial).map(move |i| (j, i))) {
            let is_bolt = (BOLT[0][0]..BOLT[0][1]).contains(&i) && (BOLT[1][0]..BOLT[1][1]).contains(&(j % around));
            if is_bolt {
                let name = format!("Bolt{}", j / around);
                (0..2 * through).for_each(|k| mesh.element(Body::Bolt, [i, j, k], &name));
                continue;
            }
            for k in 0..through {
                mesh.element(Body::Lower, [i, j, k], "Rings");
                mesh.element(Body::Upper, [i, j, k], "Rings");
            }
            let (slave, master) =
                (mesh.face(Body::Lower, [i, j, through], false), mesh.face(Body::Upper, [i, j, 0], true));
            mesh.condition(slave, &["Slave", "Contact"]);
            mesh.condition(master, &["Contact"]);
            if i == 0 {
                let lifted = mesh.face(Body::Upper, [i, j, through], false);
                mesh.condition(lifted, &["Lift"]);
            }
        }
        let mut select = |name: &str, wanted: &dyn Fn(Body, [usize; 3]) -> bool| {
            let nodes = mesh.known.iter().filter(|((body, at), _)| wanted(*body, *at)).map(|(_, &node)| node).collect();
            mesh.parts.insert(name.to_owned(), [nodes, Vec::new(), Vec::new()]);
        };
        select("Base", &|body, [i, _, k]| body == Body::Lower && k == 0 && i <= 1);
        select("Rim", &|body, [i, ..]| body == Body::Upper && i == radial);
        select("SideA", &|_, [_, j, _]| j == 0);
        select("SideB", &|_, [_, j, _]| j == around);
        mesh
    }

    fn text(&self) -> String {
        let mut out = String::from("Begin Properties 1\nEnd Properties\nBegin Nodes\n");
        for (at, [x, y, z]) in self.nodes.iter().enumerate() {
            let _ = writeln!(out, "{} {x:?} {y:?} {z:?}", at + 1);
        }
        let list = |ids: &[usize], between: &str| ids.iter().map(usize::to_string).collect::<Vec<_>>().join(between);
        out.push_str("End Nodes\nBegin Elements SmallDisplacementElement3D8N\n");
        for (at, nodes) in self.elements.iter().enumerate() {
            let _ = writeln!(out, "{} 1 {}", at + 1, list(nodes, " "));
        }
        out.push_str("End Elements\nBegin Conditions SurfaceLoadCondition3D4N\n");
        for (at, nodes) in self.conditions.iter().enumerate() {
            let _ = writeln!(out, "{} 1 {}", at + 1, list(nodes, " "));
        }
        out.push_str("End Conditions\n");
        for (name, members) in &self.parts {
            let _ = writeln!(out, "Begin SubModelPart {name}");
            for (kind, ids) in ["Nodes", "Elements", "Conditions"].iter().zip(members) {
                let mut ids = ids.clone();
                ids.sort_unstable();
                ids.dedup();
                let _ = writeln!(out, "Begin SubModelPart{kind}\n{}\nEnd SubModelPart{kind}", list(&ids, "\n"));
            }
            out.push_str("End SubModelPart\n");
        }
        out
    }

    /// Tightens the bolts at t = 1; at t = 2 the upper ring is lifted inside and its rim is turned.
    fn write(&self, folder: &Path, friction: bool) {
        let process = |name: &str, settings: Value| json!({"python_module": name, "Parameters": settings});
        let fix = |part: &str, value: Value| {
            let settings = json!({"model_part_name": format!("Structure.{part}"), "variable_name": "DISPLACEMENT",
                "constrained": value.as_array().expect("three").iter().map(|v| !v.is_null()).collect::<Vec<_>>(),
                "value": value, "interval": [0.0, "End"]});
            process("assign_vector_variable_process", settings)
        };
        let mut processes = vec![fix("Base", json!([0.0, 0.0, 0.0]))];
        for bolt in 0..self.sectors {
            let settings = json!({"model_part_name": format!("Structure.Bolt{bolt}"), "point": [0.0, 0.0, 4.0],
                "normal": [0.0, 0.0, 1.0], "force": "4000*t", "interval": [0.0, 1.5]});
            processes.push(process("bolt_pretension_process", settings));
        }
        let lift = json!({"model_part_name": "Structure.Lift", "variable_name": "SURFACE_LOAD",
            "value": [0.0, 0.0, "6*(t-1)"], "interval": [1.5, "End"]});
        processes.push(process("assign_vector_variable_to_conditions_process", lift));
        if friction {
            processes.push(fix("Rim", json!(["-2e-5*Y*t", "2e-5*X*t", null])));
        }
        if self.sectors < BOLTS {
            let turn = json!({"axis_of_rotation": [0.0, 0.0, 1.0], "angle_degree": 360.0 / BOLTS as f64});
            let settings = json!({"model_part_name": "Structure", "first_model_part_name": "SideA",
                "second_model_part_name": "SideB", "variable_names": ["DISPLACEMENT"],
                "transformation_settings": {"rotation_settings": turn}});
            processes.push(process("apply_periodic_condition_process", settings));
        }
        let kind = if friction { "Frictional" } else { "Frictionless" };
        let contact = json!({"model_part_name": "Structure", "contact_model_part": {"0": ["Contact"]},
            "assume_master_slave": {"0": ["Slave"]}, "contact_type": kind, "friction_coefficients": {"0": 0.2}});
        processes.push(process("alm_contact_process", contact));
        let output = json!({"output_file_name": "results.json", "model_part_name": "Structure", "time_frequency": 0.0,
            "output_variables": ["DISPLACEMENT"]});
        processes.push(process("json_output_process", output));
        let tight: serde_json::Map<String, Value> = [
            ("mortar_type".to_owned(), json!(format!("ALMContact{kind}"))),
            ("contact_residual_relative_tolerance".to_owned(), json!(1e-8)),
        ]
        .into_iter()
        .collect();
        let solver = json!({"solver_type": "Static", "model_part_name": "Structure", "domain_size": 3, "echo_level": 0,
            "analysis_type": "non_linear", "time_stepping": {"time_step": 1.0}, "contact_settings": tight,
            "residual_relative_tolerance": 1e-8,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
            "material_import_settings": {"materials_filename": "materials.json"}});
        let deck = json!({"problem_data": {"problem_name": "flange", "parallel_type": "OpenMP", "echo_level": 0,
            "start_time": 0.0, "end_time": 2.0}, "solver_settings": solver, "processes": {"list": processes}});
        let material = json!({"properties": [{"model_part_name": "Structure", "properties_id": 1, "Material": {
            "constitutive_law": {"name": "LinearElastic3DLaw"},
            "Variables": {"YOUNG_MODULUS": 2.1e5, "POISSON_RATIO": 0.3}, "Tables": {}}}]});
        let write = |name: &str, text: String| std::fs::write(folder.join(name), text).expect("a file");
        write("ProjectParameters.json", deck.to_string());
        write("materials.json", material.to_string());
        write("mesh.mdpa", self.text());
    }

    /// Displacements by step and node, and the report.
    fn run(&self, friction: bool) -> (Vec<Vec<Vec3>>, RunReport) {
        let folder = tempfile::tempdir().expect("a scratch folder");
        self.write(folder.path(), friction);
        let mut simulation = Simulation::open(&folder.path().join("ProjectParameters.json"), &RunOptions::default())
            .expect("a deck that opens");
        simulation.run(&mut Silent).expect("a converged run");
        let text = std::fs::read_to_string(folder.path().join("results.json")).expect("results");
        let results: Value = serde_json::from_str(&text).expect("JSON");
        let value = |node: usize, axis: &str, step: usize| {
            results[format!("NODE_{}", node + 1)][format!("DISPLACEMENT_{axis}")][step].as_f64().expect("a number")
        };
        let of_step =
            |step| (0..self.nodes.len()).map(|node| ["X", "Y", "Z"].map(|axis| value(node, axis, step))).collect();
        ((0..2).map(of_step).collect(), simulation.into_report())
    }
}

#[test]
fn a_sector_of_a_bolted_flange_moves_as_the_whole() {
    let (sector, whole) = (Mesh::new(1), Mesh::new(BOLTS));
    for friction in [false, true] {
        let (of_sector, report) = sector.run(friction);
        let (of_whole, of_all) = whole.run(friction);
        let said = &report.warnings;
        assert!(!said.iter().any(|warning| warning.contains("redundant")), "{said:?}");
        for step in 0..2 {
            let (mut most, mut size) = (0.0_f64, 0.0_f64);
            for (key, &node) in &sector.known {
                let [own, same] = [of_sector[step][node - 1], of_whole[step][whole.known[key] - 1]];
                for c in 0..3 {
                    most = most.max((own[c] - same[c]).abs());
                    size = size.max(same[c].abs());
                }
            }
            println!("friction {friction}, step {step}: {:.1e}", most / size);
            assert!(most < 1e-8 * size, "friction {friction}, step {step}: {most:.2e} of {size:.2e}");
        }
        let force = |report: &RunReport| {
            let numbers = &report.steps[1].interactions;
            numbers.iter().find(|(name, _)| name == "force of bolt Structure.Bolt0").expect("a force").1
        };
        let [own, all] = [force(&report), force(&of_all)];
        assert!((own / all - 1.0).abs() < 1e-8 && (own / 4000.0 - 1.0).abs() < 0.05, "{own} and {all}");
    }
}

/// Displacements at the end by id of node, on one of the ranks that share the run.
fn of_rank(folder: &Path, ranks: Ranks) -> BTreeMap<usize, Vec3> {
    let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
    let mut simulation = Simulation::open(&folder.join("ProjectParameters.json"), &options).expect("a deck that opens");
    simulation.run(&mut Silent).expect("a converged run");
    let ids = &simulation.part().expect("a part").nodes.ids;
    let field = simulation.field("DISPLACEMENT").expect("a field").chunks_exact(3);
    ids.iter().zip(field).map(|(&id, u)| (id, [u[0], u[1], u[2]])).collect()
}

#[test]
fn ranks_share_a_sector() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    Mesh::new(1).write(folder.path(), true);
    let alone = of_rank(folder.path(), Ranks::default());
    let size = alone.values().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
    for count in [2, 3] {
        for found in on_threads(count, |ranks| of_rank(folder.path(), ranks)) {
            let off = found.iter().flat_map(|(id, u)| u.iter().zip(alone[id]).map(|(a, b)| (a - b).abs()));
            let most = off.fold(0.0, f64::max) / size;
            assert!(most < 1e-9, "{count} ranks: {most:.1e}");
        }
    }
}
