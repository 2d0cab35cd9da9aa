//! Meshes that seem whole and are cut, and tables that hold no numbers.

use serde_json::json;

use crate::DECK;
use crate::support::{read_json, root, said, scratch_copy, zelus};

const CODE: &str = "coincident-nodes";

/// Messages of `zelus check` on a strip of two quadrilaterals, whose lips along x = 1 are two pairs of nodes, with these lines after the
/// elements and processes of contact.
fn strip(more: &str, contact: serde_json::Value) -> String {
    let scratch = scratch_copy(&root().join("tests/cases/structural/bar_thickness"));
    let path = scratch.path().join(DECK);
    let mut deck = read_json(&path).expect("the deck");
    deck["processes"]["contact_process_list"] = contact;
    deck["processes"]["constraints_process_list"] = json!([]);
    deck["processes"]["loads_process_list"] = json!([]);
    deck["processes"]["json_output_process_list"] = json!([]);
    std::fs::write(&path, deck.to_string()).expect("the deck");
    // The bodies meet at 2, 3 and at 5, 8; a third element below joins them where they are one body.
    let mesh = format!(
        "Begin Properties 0\nEnd Properties\nBegin Nodes\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 1 0 0\n6 2 0 0\n7 2 1 0\n8 1 1 0\n\
         End Nodes\nBegin Elements SmallDisplacementElement2D4N\n1 0 1 2 3 4\n2 0 5 6 7 8\nEnd Elements\n{more}\n\
         Begin SubModelPart Body\nBegin SubModelPartNodes\n1\n2\n3\n4\n5\n6\n7\n8\nEnd SubModelPartNodes\n\
         Begin SubModelPartElements\n1\n2\nEnd SubModelPartElements\nEnd SubModelPart\n\
         Begin SubModelPart Left\nBegin SubModelPartNodes\n2\n3\nEnd SubModelPartNodes\nEnd SubModelPart\n\
         Begin SubModelPart Right\nBegin SubModelPartNodes\n5\n8\nEnd SubModelPartNodes\nEnd SubModelPart\n"
    );
    std::fs::write(scratch.path().join("mesh.mdpa"), mesh).expect("the mesh");
    said(&zelus(scratch.path(), &["check", DECK]))
}

#[test]
fn lips_that_nothing_couples_are_named_and_others_not() {
    let cut = strip("", json!([]));
    assert!(cut.contains(CODE) && cut.contains("at 2 places") && cut.contains("2 and 5 at (1, 0, 0)"), "{cut}");
    let constrained = |node: usize, other: usize, id: usize| {
        format!(
            "Begin Constraints LinearMasterSlaveConstraint DISPLACEMENT_X DISPLACEMENT_X\n{id} 0.0 [1.0] {other} {node}\n\
             End Constraints\n"
        )
    };
    let tied = strip(&[constrained(2, 5, 1), constrained(3, 8, 2)].concat(), json!([]));
    assert!(!tied.contains(CODE), "constraints couple them: {tied}");
    let half = strip(&constrained(2, 5, 1), json!([]));
    assert!(half.contains("at 1 place") && half.contains("3 and 8"), "constraints couple the other: {half}");
    let tie = json!([{"python_module": "mesh_tying_process", "Parameters": {"model_part_name": "Structure",
        "mesh_tying_model_part": {"0": ["Left", "Right"]}, "assume_master_slave": {"0": ["Left"]}}}]);
    let tied = strip("", tie);
    assert!(!tied.contains(CODE), "a tie couples them: {tied}");
}

#[test]
fn tables_without_numbers_are_refused() {
    for (cell, code) in [("nan", Some(2)), ("inf", Some(2)), ("2.5e6", Some(0))] {
        let scratch = scratch_copy(&root().join("tests/cases/structural/load_table"));
        let table = format!("time,pressure\n0.0,1.0e6\n2.0,{cell}\n4.0,2.0e6\n");
        std::fs::write(scratch.path().join("load.csv"), table).expect("a table");
        let output = zelus(scratch.path(), &["check", DECK]);
        let said = said(&output);
        let told = said.contains("error[invalid-table]") && said.contains("load.csv:3");
        assert!(output.status.code() == code && told == (code == Some(2)), "{cell}: {said}");
    }
}
