//! The commands of the book run, and do as its pages say.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::support::{read_json, root, said, scratch_copy, zelus};

/// Examples that pages of the book run.
const TUTORIALS: [&str; 2] = ["examples/disc_on_block", "examples/lug"];

/// A block of commands of a page.
struct Block {
    /// Words after `console`: `example=FOLDER` begins with a copy of that example, `optional=PROGRAM` needs that program.
    words: String,
    commands: Vec<String>,
}

fn blocks(page: &Path) -> Vec<Block> {
    let text = std::fs::read_to_string(page).expect("a page");
    let of = |block: &str| {
        let (words, lines) = block.split_once('\n').expect("a block");
        let commands = lines.lines().filter_map(|line| line.strip_prefix("$ ")).map(str::to_owned).collect();
        Block { words: words.trim().to_owned(), commands }
    };
    text.split("```console").skip(1).filter_map(|rest| rest.split("```").next()).map(of).collect()
}

fn shell(folder: &Path, command: &str) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_zelus")).parent().expect("a folder");
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    Command::new("sh").args(["-c", command]).current_dir(folder).env("PATH", path).output().expect("a shell")
}

/// Runs the blocks of a page one after another in one folder.
fn run_page(name: &str) -> tempfile::TempDir {
    let page = root().join("docs").join(name);
    let blocks = blocks(&page);
    let example = blocks.iter().find_map(|block| block.words.strip_prefix("example=")).expect("an example");
    let scratch = scratch_copy(&root().join("examples").join(example));
    let mut count = 0;
    for block in &blocks {
        let optional = block.words.strip_prefix("optional=");
        if optional.is_some_and(|tool| !shell(scratch.path(), &format!("command -v {tool}")).status.success()) {
            println!("skipped: {:?} of {name}", block.commands);
            continue;
        }
        for command in &block.commands {
            let output = shell(scratch.path(), command);
            assert!(output.status.success(), "{name}: {command}\n{}", said(&output));
            count += 1;
        }
    }
    assert!(count > 3, "{name} has hardly any command");
    scratch
}

#[test]
fn the_first_contact_has_the_pressure_of_hertz() {
    let scratch = run_page("first-contact.md");
    let report = read_json(&scratch.path().join("disc/run.json")).expect("a report");
    let pressure = report["largest"]["CONTACT_PRESSURE"].as_f64().expect("a pressure");
    assert!((pressure / 2710.0 - 1.0).abs() < 0.02, "{pressure}");
    assert!(scratch.path().join("disc/page.html").is_file() && scratch.path().join("disc/disc.png").is_file());
    // The finished deck of the example is the one that the page makes.
    let output = zelus(
        &root().join("examples/disc_on_block"),
        &[
            "run",
            "ProjectParameters.json",
            "-o",
            &scratch.path().join("own").to_string_lossy(),
            "--report",
            &scratch.path().join("own.json").to_string_lossy(),
        ],
    );
    assert!(output.status.success(), "{}", said(&output));
    let own = read_json(&scratch.path().join("own.json")).expect("a report");
    assert!((own["largest"]["CONTACT_PRESSURE"].as_f64().expect("a pressure") / pressure - 1.0).abs() < 1e-9);
}

#[test]
fn the_lug_behaves_as_its_page_says() {
    let scratch = run_page("lug.md");
    let report = read_json(&scratch.path().join("joint/run.json")).expect("a report");
    let step = report["steps"].as_array().expect("steps").last().expect("a step");
    let supports = step["balance"]["supports"].as_array().expect("supports");
    let bottom = supports.iter().find(|own| own["part"] == "Structure.Bottom").expect("the lower support");
    let held = bottom["reaction"][1].as_f64().expect("a reaction");
    // ANALYTIC: the support takes the load of 1000 N; 1e-4 of the criterion of convergence
    assert!((held + 1000.0).abs() < 0.1, "{held}");
    for picture in ["stress.png", "pressure.png"] {
        let bytes = std::fs::read(scratch.path().join("joint").join(picture)).expect("a picture");
        assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 20_000, "{picture}");
    }
    let text = std::fs::read_to_string(root().join("docs/lug.md")).expect("the page");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .map(|line| line.split('|').filter_map(|cell| cell.trim().parse().ok()).collect::<Vec<f64>>())
        .filter(|row| row.len() == 5)
        .collect();
    assert_eq!(rows.len(), 4);
    for (at, row) in rows.iter().enumerate() {
        let report = read_json(&scratch.path().join(format!("friction/row_{}/report.json", at + 1))).expect("a report");
        let pressure = report["largest"]["CONTACT_PRESSURE"].as_f64().expect("a pressure");
        let pair = &report["steps"].as_array().expect("steps").last().expect("one")["balance"]["pairs"][0];
        let force = |axis: usize| -pair["force"][axis].as_f64().expect("a force");
        for (computed, written) in [(pressure, row[1]), (force(0), row[2]), (force(1), row[3])] {
            assert!((computed / written - 1.0).abs() < 1e-3, "{computed} and {written} of {row:?}");
        }
        assert_eq!(pair["slipping"].as_f64(), Some(row[4]));
    }
}

#[test]
fn the_seal_is_squeezed_as_its_page_says() {
    let scratch = run_page("seal.md");
    let report = read_json(&scratch.path().join("run.json")).expect("a report");
    let steps = report["steps"].as_array().expect("steps");
    let force = |squeeze: f64| {
        let step = steps.iter().find(|step| (step["time"].as_f64().expect("a time") - squeeze).abs() < 1e-9);
        let pair = &step.expect("a step")["balance"]["pairs"][0];
        -2.0 * pair["force"][1].as_f64().expect("a force")
    };
    let text = std::fs::read_to_string(root().join("docs/seal.md")).expect("the page");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .map(|line| line.split('|').filter_map(|cell| cell.trim().parse().ok()).collect::<Vec<f64>>())
        .filter(|row| row.len() == 3)
        .collect();
    assert_eq!(rows.len(), 4);
    // REGRESSION: digits of the page
    rows.iter().for_each(|row| assert!((force(row[0]) / row[1] - 1.0).abs() < 1e-3, "{} of {row:?}", force(row[0])));
    // ANALYTIC: Hertz, up to terms of the squeeze over the radius
    assert!((rows[0][1] / rows[0][2] - 1.0).abs() < 0.02, "{rows:?}");
    let pressure = report["largest"]["CONTACT_PRESSURE"].as_f64().expect("a pressure");
    assert!(
        (force(1.0) / 7.401 - 1.0).abs() < 1e-3 && (pressure / 3.76 - 1.0).abs() < 2e-3,
        "{} {pressure}",
        force(1.0)
    );
    // ANALYTIC: the data are those of the constants in the deck
    let fitted = std::fs::read_to_string(scratch.path().join("fitted.json")).expect("materials");
    let moduli = fitted.split("\"OGDEN_MODULI\": [").nth(1).and_then(|rest| rest.split(',').next()).expect("moduli");
    assert!((moduli.parse::<f64>().expect("a modulus") / 1.2 - 1.0).abs() < 2e-3, "{moduli}");
    assert!(scratch.path().join("seal.png").is_file() && scratch.path().join("fitted.svg").is_file());
}

/// Tests run all commands of the gallery: the examples, each with its expected results, and the atlas.
#[test]
fn commands_of_the_gallery_are_those_of_tests() {
    let text = std::fs::read_to_string(root().join("docs/gallery.md")).expect("the page");
    let mut count = 0;
    for line in text.lines().filter_map(|line| line.strip_prefix("    ")) {
        count += 1;
        let folder = line.strip_prefix("zelus run ").and_then(|deck| deck.strip_suffix("/ProjectParameters.json"));
        match (folder, line.strip_prefix("python3 verification/run.py --only ")) {
            (Some(folder), _) => {
                let is_tested = root().join(folder).join("expected.json").is_file() || TUTORIALS.contains(&folder);
                assert!(is_tested, "{line}");
            }
            (_, Some(name)) => assert!(root().join("verification").join(name).is_dir(), "{line}"),
            _ => panic!("the gallery has another command: {line}"),
        }
    }
    assert!(count >= 12, "{count} problems");
}

/// Options that pages name are those of the program.
#[test]
fn command_lines_of_the_pages_have_options_that_are_there() {
    let pages = std::fs::read_dir(root().join("docs")).expect("docs").map(|entry| entry.expect("an entry").path());
    let pages: Vec<PathBuf> = pages.filter(|path| path.extension().is_some_and(|end| end == "md")).collect();
    let (mut wrong, mut count) = (Vec::new(), 0);
    for page in pages {
        let text = std::fs::read_to_string(&page).expect("a page");
        for line in text.lines().filter_map(|line| line.strip_prefix("    zelus ").or(line.strip_prefix("$ zelus "))) {
            let words: Vec<&str> = line.split(['#', '\'']).next().unwrap_or(line).split_whitespace().collect();
            let help = said(&zelus(&root(), &[words[0], "--help"]));
            let options = words.iter().map(|word| word.trim_matches(['[', ']'])).filter(|word| word.starts_with("--"));
            for option in options.map(|word| word.split('=').next().unwrap_or(word)) {
                count += 1;
                if !help.contains(option) {
                    wrong.push(format!("{}: {option} of {line}", page.display()));
                }
            }
        }
    }
    assert!(count > 20, "{count}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
