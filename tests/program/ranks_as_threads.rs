//! Several ranks in one process, each a thread with a simulation of its own: nothing of a run is global.

use crate::support;
use std::collections::BTreeMap;
use std::path::Path;

use crate::support::{root, scratch_copy};
use crate::thread_ranks::on_threads;
use zelus::core::communication::Ranks;
use zelus::{RunOptions, Silent, Simulation};

/// Displacements by node, and the iterations of all steps.
type Outcome = (BTreeMap<usize, [f64; 3]>, Vec<usize>);

fn outcome(folder: &Path, ranks: Ranks) -> Outcome {
    let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
    let mut simulation = Simulation::open(&folder.join("ProjectParameters.json"), &options).expect("a deck");
    simulation.run(&mut Silent).expect("it converges");
    let displacement = simulation.field("DISPLACEMENT").expect("a field").chunks_exact(3);
    let ids = &simulation.part().expect("a part").nodes.ids;
    let by_node = ids.iter().zip(displacement).map(|(&id, u)| (id, [u[0], u[1], u[2]])).collect();
    (by_node, simulation.records().iter().map(|step| step.iterations.len()).collect())
}

fn is_near(found: &Outcome, expected: &Outcome) -> bool {
    let largest = expected.0.values().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
    let near =
        |(id, u): (&usize, &[f64; 3])| u.iter().zip(expected.0[id]).all(|(a, b)| (a - b).abs() <= 1e-9 * largest);
    found.1 == expected.1 && found.0.iter().all(near)
}

/// Runs on three ranks, on two and on one at the same time.
fn stand_side_by_side(case: &str) {
    let folder = scratch_copy(&root().join("tests/cases").join(case));
    let expected = outcome(folder.path(), Ranks::default());
    let results = std::thread::scope(|scope| {
        let start = |count| {
            scope.spawn(move || {
                let own = scratch_copy(&root().join("tests/cases").join(case));
                on_threads(count, |ranks| outcome(own.path(), ranks))
            })
        };
        let groups = [3, 2, 1].map(start);
        groups.map(|group| group.join().expect("a group of ranks"))
    });
    for of_ranks in results {
        let count = of_ranks.len();
        let nodes: usize = of_ranks.iter().map(|found| found.0.len()).sum();
        assert!(count == 1 || nodes < count * expected.0.len(), "{case} on {count} ranks: nothing is shared out");
        assert!(of_ranks.iter().all(|found| is_near(found, &expected)), "{case} on {count} ranks: another answer");
    }
}

#[test]
fn contact_in_the_plane() {
    stand_side_by_side("contact_2d/opening");
    stand_side_by_side("contact_2d/friction_arc");
}

#[test]
fn contact_in_space() {
    stand_side_by_side("contact_3d/hexahedra_nonmatching");
}

/// Ranks that have nothing of a variable measure it with the others.
#[test]
fn unknowns_of_several_kinds() {
    stand_side_by_side("mesh_tying/tetrahedra_on_hexahedra");
    stand_side_by_side("structural/volumetric_strain_swings_3D8N");
}

#[test]
fn errors_are_those_of_one_process() {
    let folder = scratch_copy(&root().join("tests/cases/contact_2d/opening"));
    support::change(
        folder.path(),
        "ProjectParameters.json",
        "\"model_part_name\": \"Structure.",
        "\"model_part_name\": \"Structure.No",
    );
    let run = |ranks: Ranks| {
        let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
        let mut simulation = Simulation::open(&folder.path().join("ProjectParameters.json"), &options).expect("a deck");
        simulation.run(&mut Silent).expect_err("a part that is not there").to_string()
    };
    let alone = run(Ranks::default());
    assert!(on_threads(3, run).iter().all(|said| *said == alone));
}
