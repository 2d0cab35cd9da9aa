//! Contact without named pairs: the whole skins of the bodies give the results of the pairs, with sides chosen by the program.

use serde_json::{Value, json};
use zelus::{RunOptions, Silent, Simulation};

use crate::support::{read_json, root, scratch_copy};

const DECK: &str = "ProjectParameters.json";

/// The largest contact force and pressure of a deck, as it is or with whole skins.
fn largest(deck: &str, whole: bool) -> [f64; 2] {
    let folder = scratch_copy(&root().join(deck));
    let path = folder.path().join(DECK);
    let mut changed = read_json(&path).expect("a deck");
    let mut pairs = 0;
    for list in changed["processes"].as_object_mut().expect("processes").values_mut() {
        let with_pairs = |process: &&mut Value| process["Parameters"].get("contact_model_part").is_some();
        for process in list.as_array_mut().expect("a list").iter_mut().filter(with_pairs) {
            pairs += 1;
            if whole {
                let parameters = process["Parameters"].as_object_mut().expect("parameters");
                parameters.remove("assume_master_slave");
                parameters.insert("contact_model_part".to_owned(), json!({}));
            }
        }
    }
    assert_eq!(pairs, 1, "{deck}");
    std::fs::write(&path, changed.to_string()).expect("a file");
    let options = RunOptions { threads: Some(1), ..RunOptions::default() };
    let mut simulation = Simulation::open(&path, &options).expect("a deck");
    simulation.run(&mut Silent).unwrap_or_else(|error| panic!("{deck}, whole: {whole}: {error}"));
    ["CONTACT_FORCE", "CONTACT_PRESSURE"].map(|name| simulation.report().largest[name])
}

/// The whole skin gives the forces and pressures of the named pairs, whose slave is the finer side, within a share of them.
fn gives_the_named_pairs(deck: &str, tolerance: f64) {
    let (named, whole) = (largest(deck, false), largest(deck, true));
    for (named, whole) in named.into_iter().zip(whole) {
        assert!(named > 0.0 && (whole / named - 1.0).abs() < tolerance, "{deck}: {whole} for {named}");
    }
}

/// Uniform pressures, on faces, slopes and between unlike cells: any choice of sides gives them to round-off.
#[test]
fn uniform_pressures_are_exact() {
    for case in [
        "contact_2d/nonmatching_coarse_slave",
        "contact_2d/slope",
        "contact_2d/slope_triangles",
        "contact_2d/three_blocks",
        "contact_3d/hexahedra_skewed",
        "contact_3d/slope",
        "contact_3d/slope_tetrahedra",
        "contact_3d/tetrahedra_tilted",
        "contact_3d/prisms_on_hexahedra",
    ] {
        gives_the_named_pairs(&format!("tests/cases/{case}"), 1e-5);
    }
}

/// Peaks depend on the side: the finer one is the slave, with similar meshes the softer one.
#[test]
fn peaks_are_those_of_the_finer_side() {
    gives_the_named_pairs("examples/hertz_line_contact", 1e-3);
    gives_the_named_pairs("examples/disc_on_block", 1e-3);
    gives_the_named_pairs("examples/hertz_sphere", 1e-3);
}

/// The side with an edge is the slave, although its mesh is the coarser one: slave nodes do not see an edge between them.
#[test]
fn the_side_with_an_edge_is_the_slave() {
    gives_the_named_pairs("tests/cases/contact_2d/standing_on_corner", 1e-9);
}

/// Facets that come to face each other within a step get their sides there: a body that falls a long way, or slides off all it met.
#[test]
fn sides_follow_bodies_that_move_within_a_step() {
    for case in ["contact_2d/dropped", "contact_2d/dropped_deep", "contact_2d/slid_past", "contact_3d/dropped"] {
        gives_the_named_pairs(&format!("tests/cases/{case}"), 1e-5);
    }
}

/// Friction slides under the whole skin as under the pair.
#[test]
fn friction_slides_as_under_the_pair() {
    for case in ["contact_2d/friction_slide", "contact_3d/friction_slide", "contact_3d/friction_penalty_slide"] {
        gives_the_named_pairs(&format!("tests/cases/{case}"), 1e-5);
    }
}
