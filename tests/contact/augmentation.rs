//! Contact of unlike curved meshes: it converges with default settings, quadratically, and its solution does not depend on the
//! penalties of a deck (ANALYTIC: the equations of a node do not contain them).

use crate::support::{Results, said, zelus};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

type Point = [f64; 3];

/// Two bodies, each a grid of layers between a held and a touching surface.
struct Mesh {
    space: usize,
    nodes: Vec<Point>,
    elements: Vec<Vec<usize>>,
    /// Facets of the inner and of the outer body that face each other.
    facets: [Vec<Vec<usize>>; 2],
    /// The far surface of each body.
    held: [Vec<usize>; 2],
}

/// Angles of a ring of `count` segments, some of which are longer than others where it is `uneven`.
fn ring_angle(at: usize, count: usize, phase: f64, uneven: f64) -> f64 {
    let share = (at % count) as f64 / count as f64;
    2.0 * PI * (share + uneven * (2.0 * PI * 3.0 * share).sin() / count as f64) + phase
}

/// A ring in a ring of the same radius, with these numbers of segments.
fn rings(segments: [usize; 2], uneven: f64) -> Mesh {
    let mut mesh = Mesh {
        space: 2,
        nodes: Vec::new(),
        elements: Vec::new(),
        facets: Default::default(),
        held: Default::default(),
    };
    let layers = 2;
    for (body, &count) in segments.iter().enumerate() {
        let (first, inner) = (mesh.nodes.len() + 1, [0.5, 1.0][body]);
        for layer in 0..=layers {
            let radius = inner + 0.5 * layer as f64 / layers as f64;
            mesh.nodes.extend((0..count).map(|i| {
                let angle = ring_angle(i, count, 0.1 * body as f64, uneven);
                [radius * angle.cos(), radius * angle.sin(), 0.0]
            }));
        }
        let node = |layer: usize, i: usize| first + layer * count + i % count;
        for layer in 0..layers {
            mesh.elements.extend(
                (0..count)
                    .map(|i| vec![node(layer, i), node(layer + 1, i), node(layer + 1, i + 1), node(layer, i + 1)]),
            );
        }
        let (touching, far) = if body == 0 { (layers, 0) } else { (0, layers) };
        mesh.facets[body] = (0..count)
            .map(|i| {
                if body == 0 {
                    vec![node(touching, i), node(touching, i + 1)]
                } else {
                    vec![node(touching, i + 1), node(touching, i)]
                }
            })
            .collect();
        mesh.held[body] = (0..count).map(|i| node(far, i)).collect();
    }
    mesh
}

/// Part of a ball in part of a socket of the same radius; the second grid is turned against the first.
fn ball(pieces: [usize; 2]) -> Mesh {
    let mut mesh = Mesh {
        space: 3,
        nodes: Vec::new(),
        elements: Vec::new(),
        facets: Default::default(),
        held: Default::default(),
    };
    for (body, &count) in pieces.iter().enumerate() {
        let (first, turn) = (mesh.nodes.len() + 1, 0.2 * body as f64);
        for radius in [0.5 + 0.5 * body as f64, 1.0 + 0.5 * body as f64] {
            for at in 0..(count + 1).pow(2) {
                let [u, v] = [at % (count + 1), at / (count + 1)].map(|i| (i as f64 / count as f64 - 0.5).tan());
                let [u, v] = [u * turn.cos() - v * turn.sin(), u * turn.sin() + v * turn.cos()];
                let scale = radius / (1.0 + u * u + v * v).sqrt();
                mesh.nodes.push([u * scale, -v * scale, -scale]);
            }
        }
        let node = |layer: usize, i: usize, j: usize| first + (layer * (count + 1) + j) * (count + 1) + i;
        let cells: Vec<[usize; 2]> = (0..count * count).map(|at| [at % count, at / count]).collect();
        let quadrilateral = |layer: usize, [i, j]: [usize; 2]| {
            vec![node(layer, i, j), node(layer, i + 1, j), node(layer, i + 1, j + 1), node(layer, i, j + 1)]
        };
        mesh.elements.extend(cells.iter().map(|&cell| [quadrilateral(0, cell), quadrilateral(1, cell)].concat()));
        mesh.facets[body] = cells.iter().map(|&cell| quadrilateral(1 - body, cell)).collect();
        if body == 1 {
            mesh.facets[body].iter_mut().for_each(|facet| facet.reverse());
        }
        mesh.held[body] = (0..(count + 1).pow(2)).map(|at| first + body * (count + 1).pow(2) + at).collect();
    }
    mesh
}

impl Mesh {
    fn text(&self, slave: usize) -> String {
        let mut out =
            String::from("Begin ModelPartData\nEnd ModelPartData\nBegin Properties 0\nEnd Properties\nBegin Nodes\n");
        let words = |list: &[usize]| list.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
        for (at, [x, y, z]) in self.nodes.iter().enumerate() {
            writeln!(out, "{} {x:.15} {y:.15} {z:.15}", at + 1).expect("text");
        }
        let [element, facet] = match self.space {
            2 => ["TotalLagrangianElement2D4N", "LineCondition2D2N"],
            _ => ["TotalLagrangianElement3D8N", "SurfaceCondition3D4N"],
        };
        writeln!(out, "End Nodes\nBegin Elements {element}").expect("text");
        for (at, nodes) in self.elements.iter().enumerate() {
            writeln!(out, "{} 0 {}", at + 1, words(nodes)).expect("text");
        }
        writeln!(out, "End Elements\nBegin Conditions {facet}").expect("text");
        for (at, nodes) in self.facets.iter().flatten().enumerate() {
            writeln!(out, "{} 0 {}", at + 1, words(nodes)).expect("text");
        }
        writeln!(out, "End Conditions").expect("text");
        let count = self.facets[0].len();
        let conditions = [(1..=count).collect::<Vec<_>>(), (count + 1..=count + self.facets[1].len()).collect()];
        let nodes = |body: usize| {
            let mut nodes = self.facets[body].concat();
            nodes.sort_unstable();
            nodes.dedup();
            nodes
        };
        let parts = [
            ("Inner", self.held[0].clone(), Vec::new()),
            ("Outer", self.held[1].clone(), Vec::new()),
            ("Interface", [nodes(0), nodes(1)].concat(), conditions.concat()),
            ("Slave", nodes(slave), conditions[slave].clone()),
        ];
        for (name, nodes, conditions) in parts {
            writeln!(
                out,
                "Begin SubModelPart {name}\nBegin SubModelPartNodes\n{}\nEnd SubModelPartNodes\nBegin SubModelPartConditions\n{}\n\
                 End SubModelPartConditions\nEnd SubModelPart",
                words(&nodes).replace(' ', "\n"),
                words(&conditions).replace(' ', "\n")
            )
            .expect("text");
        }
        out
    }
}

/// The inner body held and the outer one pushed onto it, or the other way round in space; `more` goes into the process.
fn deck(space: usize, friction: f64, more: &Value) -> Value {
    let kind = if friction > 0.0 { "Frictional" } else { "Frictionless" };
    let fix = |part: &str, value: Value| {
        json!({"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics", "Parameters": {
            "model_part_name": format!("Structure.{part}"), "variable_name": "DISPLACEMENT",
            "constrained": [true, true, space == 3], "value": value, "interval": [0.0, "End"]}})
    };
    let last = if space == 3 { json!(0.0) } else { json!(null) };
    let (still, pushed) =
        if space == 3 { ("Outer", json!([0.0, 0.0, -0.02])) } else { ("Inner", json!([0.0, -0.02, null])) };
    let mut contact = json!({"model_part_name": "Structure", "contact_type": kind,
        "contact_model_part": {"0": ["Interface"]}, "assume_master_slave": {"0": ["Slave"]}});
    if friction > 0.0 {
        contact["friction_coefficients"] = json!({"0": friction});
    }
    for (key, value) in more.as_object().expect("an object") {
        contact[key] = value.clone();
    }
    json!({
        "problem_data": {"problem_name": "mesh", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0, "end_time": 0.5},
        "solver_settings": {
            "solver_type": "Static", "model_part_name": "Structure", "domain_size": space, "analysis_type": "non_linear",
            "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
            "material_import_settings": {"materials_filename": "materials.json"}, "time_stepping": {"time_step": 1.0},
            "convergence_criterion": "contact_residual_criterion", "residual_relative_tolerance": 1e-10,
            "residual_absolute_tolerance": 1e-14,
            "contact_settings": {"mortar_type": format!("ALMContact{kind}"), "contact_residual_relative_tolerance": 1e-8}},
        "processes": {
            "constraints_process_list": [
                fix(still, json!([0.0, 0.0, last])),
                fix(if space == 3 { "Inner" } else { "Outer" }, pushed)],
            "contact_process_list": [{"python_module": "alm_contact_process",
                "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication", "Parameters": contact}],
            "json_output_process_list": [{"python_module": "json_output_process", "kratos_module": "KratosMultiphysics",
                "Parameters": {"output_file_name": "results.json", "model_part_name": "Structure",
                    "output_variables": ["DISPLACEMENT"], "time_frequency": 0.0}}]}
    })
}

fn materials(space: usize) -> Value {
    let law = if space == 2 { "LinearElasticPlaneStrain2DLaw" } else { "LinearElastic3DLaw" };
    json!({"properties": [{"model_part_name": "Structure", "properties_id": 1, "Material": {
        "constitutive_law": {"name": law},
        "Variables": {"YOUNG_MODULUS": 1000.0, "POISSON_RATIO": 0.3, "DENSITY": 1.0, "THICKNESS": 1.0}, "Tables": {}}}]})
}

/// Displacements by component, and the output of the run.
fn run(mesh: &Mesh, slave: usize, friction: f64, more: &Value) -> (Vec<f64>, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).expect("a file");
    write("mesh.mdpa", mesh.text(slave));
    write("materials.json", materials(mesh.space).to_string());
    write("ProjectParameters.json", deck(mesh.space, friction, more).to_string());
    let output = zelus(folder.path(), &["run", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
    (displacements(folder.path(), mesh.space), said(&output))
}

fn displacements(folder: &Path, space: usize) -> Vec<f64> {
    let results = Results::read(&folder.join("results.json")).expect("results");
    let step = results.step(None).expect("a step");
    let component = |c: usize| -> BTreeMap<u64, f64> {
        results.nodal(["DISPLACEMENT_X", "DISPLACEMENT_Y", "DISPLACEMENT_Z"][c], step)
    };
    (0..space).flat_map(|c| component(c).into_values()).collect()
}

/// The residuals of the iterations that left the active set as it was, since its last change; first column of the table.
fn last_residuals(said: &str) -> Vec<f64> {
    let mut out = Vec::new();
    for line in said.lines() {
        let words: Vec<&str> = line.split_whitespace().filter(|word| *word != "✓").collect();
        let [number, residual, _, .., changes] = words[..] else { continue };
        let (Ok(_), Ok(residual), Ok(changes)) =
            (number.parse::<usize>(), residual.parse::<f64>(), changes.parse::<usize>())
        else {
            continue;
        };
        if changes > 0 {
            out.clear();
        } else {
            out.push(residual);
        }
    }
    out
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    let size = a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    a.iter().zip(b).fold(0.0_f64, |most, (x, y)| most.max((x - y).abs())) / size
}

/// Meshes with the side of the slave.
fn contacts() -> Vec<(String, Mesh, usize)> {
    let mut out = Vec::new();
    for (segments, uneven) in [([24, 12], 0.0), ([24, 19], 0.3), ([40, 39], 0.0)] {
        for slave in [0, 1] {
            out.push((format!("rings of {segments:?}, slave {slave}"), rings(segments, uneven), slave));
        }
    }
    out.push(("ball in socket".to_owned(), ball([4, 3]), 0));
    out
}

#[test]
fn answers_do_not_depend_on_penalties() {
    for (name, mesh, slave) in contacts() {
        for friction in [0.0, 0.2] {
            let (usual, _) = run(&mesh, slave, friction, &json!({}));
            for factor in [1e-3, 1e3] {
                let (other, _) =
                    run(&mesh, slave, friction, &json!({"advance_ALM_parameters": {"stiffness_factor": factor}}));
                let apart = apart(&usual, &other);
                assert!(apart < 1e-8, "{name}, friction {friction}, stiffness_factor {factor}: {apart:e} apart");
            }
            if friction > 0.0 {
                for factor in [1e-3, 1e4] {
                    let (other, _) = run(&mesh, slave, friction, &json!({"tangent_factor": factor}));
                    let apart = apart(&usual, &other);
                    assert!(apart < 1e-6, "{name}, tangent_factor {factor}: {apart:e} apart");
                }
            }
        }
    }
}

/// Once the set is found, residuals fall with the square of the one before; with friction, whose slip has a column of its own,
/// ever faster.
#[test]
fn curved_contact_converges_quadratically() {
    for (name, mesh, slave) in contacts() {
        for friction in [0.0, 0.2] {
            let (_, said) = run(&mesh, slave, friction, &json!({}));
            let residuals = last_residuals(&said);
            let [.., before, last] = residuals[..] else { panic!("{name}, friction {friction}: {said}") };
            let least = if friction == 0.0 { 10.0 * before * before } else { 2e-3 * before };
            assert!(last < least.max(1e-11), "{name}, friction {friction}: {residuals:?}\n{said}");
        }
    }
}
