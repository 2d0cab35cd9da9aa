//! Points inside a facet, one near each node, and the functions of its space that belong to them.

use zelus_core::geometry::{FacetShape, Shape};
use zelus_core::scalar::Real;

/// Distance of the inner points from the centre by that of the nodes: that of the Gauss rule with as many points.
fn share<S: FacetShape>() -> f64 {
    if matches!(S::SHAPE, Shape::Tri3 | Shape::Tri6) { 0.5 } else { 1.0 / 3.0_f64.sqrt() }
}

/// Local coordinates of the inner point near node `n`.
#[inline]
pub fn inner_point<S: FacetShape>(n: usize) -> [f64; 2] {
    let corner = S::corner(n);
    std::array::from_fn(|c| S::CENTRE[c] + (corner[c] - S::CENTRE[c]) * share::<S>())
}

/// The functions of the facet's space that are one at one of its [`inner_point`]s and zero at the others.
#[inline]
pub fn inner_values<T: Real, S: FacetShape>(xi: [T; 2]) -> S::Nodal<T> {
    S::values(std::array::from_fn(|c| (xi[c] - S::CENTRE[c]) / share::<S>() + S::CENTRE[c]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::geometry::{Line2, Quadrilateral4, Triangle3};

    #[test]
    fn inner_functions_are_one_at_their_points() {
        fn check<S: FacetShape>() {
            for g in 0..S::NODES {
                let found = inner_values::<f64, S>(inner_point::<S>(g));
                assert!((0..S::NODES).all(|k| (found[k] - f64::from(u8::from(k == g))).abs() < 1e-14), "{found:?}");
            }
        }
        check::<Line2>();
        check::<Triangle3>();
        check::<Quadrilateral4>();
    }
}
