//! Normals of contact surfaces.
//!
//! The normal of a node is the sum of the unit normals of its facets, taken at the node, normalised; facets are not
//! weighted by their area. Everything in the present configuration, outward.

use zelus_core::geometry::Shape;
use zelus_core::geometry::mapping::unit_normal;
use zelus_core::model::{ModelPart, variables::NORMAL};
use zelus_core::vector3::norm;

use super::facets::{Facet, Interface, Roles};
use crate::variables::NORMAL_LENGTH;

/// Unit normal at the centre of a facet; `None` when it has no area.
pub fn centre_normal(shape: Shape, points: &[[f64; 3]]) -> Option<[f64; 3]> {
    unit_normal(shape, points, shape.cell().centre)
}

/// Present positions of a facet's nodes.
pub fn positions<'a>(facet: &Facet, part: &ModelPart, buffer: &'a mut [[f64; 3]; 4]) -> &'a [[f64; 3]] {
    for (slot, &node) in buffer.iter_mut().zip(&facet.nodes) {
        *slot = part.nodes.current[node as usize];
    }
    &buffer[..facet.nodes.len()]
}

/// Writes NORMAL at the nodes of the interfaces.
///
/// Where each search decides the sides, facets that meet nothing do not turn the normals of those that do: the edge of a
/// block found by its skin would otherwise be pressed askew.
pub fn nodal_normals(part: &mut ModelPart, interfaces: &[Interface]) {
    let mut sums = vec![[0.0; 3]; part.nodes.len()];
    let mut buffer = [[0.0; 3]; 4];
    let mut met = vec![false; part.nodes.len()];
    let meeting = interfaces.iter().filter(|i| i.open).flat_map(|i| &i.facets).filter(|f| f.role != Roles::Open);
    meeting.flat_map(|f| &f.nodes).for_each(|&node| met[node as usize] = true);
    for facet in interfaces.iter().flat_map(|i| &i.facets) {
        let points = positions(facet, part, &mut buffer);
        for (local, &node) in facet.nodes.iter().enumerate() {
            if facet.role == Roles::Open && met[node as usize] {
                continue;
            }
            if let Some(normal) = unit_normal(facet.shape, points, facet.shape.cell().points[local]) {
                (0..3).for_each(|c| sums[node as usize][c] += normal[c]);
            }
        }
    }
    let lengths: Vec<f64> = sums.iter().map(|sum| norm(*sum)).collect();
    part.nodes.values.values_mut(&NORMAL_LENGTH, 0).copy_from_slice(&lengths);
    let column = part.nodes.history.values_mut(&NORMAL, 0);
    for &node in interfaces.iter().flat_map(|i| &i.nodes) {
        let (sum, size) = (sums[node as usize], lengths[node as usize]);
        if size > 0.0 {
            (0..3).for_each(|c| column[3 * node as usize + c] = sum[c] / size);
        }
    }
}
