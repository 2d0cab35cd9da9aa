//! Supports that something else would take the place of.

use crate::DECK;
use crate::support::{root, said, scratch_copy, zelus};

#[test]
fn a_constraint_on_a_supported_node_is_refused() {
    let scratch = scratch_copy(&root().join("tests/cases/structural/bar_thickness"));
    let path = scratch.path().join("mesh.mdpa");
    let mesh = std::fs::read_to_string(&path).expect("the mesh");
    let with = |slave: usize, master: usize| {
        let constraint = format!(
            "Begin Constraints LinearMasterSlaveConstraint DISPLACEMENT_X DISPLACEMENT_X\n1 0.0 [1.0] {slave} {master}\n\
             End Constraints\n\n"
        );
        let (head, parts) = mesh.split_once("Begin SubModelPart").expect("parts");
        std::fs::write(&path, format!("{head}{constraint}Begin SubModelPart{parts}")).expect("a file");
        let output = zelus(scratch.path(), &["run", DECK]);
        (output.status.code(), said(&output))
    };
    let (code, said) = with(1, 7);
    let names = ["error[constraint-on-support]", "DISPLACEMENT_X of node 1"];
    assert!(code == Some(2) && names.iter().all(|name| said.contains(name)), "{code:?} {said}");
    // A free node may follow a supported one, and supported nodes each other.
    for (slave, master) in [(7, 1), (1, 6)] {
        let (code, said) = with(slave, master);
        assert_eq!(code, Some(0), "{slave} follows {master}: {said}");
    }
}
