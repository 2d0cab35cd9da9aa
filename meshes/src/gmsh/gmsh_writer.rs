//! Writes version 4.1 as text: an entity for each set of groups that cells share.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::geometry::Shape;
use zelus_core::io::mdpa::MdpaDocument;
use zelus_core::io::replace_own_file;

use super::gmsh_cells::number;
use crate::document::mesh;
use crate::mesh::Mesh;

/// Cells of one dimension and shape in the same groups.
type Entity = (usize, Vec<usize>);

pub(super) fn write(document: &MdpaDocument, path: &Path) -> Result<Vec<Diagnostic>> {
    let mut mesh = mesh(document)?;
    add_points(&mut mesh);
    replace_own_file(path, |out| text(&mesh, out))?;
    Ok(Vec::new())
}

/// Gives nodes that a group lists beside its cells a cell each: Gmsh's groups hold no nodes.
fn add_points(mesh: &mut Mesh) {
    let mut next = mesh.cells.max_id() + 1;
    let mut point_of: BTreeMap<u32, u32> = BTreeMap::new();
    for at in 0..mesh.groups.len() {
        let group = &mesh.groups[at];
        let mut held: Vec<u32> =
            group.cells.iter().flat_map(|&cell| mesh.cells.nodes(cell as usize)).copied().collect();
        held.sort_unstable();
        let lone: Vec<u32> = group.nodes.iter().copied().filter(|node| held.binary_search(node).is_err()).collect();
        for node in lone {
            let cell = *point_of.entry(node).or_insert_with(|| {
                next += 1;
                mesh.cells.push(next - 1, Shape::Point1, [node])
            });
            mesh.groups[at].cells.push(cell);
        }
    }
}

fn text(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let mut of_cell: Vec<Vec<usize>> = vec![Vec::new(); mesh.cells.len()];
    for (at, group) in mesh.groups.iter().enumerate() {
        group.cells.iter().for_each(|&cell| of_cell[cell as usize].push(at));
    }
    let mut entities: BTreeMap<Entity, BTreeMap<Shape, Vec<usize>>> = BTreeMap::new();
    for (cell, groups) in of_cell.into_iter().enumerate() {
        let shape = mesh.cells.shapes[cell];
        entities.entry((shape.dim(), groups)).or_default().entry(shape).or_default().push(cell);
    }
    let names: std::collections::BTreeSet<(usize, usize)> =
        entities.keys().flat_map(|(dimension, groups)| groups.iter().map(|&group| (*dimension, group))).collect();
    writeln!(out, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n{}", names.len())?;
    for (dimension, group) in names {
        writeln!(out, "{dimension} {} \"{}\"", group + 1, mesh.groups[group].name)?;
    }
    let count = |dimension| entities.keys().filter(|(own, _)| *own == dimension).count();
    writeln!(out, "$EndPhysicalNames\n$Entities\n{} {} {} {}", count(0), count(1), count(2), count(3))?;
    for (tag, (dimension, groups)) in entities.keys().enumerate() {
        let place = if *dimension == 0 { "0 0 0" } else { "0 0 0 0 0 0" };
        let groups: String = groups.iter().map(|group| format!(" {}", group + 1)).collect();
        let around = if *dimension == 0 { "" } else { " 0" };
        writeln!(out, "{} {place} {}{groups}{around}", tag + 1, groups.split_whitespace().count())?;
    }
    let (least, most) = (mesh.node_ids.iter().min().unwrap_or(&0), mesh.node_ids.iter().max().unwrap_or(&0));
    let nodes = mesh.points.len();
    // all nodes stand in the last entity, which has the most dimensions
    let (last, dimension) = (entities.len(), entities.keys().next_back().map_or(0, |(dimension, _)| *dimension));
    writeln!(out, "$EndEntities\n$Nodes\n1 {nodes} {least} {most}\n{dimension} {last} 0 {nodes}")?;
    mesh.node_ids.iter().try_for_each(|id| writeln!(out, "{id}"))?;
    mesh.points.iter().try_for_each(|[x, y, z]| writeln!(out, "{x:?} {y:?} {z:?}"))?;
    let blocks: usize = entities.values().map(BTreeMap::len).sum();
    let least = mesh.cells.ids.iter().min().unwrap_or(&0);
    writeln!(out, "$EndNodes\n$Elements\n{blocks} {} {least} {}", mesh.cells.len(), mesh.cells.max_id())?;
    for (tag, ((dimension, _), shapes)) in entities.iter().enumerate() {
        for (&shape, cells) in shapes {
            let (kind, order) = number(shape);
            writeln!(out, "{dimension} {} {kind} {}", tag + 1, cells.len())?;
            for &cell in cells {
                write!(out, "{}", mesh.cells.ids[cell])?;
                let nodes = mesh.cells.nodes(cell);
                order.iter().try_for_each(|&at| write!(out, " {}", mesh.node_ids[nodes[at] as usize]))?;
                writeln!(out)?;
            }
        }
    }
    writeln!(out, "$EndElements")
}
