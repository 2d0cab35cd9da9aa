//! What a result file shows, as plain arrays.

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

impl Dataset {
    /// The cells chosen by position, with the points they use, and the chosen points that no cell at all uses.
    ///
    /// Pieces whose choices share out all cells and points hold everything; points where pieces meet are in several.
    pub fn piece(&self, has_cell: impl Fn(usize) -> bool, has_point: impl Fn(usize) -> bool) -> Self {
        let (mut is_used, mut is_own) = (vec![false; self.points.len()], vec![false; self.points.len()]);
        let mut cells = Vec::new();
        for (at, (_, points)) in self.cells.iter().enumerate() {
            let has = has_cell(at);
            cells.extend(has.then_some(at));
            for &point in points {
                is_used[point as usize] = true;
                is_own[point as usize] |= has;
            }
        }
        let chosen = |&at: &usize| is_own[at] || (!is_used[at] && has_point(at));
        let points: Vec<usize> = (0..self.points.len()).filter(chosen).collect();
        let mut new = vec![0_u32; self.points.len()];
        points.iter().enumerate().for_each(|(at, &point)| new[point] = at as u32);
        let mut out = Self {
            point_ids: points.iter().map(|&at| self.point_ids[at]).collect(),
            points: points.iter().map(|&at| self.points[at]).collect(),
            point_data: self.point_data.iter().map(|column| column.rows(&points)).collect(),
            cell_data: self.cell_data.iter().map(|column| column.rows(&cells)).collect(),
            ..Self::default()
        };
        for (at, (shape, points)) in self.cells.iter().enumerate().filter(|(at, _)| has_cell(*at)) {
            let points = points.iter().map(|&point| new[point as usize]);
            out.cells.push(self.cells.ids[at], self.cells.properties[at], shape, points);
        }
        out
    }
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

impl Column {
    /// A column of real numbers.
    pub fn real(name: impl Into<String>, components: usize, values: Vec<f64>) -> Self {
        Self { name: name.into(), components, values: Values::Real(values) }
    }

    /// A column of ids.
    pub fn ids(name: impl Into<String>, ids: &[usize]) -> Self {
        Self { name: name.into(), components: 1, values: Values::Whole(ids.iter().map(|&id| id as i32).collect()) }
    }

    /// The rows at these positions.
    fn rows(&self, rows: &[usize]) -> Self {
        fn pick<T: Copy>(values: &[T], components: usize, rows: &[usize]) -> Vec<T> {
            rows.iter().flat_map(|&row| &values[row * components..][..components]).copied().collect()
        }
        let values = match &self.values {
            Values::Real(values) => Values::Real(pick(values, self.components, rows)),
            Values::Whole(values) => Values::Whole(pick(values, self.components, rows)),
        };
        Self { name: self.name.clone(), components: self.components, values }
    }
}
