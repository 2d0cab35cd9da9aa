//! The file as keywords with their data.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use zelus_core::diagnostics::{Diagnostic, Error, Place, Report, Result};

use crate::source;

/// Keywords of several words: CalculiX reads them without blanks, too.
const WORDS: [&str; 28] = [
    "COMPLEX FREQUENCY",
    "CONTACT FILE",
    "CONTACT INTERFERENCE",
    "CONTACT OUTPUT",
    "CONTACT PAIR",
    "CONTACT PRINT",
    "CYCLIC SYMMETRY MODEL",
    "EL FILE",
    "EL PRINT",
    "ELEMENT OUTPUT",
    "END ASSEMBLY",
    "END INSTANCE",
    "END PART",
    "END STEP",
    "FILE FORMAT",
    "INITIAL CONDITIONS",
    "NODE FILE",
    "NODE OUTPUT",
    "NODE PRINT",
    "PHYSICAL CONSTANTS",
    "PRE-TENSION SECTION",
    "RIGID BODY",
    "ROTARY INERTIA",
    "SECTION PRINT",
    "SOLID SECTION",
    "SURFACE BEHAVIOR",
    "SURFACE INTERACTION",
    "TIME POINTS",
];

/// A word without its blanks.
fn squeezed(word: &str) -> String {
    word.split_whitespace().collect()
}

/// Files that include each other are read to this depth.
const DEPTH: usize = 16;

/// A line of data below a keyword.
#[derive(Debug, Clone)]
pub(super) struct Row {
    /// Fields without blanks around them.
    pub fields: Vec<String>,
    /// Line of the file, from 1.
    pub line: u32,
}

impl Row {
    /// A field from 0; empty where there is none.
    pub(super) fn get(&self, at: usize) -> &str {
        self.fields.get(at).map_or("", String::as_str)
    }
}

/// A parameter of a keyword, and whether the reader has asked for it.
#[derive(Debug)]
pub(super) struct Parameter {
    /// In capitals.
    pub name: String,
    value: String,
    pub is_read: Cell<bool>,
}

/// A keyword with its parameters and the lines of data below it.
#[derive(Debug)]
pub(super) struct Card {
    /// In capitals, words separated by one blank.
    pub keyword: String,
    pub parameters: Vec<Parameter>,
    pub rows: Vec<Row>,
    /// Whether the reader has used it.
    pub is_read: Cell<bool>,
    file: Rc<PathBuf>,
    line: u32,
}

impl Card {
    /// The value of a parameter, which counts as read; empty where it has none.
    pub(super) fn get(&self, name: &str) -> Option<&str> {
        let wanted = squeezed(name);
        let found = self.parameters.iter().find(|own| squeezed(&own.name) == wanted)?;
        found.is_read.set(true);
        Some(&found.value)
    }

    /// Whether a parameter has this value, in any case; another value stays unread.
    pub(super) fn says(&self, name: &str, value: &str) -> bool {
        let wanted = squeezed(name);
        let is_own = |own: &&Parameter| {
            squeezed(&own.name) == wanted && squeezed(&own.value).eq_ignore_ascii_case(&squeezed(value))
        };
        let found = self.parameters.iter().find(is_own);
        found.inspect(|own| own.is_read.set(true)).is_some()
    }

    /// The value of a parameter that must be there.
    pub(super) fn require(&self, name: &str) -> Result<&str> {
        self.get(name).ok_or_else(|| self.wrong(format!("*{} has no {name}", self.keyword)))
    }

    /// All fields that hold something, with their lines.
    pub(super) fn fields(&self) -> impl Iterator<Item = (&str, u32)> {
        let all = self.rows.iter().flat_map(|row| row.fields.iter().map(|field| (field.as_str(), row.line)));
        all.filter(|(field, _)| !field.is_empty())
    }

    /// An error of this card.
    pub(super) fn wrong(&self, fact: impl Into<String>) -> Error {
        Diagnostic::error("mesh-syntax", fact).at(self.place()).into()
    }

    /// An error of a line of this card.
    pub(super) fn wrong_at(&self, line: u32, fact: impl std::fmt::Display) -> Error {
        Diagnostic::error("mesh-syntax", format!("*{}: {fact}", self.keyword)).at(self.place_of(line)).into()
    }

    /// A warning about this card: a part of its meaning is not in the mesh.
    pub(super) fn left_out(&self, fact: impl Into<String>) -> Diagnostic {
        Diagnostic::warning("not-taken-over", fact).at(self.place())
    }

    /// Where the keyword stands.
    pub(super) fn place(&self) -> Place {
        self.place_of(self.line)
    }

    /// A line of its file.
    pub(super) fn place_of(&self, line: u32) -> Place {
        Place::at(&*self.file, line, 0)
    }

    /// A field as a number.
    pub(super) fn number(&self, field: &str, line: u32) -> Result<f64> {
        let number: f64 = field.to_ascii_lowercase().replace('d', "e").parse().unwrap_or(f64::NAN);
        if number.is_finite() { Ok(number) } else { Err(self.wrong_at(line, format!("{field:?} is no number"))) }
    }

    /// The numbers of a line; an empty field is 0.
    pub(super) fn numbers(&self, row: &Row) -> Result<Vec<f64>> {
        let number = |field: &String| if field.is_empty() { Ok(0.0) } else { self.number(field, row.line) };
        row.fields.iter().map(number).collect()
    }

    /// All numbers of all lines.
    pub(super) fn all_numbers(&self) -> Result<Vec<f64>> {
        self.fields().map(|(field, line)| self.number(field, line)).collect()
    }

    /// A field as the number of a node or element.
    pub(super) fn label(&self, field: &str, line: u32) -> Result<u32> {
        field.parse().map_err(|_| self.wrong_at(line, format!("{field:?} is no number of a node or element")))
    }

    /// A field as a degree of freedom.
    pub(super) fn freedom(&self, field: &str, line: u32) -> Result<usize> {
        field.parse().map_err(|_| self.wrong_at(line, format!("{field:?} is no degree of freedom")))
    }
}

/// The cards of a file and of those that it includes; reports files that are missing.
pub(super) fn read(path: &Path, report: &mut Report) -> Result<Vec<Card>> {
    let mut out = Vec::new();
    add(path, 0, &mut out, report)?;
    Ok(out)
}

/// Text of any encoding: UTF-8, with a mark of the order of bytes or without, otherwise Latin-1.
fn decoded(bytes: Vec<u8>) -> String {
    let wide = |of: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|two| of([two[0], two[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    match bytes.as_slice() {
        [0xFF, 0xFE, ..] => return wide(u16::from_le_bytes),
        [0xFE, 0xFF, ..] => return wide(u16::from_be_bytes),
        _ => {}
    }
    let text = String::from_utf8(bytes);
    let text = text.unwrap_or_else(|error| error.into_bytes().into_iter().map(char::from).collect());
    text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text)
}

fn add(path: &Path, depth: usize, out: &mut Vec<Card>, report: &mut Report) -> Result<()> {
    let text = decoded(source::read(path)?).replace("\r\n", "\n").replace('\r', "\n");
    let file = Rc::new(path.to_owned());
    let is_data = |(_, line): &(usize, &str)| !line.trim_start().starts_with("**") && !line.trim().is_empty();
    let mut lines = text.lines().enumerate().filter(is_data).peekable();
    let mut stray = false;
    while let Some((at, line)) = lines.next() {
        let number = at as u32 + 1;
        let Some(head) = line.trim().strip_prefix('*') else {
            let fields = line.trim().trim_end_matches(',').split(',').map(|field| field.trim().to_owned()).collect();
            match out.last_mut() {
                Some(card) => card.rows.push(Row { fields, line: number }),
                None if !stray => {
                    stray = true;
                    let problem = Diagnostic::warning("not-taken-over", "data stand before the first keyword");
                    report.push(problem.at(Place::at(path, number, 0)));
                }
                None => {}
            }
            continue;
        };
        let mut head = head.trim_end().to_owned();
        // a comma at the end goes on in the next line
        while head.ends_with(',') {
            let Some((_, more)) = lines.next_if(|(_, more)| has_parameters(more)) else { break };
            head.push_str(more.trim());
        }
        let mut words = head.split(',');
        let keyword =
            words.next().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
        let spaced = WORDS.iter().find(|known| squeezed(known) == keyword);
        let keyword = spaced.map_or(keyword, |known| (*known).to_owned());
        let parameter = |word: &str| {
            let (name, value) = word.split_once('=').unwrap_or((word, ""));
            let name = name.split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
            Parameter { name, value: value.trim().trim_matches('"').to_owned(), is_read: Cell::new(false) }
        };
        let parameters = words.filter(|word| !word.trim().is_empty()).map(parameter).collect();
        let card =
            Card { keyword, parameters, rows: Vec::new(), is_read: Cell::new(false), file: file.clone(), line: number };
        if card.keyword == "INCLUDE" {
            include(&card, path, depth, out, report)?;
        } else {
            out.push(card);
        }
    }
    Ok(())
}

/// Whether a line below a keyword that ends in a comma has its parameters; programs end keywords without any in a comma, too.
fn has_parameters(line: &str) -> bool {
    let line = line.trim();
    !line.starts_with('*') && line.split(',').all(|field| field.trim().parse::<f64>().is_err())
}

fn include(card: &Card, path: &Path, depth: usize, out: &mut Vec<Card>, report: &mut Report) -> Result<()> {
    let Some(name) = card.get("INPUT") else {
        report.push(card.left_out("*INCLUDE has no INPUT"));
        return Ok(());
    };
    let file = path.with_file_name(name);
    if !file.is_file() {
        report.push(card.left_out(format!("there is no file {} to include", file.display())));
    } else if depth == DEPTH {
        report.push(card.left_out(format!("files include each other more than {DEPTH} deep")));
    } else {
        add(&file, depth + 1, out, report)?;
    }
    Ok(())
}
