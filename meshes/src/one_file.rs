//! The output format `vtkhdf`: pictures of all steps in one file. While a run goes on they are VTU files, which a run that is killed
//! leaves behind; once it has ended they become one file.

use std::path::{Path, PathBuf};

use zelus_core::State;
use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::io::results::read_pvd;
use zelus_core::io::{Mark, remove_series};
use zelus_core::processes::{OutputFormat, OutputFormatEntry, OutputFrame};
use zelus_core::register;
use zelus_core::registry::require;

use super::vtkhdf::write_vtkhdf;

/// Endings of its files: last that of the one file, before it those of the pictures of a run that continues.
const ENDINGS: [&str; 4] = ["vtu", "pvtu", "pvd", "vtkhdf"];
const STEPS: &[&str] = ENDINGS.split_at(3).0;

struct OneFile {
    steps: Box<dyn OutputFormat>,
    /// Files that it has written.
    files: Vec<PathBuf>,
}

impl OutputFormat for OneFile {
    fn write(&mut self, shown: &OutputFrame<'_>) -> Result<()> {
        self.steps.write(shown)
    }

    fn endings(&self) -> &'static [&'static str] {
        &ENDINGS
    }

    fn mark(&self) -> Mark {
        self.steps.mark()
    }

    fn finish(&mut self, folder: &Path) -> Result<()> {
        for series in self.steps.outputs(folder) {
            let file = series.with_extension("vtkhdf");
            write_vtkhdf(&series, &file)?;
            let name = series.file_stem().unwrap_or_default().to_string_lossy();
            remove_series(folder, &name, STEPS)?;
            self.files.push(file);
        }
        Ok(())
    }

    fn state(&self) -> Option<Box<dyn State>> {
        self.steps.state()
    }

    fn resume(&mut self, state: Box<dyn State>, folder: &Path) -> Result<()> {
        self.steps.resume(state, folder)?;
        for series in self.steps.outputs(folder) {
            let files = read_pvd(&series).unwrap_or_default();
            if files.is_empty() || !files.iter().all(|(_, file)| file.is_file()) {
                let fact = format!("the pictures of earlier steps are no longer in {}", folder.display());
                let remedy = "a run that has ended has put them into one file, to which none can be added: run the deck from its start";
                return Err(Diagnostic::error("saved-state", fact).remedy(remedy).into());
            }
        }
        Ok(())
    }

    fn outputs(&self, folder: &Path) -> Vec<PathBuf> {
        if self.files.is_empty() { self.steps.outputs(folder) } else { self.files.clone() }
    }
}

register! { OutputFormatEntry "vtkhdf",
    about: "one file of VTK's HDF format with all steps, in double precision, once the run has ended; until then VTU files",
    source: "VTK documentation, \"VTKHDF File Format\"",
    build: |settings| {
        let steps = (require::<OutputFormatEntry>("vtu")?.build)(settings)?;
        Ok(Box::new(OneFile { steps, files: Vec::new() }))
    },
}
