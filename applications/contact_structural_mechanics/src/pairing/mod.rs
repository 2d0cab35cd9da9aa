//! Pairs of all interfaces: found by the search, kept in blocks, integrated to gaps, slips and areas of slave nodes.

mod edge_nodes;
mod edges;
mod integration;
mod pairs_of_interfaces;

pub(crate) use edges::{FLAT, NO_COMMON_NORMAL, SHARP, take_normals_of_masters};
pub(crate) use integration::integrate;
pub(crate) use pairs_of_interfaces::{Pairing, PairingState, integrals, searching, without_tangent};
