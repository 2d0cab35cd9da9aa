//! The results of a run as they lie on the disk: series of pictures and histories, by name.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde_json::Value;
use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::io::results::{Column, Dataset, read_pvd, read_vtu};
use zelus_core::{Error, Result};

use super::report::is_report;

/// The steps of one series, in order.
pub(super) type Series = Vec<Frame>;

/// One step of a series.
#[derive(Debug)]
pub(super) struct Frame {
    /// Its time, where the series says it.
    pub time: Option<f64>,
    source: Source,
}

#[derive(Debug)]
enum Source {
    Picture(PathBuf),
    /// Values at one time in a file of histories.
    Values(Box<Dataset>),
}

impl Frame {
    /// Its points and fields; points of histories have ids and no positions.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(super) fn read(&self) -> Result<Dataset> {
        match &self.source {
            Source::Picture(path) => read_vtu(path),
            Source::Values(values) => Ok((**values).clone()),
        }
    }
}

/// All series below a folder, of the outputs that a report names, or of one file, by the name that tells them apart.
///
/// # Errors
/// A path without results, or with damaged ones.
pub(super) fn find(path: &Path) -> Result<BTreeMap<String, Series>> {
    if !path.exists() {
        return Err(without_results(path, "there is no such file or folder"));
    }
    let mut found = BTreeMap::new();
    if path.is_dir() {
        let (mut files, mut listed) = (Vec::new(), BTreeSet::new());
        below(path, &mut files)?;
        let is = |file: &&PathBuf, ending: &str| file.extension().is_some_and(|own| own == ending);
        for file in files.iter().filter(|file| is(file, "pvd")) {
            listed.extend(read_pvd(file)?.into_iter().map(|(_, picture)| picture));
            found.insert(name_in(path, file), series(file)?);
        }
        let single = files.iter().filter(|file| is(file, "vtu") && !listed.contains(*file) && listed.is_empty());
        for file in single.chain(files.iter().filter(|file| is(file, "json"))) {
            match series(file) {
                Ok(series) => drop(found.insert(name_in(path, file), series)),
                Err(error) if is(&file, "vtu") => return Err(error),
                Err(_) => {}
            }
        }
    } else if let Some(outputs) = outputs_of(path) {
        for output in outputs {
            let beside = path.with_file_name(&output);
            let place = if output.exists() || !beside.exists() { &output } else { &beside };
            if place.is_dir() {
                let name = |own: String| format!("{}/{own}", file_name(place));
                found.extend(find(place)?.into_iter().map(|(own, series)| (name(own), series)));
            } else if ["pvd", "vtu", "json"].iter().any(|known| place.extension().is_some_and(|own| own == *known)) {
                found.insert(file_name(place), series(place)?);
            }
        }
    } else {
        found.insert(file_name(path), series(path)?);
    }
    if found.is_empty() {
        return Err(without_results(path, "there are no results that can be read"));
    }
    Ok(found)
}

fn series(path: &Path) -> Result<Series> {
    let picture = |path| Source::Picture(path);
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("pvd") => Ok(read_pvd(path)?
            .into_iter()
            .map(|(time, file)| Frame { time: Some(time), source: picture(file) })
            .collect()),
        Some("json") => histories(path),
        _ => Ok(vec![Frame { time: None, source: picture(path.to_owned()) }]),
    }
}

fn below(folder: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    let failed = |error: std::io::Error| Error::System(format!("{}: {error}", folder.display()));
    let entries = std::fs::read_dir(folder).map_err(failed)?;
    let mut entries: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    entries.sort();
    for entry in entries {
        if !entry.is_dir() {
            files.push(entry);
        } else if !entry.is_symlink() {
            below(&entry, files)?;
        }
    }
    Ok(())
}

fn name_in(folder: &Path, file: &Path) -> String {
    file.strip_prefix(folder).unwrap_or(file).display().to_string()
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

fn json_of(path: &Path) -> Option<Value> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

/// The outputs of a report; nothing where the file is none.
fn outputs_of(path: &Path) -> Option<Vec<PathBuf>> {
    let report = json_of(path).filter(is_report)?;
    Some(report.get("outputs")?.as_array()?.iter().filter_map(Value::as_str).map(PathBuf::from).collect())
}

/// Histories that json_output_process has written: numbers by node and variable, one a time.
fn histories(path: &Path) -> Result<Series> {
    let wrong = || without_results(path, "it is no report, and holds no histories of nodes");
    let root = json_of(path).ok_or_else(wrong)?;
    let times = root.get("TIME").and_then(Value::as_array).ok_or_else(wrong)?;
    let nodes: Vec<(usize, &Value)> = root
        .as_object()
        .into_iter()
        .flatten()
        .filter_map(|(key, values)| Some((key.strip_prefix("NODE_")?.parse().ok()?, values)))
        .collect();
    let mut names: BTreeSet<&String> = BTreeSet::new();
    nodes.iter().for_each(|(_, values)| names.extend(values.as_object().into_iter().flatten().map(|(name, _)| name)));
    let frame = |at: usize| {
        let column = |name: &&String| {
            let numbers = |(_, values): &(usize, &Value)| match values.get(name.as_str()).and_then(|all| all.get(at)) {
                Some(Value::Array(several)) => several.iter().map(|x| x.as_f64().unwrap_or(f64::NAN)).collect(),
                other => vec![other.and_then(Value::as_f64).unwrap_or(f64::NAN)],
            };
            let values: Vec<Vec<f64>> = nodes.iter().map(numbers).collect();
            let components = values.iter().map(Vec::len).max().unwrap_or(1).max(1);
            let filled = values.into_iter().flat_map(|mut own| {
                own.resize(components, f64::NAN);
                own
            });
            Column::real(name.as_str(), components, filled.collect())
        };
        let ids: Vec<usize> = nodes.iter().map(|(id, _)| *id).collect();
        let points = vec![[f64::NAN; 3]; ids.len()];
        Dataset { point_ids: ids, points, point_data: names.iter().map(column).collect(), ..Dataset::default() }
    };
    let time = |at: usize| times[at].as_f64();
    Ok((0..times.len()).map(|at| Frame { time: time(at), source: Source::Values(Box::new(frame(at))) }).collect())
}

fn without_results(path: &Path, fact: &str) -> Error {
    let problem = Diagnostic::error("no-results", fact).at(Place::file(path));
    problem.remedy("name a folder with .pvd, .vtu or .json results, one of these files, or a report of a run").into()
}
