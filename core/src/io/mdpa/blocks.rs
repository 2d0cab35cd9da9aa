//! The bodies of the blocks of an mdpa file.

use super::mdpa_document::*;
use super::reader::{MdpaReader, OpenBlock, text};
use super::tokens::parse_prefix;
use crate::diagnostics::{Diagnostic, did_you_mean};
use crate::model::EntityRole;
use crate::registry::instead_of;

/// Sub model parts may be nested this deep.
pub const DEPTH: usize = 100;

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

impl MdpaReader<'_> {
    pub(super) fn nodes(&mut self, open: OpenBlock) {
        while let Some(id) = self.row(open) {
            let line = self.tokens.line;
            let mut position = [0.0; 3];
            let read = position.iter_mut().all(|x| {
                let value = self.number("a coordinate", open);
                *x = value.unwrap_or_default();
                value.is_some()
            });
            if read {
                self.document.nodes.ids.push(id);
                self.document.nodes.coordinates.push(position);
                self.lines.nodes.push(line);
            }
        }
    }

    pub(super) fn entities(&mut self, open: OpenBlock) {
        let Some(name) = self.heading(open, "the name of an element, condition or geometry") else {
            return self.skip_block(open);
        };
        let Some(nodes_per_entity) = (self.names.nodes_of)(&name) else {
            let fact = format!("`{name}` is not registered ({})", open.kind);
            let sort = if open.kind == "Conditions" { EntityRole::Condition } else { EntityRole::Element };
            let instead = instead_of(sort.word(), &name).map(str::to_owned);
            let remedy = instead.or_else(|| did_you_mean(&name, self.names.known.iter().copied()));
            let remedy = remedy.unwrap_or_else(|| "`zelus list` shows the registered names".to_owned());
            self.problems.push(open.line, Diagnostic::error("unknown-entity", fact).remedy(remedy));
            return self.skip_block(open);
        };
        let has_properties = open.kind != "Geometries";
        let mut block = MdpaEntities { name, nodes_per_entity, line: Line(open.line), ..Default::default() };
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

    pub(super) fn constraints(&mut self, open: OpenBlock) {
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

    pub(super) fn data(&mut self, open: OpenBlock) {
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

    /// The value after the id in a row of data; returns whether it was good. The first row decides the type of the column.
    fn data_row(&mut self, open: OpenBlock, id: u32, nodal: bool, column: &mut Option<DataColumn>) -> bool {
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

    fn mixed_shapes(&mut self, line: u32, open: OpenBlock) -> bool {
        let fact = format!("a value whose shape differs from the first one of the block {}", open.kind);
        self.problems.error(line, "mixed-shapes", fact);
        false
    }

    /// `[n] (a,…)` or `[m,n] ((a,…),…)`; reported when wrong.
    fn bracketed(&mut self, open: OpenBlock) -> Option<DataValue> {
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
    pub(super) fn entries(
        &mut self,
        open: OpenBlock,
        entries: &mut Vec<DataEntry>,
        mut tables: Option<&mut Vec<MdpaTable>>,
    ) {
        while !self.ends(open) {
            let Some(name) = self.tokens.word().map(text) else { continue };
            let line = self.tokens.line;
            if name == "Begin" {
                let Some(kind) = self.heading(OpenBlock { kind: "Begin", line }, "the kind of block") else { continue };
                let inner = OpenBlock { kind: &kind, line };
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

    pub(super) fn table(&mut self, open: OpenBlock, id: Option<u32>) -> Option<MdpaTable> {
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
        Some(MdpaTable { id, input_variable, output_variable, rows, line: Line(open.line) })
    }

    pub(super) fn sub_model_part(&mut self, open: OpenBlock, siblings: &mut Vec<SubModelPart>) {
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
            let Some(kind) = self.heading(OpenBlock { kind: "Begin", line }, "the kind of block") else { continue };
            let inner = OpenBlock { kind: &kind, line };
            match kind.as_str() {
                "SubModelPartData" => self.entries(inner, &mut part.data, None),
                "SubModelPartTables" => self.ids(inner, &mut part.tables),
                "SubModelPartProperties" => self.ids(inner, &mut part.properties),
                "SubModelPartNodes" => self.ids(inner, &mut part.nodes),
                "SubModelPartElements" => self.ids(inner, &mut part.elements),
                "SubModelPartConditions" => self.ids(inner, &mut part.conditions),
                "SubModelPartGeometries" => self.ids(inner, &mut part.geometries),
                "SubModelPartConstraints" => self.ids(inner, &mut part.constraints),
                "SubModelPart" if self.depth == DEPTH => {
                    let fact = format!("sub model parts are nested more than {DEPTH} deep");
                    let remedy = "an `End SubModelPart` may be missing above";
                    self.problems.push(line, Diagnostic::error("nested-too-deep", fact).remedy(remedy));
                    self.skip_block(inner);
                }
                "SubModelPart" => {
                    self.depth += 1;
                    self.sub_model_part(inner, &mut part.parts);
                    self.depth -= 1;
                }
                _ => {
                    self.unknown_block(&kind, line, &PART_BLOCKS);
                    self.skip_block(inner);
                }
            }
        }
        siblings.push(part);
    }

    fn ids(&mut self, open: OpenBlock, ids: &mut Vec<u32>) {
        while let Some(id) = self.row(open) {
            ids.push(id);
        }
    }
}
