//! The file that `--log` names: all that is said, with the seconds since the start, as it is said.

use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use zelus_core::io::Mark;
use zelus_core::{Error, Result};

use super::report::check_output;

/// Start of every log, by which one is recognised.
const MARK: &str = "zelus ";

/// A log that grows line by line.
#[derive(Debug)]
pub(super) struct Log {
    file: File,
    begun: Instant,
    /// Whether a line could not be written, which is said once.
    failed: bool,
}

impl Log {
    /// Begins the log of a run of `deck`, in place of an earlier one.
    ///
    /// # Errors
    /// A file that is the deck, is no log, or cannot be written.
    pub(super) fn begin(path: &Path, deck: &Path) -> Result<Self> {
        check_output("the log", path, &[deck], Mark::Begins(&[MARK]))?;
        let file = File::create(path).map_err(|error| Error::System(format!("{}: {error}", path.display())))?;
        let mut log = Self { file, begun: Instant::now(), failed: false };
        let words: Vec<String> = std::env::args().skip(1).collect();
        log.raw(&format!("{MARK}{} {}", env!("CARGO_PKG_VERSION"), words.join(" ")));
        Ok(log)
    }

    /// Adds a line of output.
    pub(super) fn line(&mut self, text: &str) {
        self.raw(&format!("{:10.3} {text}", self.begun.elapsed().as_secs_f64()));
    }

    fn raw(&mut self, text: &str) {
        if let Err(error) = writeln!(self.file, "{text}")
            && !std::mem::replace(&mut self.failed, true)
        {
            let _ = writeln!(std::io::stderr(), "the log cannot be written: {error}");
        }
    }
}
