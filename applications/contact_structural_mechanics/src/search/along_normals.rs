//! How far a slave facet is from the masters that it faces.

use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, norm, scale, sub};

use super::direct_check::met_along;
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
        let master = |at: u32| &interface.facets[masters[at as usize] as usize];
        let faces = |_: &Facet, of_master| norm(sub(normal, of_master)) >= threshold;
        let met = met_along(part, (tree, master), &line, (x, normal), faces).map(|(distance, _)| distance);
        met.filter(|distance| *distance >= 0.0).min_by(f64::total_cmp)
    };
    let points = facet.positions(part);
    let points = points.iter().copied().chain([centre]);
    points.filter_map(first).fold(0.0, f64::max)
}
