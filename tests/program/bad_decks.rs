//! Every bad deck ends with exit code 2, a message of its own with place, fact and remedy, and nothing written.
//!
//! All messages stand on one page, `snapshots/bad_decks__messages.snap`: they are interface.

mod table;

use crate::support::{contents, root, said, scratch_copy, zelus};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use table::{BAD_DECKS, BadDeck, Change};

/// The good deck, with results of an earlier run that a bad run must leave alone.
fn good_deck() -> tempfile::TempDir {
    let scratch = scratch_copy(&root().join("tests/program/bad_decks/good"));
    std::fs::write(scratch.path().join("results.json"), "{\"TIME\": []}").expect("a file");
    std::fs::create_dir(scratch.path().join("vtk_output")).expect("a folder");
    std::fs::write(scratch.path().join("vtk_output/Structure_0_1.vtk"), "# vtk DataFile of an earlier run")
        .expect("a file");
    scratch
}

fn apply(change: &Change, folder: &Path) {
    let edit = |file: &str, with: &dyn Fn(String) -> String| {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path).expect("a file of the good deck");
        std::fs::write(path, with(text)).expect("a file");
    };
    match change {
        Change::Remove(file) => std::fs::remove_file(folder.join(file)).expect("a file of the good deck"),
        Change::Replace(file, find, with) => edit(file, &|text| {
            assert!(text.contains(find), "{file} of the good deck does not have {find:?}");
            text.replacen(find, with, 1)
        }),
        Change::CutAt(file, find) => edit(file, &|text| {
            let at = text.find(find).unwrap_or_else(|| panic!("{file} of the good deck does not have {find:?}"));
            text[..at].to_owned()
        }),
    }
}

/// Faults of the answer to a bad deck, and the message.
fn judge(deck: &BadDeck, command: &str) -> (Vec<String>, String) {
    let BadDeck(_, change, says) = deck;
    let scratch = good_deck();
    apply(change, scratch.path());
    let before = contents(scratch.path());
    let output = zelus(scratch.path(), &[command, "ProjectParameters.json"]);
    let message = String::from_utf8_lossy(&output.stderr).replace(&*scratch.path().to_string_lossy(), "[folder]");
    let mut problems = Vec::new();
    if output.status.code() != Some(2) {
        problems.push(format!("{command} ends with exit code {:?}, not 2", output.status.code()));
    }
    if contents(scratch.path()) != before {
        problems.push(format!("{command} changes files"));
    }
    let lines: Vec<&str> = message.lines().collect();
    let bare = lines.windows(2).find(|pair| pair[0].starts_with("error[") && !pair[1].starts_with("    "));
    if let Some(pair) = bare {
        problems.push(format!("{command} names no remedy: {}", pair[0]));
    }
    let unsaid: Vec<_> = says.iter().filter(|word| !message.contains(**word)).collect();
    if !unsaid.is_empty() {
        problems.push(format!("{command} does not say {unsaid:?}"));
    }
    (problems, message)
}

#[test]
fn the_good_deck_runs() {
    let scratch = good_deck();
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let results = std::fs::read_to_string(scratch.path().join("results.json")).expect("results");
    assert!(results.contains("\"NODE_9\""), "{results}");
}

#[test]
fn every_bad_deck_is_refused_with_its_own_message() {
    let mut page = String::new();
    let mut failed = Vec::new();
    let mut first_with: BTreeMap<String, &str> = BTreeMap::new();
    for deck in BAD_DECKS {
        let (mut problems, message) = judge(deck, "run");
        problems.extend(judge(deck, "check").0);
        if let Some(other) = first_with.insert(message.clone(), deck.0) {
            problems.push(format!("has the message of \"{other}\""));
        }
        if !problems.is_empty() {
            failed.push(format!("{}: {}\n{}", deck.0, problems.join("; "), message.trim_end()));
        }
        writeln!(page, "== {} ==\n{}\n", deck.0, message.trim_end()).expect("text");
    }
    assert!(failed.is_empty(), "{} of {} bad decks\n\n{}", failed.len(), BAD_DECKS.len(), failed.join("\n\n"));
    insta::assert_snapshot!("messages", page);
}
