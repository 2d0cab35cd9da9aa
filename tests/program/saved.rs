//! A run that is saved between two steps and goes on elsewhere gives the bits of the run that was not: fields, states, report
//! and files.

use crate::support;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::ranks_as_threads::{clamp_by_directions, hang_a_body, slide_on_a_slope};
use crate::support::{contents, root, scratch_copy};
use crate::thread_ranks::on_threads;
use serde_json::{Value, json};
use zelus::core::communication::Ranks;
use zelus::core::model::{EntityTable, Fields, ModelPart};
use zelus::{Error, RunOptions, Silent, Simulation};

const DECK: &str = "ProjectParameters.json";
/// Settings of the structure beside heat.
const STRUCTURE: &str = "structural_solver_settings";

/// A folder beside or below `tests`, the change of its deck, and how many steps it makes.
struct Case {
    folder: &'static str,
    change: fn(&mut Value),
    steps: usize,
}

const fn case(folder: &'static str, steps: usize) -> Case {
    Case { folder, change: |_| {}, steps }
}

/// Supports along directions and resultants.
const DIRECTIONS: Case = Case {
    folder: "cases/structural/cooks_membrane_mixed",
    change: |deck| clamp_by_directions(&mut deck["processes"]),
    steps: 4,
};
const SLOPE: Case = Case {
    folder: "cases/contact_3d/hexahedra_nonmatching",
    change: |deck| slide_on_a_slope(&mut deck["processes"]),
    steps: 4,
};

fn open(folder: &Path, threads: usize) -> Simulation {
    let options = RunOptions { threads: Some(threads), ..RunOptions::default() };
    Simulation::open(&folder.join(DECK), &options).expect("a deck")
}

fn bits(fields: &Fields, out: &mut Vec<(String, Vec<u64>)>) {
    for (name, field) in fields.iter() {
        for (level, values) in field.levels.iter().enumerate() {
            out.push((format!("{name} {level}"), values.iter().map(|value| value.to_bits()).collect()));
        }
    }
}

/// All numbers of a part, by name.
fn state(part: &ModelPart) -> Vec<(String, Vec<u64>)> {
    let mut out = Vec::new();
    for fields in [&part.nodes.history, &part.nodes.values, &part.elements.data, &part.conditions.data] {
        bits(fields, &mut out);
    }
    out.push(("positions".into(), part.nodes.current.as_flattened().iter().map(|x| x.to_bits()).collect()));
    let info = &part.info;
    out.extend(info.values.iter().map(|(name, value)| ((*name).to_owned(), vec![value.to_bits()])));
    out.push(("time".into(), vec![info.time.to_bits(), info.delta_time.to_bits(), info.step as u64]));
    out
}

/// The report without numbers that depend on clock and machine.
fn report(simulation: &Simulation) -> Value {
    let mut report = serde_json::to_value(simulation.report()).expect("a report");
    for key in ["seconds", "threads", "memory"] {
        report.as_object_mut().expect("an object").remove(key);
    }
    report
}

fn assert_same(what: &str, a: &Simulation, b: &Simulation) {
    let [first, second] = [a, b].map(|simulation| simulation.part().expect("a part"));
    for ((name, a), (other, b)) in state(first).iter().zip(&state(second)) {
        assert_eq!(name, other, "{what}");
        assert!(a == b, "{what}: {name} differs");
    }
    assert!(first.nodes.flags == second.nodes.flags && first.constraints == second.constraints, "{what}");
    let flags = |table: &EntityTable| table.flags.clone();
    assert!(flags(&first.elements) == flags(&second.elements), "{what}");
    let [mut a, mut b] = [report(a), report(b)];
    for key in a.as_object().expect("an object").keys().cloned().collect::<Vec<_>>() {
        assert_eq!(a[&key].take(), b[&key].take(), "{what}: {key} of the report");
    }
}

/// A scratch copy of a case with its changes.
fn prepared(case: &Case) -> tempfile::TempDir {
    let scratch = scratch_copy(&root().join("tests").join(case.folder));
    let path = scratch.path().join(DECK);
    let text = std::fs::read_to_string(&path).expect("the deck");
    let mut deck: Value = serde_json::from_str(&text).expect("JSON");
    (case.change)(&mut deck);
    if deck.get("stages").is_none() {
        let end = deck["problem_data"]["end_time"].as_f64().expect("a time");
        let start = deck["problem_data"]["start_time"].as_f64().expect("a time");
        let solver = &mut deck["solver_settings"];
        let solver = if solver.get(STRUCTURE).is_some() { &mut solver[STRUCTURE] } else { solver };
        solver["time_stepping"] = json!({"time_step": (end - start) / case.steps as f64});
    }
    std::fs::write(&path, deck.to_string()).expect("the deck");
    scratch
}

/// Runs a case to its end; again, saved in the middle; and again from there, with other threads and further back than the
/// files have come to.
fn goes_on(case: &Case) {
    let scratch = prepared(case);
    let mut whole = open(scratch.path(), 2);
    whole.run(&mut Silent).expect("a run");
    let files = contents(scratch.path());
    let middle = (whole.records().iter().filter(|record| record.converged).count() / 2).max(1);
    let saved = scratch.path().join("saved");
    let mut first = open(scratch.path(), 1);
    for _ in 0..middle {
        assert!(first.step(&mut Silent).expect("a step"), "{}", case.folder);
    }
    first.save(&saved).expect("a saved run");
    first.step(&mut Silent).expect("a step more, whose traces go");
    drop(first);
    let mut second = open(scratch.path(), 3);
    second.load(&saved, &mut Silent).expect("a run to go on with");
    second.run(&mut Silent).expect("the rest");
    assert_same(case.folder, &whole, &second);
    std::fs::remove_file(&saved).expect("the saved run");
    let mut again = contents(scratch.path());
    for (name, bytes) in &files {
        assert!(again.remove(name).as_ref() == Some(bytes), "{}: {} differs", case.folder, name.display());
    }
    assert!(again.is_empty(), "{}: {:?}", case.folder, again.keys());
}

fn all(cases: &[Case]) {
    cases.iter().for_each(goes_on);
}

fn scheme(deck: &mut Value, name: &str) {
    deck["solver_settings"]["scheme_type"] = json!(name);
}

/// Explicit steps of 2.2, which one element reaches with more mass: its own critical step is 2.4 times 0.8.
fn explicit_with_scaled_mass(deck: &mut Value) {
    let solver = &mut deck["solver_settings"];
    solver["time_integration_method"] = json!("explicit");
    solver["scheme_type"] = json!("central_differences");
    solver["time_step_prediction_level"] = json!(2);
    solver["delta_time_refresh"] = json!(7);
    solver["max_delta_time"] = json!(9.0);
    solver["mass_scaling_time_step"] = json!(2.2);
    ends(deck, 100.0);
}

/// A body that starts with a spin.
fn swing_a_body(deck: &mut Value) {
    hang_a_body(&mut deck["processes"]);
    for (key, value) in
        [("solver_type", "Dynamic"), ("time_integration_method", "implicit"), ("scheme_type", "newmark")]
    {
        deck["solver_settings"][key] = json!(value);
    }
    let spin = json!({"python_module": "assign_vector_variable_process", "Parameters": {"model_part_name": "Structure.Hub",
        "variable_name": "ANGULAR_VELOCITY", "constrained": [false, false, false], "value": [0.1, 0.0, 0.2],
        "interval": [0.0, 0.0]}});
    deck["processes"]["constraints_process_list"].as_array_mut().expect("a list").push(spin);
}

fn solver(deck: &mut Value, settings: Value) {
    deck["solver_settings"]["linear_solver_settings"] = settings;
}

/// Files of every kind beside the histories.
fn with_files(deck: &mut Value) {
    let process = |name: &str, parameters: Value| json!({"python_module": name, "Parameters": parameters});
    deck["output_processes"] = json!({"files": [
        process("vtu_output_process", json!({"model_part_name": "Structure", "output_interval": 2,
            "nodal_solution_step_data_variables": ["DISPLACEMENT"], "output_path": "vtu"})),
        process("vtk_output_process", json!({"model_part_name": "Structure.Upper", "output_control_type": "time",
            "output_interval": 0.3, "nodal_solution_step_data_variables": ["DISPLACEMENT"], "output_path": "vtk"})),
        process("gid_output_process", json!({"model_part_name": "Structure", "output_name": "gid",
            "postprocess_parameters": {"result_file_configuration": {"gidpost_flags": {"GiDPostMode": "GiD_PostAscii"},
            "nodal_results": ["DISPLACEMENT"]}}})),
        process("json_output_process", json!({"model_part_name": "Structure", "output_file_name": "gauss.json",
            "output_variables": ["DISPLACEMENT"], "gauss_points_output_variables": ["VON_MISES_STRESS"],
            "time_frequency": 0.3})),
        process("multiple_points_output_process", json!({"model_part_name": "Structure.Upper", "entity_type": "node",
            "positions": [[0.0, 0.0, 0.0]], "output_variables": ["REACTION"], "search_tolerance": 100.0,
            "output_file_settings": {"file_name": "points"}})),
    ]});
}

#[test]
fn contact_in_the_plane() {
    all(&[
        Case { folder: "cases/contact_2d/friction_slide", change: with_files, steps: 5 },
        case("cases/contact_2d/cattaneo_mindlin_light_coarse_penalty", 6),
        case("cases/contact_2d/friction_penalty_slide", 5),
        case("cases/contact_2d/uzawa", 4),
        case("cases/contact_2d/nitsche", 4),
        case("cases/contact_2d/opening", 4),
        case("cases/self_contact/slit", 4),
    ]);
}

#[test]
fn contact_in_space() {
    all(&[
        case("cases/contact_3d/friction_slide", 4),
        case("cases/contact_3d/friction_iterative_engine", 4),
        Case {
            folder: "cases/contact_3d/hexahedra_nonmatching",
            change: |deck| solver(deck, json!({"solver_type": "amgcl", "direct_below": 0})),
            steps: 4,
        },
    ]);
}

#[test]
fn ties_and_constraints() {
    all(&[
        case("cases/mesh_tying/quadrilaterals", 4),
        case("cases/mpc/pressed_and_opened", 6),
        case("cases/mpc/tying_matching", 4),
        case("cases/mpc/mapped_field", 4),
        case("cases/constraints/rigid_plate", 4),
        case("cases/constraints/tightened_bolt", 4),
        case("cases/constraints/coupled_block", 4),
        case("cases/constraints/rigid_plate_elimination", 4),
        DIRECTIONS,
        SLOPE,
    ]);
}

#[test]
fn motion() {
    all(&[
        case("decks/bouncing_block", 40),
        Case { folder: "decks/bouncing_block", change: |deck| scheme(deck, "generalized_alpha"), steps: 40 },
        Case { folder: "decks/bouncing_block", change: |deck| scheme(deck, "bdf2"), steps: 40 },
        case("decks/oscillator", 40),
        Case { folder: "cases/constraints/coupled_block", change: swing_a_body, steps: 10 },
        case("cases/contact_3d/explicit_touch", 50),
        Case { folder: "decks/oscillator", change: explicit_with_scaled_mass, steps: 40 },
    ]);
}

#[test]
fn materials_that_remember_and_paths_through_limits() {
    all(&[
        case("decks/squeezed_block", 6),
        case("cases/structural/mixture_of_layers", 6),
        case("decks/truss", 8),
        case("cases/structural/stages_of_plastic_flow", 0),
        case("cases/structural/two_stages", 0),
    ]);
}

/// Heat alone, through contact, of friction, in staggered coupling with the structure, and wear.
const HEAT_AND_WEAR: [Case; 5] = [
    Case { folder: "../examples/transient_slab", change: |deck| ends(deck, 0.1), steps: 6 },
    case("../examples/bars_in_thermal_contact", 2),
    Case { folder: "../examples/rubbing_blocks", change: |deck| ends(deck, 6e-4), steps: 6 },
    Case { folder: "../examples/barber_rod", change: |deck| ends(deck, 0.03), steps: 6 },
    Case { folder: "../examples/worn_pin", change: |deck| ends(deck, 0.06), steps: 6 },
];

fn ends(deck: &mut Value, time: f64) {
    deck["problem_data"]["end_time"] = json!(time);
}

#[test]
fn heat_and_wear() {
    all(&HEAT_AND_WEAR);
}

#[test]
fn heat_and_wear_go_on_over_other_ranks() {
    elsewhere(&HEAT_AND_WEAR);
}

/// The deck of a slide, its folder and a run of it saved after a step.
fn saved_slide() -> (tempfile::TempDir, PathBuf) {
    let scratch = scratch_copy(&root().join("tests/cases/contact_2d/friction_slide"));
    let mut simulation = open(scratch.path(), 1);
    assert!(simulation.step(&mut Silent).expect("a step"));
    let saved = scratch.path().join("saved");
    simulation.save(&saved).expect("a saved run");
    (scratch, saved)
}

fn refusal(folder: &Path, saved: &Path) -> String {
    match open(folder, 1).load(saved, &mut Silent) {
        Err(error @ Error::Input(_)) => error.to_string(),
        other => panic!("it is refused, and not {other:?}"),
    }
}

/// Both stages of a run, and the moment between them.
#[test]
fn stages_go_on_from_between() {
    let scratch = scratch_copy(&root().join("tests/cases/structural/stages_of_plastic_flow"));
    let mut whole = open(scratch.path(), 1);
    whole.run(&mut Silent).expect("a run");
    let saved = scratch.path().join("saved");
    for steps in 0..whole.records().len() {
        let mut first = open(scratch.path(), 1);
        for _ in 0..steps {
            assert!(first.step(&mut Silent).expect("a step"));
        }
        first.save(&saved).expect("a saved run");
        drop(first);
        let mut second = open(scratch.path(), 1);
        second.load(&saved, &mut Silent).expect("a run to go on with");
        second.run(&mut Silent).expect("the rest");
        assert_same(&format!("after {steps} steps"), &whole, &second);
    }
}

#[test]
fn other_decks_and_meshes_and_begun_runs_are_refused() {
    let (scratch, saved) = saved_slide();
    let mut begun = open(scratch.path(), 1);
    begun.prepare(&mut Silent).expect("a deck");
    let error = begun.load(&saved, &mut Silent).expect_err("it has begun").to_string();
    assert!(error.contains("has begun"), "{error}");
    support::change(scratch.path(), "mesh.mdpa", "Begin Nodes\n", "Begin Nodes\n 99999 1e3 1e3 0.0\n");
    let said = refusal(scratch.path(), &saved);
    assert!(said.contains("mesh of Structure") && said.contains("saved"), "{said}");
    support::change(scratch.path(), DECK, "\"max_iteration\": 30", "\"max_iteration\": 31");
    let said = refusal(scratch.path(), &saved);
    assert!(said.contains("another deck") && said.contains("from its start"), "{said}");
    let said = refusal(scratch.path(), &scratch.path().join("mesh.mdpa"));
    assert!(said.contains("no saved run") && said.contains("mesh.mdpa"), "{said}");
}

/// An output file that a run would append to, and that is gone, is named, instead of being begun anew without its beginning.
#[test]
fn files_of_output_must_be_there() {
    let scratch = scratch_copy(&root().join("tests/cases/contact_2d/friction_slide"));
    let mut deck: Value =
        serde_json::from_str(&std::fs::read_to_string(scratch.path().join(DECK)).expect("the deck")).expect("JSON");
    with_files(&mut deck);
    std::fs::write(scratch.path().join(DECK), deck.to_string()).expect("the deck");
    let mut simulation = open(scratch.path(), 1);
    assert!(simulation.step(&mut Silent).expect("a step"));
    let saved = scratch.path().join("saved");
    simulation.save(&saved).expect("a saved run");
    std::fs::remove_file(scratch.path().join("points_1.dat")).expect("a history");
    let error = open(scratch.path(), 1).load(&saved, &mut Silent).expect_err("it is gone").to_string();
    assert!(error.contains("points_1.dat"), "{error}");
}

fn of_rank(folder: &Path, ranks: &Ranks) -> Simulation {
    let options = RunOptions { threads: Some(1), ranks: ranks.clone(), ..RunOptions::default() };
    Simulation::open(&folder.join(DECK), &options).expect("a deck")
}

/// Several ranks save one file, and go on with the same bits where they are as many as they were.
#[test]
fn ranks_go_on_as_many_as_they_were() {
    for case in ["contact_2d/friction_slide", "contact_3d/friction_slide"] {
        let scratch = scratch_copy(&root().join("tests/cases").join(case));
        let saved = scratch.path().join("saved");
        on_threads(3, |ranks| {
            let mut whole = of_rank(scratch.path(), &ranks);
            whole.run(&mut Silent).expect("a run");
            let mut first = of_rank(scratch.path(), &ranks);
            assert!(first.step(&mut Silent).expect("a step"));
            first.save(&saved).expect("a saved run");
            drop(first);
            let mut second = of_rank(scratch.path(), &ranks);
            second.load(&saved, &mut Silent).expect("a run to go on with");
            second.run(&mut Silent).expect("the rest");
            assert_same(&format!("{case}, {ranks:?}"), &whole, &second);
        });
    }
}

/// Numbers of all nodes of a run that some ranks have made together, by name and id; those of the owners.
fn by_id(simulation: &Simulation) -> BTreeMap<String, BTreeMap<usize, Vec<f64>>> {
    let nodes = &simulation.part().expect("a part").nodes;
    let mut out = BTreeMap::new();
    for (kind, fields) in [("history", &nodes.history), ("values", &nodes.values)] {
        for (name, field) in fields.iter() {
            let of_node = |at: usize| field.levels[0][at * field.components..][..field.components].to_vec();
            let owned = (0..nodes.len()).filter(|&at| simulation.part().is_some_and(|part| part.owns_node(at)));
            out.insert(format!("{kind} {name}"), owned.map(|at| (nodes.ids[at], of_node(at))).collect());
        }
    }
    out
}

type Numbers = BTreeMap<String, BTreeMap<usize, Vec<f64>>>;

fn joined(of_ranks: Vec<Numbers>) -> Numbers {
    let mut all = Numbers::new();
    for (name, values) in of_ranks.into_iter().flatten() {
        all.entry(name).or_default().extend(values);
    }
    all
}

/// The largest difference of two runs over the largest number, by name; of quantities that both have.
fn differences(a: &Numbers, b: &Numbers) -> Vec<(String, f64)> {
    let difference = |(name, values): (&String, &BTreeMap<usize, Vec<f64>>)| {
        let other = &b[name];
        assert!(values.keys().eq(other.keys()), "{name}");
        let numbers = || values.iter().flat_map(|(id, own)| own.iter().zip(&other[id]));
        let most = numbers().fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        let scale = numbers().fold(0.0_f64, |most, (a, _)| most.max(a.abs()));
        (name.clone(), if most > 0.0 { most / scale } else { 0.0 })
    };
    a.iter().map(difference).collect()
}

/// All steps of a case over `ranks` ranks.
fn whole_over(folder: &Path, ranks: usize) -> Numbers {
    joined(on_threads(ranks, |ranks| {
        let mut whole = of_rank(folder, &ranks);
        whole.run(&mut Silent).expect("a run");
        by_id(&whole)
    }))
}

/// Runs a case over `were` ranks, saved on the way, and on from there over `are`: displacements are those of the run that was not
/// stopped to 1e-10, and no number is farther from it than those of a run over `are` ranks.
fn goes_on_elsewhere(case: &Case, were: usize, are: usize) {
    let scratch = prepared(case);
    let [whole, other] = [were, are].map(|ranks| whole_over(scratch.path(), ranks));
    let saved = scratch.path().join("saved");
    on_threads(were, |ranks| {
        let mut first = of_rank(scratch.path(), &ranks);
        for _ in 0..(case.steps / 2).max(1) {
            assert!(first.step(&mut Silent).expect("a step"));
        }
        first.save(&saved).expect("a saved run");
    });
    let again = joined(on_threads(are, |ranks| {
        let mut second = of_rank(scratch.path(), &ranks);
        second.load(&saved, &mut Silent).expect("a run to go on with");
        second.run(&mut Silent).expect("the rest");
        by_id(&second)
    }));
    for ((name, here), (_, there)) in differences(&whole, &again).into_iter().zip(differences(&whole, &other)) {
        let most = if name.ends_with(" DISPLACEMENT") { 1e-10 } else { (10.0 * there).max(1e-10) };
        assert!(here <= most, "{}, {were} ranks and then {are}: {name} differs by {here:e}, {there:e}", case.folder);
    }
}

fn elsewhere(cases: &[Case]) {
    for case in cases {
        [(1, 3), (3, 1), (2, 3)].into_iter().for_each(|(were, are)| goes_on_elsewhere(case, were, are));
    }
}

#[test]
fn contact_goes_on_over_other_ranks() {
    elsewhere(&[
        Case { folder: "cases/contact_2d/friction_slide", change: with_files, steps: 5 },
        case("cases/contact_3d/friction_slide", 4),
        Case {
            folder: "cases/contact_2d/uzawa",
            change: |deck| deck["problem_data"]["end_time"] = json!(0.5),
            steps: 4,
        },
        case("cases/contact_2d/nitsche", 4),
        case("cases/self_contact/slit", 4),
        Case {
            folder: "cases/mpc/pressed_and_opened",
            change: |deck| deck["problem_data"]["end_time"] = json!(1.0),
            steps: 4,
        },
        case("cases/mesh_tying/quadrilaterals", 4),
        DIRECTIONS,
        SLOPE,
    ]);
}

#[test]
fn motion_goes_on_over_other_ranks() {
    elsewhere(&[
        case("decks/bouncing_block", 40),
        Case { folder: "decks/bouncing_block", change: |deck| scheme(deck, "generalized_alpha"), steps: 40 },
        Case { folder: "decks/bouncing_block", change: |deck| scheme(deck, "bdf2"), steps: 40 },
        case("cases/contact_3d/explicit_touch", 50),
        Case { folder: "decks/oscillator", change: explicit_with_scaled_mass, steps: 40 },
    ]);
}

#[test]
fn materials_that_remember_go_on_over_other_ranks() {
    elsewhere(&[
        case("decks/squeezed_block", 6),
        case("cases/structural/mixture_of_layers", 6),
        case("cases/structural/stages_of_plastic_flow", 0),
    ]);
}
