//! The direct check of a pair: which slave nodes touch the master facet itself.

use zelus_core::geometry::mapping::{local_coordinates, position, unit_normal};
use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, scale, sub};
use zelus_structural_mechanics::variables::NORMAL;

use super::tree::{Bounds, Tree};
use crate::interface::Facet;
use crate::variables::NODAL_H;

/// Slack of local coordinates at the edge of the master.
const EDGE: f64 = 1e-9;

/// Steps with which the point of a facet of second order is looked for.
const STEPS: usize = 8;

/// Nodes of `slave` whose distance to `master` is below `factor` mesh sizes and whose foot lies on it.
///
/// The distance runs along the node's normal, or along the master's where the first misses.
pub fn touching_nodes(part: &ModelPart, slave: &Facet, master: &Facet, factor: f64) -> Vec<u32> {
    let points = master.positions(part);
    let normal = master.normal_at(&points);
    let normals = part.nodes.history.values(&NORMAL, 0);
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let touches = |node: u32, direction: [f64; 3]| {
        let (x, size) = (part.nodes.current[node as usize], sizes[node as usize]);
        let (low, high) = (-size, factor * size);
        distance_along(master, &points, normal, x, direction).is_some_and(|distance| {
            distance <= high && distance >= low && meets(&points, master, x, direction, distance)
        })
    };
    let nodal = |node: u32| std::array::from_fn(|c| normals[3 * node as usize + c]);
    slave.nodes.iter().copied().filter(|&n| touches(n, nodal(n)) || touches(n, scale(normal, -1.0))).collect()
}

/// Way from `x` along `direction` to the plane with this normal through the facet at `points`, of a facet of second order to
/// itself; `None` where it is parallel.
fn distance_along(
    facet: &Facet,
    points: &[[f64; 3]],
    normal: [f64; 3],
    x: [f64; 3],
    direction: [f64; 3],
) -> Option<f64> {
    let to_plane = |on: [f64; 3], normal: [f64; 3]| {
        Some(dot(sub(on, x), normal) / dot(direction, normal)).filter(|distance| distance.is_finite())
    };
    let mut distance = to_plane(points[0], normal)?;
    if points.len() > facet.shape.cell().corners() {
        // By the tangent planes under the point.
        for _ in 0..STEPS {
            let point = add(x, scale(direction, distance));
            let Some(at) = local_coordinates(facet.shape, points, point) else { break };
            let Some(normal) = unit_normal(facet.shape, points, at.xi) else { break };
            distance = to_plane(position(facet.shape, points, at.xi), normal)?;
        }
    }
    Some(distance)
}

/// The masters whose boxes meet `line` and that a line from `x` along the unit vector `direction` meets, with the way to each
/// (length); `faces` says of a master, by its unit normal, whether it counts.
pub(super) fn met_along<'a>(
    part: &ModelPart,
    (tree, master): (&Tree, impl Fn(u32) -> &'a Facet),
    line: &Bounds,
    (x, direction): ([f64; 3], [f64; 3]),
    faces: impl Fn(&Facet, [f64; 3]) -> bool,
) -> impl Iterator<Item = (f64, &'a Facet)> {
    tree.meeting(line).into_iter().filter_map(move |at| {
        let facet = master(at);
        let points = facet.positions(part);
        let normal = facet.normal_at(&points);
        if !faces(facet, normal) {
            return None;
        }
        let distance = distance_along(facet, &points, normal, x, direction)?;
        meets(&points, facet, x, direction, distance).then_some((distance, facet))
    })
}

/// Whether the foot at that distance lies on the facet at `points`.
fn meets(points: &[[f64; 3]], facet: &Facet, x: [f64; 3], direction: [f64; 3], distance: f64) -> bool {
    let foot = std::array::from_fn(|c| x[c] + distance * direction[c]);
    local_coordinates(facet.shape, points, foot).is_some_and(|at| facet.shape.cell().contains(at.xi, EDGE))
}
