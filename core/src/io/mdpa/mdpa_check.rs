//! Checks across the blocks of an mdpa file: ids defined once, references to existing entities.

use std::collections::BTreeMap;

use super::mdpa_document::*;
use super::mdpa_problems::Problems;
use crate::diagnostics::Diagnostic;
use rustc_hash::FxHashMap;

/// The line of every row, block by block; needed while the file is checked, not after.
#[derive(Default)]
pub(super) struct Lines {
    pub(super) nodes: Vec<u32>,
    pub(super) elements: Vec<Vec<u32>>,
    pub(super) conditions: Vec<Vec<u32>>,
    pub(super) geometries: Vec<Vec<u32>>,
    pub(super) constraints: Vec<Vec<u32>>,
    pub(super) nodal_data: Vec<Vec<u32>>,
    pub(super) elemental_data: Vec<Vec<u32>>,
    pub(super) conditional_data: Vec<Vec<u32>>,
}

/// From an id to the row that defined it first: an array where ids are dense, else a map.
enum Ids {
    Dense(Vec<u32>),
    Sparse(FxHashMap<u32, u32>),
}

impl Ids {
    const NONE: u32 = u32::MAX;

    fn new(largest: u32, count: usize) -> Self {
        if (largest as usize) < 4 * count + 1024 {
            Self::Dense(vec![Self::NONE; largest as usize + 1])
        } else {
            Self::Sparse(FxHashMap::default())
        }
    }

    /// Enters an id; gives the row that has it already.
    fn enter(&mut self, id: u32, row: u32) -> Option<u32> {
        match self {
            Self::Dense(rows) => {
                let entry = &mut rows[id as usize];
                if *entry == Self::NONE {
                    *entry = row;
                    return None;
                }
                Some(*entry)
            }
            Self::Sparse(rows) => {
                let entry = rows.entry(id).or_insert(row);
                (*entry != row).then_some(*entry)
            }
        }
    }

    fn has(&self, id: u32) -> bool {
        match self {
            Self::Dense(rows) => rows.get(id as usize).is_some_and(|&row| row != Self::NONE),
            Self::Sparse(rows) => rows.contains_key(&id),
        }
    }
}

/// The ids of each kind.
struct KnownIds {
    nodes: Ids,
    properties: Ids,
    tables: Ids,
    elements: Ids,
    conditions: Ids,
    geometries: Ids,
    constraints: Ids,
}

pub(super) fn check(document: &mut MdpaDocument, lines: &Lines, problems: &mut Problems) {
    let known = KnownIds {
        nodes: nodes(document, &lines.nodes, problems),
        properties: properties(document, problems),
        tables: tables(&document.tables, problems),
        elements: entities("element", &mut document.elements, &lines.elements, problems),
        conditions: entities("condition", &mut document.conditions, &lines.conditions, problems),
        geometries: entities("geometry", &mut document.geometries, &lines.geometries, problems),
        constraints: constraints(&document.constraints, &lines.constraints, problems),
    };
    for (kind, blocks, lines) in [
        ("element", &document.elements, &lines.elements),
        ("condition", &document.conditions, &lines.conditions),
        ("geometry", &document.geometries, &lines.geometries),
    ] {
        for (block, lines) in blocks.iter().zip(lines) {
            references(kind, block, lines, &known, problems);
        }
    }
    for (block, lines) in document.constraints.iter().zip(&lines.constraints) {
        for (row, &line) in block.rows.iter().zip(lines) {
            for &node in std::iter::once(&row.slave).chain(&row.masters).filter(|&&node| !known.nodes.has(node)) {
                undefined(problems, line, &format!("constraint {}", row.id), "node", node);
            }
        }
    }
    for (kind, blocks, lines, ids) in [
        ("node", &document.nodal_data, &lines.nodal_data, &known.nodes),
        ("element", &document.elemental_data, &lines.elemental_data, &known.elements),
        ("condition", &document.conditional_data, &lines.conditional_data, &known.conditions),
    ] {
        for (block, lines) in blocks.iter().zip(lines) {
            for (&id, &line) in block.ids.iter().zip(lines).filter(|&(&id, _)| !ids.has(id)) {
                undefined(problems, line, &format!("the values of {}", block.variable), kind, id);
            }
        }
    }
    document.sub_model_parts.iter().for_each(|part| sub_model_part(part, &part.name, &known, problems));
}

fn undefined(problems: &mut Problems, line: u32, who: &str, kind: &str, id: u32) {
    let problem = Diagnostic::error("undefined-id", format!("{who} names {kind} {id}, which is not defined"));
    let remedy = match kind {
        "properties" => format!("write `Begin Properties {id}` and `End Properties`, empty if need be"),
        _ => format!("correct the id, or define the {kind}"),
    };
    problems.push(line, problem.remedy(remedy));
}

fn nodes(document: &MdpaDocument, lines: &[u32], problems: &mut Problems) -> Ids {
    let MdpaNodes { ids, coordinates } = &document.nodes;
    let mut known = Ids::new(ids.iter().copied().max().unwrap_or(0), ids.len());
    for (row, (&id, position)) in ids.iter().zip(coordinates).enumerate() {
        let Some(first) = known.enter(id, row as u32).map(|first| first as usize) else { continue };
        if coordinates[first] != *position {
            let fact = format!("node {id} is already defined in line {} with other coordinates", lines[first]);
            problems
                .push(lines[row], Diagnostic::error("repeated-node", fact).remedy("give every node an id of its own"));
        } else {
            let fact = format!("node {id} is already defined in line {}, with the same coordinates", lines[first]);
            problems.push(lines[row], Diagnostic::warning("repeated-node", fact));
        }
    }
    known
}

/// Checks the ids, and merges blocks with one id into the first of them: later values win.
fn properties(document: &mut MdpaDocument, problems: &mut Problems) -> Ids {
    let blocks = std::mem::take(&mut document.properties);
    let mut known = Ids::new(blocks.iter().map(|block| block.id).max().unwrap_or(0), blocks.len());
    for block in blocks {
        let Some(first) = known.enter(block.id, document.properties.len() as u32) else {
            document.properties.push(block);
            continue;
        };
        let first = &mut document.properties[first as usize];
        let fact = format!("properties {} are already defined in line {}; the two are merged", block.id, first.line.0);
        problems.push(block.line.0, Diagnostic::warning("repeated-properties", fact));
        for entry in block.values {
            first.values.retain(|old| old.name != entry.name);
            first.values.push(entry);
        }
        first.tables.extend(block.tables);
    }
    known
}

fn tables(tables: &[MdpaTable], problems: &mut Problems) -> Ids {
    let ids = || tables.iter().filter_map(|table| table.id);
    let mut known = Ids::new(ids().max().unwrap_or(0), tables.len());
    for (row, table) in tables.iter().enumerate() {
        let Some(id) = table.id else { continue };
        if let Some(first) = known.enter(id, row as u32) {
            let fact = format!("table {id} is already defined in line {}", tables[first as usize].line.0);
            problems.error(table.line.0, "repeated-table", fact);
        }
    }
    known
}

/// Enters the ids; an entity that repeats another one is left out, one that differs from it is an error.
fn entities(kind: &str, blocks: &mut [MdpaEntities], lines: &[Vec<u32>], problems: &mut Problems) -> Ids {
    let all = || blocks.iter().flat_map(|block| &block.ids);
    let mut known = Ids::new(all().copied().max().unwrap_or(0), all().count());
    let mut row = 0;
    let mut repeated = Vec::new();
    for (at, (block, lines)) in blocks.iter().zip(lines).enumerate() {
        for (i, &id) in block.ids.iter().enumerate() {
            if known.enter(id, row).is_some() {
                let first = blocks.iter().find_map(|b| Some((b, b.ids.iter().position(|other| *other == id)?)));
                let same = first.is_some_and(|(b, j)| b.name == block.name && b.nodes_of(j) == block.nodes_of(i));
                let problem = if same {
                    Diagnostic::warning(
                        "repeated-entity",
                        format!("{kind} {id} is already defined, with the same nodes"),
                    )
                } else {
                    Diagnostic::error("repeated-entity", format!("{kind} {id} is already defined, with other nodes"))
                        .remedy(format!("give every {kind} an id of its own"))
                };
                problems.push(lines[i], problem);
                repeated.push((at, i));
            }
            row += 1;
        }
    }
    for (at, i) in repeated.into_iter().rev() {
        let block = &mut blocks[at];
        block.ids.remove(i);
        block.nodes.drain(i * block.nodes_per_entity..(i + 1) * block.nodes_per_entity);
        if !block.properties.is_empty() {
            block.properties.remove(i);
        }
    }
    known
}

fn references(kind: &str, block: &MdpaEntities, lines: &[u32], known: &KnownIds, problems: &mut Problems) {
    // Lines were kept for all rows; where a repeated one was dropped, the line of the block is the honest answer.
    let line = |i: usize| if lines.len() == block.ids.len() { lines[i] } else { block.line.0 };
    for (i, nodes) in block.nodes.chunks_exact(block.nodes_per_entity).enumerate() {
        if let Some(&node) = nodes.iter().find(|&&node| !known.nodes.has(node)) {
            undefined(problems, line(i), &format!("{kind} {}", block.ids[i]), "node", node);
        }
        if problems.full() {
            return;
        }
    }
    // Of each missing properties the first row that names them, and how many do.
    let mut missing: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
    for (i, &id) in block.properties.iter().enumerate().filter(|(_, id)| !known.properties.has(**id)) {
        missing.entry(id).or_insert((i, 0)).1 += 1;
    }
    for (id, (first, count)) in missing {
        let more = if count > 1 { format!(", as {} others of its block,", count - 1) } else { String::new() };
        undefined(problems, line(first), &format!("{kind} {}{more}", block.ids[first]), "properties", id);
    }
}

fn constraints(blocks: &[ConstraintBlock], lines: &[Vec<u32>], problems: &mut Problems) -> Ids {
    let all = || blocks.iter().flat_map(|block| &block.rows).map(|row| row.id);
    let mut known = Ids::new(all().max().unwrap_or(0), all().count());
    for (row, (id, &line)) in all().zip(lines.iter().flatten()).enumerate() {
        if known.enter(id, row as u32).is_some() {
            problems.error(line, "repeated-constraint", format!("constraint {id} is already defined"));
        }
    }
    known
}

fn sub_model_part(part: &SubModelPart, path: &str, known: &KnownIds, problems: &mut Problems) {
    for (kind, named, defined) in [
        ("table", &part.tables, &known.tables),
        ("properties", &part.properties, &known.properties),
        ("node", &part.nodes, &known.nodes),
        ("element", &part.elements, &known.elements),
        ("condition", &part.conditions, &known.conditions),
        ("geometry", &part.geometries, &known.geometries),
        ("constraint", &part.constraints, &known.constraints),
    ] {
        let missing: Vec<u32> = named.iter().copied().filter(|&id| !defined.has(id)).collect();
        if !missing.is_empty() {
            let shown: Vec<String> = missing.iter().take(5).map(ToString::to_string).collect();
            let more = if missing.len() > 5 { format!(" and {} more", missing.len() - 5) } else { String::new() };
            let fact = format!("the sub model part {path} names undefined ids ({kind} {}{more})", shown.join(", "));
            problems.push(
                part.line.0,
                Diagnostic::error("undefined-id", fact).remedy("correct the ids, or define what they name"),
            );
        }
    }
    part.parts.iter().for_each(|inner| sub_model_part(inner, &format!("{path}.{}", inner.name), known, problems));
}
