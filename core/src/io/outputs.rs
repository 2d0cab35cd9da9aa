//! Whether the files of a run can be written without a loss, asked before anything is solved.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::diagnostics::{Diagnostic, Error, Result};

/// Longest name of a file, in bytes, on the file systems in use.
const LONGEST: usize = 255;
/// What the label of a step and an ending take of a name.
const LABEL: usize = 40;
/// What a disk must have left to begin with, in bytes.
const LEAST_SPACE: usize = 1 << 16;

/// Folders, and why nothing can be written to them.
type Tried = BTreeMap<PathBuf, std::result::Result<(), String>>;

/// A file that a run reads or writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FileUse {
    /// It is read.
    Reads(PathBuf),
    /// It is replaced.
    Writes(PathBuf),
    /// Files are replaced, one a step: of `Block.vtu` those of [`of_series`], and `Block.vtu` itself.
    WritesSeries(PathBuf),
}

/// Whether a file with this name is of one step of a series: `Block_7.vtu`, `Block_7_1.vtu` and `Block_0_0.5.vtu` are of `Block.vtu`.
pub fn of_series(name: &str, series: &str) -> bool {
    let (stem, ending) = series.rsplit_once('.').unwrap_or((series, ""));
    let label =
        name.strip_prefix(stem).and_then(|rest| rest.strip_prefix('_')).and_then(|rest| rest.strip_suffix(ending));
    label.is_some_and(|label| !label.is_empty() && label.chars().all(|c| c.is_ascii_digit() || "._+-e".contains(c)))
}

impl FileUse {
    fn path(&self) -> &Path {
        match self {
            Self::Reads(path) | Self::Writes(path) | Self::WritesSeries(path) => path,
        }
    }

    /// The path, where something is read.
    pub fn input(&self) -> Option<&Path> {
        matches!(self, Self::Reads(_)).then(|| self.path())
    }

    /// The path, where something is written.
    pub fn output(&self) -> Option<&Path> {
        (!matches!(self, Self::Reads(_))).then(|| self.path())
    }
}

/// Why files cannot be used so: outputs that are inputs, other outputs or no files, and places where nothing can be written.
pub fn check_files(files: &[FileUse]) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    let whole: Vec<PathBuf> = files.iter().map(|file| resolved(file.path())).collect();
    let mut folders = BTreeMap::new();
    for (at, file) in files.iter().enumerate() {
        let Some(path) = file.output() else { continue };
        let shown = path.display();
        let mut problem = |fact: String, remedy: &str| {
            problems.push(Diagnostic::error("output-file", fact).remedy(remedy));
        };
        let same = |other: &usize| whole[*other] == whole[at];
        if (0..files.len()).filter(same).any(|other| files[other].output().is_none()) {
            problem(format!("{shown} is read by the run, and would be replaced"), "give the output another name");
        }
        if (0..at).filter(same).any(|other| files[other].output().is_some()) {
            problem(format!("{shown} is written twice by the run"), "give each output a name of its own");
        }
        let label = if matches!(file, FileUse::WritesSeries(_)) { LABEL } else { 0 };
        if path.file_name().is_some_and(|name| name.len() + label > LONGEST) {
            problem(format!("{shown}: the name is too long"), "names of files have at most 255 bytes");
        } else if let Err(fact) = can_be_written(file, &whole[at], &mut folders) {
            problem(format!("{shown}: {fact}"), "name a file in a folder that can be written to");
        }
    }
    problems
}

/// The path with its symbolic links followed, as far as it is there.
fn resolved(path: &Path) -> PathBuf {
    if let Ok(whole) = path.canonicalize() {
        return whole;
    }
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (folder, name) = (absolute.parent(), absolute.file_name());
    folder.zip(name).map_or(absolute.clone(), |(folder, name)| resolved(folder).join(name))
}

/// Whether a file can be written; `folders` are those that were tried before.
fn can_be_written(file: &FileUse, whole: &Path, folders: &mut Tried) -> std::result::Result<(), String> {
    if let (FileUse::Writes(_), Ok(found)) = (file, fs::metadata(whole))
        && !found.is_file()
    {
        return Err("there is something that is no file".to_owned());
    }
    if fs::symlink_metadata(file.path()).is_ok_and(|link| link.is_symlink()) && fs::metadata(whole).is_err() {
        return Err("it is a link to nothing".to_owned());
    }
    let Some(folder) = whole.ancestors().skip(1).find(|folder| folder.exists()) else { return Ok(()) };
    folders.entry(folder.to_owned()).or_insert_with(|| takes_files(folder)).clone()
}

/// Writes a file to a folder and removes it.
fn takes_files(folder: &Path) -> std::result::Result<(), String> {
    if !folder.is_dir() {
        return Err(format!("{} is no folder", folder.display()));
    }
    let probe = folder.join(format!(".zelus-{}.part", std::process::id()));
    let written = File::create(&probe).and_then(|mut file| file.write_all(&[0; LEAST_SPACE]));
    let removed = fs::remove_file(&probe);
    written.and(removed).map_err(|error| format!("nothing can be written to {}: {error}", folder.display()))
}

/// An output that no other run may write as long as this lives.
#[derive(Debug)]
pub struct Claim {
    path: PathBuf,
    _lock: File,
}

impl Claim {
    /// Claims an output, and removes what a killed run has left of it half written.
    ///
    /// # Errors
    /// [`Error::System`] when another run has it, or a folder that cannot be made.
    pub fn of(output: &Path) -> Result<Self> {
        let failed =
            |what: &str, error: std::io::Error| Error::System(format!("{}: cannot {what}: {error}", output.display()));
        let whole = resolved(output);
        let (folder, name) = (whole.parent().unwrap_or(Path::new(".")), whole.file_name().unwrap_or_default());
        fs::create_dir_all(folder).map_err(|error| failed("make its folder", error))?;
        let path = folder.join(format!(".{}.lock", name.to_string_lossy()));
        let lock = File::create(&path).map_err(|error| failed("be locked", error))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(Error::System(format!(
                    "{} is being written by another run\n    wait for its end, or give this run an output of its own",
                    output.display()
                )));
            }
            // File systems without locks have none to respect.
            Err(TryLockError::Error(_)) => {}
        }
        let name = name.to_string_lossy();
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let half = entry.file_name();
            let half = half.to_string_lossy();
            let left = half.strip_prefix('.').and_then(|half| half.strip_suffix(".part")?.rsplit_once('.'));
            let is_own = |left: &str| left == name || of_series(left, &name);
            let writes = |process: &str| Path::new("/proc").join(process).exists();
            if left.is_some_and(|(left, process)| is_own(left) && !writes(process)) {
                // What cannot be removed is in nobody's way.
                let _ = fs::remove_file(entry.path());
            }
        }
        Ok(Self { path, _lock: lock })
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // A lock that stays holds nothing: it is the open file that counts.
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(files: &[FileUse]) -> String {
        check_files(files).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn outputs_that_would_destroy_something_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("mesh.mdpa"), "").unwrap();
        fs::create_dir(at("folder")).unwrap();
        std::os::unix::fs::symlink(at("mesh.mdpa"), at("link.json")).unwrap();
        std::os::unix::fs::symlink(at("nothing"), at("broken.json")).unwrap();
        let reads = FileUse::Reads(at("mesh.mdpa"));
        for (output, fact) in [
            ("mesh.mdpa", "is read by the run"),
            ("folder/../mesh.mdpa", "is read by the run"),
            ("link.json", "is read by the run"),
            ("folder", "no file"),
            ("broken.json", "a link to nothing"),
            ("mesh.mdpa/results.json", "is no folder"),
        ] {
            let said = said(&[reads.clone(), FileUse::Writes(at(output))]);
            assert!(said.contains(fact), "{output}: {said}");
        }
        assert!(said(&[FileUse::Writes(PathBuf::from("/dev/null"))]).contains("no file"));
        assert!(said(&[FileUse::WritesSeries(at(&"x".repeat(230)))]).contains("too long"));
        let twice = [FileUse::Writes(at("a.json")), FileUse::Writes(at("./a.json"))];
        assert!(said(&twice).contains("written twice"));
        assert_eq!(said(&[reads, FileUse::Writes(at("new/a.json")), FileUse::WritesSeries(at("folder"))]), "");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4, "nothing is left behind");
    }

    #[test]
    fn one_run_has_an_output() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.json");
        for left in
            [".results.json.4194999.part", ".results_3.json.4194999.part", ".results_of_others.json.4194999.part"]
        {
            fs::write(folder.path().join(left), "half").unwrap();
        }
        let first = Claim::of(&path).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "what a killed run left of this output is gone");
        assert!(Claim::of(&path).unwrap_err().to_string().contains("another run"));
        drop(first);
        drop(Claim::of(&path).unwrap());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
