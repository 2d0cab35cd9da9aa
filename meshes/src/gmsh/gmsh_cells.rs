//! Gmsh's types of cells and their order of nodes.

use zelus_core::geometry::Shape;

const SAME: [usize; 10] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9];
const PYRAMID13: [usize; 13] = [0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12];
const TET10: [usize; 10] = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8];
const PRISM: [usize; 18] = [0, 1, 2, 3, 4, 5, 6, 9, 7, 8, 10, 11, 12, 14, 13, 15, 17, 16];
const HEX: [usize; 27] =
    [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 10, 12, 14, 15, 16, 18, 19, 17, 20, 21, 23, 24, 22, 25, 26];

/// Types with their numbers.
const TYPES: [(i64, Shape); 18] = [
    (15, Shape::Point1),
    (1, Shape::Line2),
    (8, Shape::Line3),
    (2, Shape::Tri3),
    (9, Shape::Tri6),
    (3, Shape::Quad4),
    (16, Shape::Quad8),
    (10, Shape::Quad9),
    (4, Shape::Tet4),
    (11, Shape::Tet10),
    (7, Shape::Pyramid5),
    (19, Shape::Pyramid13),
    (6, Shape::Prism6),
    (18, Shape::Prism15),
    (13, Shape::Prism18),
    (5, Shape::Hex8),
    (17, Shape::Hex20),
    (12, Shape::Hex27),
];

/// The shape of a type, and for each of its nodes the place at which Gmsh writes it.
pub(super) fn of(number: i64) -> Option<(Shape, &'static [usize])> {
    let (_, shape) = *TYPES.iter().find(|(own, _)| *own == number)?;
    Some((shape, order(shape)))
}

fn order(shape: Shape) -> &'static [usize] {
    match shape {
        Shape::Tet10 => &TET10,
        Shape::Pyramid13 => &PYRAMID13,
        Shape::Prism15 => &PRISM[..15],
        Shape::Prism18 => &PRISM,
        Shape::Hex20 => &HEX[..20],
        Shape::Hex27 => &HEX,
        _ => &SAME[..shape.nodes()],
    }
}

/// The type of a shape, and at each place of Gmsh's order the node.
pub(super) fn number(shape: Shape) -> (i64, Vec<usize>) {
    let number = TYPES.iter().find(|(_, own)| *own == shape).expect("every shape has a type").0;
    let order = order(shape);
    (number, (0..order.len()).map(|place| order.iter().position(|&at| at == place).expect("a permutation")).collect())
}

/// In brackets, the name of a type that is not known here.
pub(super) fn name(number: i64) -> &'static str {
    match number {
        14 => " (pyramids of 14 nodes)",
        20..=35 => " (order 3 and higher)",
        _ => "",
    }
}
