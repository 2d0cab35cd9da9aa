//! Points that lie inside bodies.

use zelus_core::geometry::mapping::local_coordinates;
use zelus_core::model::ModelPart;
use zelus_core::parallel;

use super::tree::{Bounds, Tree};

/// Share of a cell by which a point must be inside.
const INSIDE: f64 = 1e-6;
/// Elements and points that a thread takes at a time.
const ELEMENTS: usize = 1 << 10;
const POINTS: usize = 16;

/// Marks of the points inside an element of this rank that their node is not part of.
///
/// A point is given with its node, its place and the mesh size there.
pub fn inside(part: &ModelPart, points: &[(u32, [f64; 3], f64)]) -> Vec<bool> {
    if points.is_empty() {
        return Vec::new();
    }
    let corners = |at: u32| -> Vec<[f64; 3]> {
        part.elements.nodes(at).iter().map(|&node| part.nodes.current[node as usize]).collect()
    };
    let around = Bounds::of(&points.iter().map(|point| point.1).collect::<Vec<_>>());
    let is_near = |at: usize| {
        let at = at as u32;
        part.elements.kinds[at as usize].cell.is_some_and(|shape| shape.dim() == part.info.domain_size)
            && Bounds::of(&corners(at)).meets(&around)
    };
    let cells = parallel::select(part.elements.len(), ELEMENTS, is_near);
    let tree = Tree::new(cells.iter().map(|&at| Bounds::of(&corners(at))).collect());
    let is_inside = |at: usize| {
        let (node, x, size) = points[at];
        tree.meeting(&Bounds::of(&[x])).into_iter().map(|near| cells[near as usize]).any(|at| {
            let Some(shape) = part.elements.kinds[at as usize].cell else { return false };
            !part.elements.nodes(at).contains(&node)
                && local_coordinates(shape, &corners(at), x)
                    .is_some_and(|found| shape.cell().contains(found.xi, INSIDE) && found.distance < INSIDE * size)
        })
    };
    parallel::map(points.len(), POINTS, is_inside)
}
