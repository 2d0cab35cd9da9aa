//! Files in and out: meshes, materials, results.

mod container;
mod given_materials;
mod import;
mod materials;
pub mod mdpa;
mod mesh_format;
mod outputs;
mod replace;
pub mod results;
#[cfg(test)]
mod tests;
pub(crate) mod variable_names;

pub(crate) use container::SAVED;
pub use container::{SavedFile, write_saved};
pub use import::{import, names_of_parts, read_mesh, shape_of_geometry};
pub use materials::{apply_materials, read_materials, read_materials_of};
pub use mesh_format::{MeshFormatEntry, MeshReader, MeshWriter, format_of, read_mesh_as};
pub use outputs::{Claim, FileUse, Mark, check_files, of_series, remove_series};
pub use replace::{append_to_file, cut_file, length_of, replace_file, replace_own_file};
