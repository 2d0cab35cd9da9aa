//! Outlines of the cells that a cutting plane meets.

use super::model::Solid;
use super::pose::Vertex;

/// The line along which the plane cuts a face of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outline {
    pub ends: [Vertex; 2],
    /// Corners of the face, ascending; the largest twice where it is a triangle. Two cells share it.
    pub face: [u32; 4],
    /// Index of the cell; the outlines of a cell follow each other.
    pub cell: usize,
}

/// The outlines of all cells.
pub(super) fn outlines(solids: &[Solid], vertices: &[Vertex]) -> Vec<Outline> {
    let is_above = |at: u32| vertices[at as usize].height > 0.0;
    let mut out = Vec::new();
    for (cell, solid) in solids.iter().enumerate() {
        let above = solid.corners.iter().filter(|&&at| is_above(at)).count();
        if above == 0 || above == solid.corners.len() {
            continue;
        }
        for face in solid.shape.cell().faces {
            let ring: Vec<u32> = face.nodes.iter().map(|&at| solid.corners[at]).collect();
            let sides = ring.iter().zip(ring.iter().cycle().skip(1)).filter(|(a, b)| is_above(**a) != is_above(**b));
            let ends: Vec<Vertex> =
                sides.map(|(&a, &b)| vertices[a as usize].towards_plane(&vertices[b as usize])).collect();
            let &[first, second] = &ends[..] else { continue };
            let mut sorted = ring;
            sorted.sort_unstable();
            let face = std::array::from_fn(|at| sorted[at.min(sorted.len() - 1)]);
            out.push(Outline { ends: [first, second], face, cell });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use zelus_core::geometry::Shape;

    use super::super::pose::Plane;
    use super::*;

    #[test]
    fn a_plane_cuts_a_cube_along_a_square_or_a_hexagon() {
        let corners: Vec<u32> = (0..8).collect();
        let points = Shape::Hex8.cell().points;
        let solids = [Solid { shape: Shape::Hex8, corners }];
        // ANALYTIC: of a cube of edge 2 the plane z = 0.5 cuts a square around 8, x + y + z = 0 a regular hexagon around 6 √2
        for (normal, at, count, around) in
            [([0.0, 0.0, 1.0], 0.5, 4, 8.0), ([1.0, 1.0, 1.0], 0.0, 6, 6.0 * 2.0_f64.sqrt())]
        {
            let plane = Plane { normal, at };
            let vertex = |&place: &[f64; 3]| Vertex { place, height: plane.height(place), value: 0.0 };
            let vertices: Vec<Vertex> = points.iter().map(vertex).collect();
            let found = outlines(&solids, &vertices);
            let length = |own: &Outline| {
                let [a, b] = own.ends.map(|end| end.place);
                a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt()
            };
            let sum: f64 = found.iter().map(length).sum();
            assert!(found.len() == count && (sum - around).abs() < 1e-12, "{} lines of {sum}", found.len());
        }
    }
}
