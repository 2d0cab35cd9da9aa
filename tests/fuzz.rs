//! Readers given random bytes: the targets of `fuzz`, over its corpus and mistakes made in it, for a bounded time.
//!
//! `ZELUS_FUZZ_SECONDS` says how long, for each target; failing inputs are kept in the folder for temporary files.

#[path = "../fuzz/src/forge.rs"]
mod forge;
#[path = "../fuzz/src/targets.rs"]
mod targets;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

const WORDS: [&str; 24] = [
    "Begin ",
    "End ",
    "Begin SubModelPart A\n",
    "Nodes\n",
    "Elements SmallDisplacementElement2D4N\n",
    "[3] (",
    "4294967295",
    "-1",
    "1e308",
    "nan",
    "//",
    "/*",
    "*/",
    "{",
    "}",
    "[",
    "]",
    "\"",
    ":",
    ",",
    "\\u12",
    "<DataArray ",
    "offset=\"",
    "\u{e9}",
];

/// Numbers from a seed.
struct Dice(u64);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count.max(1)
    }
}

/// A seed with up to eight mistakes.
fn mistaken(seeds: &[Vec<u8>], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = seeds[dice.below(seeds.len())].clone();
    for _ in 0..1 + dice.below(8) {
        let at = dice.below(bytes.len() + 1);
        let end = (at + dice.below(64)).min(bytes.len());
        match dice.below(7) {
            0 if at < bytes.len() => bytes[at] = dice.below(256) as u8,
            1 if at < bytes.len() => bytes[at] ^= 1 << dice.below(8),
            2 => drop(bytes.drain(at..end)),
            3 => drop(bytes.splice(at..at, WORDS[dice.below(WORDS.len())].bytes())),
            4 => {
                let copy = bytes[at..end].to_vec();
                let to = dice.below(bytes.len() + 1);
                drop(bytes.splice(to..to, copy));
            }
            5 if dice.below(8) == 0 => bytes.truncate(at),
            _ => {
                let other = &seeds[dice.below(seeds.len())];
                let from = dice.below(other.len() + 1);
                let part = other[from..(from + dice.below(256)).min(other.len())].to_vec();
                drop(bytes.splice(at..end, part));
            }
        }
    }
    bytes
}

/// Whether a target has come back, and quickly.
fn holds(target: fn(&[u8]), bytes: &[u8]) -> Option<bool> {
    let start = Instant::now();
    catch_unwind(AssertUnwindSafe(|| target(bytes))).ok()?;
    Some(start.elapsed() < Duration::from_secs(20))
}

/// Gives the seeds, and mistakes in them, to a target.
fn attack(name: &str, target: fn(&[u8]), more: &[Vec<u8>]) {
    let seconds = std::env::var("ZELUS_FUZZ_SECONDS").ok().and_then(|text| text.parse().ok()).unwrap_or(2.0);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(name);
    let entries = std::fs::read_dir(&folder).into_iter().flatten().flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    let mut seeds: Vec<Vec<u8>> = paths.iter().map(|path| std::fs::read(path).expect("a seed")).collect();
    seeds.extend(more.iter().cloned());
    assert!(!seeds.is_empty(), "{name} has no corpus");
    let (begun, mut dice, mut count) = (Instant::now(), Dice(1), 0_usize);
    while count < seeds.len() || begun.elapsed().as_secs_f64() < seconds {
        let bytes = if count < seeds.len() { seeds[count].clone() } else { mistaken(&seeds, &mut dice) };
        // A machine may stand still once, not twice at the same input.
        if !holds(target, &bytes).is_some_and(|quick| quick || holds(target, &bytes) == Some(true)) {
            let kept = std::env::temp_dir().join(format!("zelus-fuzz-{name}-{count}"));
            std::fs::write(&kept, &bytes).expect("a file");
            panic!("{name}: input {count}, kept in {}", kept.display());
        }
        count += 1;
    }
    println!("{name}: {count} inputs");
}

#[test]
fn meshes() {
    attack("mdpa", targets::mdpa, &[]);
}

#[test]
fn decks() {
    attack("json", targets::json, &[]);
}

#[test]
fn saved_runs() {
    attack("checkpoint", targets::checkpoint, &[targets::saved()]);
}

#[test]
fn forged_runs() {
    attack("forged", targets::forged, &[vec![0; 64], (0..=255).collect()]);
}

#[test]
fn pictures() {
    attack("vtu", targets::vtu, &[]);
}
