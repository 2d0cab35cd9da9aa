//! A scalar unknown with a first-order rate: steady, in time, with constraints, and on three ranks.

use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

const DIFFUSIVITY: f64 = 2.0;
const STORAGE: f64 = 3.0;
/// Cells along the strip of length 1, which is as high as one of them.
const CELLS: usize = 12;

/// A strip of cells along x with the parts of its ends and of two columns of nodes inside.
fn mesh() -> String {
    let h = 1.0 / CELLS as f64;
    let mut text =
        format!("Begin Properties 1\n  DIFFUSIVITY {DIFFUSIVITY}\n  STORAGE {STORAGE}\nEnd Properties\nBegin Nodes\n");
    for column in 0..=CELLS {
        for row in 0..2 {
            text += &format!("{} {} {} 0.0\n", 2 * column + row + 1, column as f64 * h, row as f64 * h);
        }
    }
    text += "End Nodes\nBegin Elements DiffusionElement2D4N\n";
    for cell in 0..CELLS {
        let low = 2 * cell + 1;
        text += &format!("{} 1 {low} {} {} {}\n", cell + 1, low + 2, low + 3, low + 1);
    }
    text += "End Elements\n";
    let mut part = |name: &str, nodes: Vec<usize>| {
        let lines: String = nodes.iter().map(|node| format!("    {node}\n")).collect();
        text += &format!(
            "Begin SubModelPart {name}\n  Begin SubModelPartNodes\n{lines}  End SubModelPartNodes\nEnd SubModelPart\n"
        );
    };
    let column = |at: usize| [2 * at + 1, 2 * at + 2];
    part("All", (1..=2 * (CELLS + 1)).collect());
    part("Left", column(0).to_vec());
    part("Right", column(CELLS).to_vec());
    part("Inside", (4..=8).flat_map(column).collect());
    text
}

fn prescribe(part: &str, value: Value) -> Value {
    json!({"python_module": "assign_scalar_variable_process",
        "Parameters": {"model_part_name": format!("Body.{part}"), "variable_name": "CONCENTRATION", "value": value}})
}

/// A deck with these processes that ends after `steps` steps of length `dt`.
fn deck(scheme: &str, steps: usize, dt: f64, mut processes: Vec<Value>) -> Value {
    processes.push(json!({"python_module": "json_output_process", "Parameters": {
        "model_part_name": "Body", "output_file_name": "results.json",
        "output_variables": ["CONCENTRATION", "CONCENTRATION_RATE", "CONCENTRATION_SUPPLY"], "time_frequency": 0.0}}));
    json!({
        "problem_data": {"problem_name": "strip", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
            "end_time": steps as f64 * dt},
        "solver_settings": {"solver_type": "Diffusion", "model_part_name": "Body", "domain_size": 2, "scheme_type": scheme,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "strip"}, "time_stepping": {"time_step": dt}},
        "processes": {"list": processes}
    })
}

fn mpirun(ranks: usize) -> Option<Command> {
    if !cfg!(feature = "mpi") {
        println!("skipped: built without the feature `mpi`");
        return None;
    }
    let mut command = Command::new("mpirun");
    command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command.args(["--oversubscribe", "-n", &ranks.to_string(), env!("CARGO_BIN_EXE_zelus-plugin")]);
    Some(command)
}

fn run_in(folder: &Path, deck: &Value, mut command: Command) -> Value {
    std::fs::write(folder.join("strip.mdpa"), mesh()).unwrap();
    std::fs::write(folder.join("ProjectParameters.json"), deck.to_string()).unwrap();
    let output = command.args(["run", "ProjectParameters.json"]).current_dir(folder).output().expect("a run");
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{said}");
    serde_json::from_str(&std::fs::read_to_string(folder.join("results.json")).unwrap()).unwrap()
}

fn run(deck: &Value) -> Value {
    run_in(tempfile::tempdir().unwrap().path(), deck, Command::new(env!("CARGO_BIN_EXE_zelus-plugin")))
}

/// The last value of a variable at the lower node of a column.
fn last(results: &Value, variable: &str, column: usize) -> f64 {
    let of_node = &results[format!("NODE_{}", 2 * column + 1)][variable];
    of_node.as_array().unwrap().last().unwrap().as_f64().unwrap()
}

fn steady() -> Value {
    deck("static", 1, 1.0, vec![prescribe("Left", json!(1.0)), prescribe("Right", json!(0.0))])
}

fn tied() -> Value {
    let tie = json!({"python_module": "impose_rigid_movement_process", "Parameters": {"main_model_part_name": "Body",
        "model_part_name": "Inside", "master_variable_name": "CONCENTRATION"}});
    deck("static", 1, 1.0, vec![prescribe("Left", json!(1.0)), prescribe("Right", json!(0.0)), tie])
}

/// c = sin πx at first, held at both ends.
fn decaying(scheme: &str, steps: usize, dt: f64) -> Value {
    let mut start = prescribe("All", json!("sin(3.14159265358979312*x)"));
    start["Parameters"]["interval"] = json!([0.0, 0.0]);
    start["Parameters"]["constrained"] = json!(false);
    deck(scheme, steps, dt, vec![start, prescribe("Left", json!(0.0)), prescribe("Right", json!(0.0))])
}

#[test]
fn the_steady_profile_is_a_line() {
    let results = run(&steady());
    for column in 0..=CELLS {
        let expected = 1.0 - column as f64 / CELLS as f64;
        assert!((last(&results, "CONCENTRATION", column) - expected).abs() < 1e-13);
    }
    // The flux in at one end is the flux out at the other: D over half the height at each of two nodes.
    let through = 0.5 * DIFFUSIVITY / CELLS as f64;
    assert!((last(&results, "CONCENTRATION_SUPPLY", 0) - through).abs() < 1e-13);
    assert!((last(&results, "CONCENTRATION_SUPPLY", CELLS) + through).abs() < 1e-13);
}

#[test]
fn nodes_that_are_tied_have_one_concentration() {
    let results = run(&tied());
    let slope = 1.0 / (CELLS - 4) as f64;
    for column in 0..=CELLS {
        let cells = column.min(4) + column.saturating_sub(8);
        let expected = 1.0 - cells as f64 * slope;
        assert!((last(&results, "CONCENTRATION", column) - expected).abs() < 1e-13, "column {column}");
    }
}

/// Each step of the implicit Euler scheme divides the mode of the mesh by 1 + λ Δt, with λ = 6 D/(s h²) (1 − cos πh)/(2 + cos πh).
#[test]
fn a_mode_decays_as_the_scheme_and_the_mesh_say() {
    let (steps, dt) = (20, 0.01);
    let results = run(&decaying("bdf1", steps, dt));
    let h = 1.0 / CELLS as f64;
    let phase = (std::f64::consts::PI * h).cos();
    let eigenvalue = 6.0 * DIFFUSIVITY / (STORAGE * h * h) * (1.0 - phase) / (2.0 + phase);
    let left = (1.0 + eigenvalue * dt).powi(-(steps as i32));
    for column in 0..=CELLS {
        let expected = left * (std::f64::consts::PI * column as f64 * h).sin();
        assert!((last(&results, "CONCENTRATION", column) - expected).abs() < 1e-12, "column {column}");
        let rate = -eigenvalue * expected;
        assert!((last(&results, "CONCENTRATION_RATE", column) - rate).abs() < 1e-9, "column {column}");
    }
}

/// exp(−π² D t/s) is the series' only term for this start.
#[test]
fn a_mode_decays_as_the_series_says() {
    let (end, middle) = (0.2, CELLS / 2);
    let exact = (-std::f64::consts::PI.powi(2) * DIFFUSIVITY / STORAGE * end).exp();
    let error = |scheme, steps: usize| {
        (last(&run(&decaying(scheme, steps, end / steps as f64)), "CONCENTRATION", middle) - exact).abs()
    };
    assert!(error("bdf2", 80) < 0.01 * exact && error("bdf1", 40) < 0.05 * exact);
    assert!(error("bdf1", 20) > 1.7 * error("bdf1", 40), "the implicit Euler scheme is of first order");
}

#[test]
fn schemes_for_inertia_say_that_they_are_not_for_it() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("strip.mdpa"), mesh()).unwrap();
    let mut deck = decaying("newmark", 1, 0.1);
    deck["solver_settings"]["solver_type"] = json!("Dynamic");
    std::fs::write(folder.path().join("deck.json"), deck.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_zelus-plugin"));
    let output = command.args(["run", "deck.json"]).current_dir(folder.path()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("CONCENTRATION has no second derivative"), "{said}");
}

#[test]
fn three_ranks_give_what_one_gives() {
    for deck in [steady(), tied(), decaying("bdf2", 10, 0.02)] {
        let Some(command) = mpirun(3) else { return };
        let alone = run(&deck);
        let shared = run_in(tempfile::tempdir().unwrap().path(), &deck, command);
        for column in 0..=CELLS {
            for variable in ["CONCENTRATION", "CONCENTRATION_RATE", "CONCENTRATION_SUPPLY"] {
                let [one, three] = [&alone, &shared].map(|results| last(results, variable, column));
                assert!((one - three).abs() < 1e-10, "{variable} of column {column}: {three}, alone {one}");
            }
        }
    }
}
