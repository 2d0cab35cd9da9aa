//! A heavy strip on a rigid plane whose end is lifted (BEAM THEORY and EXTERNAL): many slave nodes leave contact one after the other,
//! more than an active set that changes node by node comes to the end of.
//!
//! A strip of stiffness E I under the load q, lifted by H, leaves the plane over the length l = (24 E I H / q)^¼ and pulls with
//! F = q l / 2 = 1.05737. Independent quadratic programmes on the same meshes give 1.05669 with 60 cells of eight nodes and 1.05665
//! with 120. Contact ends 0.05 and 0.06 farther out than that of the beam, as the strip, of height 0.1, also shears.

use std::path::Path;

use crate::blocks::{Deck, Joint, Mesh};
use serde_json::{Value, json};
use zelus::{RunOptions, Silent, Simulation};

/// Length and height of the strip, and the lift of its end.
const LENGTH: f64 = 4.0;
const HEIGHT: f64 = 0.1;
const LIFT: f64 = 0.01;
/// Young's modulus of the strip and the load on it (stress).
const YOUNG: f64 = 1e6;
const LOAD: f64 = 1.0;
/// Force at the end by the quadratic programme.
const FORCE: f64 = 1.0566;

/// Condition, process and kind of a formulation.
type Formulation = [&'static str; 3];
const ALM: Formulation = ["ALMContactFrictionless", "alm_contact_process", "Frictionless"];
const COMPONENTS: Formulation = ["ALMContactFrictionlessComponents", "alm_contact_process", "FrictionlessComponents"];
const PENALTY: Formulation = ["PenaltyContactFrictionless", "penalty_contact_process", "Frictionless"];
const PERTURBED: Formulation =
    ["PerturbedLagrangianContactFrictionless", "perturbed_lagrangian_contact_process", "Frictionless"];
const UZAWA: Formulation = ["UzawaContactFrictionless", "uzawa_contact_process", "Frictionless"];

const NITSCHE: Formulation = ["NitscheContactFrictionless", "nitsche_contact_process", "Frictionless"];

/// A strip of cells, or of triangles, on a plane.
struct Strip {
    cells: usize,
    triangles: bool,
    /// Facets of the plane.
    facets: usize,
    formulation: Formulation,
}

/// Results of a run at its end.
struct Lifted {
    force: f64,
    /// Last place in contact.
    last: f64,
    iterations: usize,
}

impl Strip {
    fn mesh(&self) -> (Mesh, usize) {
        let mut mesh = Mesh::new(2);
        let plane =
            mesh.block("Lower", [self.facets, 1, 1], |[x, y, _]| [x * (LENGTH + 1.0) - 0.5, 0.2 * (y - 1.0), 0.0]);
        mesh.cut_cells(self.triangles);
        let strip = mesh.block("Upper", [self.cells, 2, 1], |[x, y, _]| [LENGTH * x, HEIGHT * y, 0.0]);
        let (own, other) = (&strip[&(1, 0)], &plane[&(1, 1)]);
        mesh.part("Slave", own.0.clone(), own.1.clone());
        mesh.part("Interface", [own.0.clone(), other.0.clone()].concat(), [own.1.clone(), other.1.clone()].concat());
        mesh.part("Top", strip[&(1, 1)].0.clone(), strip[&(1, 1)].1.clone());
        mesh.part("Left", strip[&(0, 0)].0.clone(), Vec::new());
        let tip = strip[&(0, 1)].0[1];
        mesh.part("Tip", [tip], Vec::new());
        mesh.raise("Upper", false);
        (mesh, tip)
    }

    fn write(&self, folder: &Path) -> usize {
        let (mesh, tip) = self.mesh();
        let still = [json!(0.0), json!(0.0), Value::Null];
        let supports = vec![
            ("Lower".to_owned(), still),
            ("Left".to_owned(), [json!(0.0), Value::Null, Value::Null]),
            ("Tip".to_owned(), [Value::Null, json!(format!("{LIFT}*t")), Value::Null]),
        ];
        let deck = Deck { mesh, joint: Joint::Frictionless, supports, pressure: LOAD, young: YOUNG, steps: 5 };
        deck.write(folder, |deck| {
            let [condition, process, kind] = self.formulation;
            deck["solver_settings"]["contact_settings"] = json!({"mortar_type": condition});
            deck["solver_settings"]["residual_relative_tolerance"] = json!(1e-6);
            let contact = &mut deck["processes"]["contact_process_list"][0];
            contact["python_module"] = json!(process);
            contact["Parameters"]["contact_type"] = json!(kind);
            deck["processes"]["json_output_process_list"] = json!([]);
        });
        let material = |(part, law, young): (&str, &str, f64)| {
            json!({"model_part_name": format!("Structure.{part}"), "properties_id": 1 + usize::from(part == "Upper"),
                "Material": {"constitutive_law": {"name": law},
                    "Variables": {"YOUNG_MODULUS": young, "POISSON_RATIO": 0.0}, "Tables": {}}})
        };
        let plane = ("Lower", "LinearElasticPlaneStrain2DLaw", 100.0 * YOUNG);
        let materials = [plane, ("Upper", "LinearElasticPlaneStress2DLaw", YOUNG)].map(material);
        let file = folder.join("StructuralMaterials.json");
        std::fs::write(file, json!({"properties": materials}).to_string()).expect("materials");
        tip
    }

    fn run(&self) -> Lifted {
        let folder = tempfile::tempdir().expect("a folder");
        let tip = self.write(folder.path());
        let name = self.formulation[0];
        let mut run = Simulation::open(&folder.path().join("ProjectParameters.json"), &RunOptions::default())
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        run.run(&mut Silent).unwrap_or_else(|error| panic!("{name}, {} cells: {error}", self.cells));
        let part = run.part().expect("a part");
        let reaction = run.field("REACTION").expect("reactions");
        let pressure = &part.nodes.values.get("AUGMENTED_NORMAL_CONTACT_PRESSURE").expect("pressures").levels[0];
        let slaves = part.part("Slave").expect("the slave").nodes.iter();
        let in_contact = slaves.filter(|&&node| pressure[node as usize] < 0.0);
        let last = in_contact.map(|&node| part.nodes.initial[node as usize][0]).fold(f64::MIN, f64::max);
        Lifted { force: reaction[3 * (tip - 1) + 1], last, iterations: run.report().iterations }
    }

    /// Runs the strip; its force and the place where contact ends must be right, and iterations at most so many.
    fn must_lift(&self, last: f64, most: usize) {
        let name = format!("{}, {} cells", self.formulation[0], self.cells);
        let lifted = self.run();
        println!("{name}: F {:.6}, last {:.5}, {} iterations", lifted.force, lifted.last, lifted.iterations);
        assert!((lifted.force / FORCE - 1.0).abs() < 3e-3, "{name}: F {}", lifted.force);
        let cell = LENGTH / self.cells as f64;
        assert!((lifted.last - last).abs() <= cell, "{name}: contact up to {}, {last} is right", lifted.last);
        assert!(lifted.iterations <= most, "{name}: {} iterations", lifted.iterations);
    }
}

const EVERY: [Formulation; 5] = [ALM, COMPONENTS, PENALTY, PERTURBED, UZAWA];
/// Iterations of five steps at most; Uzawa's updates take some more.
const MOST: usize = 110;
const MOST_WITH_UPDATES: usize = 140;

#[test]
fn sixty_cells_of_eight_nodes() {
    for formulation in EVERY {
        let most = if formulation == UZAWA { MOST_WITH_UPDATES } else { MOST };
        Strip { cells: 60, triangles: false, facets: 31, formulation }.must_lift(1.9333, most);
    }
}

#[test]
fn a_hundred_and_twenty_cells_of_eight_nodes() {
    Strip { cells: 120, triangles: false, facets: 61, formulation: ALM }.must_lift(1.95, MOST);
}

#[test]
fn a_hundred_and_twenty_cells_of_eight_nodes_by_a_penalty() {
    Strip { cells: 120, triangles: false, facets: 61, formulation: PENALTY }.must_lift(1.95, MOST);
}

#[test]
fn a_plane_of_one_facet() {
    Strip { cells: 60, triangles: false, facets: 1, formulation: COMPONENTS }.must_lift(1.9333, MOST);
}

#[test]
fn sixty_cells_of_triangles_of_six_nodes() {
    for formulation in EVERY {
        let most = if formulation == UZAWA { MOST_WITH_UPDATES } else { MOST };
        Strip { cells: 60, triangles: true, facets: 31, formulation }.must_lift(1.9333, most);
    }
}

/// Points decide for themselves, without joint decisions: the zone opens node by node.
const MOST_NODE_BY_NODE: usize = 330;

#[test]
fn cells_of_eight_nodes_by_nitsche_s_method() {
    for (cells, facets, last) in [(30, 16, 1.9333), (60, 31, 1.9333), (120, 61, 1.95)] {
        Strip { cells, triangles: false, facets, formulation: NITSCHE }.must_lift(last, MOST_NODE_BY_NODE);
    }
}

#[test]
fn triangles_of_six_nodes_by_nitsche_s_method() {
    Strip { cells: 60, triangles: true, facets: 31, formulation: NITSCHE }.must_lift(1.9333, MOST_NODE_BY_NODE);
}

#[test]
fn a_hundred_and_twenty_cells_of_triangles_of_six_nodes() {
    Strip { cells: 120, triangles: true, facets: 61, formulation: ALM }.must_lift(1.95, MOST);
}
