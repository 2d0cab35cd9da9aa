//! Every kind of contact and of solid gives the answers of one process.

use serde_json::{Value, json};

use crate::boxes::Boxes;
use crate::runs::*;
use crate::scene::{COMPONENTS, Corner, FRICTIONLESS, Scene, corner, die};
use crate::support::{Results, change, contents, read_json, root, said, scratch_copy, zelus};

/// Makes the channel of slug flow transient, with semi-Lagrangian advection of heat.
const CARRIED: &[(&str, &str)] = &[
    ("\"stationary\"", "\"transient\", \"time_integration_method\": \"semi_implicit\""),
    ("\"time_step\": 1.0", "\"time_step\": 0.005"),
    ("\"end_time\": 1.0", "\"end_time\": 0.015"),
    (",\n    \"stores_heat\": false", ""),
];

/// METIS leaves most facets of a sphere's small contact to few ranks: their pairs are shared out, and nothing else changes. The engine is
/// named: one process alone would hand over to the direct one, whose answers are closer than multigrid's.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn pairs_of_full_ranks_are_evaluated_by_others() {
    let deck = root().join("examples/hertz_sphere");
    // Levels depend on who has which rows: solves go further than the criteria ask, so that answers are those of no engine.
    let exact = r#""linear_solver_settings": {"solver_type": "amgcl", "tolerance": 1e-12}, "max_iteration""#;

    let first_step = ("\"end_time\": 1.0", "\"end_time\": 0.25");
    equals_serial(&deck.to_string_lossy(), &[("\"max_iteration\"", exact), first_step], EQUAL, true);
    let folder = scratch_copy(&deck);
    change(folder.path(), DECK, first_step.0, first_step.1);
    let output = distributed(folder.path(), 2, &["run", DECK]);
    assert!(said(&output).contains("pairs moved to other ranks"), "{}", said(&output));
}

/// Nodes with slave nodes of several patches, of pairs and of ties.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn corners_between_bodies() {
    let write = |scene: &Scene| {
        let folder = tempfile::tempdir().expect("a scratch folder");
        scene.write(folder.path());
        folder
    };
    let equal = |scene: &Scene| {
        let folder = write(scene);
        equals_serial(&folder.path().to_string_lossy(), &[], EQUAL, true);
    };
    for ties in [false, true] {
        let Corner { mut scene, .. } = corner(5);
        let both = vec![["Bottom", "FloorTop"], ["Left", "WallFace"]];
        scene.loads = vec![("Right", [if ties { 1.0 } else { -0.5 }, 0.0, 0.0]), ("Top", [0.0, -1.0, 0.0])];
        *if ties { &mut scene.ties } else { &mut scene.pairs } = both;
        equal(&scene);
    }
    equal(&die(2, 0.3, 1.0, COMPONENTS, true).0);
    equal(&die(3, 0.3, 1.0, FRICTIONLESS, true).0);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn bodies_without_contact() {
    equals_serial("elements/load_patch_2D4N", &[], EXACT, true);
    equals_serial("elements/displacement_patch_3D8N", &[], EXACT, true);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn heat_through_contact() {
    let deck = root().join("examples/bars_in_thermal_contact");
    equals_serial(&deck.to_string_lossy(), &[], EXACT, true);
}

/// Staggered coupling with a structure in contact, and semi-Lagrangian advection through the whole mesh.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn heat_beside_other_things() {
    let example = |name: &str| root().join("examples").join(name).to_string_lossy().into_owned();
    equals_serial(&example("shrink_fit_by_cooling"), &[], EQUAL, true);
    equals_serial(&example("graetz_slug_flow"), CARRIED, EQUAL, true);
}

/// In one iteration with a structure in contact: a rod that is cut, though its few facets are not.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn heat_together_with_a_structure() {
    let original = root().join("examples/barber_rod");
    let arguments = ["run", "AtRest.json", "--report", "report.json"];
    let before: Vec<_> = contents(&original).into_keys().collect();
    let alone = scratch_copy(&original);
    let output = zelus(alone.path(), &arguments);
    assert!(output.status.success(), "{}", said(&output));
    let (expected, iterations) = outcome(alone.path(), &before);
    for ranks in [2, 3] {
        let folder = scratch_copy(&original);
        let output = distributed(folder.path(), ranks, &arguments);
        assert!(output.status.success(), "{ranks} ranks: {}", said(&output));
        let (found, of_ranks) = outcome(folder.path(), &before);
        assert_eq!(of_ranks, iterations, "{ranks} ranks");
        assert_near(&found, &expected, EQUAL, &format!("{ranks} ranks"));
    }
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn frictionless_contact_in_the_plane() {
    equals_serial("contact_2d/nonmatching", &[], EXACT, true);
    equals_serial("contact_2d/opening", &[], EXACT, true);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn frictionless_contact_in_space() {
    equals_serial("contact_3d/hexahedra_nonmatching", &[], EXACT, true);
    equals_serial("contact_3d/tetrahedra_on_hexahedra", &[], EXACT, true);
}

/// Slips of sticking nodes are round-off and left out.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn frictional_contact() {
    equals_serial("contact_2d/friction_stick", &[("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")], EXACT, true);
    equals_serial("contact_3d/friction_stick", &[("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")], EXACT, true);
    equals_serial("contact_2d/friction_pure_slip", &[], EXACT, true);
    equals_serial("contact_2d/friction_arc", &[], EQUAL, true);
    equals_serial("contact_2d/friction_none", &[], EXACT, true);
    equals_serial("contact_2d/friction_slide", &[], EXACT, true);
    equals_serial("contact_2d/friction_tresca_slide", &[], EXACT, true);
    equals_serial("contact_2d/friction_by_pair", &[], EXACT, true);
    equals_serial("contact_3d/friction_slide", &[], EXACT, true);
    equals_serial("contact_3d/friction_tresca_slide", &[], EXACT, true);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn penalty_contact() {
    let common =
        [("alm_contact_process", "penalty_contact_process"), ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "WEIGHTED_GAP")];
    let frictionless = [&common[..], &[("ALMContactFrictionless", "PenaltyContactFrictionless")]].concat();
    let sliding = "\"contact_type\": \"Frictional\", \"friction_coefficients\": {\"0\": 0.3}";
    let frictional =
        [("ALMContactFrictionless", "PenaltyContactFrictional"), ("\"contact_type\": \"Frictionless\"", sliding)];
    equals_serial("contact_2d/nonmatching", &frictionless, EQUAL, true);
    equals_serial("contact_3d/hexahedra_nonmatching", &frictionless, EQUAL, true);
    equals_serial("contact_2d/nonmatching", &[&common[..], &frictional].concat(), EQUAL, true);
    equals_serial("contact_3d/hexahedra_nonmatching", &[&common[..], &frictional].concat(), EQUAL, true);
}

/// Points decide on contact by the traction of the slave's own element, which every rank has for each slave facet.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn contact_by_tractions_of_elements() {
    equals_serial("contact_2d/nitsche", &[], EXACT, true);
    equals_serial("contact_3d/nitsche", &[], EXACT, true);
    let family = [("alm_contact_process", "nitsche_contact_process"), ("ALMContact", "NitscheContact")];
    let parted = [&family[..], &[("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "WEIGHTED_GAP")]].concat();
    equals_serial("contact_2d/opening", &parted, EQUAL, true);
    equals_serial("contact_3d/opening", &parted, EQUAL, true);
    let rubbed = [&family[..], &[("\"VECTOR_LAGRANGE_MULTIPLIER\", \"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")]].concat();
    equals_serial("contact_2d/friction_slide", &rubbed, EQUAL, true);
    equals_serial("contact_3d/friction_slide", &rubbed, EQUAL, true);
    equals_serial("contact_3d/friction_stick", &rubbed, EQUAL, true);
}

/// A node's traction is the penalty times its gap over all its pairs, which several ranks evaluate.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn friction_by_penalties_of_nodes() {
    equals_serial("contact_2d/friction_penalty_slide", &[], EQUAL, true);
    equals_serial("contact_3d/friction_penalty_slide", &[], GROWN, false);
    equals_serial("contact_3d/friction_penalty_stick", &[("\"WEIGHTED_SLIP\"", "\"DISPLACEMENT\"")], EQUAL, true);
}

/// The block goes beyond the end of its ground, which then covers a twelfth of the last but one facet.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn nodes_beside_the_master() {
    let beyond = ("2.0*(t-1.0)", "2.73*(t-1.0)");
    equals_serial("contact_2d/slid_past", &[beyond], EQUAL, true);
    let of_nodes = ("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "WEIGHTED_GAP");
    let by_penalty = [("alm_contact_process", "penalty_contact_process"), ("ALMContact", "PenaltyContact"), of_nodes];
    equals_serial("contact_2d/slid_past", &[&by_penalty[..], &[beyond]].concat(), EQUAL, true);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn tied_meshes() {
    equals_serial("mesh_tying/triangles_on_quadrilaterals", &[], EXACT, true);
    equals_serial("mesh_tying/tetrahedra_on_hexahedra", &[], EXACT, true);
}

/// Systems as small as these are solved by rank 0 unless the deck asks for PETSc.
/// Ties over a whole part, stages, dynamics, whole skins, fields that are mapped, and bodies that touch themselves.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn what_looks_beyond_a_rank() {
    equals_serial("constraints/rigid_plate", &[], EXACT, true);
    equals_serial("structural/stages_of_plastic_flow", &[], EXACT, true);
    equals_serial("structural/volumetric_strain_swings_3D8N", &[], EQUAL, true);
    equals_serial("contact_3d/skin_detection", &[], EXACT, true);
    equals_serial("contact_3d/parts_of_nodes", &[], EXACT, true);
    equals_serial("mpc/mapped_field", &[], EXACT, true);
    equals_serial("self_contact/slit_hexahedra", &[], EQUAL, true);
}

#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn contact_by_constraints() {
    equals_serial("mpc/pressed_and_opened", &[], EXACT, true);
    equals_serial("mpc/pressed_and_opened_hexahedra", &[], EXACT, true);
    equals_serial("mpc/tying_matching", &[], EXACT, true);
    equals_serial("mpc/tying_matching_hexahedra", &[], EXACT, true);
}

/// Constraints hand on forces to nodes that other ranks own.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn reactions_of_supports_that_constraints_reach() {
    let all = ("[\"DISPLACEMENT\"]", "[\"DISPLACEMENT\", \"REACTION\"]");
    equals_serial("mpc/pressed_and_opened", &[all], EQUAL, true);
    equals_serial("mpc/tying_matching_hexahedra", &[all], EQUAL, true);
    let part = "\"Parameters\": {\n          \"model_part_name\": \"Structure\",\n";
    let rubbed = part.to_owned() + "\"contact_type\": \"Frictional\", \"friction_coefficients\": {\"0\": 0.3},";
    let friction =
        [all, ("{\"contact_type\": \"Frictionless\"}", "{\"contact_type\": \"Frictional\"}"), (part, &rubbed)];
    equals_serial("mpc/pressed_and_opened_hexahedra", &friction, EQUAL, true);
}

/// A corner that lands between the nodes of a coarse slave makes energy: the work of contact shows it, on any number of ranks.
#[test]
#[cfg_attr(not(feature = "mpi"), ignore = "needs the feature `mpi`")]
fn work_of_contact_is_counted_once() {
    const MATERIAL: [f64; 3] = [1.0, 0.2, 1.0];
    let boxes = Boxes::thrown_on_coarse_ground(0.35);
    let work = |ranks: usize| -> Vec<f64> {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let settings = json!({"contact_settings": {"largest_energy_gain": 0.0, "largest_penetration": 0.0}});
        boxes.write_thrown(folder.path(), MATERIAL, 40.0, &settings);
        let output = distributed(folder.path(), ranks, &["run", DECK, "--report", "report.json"]);
        assert!(output.status.success(), "{ranks} ranks: {}", said(&output));
        let report = read_json(&folder.path().join("report.json")).expect("the report");
        let steps = report["steps"].as_array().expect("steps").iter().filter(|step| step["converged"] == true);
        let of_step = |step: &Value| {
            let numbers = step["interactions"].as_array().expect("numbers").iter();
            numbers.filter(|number| number[0] == "work of contact").find_map(|number| number[1].as_f64()).expect("work")
        };
        let work: Vec<f64> = steps.map(of_step).collect();
        let results = Results::read(&folder.path().join("results.json")).expect("results");
        let energy = |step| boxes.state("Block", MATERIAL, &results, step).energy();
        let (won, done) = (energy(Some(results.len() - 1)) - energy(None), work[work.len() - 1]);
        // In steps this long the scheme has a share of the energy too.
        assert!((won - done).abs() < 0.1 * done.abs(), "{ranks} ranks: the block wins {won}, contact does {done}");
        work
    };
    let alone = work(1);
    let most = alone.iter().fold(0.0_f64, |most, work| most.max(work.abs()));
    assert!(most > 1e-6, "contact does no work: {most}");
    for ranks in [2, 3] {
        let shared = work(ranks);
        assert_eq!(shared.len(), alone.len(), "{ranks} ranks");
        for (step, (a, b)) in alone.iter().zip(&shared).enumerate() {
            assert!((a - b).abs() < 1e-6 * most, "{ranks} ranks, step {step}: {b}, not {a}");
        }
    }
}
