//! A new user's pin in a lug, pressed with friction in space, with one mistake after the other: the messages lead to the right deck.

use std::f64::consts::PI;
use std::path::Path;

use crate::blocks::{Deck, Joint, Mesh};
use crate::support::{read_json, said, zelus};
use serde_json::{Value, json};

const DECK: &str = "ProjectParameters.json";
const CLEARANCE: f64 = 0.05;

/// Half of a hollow pin in half of a lug, both cut at x = 0 and y = 0; the pin touches the lug below.
fn pin_in_lug(folder: &Path) {
    let mut mesh = Mesh::new(3);
    // Around the x-z plane, along y.
    let ring = |x: [f64; 3], inner: f64, outer: f64, drop: f64| {
        let (radius, angle) = (inner + (outer - inner) * x[0], PI * (x[2] - 0.5));
        let across = if x[2] == 0.0 || x[2] == 1.0 { 0.0 } else { radius * angle.cos() };
        [across, 5.0 * x[1], radius * angle.sin() - drop]
    };
    let lug = mesh.block("Lower", [3, 2, 22], |x| ring(x, 10.0 + CLEARANCE, 25.0, 0.0));
    let pin = mesh.block("Upper", [2, 2, 16], |x| ring(x, 4.0, 10.0, CLEARANCE));
    let (bore, face, hole) = (pin[&(0, 0)].clone(), pin[&(0, 1)].clone(), lug[&(0, 0)].clone());
    mesh.part("Slave", face.0.clone(), face.1.clone());
    mesh.part("Interface", [face.0, hole.0].concat(), [face.1, hole.1].concat());
    mesh.part("Top", bore.0, bore.1);
    let both = |side: (usize, usize)| [pin[&side].0.clone(), lug[&side].0.clone()].concat();
    mesh.part("CutAcross", [both((2, 0)), both((2, 1))].concat(), Vec::new());
    mesh.part("CutAlong", both((1, 0)), Vec::new());
    let held: Vec<usize> = lug[&(0, 1)].0.iter().copied().filter(|&node| mesh.nodes[node - 1][2] > 15.0).collect();
    mesh.part("Held", held, Vec::new());
    let supports = vec![
        ("CutAcross".to_owned(), [json!(0.0), Value::Null, Value::Null]),
        ("CutAlong".to_owned(), [Value::Null, json!(0.0), Value::Null]),
        ("Held".to_owned(), [json!(0.0), json!(0.0), json!(0.0)]),
    ];
    let joint = Joint::Frictional(0.3);
    Deck { mesh, joint, supports, pressure: 50.0, young: 210_000.0, steps: 4 }.write(folder, |deck| {
        // A list that a user leaves out.
        for list in ["contact_settings", ""] {
            let settings = match list {
                "" => &mut deck["solver_settings"],
                list => &mut deck["solver_settings"][list],
            };
            settings.as_object_mut().expect("settings").retain(|key, _| !key.ends_with("_tolerance"));
        }
    });
}

/// Changes the deck; the old one comes back by its text.
fn mistake(folder: &Path, make: impl FnOnce(&mut Value)) {
    let mut deck = read_json(&folder.join(DECK)).expect("the deck");
    make(&mut deck);
    std::fs::write(folder.join(DECK), deck.to_string()).expect("a file");
}

fn go(folder: &Path, command: &str) -> (Option<i32>, String) {
    let output = zelus(folder, &[command, DECK]);
    (output.status.code(), said(&output))
}

fn says(said: &str, words: &[&str]) {
    let unsaid: Vec<&&str> = words.iter().filter(|word| !said.contains(**word)).collect();
    assert!(unsaid.is_empty(), "{unsaid:?} is not in\n{said}");
}

#[test]
fn three_mistakes_in_turn_are_told_with_what_to_do() {
    let scratch = tempfile::tempdir().expect("a folder");
    let folder = scratch.path();
    pin_in_lug(folder);
    let good = read_json(&folder.join(DECK)).expect("the deck");
    let contact = |deck: &mut Value| deck["processes"]["contact_process_list"][0]["Parameters"].take();
    let parameters = contact(&mut good.clone());
    // The contact part is the pin's face alone, no friction is given, and the load is put on the face of the contact.
    mistake(folder, |deck| {
        let parameters = &mut deck["processes"]["contact_process_list"][0]["Parameters"];
        parameters["contact_model_part"] = json!({"0": ["Slave"]});
        parameters.as_object_mut().expect("settings").remove("friction_coefficients");
        deck["processes"]["loads_process_list"][0]["Parameters"]["model_part_name"] = json!("Structure.Slave");
    });
    for command in ["check", "run"] {
        let (status, said) = go(folder, command);
        assert_eq!(status, Some(2), "{said}");
        says(&said, &["empty-contact-side", "has no master facets", "\"contact_model_part\" must hold both sides"]);
    }
    mistake(folder, |deck| {
        deck["processes"]["contact_process_list"][0]["Parameters"]["contact_model_part"] =
            parameters["contact_model_part"].clone();
    });
    let (status, said) = go(folder, "check");
    assert_eq!(status, Some(0), "{said}");
    says(&said, &["no-friction", "everything slides freely", "or \"friction_coefficients\" of the process"]);
    says(&said, &["acts-on-nothing", "no condition of Structure.Slave takes SURFACE_LOAD", "name the part that holds"]);
    mistake(folder, |deck| {
        deck["processes"]["contact_process_list"][0]["Parameters"]["friction_coefficients"] = json!({"0": 0.3});
        // Friction is mended; the load still acts on nothing, so that the pin is never pressed.
    });
    let (status, said) = go(folder, "run");
    says(&said, &["acts-on-nothing", "no condition of Structure.Slave takes SURFACE_LOAD"]);
    // Nothing presses the pin: it stays where it is, or the run says that it is free.
    assert!(
        (status == Some(0) || said.contains("some body can move freely")) && !said.contains("no-friction"),
        "{said}"
    );
    mistake(folder, |deck| {
        deck["processes"]["loads_process_list"][0]["Parameters"]["model_part_name"] = json!("Structure.Top");
    });
    assert_eq!(read_json(&folder.join(DECK)).expect("the deck"), good);
    let (status, said) = go(folder, "run");
    assert!(status == Some(0) && !said.contains("warning["), "{said}");
}

#[test]
fn a_lug_that_nothing_holds_is_named() {
    let scratch = tempfile::tempdir().expect("a folder");
    pin_in_lug(scratch.path());
    mistake(scratch.path(), |deck| {
        deck["processes"]["constraints_process_list"].as_array_mut().expect("a list").pop();
    });
    let (status, said) = go(scratch.path(), "check");
    assert_eq!(status, Some(0), "{said}");
    says(&said, &["held-by-nothing", "of part Lower", "support it in all directions"]);
    let (status, said) = go(scratch.path(), "run");
    assert_eq!(status, Some(4), "{said}");
    says(&said, &["held-by-nothing", "some body can move freely: support it"]);
}
