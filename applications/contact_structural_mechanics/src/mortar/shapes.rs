//! Pairs of shapes: any two facets of one space carry contact.

use zelus_core::geometry::{FacetShape, Shape};

/// Number of nodes of the largest facet.
pub use zelus_core::geometry::MOST_FACET_NODES as MOST_NODES;

/// Whether facets of a shape carry contact: lines in the plane, triangles and quadrilaterals in space.
pub fn carries_contact(shape: Shape) -> bool {
    FacetShape::of(shape).is_some()
}

/// Kratos' name of the condition of a pair of shapes; `stem` is the name up to the shape.
pub fn condition_name(stem: &str, slave: Shape, master: Shape) -> String {
    let (space, own, other) = (slave.dim() + 1, slave.nodes(), master.nodes());
    if own == other { format!("{stem}{space}D{own}N") } else { format!("{stem}{space}D{own}N{other}N") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_are_named_by_the_nodes_of_both_sides() {
        assert_eq!(condition_name("Mortar", Shape::Line2, Shape::Line2), "Mortar2D2N");
        assert_eq!(condition_name("Mortar", Shape::Line3, Shape::Line2), "Mortar2D3N2N");
        assert_eq!(condition_name("Mortar", Shape::Quad4, Shape::Quad9), "Mortar3D4N9N");
        assert!(carries_contact(Shape::Tri6) && !carries_contact(Shape::Hex8) && !carries_contact(Shape::Point1));
    }
}
