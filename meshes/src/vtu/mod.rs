//! The XML format of VTK for unstructured grids.
//!
//! Groups are arrays of whole numbers: one that holds 0 and 1 only is the group of its name, at points or cells; any other at cells
//! is a group `NAME_VALUE` for each of its values. Source: VTK user's guide, "XML File Formats".

mod arrays;
mod xml;

use std::path::Path;

use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::geometry::Shape;
use zelus_core::io::MeshFormatEntry;
use zelus_core::io::mdpa::MdpaDocument;
use zelus_core::io::results::{Column, Dataset, write_piece};
use zelus_core::parameters::Settings;
use zelus_core::register;

use super::document::{finish, mesh};
use super::mesh::{Mesh, word};
use super::source::read;
use arrays::Array;

/// Arrays of more values than this number nothing that a deck would name.
const MOST_GROUPS: usize = 1000;
/// Arrays that hold ids.
const NODE_IDS: [&str; 2] = ["KRATOS_NODE_ID", "NODE_ID"];
const CELL_IDS: [&str; 3] = ["KRATOS_ELEMENT_ID", "KRATOS_CONDITION_ID", "CELL_ID"];

/// Reads a file with all its pieces.
///
/// # Errors
/// A file that is damaged, or with cells that no element has.
pub(crate) fn read_mesh(path: &Path) -> Result<Mesh> {
    let bytes = read(path)?;
    let wrong = |fact: String| Diagnostic::error("mesh-syntax", fact).at(Place::file(path));
    let mut out = Mesh::default();
    let file = xml::File::new(&bytes).map_err(wrong)?;
    for piece in &file.pieces {
        add(&file, piece, &mut out).map_err(wrong)?;
    }
    unique(&mut out.node_ids);
    unique(&mut out.cells.ids);
    Ok(out)
}

/// Numbers from 1 where ids repeat or are none.
fn unique(ids: &mut [u32]) {
    let mut sorted = ids.to_vec();
    sorted.sort_unstable();
    if sorted.first() == Some(&0) || sorted.windows(2).any(|two| two[0] == two[1]) {
        ids.iter_mut().zip(1..).for_each(|(id, new)| *id = new);
    }
}

fn add(file: &xml::File<'_>, piece: &xml::Piece<'_>, mesh: &mut Mesh) -> std::result::Result<(), String> {
    let array = |list: &[xml::Tag<'_>], name: &str| {
        let tag = list.iter().find(|tag| tag.get("Name") == Some(name) || (name == "Points" && list.len() == 1));
        tag.map(|tag| Array::read(file, tag)).ok_or_else(|| format!("there is no array {name}"))?
    };
    let first = mesh.points.len() as u32;
    let points = array(&piece.points, "Points")?.real();
    mesh.points.extend(points.as_chunks::<3>().0);
    let count = mesh.points.len() - first as usize;
    let connectivity = array(&piece.cells, "connectivity")?.whole()?;
    let ends = array(&piece.cells, "offsets")?.whole()?;
    let types = array(&piece.cells, "types")?.whole()?;
    let columns = |tags: &[xml::Tag<'_>]| -> std::result::Result<Vec<(String, Vec<i64>)>, String> {
        let single = tags.iter().filter(|tag| {
            tag.get("type").is_some_and(|kind| !kind.starts_with("Float"))
                && tag.get("NumberOfComponents").is_none_or(|number| number == "1" || number == "0")
        });
        let name = |tag: &xml::Tag<'_>| xml::unescape(tag.get("Name").unwrap_or_default());
        single.map(|tag| Ok((name(tag), Array::read(file, tag)?.whole()?))).collect()
    };
    let (at_points, at_cells) = (columns(&piece.point_data)?, columns(&piece.cell_data)?);
    let id = |columns: &[(String, Vec<i64>)], names: &[&str], at: usize| {
        let column = columns.iter().find(|(name, _)| names.contains(&name.as_str()));
        column.and_then(|(_, values)| values.get(at)).and_then(|&id| u32::try_from(id).ok()).unwrap_or(0)
    };
    mesh.node_ids.extend((0..count).map(|at| id(&at_points, &NODE_IDS, at)));
    let before = mesh.cells.len() as u32;
    let mut start = 0;
    for (at, (kind, end)) in types.iter().zip(&ends).enumerate() {
        let shape = Shape::ALL.into_iter().find(|shape| i64::from(shape.cell().vtk_type) == *kind);
        let shape = shape.ok_or_else(|| format!("cells of VTK's type {kind} are not known"))?;
        let end = usize::try_from(*end).unwrap_or(0);
        let own = connectivity.get(start..end).filter(|own| own.len() == shape.nodes());
        let own = own.ok_or_else(|| format!("cell {at} has a wrong number of points"))?;
        start = end;
        let mut nodes = vec![0; own.len()];
        for (&place, &point) in shape.cell().vtk_order.iter().zip(own) {
            let point = u32::try_from(point).ok().filter(|&point| (point as usize) < count);
            nodes[place] = first + point.ok_or_else(|| format!("cell {at} has a point that is not there"))?;
        }
        mesh.cells.push(id(&at_cells, &CELL_IDS, at), shape, nodes);
    }
    let cells = mesh.cells.len() - before as usize;
    for (name, values) in at_points.iter().filter(|(name, _)| !NODE_IDS.contains(&name.as_str())) {
        if values.len() == count && values.iter().all(|value| matches!(value, 0 | 1)) {
            let own = (0..count).filter(|&at| values[at] == 1).map(|at| first + at as u32);
            mesh.group_mut(&word(name)).nodes.extend(own);
        }
    }
    for (name, values) in at_cells.iter().filter(|(name, _)| !CELL_IDS.contains(&name.as_str())) {
        let kinds: std::collections::BTreeSet<i64> = values.iter().copied().collect();
        if values.len() != cells || kinds.len() > MOST_GROUPS {
            continue;
        }
        let is_flag = kinds.iter().all(|value| matches!(value, 0 | 1));
        for kind in kinds.into_iter().filter(|kind| !is_flag || *kind == 1) {
            let group = if is_flag { word(name) } else { format!("{}_{kind}", word(name)) };
            let own = (0..cells).filter(|&at| values[at] == kind).map(|at| before + at as u32);
            mesh.group_mut(&group).cells.extend(own);
        }
    }
    Ok(())
}

fn build(path: &Path, settings: &Settings) -> Result<(MdpaDocument, Vec<Diagnostic>)> {
    finish(read_mesh(path)?, settings, path)
}

fn write(document: &MdpaDocument, path: &Path) -> Result<Vec<Diagnostic>> {
    let mesh = mesh(document)?;
    let mut out = Dataset { points: mesh.points.clone(), ..Dataset::default() };
    for cell in 0..mesh.cells.len() {
        out.cells.push(
            mesh.cells.ids[cell] as usize,
            0,
            mesh.cells.shapes[cell],
            mesh.cells.nodes(cell).iter().copied(),
        );
    }
    let whole = |ids: &[u32]| ids.iter().map(|&id| id as usize).collect::<Vec<_>>();
    out.point_data.push(Column::ids("NODE_ID", &whole(&mesh.node_ids)));
    out.cell_data.push(Column::ids("CELL_ID", &whole(&mesh.cells.ids)));
    let flag = |name: &str, count: usize, members: &[u32]| {
        let mut values = vec![0; count];
        members.iter().for_each(|&at| values[at as usize] = 1);
        Column::ids(name, &values)
    };
    for group in &mesh.groups {
        if !group.cells.is_empty() {
            out.cell_data.push(flag(&group.name, mesh.cells.len(), &group.cells));
        }
        out.point_data.push(flag(&group.name, mesh.points.len(), &group.nodes));
    }
    write_piece(path, &out)?;
    Ok(Vec::new())
}

register! { MeshFormatEntry "vtu",
    about: "unstructured grids of VTK, as ParaView and meshio write them; arrays of whole numbers become sub model parts",
    source: "VTK user's guide, XML File Formats",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/mesh_formats/vtu.json")),
    build: build,
    endings: &["vtu"],
    write: Some(write),
}
