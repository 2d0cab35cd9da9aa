//! Shape functions at the points of a quadrature rule, computed once for the whole run.

use std::sync::OnceLock;

use super::{MAX_ORDER, QuadraturePoint, Shape, local_gradients, quadrature, shape_functions};

/// Shape functions and local gradients of one shape at a fixed list of points.
#[derive(Debug, Clone)]
pub struct ShapeTable {
    shape: Shape,
    points: Vec<QuadraturePoint>,
    n: Vec<f64>,
    dn: Vec<f64>,
}

impl ShapeTable {
    /// The table of `shape` with the rule of `order`, shared by the whole program; `order` is held to 1..=5.
    pub fn get(shape: Shape, order: usize) -> &'static ShapeTable {
        static TABLES: [[OnceLock<ShapeTable>; MAX_ORDER]; Shape::ALL.len()] =
            [const { [const { OnceLock::new() }; MAX_ORDER] }; Shape::ALL.len()];
        let order = order.clamp(1, MAX_ORDER);
        TABLES[shape as usize][order - 1].get_or_init(|| ShapeTable::at_points(shape, quadrature(shape, order)))
    }

    /// The table of `shape` with the rule its elements use unless told otherwise.
    pub fn default_of(shape: Shape) -> &'static ShapeTable {
        Self::get(shape, shape.cell().default_order)
    }

    /// The table of `shape` with one point at each node (weights 1).
    pub fn at_nodes(shape: Shape) -> &'static ShapeTable {
        static TABLES: [OnceLock<ShapeTable>; Shape::ALL.len()] = [const { OnceLock::new() }; Shape::ALL.len()];
        TABLES[shape as usize].get_or_init(|| {
            let nodes = shape.cell().points.iter().map(|&xi| QuadraturePoint { xi, weight: 1.0 });
            ShapeTable::at_points(shape, nodes.collect())
        })
    }

    /// A table at points of your own.
    pub fn at_points(shape: Shape, points: Vec<QuadraturePoint>) -> ShapeTable {
        let (nodes, dim) = (shape.nodes(), shape.dim());
        let (mut n, mut dn) = (vec![0.0; nodes * points.len()], Vec::with_capacity(nodes * dim * points.len()));
        let mut gradients = [[0.0; 3]; 27];
        for (point, values) in points.iter().zip(n.chunks_exact_mut(nodes)) {
            shape_functions(shape, point.xi, values);
            local_gradients(shape, point.xi, &mut gradients);
            for gradient in &gradients[..nodes] {
                dn.extend_from_slice(&gradient[..dim]);
            }
        }
        ShapeTable { shape, points, n, dn }
    }

    /// The shape the table belongs to.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Number of points.
    #[inline]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether the table has no point.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The points with their weights on the reference cell.
    #[inline]
    pub fn points(&self) -> &[QuadraturePoint] {
        &self.points
    }

    /// Weight of point `g` on the reference cell.
    #[inline]
    pub fn weight(&self, g: usize) -> f64 {
        self.points[g].weight
    }

    /// Values `n()[g][i]` of shape function `i` at point `g`.
    ///
    /// # Panics
    /// If `NODES` is not the number of nodes of the shape.
    #[inline]
    pub fn n<const NODES: usize>(&self) -> &[[f64; NODES]] {
        assert_eq!(self.n.len(), NODES * self.points.len(), "{:?} does not have {NODES} nodes", self.shape);
        self.n.as_chunks::<NODES>().0
    }

    /// Gradients `dn()[g][i][k]` of shape function `i` with respect to local coordinate `k` at point `g`.
    ///
    /// # Panics
    /// If `NODES` or `DIM` is not that of the shape.
    #[inline]
    pub fn dn<const NODES: usize, const DIM: usize>(&self) -> &[[[f64; DIM]; NODES]] {
        assert_eq!(self.dn.len(), NODES * DIM * self.points.len(), "{:?} is not {NODES}×{DIM}", self.shape);
        self.dn.as_chunks::<DIM>().0.as_chunks::<NODES>().0
    }

    /// Values at point `g` as a slice, for code that does not know the shape.
    #[inline]
    pub fn n_at(&self, g: usize) -> &[f64] {
        let nodes = self.shape.nodes();
        &self.n[g * nodes..(g + 1) * nodes]
    }

    /// Gradient of shape function `i` at point `g`, padded with zeros, for code that does not know the shape.
    #[inline]
    pub fn dn_at(&self, g: usize, i: usize) -> [f64; 3] {
        let (nodes, dim) = (self.shape.nodes(), self.shape.dim());
        let mut gradient = [0.0; 3];
        gradient[..dim].copy_from_slice(&self.dn[(g * nodes + i) * dim..][..dim]);
        gradient
    }
}
