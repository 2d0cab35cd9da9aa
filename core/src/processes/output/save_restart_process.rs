//! Saves the whole run every so many steps, so much time or so many minutes.

use crate::assembly::System;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use super::part_path::{PartPath, one_of};
use crate::diagnostics::{Result, unfit};
use crate::io::{FileUse, SAVED};
use crate::model::{Model, ModelPart};
use crate::parameters::Defaults;
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;

/// Unit of the interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RestartUnit {
    Time,
    Step,
    Minutes,
}

struct SaveRestart {
    part: PartPath,
    unit: RestartUnit,
    frequency: f64,
    folder: PathBuf,
    /// Files that are kept; `None` for all.
    most: Option<usize>,
    /// Time of the last look at the clock.
    since: Instant,
    saved: Saved,
}

/// Time or step of the next file, and the files so far.
#[derive(Clone, Default, Serialize, Deserialize)]
#[serde(remote = "Self")]
struct Saved {
    next: f64,
    files: Vec<PathBuf>,
}

stored_as_bytes!(Saved);

#[typetag::serde(name = "save_restart")]
impl State for Saved {
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let adapt = |defaults: Defaults| defaults.require(&["model_part_name"]).renamed("io_foldername", "output_path");
    let settings = &request.settings_with(adapt)?;
    let unit = [RestartUnit::Time, RestartUnit::Step, RestartUnit::Minutes];
    let unit = unit[one_of(settings, "restart_control_type", &["time", "step", "minutes"])?];
    let frequency = settings.get_f64("restart_save_frequency")?;
    let most = settings.get_i64("max_files_to_keep")?;
    let wrong = |key: &str, value: String| settings.error(key, "invalid-value", format!("\"{key}\" is {value}"));
    if frequency < 0.0 {
        let problem = wrong("restart_save_frequency", frequency.to_string());
        return Err(problem.remedy("write a positive number, or 0 to save after every step").into());
    }
    if most == 0 || most < -1 {
        let problem = wrong("max_files_to_keep", most.to_string());
        return Err(problem.remedy("write how many files are kept, or -1 for all").into());
    }
    let folder = match (settings.get_bool("save_restart_files_in_folder")?, settings.get_str("output_path")?) {
        (false, _) => request.results.to_owned(),
        (true, "") => request.results.join(format!("{}__restart_files", settings.get_str("model_part_name")?)),
        (true, path) => request.results.join(path),
    };
    let frequency = if unit == RestartUnit::Step { frequency.trunc() } else { frequency };
    Ok(Box::new(SaveRestart {
        part: PartPath::new(settings)?,
        unit,
        frequency,
        folder,
        most: usize::try_from(most).ok(),
        since: Instant::now(),
        saved: Saved { next: frequency, files: Vec::new() },
    }))
}

impl SaveRestart {
    /// Removes the oldest files beyond those that are kept; the latest is whole on the disk by then.
    fn remove_old(&mut self, model: &Model) {
        let surplus = self.most.map_or(0, |most| self.saved.files.len().saturating_sub(most));
        for old in self.saved.files.drain(..surplus).filter(|_| model.ranks.is_root()) {
            // One that cannot be removed is a file more.
            let _ = std::fs::remove_file(old);
        }
    }
}

/// The name of a file in a folder: part and label.
fn file(folder: &Path, part: &str, label: f64) -> PathBuf {
    // Twelve digits, as Kratos writes them.
    let rounded: f64 = format!("{label:.11e}").parse().unwrap_or(label);
    folder.join(format!("{part}_{rounded}.rest"))
}

impl Process for SaveRestart {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        self.part.find(model).map(|_| ())
    }

    fn saves_runs(&self) -> bool {
        true
    }

    fn saves(&mut self, model: &Model) -> Option<PathBuf> {
        let info = &self.part.find(model).ok()?.0.info;
        let (step, time) = (info.step as f64, info.time);
        let (label, due) = match self.unit {
            RestartUnit::Time => (time, time > self.saved.next),
            RestartUnit::Step => (step, step >= self.saved.next),
            RestartUnit::Minutes => {
                (step, model.ranks.any(self.since.elapsed().as_secs_f64() >= 60.0 * self.frequency))
            }
        };
        if !due {
            return None;
        }
        self.since = Instant::now();
        if self.frequency > 0.0 {
            self.saved.next = ((label / self.frequency).floor() + 1.0) * self.frequency;
        }
        self.remove_old(model);
        let path = file(&self.folder, &self.part.path, label);
        self.saved.files.retain(|known| *known != path);
        self.saved.files.push(path.clone());
        Some(path)
    }

    fn files(&self) -> Vec<FileUse> {
        vec![FileUse::WritesSeries(self.folder.join(format!("{}.rest", self.part.path)), SAVED)]
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(self.saved.clone()))
    }

    fn resume(&mut self, _model: &mut Model, state: Box<dyn State>) -> Result<()> {
        let saved: Saved = state.take()?;
        let own = |path: &PathBuf| path.parent() == Some(&self.folder) && path.extension().is_some_and(|e| e == "rest");
        if !saved.files.iter().all(own) {
            return Err(unfit("it names saved runs that are none of this run"));
        }
        self.saved = saved;
        Ok(())
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        self.remove_old(model);
        Ok(())
    }
}

register! { ProcessEntry "save_restart_process",
    aliases: &["SaveRestartProcess"],
    about: "saves the whole run, for a bitwise identical restart",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/save_restart_process.json")),
    build: build,
}
