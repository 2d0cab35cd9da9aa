//! Compares a file that the run writes with a reference, once the run is over.

use crate::assembly::System;
use std::path::{Path, PathBuf};

use super::part_path::one_of;
use crate::diagnostics::{Diagnostic, Error, Place, Result};
use crate::io::FileUse;
use crate::model::{Model, ModelPart};
use crate::parameters::Defaults;
use crate::processes::comparison::is_close;
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;

struct CompareTwoFiles {
    reference: PathBuf,
    output: PathBuf,
    place: Place,
    /// Byte by byte; otherwise word by word, numbers with tolerances.
    exact: bool,
    tolerance: f64,
    relative_tolerance: f64,
    remove: bool,
}

/// All but the first are compared as text, word by word.
const WAYS: [&str; 10] = [
    "deterministic",
    "mesh_file",
    "sol_file",
    "post_res_file",
    "dat_file",
    "csv_file",
    "dat_file_variables_time_history",
    "vtk",
    "case",
    "geo",
];

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let required = ["reference_file_name", "output_file_name"];
    let settings = &request.settings_with(|defaults: Defaults| defaults.require(&required))?;
    let reference = request.folder.join(settings.get_str(required[0])?);
    if !reference.is_file() {
        let fact = format!("there is no reference {}", reference.display());
        let remedy = "\"reference_file_name\" is relative to the deck";
        return Err(settings.error("reference_file_name", "missing-file", fact).remedy(remedy).into());
    }
    Ok(Box::new(CompareTwoFiles {
        reference,
        output: request.results.join(settings.get_str(required[1])?),
        place: settings.key_place("output_file_name"),
        exact: one_of(settings, "comparison_type", &WAYS)? == 0,
        tolerance: settings.get_f64("tolerance")?,
        relative_tolerance: settings.get_f64("relative_tolerance")?,
        remove: settings.get_bool("remove_output_file")?,
    }))
}

fn read(path: &Path, place: &Place) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|error| {
        let fact = format!("{} cannot be compared: {error}", path.display());
        Diagnostic::error("missing-file", fact).at(place.clone()).remedy("an output process must write it").into()
    })
}

/// Lines that say something, with their numbers from 1: comments of columns are left out.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .map(|(at, line)| (at + 1, line.trim()))
        .filter(|(_, l)| !l.is_empty() && !l.starts_with('#'))
}

impl CompareTwoFiles {
    /// Where the files differ first.
    fn difference(&self, wanted: &[u8], found: &[u8]) -> Option<String> {
        if self.exact {
            let same = wanted.iter().zip(found).take_while(|(a, b)| a == b).count();
            let differ = wanted.len() != found.len() || same < wanted.len();
            return differ.then(|| format!("byte {} differs", same + 1));
        }
        let (Ok(wanted), Ok(found)) = (std::str::from_utf8(wanted), std::str::from_utf8(found)) else {
            return Some("they are no text files, which are compared as \"deterministic\" only".to_owned());
        };
        let (mut first, mut second) = (lines(wanted), lines(found));
        loop {
            match (first.next(), second.next()) {
                (None, None) => return None,
                (Some((number, a)), Some((_, b))) if !self.is_same(a, b) => {
                    return Some(format!("line {number} of the reference is {a:?}, not {b:?}"));
                }
                (Some(_), Some(_)) => {}
                (Some((number, _)), None) => return Some(format!("line {number} of the reference is missing")),
                (None, Some((number, _))) => return Some(format!("line {number} is not in the reference")),
            }
        }
    }

    fn is_same(&self, a: &str, b: &str) -> bool {
        let words = |line| str::split(line, |c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
        let same = |a: &str, b: &str| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(a), Ok(b)) => a == b || is_close(a, b, self.tolerance, self.relative_tolerance),
            _ => a == b,
        };
        words(a).count() == words(b).count() && words(a).zip(words(b)).all(|(a, b)| same(a, b))
    }
}

impl Process for CompareTwoFiles {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn files(&self) -> Vec<FileUse> {
        vec![FileUse::Reads(self.reference.clone())]
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        if !model.ranks.is_root() {
            return Ok(());
        }
        let (wanted, found) = (read(&self.reference, &self.place)?, read(&self.output, &self.place)?);
        if let Some(difference) = self.difference(&wanted, &found) {
            let files = format!("{} is not {}", self.output.display(), self.reference.display());
            return Err(Error::System(format!("{}: {files}: {difference}", self.place)));
        }
        if self.remove {
            std::fs::remove_file(&self.output)
                .map_err(|error| Error::System(format!("{} cannot be removed: {error}", self.output.display())))?;
        }
        Ok(())
    }
}

register! { ProcessEntry "compare_two_files_check_process",
    aliases: &["CompareTwoFilesCheckProcess"],
    about: "compares a file that the run writes with a reference at its end; a difference is an error",
    defaults: include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../configs/processes/compare_two_files_check_process.json"
    )),
    build: build,
}
