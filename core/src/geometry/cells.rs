//! The table of reference cells. Corners come first, then edge middles, face middles, centre.

use super::{Facet, ReferenceCell, Shape};

const fn facet<const K: usize>(dim: usize, nodes: &'static [usize; K]) -> Facet {
    match Shape::of(dim, K) {
        Some(shape) => Facet { shape, nodes },
        None => panic!("no shape with this dimension and number of nodes"),
    }
}

const fn point(nodes: &'static [usize; 1]) -> Facet {
    facet(0, nodes)
}

const fn line<const K: usize>(nodes: &'static [usize; K]) -> Facet {
    facet(1, nodes)
}

const fn surface<const K: usize>(nodes: &'static [usize; K]) -> Facet {
    facet(2, nodes)
}

const LINE: [[f64; 3]; 3] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];

const TRIANGLE: [[f64; 3]; 6] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.0]];

const QUADRILATERAL: [[f64; 3]; 9] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];

const TETRAHEDRON: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.5, 0.0, 0.5],
    [0.0, 0.5, 0.5],
];

/// Triangle edges of the bottom, uprights, triangle edges of the top.
const PRISM: [[f64; 3]; 15] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [1.0, 0.0, 0.5],
    [0.0, 1.0, 0.5],
    [0.5, 0.0, 1.0],
    [0.5, 0.5, 1.0],
    [0.0, 0.5, 1.0],
];

/// Edges of the bottom, uprights, edges of the top; faces −z, −y, +x, +y, −x, +z; centre.
const HEXAHEDRON: [[f64; 3]; 27] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, 0.0],
];

const fn head<const K: usize>(points: &'static [[f64; 3]]) -> &'static [[f64; 3]] {
    points.split_at(K).0
}

const SAME: &[usize; 10] = &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9];

const fn same<const K: usize>() -> &'static [usize] {
    SAME.split_at(K).0
}

const THIRD: f64 = 1.0 / 3.0;

/// The table, in the order of [`Shape`].
pub(super) const CELLS: &[ReferenceCell; Shape::ALL.len()] = &[
    ReferenceCell {
        shape: Shape::Point1,
        dim: 0,
        points: &[[0.0; 3]],
        centre: [0.0; 3],
        faces: &[],
        edges: &[],
        default_order: 1,
        vtk_type: 1,
        vtk_order: same::<1>(),
        gid_name: "Point",
    },
    ReferenceCell {
        shape: Shape::Line2,
        dim: 1,
        points: head::<2>(&LINE),
        centre: [0.0; 3],
        faces: &[point(&[0]), point(&[1])],
        edges: &[line(&[0, 1])],
        default_order: 1,
        vtk_type: 3,
        vtk_order: same::<2>(),
        gid_name: "Linear",
    },
    ReferenceCell {
        shape: Shape::Line3,
        dim: 1,
        points: &LINE,
        centre: [0.0; 3],
        faces: &[point(&[0]), point(&[1])],
        edges: &[line(&[0, 1, 2])],
        default_order: 2,
        vtk_type: 21,
        vtk_order: same::<3>(),
        gid_name: "Linear",
    },
    ReferenceCell {
        shape: Shape::Tri3,
        dim: 2,
        points: head::<3>(&TRIANGLE),
        centre: [THIRD, THIRD, 0.0],
        faces: &[line(&[0, 1]), line(&[1, 2]), line(&[2, 0])],
        edges: &[line(&[0, 1]), line(&[1, 2]), line(&[2, 0])],
        default_order: 1,
        vtk_type: 5,
        vtk_order: same::<3>(),
        gid_name: "Triangle",
    },
    ReferenceCell {
        shape: Shape::Tri6,
        dim: 2,
        points: &TRIANGLE,
        centre: [THIRD, THIRD, 0.0],
        faces: &[line(&[0, 1, 3]), line(&[1, 2, 4]), line(&[2, 0, 5])],
        edges: &[line(&[0, 1, 3]), line(&[1, 2, 4]), line(&[2, 0, 5])],
        default_order: 2,
        vtk_type: 22,
        vtk_order: same::<6>(),
        gid_name: "Triangle",
    },
    ReferenceCell {
        shape: Shape::Quad4,
        dim: 2,
        points: head::<4>(&QUADRILATERAL),
        centre: [0.0; 3],
        faces: &[line(&[0, 1]), line(&[1, 2]), line(&[2, 3]), line(&[3, 0])],
        edges: &[line(&[0, 1]), line(&[1, 2]), line(&[2, 3]), line(&[3, 0])],
        default_order: 2,
        vtk_type: 9,
        vtk_order: same::<4>(),
        gid_name: "Quadrilateral",
    },
    ReferenceCell {
        shape: Shape::Quad8,
        dim: 2,
        points: head::<8>(&QUADRILATERAL),
        centre: [0.0; 3],
        faces: &[line(&[0, 1, 4]), line(&[1, 2, 5]), line(&[2, 3, 6]), line(&[3, 0, 7])],
        edges: &[line(&[0, 1, 4]), line(&[1, 2, 5]), line(&[2, 3, 6]), line(&[3, 0, 7])],
        default_order: 3,
        vtk_type: 23,
        vtk_order: same::<8>(),
        gid_name: "Quadrilateral",
    },
    ReferenceCell {
        shape: Shape::Quad9,
        dim: 2,
        points: &QUADRILATERAL,
        centre: [0.0; 3],
        faces: &[line(&[0, 1, 4]), line(&[1, 2, 5]), line(&[2, 3, 6]), line(&[3, 0, 7])],
        edges: &[line(&[0, 1, 4]), line(&[1, 2, 5]), line(&[2, 3, 6]), line(&[3, 0, 7])],
        default_order: 3,
        vtk_type: 28,
        vtk_order: same::<9>(),
        gid_name: "Quadrilateral",
    },
    ReferenceCell {
        shape: Shape::Tet4,
        dim: 3,
        points: head::<4>(&TETRAHEDRON),
        centre: [0.25; 3],
        faces: &[surface(&[0, 2, 1]), surface(&[0, 3, 2]), surface(&[0, 1, 3]), surface(&[2, 3, 1])],
        edges: &[line(&[0, 1]), line(&[1, 2]), line(&[2, 0]), line(&[0, 3]), line(&[1, 3]), line(&[2, 3])],
        default_order: 1,
        vtk_type: 10,
        vtk_order: same::<4>(),
        gid_name: "Tetrahedra",
    },
    ReferenceCell {
        shape: Shape::Tet10,
        dim: 3,
        points: &TETRAHEDRON,
        centre: [0.25; 3],
        faces: &[
            surface(&[0, 2, 1, 6, 5, 4]),
            surface(&[0, 3, 2, 7, 9, 6]),
            surface(&[0, 1, 3, 4, 8, 7]),
            surface(&[2, 3, 1, 9, 8, 5]),
        ],
        edges: &[
            line(&[0, 1, 4]),
            line(&[1, 2, 5]),
            line(&[2, 0, 6]),
            line(&[0, 3, 7]),
            line(&[1, 3, 8]),
            line(&[2, 3, 9]),
        ],
        default_order: 2,
        vtk_type: 24,
        vtk_order: same::<10>(),
        gid_name: "Tetrahedra",
    },
    ReferenceCell {
        shape: Shape::Prism6,
        dim: 3,
        points: head::<6>(&PRISM),
        centre: [THIRD, THIRD, 0.5],
        faces: &[
            surface(&[0, 2, 1]),
            surface(&[3, 4, 5]),
            surface(&[1, 2, 5, 4]),
            surface(&[0, 3, 5, 2]),
            surface(&[0, 1, 4, 3]),
        ],
        edges: &[
            line(&[0, 1]),
            line(&[1, 2]),
            line(&[2, 0]),
            line(&[3, 4]),
            line(&[4, 5]),
            line(&[5, 3]),
            line(&[0, 3]),
            line(&[1, 4]),
            line(&[2, 5]),
        ],
        default_order: 2,
        vtk_type: 13,
        vtk_order: same::<6>(),
        gid_name: "Prism",
    },
    ReferenceCell {
        shape: Shape::Prism15,
        dim: 3,
        points: &PRISM,
        centre: [THIRD, THIRD, 0.5],
        faces: &[
            surface(&[0, 2, 1, 8, 7, 6]),
            surface(&[3, 4, 5, 12, 13, 14]),
            surface(&[0, 1, 4, 3, 6, 10, 12, 9]),
            surface(&[2, 0, 3, 5, 8, 9, 14, 11]),
            surface(&[1, 2, 5, 4, 7, 11, 13, 10]),
        ],
        edges: &[
            line(&[0, 1, 6]),
            line(&[1, 2, 7]),
            line(&[2, 0, 8]),
            line(&[3, 4, 12]),
            line(&[4, 5, 13]),
            line(&[5, 3, 14]),
            line(&[0, 3, 9]),
            line(&[1, 4, 10]),
            line(&[2, 5, 11]),
        ],
        default_order: 3,
        vtk_type: 26,
        vtk_order: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11],
        gid_name: "Prism",
    },
    ReferenceCell {
        shape: Shape::Hex8,
        dim: 3,
        points: head::<8>(&HEXAHEDRON),
        centre: [0.0; 3],
        faces: &[
            surface(&[3, 2, 1, 0]),
            surface(&[0, 1, 5, 4]),
            surface(&[2, 6, 5, 1]),
            surface(&[7, 6, 2, 3]),
            surface(&[7, 3, 0, 4]),
            surface(&[4, 5, 6, 7]),
        ],
        edges: &[
            line(&[0, 1]),
            line(&[1, 2]),
            line(&[2, 3]),
            line(&[3, 0]),
            line(&[4, 5]),
            line(&[5, 6]),
            line(&[6, 7]),
            line(&[7, 4]),
            line(&[0, 4]),
            line(&[1, 5]),
            line(&[2, 6]),
            line(&[3, 7]),
        ],
        default_order: 2,
        vtk_type: 12,
        vtk_order: same::<8>(),
        gid_name: "Hexahedra",
    },
    ReferenceCell {
        shape: Shape::Hex20,
        dim: 3,
        points: head::<20>(&HEXAHEDRON),
        centre: [0.0; 3],
        faces: &[
            surface(&[3, 2, 1, 0, 10, 9, 8, 11]),
            surface(&[0, 1, 5, 4, 8, 13, 16, 12]),
            surface(&[2, 6, 5, 1, 14, 17, 13, 9]),
            surface(&[7, 6, 2, 3, 18, 14, 10, 15]),
            surface(&[7, 3, 0, 4, 15, 11, 12, 19]),
            surface(&[4, 5, 6, 7, 16, 17, 18, 19]),
        ],
        edges: QUADRATIC_HEXAHEDRON_EDGES,
        default_order: 3,
        vtk_type: 25,
        vtk_order: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15],
        gid_name: "Hexahedra",
    },
    ReferenceCell {
        shape: Shape::Hex27,
        dim: 3,
        points: &HEXAHEDRON,
        centre: [0.0; 3],
        faces: &[
            surface(&[3, 2, 1, 0, 10, 9, 8, 11, 20]),
            surface(&[0, 1, 5, 4, 8, 13, 16, 12, 21]),
            surface(&[2, 6, 5, 1, 14, 17, 13, 9, 22]),
            surface(&[7, 6, 2, 3, 18, 14, 10, 15, 23]),
            surface(&[7, 3, 0, 4, 15, 11, 12, 19, 24]),
            surface(&[4, 5, 6, 7, 16, 17, 18, 19, 25]),
        ],
        edges: QUADRATIC_HEXAHEDRON_EDGES,
        default_order: 3,
        vtk_type: 29,
        vtk_order: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15, 24, 22, 21, 23, 20, 25, 26],
        gid_name: "Hexahedra",
    },
];

const QUADRATIC_HEXAHEDRON_EDGES: &[Facet] = &[
    line(&[0, 1, 8]),
    line(&[1, 2, 9]),
    line(&[2, 3, 10]),
    line(&[3, 0, 11]),
    line(&[4, 5, 16]),
    line(&[5, 6, 17]),
    line(&[6, 7, 18]),
    line(&[7, 4, 19]),
    line(&[0, 4, 12]),
    line(&[1, 5, 13]),
    line(&[2, 6, 14]),
    line(&[3, 7, 15]),
];
