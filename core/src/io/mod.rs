//! Files in and out: meshes, materials, results.

pub mod mdpa;
mod replace;

pub use replace::replace_file;
