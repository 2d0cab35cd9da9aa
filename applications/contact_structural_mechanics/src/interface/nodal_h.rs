//! The mesh size at a node.

use zelus_core::model::ModelPart;
use zelus_core::vector3::{norm, sub};

use crate::variables::NODAL_H;

/// Writes NODAL_H: the distance to the nearest other node of any element of the node, initial configuration (length);
/// collective.
pub fn find_nodal_h(part: &mut ModelPart) {
    let mut sizes = vec![f64::MAX; part.nodes.len()];
    for element in 0..part.elements.len() as u32 {
        let nodes = part.elements.nodes(element);
        for (i, &a) in nodes.iter().enumerate() {
            for &b in &nodes[i + 1..] {
                let length = norm(sub(part.nodes.initial[a as usize], part.nodes.initial[b as usize]));
                sizes[a as usize] = sizes[a as usize].min(length);
                sizes[b as usize] = sizes[b as usize].min(length);
            }
        }
    }
    if let Some(share) = &part.share {
        share.halo.least(&mut sizes);
    }
    part.nodes.values.values_mut(&NODAL_H, 0).copy_from_slice(&sizes);
}
