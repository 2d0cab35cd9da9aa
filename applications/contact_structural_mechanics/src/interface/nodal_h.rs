//! The mesh size at a node.

use zelus_core::model::ModelPart;
use zelus_core::vector3::{dot, sub};

use crate::variables::NODAL_H;

/// Writes NODAL_H: the distance to the nearest other node of any element of the node, initial configuration (length);
/// collective.
pub fn find_nodal_h(part: &mut ModelPart) {
    let mut squares = vec![f64::MAX; part.nodes.len()];
    for element in 0..part.elements.len() as u32 {
        let nodes = part.elements.nodes(element);
        for (i, &a) in nodes.iter().enumerate() {
            let (x, mut nearest) = (part.nodes.initial[a as usize], f64::MAX);
            for &b in &nodes[i + 1..] {
                let apart = sub(x, part.nodes.initial[b as usize]);
                let square = dot(apart, apart);
                nearest = nearest.min(square);
                squares[b as usize] = squares[b as usize].min(square);
            }
            squares[a as usize] = squares[a as usize].min(nearest);
        }
    }
    let mut sizes: Vec<f64> = squares.into_iter().map(|s| if s < f64::MAX { s.sqrt() } else { s }).collect();
    if let Some(share) = &part.share {
        share.halo.least(&mut sizes);
    }
    part.nodes.values.values_mut(&NODAL_H, 0).copy_from_slice(&sizes);
}
