//! Reads numbers from a file, as text or as bytes.

use std::path::Path;

use zelus_core::diagnostics::{Diagnostic, Error, Place, Result};

/// The bytes of a file and where reading stands.
pub(crate) struct Source<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    at: usize,
    /// Whether numbers are little-endian bytes; text otherwise.
    pub is_binary: bool,
}

/// The bytes of a file.
///
/// # Errors
/// [`Error::System`] when it cannot be read.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|error| Error::System(format!("{}: cannot be read: {error}", path.display())))
}

impl<'a> Source<'a> {
    pub(crate) fn new(path: &'a Path, bytes: &'a [u8]) -> Self {
        Self { path, bytes, at: 0, is_binary: false }
    }

    /// An error where reading stands.
    pub(crate) fn wrong(&self, fact: impl Into<String>) -> Error {
        let line = self.bytes[..self.at.min(self.bytes.len())].iter().filter(|&&byte| byte == b'\n').count() + 1;
        let line = if self.is_binary { 0 } else { line as u32 };
        Diagnostic::error("mesh-syntax", fact).at(Place::at(self.path, line, 0)).into()
    }

    /// The next line without its end; `None` at the end of the file.
    pub(crate) fn line(&mut self) -> Option<&'a str> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let end = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        self.at += end + 1;
        Some(std::str::from_utf8(&rest[..end]).unwrap_or("").trim())
    }

    /// Goes on behind the next line that is `line`.
    pub(crate) fn skip_behind(&mut self, line: &str) -> Result<()> {
        let rest = &self.bytes[self.at.min(self.bytes.len())..];
        let found = rest.windows(line.len()).position(|window| window == line.as_bytes());
        let Some(found) = found else { return Err(self.wrong(format!("there is no {line}"))) };
        self.at += found + line.len();
        self.line();
        Ok(())
    }

    /// The next word of text.
    fn word(&mut self) -> Result<&'a str> {
        let rest = &self.bytes[self.at.min(self.bytes.len())..];
        let start = rest.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(rest.len());
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        if length == 0 {
            return Err(self.wrong("the file ends in the middle of a section"));
        }
        self.at += start + length;
        std::str::from_utf8(&rest[start..start + length]).map_err(|_| self.wrong("a word is no text"))
    }

    fn raw<const N: usize>(&mut self) -> Result<[u8; N]> {
        let found = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk::<N>());
        let bytes = *found.ok_or_else(|| self.wrong("the file ends in the middle of a section"))?;
        self.at += N;
        Ok(bytes)
    }

    fn parsed<T: std::str::FromStr>(&mut self, what: &str) -> Result<T> {
        let word = self.word()?;
        word.parse().map_err(|_| self.wrong(format!("{word:?} is not {what}")))
    }

    /// A whole number of four bytes.
    pub(crate) fn int(&mut self) -> Result<i64> {
        if self.is_binary {
            self.raw().map(|bytes| i32::from_le_bytes(bytes).into())
        } else {
            self.parsed("a whole number")
        }
    }

    /// A count or tag of eight bytes.
    pub(crate) fn size(&mut self) -> Result<usize> {
        if self.is_binary {
            let number = u64::from_le_bytes(self.raw()?);
            usize::try_from(number).map_err(|_| self.wrong(format!("{number} is too large")))
        } else {
            self.parsed("a whole number")
        }
    }

    /// A real number of eight bytes.
    pub(crate) fn real(&mut self) -> Result<f64> {
        let number = if self.is_binary { f64::from_le_bytes(self.raw()?) } else { self.parsed("a number")? };
        if number.is_finite() { Ok(number) } else { Err(self.wrong(format!("{number} is no coordinate"))) }
    }

    /// Refuses a count of things that the rest of the file cannot hold.
    pub(crate) fn held(&self, count: usize) -> Result<usize> {
        let is_held = count <= self.bytes.len() - self.at.min(self.bytes.len());
        if is_held {
            Ok(count)
        } else {
            Err(self.wrong(format!("{count} things are announced, the file is too short")))
        }
    }
}
