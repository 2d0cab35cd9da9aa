//! Parallel runs on several ranks: the same results in the same iterations as one rank gives, and clean ends of failed runs.
//!
//! They need the feature `mpi`, without which they are ignored, and mpirun.

mod answers;
#[path = "../support/blocks.rs"]
mod blocks;
#[path = "../support/boxes.rs"]
mod boxes;
mod ends;
mod engines;
mod files;
mod runs;
#[path = "../support/scene.rs"]
mod scene;
#[path = "../support/mod.rs"]
mod support;
#[path = "../support/vtu.rs"]
mod vtu;

use std::process::Command;

use runs::{DECK, case};
use support::said;

/// A program without MPI that is started as one of several would run the whole deck in each of them.
#[test]
#[cfg_attr(feature = "mpi", ignore = "of a program without the feature `mpi`")]
fn several_processes_need_the_feature() {
    let folder = case("contact_2d/nonmatching");
    let output = Command::new(env!("CARGO_BIN_EXE_zelus"))
        .args(["run", DECK])
        .current_dir(folder.path())
        .env("OMPI_COMM_WORLD_SIZE", "2")
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(4), "{}", said(&output));
    assert!(said(&output).contains("without the feature `mpi`"), "{}", said(&output));
}
