//! From the text of an mdpa file to the document.

use super::mdpa_document::*;
use super::mdpa_problems::Problems;
use super::tokens::{Number, Tokens, parse_prefix};
use super::{mdpa_check, mdpa_check::Lines};
use crate::diagnostics::{Diagnostic, Error, Place, Result, did_you_mean};
use std::path::Path;

/// Data of the registered elements, conditions and geometries, and of the flags, that the reader needs.
pub struct EntityNames<'a> {
    /// Number of nodes of a registered name.
    pub nodes_of: &'a dyn Fn(&str) -> Option<usize>,
    /// Registered names, for "did you mean".
    pub known: &'a [&'a str],
    /// Whether a name is a flag: its data blocks hold ids only.
    pub is_flag: &'a dyn Fn(&str) -> bool,
}

/// Reads an mdpa file; the second part of the answer is the warnings.
///
/// # Errors
/// [`Error::Input`] with every problem found (the first 50), each with its line, or when the file does not exist;
/// [`Error::System`] when it cannot be read.
pub fn read(path: &Path, names: &EntityNames) -> Result<(MdpaDocument, Vec<Diagnostic>)> {
    let bytes = std::fs::read(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => Diagnostic::error("missing-file", "the mesh file does not exist")
            .at(Place::file(path))
            .remedy("\"input_filename\" is its path without the ending .mdpa, relative to the working directory")
            .into(),
        _ => Error::System(format!("{}: cannot be read: {e}", path.display())),
    })?;
    read_bytes(&bytes, path, names)
}

/// Reads the content of an mdpa file; `path` is named in messages only.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(bytes: &[u8], path: &Path, names: &EntityNames) -> Result<(MdpaDocument, Vec<Diagnostic>)> {
    let mut reader = MdpaReader {
        tokens: Tokens::new(bytes),
        names,
        problems: Problems::new(path),
        document: MdpaDocument { file: path.to_owned(), ..Default::default() },
        lines: Lines::default(),
        depth: 0,
    };
    reader.file();
    let MdpaReader { mut problems, mut document, lines, .. } = reader;
    mdpa_check::check(&mut document, &lines, &mut problems);
    Ok((document, problems.finish()?))
}

/// A block that is being read: its kind and the line where it begins.
#[derive(Clone, Copy)]
pub(super) struct OpenBlock<'a> {
    pub(super) kind: &'a str,
    pub(super) line: u32,
}

/// Contents read so far, and the present position.
pub(super) struct MdpaReader<'a> {
    pub(super) tokens: Tokens<'a>,
    pub(super) names: &'a EntityNames<'a>,
    pub(super) problems: Problems<'a>,
    pub(super) document: MdpaDocument,
    pub(super) lines: Lines,
    /// How many sub model parts the one being read stands in.
    pub(super) depth: usize,
}

const BLOCKS: [&str; 14] = [
    "ModelPartData",
    "Table",
    "Properties",
    "Nodes",
    "Elements",
    "Conditions",
    "Geometries",
    "Constraints",
    "NodalData",
    "ElementalData",
    "ConditionalData",
    "SubModelPart",
    "Mesh",
    "CommunicatorData",
];

pub(super) fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}

impl<'a> MdpaReader<'a> {
    fn file(&mut self) {
        while !self.problems.full() {
            let Some(word) = self.tokens.word() else { break };
            let line = self.tokens.line;
            if word != b"Begin" {
                let fact = format!("`{}` stands outside any block", text(word));
                self.problems.push(
                    line,
                    Diagnostic::error("outside-block", fact).remedy("a block is `Begin NAME` … `End NAME`"),
                );
                self.tokens.skip_line();
            } else if let Some(kind) = self.heading(OpenBlock { kind: "Begin", line }, "the kind of block") {
                self.block(OpenBlock { kind: &kind, line });
            }
        }
        if let Some(line) = self.tokens.open_comment {
            self.problems.error(line, "cut-off", "the comment begun here with /* is never closed with */");
        }
    }

    fn block(&mut self, open: OpenBlock) {
        match open.kind {
            "ModelPartData" => {
                let mut entries = std::mem::take(&mut self.document.model_part_data);
                self.entries(open, &mut entries, None);
                self.document.model_part_data = entries;
            }
            "Table" => {
                let id = self.heading_id(open);
                let Some(table) = self.table(open, id) else { return };
                self.document.tables.extend(id.is_some().then_some(table));
            }
            "Properties" => {
                let id = self.heading_id(open);
                let (mut values, mut tables) = (Vec::new(), Vec::new());
                self.entries(open, &mut values, Some(&mut tables));
                let line = Line(open.line);
                self.document.properties.extend(id.map(|id| PropertiesBlock { id, values, tables, line }));
            }
            "Nodes" => self.nodes(open),
            "Elements" | "Conditions" | "Geometries" => self.entities(open),
            "Constraints" => self.constraints(open),
            "NodalData" | "ElementalData" | "ConditionalData" => self.data(open),
            "SubModelPart" => {
                let mut parts = std::mem::take(&mut self.document.sub_model_parts);
                self.sub_model_part(open, &mut parts);
                self.document.sub_model_parts = parts;
            }
            "Mesh" | "CommunicatorData" => {
                let fact = format!("the block {} is not used and is skipped", open.kind);
                self.problems.push(open.line, Diagnostic::warning("skipped-block", fact));
                self.skip_block(open);
            }
            kind => {
                self.unknown_block(kind, open.line, &BLOCKS);
                self.skip_block(open);
            }
        }
    }

    pub(super) fn unknown_block(&mut self, kind: &str, line: u32, known: &[&str]) {
        let elsewhere = (kind == "SubProperties")
            .then(|| "give them in the materials file, as \"sub_properties\" beside \"Material\"".to_owned());
        let remedy = elsewhere.or_else(|| did_you_mean(kind, known.iter().copied()));
        let remedy = remedy.unwrap_or_else(|| format!("blocks known here: {}", known.join(", ")));
        self.problems
            .push(line, Diagnostic::error("unknown-block", format!("there is no block `{kind}`")).remedy(remedy));
    }

    /// Skips the rest of a block and of the blocks in it.
    pub(super) fn skip_block(&mut self, open: OpenBlock) {
        let mut depth = 1;
        while let Some(word) = self.tokens.word() {
            match word {
                b"Begin" => depth += 1,
                b"End" => depth -= 1,
                _ => continue,
            }
            self.tokens.word();
            if depth == 0 {
                return;
            }
        }
        self.cut_off(open);
    }

    fn cut_off(&mut self, open: OpenBlock) {
        let fact = format!("the file ends inside the block {} that begins here", open.kind);
        let remedy = format!("the file may be cut off; the block is closed by `End {}`", open.kind);
        self.problems.push(open.line, Diagnostic::error("cut-off", fact).remedy(remedy));
    }

    /// A word of the heading of a block; `None`, with a message, when there is none.
    pub(super) fn heading(&mut self, open: OpenBlock, what: &str) -> Option<String> {
        // On the line of the block each word is a heading: parts may be called `End`.
        let word = self.tokens.peek().map(text);
        let word = word.filter(|word| self.tokens.line == open.line || !matches!(word.as_str(), "Begin" | "End"));
        if word.is_some() {
            self.tokens.word();
        } else {
            let fact = format!("`{}` is not followed by {what}", open.kind);
            self.problems.error(open.line, "bad-heading", fact);
        }
        word
    }

    fn heading_id(&mut self, open: OpenBlock) -> Option<u32> {
        let word = self.heading(open, "an id")?;
        let id = parse_prefix(word.as_bytes()).map(|(value, _)| value).filter(|v| *v >= 0.0 && *v <= u32::MAX.into());
        if id.is_none() {
            let fact = format!("`{word}` is not an id of {}", open.kind);
            self.problems.push(open.line, Diagnostic::error("bad-number", fact).remedy("write an integer from 0"));
        }
        id.map(|v| v as u32)
    }

    /// Whether the block ends here; its `End` is then behind us. Says so when it ends in a wrong way.
    pub(super) fn ends(&mut self, open: OpenBlock) -> bool {
        let Some(word) = self.tokens.peek() else {
            self.cut_off(open);
            return true;
        };
        if word != b"End" {
            return self.problems.full();
        }
        self.tokens.word();
        let line = self.tokens.line;
        if self.tokens.peek() == Some(open.kind.as_bytes()) {
            self.tokens.word();
        } else {
            let name = self.tokens.word_on_line().map(text).unwrap_or_default();
            let fact = format!("`End {name}` closes the block {} of line {}", open.kind, open.line);
            let remedy = format!("write `End {}`", open.kind);
            self.problems.push(line, Diagnostic::error("wrong-end", fact).remedy(remedy));
        }
        true
    }

    /// The id a row begins with, or nothing at the end of the block; rows without one are reported and passed over.
    pub(super) fn row(&mut self, open: OpenBlock) -> Option<u32> {
        loop {
            if let Some(id) = self.tokens.integer() {
                self.said_whole(id.whole, &id.value);
                return Some(id.value);
            }
            if self.ends(open) {
                return None;
            }
            let word = self.tokens.peek().unwrap_or_default();
            if word == b"Begin" {
                let line = self.tokens.line;
                let fact = format!("the block {} of line {} is not closed before this block", open.kind, open.line);
                let remedy = format!("write `End {}` before it", open.kind);
                self.problems.push(line, Diagnostic::error("not-closed", fact).remedy(remedy));
                return None;
            }
            self.bad_number("an id", open);
        }
    }

    pub(super) fn bad_number(&mut self, what: &str, open: OpenBlock) {
        // The end of a block and of the file are reported by who looks for the next row.
        let Some(word) = self.tokens.peek() else { return };
        let line = self.tokens.line;
        if word == b"End" || word == b"Begin" {
            let fact = format!("the last row of the block {} of line {} ends before {what}", open.kind, open.line);
            let remedy = "every row of a block has the same number of entries";
            self.problems.push(line, Diagnostic::error("short-row", fact).remedy(remedy));
        } else {
            let fact = format!("`{}` is not {what}, in the block {}", text(word), open.kind);
            self.problems.push(line, Diagnostic::error("bad-number", fact).remedy("correct the row"));
            self.tokens.skip_line();
        }
    }

    pub(super) fn said_whole(&mut self, whole: bool, value: &dyn std::fmt::Display) {
        if !whole {
            let fact = format!("only the beginning of a word is a number: it is read as {value}, as Kratos does");
            self.problems.push(
                self.tokens.line,
                Diagnostic::warning("number-prefix", fact).remedy("exponents are written with e, as in 1.0e5"),
            );
        }
    }

    pub(super) fn integer(&mut self, what: &str, open: OpenBlock) -> Option<u32> {
        let read = self.tokens.integer();
        match read {
            Some(Number { value, whole }) => self.said_whole(whole, &value),
            None => self.bad_number(what, open),
        }
        read.map(|number| number.value)
    }

    pub(super) fn number(&mut self, what: &str, open: OpenBlock) -> Option<f64> {
        let read = self.tokens.number();
        match read {
            Some(Number { value, whole }) => self.said_whole(whole, &value),
            None => self.bad_number(what, open),
        }
        read.map(|number| number.value)
    }
}
