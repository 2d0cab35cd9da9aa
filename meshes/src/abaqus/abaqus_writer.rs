//! Writes nodes, elements, sets and surfaces.

use std::io::{self, Write};
use std::path::Path;

use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::geometry::Shape;
use zelus_core::io::mdpa::MdpaDocument;
use zelus_core::io::replace_own_file;

use super::abaqus_cells;
use crate::document::mesh;
use crate::faces::{corners, faces};
use crate::mesh::{Mesh, Plane};

pub(super) fn write(document: &MdpaDocument, path: &Path) -> Result<Vec<Diagnostic>> {
    let mut mesh = mesh(document)?;
    let is_axial = document.elements.iter().any(|block| block.name.starts_with("Axisym"));
    mesh.plane = is_axial.then_some(Plane::Axial);
    let dimension = mesh.dimension();
    let strange =
        mesh.cells.shapes.iter().find(|shape| shape.dim() == dimension && abaqus_cells::name(**shape, None).is_none());
    if let Some(shape) = strange {
        let fact = format!("the format has no element of shape {shape:?}");
        return Err(Diagnostic::error("no-such-cell", fact).at(Place::file(path)).remedy("write .msh or .vtu").into());
    }
    replace_own_file(path, |out| text(&mesh, dimension, out))?;
    Ok(Vec::new())
}

fn text(mesh: &Mesh, dimension: usize, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "*HEADING\nwritten by zelus\n*NODE, NSET=Nall")?;
    for (id, [x, y, z]) in mesh.node_ids.iter().zip(&mesh.points) {
        writeln!(out, "{id}, {}, {}, {}", number(*x), number(*y), number(*z))?;
    }
    for shape in Shape::ALL.into_iter().filter(|shape| shape.dim() == dimension) {
        let own: Vec<usize> = (0..mesh.cells.len()).filter(|&cell| mesh.cells.shapes[cell] == shape).collect();
        let Some(name) = abaqus_cells::name(shape, mesh.plane).filter(|_| !own.is_empty()) else { continue };
        writeln!(out, "*ELEMENT, TYPE={name}, ELSET=Eall")?;
        for cell in own {
            let nodes = mesh.cells.nodes(cell);
            let nodes = abaqus_cells::order(shape).iter().map(|&at| mesh.node_ids[nodes[at] as usize]);
            list(out, std::iter::once(mesh.cells.ids[cell]).chain(nodes))?;
        }
    }
    let of = faces(mesh);
    for group in &mesh.groups {
        let elements = group.cells.iter().filter(|&&cell| mesh.cells.shapes[cell as usize].dim() == dimension);
        let elements: Vec<u32> = elements.map(|&cell| mesh.cells.ids[cell as usize]).collect();
        let mut nodes = group.nodes.clone();
        nodes.extend(group.cells.iter().flat_map(|&cell| mesh.cells.nodes(cell as usize)));
        nodes.sort_unstable();
        nodes.dedup();
        let ids = nodes.iter().map(|&node| mesh.node_ids[node as usize]);
        if !nodes.is_empty() {
            writeln!(out, "*NSET, NSET={}", group.name)?;
            list(out, ids)?;
        }
        if !elements.is_empty() {
            writeln!(out, "*ELSET, ELSET={}", group.name)?;
            list(out, elements.into_iter())?;
        }
        let sides = group.cells.iter().filter_map(|&cell| {
            let cell = cell as usize;
            let face = of.get(&corners(mesh.cells.shapes[cell], mesh.cells.nodes(cell)))?;
            let shape = mesh.cells.shapes[face.element as usize];
            let number = (1..=abaqus_cells::faces(shape).len())
                .find(|&number| abaqus_cells::face(shape, number) == Some(face.number))?;
            Some((mesh.cells.ids[face.element as usize], number))
        });
        let sides: Vec<_> = sides.collect();
        if !sides.is_empty() {
            writeln!(out, "*SURFACE, NAME={}, TYPE=ELEMENT", group.name)?;
            sides.iter().try_for_each(|(element, number)| writeln!(out, "{element}, S{number}"))?;
        }
    }
    Ok(())
}

/// A number in at most 20 characters: CalculiX reads no longer ones.
fn number(x: f64) -> String {
    let shortest = format!("{x:?}");
    if shortest.len() > 20 { format!("{x:.13e}") } else { shortest }
}

/// Numbers, eight a line.
fn list(out: &mut impl Write, numbers: impl Iterator<Item = u32>) -> io::Result<()> {
    let numbers: Vec<String> = numbers.map(|number| number.to_string()).collect();
    for (at, line) in numbers.chunks(8).enumerate() {
        let goes_on = (at + 1) * 8 < numbers.len();
        writeln!(out, "{}{}", line.join(", "), if goes_on { "," } else { "" })?;
    }
    Ok(())
}
