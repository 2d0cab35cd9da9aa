//! `zelus report`: a page that a browser draws without a network.

use crate::support;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::blocks::{Deck, Joint, Mesh};
use crate::support::{change, root, run_with_report, said, scratch_copy, zelus};
use serde_json::{Value, json};

const DECK: &str = "ProjectParameters.json";

/// A run with its page.
fn page(deck: &str, prepare: impl Fn(&Path)) -> (tempfile::TempDir, PathBuf) {
    let folder = scratch_copy(&root().join(deck));
    prepare(folder.path());
    run_with_report(folder.path(), DECK);
    let output = zelus(folder.path(), &["report", "run.json", "-o", "page.html"]);
    assert!(output.status.success(), "{}", said(&output));
    let page = folder.path().join("page.html");
    (folder, page)
}

/// A block on another in space, which is drawn.
fn in_space(folder: &Path) {
    let output = r#""vtu": [{"python_module": "vtu_output_process", "kratos_module": "KratosMultiphysics", "Parameters": {
        "model_part_name": "Structure", "nodal_solution_step_data_variables": ["DISPLACEMENT", "REACTION"]}}], "constraints_process_list""#;
    change(folder, DECK, "\"constraints_process_list\"", output);
}

fn browser() -> Option<&'static str> {
    let runs = |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"].into_iter().find(runs)
}

/// Text of a page as the browser shows it in a window of this width and 900 points of height, with the words after # in its address; its
/// picture goes to a file.
fn opened_in(browser: &str, page: &Path, width: usize, words: &str, picture: Option<&Path>) -> String {
    let home = tempfile::tempdir().expect("a folder");
    let profile = format!("--user-data-dir={}", home.path().display());
    let address = format!("file://{}{words}", page.display());
    let mut command = Command::new(browser);
    command.args([
        "--headless",
        "--no-sandbox",
        "--disable-dev-shm-usage",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--virtual-time-budget=20000",
    ]);
    command.args([profile, format!("--window-size={width},900")]);
    if let Some(file) = picture {
        command.arg("--hide-scrollbars").arg(format!("--screenshot={}", file.display()));
    }
    let output = command.args(["--dump-dom", &address]).output().expect("the browser starts");
    assert!(output.status.success(), "{}", said(&output));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Text of a page as the browser shows it.
fn opened(browser: &str, page: &Path) -> String {
    opened_in(browser, page, 1400, "", None)
}

/// Words that the page has left on its first element.
fn word<'d>(dom: &'d str, name: &str) -> Option<&'d str> {
    let (_, rest) = dom.split_once("<html")?.1.split_once('>')?.0.split_once(&format!("data-{name}=\""))?;
    Some(rest.split_once('"')?.0)
}

/// A number that the page has left on its first element.
fn told(dom: &str, name: &str) -> Option<usize> {
    word(dom, name)?.parse().ok()
}

#[test]
fn a_browser_draws_the_page() {
    let Some(browser) = browser() else {
        println!("skipped: no chromium (apt-get install chromium)");
        return;
    };
    for (deck, prepare) in [
        ("examples/hertz_line_contact", (|_: &Path| {}) as fn(&Path)),
        ("tests/cases/contact_3d/friction_slide", in_space),
    ] {
        let (_folder, page) = page(deck, prepare);
        let dom = opened(browser, &page);
        let head = &dom[..dom.find("<head").unwrap_or(0)];
        assert!(!head.contains("data-error"), "{deck}: {head}");
        assert!(told(&dom, "ready").is_some_and(|charts| charts >= 5), "{deck}: {head}");
        assert!(told(&dom, "drawn").is_some_and(|points| points > 10_000), "{deck}: {head}");
        for words in [
            ">Convergence</h2>",
            ">Contact ",
            ">Balance of DISPLACEMENT over time</h2>",
            ">Energies</h2>",
            "largest memory",
            " MB<",
        ] {
            assert!(dom.contains(words), "{deck}: {words} is not on the page");
        }
    }
}

/// A quarter of a pin pressed into a hole 0.01 narrower, whose face is the slave.
pub(crate) fn press_fit() -> Deck {
    let mut mesh = Mesh::new(3);
    let ring = |radii: [f64; 2]| {
        move |[r, turn, z]: [f64; 3]| {
            let (radius, (s, c)) =
                (radii[0] + r * (radii[1] - radii[0]), (turn * std::f64::consts::FRAC_PI_2).sin_cos());
            [radius * c, radius * s, z]
        }
    };
    let sides = [mesh.block("Lower", [3, 8, 2], ring([0.4, 1.0])), mesh.block("Upper", [4, 10, 2], ring([0.99, 2.0]))];
    let pick = |place: (usize, usize)| sides.iter().flat_map(move |own| own[&place].0.clone());
    mesh.part("Bottom", pick((2, 0)), Vec::new());
    mesh.part("AlongX", pick((1, 0)), Vec::new());
    mesh.part("AlongY", pick((1, 1)), Vec::new());
    let (pin, hole) = (sides[0][&(0, 1)].clone(), sides[1][&(0, 0)].clone());
    mesh.part("Interface", pin.0.iter().chain(&hole.0).copied(), [pin.1.clone(), hole.1.clone()].concat());
    mesh.part("Slave", hole.0, hole.1);
    let support = |part: &str, axis: usize| {
        let value: [Value; 3] = std::array::from_fn(|c| if c == axis { json!(0.0) } else { Value::Null });
        (part.to_owned(), value)
    };
    let supports = vec![support("Bottom", 2), support("AlongX", 1), support("AlongY", 0)];
    Deck { mesh, joint: Joint::Frictionless, supports, pressure: 0.0, young: 1000.0, steps: 2 }
}

/// The page of the press fit at two sizes of the window: the model in the first screen, coloured by von Mises stress; the pressure in the
/// hole, with the pin hidden, and through a cut. Its pictures are in the folder of the tests' output.
#[test]
fn the_page_shows_what_an_engineer_looks_for() {
    let folder = tempfile::tempdir().expect("a folder");
    press_fit().write(folder.path(), |deck| {
        let output = json!({"python_module": "vtu_output_process", "kratos_module": "KratosMultiphysics",
            "Parameters": {"model_part_name": "Structure"}});
        deck["processes"]["output"] = json!([output]);
    });
    run_with_report(folder.path(), DECK);
    let report = support::read_json(&folder.path().join("run.json")).expect("a report");
    let bodies: Vec<&str> =
        report["bodies"].as_array().into_iter().flatten().filter_map(|own| own["name"].as_str()).collect();
    assert_eq!(bodies, ["Lower", "Upper"]);
    let output = zelus(folder.path(), &["report", "run.json", "-o", "page.html"]);
    assert!(output.status.success(), "{}", said(&output));
    let page = folder.path().join("page.html");
    let Some(browser) = browser() else {
        println!("skipped: no chromium (apt-get install chromium)");
        return;
    };
    let pictures = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report-page");
    std::fs::create_dir_all(&pictures).expect("a folder");
    let largest = |name: &str| (report["largest"][name].as_f64().expect(name), report["places"][name]["node"].as_u64());
    for (name, words, field) in [
        ("model", "", "VON_MISES_STRESS"),
        ("hidden", "#field=CONTACT_PRESSURE&hide=Lower&turn=0.62,-0.52", "CONTACT_PRESSURE"),
        ("cut", "#field=CONTACT_PRESSURE&cut=z&at=0.75&turn=0.62,-0.52", "CONTACT_PRESSURE"),
    ] {
        for width in [1400, 480] {
            let picture = pictures.join(format!("{name}-{width}.png"));
            let dom = opened_in(browser, &page, width, words, Some(&picture));
            assert!(std::fs::metadata(&picture).is_ok_and(|file| file.len() > 10_000), "{}", picture.display());
            let head = &dom[..dom.find("<head").unwrap_or(0)];
            assert!(!head.contains("data-error"), "{name}: {head}");
            assert_eq!(told(&dom, "overflow"), Some(0), "{name} at {width}: {head}");
            // a twentieth of the canvas at least is the model
            assert!(told(&dom, "drawn").is_some_and(|points| points > 8_000), "{name} at {width}: {head}");
            let most: Vec<&str> = word(&dom, "most").unwrap_or_default().split(' ').collect();
            let (value, node) = largest(field);
            assert_eq!(most[0], field, "{name}");
            let shown: f64 = most[1].parse().expect("a number");
            if name == "cut" {
                assert!(shown > 0.5 * value && shown <= value * 1.00001, "{shown} of {value}");
            } else {
                assert!((shown / value - 1.0).abs() < 1e-5, "{name}: {shown} instead of {value}");
                assert_eq!(most[2].parse().ok(), node, "{name}");
            }
        }
    }
    let dom = opened(browser, &page);
    let place = |words: &str| dom.find(words).unwrap_or_else(|| panic!("{words} is not on the page"));
    let order = [
        ">Model</h2>",
        ">Results</h2>",
        ">Reactions by support</h2>",
        ">Forces of contact pairs and ties</h2>",
        ">Errors and warnings (",
        ">Convergence</h2>",
        ">linear solver<",
    ];
    assert!(order.map(place).is_sorted());
    // words of the legend, of the controls and for readers of the screen
    for words in [
        ">von Mises stress (force/area)</strong>",
        "deformation times ",
        ">true (1)</button>",
        ">none (0)</button>",
        "> Upper</label>",
        ">play</button>",
        "role=\"img\"",
        "aria-label=\"Deformed model coloured by von Mises stress",
        "tabindex=\"0\"",
        "aria-live=\"polite\"",
        ">largest displacement</th>",
        ">smallest principal stress</th>",
        ">Bottom</th>",
    ] {
        place(words);
    }
}

#[test]
fn the_page_names_nothing_outside_itself_and_holds_what_a_text_says() {
    let (folder, page) = page("examples/hertz_line_contact", |folder| {
        change(folder, DECK, "\"problem_name\": \"", "\"problem_name\": \"</script><b>");
    });
    let text = std::fs::read_to_string(&page).expect("the page");
    for outside in ["https:", "src=", "@import", "</script><b>"] {
        assert!(!text.contains(outside), "the page holds {outside}");
    }
    let links: Vec<&str> = text.match_indices("http:").map(|(at, _)| &text[at..at + 27]).collect();
    assert!(links.iter().all(|link| *link == "http://www.w3.org/2000/svg\""), "{links:?}");
    assert!(text.contains("&lt;/script>"));
    std::fs::write(folder.path().join("mine.html"), "<p>mine</p>").expect("a file");
    for (report, output, code) in [
        ("run.json", "mine.html", 2),
        ("run.json", "run.json", 2),
        ("run.json", "nowhere/page.html", 4),
        (DECK, "other.html", 2),
        ("nothing.json", "other.html", 2),
    ] {
        let before = support::contents(folder.path());
        let done = zelus(folder.path(), &["report", report, "-o", output]);
        assert_eq!(done.status.code(), Some(code), "{report} {output}: {}", said(&done));
        assert_eq!(support::contents(folder.path()), before);
    }
    assert!(
        zelus(folder.path(), &["report", "run.json", "-o", "page.html"]).status.success(),
        "a page replaces a page"
    );
}

#[test]
fn a_run_that_failed_and_one_without_pictures_have_their_page() {
    let folder = scratch_copy(&root().join("tests/cases/contact_2d/matching"));
    change(folder.path(), "mesh.mdpa", "SmallDisplacementElement2D4N", "TotalLagrangianElement2D4N");
    change(folder.path(), DECK, "\"value\": [null, 0.0, null]", "\"value\": [null, -1.0e200, null]");
    assert_eq!(zelus(folder.path(), &["run", DECK, "--report", "run.json"]).status.code(), Some(3));
    let output = zelus(folder.path(), &["report", "run.json", "-o", "page.html"]);
    assert!(output.status.success() && said(&output).contains("no picture of the mesh"), "{}", said(&output));
    if let Some(browser) = browser() {
        let dom = opened(browser, &folder.path().join("page.html"));
        assert!(told(&dom, "ready").is_some() && !dom[..dom.find("<head").unwrap_or(0)].contains("data-error"));
        assert!(
            dom.contains("not converged") || dom.contains("the step cannot begin"),
            "the failure is not on the page"
        );
    }
}
