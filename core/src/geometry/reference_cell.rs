//! The constant facts of every reference cell: node order, faces, edges, names in other programs.
//!
//! Local coordinates run over [−1, 1] for lines, quadrilaterals and hexahedra, over the unit simplex for triangles and
//! tetrahedra, over unit triangle × [0, 1] for prisms, and over [−1, 1]² × 0 with the apex at height 1 for pyramids. Corners come first, then edge middles, face middles, centre.

use super::Shape;

/// A face or edge of a cell: its shape and the local node numbers, in the order of that shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Facet {
    /// Shape of the facet.
    pub shape: Shape,
    /// Node numbers in the cell, from 0.
    pub nodes: &'static [usize],
}

/// Constant data of a cell, whatever its node coordinates.
#[derive(Debug)]
pub struct ReferenceCell {
    /// The shape the facts belong to.
    pub shape: Shape,
    /// Local dimension: 0 point, 1 line, 2 surface, 3 solid.
    pub dim: usize,
    /// Local coordinates of the nodes, in Kratos' node order.
    pub points: &'static [[f64; 3]],
    /// Local coordinates of the centre.
    pub centre: [f64; 3],
    /// Boundary of dimension `dim − 1`, outward, in Kratos' order.
    pub faces: &'static [Facet],
    /// All edges (for lines the line itself).
    pub edges: &'static [Facet],
    /// Order of the quadrature rule that elements use by default.
    pub default_order: usize,
    /// Cell type of the VTK formats.
    pub vtk_type: u8,
    /// Entry `k` is the node (in our order) that VTK puts at place `k`.
    pub vtk_order: &'static [usize],
    /// Element type of the GiD formats; GiD's node order is ours.
    pub gid_name: &'static str,
}

impl ReferenceCell {
    /// End of the names of entities on this cell in `space` dimensions, e.g. `3D8N`.
    pub fn suffix(&self, space: usize) -> String {
        format!("{space}D{}N", self.points.len())
    }

    /// Whether local coordinates lie in the cell, with the slack `tolerance` (in local units).
    pub fn contains(&self, xi: [f64; 3], tolerance: f64) -> bool {
        let [a, b, c] = xi;
        let (low, high) = (-tolerance, 1.0 + tolerance);
        match self.shape {
            Shape::Point1 => true,
            Shape::Tri3 | Shape::Tri6 => a >= low && b >= low && a + b <= high,
            Shape::Tet4 | Shape::Tet10 => a >= low && b >= low && c >= low && a + b + c <= high,
            Shape::Prism6 | Shape::Prism15 | Shape::Prism18 => {
                a >= low && b >= low && a + b <= high && c >= low && c <= high
            }
            Shape::Pyramid5 | Shape::Pyramid13 => c >= low && a.abs().max(b.abs()) + c <= high,
            _ => xi[..self.dim].iter().all(|x| x.abs() <= high),
        }
    }

    /// The point of a cell of a line or surface near a point outside it: negative coordinates become 0, those beyond 1 are shortened.
    pub fn clamped(&self, xi: [f64; 3]) -> [f64; 3] {
        match self.shape {
            Shape::Tri3 | Shape::Tri6 => {
                let [a, b] = [xi[0].max(0.0), xi[1].max(0.0)];
                let sum = (a + b).max(1.0);
                [a / sum, b / sum, 0.0]
            }
            _ => std::array::from_fn(|k| if k < self.dim { xi[k].clamp(-1.0, 1.0) } else { 0.0 }),
        }
    }

    /// Length, area or volume of the cell in local coordinates; 1 for a point.
    pub const fn size(&self) -> f64 {
        match self.shape {
            Shape::Point1 => 1.0,
            Shape::Line2 | Shape::Line3 => 2.0,
            Shape::Tri3 | Shape::Tri6 | Shape::Prism6 | Shape::Prism15 | Shape::Prism18 => 0.5,
            Shape::Pyramid5 | Shape::Pyramid13 => 4.0 / 3.0,
            Shape::Quad4 | Shape::Quad8 | Shape::Quad9 => 4.0,
            Shape::Tet4 | Shape::Tet10 => 1.0 / 6.0,
            Shape::Hex8 | Shape::Hex20 | Shape::Hex27 => 8.0,
        }
    }

    /// Nodes at the corners, which come first: those of the linear cell of the same kind.
    pub const fn corners(&self) -> usize {
        match self.shape {
            Shape::Point1 => 1,
            Shape::Line2 | Shape::Line3 => 2,
            Shape::Tri3 | Shape::Tri6 => 3,
            Shape::Quad4 | Shape::Quad8 | Shape::Quad9 | Shape::Tet4 | Shape::Tet10 => 4,
            Shape::Pyramid5 | Shape::Pyramid13 => 5,
            Shape::Prism6 | Shape::Prism15 | Shape::Prism18 => 6,
            Shape::Hex8 | Shape::Hex20 | Shape::Hex27 => 8,
        }
    }
}
