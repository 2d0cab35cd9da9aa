//! `zelus report`: a page that a browser draws without a network.

use crate::support;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::{change, root, said, scratch_copy, zelus};

const DECK: &str = "ProjectParameters.json";

/// A run with its page.
fn page(deck: &str, prepare: impl Fn(&Path)) -> (tempfile::TempDir, PathBuf) {
    let folder = scratch_copy(&root().join(deck));
    prepare(folder.path());
    let output = zelus(folder.path(), &["run", DECK, "--report", "run.json", "-q"]);
    assert!(output.status.success(), "{}", said(&output));
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

/// Text of a page as the browser shows it.
fn opened(browser: &str, page: &Path) -> String {
    let home = tempfile::tempdir().expect("a folder");
    let profile = format!("--user-data-dir={}", home.path().display());
    let address = format!("file://{}", page.display());
    let mut command = Command::new(browser);
    command.args([
        "--headless",
        "--no-sandbox",
        "--disable-dev-shm-usage",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
    ]);
    command.args([&profile, "--virtual-time-budget=20000", "--dump-dom", &address]);
    let output = command.output().expect("the browser starts");
    assert!(output.status.success(), "{}", said(&output));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// A number that the page has left on its first element.
fn told(dom: &str, name: &str) -> Option<usize> {
    let (_, rest) = dom.split_once("<html")?.1.split_once('>')?.0.split_once(&format!("data-{name}=\""))?;
    rest.split_once('"')?.0.parse().ok()
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
            "<h2>Convergence</h2>",
            "<h2>Contact ",
            "<h2>Balance of DISPLACEMENT</h2>",
            "<h2>Energies</h2>",
            "largest memory",
            " MB<",
        ] {
            assert!(dom.contains(words), "{deck}: {words} is not on the page");
        }
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
