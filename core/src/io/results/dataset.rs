//! Contents of a result file, as plain arrays.

use crate::geometry::Shape;

/// Points, cells on them, and named columns over both.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Dataset {
    /// Id of each point in the mesh.
    pub point_ids: Vec<usize>,
    /// Positions.
    pub points: Vec<[f64; 3]>,
    /// Cells.
    pub cells: Cells,
    /// Columns over the points.
    pub point_data: Vec<Column>,
    /// Columns over the cells.
    pub cell_data: Vec<Column>,
}

/// Cells in flat arrays.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cells {
    /// Id of each cell in the mesh.
    pub ids: Vec<usize>,
    /// Properties id of each cell.
    pub properties: Vec<usize>,
    /// Shape of each cell.
    pub shapes: Vec<Shape>,
    /// Indices of the cells' points, one cell after another, in the node order of the shape.
    pub points: Vec<u32>,
}

impl Cells {
    /// Adds one cell.
    pub fn push(&mut self, id: usize, properties: usize, shape: Shape, points: impl IntoIterator<Item = u32>) {
        self.ids.push(id);
        self.properties.push(properties);
        self.shapes.push(shape);
        self.points.extend(points);
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Shape and point indices of every cell.
    pub fn iter(&self) -> impl Iterator<Item = (Shape, &[u32])> {
        let mut rest = self.points.as_slice();
        self.shapes.iter().map(move |&shape| {
            let (own, others) = rest.split_at(shape.nodes());
            rest = others;
            (shape, own)
        })
    }
}

/// A named quantity over points or cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of the quantity.
    pub name: String,
    /// Numbers a point or cell.
    pub components: usize,
    /// `components` numbers a point or cell.
    pub values: Values,
}

/// Numbers or counts.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Real numbers.
    Real(Vec<f64>),
    /// Whole numbers, as ids.
    Whole(Vec<i32>),
}

impl Values {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Whole(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One of them.
    pub fn get(&self, at: usize) -> f64 {
        match self {
            Self::Real(values) => values[at],
            Self::Whole(values) => values[at].into(),
        }
    }
}

impl Column {
    /// A column of real numbers.
    pub fn real(name: impl Into<String>, components: usize, values: Vec<f64>) -> Self {
        Self { name: name.into(), components, values: Values::Real(values) }
    }

    /// A column of ids.
    pub fn ids(name: impl Into<String>, ids: &[usize]) -> Self {
        Self { name: name.into(), components: 1, values: Values::Whole(ids.iter().map(|&id| id as i32).collect()) }
    }
}
