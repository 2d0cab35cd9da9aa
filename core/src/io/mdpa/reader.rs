//! From the text of an mdpa file to the document.

use super::document::*;
use super::tokens::{Number, Tokens, parse_prefix};
use super::{check, check::Lines};
use crate::diagnostics::{Diagnostic, Error, Place, Report, Result, did_you_mean};
use std::path::Path;

/// What the reader must know of the registered elements, conditions and geometries, and of the flags.
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
    let mut reader = Reader {
        tokens: Tokens::new(bytes),
        names,
        problems: Problems { path, report: Report::new() },
        document: MdpaDocument { file: path.to_owned(), ..Default::default() },
        lines: Lines::default(),
    };
    reader.file();
    let Reader { mut problems, mut document, lines, .. } = reader;
    check::check(&mut document, &lines, &mut problems);
    Ok((document, problems.report.finish()?))
}

/// The problems of one file, up to a number a user may want to see.
pub(super) struct Problems<'a> {
    path: &'a Path,
    report: Report,
}

impl Problems<'_> {
    const CAP: usize = 50;

    pub(super) fn full(&self) -> bool {
        self.report.diagnostics().len() > Self::CAP
    }

    pub(super) fn push(&mut self, line: u32, diagnostic: Diagnostic) {
        if self.report.diagnostics().len() == Self::CAP {
            let fact = format!("more than {} problems; the rest of the file is not looked at", Self::CAP);
            self.report.push(Diagnostic::error("too-many-problems", fact).at(Place::file(self.path)));
        } else if !self.full() {
            self.report.push(diagnostic.at(Place::at(self.path, line, 0)));
        }
    }

    pub(super) fn error(&mut self, line: u32, code: &'static str, fact: impl Into<String>) {
        self.push(line, Diagnostic::error(code, fact));
    }
}

/// A block that is being read.
#[derive(Clone, Copy)]
struct Open<'a> {
    kind: &'a str,
    line: u32,
}

struct Reader<'a> {
    tokens: Tokens<'a>,
    names: &'a EntityNames<'a>,
    problems: Problems<'a>,
    document: MdpaDocument,
    lines: Lines,
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
const PART_BLOCKS: [&str; 9] = [
    "SubModelPartData",
    "SubModelPartTables",
    "SubModelPartProperties",
    "SubModelPartNodes",
    "SubModelPartElements",
    "SubModelPartConditions",
    "SubModelPartGeometries",
    "SubModelPartConstraints",
    "SubModelPart",
];

fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}

impl<'a> Reader<'a> {
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
            } else if let Some(kind) = self.heading(Open { kind: "Begin", line }, "the kind of block") {
                self.block(Open { kind: &kind, line });
            }
        }
        if let Some(line) = self.tokens.open_comment {
            self.problems.error(line, "cut-off", "the comment begun here with /* is never closed with */");
        }
    }

    fn block(&mut self, open: Open) {
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

    fn unknown_block(&mut self, kind: &str, line: u32, known: &[&str]) {
        let remedy = did_you_mean(kind, known.iter().copied());
        let remedy = remedy.unwrap_or_else(|| format!("blocks known here: {}", known.join(", ")));
        self.problems
            .push(line, Diagnostic::error("unknown-block", format!("there is no block `{kind}`")).remedy(remedy));
    }

    /// Skips what is left of a block and of the blocks in it.
    fn skip_block(&mut self, open: Open) {
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

    fn cut_off(&mut self, open: Open) {
        let fact = format!("the file ends inside the block {} that begins here", open.kind);
        let remedy = format!("the file may be cut off; the block is closed by `End {}`", open.kind);
        self.problems.push(open.line, Diagnostic::error("cut-off", fact).remedy(remedy));
    }

    /// A word of the heading of a block; nothing, said, when there is none.
    fn heading(&mut self, open: Open, what: &str) -> Option<String> {
        let word = self.tokens.peek().filter(|word| !matches!(*word, b"Begin" | b"End")).map(text);
        if word.is_some() {
            self.tokens.word();
        } else {
            let fact = format!("`{}` is not followed by {what}", open.kind);
            self.problems.error(open.line, "bad-heading", fact);
        }
        word
    }

    fn heading_id(&mut self, open: Open) -> Option<u32> {
        let word = self.heading(open, "an id")?;
        let id = parse_prefix(word.as_bytes()).map(|(value, _)| value).filter(|v| *v >= 0.0 && *v <= u32::MAX.into());
        if id.is_none() {
            self.problems.error(open.line, "bad-number", format!("`{word}` is not an id of {}", open.kind));
        }
        id.map(|v| v as u32)
    }

    /// Whether the block ends here; its `End` is then behind us. Says so when it ends in a wrong way.
    fn ends(&mut self, open: Open) -> bool {
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
    fn row(&mut self, open: Open) -> Option<u32> {
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

    fn bad_number(&mut self, what: &str, open: Open) {
        // The end of a block and of the file are reported by who looks for the next row.
        let Some(word) = self.tokens.peek() else { return };
        let line = self.tokens.line;
        if word == b"End" || word == b"Begin" {
            let fact = format!("the last row of the block {} of line {} ends before {what}", open.kind, open.line);
            self.problems.error(line, "short-row", fact);
        } else {
            let fact = format!("`{}` is not {what}, in the block {}", text(word), open.kind);
            self.problems.error(line, "bad-number", fact);
            self.tokens.skip_line();
        }
    }

    fn said_whole(&mut self, whole: bool, value: &dyn std::fmt::Display) {
        if !whole {
            let fact = format!("only the beginning of a word is a number: it is read as {value}, as Kratos does");
            self.problems.push(
                self.tokens.line,
                Diagnostic::warning("number-prefix", fact).remedy("exponents are written with e, as in 1.0e5"),
            );
        }
    }

    fn integer(&mut self, what: &str, open: Open) -> Option<u32> {
        match self.tokens.integer() {
            Some(Number { value, whole: true }) => Some(value),
            Some(Number { value, .. }) => {
                self.said_whole(false, &value);
                Some(value)
            }
            None => {
                self.bad_number(what, open);
                None
            }
        }
    }

    fn number(&mut self, what: &str, open: Open) -> Option<f64> {
        match self.tokens.number() {
            Some(Number { value, whole: true }) => Some(value),
            Some(Number { value, .. }) => {
                self.said_whole(false, &value);
                Some(value)
            }
            None => {
                self.bad_number(what, open);
                None
            }
        }
    }

    fn nodes(&mut self, open: Open) {
        while let Some(id) = self.row(open) {
            let line = self.tokens.line;
            let mut position = [0.0; 3];
            let whole = position.iter_mut().zip(["x", "y", "z"]).all(|(x, axis)| {
                let value = self.tokens.number();
                match value {
                    Some(Number { value, whole: true }) => *x = value,
                    Some(Number { value, .. }) => {
                        self.said_whole(false, &value);
                        *x = value;
                    }
                    None => self.bad_number(&format!("a coordinate ({axis} of node {id})"), open),
                }
                value.is_some()
            });
            if whole {
                self.document.nodes.ids.push(id);
                self.document.nodes.coordinates.push(position);
                self.lines.nodes.push(line);
            }
        }
    }

    fn entities(&mut self, open: Open) {
        let Some(name) = self.heading(open, "the name of an element, condition or geometry") else {
            return self.skip_block(open);
        };
        let Some(nodes_per_entity) = (self.names.nodes_of)(&name) else {
            let fact = format!("`{name}` is not registered ({})", open.kind);
            let remedy = did_you_mean(&name, self.names.known.iter().copied());
            let remedy = remedy.unwrap_or_else(|| "`zelus list` shows the registered names".to_owned());
            self.problems.push(open.line, Diagnostic::error("unknown-entity", fact).remedy(remedy));
            return self.skip_block(open);
        };
        let has_properties = open.kind != "Geometries";
        let mut block = EntityBlock { name, nodes_per_entity, line: Line(open.line), ..Default::default() };
        let mut lines = Vec::new();
        while let Some(id) = self.row(open) {
            let line = self.tokens.line;
            let length = block.nodes.len();
            let properties = if has_properties {
                let Some(properties) = self.integer("a properties id", open) else { continue };
                properties
            } else {
                0
            };
            for _ in 0..nodes_per_entity {
                let Some(node) = self.integer("a node id", open) else { break };
                block.nodes.push(node);
            }
            if block.nodes.len() < length + nodes_per_entity {
                block.nodes.truncate(length);
                continue;
            }
            block.ids.push(id);
            if has_properties {
                block.properties.push(properties);
            }
            lines.push(line);
        }
        let (blocks, all_lines) = match open.kind {
            "Elements" => (&mut self.document.elements, &mut self.lines.elements),
            "Conditions" => (&mut self.document.conditions, &mut self.lines.conditions),
            _ => (&mut self.document.geometries, &mut self.lines.geometries),
        };
        blocks.push(block);
        all_lines.push(lines);
    }

    fn constraints(&mut self, open: Open) {
        let Some(name) = self.heading(open, "the name of a constraint") else { return self.skip_block(open) };
        let Some(first) = self.heading(open, "a variable") else { return self.skip_block(open) };
        let mut block = ConstraintBlock { name, variables: vec![first], line: Line(open.line), ..Default::default() };
        while let Some(word) = self.tokens.word_on_line() {
            block.variables.push(text(word));
        }
        let mut lines = Vec::new();
        while let Some(id) = self.row(open) {
            let line = self.tokens.line;
            let Some(constant) = self.number("the constant of the constraint", open) else { continue };
            let mut weights = Vec::new();
            if !self.list(b'[', b']', &mut weights) {
                self.bad_number("the list of weights, as [1.0]", open);
                continue;
            }
            let Some(slave) = self.integer("a node id", open) else { continue };
            let mut masters = Vec::new();
            while masters.len() < weights.len() {
                let Some(master) = self.integer("a node id", open) else { break };
                masters.push(master);
            }
            if masters.len() == weights.len() {
                block.rows.push(Constraint { id, constant, weights, slave, masters });
                lines.push(line);
            }
        }
        self.document.constraints.push(block);
        self.lines.constraints.push(lines);
    }

    fn data(&mut self, open: Open) {
        let Some(variable) = self.heading(open, "a variable") else { return self.skip_block(open) };
        let mut column = (self.names.is_flag)(&variable).then_some(DataColumn::Flag);
        let nodal = open.kind == "NodalData";
        let (mut ids, mut lines) = (Vec::new(), Vec::new());
        while let Some(id) = self.row(open) {
            let line = self.tokens.line;
            let read = matches!(column, Some(DataColumn::Flag)) || self.data_row(open, id, nodal, &mut column);
            if read {
                ids.push(id);
                lines.push(line);
            }
        }
        let scalar = || DataColumn::Scalar { values: Vec::new(), fixed: Vec::new() };
        let block = DataBlock { variable, ids, values: column.unwrap_or_else(scalar), line: Line(open.line) };
        let (blocks, all_lines) = match open.kind {
            "NodalData" => (&mut self.document.nodal_data, &mut self.lines.nodal_data),
            "ElementalData" => (&mut self.document.elemental_data, &mut self.lines.elemental_data),
            _ => (&mut self.document.conditional_data, &mut self.lines.conditional_data),
        };
        blocks.push(block);
        all_lines.push(lines);
    }

    /// What follows the id of a row of data; whether it was good. The first row decides the type of the column.
    fn data_row(&mut self, open: Open, id: u32, nodal: bool, column: &mut Option<DataColumn>) -> bool {
        let line = self.tokens.line;
        let mut is_fixed = false;
        if nodal {
            match self.integer("the fixity, 0 or 1", open) {
                Some(fixity @ 0..=1) => is_fixed = fixity == 1,
                Some(other) => {
                    let fact = format!("the fixity of node {id} is {other}");
                    let remedy = "a row is `id fixed value` with fixed 0 or 1";
                    self.problems.push(line, Diagnostic::error("bad-number", fact).remedy(remedy));
                    self.tokens.skip_line();
                    return false;
                }
                None => return false,
            }
        }
        if self.tokens.skip() != Some(b'[') {
            let Some(value) = self.number("a value", open) else { return false };
            let new = || DataColumn::Scalar { values: Vec::new(), fixed: Vec::new() };
            let DataColumn::Scalar { values, fixed } = column.get_or_insert_with(new) else {
                return self.mixed_shapes(line, open);
            };
            values.push(value);
            fixed.extend(nodal.then_some(is_fixed));
            return true;
        }
        if is_fixed {
            let fact = format!("node {id} has a vector that is fixed");
            let remedy = "fix its components in blocks of their own, as NodalData DISPLACEMENT_X";
            self.problems.push(line, Diagnostic::error("fixed-vector", fact).remedy(remedy));
        }
        match self.bracketed(open) {
            None => false,
            Some(DataValue::Matrix { rows, columns, values }) => {
                let new = || DataColumn::Matrix { rows, columns, values: Vec::new() };
                match column.get_or_insert_with(new) {
                    DataColumn::Matrix { rows: r, columns: c, values: all } if (rows, columns) == (*r, *c) => {
                        all.extend(values);
                        true
                    }
                    _ => self.mixed_shapes(line, open),
                }
            }
            Some(DataValue::Vector(values)) => {
                let new = || DataColumn::Vector { size: values.len(), values: Vec::new() };
                match column.get_or_insert_with(new) {
                    DataColumn::Vector { size, values: all } if *size == values.len() => {
                        all.extend(values);
                        true
                    }
                    _ => self.mixed_shapes(line, open),
                }
            }
            Some(_) => false,
        }
    }

    fn mixed_shapes(&mut self, line: u32, open: Open) -> bool {
        let fact = format!("a value whose shape differs from the first one of the block {}", open.kind);
        self.problems.error(line, "mixed-shapes", fact);
        false
    }

    /// `[n] (a,…)` or `[m,n] ((a,…),…)`; reported when wrong.
    fn bracketed(&mut self, open: Open) -> Option<DataValue> {
        let mut shape = Vec::new();
        let shape_read = self.list(b'[', b']', &mut shape);
        let (mut values, mut rows) = (Vec::new(), 0);
        let is_matrix = shape.len() == 2;
        let read = shape_read
            && if !is_matrix {
                shape.len() == 1 && self.list(b'(', b')', &mut values)
            } else {
                let mut good = self.tokens.punctuation(b'(');
                while good && !self.tokens.punctuation(b')') {
                    let start = values.len();
                    good = (rows == 0 || self.tokens.punctuation(b',')) && self.list(b'(', b')', &mut values);
                    good &= values.len() - start == shape[1] as usize;
                    rows += 1;
                }
                good && rows == shape[0] as usize
            };
        if !read || (!is_matrix && values.len() != shape[0] as usize) {
            let line = self.tokens.line;
            let fact = format!("a value in the block {} is not a vector or matrix of the size it states", open.kind);
            let remedy = "a vector is written [3] (a,b,c), a matrix [2,2] ((a,b),(c,d))";
            self.problems.push(line, Diagnostic::error("bad-value", fact).remedy(remedy));
            self.tokens.skip_line();
            return None;
        }
        Some(match is_matrix {
            true => DataValue::Matrix { rows, columns: shape[1] as usize, values },
            false => DataValue::Vector(values),
        })
    }

    /// Numbers between `first` and `last`, separated by commas; whether they are well formed.
    fn list(&mut self, first: u8, last: u8, values: &mut Vec<f64>) -> bool {
        if !self.tokens.punctuation(first) {
            return false;
        }
        if self.tokens.punctuation(last) {
            return true;
        }
        loop {
            let Some(number) = self.tokens.number() else { return false };
            self.said_whole(number.whole, &number.value);
            values.push(number.value);
            if self.tokens.punctuation(last) {
                return true;
            }
            if !self.tokens.punctuation(b',') {
                return false;
            }
        }
    }

    /// `NAME value` pairs and, where `tables` is given, tables.
    fn entries(&mut self, open: Open, entries: &mut Vec<DataEntry>, mut tables: Option<&mut Vec<Table>>) {
        while !self.ends(open) {
            let Some(name) = self.tokens.word().map(text) else { continue };
            let line = self.tokens.line;
            if name == "Begin" {
                let Some(kind) = self.heading(Open { kind: "Begin", line }, "the kind of block") else { continue };
                let inner = Open { kind: &kind, line };
                match tables.as_deref_mut() {
                    Some(tables) if kind == "Table" => tables.extend(self.table(inner, None)),
                    Some(_) => {
                        self.unknown_block(&kind, line, &["Table"]);
                        self.skip_block(inner);
                    }
                    None => {
                        self.unknown_block(&kind, line, &[]);
                        self.skip_block(inner);
                    }
                }
                continue;
            }
            let value = match self.tokens.peek() {
                None | Some(b"End" | b"Begin") => {
                    self.problems.error(line, "missing-value", format!("{name} has no value"));
                    continue;
                }
                Some(word) if word[0] == b'[' => match self.bracketed(open) {
                    Some(value) => value,
                    None => continue,
                },
                Some(word) => {
                    self.tokens.word();
                    match parse_prefix(word) {
                        Some((value, length)) if length == word.len() => DataValue::Number(value),
                        _ => DataValue::Text(text(word)),
                    }
                }
            };
            entries.push(DataEntry { name, value, line: Line(line) });
        }
    }

    fn table(&mut self, open: Open, id: Option<u32>) -> Option<Table> {
        let variables = self.heading(open, "the variable of the argument").zip(self.heading(open, "two variables"));
        let Some((input_variable, output_variable)) = variables else {
            self.skip_block(open);
            return None;
        };
        let mut rows = Vec::new();
        while !self.ends(open) {
            let Some(x) = self.number("a number", open) else {
                if self.tokens.peek() == Some(b"Begin") {
                    break;
                }
                continue;
            };
            let Some(y) = self.number("a number", open) else { continue };
            rows.push([x, y]);
        }
        Some(Table { id, input_variable, output_variable, rows, line: Line(open.line) })
    }

    fn sub_model_part(&mut self, open: Open, siblings: &mut Vec<SubModelPart>) {
        let Some(name) = self.heading(open, "a name") else { return self.skip_block(open) };
        if let Some(first) = siblings.iter().find(|part| part.name == name) {
            let fact = format!("the sub model part {name} is already defined in line {}", first.line.0);
            let remedy = "names are unique among siblings; merge the two blocks or rename one";
            self.problems.push(open.line, Diagnostic::error("repeated-part", fact).remedy(remedy));
        }
        let mut part = SubModelPart { name, line: Line(open.line), ..Default::default() };
        while !self.ends(open) {
            let Some(word) = self.tokens.word() else { continue };
            let line = self.tokens.line;
            if word != b"Begin" {
                let fact = format!("`{}` stands outside any block of the sub model part {}", text(word), part.name);
                self.problems.error(line, "outside-block", fact);
                self.tokens.skip_line();
                continue;
            }
            let Some(kind) = self.heading(Open { kind: "Begin", line }, "the kind of block") else { continue };
            let inner = Open { kind: &kind, line };
            match kind.as_str() {
                "SubModelPartData" => self.entries(inner, &mut part.data, None),
                "SubModelPartTables" => self.ids(inner, &mut part.tables),
                "SubModelPartProperties" => self.ids(inner, &mut part.properties),
                "SubModelPartNodes" => self.ids(inner, &mut part.nodes),
                "SubModelPartElements" => self.ids(inner, &mut part.elements),
                "SubModelPartConditions" => self.ids(inner, &mut part.conditions),
                "SubModelPartGeometries" => self.ids(inner, &mut part.geometries),
                "SubModelPartConstraints" => self.ids(inner, &mut part.constraints),
                "SubModelPart" => self.sub_model_part(inner, &mut part.parts),
                _ => {
                    self.unknown_block(&kind, line, &PART_BLOCKS);
                    self.skip_block(inner);
                }
            }
        }
        siblings.push(part);
    }

    fn ids(&mut self, open: Open, ids: &mut Vec<u32>) {
        while let Some(id) = self.row(open) {
            ids.push(id);
        }
    }
}
