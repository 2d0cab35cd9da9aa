//! Masters that end just inside a slave facet: the pressure that is reported is usable, whatever the overlap of the last facet is.

use crate::blocks::{Deck, Joint, Mesh};
use serde_json::json;
use zelus::{RunOptions, Silent, Simulation};

const PRESSURE: f64 = 1.0;
const CELLS: usize = 4;

/// Pressures at the slave nodes, and the force of the pair over the load, where the master ends at `width` of the last facet.
fn pressures(space: usize, width: f64, least_coverage: Option<f64>) -> (Vec<f64>, f64) {
    let cell = 1.0 / CELLS as f64;
    let covered = 1.0 - cell + width * cell;
    let mut mesh = Mesh::new(space);
    let up = space - 1;
    let flat = |x: [f64; 3], length: f64, from: f64| {
        std::array::from_fn(|c| {
            if c == up {
                from + 0.5 * x[c]
            } else if c == 0 {
                length * x[c]
            } else {
                x[c]
            }
        })
    };
    let lower = mesh.block("Lower", [3; 3], |x| flat(x, covered, 0.0));
    let upper = mesh.block("Upper", [CELLS; 3], |x| flat(x, 1.0, 0.5));
    let (slave, master) = (upper[&(up, 0)].clone(), lower[&(up, 1)].clone());
    mesh.part("Slave", slave.0.clone(), slave.1.clone());
    mesh.part("Interface", [slave.0.clone(), master.0].concat(), [slave.1, master.1].concat());
    mesh.part("Bottom", lower[&(up, 0)].0.clone(), Vec::new());
    mesh.part("Top", upper[&(up, 1)].0.clone(), upper[&(up, 1)].1.clone());
    let mut supports = vec![("Bottom".to_owned(), [json!(0.0), json!(0.0), json!(0.0)])];
    // All moves straight down: under a master as long as the slave the pressure is the same everywhere.
    let sides = lower.values().chain(upper.values());
    mesh.part("Guided", sides.flat_map(|side| side.0.clone()), Vec::new());
    let across = std::array::from_fn(|c| if c == up { json!(null) } else { json!(0.0) });
    supports.push(("Guided".to_owned(), across));
    let deck = Deck { mesh, joint: Joint::Frictionless, supports, pressure: PRESSURE, young: 1e3, steps: 1 };
    let scratch = tempfile::tempdir().expect("a folder");
    deck.write(scratch.path(), |deck| {
        let contact = &mut deck["processes"]["contact_process_list"][0]["Parameters"];
        least_coverage.into_iter().for_each(|least| contact["least_coverage"] = json!(least));
    });
    let mut run =
        Simulation::open(&scratch.path().join("ProjectParameters.json"), &RunOptions::default()).expect("a deck");
    run.run(&mut Silent).expect("it converges");
    let scale = run.report().parameters["scale factor k"];
    let part = run.part().expect("a part");
    let field = run.field("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE").expect("multipliers");
    let of_node = |id: &usize| scale * field[part.nodes.ids.iter().position(|own| *own == *id).expect("a node")];
    let pair = &run.records().last().expect("a step").balance.as_ref().expect("a balance").pairs[0];
    (slave.0.iter().map(of_node).collect(), pair.force[up].abs() / PRESSURE)
}

#[test]
fn pressures_beside_the_edge_of_a_master_are_usable() {
    for space in [2, 3] {
        // The whole facet is covered, and next to nothing of it.
        for width in [1.0, 0.9, 0.6, 0.4, 0.3, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9] {
            let (found, force) = pressures(space, width, None);
            assert!((force - 1.0).abs() < 1e-6, "{space} {width}: force {force}");
            let worst = found.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
            // At the edge itself the pressure is singular.
            assert!(worst < 8.0 * PRESSURE, "{space} {width}: {found:?}");
            assert!(found.iter().all(|p| *p <= 1e-9), "{space} {width}: nothing pulls: {found:?}");
            let whole = width == 1.0;
            assert!(!whole || found.iter().all(|p| (p + PRESSURE).abs() < 1e-6), "{space}: {found:?}");
        }
    }
}

/// Kratos' result: the force of a sliver by its area.
#[test]
fn without_a_least_coverage_slivers_report_anything() {
    let (found, force) = pressures(2, 1e-3, Some(0.0));
    assert!((force - 1.0).abs() < 1e-6);
    assert!(found.iter().any(|p| *p < -100.0 * PRESSURE), "{found:?}");
}
