//! Files that are whole or not there, written beside their name and renamed onto it, and files that grow.

use crate::communication::Ranks;
use crate::diagnostics::{Error, Result};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes a file so that a reader sees the old content or the whole new one, never a part.
///
/// Missing folders on the way are made; symbolic links are followed. The new content is on the disk before it takes the place of the
/// old one. Over several ranks only the first writes.
///
/// # Errors
/// [`Error::System`] when the disk refuses; the old content is then untouched. With several ranks the error is kept until
/// they next agree.
pub fn replace_file(
    ranks: &Ranks,
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<()> {
    ranks.on_root(|| replace_own_file(path, fill))
}

/// As [`replace_file`], for a file that is this rank's own.
///
/// # Errors
/// As [`replace_file`], but at once: other ranks know of it when they agree.
pub fn replace_own_file(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<()> {
    let mut fill = Some(fill);
    replace(path, &mut |out| fill.take().map_or(Ok(()), |fill| fill(out)))
}

/// Writes to a file.
type Fill<'a> = &'a mut dyn FnMut(&mut BufWriter<File>) -> io::Result<()>;

fn replace(path: &Path, fill: Fill<'_>) -> Result<()> {
    let followed = path.canonicalize();
    let path = followed.as_deref().unwrap_or(path);
    if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
        return Err(Error::System(format!("{}: is no file, and is not replaced", path.display())));
    }
    let failed = |what: &str, e: io::Error| Error::System(format!("{}: cannot {what}: {e}", path.display()));
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(|e| failed("make its folder", e))?;
    }
    let name = path.file_name().ok_or_else(|| Error::System(format!("{}: not a file name", path.display())))?;
    let temporary = path.with_file_name(format!(".{}.{}.part", name.to_string_lossy(), std::process::id()));
    let written = File::create(&temporary).and_then(|file| {
        let mut writer = BufWriter::with_capacity(1 << 16, file);
        fill(&mut writer)?;
        writer.flush()?;
        writer.get_ref().sync_data()
    });
    written.and_then(|()| fs::rename(&temporary, path)).map_err(|e| {
        // The first failure is the one to tell; a temporary file that cannot be removed adds nothing to it.
        let _ = fs::remove_file(&temporary);
        failed("be written", e)
    })
}

/// Adds to a file that grows over a run; it must exist.
///
/// # Errors
/// [`Error::System`] when the disk refuses.
pub fn append_to_file(
    ranks: &Ranks,
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<()> {
    let mut fill = Some(fill);
    ranks.on_root(|| append(path, &mut |out| fill.take().map_or(Ok(()), |fill| fill(out))))
}

fn append(path: &Path, fill: Fill<'_>) -> Result<()> {
    let done = File::options().append(true).open(path).and_then(|file| {
        let mut writer = BufWriter::with_capacity(1 << 16, file);
        fill(&mut writer)?;
        writer.flush()
    });
    done.map_err(|e| Error::System(format!("{}: cannot be written: {e}", path.display())))
}

/// Length of a file that grows; 0 where there is none yet.
pub fn length_of(path: &Path) -> u64 {
    fs::metadata(path).map_or(0, |file| file.len())
}

/// Cuts a file that has grown to `length` bytes, as where a run continues from an earlier state.
///
/// # Errors
/// A file that is not there or is shorter; with several ranks the error is kept until they next agree.
pub fn cut_file(ranks: &Ranks, path: &Path, length: u64) -> Result<()> {
    ranks.on_root(|| {
        let now = length_of(path);
        if now < length {
            let fact = format!("{}: it has {now} bytes, and had {length} when the run was saved", path.display());
            return Err(Error::System(format!("{fact}\n    bring it back, or run the deck from its start")));
        }
        let cut = File::options().write(true).open(path).and_then(|file| file.set_len(length));
        cut.map_err(|e| Error::System(format!("{}: cannot be written: {e}", path.display())))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_grew_is_cut_and_one_that_is_short_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.dat");
        let alone = Ranks::default();
        assert!(length_of(&path) == 0 && cut_file(&alone, &path, 1).is_err());
        replace_file(&alone, &path, |w| w.write_all(b"one\n")).unwrap();
        append_to_file(&alone, &path, |w| w.write_all(b"two\n")).unwrap();
        cut_file(&alone, &path, 4).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one\n");
        let error = cut_file(&alone, &path, 8).unwrap_err().to_string();
        assert!(error.contains("history.dat") && error.contains("4 bytes"), "{error}");
    }

    #[test]
    fn a_failed_writing_keeps_the_old_content() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b.txt");
        replace_own_file(&path, |w| w.write_all(b"old")).unwrap();
        let error = replace_own_file(&path, |w| {
            w.write_all(b"half")?;
            Err(io::Error::other("full"))
        })
        .unwrap_err();
        assert_eq!(error.exit_code(), 4);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }
}
