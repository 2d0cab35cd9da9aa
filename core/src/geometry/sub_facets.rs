//! Linear sub-facets: a facet of second order is cut along lines between its nodes, and each of its nodes is a corner of sub-facets.

use super::Shape;

/// The linear sub-facets of a facet, each by its nodes in the facet's order of turning: a line of second order has two, a triangle
/// four, a quadrilateral four quadrilaterals, or one between four triangles where it has no node at its centre. A facet of first
/// order is its only sub-facet.
pub const fn sub_facets(shape: Shape) -> &'static [&'static [usize]] {
    match shape {
        Shape::Line3 => &[&[0, 2], &[2, 1]],
        Shape::Tri6 => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        Shape::Quad8 => &[&[0, 4, 7], &[4, 1, 5], &[5, 2, 6], &[6, 3, 7], &[4, 5, 6, 7]],
        Shape::Quad9 => &[&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]],
        Shape::Line2 => &[&[0, 1]],
        Shape::Tri3 => &[&[0, 1, 2]],
        _ => &[&[0, 1, 2, 3]],
    }
}

/// Divisor of the size of a facet for the share of one of its nodes: each sub-facet is shared out evenly among its own nodes.
pub fn parts(shape: Shape, node: usize) -> f64 {
    let sub_facets = sub_facets(shape);
    if sub_facets.len() == 1 {
        return shape.nodes() as f64;
    }
    // In shares of a sub-facet; a quadrilateral between four triangles is as large as all of them.
    let size = |sub_facet: &[usize]| if shape == Shape::Quad8 && sub_facet.len() == 4 { 4.0 } else { 1.0 };
    let own = sub_facets
        .iter()
        .filter(|sub_facet| sub_facet.contains(&node))
        .map(|sub_facet| size(sub_facet) / sub_facet.len() as f64);
    sub_facets.iter().map(|sub_facet| size(sub_facet)).sum::<f64>() / own.sum::<f64>()
}

/// The nodes of a line or surface run through the other way round, so that its normal turns.
pub fn reversed(shape: Shape, nodes: &[u32]) -> Vec<u32> {
    let corners = shape.cell().corners();
    let (outer, rest) = nodes.split_at(corners);
    let mut out: Vec<u32> = outer.iter().rev().copied().collect();
    // Nodes on edges stand in the order of the edges, those at the centre of the facet last.
    let edges = if shape.dim() == 1 { 0 } else { rest.len().min(corners) };
    out.extend((0..edges).map(|edge| rest[(2 * corners - 2 - edge) % corners]));
    out.extend(&rest[edges..]);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mapping::{domain_size, unit_normal};

    const ALL: [Shape; 7] =
        [Shape::Line2, Shape::Line3, Shape::Tri3, Shape::Tri6, Shape::Quad4, Shape::Quad8, Shape::Quad9];

    #[test]
    fn pieces_fill_the_facet() {
        for shape in ALL {
            let points = shape.cell().points;
            let piece_shape = |nodes: usize| [Shape::Line2, Shape::Tri3, Shape::Quad4][nodes - 2];
            let sizes = sub_facets(shape).iter().map(|nodes| {
                let at: Vec<[f64; 3]> = nodes.iter().map(|&n| points[n]).collect();
                let own = piece_shape(nodes.len());
                let normal = unit_normal(own, &at, own.cell().centre).unwrap();
                let whole = unit_normal(shape, points, shape.cell().centre).unwrap();
                assert!((0..3).all(|c| (normal[c] - whole[c]).abs() < 1e-14), "{shape:?} {nodes:?}");
                domain_size(own, &at)
            });
            assert!((sizes.sum::<f64>() - shape.cell().size()).abs() < 1e-14, "{shape:?}");
        }
    }

    #[test]
    fn parts_make_the_whole() {
        for shape in ALL {
            let sum: f64 = (0..shape.nodes()).map(|node| 1.0 / parts(shape, node)).sum();
            assert!((sum - 1.0).abs() < 1e-15, "{shape:?}: {sum}");
        }
        for (shape, node, exact) in
            [(Shape::Tri6, 0, 12.0), (Shape::Tri6, 3, 4.0), (Shape::Quad8, 0, 24.0), (Shape::Quad8, 4, 4.8)]
        {
            assert!((parts(shape, node) - exact).abs() < 1e-14 * exact, "{shape:?} {node}: {}", parts(shape, node));
        }
    }

    #[test]
    fn a_reversed_facet_is_the_same_surface_from_behind() {
        for shape in ALL {
            let nodes: Vec<u32> = (0..shape.nodes() as u32).collect();
            let back = reversed(shape, &nodes);
            let places: Vec<[f64; 3]> = back.iter().map(|&n| shape.cell().points[n as usize]).collect();
            let normal = unit_normal(shape, &places, shape.cell().centre).unwrap();
            let before = unit_normal(shape, shape.cell().points, shape.cell().centre).unwrap();
            assert!((0..3).all(|c| (normal[c] + before[c]).abs() < 1e-14), "{shape:?} {back:?}");
            assert!((domain_size(shape, &places) - shape.cell().size()).abs() < 1e-13, "{shape:?} {back:?}");
            assert_eq!(reversed(shape, &back), nodes, "{shape:?}");
        }
    }
}
