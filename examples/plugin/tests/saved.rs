//! Restarted runs of additions from outside are bitwise identical: their history is in the saved run.

use std::path::Path;

use zelus::{RunOptions, Silent, Simulation};
use zelus_plugin as _;

const DECKS: [&str; 3] = ["ProjectParameters.json", "SoftLayer.json", "Friction.json"];

fn results(simulation: &Simulation) -> (Vec<u64>, serde_json::Value) {
    let field = simulation.field("DISPLACEMENT").expect("a field").iter().map(|u| u.to_bits()).collect();
    (field, serde_json::to_value(simulation.records()).expect("records"))
}

#[test]
fn what_additions_remember_is_saved() {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    for file in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("deck")).expect("the decks").flatten() {
        std::fs::copy(file.path(), scratch.path().join(file.file_name())).expect("a copy of the deck");
    }
    let saved = scratch.path().join("saved");
    for deck in DECKS {
        let open = || Simulation::open(&scratch.path().join(deck), &RunOptions::default()).expect("a deck");
        let mut whole = open();
        whole.run(&mut Silent).expect("a run");
        let mut first = open();
        assert!(first.step(&mut Silent).expect("a step"));
        first.save(&saved).expect("a saved run");
        drop(first);
        let mut second = open();
        second.load(&saved, &mut Silent).expect("a run to go on with");
        second.run(&mut Silent).expect("the rest");
        assert_eq!(results(&second), results(&whole), "{deck}");
    }
}

/// The scheme `continued` guesses from the last step: its file names it, by its tag.
#[test]
fn the_state_of_a_scheme_is_tagged() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("deck");
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let text = std::fs::read_to_string(folder.join(DECKS[0])).expect("the deck");
    let mut deck: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    deck.as_object_mut().expect("a deck").remove("output_processes");
    let lists = deck["processes"].as_object_mut().expect("lists");
    lists.retain(|_, list| !list.to_string().contains("output_process"));
    let mut simulation = Simulation::of_value(&deck, &folder, &RunOptions::default()).expect("a deck");
    assert!(simulation.step(&mut Silent).expect("a step"));
    let saved = scratch.path().join("saved");
    simulation.save(&saved).expect("a saved run");
    let bytes = std::fs::read(&saved).expect("the file");
    assert!(bytes.windows(b"continued".len()).any(|word| word == b"continued"));
}
