//! The input files of Abaqus and CalculiX: parts and instances, sets, surfaces, ties and contact pairs.
//!
//! A part is read anew for each of its instances, whose name stands before those of its sets: `INSTANCE_SET`. Materials, supports,
//! loads and couplings are kept for a starter deck, over the time of the steps. Lines that cannot be read are left out and named;
//! so is every card and parameter that nothing has asked for. Source: CalculiX CrunchiX user's manual, "Input deck format".

mod cards;
mod abaqus_cells;
mod instance;
mod sets;
mod unread;
mod schedule;
mod model;
mod surfaces;
mod hyperelastic;
mod materials;
mod contact;
mod couplings;
mod discrete_elements;
mod analysis;
mod distributed_loads;
mod kept;
mod abaqus_writer;

use std::path::Path;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::io::MeshFormatEntry;
use zelus_core::io::mdpa::MdpaDocument;
use zelus_core::parameters::Settings;
use zelus_core::register;

use super::document::finish;
use super::mesh::Mesh;

/// Reads an input file; warns of contents that no mesh holds.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn read_mesh(path: &Path) -> Result<(Mesh, Vec<Diagnostic>)> {
    model::read(path)
}
fn build(path: &Path, settings: &Settings) -> Result<(MdpaDocument, Vec<Diagnostic>)> {
    let (mesh, mut said) = read_mesh(path)?;
    let (document, mended) = finish(mesh, settings, path)?;
    said.extend(mended);
    Ok((document, said))
}

register! { MeshFormatEntry "abaqus",
    aliases: &["calculix", "inp"],
    about: "input files of Abaqus and CalculiX; sets, surfaces and instances become sub model parts",
    source: "CalculiX CrunchiX user's manual",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/mesh_formats/abaqus.json")),
    build: build,
    endings: &["inp"],
    write: Some(abaqus_writer::write),
}
