//! Data that pass from stage to stage: fields, multipliers, states of contact; and changes between stages that are refused.
//!
//! Plastic strain is in `tests/cases/structural/stages_of_plastic_flow`.

use crate::support::{Results, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};

const DECK: &str = "ProjectParameters.json";

/// The deck as two stages, the second on the state of the first.
fn in_two_stages(deck: &Value) -> Value {
    let stage = |number: i32| {
        let mut settings = deck.clone();
        if number > 0 {
            settings["solver_settings"]["model_import_settings"] = json!({"input_type": "use_input_model_part"});
            settings["solver_settings"]["material_import_settings"] = json!({"materials_filename": ""});
        }
        settings["problem_data"]["start_time"] = json!(f64::from(number));
        settings["problem_data"]["end_time"] = json!(f64::from(number) + 1.0);
        for process in settings["processes"]["json_output_process_list"].as_array_mut().expect("outputs") {
            let name = &mut process["Parameters"]["output_file_name"];
            *name = json!(format!("{number}_{}", name.as_str().expect("a name")));
        }
        json!({"stage_preprocess": {}, "stage_settings": settings, "stage_postprocess": {}})
    };
    json!({"orchestrator": {"name": "Orchestrators.KratosMultiphysics.SequentialOrchestrator",
            "settings": {"execution_list": ["press", "hold"], "load_from_checkpoint": null, "stage_checkpoints": false}},
        "stages": {"press": stage(0), "hold": stage(1)}})
}

/// REGRESSION: under the same loads the second stage has nothing to do: one iteration, and the numbers of the first to
/// round-off. Lost multipliers or states of contact would take as many iterations as the first stage.
#[test]
fn contact_with_friction_goes_on_as_it_was() {
    for case in ["contact_2d/friction_stick", "contact_3d/friction_stick"] {
        let scratch = scratch_copy(&root().join("tests/cases").join(case));
        let deck = read_json(&scratch.path().join(DECK)).expect("the deck");
        let mut staged = in_two_stages(&deck);
        let second = &mut staged["stages"]["hold"]["stage_settings"]["solver_settings"];
        second["max_iteration"] = json!(1);
        second["step_cutting"] = json!(false);
        std::fs::write(scratch.path().join(DECK), staged.to_string()).expect("the deck");
        let output = zelus(scratch.path(), &["run", DECK]);
        assert!(output.status.success(), "{case}: {}", said(&output));
        for part in ["lower", "upper", "slave"] {
            let [first, second] = [0, 1]
                .map(|stage| Results::read(&scratch.path().join(format!("{stage}_{part}.json"))).expect("results"));
            assert!(second.times()[0] > first.times()[first.len() - 1], "{case}: time goes on");
            for vector in ["DISPLACEMENT", "VECTOR_LAGRANGE_MULTIPLIER"] {
                let quantities = ["X", "Y", "Z"].map(|axis| format!("{vector}_{axis}"));
                let before = quantities.each_ref().map(|quantity| first.nodal(quantity, first.len() - 1));
                let all = before.iter().flat_map(|component| component.values());
                let scale = all.fold(0.0_f64, |most, value| most.max(value.abs()));
                for (quantity, before) in quantities.iter().zip(&before) {
                    for (node, value) in second.nodal(quantity, 0) {
                        let moved = (value - before[&node]).abs();
                        assert!(
                            moved <= 1e-8 * scale,
                            "{case} {quantity} of node {node}: {} then {value}",
                            before[&node]
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn what_is_not_run_between_stages_is_refused_or_said() {
    let scratch = scratch_copy(&root().join("tests/cases/structural/two_stages"));
    let good = read_json(&scratch.path().join(DECK)).expect("the deck");
    let run = |change: &dyn Fn(&mut Value)| {
        let mut deck = good.clone();
        change(&mut deck);
        std::fs::write(scratch.path().join(DECK), deck.to_string()).expect("the deck");
        let output = zelus(scratch.path(), &["run", DECK]);
        (output.status.code(), said(&output))
    };
    type Change = fn(&mut Value);
    let refused: [(Change, &str); 5] = [
        (|deck| deck["orchestrator"]["name"] = json!("Orchestrators.Mine"), "no orchestrator \"Orchestrators.Mine\""),
        (
            |deck| deck["orchestrator"]["settings"]["load_from_checkpoint"] = json!("checkpoints/first"),
            "cannot be read",
        ),
        (|deck| deck["orchestrator"]["settings"]["stage_checkpoints"] = json!(["frist"]), "no stage \"frist\""),
        (
            |deck| deck["stages"]["second"]["stage_preprocess"] = json!({"operations": [{"name": "delete"}]}),
            "\"operations\" of \"stage_preprocess\" is not run",
        ),
        (
            |deck| deck["stages"]["first"]["stage_postprocess"] = json!({"modelers": [{"name": "x"}]}),
            "\"modelers\" of \"stage_postprocess\" is not run",
        ),
    ];
    for (change, words) in refused {
        let (code, said) = run(&change);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(words), "no {words:?} in {said}");
    }
    let empty = json!({"operations": [], "modelers": [], "processes": {}});
    let (code, said) = run(&|deck| deck["stages"]["second"]["stage_preprocess"] = empty.clone());
    assert_eq!(code, Some(0), "{said}");
}
