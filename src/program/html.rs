//! `zelus report`: a run on one page that needs no network.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::io::{Mark, replace_own_file};
use zelus_core::{Error, Result};

use super::colours::MAP;
use super::deformation;
use super::picture::{self, PictureOptions};
use super::quantities;
use super::report::{check_output, is_report};
use super::results::find;
use super::say::say;
use super::skin::view;

const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/style.css");
const SCRIPTS: [&str; 7] = [
    include_str!("page/charts.js"),
    include_str!("page/names.js"),
    include_str!("page/canvas.js"),
    include_str!("page/cut.js"),
    include_str!("page/view.js"),
    include_str!("page/results.js"),
    include_str!("page/sections.js"),
];
/// Start of every page, by which one is recognised.
const MARK: &str = "<!doctype html>\n<!-- zelus report -->";

/// The command line of `zelus report`.
#[derive(Debug, clap::Args)]
pub(super) struct ReportArguments {
    /// The report of a run (`zelus run DECK --report run.json`).
    report: PathBuf,
    /// The HTML page to write.
    #[arg(short, long, default_value = "report.html", conflicts_with = "file")]
    output: PathBuf,
    #[command(flatten)]
    picture: PictureOptions,
}

/// Writes the page.
///
/// # Errors
/// A file that is no report, results that cannot be read, an output that cannot be written or would replace something else.
pub(super) fn run(arguments: &ReportArguments) -> Result<()> {
    let ReportArguments { report: path, output, picture } = arguments;
    if let Some(file) = &picture.file {
        return picture::write(file, path, &read(path)?, picture);
    }
    check_output("the page", output, &[path], Mark::Begins(&[MARK]))?;
    let report = read(path)?;
    let (views, missing) = views(path)?;
    let page = page(&report, &views, &missing);
    replace_own_file(output, |file| file.write_all(page.as_bytes()))?;
    missing.iter().for_each(|what| say(what));
    say(&format!("page: {}", output.display()));
    Ok(())
}

fn read(path: &Path) -> Result<Value> {
    let wrong = |fact: String| {
        let problem = Diagnostic::error("no-report", fact).at(Place::file(path));
        Error::from(problem.remedy("`zelus run DECK --report run.json` writes one"))
    };
    let bytes = std::fs::read(path).map_err(|error| wrong(format!("it cannot be read: {error}")))?;
    let report: Value = serde_json::from_slice(&bytes).map_err(|error| wrong(format!("it is no JSON: {error}")))?;
    if is_report(&report) { Ok(report) } else { Err(wrong("it is no report of a run".to_owned())) }
}

/// The pictures of the run, and why there are none of some.
fn views(report: &Path) -> Result<(Vec<Value>, Vec<String>)> {
    let (mut views, mut missing) = (Vec::new(), Vec::new());
    let all = match find(report) {
        Ok(all) => all,
        Err(error) => return Ok((views, vec![format!("no picture of the mesh: {error}")])),
    };
    for (name, series) in &all {
        match view(name, series) {
            Ok(view) => views.extend(view),
            Err(error) => missing.push(format!("no picture of {name}: {error}")),
        }
    }
    if views.is_empty() && missing.is_empty() {
        missing.push("no picture of the mesh: the deck has no vtu_output_process; with empty lists one writes all that the page shows".to_owned());
    }
    Ok((views, missing))
}

fn page(report: &Value, views: &[Value], missing: &[String]) -> String {
    // Nothing within a text may end the script that holds it.
    let data = json!({
        "report": report,
        "views": views,
        "missing": missing,
        "colours": MAP,
        "quantities": quantities(report, views),
        "first_fields": quantities::FIRST_FIELDS,
        "deformation": [deformation::SEEN, deformation::AIM],
    });
    let data = data.to_string().replace("</", "<\\/");
    let title = report["problem"].as_str().unwrap_or_default();
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    let page = PAGE.replace("{{title}}", &title).replace("{{style}}", STYLE).replace("{{scripts}}", &SCRIPTS.concat());
    format!("{MARK}\n{}", page.replace("{{data}}", &data))
}

/// Words and unit of the fields of all pictures and of the results of the report, by name.
fn quantities(report: &Value, views: &[Value]) -> BTreeMap<String, [String; 2]> {
    let fields = views.iter().filter_map(|view| view["steps"].as_array()).flatten();
    let fields = fields.filter_map(|step| step["fields"].as_array()).flatten().filter_map(|field| field[0].as_str());
    let results = report["largest"].as_object().into_iter().flatten().map(|(name, _)| name.as_str());
    let mut all: Vec<&str> = quantities::names().to_vec();
    all.extend(fields.chain(results));
    all.into_iter().map(|name| (name.to_owned(), [quantities::in_words(name), quantities::unit(name)])).collect()
}
