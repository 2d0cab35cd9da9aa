//! Result files from plain arrays: legacy VTK, VTU with its PVD series, PVTU, GiD; VTU is also read.
//!
//! A [`Dataset`] is the contents of a picture: points, cells, named columns. The writers know nothing of models.

mod dataset;
mod gid;
mod number;
mod gathered_dataset;
mod pvtu;
mod vtu_reader;
#[cfg(test)]
mod tests;
mod vtk;
mod vtu;

pub use dataset::{Cells, Column, Dataset, Values};
pub use gid::{GaussResult, GidKind, write_gid_mesh, write_gid_results_head, write_gid_step};
pub use pvtu::write_pvtu;
pub use vtk::{VtkFormat, write_vtk};
pub use vtu::{PvdFile, escape, write_piece, write_pvd, write_vtu};
pub use vtu_reader::{read_pvd, read_vtu, vtu_of};
