//! The file of a saved run: what it is, which version, how long, its checksum, then its contents.
//!
//! Numbers of the head are little-endian. Contents are MessagePack with the names of fields, in which numbers keep their bits.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::replace::replace_own_file;
use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Error, Place, Result};

/// The first bytes of every saved run.
const MARK: &[u8; 16] = b"zelus saved run\n";
/// Version of the contents: one more with every change of what is saved.
const VERSION: u32 = 1;
/// Bytes before the contents.
const HEAD: usize = MARK.len() + 4 + 8 + 4;

/// The file of this rank where several save a run: the name ends in the number of the rank.
pub fn path_of_rank(ranks: &Ranks, path: &Path) -> PathBuf {
    let Some(name) = path.file_name().filter(|_| ranks.size() > 1) else { return path.to_owned() };
    path.with_file_name(format!("{}.{}", name.to_string_lossy(), ranks.rank()))
}

/// Writes a saved run in place of what stands at `path`, once it is whole on the disk.
///
/// # Errors
/// A disk that refuses.
pub fn write_saved(path: &Path, contents: &impl Serialize) -> Result<()> {
    let bytes = rmp_serde::to_vec_named(contents)
        .map_err(|error| Error::System(format!("{}: the run cannot be saved: {error}", path.display())))?;
    replace_own_file(path, |out| {
        out.write_all(MARK)?;
        out.write_all(&VERSION.to_le_bytes())?;
        out.write_all(&(bytes.len() as u64).to_le_bytes())?;
        out.write_all(&crc32fast::hash(&bytes).to_le_bytes())?;
        out.write_all(&bytes)
    })
}

/// Reads a saved run.
///
/// # Errors
/// A file that is not there, is no saved run, is one of another version, is cut short or damaged.
pub fn read_saved<T: DeserializeOwned>(path: &Path) -> Result<T> {
    let problem = |fact: String, remedy: &str| {
        Error::from(Diagnostic::error("saved-run", fact).at(Place::file(path)).remedy(remedy))
    };
    let bytes = fs::read(path)
        .map_err(|error| problem(format!("the saved run cannot be read: {error}"), "run the deck from its start"))?;
    if bytes.get(..MARK.len()).is_none_or(|mark| mark != MARK) {
        return Err(problem("this is no saved run".to_owned(), "name a file that zelus has saved a run in"));
    }
    let number = |from: usize, count: usize| -> Option<u64> {
        let mut number = [0; 8];
        number[..count].copy_from_slice(bytes.get(from..from + count)?);
        Some(u64::from_le_bytes(number))
    };
    let whole = "run the deck from its start, or take an older file";
    let cut = |length: String| problem(format!("it is cut short: it has {} bytes{length}", bytes.len()), whole);
    let version = number(MARK.len(), 4).ok_or_else(|| cut(String::new()))?;
    if version != u64::from(VERSION) {
        let fact = format!("it is of version {version} of saved runs, and this program reads {VERSION}");
        return Err(problem(fact, "go on with the program that has written it, or run the deck from its start"));
    }
    let length = number(MARK.len() + 4, 8).ok_or_else(|| cut(String::new()))?;
    let sum = number(MARK.len() + 12, 4).ok_or_else(|| cut(String::new()))?;
    let contents = &bytes[HEAD..];
    if contents.len() as u64 != length {
        return Err(cut(format!(" of {}", length.saturating_add(HEAD as u64))));
    }
    if u64::from(crc32fast::hash(contents)) != sum {
        return Err(problem("it is damaged: its checksum is another".to_owned(), whole));
    }
    rmp_serde::from_slice(contents).map_err(|error| {
        let remedy = "go on with the program that has written it, with all that is registered there";
        problem(format!("this program does not know what it holds: {error}"), remedy)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(path: &Path) -> String {
        read_saved::<Vec<f64>>(path).expect_err("it is refused").to_string()
    }

    #[test]
    fn numbers_keep_their_bits() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        let numbers = [0.1, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -f64::NAN, 5e-324, f64::MAX];
        write_saved(&path, &numbers).unwrap();
        let read: Vec<f64> = read_saved(&path).unwrap();
        assert_eq!(numbers.map(f64::to_bits).to_vec(), read.into_iter().map(f64::to_bits).collect::<Vec<_>>());
    }

    #[test]
    fn what_is_no_whole_saved_run_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        assert!(refused(&path).contains("cannot be read"));
        fs::write(&path, "{ \"a\": 1 }").unwrap();
        assert!(refused(&path).contains("no saved run"));
        write_saved(&path, &vec![1.0; 100]).unwrap();
        let whole = fs::read(&path).unwrap();
        for length in [MARK.len(), MARK.len() + 3, HEAD - 1, HEAD, whole.len() - 1] {
            fs::write(&path, &whole[..length]).unwrap();
            assert!(refused(&path).contains("cut short"), "{length}: {}", refused(&path));
        }
        let mut other = whole.clone();
        other[HEAD + 17] ^= 1;
        fs::write(&path, &other).unwrap();
        assert!(refused(&path).contains("damaged"));
        other = whole.clone();
        other[MARK.len()] = 99;
        fs::write(&path, &other).unwrap();
        assert!(refused(&path).contains("version 99"));
        write_saved(&path, &"words").unwrap();
        assert!(refused(&path).contains("does not know"));
    }
}
