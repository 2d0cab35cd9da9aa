//! The page on extending shows the code of this crate, and all of its kinds.

use std::path::Path;

/// Most lines that a kind may take on the page.
const LINES: usize = 40;

#[test]
fn the_page_shows_the_code_of_every_file() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(here.join("../../docs/extending.md")).expect("the page");
    let mut problems = Vec::new();
    for file in std::fs::read_dir(here.join("src")).expect("the sources").flatten() {
        let name = file.file_name().into_string().expect("a name");
        if ["lib.rs", "main.rs"].contains(&name.as_str()) {
            continue;
        }
        let source = std::fs::read_to_string(file.path()).expect("a source");
        let shown = page.split_once(&format!("(../examples/plugin/src/{name})"));
        let block = shown.and_then(|(_, rest)| rest.split_once("```rust\n")?.1.split_once("```"));
        match block {
            None => problems.push(format!("{name} is not shown")),
            Some((block, _)) if !source.contains(block) => problems.push(format!("{name} has no such lines:\n{block}")),
            Some((block, _)) if block.lines().count() > LINES => problems.push(format!("{name}: over {LINES} lines")),
            Some(_) => {}
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}
