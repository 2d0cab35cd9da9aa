//! The file as keywords with their data.

use std::path::{Path, PathBuf};

use zelus_core::diagnostics::{Diagnostic, Error, Place, Result};

use crate::source;

/// Files that include each other are read to this depth.
const DEPTH: usize = 16;

/// A keyword with its parameters and the lines of data below it.
#[derive(Debug, Clone, Default)]
pub(super) struct Card {
    /// In capitals, words separated by one blank.
    pub keyword: String,
    parameters: Vec<(String, String)>,
    /// Fields of each line, without blanks around them.
    pub lines: Vec<Vec<String>>,
    file: PathBuf,
    line: u32,
}

impl Card {
    /// The value of a parameter; empty where it has none.
    pub(super) fn get(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_str())
    }

    /// The value of a parameter that must be there.
    pub(super) fn require(&self, name: &str) -> Result<&str> {
        self.get(name).ok_or_else(|| self.wrong(format!("*{} has no {name}", self.keyword)))
    }

    /// All fields that hold something.
    pub(super) fn fields(&self) -> impl Iterator<Item = &str> {
        self.lines.iter().flatten().map(String::as_str).filter(|field| !field.is_empty())
    }

    /// An error of this card.
    pub(super) fn wrong(&self, fact: impl Into<String>) -> Error {
        Diagnostic::error("mesh-syntax", fact).at(self.place()).into()
    }

    /// Where the keyword stands.
    pub(super) fn place(&self) -> Place {
        Place::at(&self.file, self.line, 0)
    }

    /// A field as a number.
    pub(super) fn number(&self, field: &str) -> Result<f64> {
        let number: f64 = field.to_ascii_lowercase().replace('d', "e").parse().unwrap_or(f64::NAN);
        if number.is_finite() {
            Ok(number)
        } else {
            Err(self.wrong(format!("*{}: {field:?} is no number", self.keyword)))
        }
    }

    /// A field as the number of a node or element.
    pub(super) fn label(&self, field: &str) -> Result<u32> {
        field.parse().map_err(|_| self.wrong(format!("*{}: {field:?} is no number of a node or element", self.keyword)))
    }
}

/// The cards of a file and of those that it includes.
pub(super) fn read(path: &Path) -> Result<Vec<Card>> {
    let mut out = Vec::new();
    add(path, 0, &mut out)?;
    Ok(out)
}

fn add(path: &Path, depth: usize, out: &mut Vec<Card>) -> Result<()> {
    if depth > DEPTH {
        let fact = format!("files include each other more than {DEPTH} deep");
        return Err(Diagnostic::error("mesh-syntax", fact).at(Place::file(path)).into());
    }
    let bytes = source::read(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with("**") && !line.trim().is_empty());
    while let Some((at, line)) = lines.next() {
        let Some(head) = line.trim().strip_prefix('*') else {
            let fields = line.trim().trim_end_matches(',').split(',').map(|field| field.trim().to_owned()).collect();
            match out.last_mut() {
                Some(card) => card.lines.push(fields),
                None => {
                    let problem = Diagnostic::error("mesh-syntax", "data stand before the first keyword");
                    return Err(problem.at(Place::at(path, at as u32 + 1, 0)).into());
                }
            }
            continue;
        };
        let mut head = head.trim_end().to_owned();
        // a comma at the end goes on in the next line
        while head.ends_with(',') {
            let Some((_, more)) = lines.next() else { break };
            head.push_str(more.trim());
        }
        let mut words = head.split(',');
        let keyword =
            words.next().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
        let parameter = |word: &str| {
            let (name, value) = word.split_once('=').unwrap_or((word, ""));
            (name.trim().to_ascii_uppercase(), value.trim().trim_matches('"').to_owned())
        };
        let parameters = words.map(parameter).collect();
        let card = Card { keyword, parameters, lines: Vec::new(), file: path.to_owned(), line: at as u32 + 1 };
        if card.keyword == "INCLUDE" {
            let file = path.with_file_name(card.require("INPUT")?);
            if !file.is_file() {
                return Err(card.wrong(format!("there is no file {} to include", file.display())));
            }
            add(&file, depth + 1, out)?;
        } else {
            out.push(card);
        }
    }
    Ok(())
}
