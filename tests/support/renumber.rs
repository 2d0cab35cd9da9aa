//! Meshes numbered otherwise.

use std::collections::BTreeMap;

/// New ids by the old ones.
pub type Ids = BTreeMap<u64, u64>;

/// New numbers for the nodes, elements and conditions of a mesh file, and its text with them, in reversed order.
pub fn reversed(text: &str) -> (Ids, String) {
    let lines: Vec<Vec<&str>> = text
        .lines()
        .map(|line| line.split("//").next().expect("a first part").split_whitespace().collect())
        .filter(|words: &Vec<&str>| !words.is_empty())
        .collect();
    let mut ids: BTreeMap<&str, Vec<u64>> = BTreeMap::new();
    for (block, words) in in_blocks(&lines) {
        if matches!(block, "Nodes" | "Elements" | "Conditions") {
            ids.entry(block).or_default().push(words[0].parse().expect("an id"));
        }
    }
    let number = |kind: &str| -> Ids {
        let mut old = ids.get(kind).cloned().unwrap_or_default();
        old.sort_unstable();
        old.iter().copied().zip(old.iter().rev().copied()).collect()
    };
    let (nodes, elements, conditions) = (number("Nodes"), number("Elements"), number("Conditions"));
    let renumber = |ids: &Ids, word: &str| ids[&word.parse().expect("an id")].to_string();
    let mut out: Vec<String> = Vec::new();
    let mut pending: Vec<String> = Vec::new();
    let mut blocks: Vec<&str> = Vec::new();
    for words in &lines {
        match words[0] {
            "Begin" => {
                out.append(&mut pending);
                blocks.push(words[1]);
                out.push(words.join(" "));
            }
            "End" => {
                if matches!(blocks.pop(), Some("Nodes" | "Elements" | "Conditions")) {
                    pending.reverse();
                }
                out.append(&mut pending);
                out.push(words.join(" "));
            }
            _ => {
                let block = *blocks.last().expect("inside a block");
                let new: Vec<String> = words
                    .iter()
                    .enumerate()
                    .map(|(at, word)| match (block, at) {
                        ("Nodes" | "NodalData", 0) | ("SubModelPartNodes", _) => renumber(&nodes, word),
                        ("Elements" | "ElementalData", 0) | ("SubModelPartElements", _) => renumber(&elements, word),
                        ("Conditions" | "ConditionalData", 0) | ("SubModelPartConditions", _) => {
                            renumber(&conditions, word)
                        }
                        ("Elements" | "Conditions", 2..) | ("Geometries", 1..) => renumber(&nodes, word),
                        ("Constraints", 3..) if words.len() == 5 => renumber(&nodes, word),
                        _ => (*word).to_owned(),
                    })
                    .collect();
                pending.push(new.join(" "));
            }
        }
    }
    (nodes, out.join("\n") + "\n")
}

/// The lines inside blocks, each with the name of its block.
fn in_blocks<'a>(lines: &'a [Vec<&'a str>]) -> Vec<(&'a str, &'a [&'a str])> {
    let mut blocks = Vec::new();
    let mut found = Vec::new();
    for words in lines {
        match words[0] {
            "Begin" => blocks.push(words[1]),
            "End" => _ = blocks.pop(),
            _ => found.push((*blocks.last().expect("inside a block"), words.as_slice())),
        }
    }
    found
}
