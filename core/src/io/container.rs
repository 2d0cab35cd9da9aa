//! The file of a saved run: format, version and number of ranks; the length of each rank's contents and their checksum; then the
//! contents, rank after rank.
//!
//! Numbers of the head are little-endian. Contents are values as bytes ([`packed`]), in which numbers keep their bits. All
//! ranks stand in one file, which is replaced as a whole: no end of a run leaves files of two moments.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use zelus_linear_algebra::packed;

use super::outputs::{Mark, remove_half_written};
use super::replace::replace_own_file;
use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Error, Place, Result};

/// The first bytes of every saved run.
const MARK: &str = "zelus saved run\n";
/// How a saved run is known.
pub(crate) const SAVED: Mark = Mark::Begins(&[MARK]);
/// Version of the contents: one more with every change of the saved data.
const VERSION: u32 = 7;
/// Bytes before the lengths.
const HEAD: usize = MARK.len() + 4 + 4;
/// Bytes of the head for each rank: length and checksum.
const ENTRY: usize = 8 + 4;
/// Most words that go from rank to rank at once.
const AT_ONCE: usize = 1 << 24;

/// Writes a saved run of all ranks in place of the file at `path`, once it is whole on the disk, on rank 0. Collective.
///
/// # Errors
/// A disk that refuses.
pub fn write_saved(ranks: &Ranks, path: &Path, contents: &impl Serialize) -> Result<()> {
    let bytes = packed::to_bytes(contents)
        .map_err(|error| Error::System(format!("{}: the run cannot be saved: {error}", path.display())));
    let bytes = ranks.agree(bytes)?;
    let entry = [bytes.len() as f64, f64::from(crc32fast::hash(&bytes))];
    let entries: Vec<(u64, u32)> =
        ranks.gather_equal_numbers(&entry).chunks_exact(2).map(|entry| (entry[0] as u64, entry[1] as u32)).collect();
    let mut left = (1..ranks.size()).flat_map(|rank| pieces(rank, entries[rank].0 as usize));
    let mut send = || {
        let (rank, from, to) = left.next()?;
        let own = if rank == ranks.rank() { words(&bytes[from..to]) } else { Vec::new() };
        let received = ranks.exchange_indices(&ranks.for_root(own)).swap_remove(rank);
        Some(received.into_iter().flat_map(u32::to_le_bytes).take(to - from).collect::<Vec<u8>>())
    };
    let written = if ranks.is_root() {
        let (folder, name) = (path.parent().unwrap_or(Path::new("")), path.file_name().unwrap_or_default());
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        remove_half_written(folder, |left| name == left);
        replace_own_file(path, |out| {
            out.write_all(MARK.as_bytes())?;
            out.write_all(&VERSION.to_le_bytes())?;
            out.write_all(&(entries.len() as u32).to_le_bytes())?;
            for (length, sum) in &entries {
                out.write_all(&length.to_le_bytes())?;
                out.write_all(&sum.to_le_bytes())?;
            }
            out.write_all(&bytes)?;
            while let Some(piece) = send() {
                out.write_all(&piece)?;
            }
            Ok(())
        })
    } else {
        Ok(())
    };
    // Other ranks learn of a full disk once they have sent all.
    while send().is_some() {}
    ranks.agree(written)
}

/// Pieces that a rank sends: the rank, where they begin and end.
fn pieces(rank: usize, length: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..length).step_by(4 * AT_ONCE).map(move |from| (rank, from, length.min(from + 4 * AT_ONCE)))
}

fn words(bytes: &[u8]) -> Vec<u32> {
    let word = |four: &[u8]| std::array::from_fn(|at| four.get(at).copied().unwrap_or(0));
    bytes.chunks(4).map(|four| u32::from_le_bytes(word(four))).collect()
}

/// A saved run whose head has been read.
pub struct SavedFile {
    path: PathBuf,
    file: File,
    /// Where the contents of each rank begin, their length and their checksum.
    entries: Vec<(u64, u64, u32)>,
}

impl SavedFile {
    /// Reads the head of the file.
    ///
    /// # Errors
    /// A file that is not there, is no saved run, is one of another version or is cut short.
    pub fn open(path: &Path) -> Result<Self> {
        // A pipe would keep whoever opens it waiting.
        if !fs::metadata(path).map_err(|error| unreadable(path, &error))?.is_file() {
            return Err(problem(path, "this is no file".to_owned(), "name a file that zelus has saved a run in"));
        }
        let mut file = File::open(path).map_err(|error| unreadable(path, &error))?;
        let mut head = Vec::new();
        let mut more = |head: &mut Vec<u8>, count: u64| Read::by_ref(&mut file).take(count).read_to_end(head);
        more(&mut head, HEAD as u64).map_err(|error| unreadable(path, &error))?;
        if head.get(..MARK.len()).is_none_or(|mark| mark != MARK.as_bytes()) {
            let remedy = "name a file that zelus has saved a run in";
            return Err(problem(path, "this is no saved run".to_owned(), remedy));
        }
        let length = |file: &File| file.metadata().map_or(0, |found| found.len());
        let number = |head: &[u8], at: usize, count: usize| {
            let mut number = [0; 8];
            number[..count].copy_from_slice(head.get(at..at + count)?);
            Some(u64::from_le_bytes(number))
        };
        let version = number(&head, MARK.len(), 4);
        if let Some(version) = version.filter(|version| *version != u64::from(VERSION)) {
            let fact = format!("it is of version {version} of saved runs, and this program reads {VERSION}");
            let remedy = "restart with the program that has written it, or run the deck from its start";
            return Err(problem(path, fact, remedy));
        }
        let ranks = number(&head, MARK.len() + 4, 4).unwrap_or(0);
        more(&mut head, ranks * ENTRY as u64).map_err(|error| unreadable(path, &error))?;
        let mut start = HEAD as u64 + ranks * ENTRY as u64;
        let mut entries = Vec::new();
        for at in (HEAD..).step_by(ENTRY).take(ranks as usize) {
            let (Some(length), Some(sum)) = (number(&head, at, 8), number(&head, at + 8, 4)) else { break };
            entries.push((start, length, sum as u32));
            start = start.saturating_add(length);
        }
        let there = length(&file);
        if entries.is_empty() || (entries.len() as u64) < ranks || there != start {
            let all = if entries.is_empty() { String::new() } else { format!(" of {start}") };
            let fact = format!("it is cut short: it has {there} bytes{all}");
            return Err(problem(path, fact, "run the deck from its start, or take an older file"));
        }
        Ok(Self { path: path.to_owned(), file, entries })
    }

    /// Ranks that have saved the run.
    pub fn ranks(&self) -> usize {
        self.entries.len()
    }

    /// The saved data of one rank.
    ///
    /// # Errors
    /// Contents that are damaged, or that this program does not know.
    pub fn read<T: DeserializeOwned>(&self, rank: usize) -> Result<T> {
        let (start, length, sum) = self.entries[rank];
        let mut contents = Vec::new();
        let mut file = &self.file;
        let read = file.seek(SeekFrom::Start(start)).and_then(|_| file.take(length).read_to_end(&mut contents));
        read.map_err(|error| unreadable(&self.path, &error))?;
        if contents.len() as u64 != length || crc32fast::hash(&contents) != sum {
            let fact = "it is damaged: its checksum is another".to_owned();
            return Err(problem(&self.path, fact, "run the deck from its start, or take an older file"));
        }
        packed::from_bytes(&contents).map_err(|error| {
            let remedy = "restart with the program that has written it, plugins included";
            problem(&self.path, format!("this program does not know its content: {error}"), remedy)
        })
    }
}

fn unreadable(path: &Path, error: &io::Error) -> Error {
    problem(path, format!("the saved run cannot be read: {error}"), "run the deck from its start")
}

fn problem(path: &Path, fact: String, remedy: &str) -> Error {
    Diagnostic::error("saved-run", fact).at(Place::file(path)).remedy(remedy).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read<T: DeserializeOwned>(path: &Path) -> Result<T> {
        SavedFile::open(path)?.read(0)
    }

    fn write(path: &Path, contents: &impl Serialize) {
        write_saved(&Ranks::default(), path, contents).unwrap();
    }

    fn refused(path: &Path) -> String {
        read::<Vec<f64>>(path).expect_err("it is refused").to_string()
    }

    #[test]
    fn numbers_keep_their_bits() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        let numbers = [0.1, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -f64::NAN, 5e-324, f64::MAX];
        write(&path, &numbers.to_vec());
        let read: Vec<f64> = read(&path).unwrap();
        assert_eq!(numbers.map(f64::to_bits).to_vec(), read.into_iter().map(f64::to_bits).collect::<Vec<_>>());
    }

    #[test]
    fn what_is_no_whole_saved_run_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        assert!(refused(&path).contains("cannot be read"));
        assert!(refused(folder.path()).contains("no file"));
        fs::write(&path, "{ \"a\": 1 }").unwrap();
        assert!(refused(&path).contains("no saved run"));
        write(&path, &vec![1.0; 100]);
        let whole = fs::read(&path).unwrap();
        let contents = HEAD + ENTRY;
        for length in [MARK.len(), MARK.len() + 3, HEAD - 1, HEAD, contents - 1, contents, whole.len() - 1] {
            fs::write(&path, &whole[..length]).unwrap();
            assert!(refused(&path).contains("cut short"), "{length}: {}", refused(&path));
        }
        let mut other = whole.clone();
        other[contents + 17] ^= 1;
        fs::write(&path, &other).unwrap();
        assert!(refused(&path).contains("damaged"));
        other = whole.clone();
        other[MARK.len()] = 99;
        fs::write(&path, &other).unwrap();
        assert!(refused(&path).contains("version 99"));
        for ranks in [0, 2, u32::MAX] {
            other = whole.clone();
            other[HEAD - 4..HEAD].copy_from_slice(&ranks.to_le_bytes());
            fs::write(&path, &other).unwrap();
            assert!(refused(&path).contains("cut short"), "{ranks}: {}", refused(&path));
        }
        write(&path, &"words");
        assert!(refused(&path).contains("does not know"));
    }
}
