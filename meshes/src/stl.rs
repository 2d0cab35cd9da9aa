//! Writes the surface of the bodies of a mesh as an STL file, e.g. for a rigid shape.
//!
//! Bytes: 80 of a header, a count (u32), then for each triangle its normal, three vertices (f32, little endian) and two bytes. Faces of
//! second order are cut along lines between their nodes, and quadrilaterals by a diagonal. Triangles go round so that they point out of
//! the body.

use std::io::Write;
use std::path::Path;

use zelus_core::diagnostics::{Diagnostic, Place, Result, did_you_mean};
use zelus_core::geometry::{Shape, sub_facets};
use zelus_core::io::mdpa::MdpaDocument;
use zelus_core::io::replace_own_file;
use zelus_core::vector3::{cross, normalised, sub};

use super::document::mesh;
use super::faces::{face_nodes, faces};
use super::mesh::Mesh;

/// Bytes of the header.
const HEADER: usize = 80;

/// Writes the outer faces of the solids of a mesh, or of a part of it with nested names joined by an underscore; of a part of faces alone
/// those faces. How many triangles there are.
///
/// # Errors
/// No such part; neither solids nor faces in space; a file that cannot be written.
pub fn write_stl(document: &MdpaDocument, part: Option<&str>, to: &Path) -> Result<usize> {
    let all = mesh(document)?;
    let cells = match part {
        None => (0..all.cells.len() as u32).collect(),
        Some(name) => {
            let own = all.group(name).map(|group| group.cells.clone());
            own.ok_or_else(|| {
                let problem = Diagnostic::error("unknown-model-part", format!("the mesh has no part {name}"));
                let known = did_you_mean(name, all.groups.iter().map(|group| group.name.as_str()));
                problem.at(Place::file(&document.file)).remedy(known.unwrap_or_else(|| "leave --part out".to_owned()))
            })?
        }
    };
    let surface = surface(&all, &cells);
    let triangles: Vec<[u32; 3]> = surface.iter().flat_map(|(shape, nodes)| triangles(*shape, nodes)).collect();
    if triangles.is_empty() {
        let fact = "an STL file holds surfaces in space, and there are neither solids nor faces".to_owned();
        let problem = Diagnostic::error("stl-file", fact).at(Place::file(&document.file));
        return Err(problem.remedy("name a part of a mesh in space").into());
    }
    replace_own_file(to, |out| {
        out.write_all(&[b' '; HEADER])?;
        out.write_all(&(triangles.len() as u32).to_le_bytes())?;
        for corners in &triangles {
            let [a, b, c] = corners.map(|node| all.points[node as usize]);
            let normal = normalised(cross(sub(b, a), sub(c, a)));
            for number in [normal, a, b, c].as_flattened() {
                out.write_all(&(*number as f32).to_le_bytes())?;
            }
            out.write_all(&[0; 2])?;
        }
        Ok(())
    })?;
    Ok(triangles.len())
}

/// The outer faces of the solids among some cells, with their nodes; where there are none, the faces among them.
fn surface(mesh: &Mesh, cells: &[u32]) -> Vec<(Shape, Vec<u32>)> {
    let chosen = |dimension: usize| {
        let mut own = Mesh { points: mesh.points.clone(), ..Mesh::default() };
        for &cell in cells.iter().filter(|&&cell| mesh.cells.shapes[cell as usize].dim() == dimension) {
            let at = cell as usize;
            own.cells.push(mesh.cells.ids[at], mesh.cells.shapes[at], mesh.cells.nodes(at).iter().copied());
        }
        own
    };
    let solids = chosen(3);
    if solids.cells.is_empty() {
        // Cells of a planar mesh are no surface in space.
        let faces = if mesh.dimension() == 3 { chosen(2) } else { Mesh::default() };
        return (0..faces.cells.len()).map(|at| (faces.cells.shapes[at], faces.cells.nodes(at).to_vec())).collect();
    }
    let mut outer: Vec<(u32, usize)> =
        faces(&solids).values().filter(|face| !face.is_inner).map(|face| (face.element, face.number)).collect();
    outer.sort_unstable();
    outer.into_iter().map(|(element, number)| face_nodes(&solids, element as usize, number)).collect()
}

/// Triangles that cover a face, with its orientation.
fn triangles(shape: Shape, nodes: &[u32]) -> Vec<[u32; 3]> {
    let fan = |own: &&[usize]| -> Vec<[u32; 3]> {
        (2..own.len()).map(|at| [own[0], own[at - 1], own[at]].map(|local| nodes[local])).collect()
    };
    sub_facets(shape).iter().flat_map(fan).collect()
}
