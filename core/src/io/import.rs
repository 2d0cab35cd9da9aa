//! From a mesh document to a model part: ids become indices, names become registered kinds and variables.

use crate::model::EntityRole;
mod constraints;

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use rustc_hash::FxHashMap;

use super::mdpa::{self, DataBlock, DataColumn, DataEntry, DataValue, EntityNames, Line, MdpaDocument, MdpaEntities};
use super::variable_names::{kind_of, law_name, unknown_variable, without_effect};
use crate::diagnostics::{Diagnostic, Place, Report, Result};
use crate::entities::{find_kind, kind_names, require_kind};
use crate::geometry::Shape;
use crate::model::flags::flag;
use crate::model::{
    EntityTable, Fields, Flags, ModelPart, Named, Nodes, Properties, PropertyValue, ScalarVariable, SubPart, Table,
    VariableKind, named,
};

/// Gives `read` the registered names that it must know.
pub(super) fn entity_names<R>(read: impl FnOnce(&EntityNames) -> R) -> R {
    let known = [kind_names(EntityRole::Element), kind_names(EntityRole::Condition)].concat();
    let nodes_of = |name: &str| {
        let entry = find_kind(EntityRole::Element, name).or_else(|| find_kind(EntityRole::Condition, name));
        entry.map(|entry| entry.nodes()).or_else(|| shape_of_geometry(name).map(|(cell, _)| cell.nodes()))
    };
    read(&EntityNames { nodes_of: &nodes_of, known: &known, is_flag: &|name| flag(name).is_ok() })
}

/// Reads an mdpa file into `part`; gives the warnings. Columns the part already has are kept and made longer.
///
/// # Errors
/// As [`mdpa::read`] and [`import`].
pub fn read_mesh(path: &Path, part: &mut ModelPart) -> Result<Vec<Diagnostic>> {
    let (document, mut warnings) = entity_names(|names| mdpa::read(path, names))?;
    warnings.extend(import(&document, part)?);
    Ok(warnings)
}

/// The names of sub model parts of an mdpa file, as parts with nothing in them; `None` where there is no such
/// file, or it is not whole.
pub fn names_of_parts(path: &Path) -> Option<BTreeMap<String, SubPart>> {
    let text = std::fs::read(path).ok()?;
    let text = String::from_utf8_lossy(&text);
    let mut open = vec![SubPart::new("")];
    let mut blocks = 0_i64;
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.clone().next() {
            Some("Begin") => blocks += 1,
            Some("End") => blocks -= 1,
            _ => {}
        }
        match (words.next(), words.next(), words.next()) {
            (Some("Begin"), Some("SubModelPart"), Some(name)) if open.len() <= mdpa::DEPTH => {
                open.push(SubPart::new(name))
            }
            (Some("End"), Some("SubModelPart"), _) if open.len() > 1 => close(&mut open),
            _ => {}
        }
    }
    (blocks == 0 && open.len() == 1).then(|| open.swap_remove(0).children)
}

/// Puts the last part into the one before it.
fn close(open: &mut Vec<SubPart>) {
    let done = open.pop().expect("a part is open");
    open.last_mut().expect("the whole is open").children.insert(done.name.clone(), done);
}

/// Reference cell and space of a geometry by its name, as `Quadrilateral3D4`.
pub fn shape_of_geometry(name: &str) -> Option<(Shape, usize)> {
    let kinds = [
        ("Point", 0),
        ("Line", 1),
        ("Triangle", 2),
        ("Quadrilateral", 2),
        ("Tetrahedra", 3),
        ("Prism", 3),
        ("Hexahedra", 3),
    ];
    let (kind, dimension) = kinds.iter().find(|(kind, _)| name.starts_with(kind))?;
    let rest = &name[kind.len()..];
    let space = if rest.starts_with("2D") { 2 } else { 3 };
    let nodes = rest.strip_prefix("2D").or_else(|| rest.strip_prefix("3D"))?;
    let cell = Shape::of(*dimension, if nodes.is_empty() { 1 } else { nodes.parse().ok()? })?;
    Some((cell, space))
}

/// Puts the content of a document into `part`, sorted by id; gives the warnings.
///
/// The document is one that was read (or is as good): ids are unique and references go to existing entities.
///
/// # Errors
/// Names of entities, variables, flags and laws that are not registered, and values that do not fit their variable,
/// each with its line.
pub fn import(document: &MdpaDocument, part: &mut ModelPart) -> Result<Vec<Diagnostic>> {
    let mut import = Import { document, report: Report::new() };
    import.nodes(part);
    import.elements_and_conditions(part);
    import.geometries(part);
    for entry in &document.model_part_data {
        import.entry(entry, &mut part.data);
    }
    for table in &document.tables {
        part.tables.extend(table.id.map(|id| (id as usize, Table::new(table.rows.clone()))));
    }
    import.properties(part);
    import.nodal_data(part);
    let ModelPart { elements, conditions, .. } = part;
    for (blocks, table) in [(&document.elemental_data, elements), (&document.conditional_data, conditions)] {
        for block in blocks {
            let EntityTable { data, flags, .. } = &mut *table;
            let (mut data, mut flags) = (std::mem::take(data), std::mem::take(flags));
            import.column(block, &mut data, &mut flags, &|id| table.find(id).expect("checked by the reader"));
            (table.data, table.flags) = (data, flags);
        }
    }
    let constraints = import.constraints(part);
    import.sub_parts(part, &constraints);
    import.report.finish()
}

struct Import<'a> {
    document: &'a MdpaDocument,
    report: Report,
}

impl Import<'_> {
    fn push(&mut self, line: Line, diagnostic: Diagnostic) {
        self.report.push(diagnostic.at(self.place(line)));
    }

    fn place(&self, line: Line) -> Place {
        Place::at(&self.document.file, line.0, 0)
    }

    fn nodes(&self, part: &mut ModelPart) {
        let source = &self.document.nodes;
        let mut order: Vec<usize> = (0..source.ids.len()).collect();
        order.sort_by_key(|&at| source.ids[at]);
        // The reader lets a repeated node with equal coordinates pass.
        order.dedup_by_key(|at| source.ids[*at]);
        let ids = order.iter().map(|&at| source.ids[at] as usize).collect();
        let nodes = Nodes::new(ids, order.iter().map(|&at| source.coordinates[at]).collect());
        let Nodes { mut history, mut values, .. } = std::mem::replace(&mut part.nodes, nodes);
        history.grow(part.nodes.len());
        values.grow(part.nodes.len());
        (part.nodes.history, part.nodes.values) = (history, values);
    }

    fn elements_and_conditions(&mut self, part: &mut ModelPart) {
        let ModelPart { nodes, elements, conditions, .. } = part;
        for (role, blocks, table) in [
            (EntityRole::Element, &self.document.elements, elements),
            (EntityRole::Condition, &self.document.conditions, conditions),
        ] {
            let mut rows: Vec<(u32, &MdpaEntities, usize)> = Vec::new();
            let mut entries = Vec::new();
            for block in blocks {
                match require_kind(role, &block.name) {
                    Ok(entry) => entries.push((block.name.as_str(), entry)),
                    Err(problem) => self.push(block.line, problem),
                }
                rows.extend(block.ids.iter().enumerate().map(|(at, &id)| (id, block, at)));
            }
            rows.sort_by_key(|&(id, ..)| id);
            let mut indices = Vec::new();
            for (id, block, at) in rows {
                let Some((_, entry)) = entries.iter().find(|(name, _)| *name == block.name) else { continue };
                indices.clear();
                indices.extend(block.nodes_of(at).iter().map(|&node| nodes.find(node as usize).expect("checked")));
                table.push(id as usize, entry, block.properties[at] as usize, &indices);
            }
            table.finish();
        }
    }

    fn geometries(&self, part: &mut ModelPart) {
        let mut rows: Vec<(u32, &MdpaEntities, usize)> = Vec::new();
        for block in &self.document.geometries {
            rows.extend(block.ids.iter().enumerate().map(|(at, &id)| (id, block, at)));
        }
        rows.sort_by_key(|&(id, ..)| id);
        part.geometries.place = self.document.geometries.first().map(|block| self.place(block.line));
        for (id, block, at) in rows {
            let Some((cell, space)) = shape_of_geometry(&block.name) else { continue };
            let nodes = block.nodes_of(at).iter().map(|&node| part.nodes.find(node as usize).expect("checked"));
            part.geometries.push(id as usize, cell, space, nodes.collect());
        }
    }

    fn properties(&mut self, part: &mut ModelPart) {
        for block in &self.document.properties {
            let mut properties = Properties::new(block.id as usize);
            properties.place = Some(self.place(block.line));
            for entry in &block.values {
                match (&entry.name[..], &entry.value) {
                    ("CONSTITUTIVE_LAW", DataValue::Text(law)) => match law_name(law) {
                        Ok(name) => properties.law = Some(name),
                        Err(problem) => self.push(entry.line, problem),
                    },
                    _ => self.entry(entry, &mut properties.values),
                }
            }
            for table in &block.tables {
                for name in [&table.input_variable, &table.output_variable] {
                    if kind_of(name).is_none() {
                        self.push(table.line, unknown_variable(name));
                    }
                }
                if let Some(fault) = Table::fault(&table.output_variable, &table.rows) {
                    self.push(table.line, fault);
                }
                let names = (table.input_variable.clone(), table.output_variable.clone());
                properties.tables.insert(names, Table::new(table.rows.clone()));
            }
            part.properties.insert(properties.id, properties);
        }
    }

    /// Stores one `NAME value`, as the kind of the variable wants it.
    fn entry(&mut self, entry: &DataEntry, values: &mut BTreeMap<String, PropertyValue>) {
        let Some(kind) = kind_of(&entry.name) else { return self.push(entry.line, unknown_variable(&entry.name)) };
        let value = match (kind, &entry.value) {
            (VariableKind::Scalar | VariableKind::Integer, DataValue::Number(value)) => PropertyValue::Number(*value),
            (VariableKind::Scalar | VariableKind::Integer, DataValue::Text(text)) => match mdpa::number_prefix(text) {
                Some(value) => {
                    let fact = format!("{} {text} is read as {value:?}, as Kratos does", entry.name);
                    let remedy = "exponents are written with e, as in 1.0e5";
                    self.push(entry.line, Diagnostic::warning("number-prefix", fact).remedy(remedy));
                    PropertyValue::Number(value)
                }
                None => return self.misfit(entry, "a number"),
            },
            (VariableKind::Boolean, DataValue::Number(value)) => PropertyValue::Boolean(*value != 0.0),
            (VariableKind::Boolean, DataValue::Text(text)) if text == "true" || text == "false" => {
                PropertyValue::Boolean(text == "true")
            }
            (VariableKind::Vector3, DataValue::Vector(values)) if values.len() == 3 => {
                PropertyValue::Vector(values.clone())
            }
            (VariableKind::Vector, DataValue::Vector(values)) => PropertyValue::Vector(values.clone()),
            (VariableKind::Matrix, DataValue::Matrix { columns, values, .. }) => {
                PropertyValue::Matrix(values.chunks(*columns.max(&1)).map(<[f64]>::to_vec).collect())
            }
            (VariableKind::Text, DataValue::Text(text)) => PropertyValue::Text(text.clone()),
            (VariableKind::Text, DataValue::Number(value)) => PropertyValue::Text(value.to_string()),
            (VariableKind::Boolean, _) => return self.misfit(entry, "0 or 1"),
            (VariableKind::Vector3, _) => return self.misfit(entry, "three numbers, [3] (a,b,c)"),
            (VariableKind::Vector, _) => return self.misfit(entry, "a vector, [3] (a,b,c)"),
            (VariableKind::Matrix, _) => return self.misfit(entry, "a matrix, [2,2] ((a,b),(c,d))"),
            (VariableKind::Text, _) => return self.misfit(entry, "a word"),
            (VariableKind::Scalar | VariableKind::Integer, _) => return self.misfit(entry, "a number"),
        };
        values.insert(entry.name.clone(), value);
    }

    fn misfit(&mut self, entry: &DataEntry, wanted: &str) {
        let fact = format!("the value of {} is not {wanted}", entry.name);
        self.push(entry.line, Diagnostic::error("wrong-type", fact));
    }

    fn nodal_data(&mut self, part: &mut ModelPart) {
        for block in &self.document.nodal_data {
            let Nodes { history, flags, .. } = &mut part.nodes;
            let (mut history, mut flags) = (std::mem::take(history), std::mem::take(flags));
            let find = |id| part.nodes.find(id).expect("checked by the reader");
            let stored = self.column(block, &mut history, &mut flags, &find);
            (part.nodes.history, part.nodes.flags) = (history, flags);
            if let (Some(variable), DataColumn::Scalar { fixed, .. }) = (stored, &block.values) {
                let held = block.ids.iter().zip(fixed).filter(|(_, fixed)| **fixed);
                let held: Vec<u32> = held.filter_map(|(&id, _)| part.nodes.find(id as usize)).collect();
                if !held.is_empty() {
                    part.nodes.set_fixed(variable, &held, true);
                }
            }
        }
    }

    /// Stores a block of values; gives the scalar it fills, when it fills one.
    fn column(
        &mut self,
        block: &DataBlock,
        fields: &mut Fields,
        flags: &mut Flags,
        find: &dyn Fn(usize) -> u32,
    ) -> Option<ScalarVariable> {
        if let DataColumn::Flag = block.values {
            match flag(&block.variable) {
                Ok(name) => block.ids.iter().for_each(|&id| flags.set(name, find(id as usize) as usize, true)),
                Err(problem) => self.push(block.line, problem),
            }
            return None;
        }
        let Some(variable) = named(&block.variable) else {
            self.push(block.line, unknown_variable(&block.variable));
            return None;
        };
        if let Some(warning) = without_effect(&block.variable) {
            self.push(block.line, warning);
        }
        let (name, offset, size) = variable.column();
        let (values, given) = match &block.values {
            DataColumn::Scalar { values, .. } => (values, 1),
            DataColumn::Vector { size, values } => (values, *size),
            DataColumn::Matrix { rows, columns, values } => (values, rows * columns),
            DataColumn::Flag => return None,
        };
        let free_size = matches!(variable, Named::Whole(_, VariableKind::Vector | VariableKind::Matrix));
        if given != size && !free_size {
            let fact = format!("{} takes {size} numbers, the block gives {given}", block.variable);
            self.push(block.line, Diagnostic::error("wrong-size", fact));
            return None;
        }
        let components = match variable {
            Named::Component(_) => 3,
            Named::Whole(..) => given,
        };
        fields.add_named(name, components);
        let field = fields.get_mut(name).expect("just added");
        if field.components != components {
            let fact = format!("{} has {} numbers elsewhere, here {given}", block.variable, field.components);
            self.push(block.line, Diagnostic::error("wrong-size", fact));
            return None;
        }
        for (id, row) in block.ids.iter().zip(values.chunks_exact(given)) {
            let at = find(*id as usize) as usize * components + offset;
            field.levels[0][at..at + given].copy_from_slice(row);
        }
        match variable {
            Named::Component(scalar) => Some(scalar),
            Named::Whole(column, _) => (given == 1).then_some(ScalarVariable { column, component: None }),
        }
    }

    fn sub_parts(&mut self, part: &mut ModelPart, constraints: &FxHashMap<u32, Range<u32>>) {
        let mut tree = std::mem::take(&mut part.tree);
        for source in &self.document.sub_model_parts {
            let child = self.sub_part(source, part, constraints);
            tree.children.insert(child.name.clone(), child);
        }
        tree.nodes = (0..part.nodes.len() as u32).collect();
        tree.elements = (0..part.elements.len() as u32).collect();
        tree.conditions = (0..part.conditions.len() as u32).collect();
        tree.geometries = (0..part.geometries.ids.len() as u32).collect();
        tree.constraints = (0..part.constraints.len() as u32).collect();
        tree.tables = part.tables.keys().copied().collect();
        tree.properties = part.properties.keys().copied().collect();
        tree.normalise();
        part.tree = tree;
    }

    fn sub_part(
        &mut self,
        source: &mdpa::SubModelPart,
        part: &ModelPart,
        constraints: &FxHashMap<u32, Range<u32>>,
    ) -> SubPart {
        let mut out = SubPart::new(source.name.clone());
        out.nodes = source.nodes.iter().filter_map(|&id| part.nodes.find(id as usize)).collect();
        out.elements = source.elements.iter().filter_map(|&id| part.elements.find(id as usize)).collect();
        out.conditions = source.conditions.iter().filter_map(|&id| part.conditions.find(id as usize)).collect();
        out.geometries = source.geometries.iter().filter_map(|&id| part.geometries.find(id as usize)).collect();
        out.constraints = source.constraints.iter().filter_map(|id| constraints.get(id).cloned()).flatten().collect();
        out.tables = source.tables.iter().map(|&id| id as usize).collect();
        out.properties = source.properties.iter().map(|&id| id as usize).collect();
        for entry in &source.data {
            self.entry(entry, &mut out.data);
        }
        for inner in &source.parts {
            let child = self.sub_part(inner, part, constraints);
            out.nodes.extend(&child.nodes);
            out.elements.extend(&child.elements);
            out.conditions.extend(&child.conditions);
            out.geometries.extend(&child.geometries);
            out.constraints.extend(&child.constraints);
            out.children.insert(child.name.clone(), child);
        }
        out
    }
}
