//! From the document to the text of an mdpa file.

use super::mdpa_document::*;
use crate::diagnostics::Result;
use crate::io::replace_own_file;
use std::io::{self, Write};
use std::path::Path;

/// Writes a document so that reading it gives the same one.
///
/// Numbers are the shortest decimals that read back to the same double.
///
/// # Errors
/// [`crate::diagnostics::Error::System`] when the disk refuses.
pub fn write(document: &MdpaDocument, path: &Path) -> Result<()> {
    replace_own_file(path, |out| write_to(document, out))
}

/// Writes the text of a document.
///
/// # Errors
/// Errors of the writer.
pub fn write_to(document: &MdpaDocument, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "Begin ModelPartData")?;
    entries(&document.model_part_data, "", out)?;
    writeln!(out, "End ModelPartData\n")?;
    for item in &document.tables {
        table(item, "", out)?;
    }
    for block in &document.properties {
        writeln!(out, "Begin Properties {}", block.id)?;
        entries(&block.values, "", out)?;
        for item in &block.tables {
            table(item, "    ", out)?;
        }
        writeln!(out, "End Properties\n")?;
    }
    writeln!(out, "Begin Nodes")?;
    for (id, [x, y, z]) in document.nodes.ids.iter().zip(&document.nodes.coordinates) {
        writeln!(out, "    {id} {x:?} {y:?} {z:?}")?;
    }
    writeln!(out, "End Nodes\n")?;
    for (kind, blocks) in
        [("Elements", &document.elements), ("Conditions", &document.conditions), ("Geometries", &document.geometries)]
    {
        for block in blocks {
            entities(kind, block, out)?;
        }
    }
    for block in &document.constraints {
        writeln!(out, "Begin Constraints {} {}", block.name, block.variables.join(" "))?;
        for row in &block.rows {
            let masters: Vec<String> = row.masters.iter().map(ToString::to_string).collect();
            let (id, constant, slave) = (row.id, row.constant, row.slave);
            writeln!(out, "    {id} {constant:?} [{}] {slave} {}", numbers(&row.weights), masters.join(" "))?;
        }
        writeln!(out, "End Constraints\n")?;
    }
    for (kind, blocks) in [
        ("NodalData", &document.nodal_data),
        ("ElementalData", &document.elemental_data),
        ("ConditionalData", &document.conditional_data),
    ] {
        for block in blocks {
            data(kind, block, out)?;
        }
    }
    document.sub_model_parts.iter().try_for_each(|part| sub_model_part(part, 0, out))
}

fn numbers(values: &[f64]) -> String {
    values.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(",")
}

fn matrix(columns: usize, values: &[f64]) -> String {
    let rows: Vec<String> = values.chunks(columns.max(1)).map(|row| format!("({})", numbers(row))).collect();
    format!("({})", rows.join(","))
}

fn entries(entries: &[DataEntry], indent: &str, out: &mut impl Write) -> io::Result<()> {
    for DataEntry { name, value, .. } in entries {
        write!(out, "{indent}    {name} ")?;
        match value {
            DataValue::Number(value) => writeln!(out, "{value:?}")?,
            DataValue::Vector(values) => writeln!(out, "[{}] ({})", values.len(), numbers(values))?,
            DataValue::Matrix { rows, columns, values } => {
                writeln!(out, "[{rows},{columns}] {}", matrix(*columns, values))?;
            }
            DataValue::Text(text) => writeln!(out, "{text}")?,
        }
    }
    Ok(())
}

fn table(table: &MdpaTable, indent: &str, out: &mut impl Write) -> io::Result<()> {
    let id = table.id.map(|id| format!("{id} ")).unwrap_or_default();
    writeln!(out, "{indent}Begin Table {id}{} {}", table.input_variable, table.output_variable)?;
    for [x, y] in &table.rows {
        writeln!(out, "{indent}    {x:?} {y:?}")?;
    }
    writeln!(out, "{indent}End Table{}", if indent.is_empty() { "\n" } else { "" })
}

fn entities(kind: &str, block: &MdpaEntities, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "Begin {kind} {}", block.name)?;
    for (i, id) in block.ids.iter().enumerate() {
        write!(out, "    {id}")?;
        if let Some(properties) = block.properties.get(i) {
            write!(out, " {properties}")?;
        }
        for node in block.nodes_of(i) {
            write!(out, " {node}")?;
        }
        writeln!(out)?;
    }
    writeln!(out, "End {kind}\n")
}

fn data(kind: &str, block: &DataBlock, out: &mut impl Write) -> io::Result<()> {
    let fixity = if kind == "NodalData" { " 0" } else { "" };
    writeln!(out, "Begin {kind} {}", block.variable)?;
    for (i, id) in block.ids.iter().enumerate() {
        match &block.values {
            DataColumn::Flag => writeln!(out, "    {id}")?,
            DataColumn::Scalar { values, fixed } => match fixed.get(i) {
                Some(&fixed) => writeln!(out, "    {id} {} {:?}", u8::from(fixed), values[i])?,
                None => writeln!(out, "    {id}{fixity} {:?}", values[i])?,
            },
            DataColumn::Vector { size, values } => {
                writeln!(out, "    {id}{fixity} [{size}] ({})", numbers(&values[i * size..(i + 1) * size]))?;
            }
            DataColumn::Matrix { rows, columns, values } => {
                let size = rows * columns;
                let text = matrix(*columns, &values[i * size..(i + 1) * size]);
                writeln!(out, "    {id}{fixity} [{rows},{columns}] {text}")?;
            }
        }
    }
    writeln!(out, "End {kind}\n")
}

fn sub_model_part(part: &SubModelPart, depth: usize, out: &mut impl Write) -> io::Result<()> {
    let indent = "    ".repeat(depth);
    writeln!(out, "{indent}Begin SubModelPart {}", part.name)?;
    if !part.data.is_empty() {
        writeln!(out, "{indent}    Begin SubModelPartData")?;
        entries(&part.data, &format!("{indent}    "), out)?;
        writeln!(out, "{indent}    End SubModelPartData")?;
    }
    for (kind, ids) in [
        ("Tables", &part.tables),
        ("Properties", &part.properties),
        ("Nodes", &part.nodes),
        ("Elements", &part.elements),
        ("Conditions", &part.conditions),
        ("Geometries", &part.geometries),
        ("Constraints", &part.constraints),
    ] {
        if !ids.is_empty() {
            writeln!(out, "{indent}    Begin SubModelPart{kind}")?;
            for id in ids {
                writeln!(out, "{indent}        {id}")?;
            }
            writeln!(out, "{indent}    End SubModelPart{kind}")?;
        }
    }
    for inner in &part.parts {
        sub_model_part(inner, depth + 1, out)?;
    }
    writeln!(out, "{indent}End SubModelPart{}", if depth == 0 { "\n" } else { "" })
}
