//! Sparse matrices of small dense blocks, in single precision: the matrices of the levels of multigrid.

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::block_row::BlockRow;
use super::product_row::ProductRow;
#[cfg(target_arch = "x86_64")]
use super::row_product::Avx2Lanes;
use super::row_product::{Lanes, PortableLanes, TAIL, row_product};
use super::workspaces::Workspaces;
use crate::csr::Csr;
use crate::parallel;

/// Block rows of a part; fixed, so that results do not depend on the number of threads.
const ROWS: usize = 64;

/// Rows of a piece of one of fewer than [`MANY`] parts that are made at a time.
const PIECE: usize = 8;
/// Parts that are no longer made in pieces.
const MANY: usize = 128;

/// Parts that a thread takes in one piece for a product with a vector.
const PRODUCTS: usize = 8;

/// Parts of a product of three matrices that are made at a time, at least.
const PANEL: usize = 16;
/// Panels of many parts, each of which costs two rounds over the threads.
const PANELS: usize = 16;

/// No block has more rows or columns.
const LARGEST: usize = 64;

/// Blocks for which rows have room at first, those of hexahedra.
const BLOCKS_OF_A_ROW: usize = 27;

/// A matrix of `rows × columns` blocks of `height × width` entries, by rows with ascending block columns.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct BlockMatrix {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) height: usize,
    pub(super) width: usize,
    /// Rows in parts of [`ROWS`], each made and read by one task.
    parts: Vec<Arc<Part>>,
}

/// Rows that stand together.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Part {
    /// Where the blocks of each row begin, and the end.
    starts: Vec<u32>,
    indices: Vec<u32>,
    /// Entries of each block by columns, and [`TAIL`] zeros.
    values: Vec<f32>,
}

impl Part {
    /// One with room for so many rows, and blocks of `size` entries.
    fn with_room(rows: usize, blocks: usize, size: usize) -> Self {
        let mut starts = Vec::with_capacity(rows + 1);
        starts.push(0);
        let (indices, values) = (Vec::with_capacity(blocks), Vec::with_capacity(blocks * size + TAIL));
        Self { starts, indices, values }
    }

    /// Rows over `columns` blocks of `size` entries, each of which `fill` writes to an empty `row`: a piece, see [`Part::joined`].
    fn of_rows(
        rows: Range<usize>,
        columns: usize,
        size: usize,
        row: &mut BlockRow,
        mut fill: impl FnMut(usize, &mut BlockRow),
    ) -> Self {
        let mut part = Self::with_room(rows.len(), rows.len() * BLOCKS_OF_A_ROW.min(columns), size);
        for i in rows {
            fill(i, row);
            row.take(&mut part.indices, &mut part.values);
            part.end_row();
        }
        part
    }

    /// The part of the rows of pieces that follow each other.
    fn joined(mut pieces: impl Iterator<Item = Self>) -> Arc<Self> {
        let mut part = pieces.next().expect("a part has rows");
        for piece in pieces {
            let before = part.indices.len() as u32;
            part.starts.extend(piece.starts[1..].iter().map(|start| before + start));
            part.indices.extend(piece.indices);
            part.values.extend(piece.values);
        }
        part.end();
        Arc::new(part)
    }

    /// Ends a row whose blocks have been appended.
    fn end_row(&mut self) {
        self.starts.push(u32::try_from(self.indices.len()).expect("a part has fewer blocks than 2³²"));
    }

    /// Ends the last row.
    fn end(&mut self) {
        self.values.resize(self.values.len() + TAIL, 0.0);
        self.values.shrink_to_fit();
        self.indices.shrink_to_fit();
    }

    /// Columns and entries of its row `at`, with all entries that follow.
    fn row(&self, at: usize, size: usize) -> (&[u32], &[f32]) {
        let [begin, end] = [self.starts[at], self.starts[at + 1]].map(|start| start as usize);
        (&self.indices[begin..end], &self.values[begin * size..])
    }

    fn is_sound(&self, rows: usize, columns: usize, size: usize) -> bool {
        let ascend = |row: &[u32]| {
            let blocks = self.indices.get(row[0] as usize..row[1] as usize);
            blocks.is_some_and(|row| row.windows(2).all(|pair| pair[0] < pair[1]))
        };
        let values = self.indices.len().checked_mul(size).and_then(|values| values.checked_add(TAIL));
        self.starts.len() == rows + 1
            && self.starts[0] == 0
            && self.starts[rows] as usize == self.indices.len()
            && self.starts.is_sorted()
            && self.starts.windows(2).all(ascend)
            && self.indices.iter().all(|&column| (column as usize) < columns)
            && values == Some(self.values.len())
    }
}

impl BlockMatrix {
    /// Whether one that was read can be a matrix.
    pub(super) fn is_sound(&self) -> bool {
        let rows = |at: usize| ROWS.min(self.rows - at * ROWS);
        let is_sound =
            |(at, part): (usize, &Arc<Part>)| part.is_sound(rows(at), self.columns, self.height * self.width);
        (1..=LARGEST).contains(&self.height)
            && (1..=LARGEST).contains(&self.width)
            && self.parts.len() == self.rows.div_ceil(ROWS)
            && self.parts.iter().enumerate().all(is_sound)
    }
}

/// No earlier matrix to take rows from.
pub(super) const NOTHING_EARLIER: Option<(&BlockMatrix, fn(usize) -> bool)> = None;

/// The work on the product of a part: its first row, the product, and the numbers at its rows.
type WithProduct<'a> = &'a (dyn Fn(usize, &[f32], &mut [f32]) + Sync);

/// Operation of a product on the vector that it writes to.
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
        Self::from_rows_with(shape, block, NOTHING_EARLIER, || (), |i, row, ()| fill(i, row))
    }

    /// The same with the work space of `fill`, made once for many rows; rows that are those of an earlier matrix are taken from it.
    pub(super) fn from_rows_with<T: Send>(
        [rows, columns]: [usize; 2],
        [height, width]: [usize; 2],
        earlier: Option<(&Self, impl Fn(usize) -> bool + Sync)>,
        scratch: impl Fn() -> T + Sync,
        fill: impl Fn(usize, &mut BlockRow, &mut T) + Sync,
    ) -> Self {
        let make = |task: usize, (row, scratch): &mut (BlockRow, T)| {
            let own = task * ROWS..((task + 1) * ROWS).min(rows);
            let kept = |i: usize| earlier.as_ref().filter(|(_, keeps)| keeps(i)).map(|(earlier, _)| *earlier);
            if let Some((earlier, _)) = earlier.as_ref().filter(|_| own.clone().all(|i| kept(i).is_some())) {
                return earlier.parts[task].clone();
            }
            let part = Part::of_rows(own, columns, height * width, row, |i, row| match kept(i) {
                Some(earlier) => row.copy(earlier.row(i)),
                None => fill(i, row, scratch),
            });
            Part::joined(std::iter::once(part))
        };
        let workspaces = Workspaces::new(|| (BlockRow::new(columns, height * width), scratch()));
        let parts = parallel::map(rows.div_ceil(ROWS), 1, |task| workspaces.lend(|own| make(task, own)));
        Self { rows, columns, height, width, parts }
    }

    /// Entries of a block.
    pub(super) fn size(&self) -> usize {
        self.height * self.width
    }

    /// Block columns of row `i` and the entries of their blocks.
    pub(super) fn row(&self, i: usize) -> (&[u32], &[f32]) {
        let (columns, values) = self.row_and_beside(i);
        (columns, &values[..columns.len() * self.size()])
    }

    /// The same with [`TAIL`] entries or more behind those of the blocks.
    pub(super) fn row_and_beside(&self, i: usize) -> (&[u32], &[f32]) {
        self.parts[i / ROWS].row(i % ROWS, self.size())
    }

    /// Entries of all blocks, row after row.
    pub(super) fn entries(&self) -> impl Iterator<Item = f32> + '_ {
        (0..self.rows).flat_map(|i| self.row(i).1).copied()
    }

    /// Appends empty rows up to this number of them.
    pub(super) fn add_rows(&mut self, rows: usize) {
        while self.rows < rows {
            if self.rows.is_multiple_of(ROWS) {
                let mut part = Part::with_room(0, 0, 0);
                part.end();
                self.parts.push(Arc::new(part));
            }
            Arc::make_mut(self.parts.last_mut().expect("there is one for the row")).end_row();
            self.rows += 1;
        }
    }

    /// Calls `each(i, A x, y)` for the rows of each part, of which row `i` is the first.
    fn parts_of_product(&self, x: &[f32], y: &mut [f32], each: WithProduct<'_>) {
        match (self.height, self.width) {
            (1, 1) => self.fixed_parts::<1, 1>(x, y, each),
            (2, 2) => self.fixed_parts::<2, 2>(x, y, each),
            (3, 3) => self.fixed_parts::<3, 3>(x, y, each),
            (6, 6) => self.fixed_parts::<6, 6>(x, y, each),
            (2, 3) => self.fixed_parts::<2, 3>(x, y, each),
            (3, 2) => self.fixed_parts::<3, 2>(x, y, each),
            (3, 6) => self.fixed_parts::<3, 6>(x, y, each),
            (6, 3) => self.fixed_parts::<6, 3>(x, y, each),
            _ => self.any_parts(x, y, each),
        }
    }

    fn fixed_parts<const H: usize, const W: usize>(&self, x: &[f32], y: &mut [f32], each: WithProduct<'_>) {
        self.each_part(y, &|task, part, out| {
            let mut sums = [[0.0; H]; ROWS];
            let sums = &mut sums[..out.len() / H];
            part.products::<H, W>(x, sums);
            each(task * ROWS, sums.as_flattened(), out);
        });
    }

    /// Calls `work` for each part with its number and the numbers of `y` at its rows.
    fn each_part(&self, y: &mut [f32], work: &(dyn Fn(usize, &Part, &mut [f32]) + Sync)) {
        let size = ROWS * self.height;
        parallel::parts_mut(y, size * PRODUCTS, &|first, out| {
            for (task, out) in (first / size..).zip(out.chunks_mut(size)) {
                work(task, &self.parts[task], out);
            }
        });
    }

    fn any_parts(&self, x: &[f32], y: &mut [f32], each: WithProduct<'_>) {
        let (h, w) = (self.height, self.width);
        self.each_part(y, &|task, _, out| {
            let mut sums = vec![0.0_f32; out.len()];
            for (at, sum) in sums.chunks_exact_mut(h).enumerate() {
                let (columns, values) = self.row(task * ROWS + at);
                for (&j, block) in columns.iter().zip(values.chunks_exact(h * w)) {
                    let x = &x[j as usize * w..(j as usize + 1) * w];
                    for (x, column) in x.iter().zip(block.chunks_exact(h)) {
                        sum.iter_mut().zip(column).for_each(|(sum, a)| *sum += a * x);
                    }
                }
            }
            each(task * ROWS, &sums, out);
        });
    }

    /// `y = A x` or `y += A x`.
    pub(super) fn mul_vec(&self, x: &[f32], y: &mut [f32], into: Into) {
        self.parts_of_product(x, y, &|_, sums, out| match into {
            Into::Set => out.copy_from_slice(sums),
            Into::Add => out.iter_mut().zip(sums).for_each(|(y, s)| *y += s),
        });
    }

    /// `y = b - A x`.
    pub(super) fn residual(&self, b: &[f32], x: &[f32], y: &mut [f32]) {
        let h = self.height;
        self.parts_of_product(x, y, &|i, sums, out| {
            let b = &b[i * h..i * h + out.len()];
            out.iter_mut().zip(b).zip(sums).for_each(|((y, b), s)| *y = b - s);
        });
    }

    /// `step = keep step + gain D⁻¹ (b - A x)` with the inverses of diagonal blocks, all by block rows.
    pub(super) fn smoothing_step(&self, inverse: &[f32], b: &[f32], x: &[f32], factors: [f32; 2], step: &mut [f32]) {
        let h = self.height;
        self.parts_of_product(x, step, &|i, sums, out| {
            let (own, square) = (i * h..i * h + out.len(), i * h * h..(i * h + out.len()) * h);
            let (inverse, b) = (&inverse[square], &b[own]);
            // Sizes that are known make loops of known lengths.
            match h {
                2 => change(2, inverse, b, sums, factors, out),
                3 => change(3, inverse, b, sums, factors, out),
                6 => change(6, inverse, b, sums, factors, out),
                _ => change(h, inverse, b, sums, factors, out),
            }
        });
    }

    /// The transposed matrix.
    pub(super) fn transpose(&self) -> Self {
        let mut ends = vec![0_usize; self.columns + 1];
        let all = || (0..self.rows).flat_map(|i| self.row(i).0.iter().enumerate().map(move |(at, &j)| (i, at, j)));
        all().for_each(|(_, _, j)| ends[j as usize + 1] += 1);
        (0..self.columns).for_each(|j| ends[j + 1] += ends[j]);
        // Row of each block of a column, and its place there.
        let mut places = vec![(0_u32, 0_u32); ends[self.columns]];
        for (i, at, j) in all() {
            let end = &mut ends[j as usize];
            places[*end] = (i as u32, at as u32);
            *end += 1;
        }
        let size = self.size();
        let [height, width] = [self.width, self.height];
        let make = |task: usize| {
            let own = task * ROWS..((task + 1) * ROWS).min(self.columns);
            let begin = |j: usize| j.checked_sub(1).map_or(0, |before| ends[before]);
            let blocks = begin(own.end) - begin(own.start);
            let mut part = Part::with_room(own.len(), blocks, size);
            for j in own {
                for &(i, at) in &places[begin(j)..ends[j]] {
                    let block = &self.row(i as usize).1[at as usize * size..(at as usize + 1) * size];
                    part.indices.push(i);
                    let begin = part.values.len();
                    part.values.resize(begin + size, 0.0);
                    for (h, column) in part.values[begin..].chunks_exact_mut(self.width).enumerate() {
                        column
                            .iter_mut()
                            .zip(block[h..].iter().step_by(self.height))
                            .for_each(|(to, from)| *to = *from);
                    }
                }
                part.end_row();
            }
            part.end();
            Arc::new(part)
        };
        let parts = parallel::map(self.columns.div_ceil(ROWS), 1, make);
        Self { rows: self.columns, columns: self.rows, height, width, parts }
    }

    /// `self (middle right)`.
    ///
    /// The inner product is larger than the result, so only the rows under way are held.
    pub(super) fn times_product(&self, middle: &Self, right: &Self) -> Self {
        let nothing = Arc::new(Part::with_room(0, 0, 0));
        let parts = vec![nothing.clone(); middle.rows.div_ceil(ROWS)];
        let mut inner =
            Self { rows: middle.rows, columns: right.columns, height: middle.height, width: right.width, parts };
        let tasks: Vec<usize> = (0..self.rows.div_ceil(ROWS)).collect();
        let panels: Vec<&[usize]> = tasks.chunks(PANEL.max(tasks.len() / PANELS)).collect();
        let needs = |panel: &&[usize]| -> Vec<usize> {
            let mut is_needed = vec![false; inner.parts.len()];
            let rows = panel.iter().flat_map(|&task| &self.parts[task].indices);
            rows.for_each(|&k| is_needed[k as usize / ROWS] = true);
            (0..is_needed.len()).filter(|&part| is_needed[part]).collect()
        };
        let needed: Vec<Vec<usize>> = parallel::map(panels.len(), 1, |at| needs(&panels[at]));
        let mut last = vec![0; inner.parts.len()];
        needed.iter().enumerate().for_each(|(at, needed)| needed.iter().for_each(|&part| last[part] = at));
        let mut parts = Vec::with_capacity(tasks.len());
        for (at, (panel, needed)) in panels.into_iter().zip(&needed).enumerate() {
            let missing: Vec<usize> =
                needed.iter().copied().filter(|&part| Arc::ptr_eq(&inner.parts[part], &nothing)).collect();
            let made = middle.parts_of_times(right, &missing);
            missing.into_iter().zip(made).for_each(|(part, made)| inner.parts[part] = made);
            parts.extend(self.parts_of_times(&inner, panel));
            needed.iter().filter(|part| last[**part] == at).for_each(|&part| inner.parts[part] = nothing.clone());
        }
        Self { rows: self.rows, columns: right.columns, height: self.height, width: right.width, parts }
    }

    /// Parts of `self right`; few parts are made in pieces, so that all threads have work to the end: rows of an interface take far more
    /// than others.
    fn parts_of_times(&self, right: &Self, tasks: &[usize]) -> Vec<Arc<Part>> {
        let (size, of_product) = (self.size(), self.height * right.width);
        let rows = match tasks.len() {
            few if few < PANEL => 1,
            some if some < MANY => PIECE,
            _ => ROWS,
        };
        let pieces_of = |&task: &usize| {
            let end = ((task + 1) * ROWS).min(self.rows);
            (task * ROWS..end).step_by(rows).map(move |begin| begin..(begin + rows).min(end))
        };
        let pieces: Vec<Range<usize>> = tasks.iter().flat_map(pieces_of).collect();
        let workspaces = Workspaces::new(|| {
            let product = ProductRow::new([self.height, self.width, right.width]);
            (BlockRow::new(right.columns, of_product), product)
        });
        let make = |piece: &Range<usize>| {
            workspaces.lend(|(row, product)| {
                Part::of_rows(piece.clone(), right.columns, of_product, row, |i, row| {
                    let (columns, values) = self.row_and_beside(i);
                    for (at, &k) in columns.iter().enumerate() {
                        let (columns, blocks) = right.row(k as usize);
                        product.add(row, columns, &values[at * size..], blocks);
                    }
                    product.write(row);
                })
            })
        };
        let mut made = parallel::map(pieces.len(), 1, |at| make(&pieces[at])).into_iter();
        tasks.iter().map(|task| Part::joined(made.by_ref().take(pieces_of(task).count()))).collect()
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

/// `step = keep step + gain D⁻¹ (b - sums)` with blocks of `h` rows, the inverses by rows.
#[inline(always)]
fn change(h: usize, inverse: &[f32], b: &[f32], sums: &[f32], [keep, gain]: [f32; 2], step: &mut [f32]) {
    let rows = step.chunks_exact_mut(h).zip(b.chunks_exact(h)).zip(sums.chunks_exact(h));
    for (((step, b), sums), inverse) in rows.zip(inverse.chunks_exact(h * h)) {
        for (step, inverse) in step.iter_mut().zip(inverse.chunks_exact(h)) {
            let rest = b.iter().zip(sums).map(|(b, s)| b - s);
            *step = keep * *step + gain * inverse.iter().zip(rest).map(|(a, rest)| a * rest).sum::<f32>();
        }
    }
}

impl Part {
    /// The products of its rows with `x`.
    fn products<const H: usize, const W: usize>(&self, x: &[f32], sums: &mut [[f32; H]]) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has just said that it knows AVX2.
            return unsafe { self.products_by_avx2::<H, W>(x, sums) };
        }
        self.products_in::<H, W, PortableLanes>(x, sums);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn products_by_avx2<const H: usize, const W: usize>(&self, x: &[f32], sums: &mut [[f32; H]]) {
        self.products_in::<H, W, Avx2Lanes>(x, sums);
    }

    #[inline(always)]
    fn products_in<const H: usize, const W: usize, L: Lanes>(&self, x: &[f32], sums: &mut [[f32; H]]) {
        for (at, sum) in sums.iter_mut().enumerate() {
            let (columns, values) = self.row(at, H * W);
            *sum = row_product::<H, W, L>(columns, values, x);
        }
    }
}
