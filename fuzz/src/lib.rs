//! Fuzz targets, and the inputs forged from random bytes.

pub mod forge;
pub mod targets;
