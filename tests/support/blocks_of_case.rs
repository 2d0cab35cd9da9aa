//! The two blocks of the case `contact_2d/matching`, moved.

/// The first node of the upper block, and the last.
const UPPER: std::ops::RangeInclusive<usize> = 13..=24;

/// The mesh with blocks of this height and a gap between them.
pub fn raised(mesh: &str, height: f64, gap: f64) -> String {
    let (before, rest) = mesh.split_once("Begin Nodes\n").expect("nodes");
    let (nodes, after) = rest.split_once("End Nodes").expect("an end");
    let moved = nodes.lines().map(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let (id, y): (usize, f64) = (words[0].parse().expect("an id"), words[2].parse().expect("a number"));
        format!("{id} {} {} 0\n", words[1], height * y + if UPPER.contains(&id) { gap } else { 0.0 })
    });
    format!("{before}Begin Nodes\n{}End Nodes{after}", moved.collect::<String>())
}
