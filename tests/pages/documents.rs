//! The documents name only existing files.

use crate::support::root;
use std::path::Path;

/// Words between backticks that look like paths of the repository: with a slash or a source file's ending.
fn paths_named(text: &str) -> Vec<&str> {
    let quoted = text.split('`').skip(1).step_by(2);
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    quoted
        .filter(|word| word.chars().all(plain) && !word.starts_with('/') && !word.starts_with("../"))
        .filter(|word| word.contains('/') || [".rs", ".md", ".toml"].iter().any(|end| word.ends_with(end)))
        .collect()
}

fn missing_in(document: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(document).unwrap_or_else(|e| panic!("{}: {e}", document.display()));
    let folder = document.parent().expect("a folder");
    let there = |word: &str| root().join(word).exists() || folder.join(word).exists();
    let missing = paths_named(&text).into_iter().filter(|word| !there(word));
    missing.map(|word| format!("{} names {word}, which is not there", document.display())).collect()
}

#[test]
fn the_map_of_the_code_names_only_paths_that_exist() {
    let map = root().join("ARCHITECTURE.md");
    let text = std::fs::read_to_string(&map).expect("ARCHITECTURE.md");
    assert!(paths_named(&text).len() > 10, "the map names hardly any path");
    let missing = missing_in(&map);
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

#[test]
fn the_guides_name_only_paths_that_exist() {
    let mut missing: Vec<String> =
        ["README.md", "CHANGELOG.md"].iter().flat_map(|n| missing_in(&root().join(n))).collect();
    let mut pending = vec![root().join("docs")];
    while let Some(folder) = pending.pop() {
        for path in std::fs::read_dir(&folder).expect("a folder").map(|e| e.expect("an entry").path()) {
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|end| end == "md") {
                missing.extend(missing_in(&path));
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

#[test]
fn links_between_documents_lead_somewhere() {
    let mut missing = Vec::new();
    let mut pending = vec![root()];
    while let Some(folder) = pending.pop() {
        for path in std::fs::read_dir(&folder).expect("a folder").map(|e| e.expect("an entry").path()) {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && !name.starts_with('.') && name != "target" {
                pending.push(path);
            } else if name.ends_with(".md") {
                let text = std::fs::read_to_string(&path).expect("a document");
                for target in text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
                    let outside = target.is_empty() || target.contains("://") || target.contains(' ');
                    if !outside && !folder.join(target).exists() {
                        missing.push(format!("{} links to {target}, which is not there", path.display()));
                    }
                }
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

/// Numbers of equations in a cell of a table or a sentence: `4.9`, `D.12`; letters are left out, a range counts with both ends.
fn equations_named(text: &str) -> Vec<String> {
    let word = |c: char| c.is_ascii_alphanumeric() || c == '.';
    let numbers = text.split(|c: char| !word(c)).filter_map(|token| {
        let (chapter, number) = token.split_once('.')?;
        let number = number.trim_end_matches(|c: char| !c.is_ascii_digit());
        (matches!(chapter, "4" | "D") && number.parse::<u8>().is_ok()).then(|| format!("{chapter}.{number}"))
    });
    numbers.collect()
}

/// The table of equations leads to pages and files that state the equation under its number.
#[test]
fn equations_stand_where_their_table_says() {
    let folder = root().join("docs/theory");
    let table = std::fs::read_to_string(folder.join("equations.md")).expect("the table");
    let mut problems = Vec::new();
    let mut count = 0;
    for row in table.lines().filter(|line| line.starts_with("| ") && line.contains("](")) {
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").collect();
        let equations = equations_named(cells[0]);
        for target in row.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
            let text = std::fs::read_to_string(folder.join(target)).unwrap_or_else(|e| panic!("{target}: {e}"));
            let stated = equations_named(&text);
            count += equations.len();
            let missing = equations.iter().filter(|equation| !stated.contains(equation));
            problems.extend(missing.map(|equation| format!("{target} does not state eq. {equation}")));
        }
    }
    assert!(count > 80, "hardly any equation is listed");
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}
