//! Whether the files of a run can be written without a loss, asked before anything is solved.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use crate::diagnostics::{Diagnostic, Error, Result};

/// Longest name of a file, in bytes, on the file systems in use.
const LONGEST: usize = 255;
/// Bytes of a file name taken by the label of a step and the ending.
const LABEL: usize = 40;
/// Least free space of a disk at the start, in bytes.
const LEAST_SPACE: usize = 1 << 16;

/// Folders with the bytes that were tried, and why they cannot be written there.
type WriteChecks = BTreeMap<(PathBuf, usize), std::result::Result<(), String>>;

/// How a file that an earlier run has written is known: any other is not replaced. An empty file is nobody's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// It cannot be known: whatever is there is replaced.
    None,
    /// It begins with one of these.
    Begins(&'static [&'static str]),
    /// It holds this.
    Holds(&'static str),
}

impl Mark {
    /// Whether there is a file at this path without the mark.
    pub fn is_missing(self, path: &Path) -> bool {
        let Ok(mut file) = File::open(path) else { return false };
        let mut text = Vec::new();
        let read = match self {
            Self::None => return false,
            Self::Begins(words) => {
                let longest = words.iter().map(|word| word.len() as u64).max().unwrap_or(0);
                file.take(longest).read_to_end(&mut text)
            }
            Self::Holds(_) => file.read_to_end(&mut text),
        };
        let has = match self {
            Self::None => true,
            Self::Begins(words) => words.iter().any(|word| text.starts_with(word.as_bytes())),
            Self::Holds(word) => text.windows(word.len()).any(|part| part == word.as_bytes()),
        };
        read.is_ok() && !text.is_empty() && !has
    }
}

/// A file that a run reads or writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FileUse {
    /// It is read.
    Reads(PathBuf),
    /// It is replaced.
    Writes(PathBuf, Mark),
    /// Files are replaced, one a step: of `Block.vtu` those of [`of_series`], and `Block.vtu` itself.
    WritesSeries(PathBuf, Mark),
}

/// Whether a file with this name is of one step of a series: `Block_7.vtu`, `Block_7_1.vtu` and `Block_0_0.5.vtu` are of `Block.vtu`.
pub fn of_series(name: &str, series: &str) -> bool {
    let (stem, ending) = series.rsplit_once('.').unwrap_or((series, ""));
    let label =
        name.strip_prefix(stem).and_then(|rest| rest.strip_prefix('_')).and_then(|rest| rest.strip_suffix(ending));
    label.is_some_and(|label| !label.is_empty() && label.chars().all(|c| c.is_ascii_digit() || "._+-e".contains(c)))
}

/// Removes the files of a series of pictures with these endings from a folder.
///
/// # Errors
/// A file that cannot be removed.
pub fn remove_series(folder: &Path, series: &str, endings: &[&str]) -> Result<()> {
    let series: Vec<String> = endings.iter().map(|ending| format!("{series}.{ending}")).collect();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_own = series.iter().any(|series| *name == *series || of_series(&name, series));
        if is_own && entry.file_type().is_ok_and(|kind| kind.is_file()) {
            let path = entry.path();
            fs::remove_file(&path).map_err(|e| Error::System(format!("{}: cannot be removed: {e}", path.display())))?;
        }
    }
    Ok(())
}

impl FileUse {
    fn path(&self) -> &Path {
        match self {
            Self::Reads(path) | Self::Writes(path, _) | Self::WritesSeries(path, _) => path,
        }
    }

    /// A file that would be replaced, and that no run has written; `whole` is the path without links.
    fn stranger(&self, whole: &Path) -> Option<PathBuf> {
        match self {
            Self::Reads(_) => None,
            Self::Writes(path, mark) => mark.is_missing(whole).then(|| path.clone()),
            Self::WritesSeries(path, mark) => {
                let series = path.file_name()?.to_string_lossy();
                let entries = fs::read_dir(whole.parent()?).ok()?.flatten();
                let strange = entries.filter(|entry| {
                    let is_own = of_series(&entry.file_name().to_string_lossy(), &series);
                    is_own && entry.path().is_file() && mark.is_missing(&entry.path())
                });
                strange.map(|entry| path.with_file_name(entry.file_name())).min()
            }
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

/// Why files cannot be used so: outputs that are inputs, other outputs or no files, and places where they cannot be written. A file of a
/// series takes at least `picture` bytes.
pub fn check_files(files: &[FileUse], picture: usize) -> Vec<Diagnostic> {
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
        let label = if matches!(file, FileUse::WritesSeries(..)) { LABEL } else { 0 };
        if path.file_name().is_some_and(|name| name.len() + label > LONGEST) {
            problem(format!("{shown}: the name is too long"), "names of files have at most 255 bytes");
        } else if let Err(fact) = can_be_written(file, &whole[at], picture, &mut folders) {
            problem(format!("{shown}: {fact}"), "name a file in a folder that can be written to");
        } else if let Some(strange) = file.stranger(&whole[at]) {
            let fact =
                format!("{} is nothing that an earlier run has written, and would be replaced", strange.display());
            problem(fact, "give the output another name, or remove the file");
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
fn can_be_written(
    file: &FileUse,
    whole: &Path,
    picture: usize,
    folders: &mut WriteChecks,
) -> std::result::Result<(), String> {
    if let (FileUse::Writes(..), Ok(found)) = (file, fs::metadata(whole))
        && !found.is_file()
    {
        return Err("there is something that is no file".to_owned());
    }
    if fs::symlink_metadata(file.path()).is_ok_and(|link| link.is_symlink()) && fs::metadata(whole).is_err() {
        return Err("it is a link to nothing".to_owned());
    }
    let Some(folder) = whole.ancestors().skip(1).find(|folder| folder.exists()) else { return Ok(()) };
    let bytes = if matches!(file, FileUse::WritesSeries(..)) { picture.max(LEAST_SPACE) } else { LEAST_SPACE };
    folders.entry((folder.to_owned(), bytes)).or_insert_with(|| takes_files(folder, bytes)).clone()
}

/// Writes a file of so many bytes to a folder and removes it.
fn takes_files(folder: &Path, bytes: usize) -> std::result::Result<(), String> {
    if !folder.is_dir() {
        return Err(format!("{} is no folder", folder.display()));
    }
    let probe = folder.join(format!(".zelus-{}.part", std::process::id()));
    let written = File::create(&probe).and_then(|mut file| file.write_all(&vec![0; bytes]));
    let removed = fs::remove_file(&probe);
    written.and(removed).map_err(|error| format!("{bytes} bytes cannot be written to {}: {error}", folder.display()))
}

/// An output that no other run may write as long as this lives.
#[derive(Debug)]
pub struct Claim {
    path: PathBuf,
    _lock: File,
}

impl Claim {
    /// Claims an output, and removes the incomplete file of a killed run.
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
        // A series has lists beside it, of the same name with other endings.
        let stem = |name: &str| name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned();
        remove_half_written(folder, |left| of_series(left, &name) || stem(left) == stem(&name));
        Ok(Self { path, _lock: lock })
    }
}

/// Removes what killed runs have left half written of the files of a folder that are `wanted` by name.
pub(super) fn remove_half_written(folder: &Path, wanted: impl Fn(&str) -> bool) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let half = entry.file_name();
        let half = half.to_string_lossy();
        let left = half.strip_prefix('.').and_then(|half| half.strip_suffix(".part")?.rsplit_once('.'));
        let writes = |process: &str| Path::new("/proc").join(process).exists();
        if left.is_some_and(|(left, process)| wanted(left) && !writes(process)) {
            // A file that cannot be removed is in nobody's way.
            let _ = fs::remove_file(entry.path());
        }
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
        check_files(files, 0).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
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
            let said = said(&[reads.clone(), FileUse::Writes(at(output), Mark::None)]);
            assert!(said.contains(fact), "{output}: {said}");
        }
        assert!(said(&[FileUse::Writes(PathBuf::from("/dev/null"), Mark::None)]).contains("no file"));
        assert!(said(&[FileUse::WritesSeries(at(&"x".repeat(230)), Mark::None)]).contains("too long"));
        let twice = [FileUse::Writes(at("a.json"), Mark::None), FileUse::Writes(at("./a.json"), Mark::None)];
        assert!(said(&twice).contains("written twice"));
        assert_eq!(
            said(&[
                reads,
                FileUse::Writes(at("new/a.json"), Mark::None),
                FileUse::WritesSeries(at("folder"), Mark::None)
            ]),
            ""
        );
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4, "nothing is left behind");
    }

    #[test]
    fn files_of_strangers_are_known() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for (name, text) in
            [("Block_1.vtu", "<VTKFile"), ("Block_2.vtu", "mine"), ("a.json", "{\"TIME\": []}"), ("empty", "")]
        {
            fs::write(at(name), text).unwrap();
        }
        let vtu = Mark::Begins(&["<?xml", "<VTKFile"]);
        let told = said(&[FileUse::WritesSeries(at("Block.vtu"), vtu)]);
        assert!(told.contains("Block_2.vtu is nothing that an earlier run has written"), "{told}");
        assert_eq!(said(&[FileUse::WritesSeries(at("Other.vtu"), vtu)]), "");
        for (name, mark, strange) in [
            ("Block_1.vtu", vtu, false),
            ("Block_2.vtu", vtu, true),
            ("Block_2.vtu", Mark::None, false),
            ("a.json", Mark::Holds("\"TIME\""), false),
            ("a.json", Mark::Holds("\"time\""), true),
            ("empty", Mark::Holds("x"), false),
            ("none", vtu, false),
        ] {
            assert_eq!(mark.is_missing(&at(name)), strange, "{name} {mark:?}");
        }
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
