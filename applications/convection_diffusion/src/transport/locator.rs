//! The element of a mesh at a point.

use rustc_hash::FxHashMap;
use zelus_core::geometry::mapping::local_coordinates;
use zelus_core::geometry::{Shape, shape_functions};
use zelus_core::model::ModelPart;

/// How far outside an element a point may be, in local coordinates.
const SLACK: f64 = 1e-5;
/// Nodes of an element at most.
const MOST: usize = 27;

/// The elements of a part in cells of the size of a mean element, where the nodes are now.
pub struct Locator<'a> {
    part: &'a ModelPart,
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
    /// The elements that fill the space of the part.
    pub fn new(part: &'a ModelPart) -> Self {
        let mut locator = Self { part, size: 1.0, of_cell: FxHashMap::default() };
        let fills = |&at: &u32| locator.shape(at).is_some();
        let elements: Vec<u32> = (0..part.elements.len() as u32).filter(fills).collect();
        let boxes: Vec<_> = elements.iter().map(|&at| bounds(&locator.positions(at))).collect();
        let extent = |[low, high]: &[[f64; 3]; 2]| (0..3).map(|a| high[a] - low[a]).fold(0.0, f64::max);
        let mean = boxes.iter().map(extent).sum::<f64>() / boxes.len().max(1) as f64;
        locator.size = if mean > 0.0 { mean } else { 1.0 };
        for (&element, [low, high]) in elements.iter().zip(&boxes) {
            // What lies on the side of a cell belongs to both.
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

    fn shape(&self, element: u32) -> Option<Shape> {
        let ModelPart { elements, info, .. } = self.part;
        elements.kinds[element as usize].cell.filter(|cell| cell.dim() == info.domain_size)
    }

    fn positions(&self, element: u32) -> Vec<[f64; 3]> {
        self.part.elements.nodes(element).iter().map(|&node| self.part.nodes.current[node as usize]).collect()
    }

    fn cell(&self, x: [f64; 3]) -> [i32; 3] {
        x.map(|x| (x / self.size).floor() as i32)
    }

    /// The first of the elements at a point; `None` outside of the mesh.
    pub fn find(&self, point: [f64; 3]) -> Option<Place<'a>> {
        let near = self.of_cell.get(&self.cell(point))?;
        near.iter().find_map(|&element| {
            let (shape, x) = (self.shape(element)?, self.positions(element));
            let [low, high] = bounds(&x);
            let is_near = (0..3).all(|a| {
                let slack = 0.1 * (high[a] - low[a]) + SLACK * self.size;
                (low[a] - slack..=high[a] + slack).contains(&point[a])
            });
            let xi = is_near.then(|| local_coordinates(shape, &x, point)).flatten()?.xi;
            shape.cell().contains(xi, SLACK).then(|| {
                let mut n = [0.0; MOST];
                shape_functions(shape, xi, &mut n);
                Place { nodes: self.part.elements.nodes(element), n }
            })
        })
    }
}

impl Place<'_> {
    /// The value there of a field with one number a node.
    pub fn value(&self, field: &[f64]) -> f64 {
        self.nodes.iter().zip(&self.n).map(|(&node, n)| n * field[node as usize]).sum()
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
