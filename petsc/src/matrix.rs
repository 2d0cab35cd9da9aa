//! The rows of a distributed matrix that one rank owns.

use zelus_linear_algebra::{SolveError, Symmetry};

use crate::ffi;
use crate::session::Communicator;

/// The rows this rank owns, in compressed form; columns count over all ranks.
///
/// Rank 0 owns the first rows, rank 1 those after them, and so on. Both triangles are given, also of a symmetric matrix.
/// The stamps promise, where they equal those of the previous solve with the same solver, that pattern or values are
/// unchanged; they are the same on all ranks.
#[derive(Debug, Clone, Copy)]
pub struct DistributedMatrix<'a> {
    /// Number of the first owned row over all ranks.
    pub first_row: u64,
    /// Where each owned row begins in `columns` and `values`; one more than there are rows.
    pub row_starts: &'a [usize],
    /// Column of each entry, ascending within a row.
    pub columns: &'a [u64],
    /// Value of each entry.
    pub values: &'a [f64],
    /// Symmetry of the matrix.
    pub symmetry: Symmetry,
    /// Whether some equations, on any rank, are those of multipliers.
    pub has_multipliers: bool,
    /// Where the equations are, for multigrid; `None` leaves it with constants.
    pub modes: Option<&'a RigidModes>,
    /// Stamp of the pattern.
    pub graph: u64,
    /// Stamp of the values.
    pub stamp: u64,
}

impl DistributedMatrix<'_> {
    /// Number of owned rows.
    pub fn rows(&self) -> usize {
        self.row_starts.len().saturating_sub(1)
    }

    /// Number of rows of all ranks, once all ranks have found their rows in order. Collective.
    ///
    /// # Errors
    /// [`SolveError::Failed`] on all ranks, naming the first thing wrong where it is.
    pub(crate) fn check(&self, comm: Communicator) -> Result<u64, SolveError> {
        let (before, all) = comm.count(self.rows() as i64);
        let problem = self.problem(before as u64, all as u64);
        if comm.all(problem.is_none()) {
            return Ok(all as u64);
        }
        Err(SolveError::Failed(match problem {
            Some(problem) => format!("matrix: {problem}"),
            None => "matrix: the rows of another rank are not in order".to_owned(),
        }))
    }

    fn problem(&self, before: u64, all: u64) -> Option<String> {
        let rows = self.rows();
        if self.first_row != before {
            return Some(format!("the first row is {}, the ranks before have {before}", self.first_row));
        }
        if self.row_starts.first() != Some(&0) || self.row_starts.last() != Some(&self.columns.len()) {
            return Some("the rows do not cover the entries".to_owned());
        }
        if self.values.len() != self.columns.len() {
            return Some(format!("{} values for {} columns", self.values.len(), self.columns.len()));
        }
        if let Some(modes) = self.modes
            && (modes.coordinates.len() != rows || modes.components.len() != rows)
        {
            return Some(format!("coordinates of {} equations for {rows} rows", modes.coordinates.len()));
        }
        for row in 0..rows {
            let (from, to) = (self.row_starts[row], self.row_starts[row + 1]);
            let number = self.first_row + row as u64;
            let Some(columns) = self.columns.get(from..to) else {
                return Some(format!("row {number} ends before it begins"));
            };
            if columns.windows(2).any(|pair| pair[0] >= pair[1]) {
                return Some(format!("the columns of row {number} do not ascend"));
            }
            if columns.last().is_some_and(|&last| last >= all) {
                return Some(format!("row {number} has a column beyond the {all} of the matrix"));
            }
        }
        // SAFETY: compares numbers.
        let fits = |largest: usize| unsafe { ffi::zp_fits(largest as i64) } != 0;
        if !fits(all as usize) || !fits(self.columns.len() + rows) {
            return Some(format!("{all} equations are more than this PETSc counts: it needs 64-bit indices"));
        }
        let wrong = self.values.iter().position(|value| !value.is_finite())?;
        let row = self.row_starts.partition_point(|&start| start <= wrong) - 1;
        let (row, column) = (self.first_row + row as u64, self.columns[wrong]);
        Some(format!("entry ({row}, {column}) is {}", self.values[wrong]))
    }
}

/// The motions of a body without strain, as the equations see them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RigidModes {
    /// Dimensions of the space: 2 or 3.
    pub dimension: usize,
    /// Position of the node of each owned equation.
    pub coordinates: Vec<[f64; 3]>,
    /// Direction of each owned equation, 0 to 2; any other value for one that rigid-body modes do not move.
    pub components: Vec<u8>,
}

impl RigidModes {
    /// The motions, one after another, each with a value for every owned equation; rotations about `centre`.
    pub(crate) fn vectors(&self, centre: [f64; 3]) -> Vec<Vec<f64>> {
        let translations = 0..self.dimension;
        let rotations: &[(usize, usize)] = if self.dimension == 2 { &[(0, 1)] } else { &[(0, 1), (1, 2), (2, 0)] };
        let equations = || self.coordinates.iter().zip(&self.components);
        let translated = |axis: usize| equations().map(|(_, &c)| f64::from(usize::from(c) == axis)).collect();
        let rotated = |&(a, b): &(usize, usize)| {
            let value = |(x, &c): (&[f64; 3], &u8)| match usize::from(c) {
                c if c == a => centre[b] - x[b],
                c if c == b => x[a] - centre[a],
                _ => 0.0,
            };
            equations().map(value).collect()
        };
        translations.map(translated).chain(rotations.iter().map(rotated)).collect()
    }
}

/// The entries as PETSc takes them: each row with its diagonal.
pub(crate) struct Packed {
    pub(crate) starts: Vec<i64>,
    pub(crate) columns: Vec<i64>,
    pub(crate) values: Vec<f64>,
    /// Where each given value goes; empty when all rows had their diagonal.
    slots: Vec<usize>,
}

impl Packed {
    /// MUMPS' interface finds the upper triangle from the diagonals on and would lose a row without one.
    pub(crate) fn new(matrix: &DistributedMatrix<'_>) -> Self {
        let mut packed = Self { starts: vec![0], columns: Vec::new(), values: Vec::new(), slots: Vec::new() };
        let mut added = false;
        for row in 0..matrix.rows() {
            let own = matrix.first_row + row as u64;
            let entries = matrix.row_starts[row]..matrix.row_starts[row + 1];
            let columns = &matrix.columns[entries.clone()];
            let before = columns.partition_point(|&column| column < own);
            let missing = columns.get(before) != Some(&own);
            added |= missing;
            for (at, (&column, &value)) in columns.iter().zip(&matrix.values[entries]).enumerate() {
                if missing && at == before {
                    packed.push(own, 0.0);
                }
                packed.slots.push(packed.columns.len());
                packed.push(column, value);
            }
            if missing && before == columns.len() {
                packed.push(own, 0.0);
            }
            packed.starts.push(packed.columns.len() as i64);
        }
        if !added {
            packed.slots = Vec::new();
        }
        packed
    }

    fn push(&mut self, column: u64, value: f64) {
        self.columns.push(column as i64);
        self.values.push(value);
    }

    /// New values on the same pattern.
    pub(crate) fn refill(&mut self, values: &[f64]) {
        if self.slots.is_empty() {
            self.values.copy_from_slice(values);
        } else {
            self.slots.iter().zip(values).for_each(|(&slot, &value)| self.values[slot] = value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix<'a>(row_starts: &'a [usize], columns: &'a [u64], values: &'a [f64]) -> DistributedMatrix<'a> {
        DistributedMatrix {
            first_row: 4,
            row_starts,
            columns,
            values,
            symmetry: Symmetry::General,
            has_multipliers: false,
            modes: None,
            graph: 0,
            stamp: 0,
        }
    }

    #[test]
    fn missing_diagonals_are_added_and_kept_at_zero() {
        let matrix = matrix(&[0, 2, 2, 3], &[0, 5, 6], &[1.0, 2.0, 3.0]);
        let mut packed = Packed::new(&matrix);
        assert_eq!(packed.starts, [0, 3, 4, 5]);
        assert_eq!(packed.columns, [0, 4, 5, 5, 6]);
        packed.refill(&[7.0, 8.0, 9.0]);
        assert_eq!(packed.values, [7.0, 0.0, 8.0, 0.0, 9.0]);
    }

    #[test]
    fn rows_out_of_order_are_named() {
        let problem = |starts: &[usize], columns: &[u64], values: &[f64]| matrix(starts, columns, values).problem(4, 8);
        assert_eq!(problem(&[0, 1, 2], &[4, 5], &[1.0, 1.0]), None);
        assert!(problem(&[0, 2], &[5, 4], &[1.0, 1.0]).unwrap().contains("row 4 do not ascend"));
        assert!(problem(&[0, 1], &[8], &[1.0]).unwrap().contains("beyond the 8"));
        assert!(problem(&[0, 1], &[4], &[f64::NAN]).unwrap().contains("(4, 4) is NaN"));
    }

    #[test]
    fn rigid_modes_of_space_are_six() {
        let modes = RigidModes { dimension: 3, coordinates: vec![[1.0, 2.0, 3.0]; 3], components: vec![0, 1, 2] };
        let vectors = modes.vectors([0.0; 3]);
        assert_eq!(vectors.len(), 6);
        assert_eq!(vectors[3], [-2.0, 1.0, 0.0]);
        assert_eq!(vectors[4], [0.0, -3.0, 2.0]);
        assert_eq!(vectors[5], [3.0, 0.0, -1.0]);
    }
}
