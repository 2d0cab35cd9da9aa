//! Meshes of other programs, read into sub model parts, elements and conditions and written back.
//!
//! A format reads its file into a [`mesh::Mesh`], which knows nothing of formats; [`repair`] removes cells that no deck can use and
//! reorients those that are inside out; [`document`] names elements and conditions. Each format registers itself under the name that
//! decks give as `"input_type"`; a plugin adds one in the same way, with this crate or without.

pub mod history;
pub mod conditions;
pub mod mesh;
pub mod repair;
pub mod faces;
mod constraints;
mod discrete;
pub mod document;
pub mod proximity;
mod source;
mod abaqus;
mod gmsh;
mod med;
mod vtu;
mod series;
mod vtkhdf;
mod xdmf;
mod stl;
mod one_file;

use std::path::Path;

use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::io::{MeshFormatEntry, format_of};
use zelus_core::parameters::{Node, Object, Value};
use zelus_core::registry;

pub use mesh::Mesh;
pub use stl::write_stl;
pub use vtkhdf::write_vtkhdf;
pub use xdmf::write_xdmf;

/// Writes the results of a series of steps as another format; how many steps there were.
pub type WriteResults = fn(&Path, &Path) -> Result<usize>;

/// Formats that take the results of all steps, by the ending of their files.
pub const RESULTS: [(&str, WriteResults); 2] = [("vtkhdf", write_vtkhdf), ("xdmf", write_xdmf)];

/// The format of a file: the one named, or that of its ending.
///
/// # Errors
/// No such format, or an ending of none.
pub fn format(path: &Path, name: Option<&str>) -> Result<&'static MeshFormatEntry> {
    match name {
        Some(name) => Ok(registry::require::<MeshFormatEntry>(name)?),
        None => format_of(path).ok_or_else(|| {
            let all = registry::all::<MeshFormatEntry>().into_iter();
            let endings: Vec<String> =
                all.flat_map(|format| format.endings.iter().map(|ending| format!(".{ending}"))).collect();
            let fact = format!("{} has the ending of no mesh format", path.display());
            let remedy = format!("endings are {}; --format names one for another ending", endings.join(", "));
            Diagnostic::error("mesh-format", fact).remedy(remedy).into()
        }),
    }
}

/// The mesh of a file, with all further contents of its format, mended; and the notes.
///
/// # Errors
/// Errors of the format.
pub fn read(path: &Path, format: &MeshFormatEntry) -> Result<(Mesh, Vec<Diagnostic>)> {
    let (mut mesh, mut said) = match format.name {
        "abaqus" => abaqus::read_mesh(path)?,
        "gmsh" => (gmsh::read_mesh(path)?, Vec::new()),
        "med" => (med::read_mesh(path)?, Vec::new()),
        "vtu" => (vtu::read_mesh(path)?, Vec::new()),
        _ => {
            let nothing = Node::new(Value::Object(Object::default()), &Place::file(path));
            let (document, said) = (format.build)(path, &format.settings(&nothing)?)?;
            (document::mesh(&document)?, said)
        }
    };
    said.extend(repair::repair(&mut mesh, &Place::file(path))?);
    Ok((mesh, said))
}
