//! Files in and out: meshes, materials, results.

mod container;
mod import;
mod materials;
pub mod mdpa;
mod outputs;
mod replace;
pub mod results;
#[cfg(test)]
mod tests;
pub(crate) mod variables;

pub use container::{SavedFile, write_saved};
pub use import::{import, mesh_file, read_mesh, read_mesh_of};
pub use materials::{apply_materials, read_materials, read_materials_of};
pub use outputs::{Claim, FileUse, check_files, of_series};
pub use replace::{append_to_file, cut_file, length_of, replace_file, replace_own_file};
