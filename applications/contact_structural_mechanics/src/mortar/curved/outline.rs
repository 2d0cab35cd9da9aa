//! The overlap of the outline of a master facet with a convex part of the slave, in the plane of the slave.
//!
//! The outline of a facet of second order runs through the nodes on its edges and need not be convex, so it is cut by one edge of
//! the slave after the other (Sutherland and Hodgman 1974). Nodes within a tolerance of an edge lie on it, which makes coincident
//! nodes and edges one vertex.

use super::super::segmentation_3d::{Vertex, area, cross2, length, minus};
use zelus_core::geometry::{FacetShape, Nodal};

/// Room for the vertices: a cut by one of at most four edges adds at most half as many as there are.
const CAPACITY: usize = 40;

/// Nodes of a facet along its rim.
pub(super) fn rim(shape: &FacetShape) -> Nodal<usize> {
    let count = shape.corners;
    if shape.curved {
        Nodal::new(2 * count, |n| if n % 2 == 0 { n / 2 } else { count + n / 2 })
    } else {
        Nodal::new(count, |n| n)
    }
}

/// A vertex, where it is, and the edge that the outline follows from there.
#[derive(Clone, Copy)]
struct OutlineVertex {
    vertex: Vertex,
    at: [f64; 2],
    edge: Edge,
}

/// An edge by the node that it starts from.
#[derive(Clone, Copy)]
enum Edge {
    Slave(usize),
    Master(usize),
}

/// A closed line of vertices.
pub(super) struct ClosedLine {
    corners: [OutlineVertex; CAPACITY],
    len: usize,
}

impl ClosedLine {
    const EMPTY: Self = Self {
        corners: [OutlineVertex { vertex: Vertex::Slave(0), at: [0.0; 2], edge: Edge::Slave(0) }; CAPACITY],
        len: 0,
    };

    /// The overlap of a convex slave with the outline of a master, anticlockwise; both may run either way round.
    pub(super) fn overlap(slave: &[[f64; 2]], master: &[[f64; 2]], tolerance: f64) -> Self {
        if !boxes_meet(slave, master, tolerance) {
            return Self::EMPTY;
        }
        let (turn, count) = (area(slave).signum(), master.len());
        let mut line = Self::EMPTY;
        for n in 0..count {
            // Backwards, an edge starts where it ends.
            let (node, edge) = if area(master) > 0.0 { (n, n) } else { (count - 1 - n, (2 * count - 2 - n) % count) };
            line.push(OutlineVertex { vertex: Vertex::Master(node), at: master[node], edge: Edge::Master(edge) });
        }
        for edge in 0..slave.len() {
            line = line.cut(slave, edge, turn, tolerance);
        }
        line
    }

    /// The vertices, the first of them the one nearest to a point.
    pub(super) fn vertices_from(&self, point: [f64; 2]) -> impl Iterator<Item = Vertex> + '_ {
        let corners = &self.corners[..self.len];
        let apart = |corner: &OutlineVertex| length(minus(corner.at, point));
        let first = (0..self.len).min_by(|&a, &b| apart(&corners[a]).total_cmp(&apart(&corners[b]))).unwrap_or(0);
        corners[first..].iter().chain(&corners[..first]).map(|corner| corner.vertex)
    }

    fn push(&mut self, corner: OutlineVertex) {
        if self.len < CAPACITY {
            self.corners[self.len] = corner;
            self.len += 1;
        }
    }

    /// The part on the inner side of an edge of the slave, which turns anticlockwise where `turn` is 1.
    fn cut(&self, slave: &[[f64; 2]], edge: usize, turn: f64, tolerance: f64) -> Self {
        let (from, to) = (slave[edge], slave[(edge + 1) % slave.len()]);
        let along = minus(to, from);
        let whole = length(along);
        // Distance inwards, zero on the edge.
        let inwards = |corner: &OutlineVertex| {
            let height = turn * cross2(along, minus(corner.at, from)) / whole;
            if height.abs() <= tolerance { 0.0 } else { height }
        };
        let mut out = Self::EMPTY;
        for n in 0..self.len {
            let (start, end) = (&self.corners[n], &self.corners[(n + 1) % self.len]);
            let (a, b) = (inwards(start), inwards(end));
            if a >= 0.0 {
                let leaves = a == 0.0 && b < 0.0;
                out.push(OutlineVertex { edge: if leaves { Edge::Slave(edge) } else { start.edge }, ..*start });
            }
            if a * b < 0.0 {
                let share = a / (a - b);
                let at = std::array::from_fn(|c| start.at[c] + (end.at[c] - start.at[c]) * share);
                let next = if b < 0.0 { Edge::Slave(edge) } else { start.edge };
                out.push(OutlineVertex { vertex: crossing(slave.len(), edge, start.edge), at, edge: next });
            }
        }
        out
    }
}

/// The vertex in which an edge of the slave crosses another edge.
fn crossing(slaves: usize, edge: usize, other: Edge) -> Vertex {
    match other {
        Edge::Master(master) => Vertex::Crossing { slave: edge, master },
        // Edges of the slave cross in the corner that they share.
        Edge::Slave(other) if (other + 1) % slaves == edge => Vertex::Slave(edge),
        Edge::Slave(other) => Vertex::Slave(other),
    }
}

/// Whether the boxes around two sets of points meet.
fn boxes_meet(some: &[[f64; 2]], others: &[[f64; 2]], tolerance: f64) -> bool {
    let bound = |points: &[[f64; 2]], c: usize, start: f64, of: fn(f64, f64) -> f64| {
        points.iter().map(|point| point[c]).fold(start, of)
    };
    (0..2).all(|c| {
        let low = |points: &[[f64; 2]]| bound(points, c, f64::INFINITY, f64::min);
        let high = |points: &[[f64; 2]]| bound(points, c, f64::NEG_INFINITY, f64::max);
        low(some) <= high(others) + tolerance && low(others) <= high(some) + tolerance
    })
}

#[cfg(test)]
mod tests {
    use super::super::super::segmentation_3d::place;
    use super::*;

    const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

    fn overlap_area(slave: &[[f64; 2]], master: &[[f64; 2]]) -> f64 {
        let line = ClosedLine::overlap(slave, master, 1e-12);
        let points: Vec<[f64; 2]> = line.vertices_from(slave[0]).map(|vertex| place(vertex, slave, master)).collect();
        if points.len() < 3 { 0.0 } else { area(&points) }
    }

    #[test]
    fn outlines_that_are_not_convex_are_cut_exactly() {
        // A square with a notch of area 0.08 from the right, whose tip lies in the triangle.
        let notched = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.3], [0.2, 0.4], [2.0, 0.5], [2.0, 2.0], [-1.0, 2.0]];
        // Within the triangle the notch is cut at x + y = 1.
        let whole = 0.5;
        let (upper, lower) = ([0.4, 0.4 + 0.2 / 18.0], [0.4, 0.4 - 0.2 / 18.0]);
        let slope = |y: [f64; 2]| (y[1] - 0.4) / (y[0] - 0.2);
        let meets = |y: [f64; 2]| {
            let x = (1.0 - 0.4 + 0.2 * slope(y)) / (1.0 + slope(y));
            [x, 1.0 - x]
        };
        let notch = area(&[[0.2, 0.4], meets(lower), meets(upper)]);
        let reversed: Vec<[f64; 2]> = notched.iter().rev().copied().collect();
        for master in [&notched[..], &reversed] {
            assert!((overlap_area(&TRIANGLE, master) - (whole - notch)).abs() < 1e-14);
        }
        // The part of a triangle that a notch leaves in two pieces.
        let split =
            [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.4], [-0.5, 0.4], [-0.5, 0.5], [2.0, 0.5], [2.0, 2.0], [-1.0, 2.0]];
        let strip = 0.1 * 0.55;
        assert!((overlap_area(&TRIANGLE, &split) - (whole - strip)).abs() < 1e-14);
    }

    #[test]
    fn coincident_corners_and_edges_are_one() {
        for noise in [0.0, 1e-15, -1e-15, 3e-13] {
            let moved = TRIANGLE.map(|[x, y]| [x + noise, y - noise]);
            let line = ClosedLine::overlap(&TRIANGLE, &moved, 1e-12);
            let vertices: Vec<Vertex> = line.vertices_from([0.0; 2]).collect();
            assert_eq!(vertices, [Vertex::Master(0), Vertex::Master(1), Vertex::Master(2)]);
        }
        let beside = TRIANGLE.map(|[x, y]| [x + 1.0, y]);
        assert!(overlap_area(&TRIANGLE, &beside).abs() < 1e-14);
        let clockwise = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]];
        assert!((overlap_area(&clockwise, &[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]) - 0.5).abs() < 1e-14);
    }

    #[test]
    fn rims_run_through_the_nodes_on_the_edges() {
        use zelus_core::geometry::{QUADRILATERAL_9, TRIANGLE_3, TRIANGLE_6};
        assert_eq!(*rim(&TRIANGLE_6), [0, 3, 1, 4, 2, 5]);
        assert_eq!(*rim(&QUADRILATERAL_9), [0, 4, 1, 5, 2, 6, 3, 7]);
        assert_eq!(*rim(&TRIANGLE_3), [0, 1, 2]);
    }
}
