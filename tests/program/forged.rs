//! Saved runs with a right checksum over contents that no run has written: they are refused, or go on without a panic.
//!
//! `ZELUS_FUZZ_SECONDS` says how long each deck is attacked.

use crate::support;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use crate::forge::{Contents, contents, with_contents};
use crate::support::{root, scratch_copy};
use serde_json::json;
use zelus::{RunOptions, Silent, Simulation};

const DECK: &str = "ProjectParameters.json";

fn open(folder: &Path) -> Simulation {
    let options = RunOptions { threads: Some(1), ..RunOptions::default() };
    Simulation::open(&folder.join(DECK), &options).expect("a deck")
}

/// Attacks a saved run of a deck of so many steps, with changes of its settings.
fn attack(folder: &str, steps: usize, change: impl Fn(&mut serde_json::Value)) {
    let scratch = scratch_copy(&root().join("tests").join(folder));
    let path = scratch.path().join(DECK);
    let mut deck = support::read_json(&path).expect("the deck");
    let [start, end] = ["start_time", "end_time"].map(|key| deck["problem_data"][key].as_f64().expect("a time"));
    deck["solver_settings"]["time_stepping"] = json!({"time_step": (end - start) / steps as f64});
    change(&mut deck);
    std::fs::write(&path, deck.to_string()).expect("the deck");
    let mut simulation = open(scratch.path());
    (0..2).for_each(|_| assert!(simulation.step(&mut Silent).expect("a step")));
    let saved = scratch.path().join("saved");
    simulation.save(&saved).expect("a saved run");
    drop(simulation);
    let whole = std::fs::read(&saved).expect("the saved run");
    let read = Contents::read(contents(&whole));
    let forged = scratch.path().join("forged");
    let go_on = |value: &Contents| {
        std::fs::write(&forged, with_contents(&whole, &value.write())).expect("a file");
        let mut simulation = open(scratch.path());
        let begun = Instant::now();
        let ended = catch_unwind(AssertUnwindSafe(|| {
            let loaded = simulation.load(&forged, &mut Silent);
            loaded.is_ok().then(|| simulation.step(&mut Silent).is_ok())
        }));
        (ended.ok(), begun.elapsed())
    };
    assert_eq!(go_on(&read).0, Some(Some(true)), "{folder}: what is written again as it was goes on");
    let seconds = std::env::var("ZELUS_FUZZ_SECONDS").ok().and_then(|text| text.parse().ok()).unwrap_or(2.0);
    let mut random = support::random(3);
    let mut dice = || (random() * f64::from(u32::MAX)) as usize;
    let (begun, mut refused, mut count) = (Instant::now(), 0, 0);
    while begun.elapsed().as_secs_f64() < seconds {
        let mut value = read.clone();
        (0..1 + dice() % 2).for_each(|_| value.forge(&mut dice));
        let (ended, time) = go_on(&value);
        let kept = || {
            let kept = std::env::temp_dir().join(format!("zelus-forged-{}-{count}", folder.replace('/', "-")));
            std::fs::copy(&forged, &kept).expect("a copy");
            kept.display().to_string()
        };
        let Some(ended) = ended else { panic!("{folder}: input {count} panics, kept in {}", kept()) };
        assert!(time < Duration::from_secs(60), "{folder}: input {count} takes {time:?}, kept in {}", kept());
        refused += usize::from(ended.is_none());
        count += 1;
    }
    assert!(refused > 0, "{folder}: {count} forged runs, and none was refused");
    println!("{folder}: {count} forged runs, {refused} refused");
}

#[test]
fn contact() {
    attack("cases/contact_2d/friction_slide", 5, |_| {});
    attack("cases/self_contact/slit", 4, |_| {});
    attack("cases/mpc/pressed_and_opened", 6, |_| {});
    attack("cases/mesh_tying/quadrilaterals", 4, |_| {});
}

#[test]
fn motion() {
    let scheme =
        |name: &'static str| move |deck: &mut serde_json::Value| deck["solver_settings"]["scheme_type"] = json!(name);
    attack("decks/bouncing_block", 40, scheme("generalized_alpha"));
    attack("decks/bouncing_block", 40, scheme("bdf2"));
    attack("cases/contact_3d/explicit_touch", 50, |_| {});
}

#[test]
fn bodies_and_solvers() {
    attack("decks/squeezed_block", 6, |_| {});
    attack("cases/structural/mixture_of_layers", 6, |_| {});
    attack("decks/truss", 8, |_| {});
    attack("cases/contact_3d/hexahedra_nonmatching", 4, |deck| {
        deck["solver_settings"]["linear_solver_settings"] = json!({"solver_type": "amgcl", "direct_below": 0});
    });
}

/// Histories and lists of files, which name places on the disk.
#[test]
fn outputs() {
    attack("cases/contact_2d/friction_slide", 5, |deck| {
        let process = |name: &str, parameters| json!({"python_module": name, "Parameters": parameters});
        deck["output_processes"] = json!({"files": [
            process("vtu_output_process", json!({"model_part_name": "Structure", "output_path": "vtu",
                "nodal_solution_step_data_variables": ["DISPLACEMENT"]})),
            process("gid_output_process", json!({"model_part_name": "Structure", "output_name": "gid",
                "postprocess_parameters": {"result_file_configuration": {"gidpost_flags": {"GiDPostMode": "GiD_PostAscii"},
                "nodal_results": ["DISPLACEMENT"]}}})),
            process("json_output_process", json!({"model_part_name": "Structure", "output_file_name": "gauss.json",
                "output_variables": ["DISPLACEMENT"], "gauss_points_output_variables": ["VON_MISES_STRESS"]})),
            process("save_restart_process", json!({"model_part_name": "Structure", "restart_control_type": "step",
                "restart_save_frequency": 1, "max_files_to_keep": 2})),
        ]});
    });
}
