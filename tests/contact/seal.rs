//! A seal of Ogden's rubber in plane strain, pressed between plates to half its diameter; κ/μ = 1000.
//!
//! Small squeezes are Hertz's (ANALYTIC): the approach of both plates is 2 F/(π E*) (2 ln(4R/b) − 1), b² = 4 F R/(π E*), E* = E/(1 − ν²) =
//! 4 μ. The force at half the diameter is a REGRESSION, beside the same mesh with twice as many cells.

use std::f64::consts::PI;
use std::path::Path;

use serde_json::json;
use zelus::{RunOptions, Silent, Simulation};

use crate::blocks::{Deck, Joint, Mesh};

/// μ = ½ Σ μ_p α_p.
const MU: f64 = 1.025;

/// A quarter of the section, of radius 1, below a plate.
fn write(folder: &Path, cells: usize, stroke: f64) -> Vec<usize> {
    let mut mesh = Mesh::new(2);
    let disc = |[u, v, _]: [f64; 3]| [u * (1.0 - 0.5 * v * v).sqrt(), v * (1.0 - 0.5 * u * u).sqrt(), 0.0];
    let seal = mesh.block("Lower", [cells, cells, 1], disc);
    let plate = mesh.block("Upper", [6, 1, 1], |[x, y, _]| [2.0 * x, 1.0 + 0.2 * y, 0.0]);
    let side = |nodes: bool, sides: &[(usize, usize)]| -> Vec<usize> {
        sides.iter().flat_map(|side| if nodes { seal[side].0.clone() } else { seal[side].1.clone() }).collect()
    };
    let rim = [(0, 1), (1, 1)];
    let face = &plate[&(1, 0)];
    mesh.part("Slave", side(true, &rim), side(false, &rim));
    mesh.part("Interface", [side(true, &rim), face.0.clone()].concat(), [side(false, &rim), face.1.clone()].concat());
    mesh.part("Left", side(true, &[(0, 0)]), Vec::new());
    mesh.part("Base", side(true, &[(1, 0)]), Vec::new());
    let plate: Vec<usize> = plate.values().flat_map(|side| side.0.clone()).collect();
    let supports = vec![
        ("Left".to_owned(), [json!(0.0), json!(null), json!(null)]),
        ("Base".to_owned(), [json!(null), json!(0.0), json!(null)]),
        ("Upper".to_owned(), [json!(0.0), json!(format!("-{stroke:?}*t")), json!(null)]),
    ];
    let deck = Deck { mesh, joint: Joint::Frictionless, supports, pressure: 0.0, young: 1.0, steps: 20 };
    deck.write(folder, |deck| {
        deck["solver_settings"]["residual_relative_tolerance"] = json!(1e-6);
        deck["solver_settings"]["max_iteration"] = json!(30);
    });
    let path = folder.join("mesh.mdpa");
    let text = std::fs::read_to_string(&path).expect("the mesh");
    let text = text.replace("SmallDisplacementElement2D4N", "TotalLagrangianQ1P0MixedElement2D4N");
    std::fs::write(path, text).expect("the mesh");
    let material = |name: &str, id: usize| {
        json!({"model_part_name": format!("Structure.{name}"), "properties_id": id, "Material": {
            "constitutive_law": {"name": "HyperElasticOgdenPlaneStrain2DLaw"},
            "Variables": {"OGDEN_MODULI": [1.2, 0.01, -0.1], "OGDEN_EXPONENTS": [1.5, 5.0, -2.0], "BULK_MODULUS": 1e3 * MU},
            "Tables": {}}})
    };
    let materials = json!({"properties": [material("Lower", 1), material("Upper", 2)]});
    std::fs::write(folder.join("StructuralMaterials.json"), materials.to_string()).expect("a file");
    plate
}

/// Force of the whole section by length after each step, with the squeeze.
fn squeeze(cells: usize, stroke: f64) -> Vec<[f64; 2]> {
    let folder = tempfile::tempdir().expect("a folder");
    let plate = write(folder.path(), cells, stroke);
    let path = folder.path().join("ProjectParameters.json");
    let mut simulation = Simulation::open(&path, &RunOptions::default()).expect("a deck");
    let mut out = Vec::new();
    while simulation.step(&mut Silent).unwrap_or_else(|error| panic!("{cells} cells: {error}")) {
        let part = &simulation.model().parts["Structure"];
        let reactions = simulation.field("REACTION").expect("reactions");
        let mut nodes = plate.clone();
        nodes.sort_unstable();
        nodes.dedup();
        let force: f64 = nodes.iter().map(|node| reactions[3 * (node - 1) + 1]).sum();
        out.push([part.info.time * stroke, -2.0 * force]);
    }
    out
}

/// Approach of both plates under a small force.
fn hertz(force: f64) -> f64 {
    let stiffness = 4.0 * MU;
    let width = (4.0 * force / (PI * stiffness)).sqrt();
    2.0 * force / (PI * stiffness) * (2.0 * (4.0 / width).ln() - 1.0)
}

#[test]
fn a_seal_is_squeezed_to_half_its_diameter() {
    let small = squeeze(16, 0.05);
    // 16 cells leave few in contact at first: 3 % at the end of this stroke, of 0.05 radii
    let [squeezed, force] = small.last().copied().expect("a step");
    println!("Hertz: squeeze {squeezed}, by the closed form {:.5}", 0.5 * hertz(force));
    assert!((0.5 * hertz(force) / squeezed - 1.0).abs() < 0.03, "{} {squeezed}", 0.5 * hertz(force));
    let curves = [12, 24].map(|cells| squeeze(cells, 0.5));
    let [coarse, fine] = curves.each_ref().map(|curve| curve.last().expect("a step")[1]);
    println!("force at half the diameter {coarse:.4}, {fine:.4}");
    assert!(curves.iter().all(|curve| curve.windows(2).all(|pair| pair[1][1] > pair[0][1])), "the force grows");
    assert!((coarse / fine - 1.0).abs() < 0.01 && (fine / 7.40 - 1.0).abs() < 2e-3, "{coarse} {fine}");
}
