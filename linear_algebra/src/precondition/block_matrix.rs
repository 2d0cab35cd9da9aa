//! Sparse matrices of small dense blocks, in single precision: what the levels of multigrid are made of.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::csr::Csr;

/// Block rows of a task; fixed, so that results do not depend on the number of threads.
const ROWS_PER_TASK: usize = 512;

/// No block has more rows or columns.
const LARGEST: usize = 64;

/// Blocks for which rows have room at first, those of hexahedra.
const BLOCKS_OF_A_ROW: usize = 27;

/// Entries behind the last block.
const TAIL: usize = 8;

/// A matrix of `rows × columns` blocks of `height × width` entries, by rows with ascending block columns.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct BlockMatrix {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) height: usize,
    pub(super) width: usize,
    pub(super) starts: Vec<usize>,
    pub(super) indices: Vec<u32>,
    /// Entries of each block by columns, and [`TAIL`] zeros, so that whole vectors can be read.
    pub(super) values: Vec<f32>,
}

impl BlockMatrix {
    /// Whether one that was read can be a matrix.
    pub(super) fn is_sound(&self) -> bool {
        let blocks = self.indices.len();
        let values = self.height.checked_mul(self.width).and_then(|size| size.checked_mul(blocks));
        let ascend = |row: &[usize]| {
            self.indices.get(row[0]..row[1]).is_some_and(|row| row.windows(2).all(|pair| pair[0] < pair[1]))
        };
        self.starts.len() == self.rows + 1
            && self.starts[0] == 0
            && self.starts[self.rows] == blocks
            && self.starts.is_sorted()
            && self.starts.windows(2).all(ascend)
            && self.indices.iter().all(|&column| (column as usize) < self.columns)
            && (1..=LARGEST).contains(&self.height)
            && (1..=LARGEST).contains(&self.width)
            && values.is_some_and(|values| self.values.len() == values + TAIL)
    }
}

/// A block row under way: blocks in the order of their first entry.
pub(super) struct BlockRow {
    place: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f32>,
    size: usize,
}

impl BlockRow {
    /// An empty row over `columns` blocks of `size` entries.
    pub(super) fn new(columns: usize, size: usize) -> Self {
        Self { place: vec![u32::MAX; columns], columns: Vec::new(), values: Vec::new(), size }
    }

    /// Where the entries of a block begin among [`BlockRow::entries`]; they are zero at first.
    pub(super) fn start(&mut self, column: u32) -> usize {
        let at = &mut self.place[column as usize];
        if *at == u32::MAX {
            *at = self.columns.len() as u32;
            self.columns.push(column);
            self.values.resize(self.values.len() + self.size, 0.0);
        }
        *at as usize * self.size
    }

    /// The entries of the blocks so far.
    pub(super) fn entries(&mut self) -> &mut [f32] {
        &mut self.values
    }

    /// The entries of a block, zero at first.
    pub(super) fn block(&mut self, column: u32) -> &mut [f32] {
        let start = self.start(column);
        &mut self.values[start..start + self.size]
    }

    /// The same as a row of another matrix with as many columns; empty before.
    pub(super) fn copy(&mut self, (columns, values): (&[u32], &[f32])) {
        self.columns.extend_from_slice(columns);
        self.values.extend_from_slice(values);
        columns.iter().enumerate().for_each(|(at, &column)| self.place[column as usize] = at as u32);
    }

    /// Appends the blocks in ascending order; the row is empty then.
    pub(super) fn take(&mut self, indices: &mut Vec<u32>, values: &mut Vec<f32>) {
        let first = indices.len();
        indices.extend_from_slice(&self.columns);
        if self.columns.is_sorted() {
            values.extend_from_slice(&self.values);
        } else {
            indices[first..].sort_unstable();
            for &column in &indices[first..] {
                let start = self.place[column as usize] as usize * self.size;
                values.extend_from_slice(&self.values[start..start + self.size]);
            }
        }
        self.columns.drain(..).for_each(|column| self.place[column as usize] = u32::MAX);
        self.values.clear();
    }
}

/// A sparse sum of numbers under way, by places, of which it holds few.
pub(super) struct Sums {
    at: Vec<u32>,
    places: Vec<u32>,
    values: Vec<f64>,
}

impl Sums {
    /// No number yet at any of `places`.
    pub(super) fn new(places: usize) -> Self {
        Self { at: vec![u32::MAX; places], places: Vec::new(), values: Vec::new() }
    }

    /// Adds a number at a place.
    pub(super) fn add(&mut self, place: usize, value: f64) {
        let at = &mut self.at[place];
        if *at == u32::MAX {
            *at = self.places.len() as u32;
            self.places.push(place as u32);
            self.values.push(0.0);
        }
        self.values[*at as usize] += value;
    }

    /// Hands on the sums by ascending places; none is left then.
    pub(super) fn drain(&mut self, mut each: impl FnMut(u32, f64)) {
        self.places.sort_unstable();
        for &place in &self.places {
            each(place, self.values[std::mem::replace(&mut self.at[place as usize], u32::MAX) as usize]);
        }
        self.places.clear();
        self.values.clear();
    }
}

/// What a product does to what stands where it is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Into {
    /// It is replaced.
    Set,
    /// The product is added.
    Add,
}

impl BlockMatrix {
    /// The matrix of these `rows × columns` blocks of `height × width` entries, whose rows `fill` writes.
    pub(super) fn from_rows(shape: [usize; 2], block: [usize; 2], fill: impl Fn(usize, &mut BlockRow) + Sync) -> Self {
        Self::from_rows_with(shape, block, || (), |i, row, ()| fill(i, row))
    }

    /// The same with what `fill` works in, made once for many rows.
    pub(super) fn from_rows_with<T>(
        [rows, columns]: [usize; 2],
        [height, width]: [usize; 2],
        scratch: impl Fn() -> T + Sync,
        fill: impl Fn(usize, &mut BlockRow, &mut T) + Sync,
    ) -> Self {
        let tasks = rows.div_ceil(ROWS_PER_TASK);
        let parts: Vec<(Vec<usize>, Vec<u32>, Vec<f32>)> = (0..tasks)
            .into_par_iter()
            .map_init(
                || (BlockRow::new(columns, height * width), scratch()),
                |(row, scratch), task| {
                    let own = task * ROWS_PER_TASK..((task + 1) * ROWS_PER_TASK).min(rows);
                    let (mut counts, mut indices) = (Vec::with_capacity(own.len()), Vec::new());
                    let mut values = Vec::with_capacity(own.len() * BLOCKS_OF_A_ROW.min(columns) * height * width);
                    for i in own {
                        fill(i, row, scratch);
                        let before = indices.len();
                        row.take(&mut indices, &mut values);
                        counts.push(indices.len() - before);
                    }
                    (counts, indices, values)
                },
            )
            .collect();
        let entries: usize = parts.iter().map(|(_, indices, _)| indices.len()).sum();
        let size = height * width;
        let mut starts = Vec::with_capacity(rows + 1);
        starts.push(0);
        let (mut all_indices, mut all_values) = (vec![0; entries], vec![0.0; entries * size + TAIL]);
        let (mut end, mut to) = (0, (&mut all_indices[..], &mut all_values[..]));
        let mut copies = Vec::with_capacity(parts.len());
        for (counts, indices, values) in parts {
            for count in counts {
                end += count;
                starts.push(end);
            }
            let (to_indices, rest_indices) = std::mem::take(&mut to.0).split_at_mut(indices.len());
            let (to_values, rest_values) = std::mem::take(&mut to.1).split_at_mut(values.len());
            to = (rest_indices, rest_values);
            copies.push((to_indices, to_values, indices, values));
        }
        copies.into_par_iter().for_each(|(to_indices, to_values, indices, values)| {
            to_indices.copy_from_slice(&indices);
            to_values.copy_from_slice(&values);
        });
        Self { rows, columns, height, width, starts, indices: all_indices, values: all_values }
    }

    /// Entries of a block.
    pub(super) fn size(&self) -> usize {
        self.height * self.width
    }

    /// Block columns of row `i` and the entries of their blocks.
    pub(super) fn row(&self, i: usize) -> (&[u32], &[f32]) {
        let range = self.starts[i]..self.starts[i + 1];
        (&self.indices[range.clone()], &self.values[range.start * self.size()..range.end * self.size()])
    }

    /// Appends empty rows up to this number of them.
    pub(super) fn add_rows(&mut self, rows: usize) {
        self.starts.resize(rows + 1, self.starts[self.rows]);
        self.rows = rows;
    }

    /// Calls `each(i, A_i x, y_i)` for every block row.
    fn rows_of_product(&self, x: &[f32], y: &mut [f32], each: impl Fn(usize, &[f32], &mut [f32]) + Sync) {
        match (self.height, self.width) {
            (2, 2) => self.kernel::<2, 2, 2>(x, y, each),
            (3, 3) => self.kernel::<3, 3, 4>(x, y, each),
            (6, 6) => self.kernel::<6, 6, 8>(x, y, each),
            (2, 3) => self.kernel::<2, 3, 2>(x, y, each),
            (3, 2) => self.kernel::<3, 2, 4>(x, y, each),
            (3, 6) => self.kernel::<3, 6, 4>(x, y, each),
            (6, 3) => self.kernel::<6, 3, 8>(x, y, each),
            _ => self.any_kernel(x, y, each),
        }
    }

    /// Columns of blocks are read as vectors of `L ≥ H` entries, of which the first `H` count.
    fn kernel<const H: usize, const W: usize, const L: usize>(
        &self,
        x: &[f32],
        y: &mut [f32],
        each: impl Fn(usize, &[f32], &mut [f32]) + Sync,
    ) {
        y.par_chunks_mut(ROWS_PER_TASK * H).enumerate().for_each(|(task, out)| {
            for (at, out) in out.chunks_exact_mut(H).enumerate() {
                let i = task * ROWS_PER_TASK + at;
                let range = self.starts[i]..self.starts[i + 1];
                let mut sums = [[0.0_f32; L]; 2];
                for (place, &j) in range.clone().zip(&self.indices[range]) {
                    let block = &self.values[place * H * W..place * H * W + (W - 1) * H + L];
                    let x: &[f32; W] = x[j as usize * W..j as usize * W + W].try_into().expect("a block of x");
                    for w in 0..W {
                        let column: &[f32; L] = block[w * H..w * H + L].try_into().expect("a column of the block");
                        // Two running sums hide the time that an addition takes.
                        for l in 0..L {
                            sums[w % 2][l] += column[l] * x[w];
                        }
                    }
                }
                let mut sum = [0.0_f32; H];
                (0..H).for_each(|h| sum[h] = sums[0][h] + sums[1][h]);
                each(i, &sum, out);
            }
        });
    }

    fn any_kernel(&self, x: &[f32], y: &mut [f32], each: impl Fn(usize, &[f32], &mut [f32]) + Sync) {
        let (h, w) = (self.height, self.width);
        y.par_chunks_mut(ROWS_PER_TASK * h).enumerate().for_each(|(task, out)| {
            let mut sum = vec![0.0_f32; h];
            for (at, out) in out.chunks_exact_mut(h).enumerate() {
                let i = task * ROWS_PER_TASK + at;
                let (columns, values) = self.row(i);
                sum.fill(0.0);
                for (&j, block) in columns.iter().zip(values.chunks_exact(h * w)) {
                    let x = &x[j as usize * w..(j as usize + 1) * w];
                    for (x, column) in x.iter().zip(block.chunks_exact(h)) {
                        sum.iter_mut().zip(column).for_each(|(sum, a)| *sum += a * x);
                    }
                }
                each(i, &sum, out);
            }
        });
    }

    /// `y = A x` or `y += A x`.
    pub(super) fn mul_vec(&self, x: &[f32], y: &mut [f32], into: Into) {
        self.rows_of_product(x, y, |_, sum, out| match into {
            Into::Set => out.copy_from_slice(sum),
            Into::Add => out.iter_mut().zip(sum).for_each(|(y, s)| *y += s),
        });
    }

    /// `y = b - A x`.
    pub(super) fn residual(&self, b: &[f32], x: &[f32], y: &mut [f32]) {
        let h = self.height;
        self.rows_of_product(x, y, |i, sum, out| {
            let b = &b[i * h..(i + 1) * h];
            for k in 0..h {
                out[k] = b[k] - sum[k];
            }
        });
    }

    /// `step = keep step + gain D⁻¹ (b - A x)` with the inverses of diagonal blocks, all by block rows.
    pub(super) fn smoothing_step(
        &self,
        inverse: &[f32],
        b: &[f32],
        x: &[f32],
        [keep, gain]: [f32; 2],
        step: &mut [f32],
    ) {
        let h = self.height;
        self.rows_of_product(x, step, |i, sum, out| {
            let b = &b[i * h..(i + 1) * h];
            let inverse = &inverse[i * h * h..(i + 1) * h * h];
            for k in 0..h {
                let change: f32 = (0..h).map(|l| inverse[k * h + l] * (b[l] - sum[l])).sum();
                out[k] = keep * out[k] + gain * change;
            }
        });
    }

    /// The transposed matrix.
    pub(super) fn transpose(&self) -> Self {
        let size = self.size();
        let mut starts = vec![0; self.columns + 1];
        self.indices.iter().for_each(|&j| starts[j as usize + 1] += 1);
        for j in 0..self.columns {
            starts[j + 1] += starts[j];
        }
        let mut next = starts.clone();
        let mut indices = vec![0; self.indices.len()];
        let mut values = vec![0.0; self.values.len()];
        for i in 0..self.rows {
            let (columns, blocks) = self.row(i);
            for (&j, block) in columns.iter().zip(blocks.chunks_exact(size)) {
                let at = next[j as usize];
                next[j as usize] += 1;
                indices[at] = i as u32;
                let turned = &mut values[at * size..(at + 1) * size];
                for h in 0..self.height {
                    for w in 0..self.width {
                        turned[h * self.width + w] = block[w * self.height + h];
                    }
                }
            }
        }
        Self { rows: self.columns, columns: self.rows, height: self.width, width: self.height, starts, indices, values }
    }

    /// `self right`.
    pub(super) fn times(&self, right: &Self) -> Self {
        let (size, shape) = (self.size(), [self.height, right.width]);
        let multiply = multiplier([self.height, self.width, right.width]);
        Self::from_rows([self.rows, right.columns], shape, |i, row| {
            let (columns, values) = self.row(i);
            for (&k, a) in columns.iter().zip(values.chunks_exact(size)) {
                let (columns, blocks) = right.row(k as usize);
                for (&j, b) in columns.iter().zip(blocks.chunks_exact(right.size())) {
                    multiply([self.height, self.width, right.width], a, b, row.block(j));
                }
            }
        })
    }

    /// The square matrix by scalar rows.
    pub(super) fn to_csr(&self) -> Csr {
        let mut matrix = Csr::empty(self.rows * self.height);
        for i in 0..self.rows {
            let (columns, blocks) = self.row(i);
            for h in 0..self.height {
                for (&j, block) in columns.iter().zip(blocks.chunks_exact(self.size())) {
                    matrix.columns.extend((0..self.width).map(|w| j * self.width as u32 + w as u32));
                    matrix.values.extend((0..self.width).map(|w| f64::from(block[w * self.height + h])));
                }
                matrix.row_starts[i * self.height + h + 1] = matrix.columns.len();
            }
        }
        matrix
    }
}

/// Adds the product of a `h × k` and a `k × w` block to a `h × w` one.
pub(super) type Multiply = fn([usize; 3], &[f32], &[f32], &mut [f32]);

/// The product of blocks of this shape `[h, k, w]`.
pub(super) fn multiplier(shape: [usize; 3]) -> Multiply {
    match shape {
        [1, 1, 1] => fixed::<1, 1, 1>,
        [2, 2, 3] => fixed::<2, 2, 3>,
        [3, 2, 3] => fixed::<3, 2, 3>,
        [3, 3, 3] => fixed::<3, 3, 3>,
        [3, 3, 6] => fixed::<3, 3, 6>,
        [6, 3, 6] => fixed::<6, 3, 6>,
        [6, 6, 6] => fixed::<6, 6, 6>,
        _ => any,
    }
}

fn fixed<const H: usize, const K: usize, const W: usize>(_: [usize; 3], a: &[f32], b: &[f32], out: &mut [f32]) {
    let (a, b, out) = (&a[..H * K], &b[..K * W], &mut out[..H * W]);
    for w in 0..W {
        let mut sum: [f32; H] = out[w * H..(w + 1) * H].try_into().expect("a column of the block");
        for k in 0..K {
            for h in 0..H {
                sum[h] += a[k * H + h] * b[w * K + k];
            }
        }
        out[w * H..(w + 1) * H].copy_from_slice(&sum);
    }
}

fn any([h, k, w]: [usize; 3], a: &[f32], b: &[f32], out: &mut [f32]) {
    for j in 0..w {
        for l in 0..k {
            for i in 0..h {
                out[j * h + i] += a[l * h + i] * b[j * k + l];
            }
        }
    }
}
