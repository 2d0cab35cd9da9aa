//! Square sparse matrices by rows, with sorted columns.

use crate::parallel;
use crate::prefetch::{AHEAD, prefetch};
use crate::row_sums::{Gathered, NOTHING_GATHERED, row_sums};

/// Rows handled by one task of a product; fixed, so that results do not depend on the number of threads.
const ROWS_PER_TASK: usize = 512;

/// Products of a row that are added side by side, which hides the time that an addition takes.
const SUMS: usize = 8;

/// Rows of a run at most.
const LONGEST_RUN: usize = 3;

/// Successive rows of a matrix that have the same columns.
#[derive(Debug, Clone, Default)]
pub(crate) struct Runs {
    lengths: Vec<u8>,
    /// First run of each task, and the number of runs.
    tasks: Vec<usize>,
}

impl Runs {
    fn of_task(&self, task: usize) -> &[u8] {
        &self.lengths[self.tasks[task]..self.tasks[task + 1]]
    }
}

/// A square sparse matrix by rows; columns of a row ascend and occur once.
///
/// `row_starts` has `rows + 1` entries; the entries of row `i` are `row_starts[i]..row_starts[i + 1]` of `values`, and of `columns`, too,
/// unless rows share theirs, as those of a node may: [`Csr::columns_of`] gives them either way.
#[derive(Debug, Clone, PartialEq)]
pub struct Csr {
    /// Number of rows and of columns.
    pub rows: usize,
    /// Where each row starts, and the number of entries at the end.
    pub row_starts: Vec<usize>,
    /// Column of each entry, or columns that rows share.
    pub columns: Vec<u32>,
    /// Where the columns of each row begin; empty where each entry has its own.
    pub(crate) column_starts: Vec<usize>,
    /// Value of each entry.
    pub values: Vec<f64>,
}

impl Default for Csr {
    fn default() -> Self {
        Self::empty(0)
    }
}

impl Csr {
    fn nothing() -> Self {
        Self { rows: 0, row_starts: Vec::new(), columns: Vec::new(), column_starts: Vec::new(), values: Vec::new() }
    }

    /// A matrix of `rows` rows without entries.
    pub fn empty(rows: usize) -> Self {
        Self { rows, row_starts: vec![0; rows + 1], ..Self::nothing() }
    }

    /// A zero matrix whose row `i` has the columns `adjacency[i]`, in any order and possibly repeated.
    ///
    /// # Panics
    /// When a column is not below the number of rows.
    pub fn from_pattern(adjacency: &[Vec<u32>]) -> Self {
        let rows = adjacency.len();
        let sorted: Vec<Vec<u32>> = parallel::map(rows, ROWS_PER_TASK, |i| {
            let mut row = adjacency[i].clone();
            row.sort_unstable();
            row.dedup();
            assert!(row.last().is_none_or(|&column| (column as usize) < rows), "column out of range");
            row
        });
        let mut row_starts = Vec::with_capacity(rows + 1);
        row_starts.push(0);
        let mut entries = 0;
        for row in &sorted {
            entries += row.len();
            row_starts.push(entries);
        }
        Self { rows, row_starts, columns: sorted.concat(), values: vec![0.0; entries], ..Self::nothing() }
    }

    /// A zero matrix of a pattern whose rows are already sorted and free of repetitions.
    ///
    /// # Panics
    /// When the lengths do not fit, or the columns of a row do not ascend or are out of range.
    pub fn from_sorted_pattern(row_starts: Vec<usize>, columns: Vec<u32>) -> Self {
        assert_eq!(row_starts.last(), Some(&columns.len()), "row_starts ends with the number of entries");
        let (rows, values) = (row_starts.len() - 1, vec![0.0; columns.len()]);
        Self { rows, row_starts, columns, values, ..Self::nothing() }.checked()
    }

    /// As [`Csr::from_sorted_pattern`] where rows share their columns: those of a row begin at its place of `column_starts`. It has no
    /// values: for those who keep them elsewhere.
    ///
    /// # Panics
    /// As there.
    pub fn with_shared_columns(row_starts: Vec<usize>, columns: Vec<u32>, column_starts: Vec<usize>) -> Self {
        assert_eq!(row_starts.len(), column_starts.len() + 1, "one start of columns for each row");
        let rows = column_starts.len();
        Self { rows, row_starts, columns, column_starts, ..Self::nothing() }.checked()
    }

    /// The same matrix, with its columns checked.
    fn checked(self) -> Self {
        parallel::ranges(self.rows, ROWS_PER_TASK, &|rows| {
            for i in rows {
                let row = self.columns_of(i);
                if i > 0 && std::ptr::eq(row, self.columns_of(i - 1)) {
                    continue;
                }
                assert!(row.windows(2).all(|pair| pair[0] < pair[1]), "columns of row {i} ascend");
                assert!(
                    row.last().is_none_or(|&column| (column as usize) < self.rows),
                    "column out of range in row {i}"
                );
            }
        });
        self
    }

    /// The same matrix, each entry with a column of its own.
    pub(crate) fn with_own_columns(&self) -> Self {
        let (row_starts, values) = (self.row_starts.clone(), self.values.clone());
        Self { rows: self.rows, row_starts, columns: self.columns_of_entries().collect(), values, ..Self::nothing() }
    }

    /// The matrix with the sum of all `(row, column, value)` given.
    ///
    /// # Panics
    /// When a row or column is not below `rows`.
    pub fn from_triplets(rows: usize, triplets: &[(usize, usize, f64)]) -> Self {
        let mut adjacency = vec![Vec::new(); rows];
        for &(i, j, _) in triplets {
            adjacency[i].push(j as u32);
        }
        let mut matrix = Self::from_pattern(&adjacency);
        for &(i, j, value) in triplets {
            matrix.add(i, j, value);
        }
        matrix
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.row_starts[self.rows]
    }

    /// Sets every stored value to zero and keeps the pattern.
    pub fn zero(&mut self) {
        parallel::parts_mut(&mut self.values, 1 << 15, &|_, chunk| chunk.fill(0.0));
    }

    /// Columns and values of row `i`.
    #[inline]
    pub fn row(&self, i: usize) -> (&[u32], &[f64]) {
        (self.columns_of(i), &self.values[self.row_starts[i]..self.row_starts[i + 1]])
    }

    /// Columns of row `i`, ascending.
    #[inline]
    pub fn columns_of(&self, i: usize) -> &[u32] {
        let begin = self.first_column(i);
        &self.columns[begin..begin + (self.row_starts[i + 1] - self.row_starts[i])]
    }

    /// Column of each entry, row after row.
    pub fn columns_of_entries(&self) -> impl Iterator<Item = u32> {
        (0..self.rows).flat_map(|i| self.columns_of(i)).copied()
    }

    #[inline]
    fn first_column(&self, i: usize) -> usize {
        if self.column_starts.is_empty() { self.row_starts[i] } else { self.column_starts[i] }
    }

    /// Position of entry `(i, j)` in `values`, or `None` outside the pattern.
    #[inline]
    pub fn find(&self, i: usize, j: usize) -> Option<usize> {
        self.columns_of(i).binary_search(&(j as u32)).ok().map(|at| self.row_starts[i] + at)
    }

    /// Value of entry `(i, j)`; zero outside the pattern.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.find(i, j).map_or(0.0, |at| self.values[at])
    }

    /// Adds `value` to entry `(i, j)`.
    ///
    /// # Panics
    /// When `(i, j)` is outside the pattern.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let Some(at) = self.find(i, j) else { panic!("entry ({i}, {j}) is outside the pattern") };
        self.values[at] += value;
    }

    /// The diagonal; zero where the pattern has none.
    pub fn diagonal(&self) -> Vec<f64> {
        (0..self.rows).map(|i| self.get(i, i)).collect()
    }

    /// Asks for the memory at the start of a row, if there is such a row.
    #[inline]
    pub(crate) fn prefetch_row(&self, row: usize) {
        if row < self.rows {
            self.prefetch_entry(row, 0);
        }
    }

    /// Asks for the memory around the diagonal of a row, if there is such a row.
    #[inline]
    pub(crate) fn prefetch_diagonal(&self, row: usize) {
        if row < self.rows {
            self.prefetch_entry(row, (self.row_starts[row + 1] - self.row_starts[row]) / 2);
        }
    }

    #[inline]
    fn prefetch_entry(&self, row: usize, at: usize) {
        prefetch(&self.columns[self.first_column(row) + at..], 0);
        prefetch(&self.values[self.row_starts[row] + at..], 0);
    }

    /// `y = A x`, the same bits on any number of threads.
    ///
    /// # Panics
    /// When `x` or `y` has not `rows` entries.
    pub fn mul_vec(&self, x: &[f64], y: &mut [f64]) {
        self.apply(&self.values, x, y, |sum, _| sum);
    }

    /// `y += A x`, the same bits on any number of threads.
    ///
    /// # Panics
    /// When `x` or `y` has not `rows` entries.
    pub fn mul_vec_add(&self, x: &[f64], y: &mut [f64]) {
        self.apply(&self.values, x, y, |sum, old| old + sum);
    }

    /// `y -= A x`, the same bits on any number of threads.
    ///
    /// # Panics
    /// When `x` or `y` has not `rows` entries.
    pub fn mul_vec_subtract(&self, x: &[f64], y: &mut [f64]) {
        self.apply(&self.values, x, y, |sum, old| old - sum);
    }

    /// `y -= B x` for the matrix B with this pattern and other values.
    ///
    /// # Panics
    /// When `x` or `y` has not `rows` entries, or `values` not one for each entry.
    pub fn mul_vec_subtract_with(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        assert_eq!(values.len(), self.entries(), "length of values");
        self.apply(values, x, y, |sum, old| old - sum);
    }

    fn apply(&self, all: &[f64], x: &[f64], y: &mut [f64], combine: impl Fn(f64, f64) -> f64 + Sync) {
        assert_eq!(x.len(), self.rows, "length of x");
        assert_eq!(y.len(), self.rows, "length of y");
        parallel::parts_mut(y, ROWS_PER_TASK, &|first, out| {
            let mut gathered = NOTHING_GATHERED;
            for (row, value) in (first..).zip(out) {
                let columns = self.columns_of(row);
                // A matrix of contact has rows at interfaces only.
                let sum = if columns.is_empty() {
                    0.0
                } else {
                    let values = &all[self.row_starts[row]..self.row_starts[row + 1]];
                    row_sums(columns, [values], x, &mut gathered)[0]
                };
                *value = combine(sum, *value);
            }
        });
    }

    /// Adds `|A| x` to `out` for several x at once, for the matrix A with this pattern and these values.
    ///
    /// # Panics
    /// When an `x` or `out` has not `rows` entries, or `values` not one for each entry.
    pub fn add_products_of_sizes<const N: usize>(&self, values: &[f64], x: [&[f64]; N], out: [&mut [f64]; N]) {
        assert_eq!(values.len(), self.entries(), "length of values");
        assert!(x.iter().all(|x| x.len() == self.rows), "length of x");
        let sums = |row: usize| {
            let (columns, values) = (self.columns_of(row), &values[self.row_starts[row]..self.row_starts[row + 1]]);
            let mut sums = [[0.0; SUMS]; N];
            for (columns, values) in columns.chunks(SUMS).zip(values.chunks(SUMS)) {
                prefetch(columns, AHEAD / 2);
                prefetch(values, AHEAD);
                for (lane, (&column, value)) in columns.iter().zip(values).enumerate() {
                    (0..N).for_each(|n| sums[n][lane] += value.abs() * x[n][column as usize]);
                }
            }
            sums.map(|sums| sums.iter().sum::<f64>())
        };
        let found: Vec<[f64; N]> = parallel::map(self.rows, ROWS_PER_TASK, sums);
        for (n, out) in out.into_iter().enumerate() {
            parallel::parts_mut(out, ROWS_PER_TASK, &|first, out| {
                out.iter_mut().zip(&found[first..]).for_each(|(out, sums)| *out += sums[n]);
            });
        }
    }

    /// Lengths of the runs of up to [`LONGEST_RUN`] rows with the same columns that the rows fall into, as those of a node do;
    /// no run crosses the border of a task.
    pub(crate) fn runs(&self) -> Runs {
        let of_task = |task: usize| {
            let end = ((task + 1) * ROWS_PER_TASK).min(self.rows);
            let (mut lengths, mut row) = (Vec::with_capacity(ROWS_PER_TASK / 2), task * ROWS_PER_TASK);
            while row < end {
                let columns = self.columns_of(row);
                let most = LONGEST_RUN.min(end - row);
                let is_other = |k: &usize| !are_same(self.columns_of(row + k), columns);
                let length = (1..most).find(is_other).unwrap_or(most);
                lengths.push(length as u8);
                row += length;
            }
            lengths
        };
        let parts: Vec<Vec<u8>> = parallel::map(self.rows.div_ceil(ROWS_PER_TASK), 1, of_task);
        let mut tasks = vec![0];
        parts.iter().for_each(|part| tasks.push(tasks[tasks.len() - 1] + part.len()));
        Runs { lengths: parts.concat(), tasks }
    }

    /// As [`Csr::mul_vec`], to the bit, with the columns of each of `runs` read once.
    pub(crate) fn mul_vec_by_runs(&self, runs: &Runs, x: &[f64], y: &mut [f64]) {
        assert_eq!(x.len(), self.rows, "length of x");
        assert_eq!(y.len(), self.rows, "length of y");
        parallel::parts_mut(y, ROWS_PER_TASK, &|first, mut out| {
            let mut gathered = NOTHING_GATHERED;
            let mut row = first;
            for &length in runs.of_task(first / ROWS_PER_TASK) {
                let (now, rest) = std::mem::take(&mut out).split_at_mut(length as usize);
                self.run_product(row, x, now, &mut gathered);
                row += length as usize;
                out = rest;
            }
        });
    }

    /// The product of as many rows as `out` has, with the columns of the first.
    #[inline(always)]
    fn run_product(&self, row: usize, x: &[f64], out: &mut [f64], gathered: &mut Gathered) {
        let columns = self.columns_of(row);
        let values = |k: usize| self.row(row + k).1;
        match out {
            [a, b, c] => [*a, *b, *c] = row_sums(columns, [values(0), values(1), values(2)], x, gathered),
            [a, b] => [*a, *b] = row_sums(columns, [values(0), values(1)], x, gathered),
            rows => [rows[0]] = row_sums(columns, [values(0)], x, gathered),
        }
    }

    /// The transposed matrix.
    pub fn transpose(&self) -> Self {
        let mut row_starts = vec![0; self.rows + 1];
        for j in self.columns_of_entries() {
            row_starts[j as usize + 1] += 1;
        }
        for i in 0..self.rows {
            row_starts[i + 1] += row_starts[i];
        }
        let mut next = row_starts.clone();
        let mut columns = vec![0; self.entries()];
        let mut values = vec![0.0; self.entries()];
        for i in 0..self.rows {
            let (row_columns, row_values) = self.row(i);
            for (&j, &value) in row_columns.iter().zip(row_values) {
                let at = &mut next[j as usize];
                columns[*at] = i as u32;
                values[*at] = value;
                *at += 1;
            }
        }
        Self { rows: self.rows, row_starts, columns, values, ..Self::nothing() }
    }

    /// `self + other` on the union of both patterns.
    ///
    /// # Panics
    /// When the sizes differ.
    pub fn plus(&self, other: &Self) -> Self {
        assert_eq!(self.rows, other.rows, "matrices of one size");
        let parts: Vec<Self> = parallel::map(self.rows.div_ceil(ROWS_PER_TASK), 1, |task| self.rows_plus(other, task));
        let entries = parts.iter().map(Self::entries).sum();
        let mut sum = Self::empty(0);
        sum.row_starts.reserve(self.rows);
        sum.columns.reserve(entries);
        sum.values.reserve(entries);
        for part in parts {
            let before = sum.columns.len();
            sum.row_starts.extend(part.row_starts[1..].iter().map(|start| before + start));
            sum.columns.extend(part.columns);
            sum.values.extend(part.values);
        }
        Self { rows: self.rows, ..sum }
    }

    /// The rows of one task of the sum.
    fn rows_plus(&self, other: &Self, task: usize) -> Self {
        let rows = task * ROWS_PER_TASK..((task + 1) * ROWS_PER_TASK).min(self.rows);
        let mut sum = Self::empty(rows.len());
        let entries = |matrix: &Self| matrix.row_starts[rows.end] - matrix.row_starts[rows.start];
        sum.columns.reserve(entries(self) + entries(other));
        sum.values.reserve(entries(self) + entries(other));
        for (at, i) in rows.enumerate() {
            let (a_columns, a_values) = self.row(i);
            let (b_columns, b_values) = other.row(i);
            let (mut a, mut b) = (0, 0);
            if a_columns.is_empty() || b_columns.is_empty() {
                sum.columns.extend(a_columns.iter().chain(b_columns));
                sum.values.extend(a_values.iter().chain(b_values));
                (a, b) = (a_columns.len(), b_columns.len());
            }
            while a < a_columns.len() || b < b_columns.len() {
                let a_column = a_columns.get(a).copied().unwrap_or(u32::MAX);
                let b_column = b_columns.get(b).copied().unwrap_or(u32::MAX);
                let column = a_column.min(b_column);
                let mut value = 0.0;
                if a_column == column {
                    value += a_values[a];
                    a += 1;
                }
                if b_column == column {
                    value += b_values[b];
                    b += 1;
                }
                sum.columns.push(column);
                sum.values.push(value);
            }
            sum.row_starts[at + 1] = sum.columns.len();
        }
        sum
    }
}

/// Whether two rows have the same columns.
pub(crate) fn are_same(a: &[u32], b: &[u32]) -> bool {
    std::ptr::eq(a, b) || a == b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_sizes_are_added() {
        let n = 40;
        let entry = |i: usize, j: usize| ((i * 7 + j * 3) % 11) as f64 - 5.0;
        let all = (0..n).flat_map(|i| (0..n).filter(move |j| (i + j) % 3 > 0).map(move |j| (i, j, entry(i, j))));
        let matrix = Csr::from_triplets(n, &all.collect::<Vec<_>>());
        let x: [Vec<f64>; 2] = [2, 5].map(|k| (0..n).map(|i| (i % k) as f64).collect());
        let mut out = [vec![1.0; n], vec![-1.0; n]];
        let [a, b] = &mut out;
        matrix.add_products_of_sizes(&matrix.values, [&x[0], &x[1]], [a, b]);
        for (i, (a, b)) in out[0].iter().zip(&out[1]).enumerate() {
            let exact =
                |x: &[f64]| matrix.row(i).0.iter().map(|&j| entry(i, j as usize).abs() * x[j as usize]).sum::<f64>();
            assert_eq!([*a, *b], [1.0 + exact(&x[0]), -1.0 + exact(&x[1])], "{i}");
        }
    }

    #[test]
    fn pattern_is_sorted_and_unique() {
        let matrix = Csr::from_pattern(&[vec![2, 0, 2], vec![], vec![1]]);
        assert_eq!(matrix.row_starts, [0, 2, 2, 3]);
        assert_eq!(matrix.columns, [0, 2, 1]);
        assert_eq!((matrix.find(0, 2), matrix.find(1, 1)), (Some(1), None));
    }

    #[test]
    fn rows_that_share_columns_are_those_that_have_their_own() {
        let own =
            Csr { values: (0..6).map(f64::from).collect(), ..Csr::from_pattern(&[vec![0, 2], vec![0, 2], vec![0, 2]]) };
        let shared = Csr::with_shared_columns(vec![0, 2, 4, 6], vec![0, 2], vec![0; 3]);
        let shared = Csr { values: own.values.clone(), ..shared };
        assert_eq!((shared.entries(), shared.find(2, 2), shared.find(2, 1)), (6, Some(5), None));
        assert!((0..3).all(|i| shared.row(i) == own.row(i)));
        assert_eq!(shared.with_own_columns(), own);
        assert_eq!(shared.transpose(), own.transpose());
        assert_eq!(shared.plus(&own), own.plus(&own));
        let (mut a, mut b) = ([0.0; 3], [0.0; 3]);
        own.mul_vec(&[1.0, 2.0, 3.0], &mut a);
        shared.mul_vec(&[1.0, 2.0, 3.0], &mut b);
        assert_eq!(a, b);
    }

    #[test]
    fn products_by_runs_are_the_same_to_the_bit() {
        let n = 1300;
        let of_node =
            |i: usize| -> Vec<u32> { [0, i / 3 * 3, i / 3 * 3 + 1, n - 1].map(|j| j.min(n - 1) as u32).into() };
        let mut matrix = Csr::from_pattern(&(0..n).map(of_node).collect::<Vec<_>>());
        matrix.values.iter_mut().enumerate().for_each(|(k, v)| *v = (k as f64 * 0.7).sin());
        let x: Vec<f64> = (0..n).map(|i| (i as f64 * 0.3).cos()).collect();
        let (mut y, mut by_runs) = (vec![0.0; n], vec![0.0; n]);
        matrix.mul_vec(&x, &mut y);
        let runs = matrix.runs();
        matrix.mul_vec_by_runs(&runs, &x, &mut by_runs);
        assert!(y.iter().zip(&by_runs).all(|(a, b)| a.to_bits() == b.to_bits()));
        assert!(runs.lengths.len() < n / 2, "{} runs", runs.lengths.len());
    }

    #[test]
    fn products_transposes_and_sums_agree() {
        let a = Csr::from_triplets(3, &[(0, 0, 1.0), (0, 2, 2.0), (2, 1, 3.0)]);
        let b = Csr::from_triplets(3, &[(0, 2, 1.0), (1, 1, 5.0)]);
        let mut y = [0.0; 3];
        a.mul_vec(&[1.0, 10.0, 100.0], &mut y);
        assert_eq!(y, [201.0, 0.0, 30.0]);
        a.transpose().mul_vec_subtract(&[1.0, 1.0, 1.0], &mut y);
        assert_eq!(y, [200.0, -3.0, 28.0]);
        let sum = a.plus(&b);
        assert_eq!((sum.get(0, 2), sum.get(1, 1), sum.get(2, 1), sum.entries()), (3.0, 5.0, 3.0, 4));
    }
}
