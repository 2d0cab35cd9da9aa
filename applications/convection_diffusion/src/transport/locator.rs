//! The element of a mesh at a point.

use rustc_hash::FxHashMap;
use zelus_core::geometry::mapping::local_coordinates;
use zelus_core::geometry::shape_functions;

use super::mesh::Mesh;

/// How far outside an element a point may be, in local coordinates.
const SLACK: f64 = 1e-5;
/// Nodes of an element at most.
const MOST: usize = 27;

/// The elements of a mesh in cells of the size of a mean element.
pub struct Locator<'a> {
    mesh: &'a Mesh<'a>,
    size: f64,
    of_cell: FxHashMap<[i32; 3], Vec<u32>>,
}

/// The element at a point.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    nodes: &'a [u32],
    n: [f64; MOST],
}

impl<'a> Locator<'a> {
    /// Finds places in a mesh.
    pub fn new(mesh: &'a Mesh<'a>) -> Self {
        let mut locator = Self { mesh, size: 1.0, of_cell: FxHashMap::default() };
        let elements = 0..mesh.elements.len() as u32;
        let boxes: Vec<_> = elements.clone().map(|at| bounds(&mesh.corners(at))).collect();
        let extent = |[low, high]: &[[f64; 3]; 2]| (0..3).map(|a| high[a] - low[a]).fold(0.0, f64::max);
        let mean = boxes.iter().map(extent).sum::<f64>() / boxes.len().max(1) as f64;
        locator.size = if mean > 0.0 { mean } else { 1.0 };
        for (element, [low, high]) in elements.zip(&boxes) {
            // A point on the side of a cell belongs to both cells.
            let margin = SLACK * locator.size;
            let (low, high) = (locator.cell(low.map(|x| x - margin)), locator.cell(high.map(|x| x + margin)));
            for i in low[0]..=high[0] {
                for j in low[1]..=high[1] {
                    for k in low[2]..=high[2] {
                        locator.of_cell.entry([i, j, k]).or_default().push(element);
                    }
                }
            }
        }
        locator
    }

    fn cell(&self, x: [f64; 3]) -> [i32; 3] {
        x.map(|x| (x / self.size).floor() as i32)
    }

    /// The first of the elements at a point; `None` outside of the mesh.
    pub fn find(&self, point: [f64; 3]) -> Option<Place<'a>> {
        let near = self.of_cell.get(&self.cell(point))?;
        near.iter().find_map(|&element| {
            let ((shape, nodes), x) = (&self.mesh.elements[element as usize], self.mesh.corners(element));
            let [low, high] = bounds(&x);
            let is_near = (0..3).all(|a| {
                let slack = 0.1 * (high[a] - low[a]) + SLACK * self.size;
                (low[a] - slack..=high[a] + slack).contains(&point[a])
            });
            let xi = is_near.then(|| local_coordinates(*shape, &x, point)).flatten()?.xi;
            shape.cell().contains(xi, SLACK).then(|| {
                let mut n = [0.0; MOST];
                shape_functions(*shape, xi, &mut n);
                Place { nodes, n }
            })
        })
    }
}

impl Place<'_> {
    /// The value there of a field with one number a node.
    pub fn value(&self, field: &[[f64; 1]]) -> f64 {
        self.nodes.iter().zip(&self.n).map(|(&node, n)| n * field[node as usize][0]).sum()
    }

    /// The value there of a field with a vector a node.
    pub fn vector(&self, field: &[[f64; 3]]) -> [f64; 3] {
        let of = |a: usize| self.nodes.iter().zip(&self.n).map(|(&node, n)| n * field[node as usize][a]).sum();
        std::array::from_fn(of)
    }
}

/// The lowest and highest coordinates of points.
fn bounds(points: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let mut bounds = [[f64::MAX; 3], [f64::MIN; 3]];
    for x in points {
        (0..3).for_each(|a| {
            bounds[0][a] = bounds[0][a].min(x[a]);
            bounds[1][a] = bounds[1][a].max(x[a]);
        });
    }
    bounds
}
