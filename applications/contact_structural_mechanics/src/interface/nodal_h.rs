//! The mesh size at a node.

use std::sync::atomic::{AtomicU64, Ordering};

use zelus_core::model::ModelPart;
use zelus_core::parallel;
use zelus_core::vector3::{dot, sub};

use crate::variables::NODAL_H;

/// Elements that a thread takes at a time.
const CHUNK: usize = 1 << 12;

/// Writes NODAL_H: the distance to the nearest other node of any element of the node, of a node of conditions alone to that of any of
/// them, initial configuration (length); collective.
pub fn find_nodal_h(part: &mut ModelPart) {
    // Numbers that are not negative are in the order of their bits.
    let squares: Vec<AtomicU64> = (0..part.nodes.len()).map(|_| AtomicU64::new(f64::MAX.to_bits())).collect();
    let lower = |node: u32, square: f64| {
        let (least, square) = (&squares[node as usize], square.to_bits());
        if square < least.load(Ordering::Relaxed) {
            least.fetch_min(square, Ordering::Relaxed);
        }
    };
    let initial = &part.nodes.initial;
    let of_cell = |nodes: &[u32]| {
        for (i, &a) in nodes.iter().enumerate() {
            let (x, mut nearest) = (initial[a as usize], f64::MAX);
            for &b in &nodes[i + 1..] {
                let apart = sub(x, initial[b as usize]);
                let square = dot(apart, apart);
                nearest = nearest.min(square);
                lower(b, square);
            }
            lower(a, nearest);
        }
    };
    let elements = &part.elements;
    parallel::ranges(elements.len(), CHUNK, &|range| range.for_each(|at| of_cell(elements.nodes(at as u32))));
    let alone: Vec<bool> =
        squares.iter().map(|bits| f64::from_bits(bits.load(Ordering::Relaxed)) == f64::MAX).collect();
    let conditions = (0..part.conditions.len()).map(|at| part.conditions.nodes(at as u32));
    conditions.filter(|nodes| nodes.iter().all(|&node| alone[node as usize])).for_each(of_cell);
    let squares = squares.into_iter().map(|bits| f64::from_bits(bits.into_inner()));
    let mut sizes: Vec<f64> = squares.map(|s| if s < f64::MAX { s.sqrt() } else { s }).collect();
    if let Some(share) = &part.share {
        share.halo.least(&mut sizes);
    }
    part.nodes.values.values_mut(&NODAL_H, 0).copy_from_slice(&sizes);
}
