//! Structured meshes of any shape over the unit square or cube, mapped.

use std::collections::BTreeMap;

use zelus_core::geometry::{Shape, mapping};

pub type Vec3 = [f64; 3];

/// A mesh of one shape.
pub struct Grid {
    pub shape: Shape,
    /// Positions.
    pub nodes: Vec<Vec3>,
    /// Positions in the unit square or cube before the map.
    pub reference: Vec<Vec3>,
    pub cells: Vec<Vec<usize>>,
}

/// Corners of the linear cells that fill one square or cube, as bits x + 2 y + 4 z.
fn pieces(corners: usize, dim: usize) -> Vec<Vec<usize>> {
    match (dim, corners) {
        (2, 4) => vec![vec![0, 1, 3, 2]],
        (2, 3) => vec![vec![0, 1, 3], vec![0, 3, 2]],
        (3, 8) => vec![vec![0, 1, 3, 2, 4, 5, 7, 6]],
        // around the corner 0
        (3, 5) => vec![vec![1, 5, 7, 3, 0], vec![2, 3, 7, 6, 0], vec![4, 6, 7, 5, 0]],
        (3, 6) => vec![vec![0, 1, 3, 4, 5, 7], vec![0, 3, 2, 4, 7, 6]],
        // around the diagonal 0-7, one for each order of the axes
        _ => [[1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]].iter().map(|[a, b]| vec![0, *a, *b, 7]).collect(),
    }
}

impl Grid {
    /// `divisions` cells along the axes, mapped from the unit square or cube.
    pub fn new(shape: Shape, divisions: &[usize], map: impl Fn(Vec3) -> Vec3) -> Self {
        let (dim, corners) = (shape.dim(), shape.cell().corners());
        let linear = Shape::of(dim, corners).expect("the linear shape of the same cell");
        let mut grid = Self { shape, nodes: Vec::new(), reference: Vec::new(), cells: Vec::new() };
        let mut known: BTreeMap<[i64; 3], usize> = BTreeMap::new();
        let count = |axis: usize| divisions.get(axis).copied().unwrap_or(1);
        for index in 0..count(0) * count(1) * count(2) {
            let base = [index % count(0), index / count(0) % count(1), index / count(0) / count(1)];
            // Pyramids of neighbours are mirror images, so that their faces meet.
            let mirrored = if corners == 5 { (0..3).map(|a| (base[a] % 2) << a).sum() } else { 0_usize };
            for mut piece in pieces(corners, dim) {
                if mirrored.count_ones() % 2 == 1 {
                    piece.swap(1, 3);
                }
                let corner = |bits: usize| -> Vec3 {
                    std::array::from_fn(|a| match a < dim {
                        true => (base[a] + ((bits ^ mirrored) >> a & 1)) as f64 / count(a) as f64,
                        false => 0.0,
                    })
                };
                let skeleton: Vec<Vec3> = piece.iter().map(|&bits| corner(bits)).collect();
                let nodes = shape.cell().points.iter().map(|xi| {
                    let at = mapping::position(linear, &skeleton, *xi);
                    let key = at.map(|x| (x * 1e7).round() as i64);
                    *known.entry(key).or_insert_with(|| {
                        grid.reference.push(at);
                        grid.nodes.push(map(at));
                        grid.nodes.len() - 1
                    })
                });
                let cell = nodes.collect();
                grid.cells.push(cell);
            }
        }
        grid
    }

    /// The nodes whose place in the unit square or cube is wanted.
    pub fn nodes_where(&self, wanted: impl Fn(Vec3) -> bool) -> Vec<usize> {
        (0..self.nodes.len()).filter(|&node| wanted(self.reference[node])).collect()
    }

    /// The facets all of whose nodes are wanted, ordered as the cell orders them, outward.
    pub fn facets_where(&self, wanted: impl Fn(Vec3) -> bool) -> Vec<(Shape, Vec<usize>)> {
        let mut found = Vec::new();
        let cell = self.shape.cell();
        for nodes in &self.cells {
            let facets = if cell.dim == 2 { cell.edges } else { cell.faces };
            for facet in facets {
                let own: Vec<usize> = facet.nodes.iter().map(|&i| nodes[i]).collect();
                if own.iter().all(|&node| wanted(self.reference[node])) {
                    found.push((facet.shape, own));
                }
            }
        }
        found
    }

    /// √∫ |u_h − u|² over the mesh, `u_h` given at the nodes.
    pub fn l2_error(&self, values: &[Vec3], exact: impl Fn(Vec3) -> Vec3) -> f64 {
        let table = zelus_core::geometry::ShapeTable::get(self.shape, zelus_core::geometry::MAX_ORDER);
        let mut sum = 0.0;
        for cell in &self.cells {
            let x: Vec<Vec3> = cell.iter().map(|&node| self.nodes[node]).collect();
            for (g, point) in table.points().iter().enumerate() {
                let interpolate = |of: &dyn Fn(usize) -> Vec3| -> Vec3 {
                    let mut out = [0.0; 3];
                    for (i, n) in table.n_at(g).iter().enumerate() {
                        (0..3).for_each(|a| out[a] += n * of(i)[a]);
                    }
                    out
                };
                let found = interpolate(&|i| values[cell[i]]);
                let wanted = exact(interpolate(&|i| x[i]));
                let error: f64 = (0..3).map(|a| (found[a] - wanted[a]).powi(2)).sum();
                sum += point.weight * mapping::det_jacobian(self.shape, &x, point.xi) * error;
            }
        }
        sum.sqrt()
    }
}
