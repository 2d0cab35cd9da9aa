//! How far a slave facet is from the masters that it faces.

use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, norm, scale, sub};

use super::direct_check::{distance_along, meets};
use super::tree::{Bounds, Tree};
use crate::interface::{Facet, Interface};

/// The largest distance (length) from nodes and centre of a facet with this unit normal to the first of `masters` along it; 0 where
/// it faces none. Masters whose unit normals differ by less than `threshold` face the same way, and do not count.
pub(super) fn farthest_master(
    part: &ModelPart,
    interface: &Interface,
    (facet, centre, normal): (&Facet, [f64; 3], [f64; 3]),
    (masters, tree): (&[u32], &Tree),
    threshold: f64,
) -> f64 {
    let Some(extent) = tree.bounds() else { return 0.0 };
    let first = |x: [f64; 3]| {
        let far = norm(sub(extent.high, extent.low)) + norm(sub(centre, extent.low));
        let line = Bounds::of(&[x, add(x, scale(normal, far))]);
        let met = tree.meeting(&line).into_iter().filter_map(|at| {
            let master = &interface.facets[masters[at as usize] as usize];
            let points = master.positions(part);
            let of_master = master.normal_at(&points);
            if norm(sub(normal, of_master)) < threshold {
                return None;
            }
            let distance = distance_along(master, &points, of_master, x, normal).filter(|distance| *distance >= 0.0)?;
            meets(&points, master, x, normal, distance).then_some(distance)
        });
        met.min_by(f64::total_cmp)
    };
    let points = facet.positions(part);
    let points = points.iter().copied().chain([centre]);
    points.filter_map(first).fold(0.0, f64::max)
}
