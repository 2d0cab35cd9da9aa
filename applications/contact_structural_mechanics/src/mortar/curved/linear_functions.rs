//! The linear functions L of the sub-facets of a slave, which multipliers are built of.

use super::super::overlap_point::OverlapPoint;
use zelus_core::geometry::{FacetShape, Nodal};
use zelus_core::scalar::Real;

/// Nodes of the largest sub-facet.
pub(super) const PIECE: usize = 4;

/// L at local coordinates of the facet. Sub-facets are parallelograms and triangles there.
pub(super) fn linear_functions<T: Real>(shape: &FacetShape, sub_facet: &[usize], xi: [T; 2]) -> [T; PIECE] {
    let corner = |n: usize| shape.corner(sub_facet[n]);
    let apart = |a: [f64; 2], b: [f64; 2]| [b[0] - a[0], b[1] - a[1]];
    let (first, from) = (apart(corner(0), corner(1)), corner(0).map(T::constant));
    let way = [xi[0] - from[0], xi[1] - from[1]];
    let mut out = [T::zero(); PIECE];
    if sub_facet.len() == 2 {
        out[1] = way[0] / first[0];
        out[0] = T::one() - out[1];
        return out;
    }
    let last = apart(corner(0), corner(sub_facet.len() - 1));
    let whole = 1.0 / (first[0] * last[1] - first[1] * last[0]);
    let a = (way[0] * last[1] - way[1] * last[0]) * whole;
    let b = (way[1] * first[0] - way[0] * first[1]) * whole;
    if sub_facet.len() == 3 {
        [T::one() - a - b, a, b, T::zero()]
    } else {
        let rest = [T::one() - a, T::one() - b];
        [rest[0] * rest[1], a * rest[1], a * b, rest[0] * b]
    }
}

/// L of all nodes of a slave at one of its points: the share of the point that each node has. For a slave of first order these are its
/// shape functions.
pub fn nodal_shares<T: Real>(shape: &FacetShape, point: &OverlapPoint<T>) -> Nodal<T> {
    if !shape.curved {
        return point.slave;
    }
    // The sub-facet that the point is in, or least outside.
    let least = |functions: &[T]| functions.iter().map(|f| f.value()).fold(f64::INFINITY, f64::min);
    let of_sub_facet = |sub_facet: &'static [usize]| (sub_facet, linear_functions(shape, sub_facet, point.local));
    let sub_facets = shape.sub_facets.iter().map(|sub_facet| of_sub_facet(sub_facet));
    let found = sub_facets.max_by(|(a, of_a), (b, of_b)| least(&of_a[..a.len()]).total_cmp(&least(&of_b[..b.len()])));
    let mut out = shape.nodal(|_| T::zero());
    let (sub_facet, functions) = found.expect("a facet has sub-facets");
    sub_facet.iter().zip(functions).for_each(|(&node, own)| out[node] = own);
    out
}
