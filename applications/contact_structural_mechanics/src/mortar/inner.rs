//! Points inside a facet, one near each node, and the functions of its space that belong to them.

use zelus_core::geometry::{FacetShape, Nodal, Shape};
use zelus_core::scalar::Real;

/// Distance of the inner points from the centre by that of the nodes: that of the Gauss rule with as many points.
fn share(facet: &FacetShape) -> f64 {
    if matches!(facet.shape, Shape::Tri3 | Shape::Tri6) { 0.5 } else { 1.0 / 3.0_f64.sqrt() }
}

/// Local coordinates of the inner point near node `n`.
pub fn inner_point(facet: &FacetShape, n: usize) -> [f64; 2] {
    let (corner, centre) = (facet.corner(n), facet.centre);
    std::array::from_fn(|c| centre[c] + (corner[c] - centre[c]) * share(facet))
}

/// The functions of the facet's space that are one at one of its [`inner_point`]s and zero at the others.
pub fn inner_values<T: Real>(facet: &FacetShape, xi: [T; 2]) -> Nodal<T> {
    facet.values(std::array::from_fn(|c| (xi[c] - facet.centre[c]) / share(facet) + facet.centre[c]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::geometry::{LINE_2, QUADRILATERAL_4, TRIANGLE_3};

    #[test]
    fn inner_functions_are_one_at_their_points() {
        for facet in [&LINE_2, &TRIANGLE_3, &QUADRILATERAL_4] {
            for g in 0..facet.nodes {
                let found = inner_values(facet, inner_point(facet, g));
                assert!((0..facet.nodes).all(|k| (found[k] - f64::from(u8::from(k == g))).abs() < 1e-14), "{found:?}");
            }
        }
    }
}
