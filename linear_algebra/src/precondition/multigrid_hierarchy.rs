//! Smoothed-aggregation multigrid on node blocks: one V-cycle with Chebyshev smoothing in single precision, symmetric for
//! a symmetric matrix.
//!
//! Vaněk, Mandel and Brezina, Computing 56 (1996). The prolongation is `P = (I - ω D⁻¹ A) T` with the tentative `T` of
//! [`super::aggregation`], `D` the diagonal blocks and `ω = 4 / (3 ρ(D⁻¹ A))`. Where several ranks share the matrix, aggregates stay
//! within the rows of one; products, prolongations and levels are those of one rank with these aggregates, and each rank has the
//! coarsest level.

use std::sync::{Arc, Mutex};

use serde::{Deserialize, Serialize, Serializer};

use super::aggregation::{NONE, Tentative, coarsen};
use super::block_matrix::{BlockMatrix, Into, NOTHING_EARLIER};
use super::block_row::BlockRow;
use super::couplings::Couplings;
use super::lines::{Inverses, Lines};
use super::multiplier::BESIDE;
use super::product_row::ProductRow;
use super::shared_levels::{Aggregates, gathered};
use super::single_precision::in_single;
use crate::check;
use crate::ghosts::Ghosts;
use crate::memory;
use crate::multifrontal::{Factor, Factorization, Precision, Scatter};
use crate::parallel;
use crate::symbolic::Symbolic;
use crate::system::Layout;
use crate::vector::{self, add_scaled, scale_by};

/// Equations below which a level is solved directly.
const COARSEST: usize = 1500;
/// Largest number of levels.
const LEVELS: usize = 12;
/// Steps of Arnoldi's iteration for the spectral radius.
const ARNOLDI_STEPS: usize = 5;
/// Safety factor of that estimate, which may be too low.
const SAFETY: f32 = 1.1;
/// Squarings of the matrix that Arnoldi's iteration leaves: its radius is then known to a thousandth.
const SQUARINGS: usize = 11;

/// The smoother of a level: Chebyshev iteration.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Smoother {
    /// Polynomial degree.
    degree: usize,
    /// Where the part of the spectrum begins that it damps, as a share of the upper bound.
    damped_from: f32,
}

/// Above aggregates, which are three blocks wide.
const ABOVE_AGGREGATES: Smoother = Smoother { degree: 2, damped_from: 0.1 };
/// Above the corners of second-order cells, which are closer: a narrower part is left, and many blocks are at one end of an edge each,
/// so that low degrees leave much of it.
const ABOVE_CORNERS: Smoother = Smoother { degree: 3, damped_from: 0.3 };

#[derive(Serialize)]
struct Level {
    matrix: Arc<BlockMatrix>,
    /// `D⁻¹`.
    #[serde(rename = "lines", serialize_with = "as_lines")]
    inverses: Inverses,
    /// Upper bound of the spectrum of `D⁻¹ A`.
    #[serde(skip)]
    radius: f32,
    smoother: Smoother,
    prolongation: BlockMatrix,
    #[serde(skip)]
    restriction: BlockMatrix,
    /// Who has which blocks.
    #[serde(skip)]
    ghosts: Ghosts,
}

/// The lines from which inverses are made again.
fn as_lines<S: Serializer>(inverses: &Inverses, to: S) -> Result<S::Ok, S::Error> {
    inverses.lines().serialize(to)
}

/// Data from which a level of one rank is restored.
#[derive(Deserialize)]
struct SavedLevel {
    matrix: Arc<BlockMatrix>,
    lines: Lines,
    smoother: Smoother,
    prolongation: BlockMatrix,
}

impl From<SavedLevel> for Level {
    fn from(SavedLevel { matrix, lines, smoother, prolongation }: SavedLevel) -> Self {
        let ghosts = Ghosts::none(matrix.rows);
        let (inverses, radius) = spectrum(&matrix, lines, &ghosts);
        let restriction = prolongation.transpose();
        Self { matrix, inverses, radius, smoother, prolongation, restriction, ghosts }
    }
}

/// Vectors of a level during a cycle, over own blocks; those of `b` and `x` over ghosts, too.
#[derive(Default)]
struct Vectors {
    b: Vec<f32>,
    x: Vec<f32>,
    step: Vec<f32>,
    /// Work space of lines.
    of_lines: Vec<f32>,
}

/// The last level, which every rank has whole.
struct Coarsest {
    /// `None` when it has no equations.
    factor: Option<Factor>,
    ghosts: Ghosts,
    /// Equations of each rank.
    counts: Vec<usize>,
}

/// The coarse space of corners on a mesh of second order.
pub(super) struct Corners<'a> {
    /// Number of each own block at a corner, and the modes there.
    pub(super) space: Tentative,
    pub(super) rows: InterpolationRows<'a>,
}

/// Calls its argument with a slot of an own block, the place of an unknown of a corner and a factor, for all of these.
type InterpolationRows<'a> = &'a (dyn Fn(usize, &mut dyn FnMut(usize, u32, f64)) + Sync);

/// The hierarchy.
#[derive(Serialize, Deserialize)]
#[serde(try_from = "SavedMultigrid")]
pub(crate) struct Multigrid {
    levels: Vec<Level>,
    /// Own rows of the last level.
    last: Arc<BlockMatrix>,
    #[serde(skip_serializing)]
    coarsest: Coarsest,
    #[serde(skip_serializing)]
    vectors: Mutex<Vec<Vectors>>,
}

/// Data from which a hierarchy of one rank is restored.
#[derive(Deserialize)]
struct SavedMultigrid {
    levels: Vec<SavedLevel>,
    last: Arc<BlockMatrix>,
}

impl TryFrom<SavedMultigrid> for Multigrid {
    type Error = &'static str;

    fn try_from(SavedMultigrid { levels, last }: SavedMultigrid) -> Result<Self, Self::Error> {
        let matrices: Vec<&BlockMatrix> = levels.iter().map(|level| &*level.matrix).chain([&*last]).collect();
        let fits = |(level, below): (&SavedLevel, &&BlockMatrix)| {
            let SavedLevel { matrix, lines, prolongation, .. } = level;
            (prolongation.rows, prolongation.height) == (matrix.rows, matrix.height)
                && (prolongation.columns, prolongation.width) == (below.rows, below.height)
                && prolongation.is_sound()
                && lines.is_sound(matrix.rows)
        };
        let square =
            |matrix: &&BlockMatrix| (matrix.rows, matrix.height) == (matrix.columns, matrix.width) && matrix.is_sound();
        if !matrices.iter().all(square) || !levels.iter().zip(&matrices[1..]).all(fits) {
            return Err("levels of multigrid that do not fit each other");
        }
        let ghosts = Ghosts::none(last.rows);
        Ok(Self::of(levels.into_iter().map(Level::from).collect(), last, ghosts))
    }
}

impl Multigrid {
    /// Builds the hierarchy on the own rows of `matrix`, whose near-null vectors have one entry for each of them; no coarse
    /// motion is one of two bodies, and `bodies` says which each block is of, `positions` where it is. Where the mesh is of second order
    /// the first coarse space is that of its `corners`. Collective.
    pub(super) fn new(
        mut matrix: Arc<BlockMatrix>,
        mut bodies: Vec<u32>,
        mut positions: Vec<[f64; 3]>,
        mut near_null_space: Vec<Vec<f64>>,
        mut ghosts: Ghosts,
        corners: Option<Corners<'_>>,
    ) -> Self {
        let mut levels: Vec<Level> = Vec::new();
        let is_large = |matrix: &BlockMatrix, ghosts: &Ghosts| {
            ghosts.total((matrix.rows * matrix.height) as f64) as usize > COARSEST
        };
        if let Some(Corners { mut space, rows }) = corners.filter(|_| is_large(&matrix, &ghosts)) {
            let lines = Lines::new(&Couplings::new(&matrix, &bodies, &positions));
            (bodies, near_null_space) = (std::mem::take(&mut space.bodies), std::mem::take(&mut space.modes));
            positions = std::mem::take(&mut space.positions);
            let (level, next, of_next) = Level::of_corners(matrix, lines, ghosts, space, rows);
            levels.push(level);
            (matrix, ghosts) = (Arc::new(next), of_next);
        }
        let of_nodes = levels.len();
        loop {
            let equations = ghosts.total((matrix.rows * matrix.height) as f64) as usize;
            if equations <= COARSEST || levels.len() >= LEVELS {
                break;
            }
            // Couplings of aggregates, which are of motions of unlike units, show no lines.
            let couplings = Couplings::new(&matrix, &bodies, &positions);
            let lines = if levels.len() == of_nodes { Lines::new(&couplings) } else { Lines::default() };
            let mut coarse = coarsen(&couplings, &lines, &near_null_space);
            let aggregates = ghosts.total(coarse.aggregates as f64) as usize;
            if aggregates == 0 || aggregates * near_null_space.len() * 4 > equations * 3 {
                break;
            }
            (bodies, near_null_space) = (std::mem::take(&mut coarse.bodies), std::mem::take(&mut coarse.modes));
            positions = std::mem::take(&mut coarse.positions);
            let (level, next, of_next) = Level::new(matrix, lines, ghosts, coarse, near_null_space.len());
            levels.push(level);
            (matrix, ghosts) = (Arc::new(next), of_next);
            if ghosts.ranks().is_some() {
                memory::give_back();
            }
        }
        Self::of(levels, matrix, ghosts)
    }

    /// The hierarchy with these levels above the `last`; collective.
    fn of(levels: Vec<Level>, last: Arc<BlockMatrix>, ghosts: Ghosts) -> Self {
        let (whole, rows) = gathered(&ghosts, &last);
        let counts = rows.iter().map(|rows| rows * last.height).collect();
        let of_levels = levels.iter().map(|level| (&level.ghosts, level.matrix.height, level.inverses.work()));
        let vectors = of_levels.chain([(&ghosts, last.height, 0)]).map(|(ghosts, height, work)| {
            let (all, own) = (ghosts.all() * height, ghosts.own() * height);
            Vectors { b: vec![0.0; all], x: vec![0.0; all], step: vec![0.0; own], of_lines: vec![0.0; work] }
        });
        let vectors = Mutex::new(vectors.collect());
        let coarsest = Coarsest { factor: factorise(&whole), ghosts, counts };
        Self { levels, last, coarsest, vectors }
    }

    /// Whether several ranks share it; it cannot be saved then.
    pub(crate) fn is_shared(&self) -> bool {
        self.coarsest.ghosts.ranks().is_some()
    }

    /// Entries of all levels, as a multiple of those of the finest; here.
    pub(crate) fn complexity(&self) -> f64 {
        let matrices = self.levels.iter().map(|level| &level.matrix).chain([&self.last]);
        let entries = |matrix: &BlockMatrix| (0..matrix.rows).map(|i| matrix.row(i).1.len()).sum::<usize>() as f64;
        let counts: Vec<f64> = matrices.map(|matrix| entries(matrix)).collect();
        counts.iter().sum::<f64>() / counts[0].max(1.0)
    }

    /// As [`Multigrid::apply`] in double precision, for the matrix times `size`; collective.
    pub(crate) fn apply_double(&self, x: &mut [f64], size: f64) {
        let finest = self.levels.first().map_or(&self.coarsest.ghosts, |level| &level.ghosts);
        in_single(finest, x, size, |x| self.apply(x));
    }

    /// Replaces `x`, own entries, by an approximation of `A⁻¹ x`; collective.
    pub(super) fn apply(&self, x: &mut [f32]) {
        let mut vectors = self.vectors.lock().expect("no cycle panics");
        vector::copy(x, &mut vectors[0].b[..x.len()]);
        self.cycle(0, &mut vectors);
        vector::copy(&vectors[0].x[..x.len()], x);
    }

    fn cycle(&self, depth: usize, vectors: &mut [Vectors]) {
        let (here, below) = vectors.split_first_mut().expect("vectors of each level");
        let Some(level) = self.levels.get(depth) else { return self.coarsest.solve(here) };
        let ghosts = self.levels.get(depth + 1).map_or(&self.coarsest.ghosts, |level| &level.ghosts);
        let width = level.prolongation.width;
        level.smooth(here, true);
        level.ghosts.spread(&mut here.x, level.matrix.height);
        level.matrix.residual(&here.b, &here.x, &mut here.step);
        level.restriction.mul_vec(&here.step, &mut below[0].b, Into::Set);
        ghosts.collect(&mut below[0].b, width);
        self.cycle(depth + 1, below);
        ghosts.spread(&mut below[0].x, width);
        level.prolongation.mul_vec(&below[0].x, &mut here.x[..here.step.len()], Into::Add);
        level.smooth(here, false);
    }
}

impl Coarsest {
    fn solve(&self, Vectors { b, x, step, .. }: &mut Vectors) {
        let own: Vec<f64> = b[..step.len()].iter().map(|&b| f64::from(b)).collect();
        let (mut all, first) = match self.ghosts.ranks() {
            None => (own, 0),
            Some(ranks) => {
                let all = ranks.exchange_counted(&vec![own; self.counts.len()], &self.counts).concat();
                (all, self.counts[..ranks.rank()].iter().sum())
            }
        };
        if let Some(factor) = &self.factor {
            factor.solve(&mut all, |_| {});
        }
        x.iter_mut().zip(&all[first..first + step.len()]).for_each(|(to, x)| *to = *x as f32);
    }
}

/// LU of the coarsest matrix; pivots of a singular one are replaced.
fn factorise(matrix: &BlockMatrix) -> Option<Factor> {
    let mut csr = matrix.to_csr();
    let n = csr.rows;
    if n == 0 {
        return None;
    }
    // Modes that an aggregate does not have left empty rows.
    for i in 0..n {
        if let Some(at) = csr.find(i, i)
            && csr.values[at] == 0.0
            && csr.row(i).1.iter().all(|v| *v == 0.0)
        {
            csr.values[at] = 1.0;
        }
    }
    let layout = Layout::blocked(matrix.rows, matrix.height);
    let symbolic = Arc::new(Symbolic::new(&csr, &layout, &vec![false; n]).ok()?);
    let scatter = Scatter::new(&symbolic, &csr, false);
    let scaling = crate::equilibrate::factors(&csr);
    Factor::new(&symbolic, &scatter, &csr, Factorization::Lu { limit: 1e-9 }, Precision::Double, scaling, None).ok()
}

impl Level {
    /// A level with this tentative prolongation to blocks of `width`, the matrix of the next one, and who has its blocks.
    fn new(
        matrix: Arc<BlockMatrix>,
        lines: Lines,
        ghosts: Ghosts,
        mut coarse: Tentative,
        width: usize,
    ) -> (Self, BlockMatrix, Ghosts) {
        let (inverses, radius) = spectrum(&matrix, lines, &ghosts);
        let omega = 4.0 / 3.0 * SAFETY / radius;
        let height = matrix.height;
        let (size, wide) = (height * height, height * width);
        let mut aggregates = Aggregates::new(&ghosts, coarse.aggregates);
        aggregates.complete(&ghosts, &mut coarse, wide);
        let (aggregate, tentative) = (&coarse.aggregate, &coarse.values);
        let (shape, blocks) = ([matrix.rows, aggregates.all()], [height, width]);
        let of = |k: usize| &tentative[k * wide..(k + 1) * wide];
        let product_of = |i: usize, row: &mut BlockRow, product: &mut ProductRow| {
            let (columns, values) = matrix.row_and_beside(i);
            for (at, &k) in columns.iter().enumerate() {
                let a = aggregate[k as usize];
                if a != NONE {
                    product.add(row, &[a], &values[at * size..], of(k as usize));
                }
            }
            product.write(row);
        };
        // The rows of A T that those of blocks in lines are made of.
        let lines = inverses.lines();
        let places = if lines.count() == 0 { Vec::new() } else { lines.places(matrix.rows) };
        let place = |i: usize| places.get(i).copied().flatten();
        let product = || ProductRow::new([height, height, width]);
        let of_lines = (!places.is_empty()).then(|| {
            BlockMatrix::from_rows_with(shape, blocks, NOTHING_EARLIER, product, |i, row, product| {
                if place(i).is_some() {
                    product_of(i, row, product);
                }
            })
        });
        // T - ω D⁻¹ (A T).
        let smoothed =
            |i: usize, row: &mut BlockRow, (damping, product, before): &mut (Vec<f32>, ProductRow, Vec<f32>)| {
                match (place(i), &of_lines) {
                    (Some((line, at)), Some(products)) => {
                        for (next, &block) in lines.blocks(line as usize).iter().enumerate() {
                            inverses.scaled_block(line as usize, [at as usize, next], -omega, damping);
                            let (columns, values) = products.row_and_beside(block as usize);
                            product.add(row, columns, damping, values);
                        }
                    }
                    _ => {
                        product_of(i, row, product);
                        let inverse = &inverses.of_blocks()[i * size..(i + 1) * size];
                        for h in 0..height {
                            (0..height).for_each(|l| damping[l * height + h] = -omega * inverse[h * height + l]);
                        }
                        before.clear();
                        before.extend_from_slice(row.entries());
                        product.add_to_each(row, damping, before);
                    }
                }
                product.write(row);
                if aggregate[i] != NONE {
                    row.block(aggregate[i]).iter_mut().zip(of(i)).for_each(|(sum, t)| *sum += t);
                }
            };
        let scratch = || (vec![0.0; size + BESIDE], product(), Vec::new());
        let prolongation = BlockMatrix::from_rows_with(shape, blocks, NOTHING_EARLIER, scratch, smoothed);
        drop(of_lines);
        Self::with(matrix, ghosts, (inverses, radius), ABOVE_AGGREGATES, aggregates, prolongation)
    }

    /// A level with linear interpolation from corners, the matrix of the next one, and who has its blocks.
    fn of_corners(
        matrix: Arc<BlockMatrix>,
        lines: Lines,
        ghosts: Ghosts,
        mut space: Tentative,
        rows: InterpolationRows<'_>,
    ) -> (Self, BlockMatrix, Ghosts) {
        let mut aggregates = Aggregates::new(&ghosts, space.aggregates);
        aggregates.complete(&ghosts, &mut space, 0);
        let (w, number) = (matrix.height, &space.aggregate);
        let prolongation = BlockMatrix::from_rows([matrix.rows, aggregates.all()], [w; 2], |i, row| {
            rows(i, &mut |slot, place, factor| {
                let (block, of_corner) = (place as usize / w, place as usize % w);
                if number[block] != NONE {
                    row.block(number[block])[of_corner * w + slot] += factor as f32;
                }
            });
        });
        let bounds = spectrum(&matrix, lines, &ghosts);
        Self::with(matrix, ghosts, bounds, ABOVE_CORNERS, aggregates, prolongation)
    }

    /// A level with this smoother, given the spectrum, and this prolongation.
    fn with(
        matrix: Arc<BlockMatrix>,
        ghosts: Ghosts,
        (inverses, radius): (Inverses, f32),
        smoother: Smoother,
        aggregates: Aggregates,
        mut prolongation: BlockMatrix,
    ) -> (Self, BlockMatrix, Ghosts) {
        let mut restriction = prolongation.transpose();
        let (next, of_next) = aggregates.product(&ghosts, &matrix, &mut prolongation, &mut restriction);
        (Self { matrix, inverses, radius, smoother, prolongation, restriction, ghosts }, next, of_next)
    }

    /// Chebyshev iteration on the upper part of the spectrum of `D⁻¹ A`.
    fn smooth(&self, vectors: &mut Vectors, from_zero: bool) {
        let Smoother { degree, damped_from } = self.smoother;
        let (low, high) = (damped_from * self.radius, self.radius);
        let (middle, half) = (0.5 * (high + low), 0.5 * (high - low));
        let sigma = middle / half;
        let mut rho = 1.0 / sigma;
        let Vectors { b, x, step, of_lines } = vectors;
        if from_zero {
            vector::clear(x);
        }
        for k in 0..degree {
            let factors = if k == 0 {
                [0.0, 1.0 / middle]
            } else {
                let next = 1.0 / (2.0 * sigma - rho);
                let factors = [next * rho, 2.0 * next / half];
                rho = next;
                factors
            };
            if k == 0 {
                vector::clear(step);
            }
            if k > 0 || !from_zero {
                self.ghosts.spread(x, self.matrix.height);
            }
            self.inverses.step(factors[0], step, of_lines, |step| {
                let inverses = self.inverses.of_blocks();
                if k == 0 && from_zero {
                    diagonal_step(inverses, self.matrix.height, b, factors[1], step);
                } else {
                    self.matrix.smoothing_step(inverses, b, x, factors, step);
                }
            });
            add_scaled(1.0, step, &mut x[..step.len()]);
        }
    }
}

/// `step = gain D⁻¹ b`.
fn diagonal_step(inverse: &[f32], height: usize, b: &[f32], gain: f32, step: &mut [f32]) {
    parallel::groups_mut(step, height, 1024, |i, step| {
        let b = &b[i * height..(i + 1) * height];
        let inverse = &inverse[i * height * height..(i + 1) * height * height];
        for (step, row) in step.iter_mut().zip(inverse.chunks_exact(height)) {
            *step = gain * row.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
        }
    });
}

/// The inverse of the diagonal blocks with these lines, and the upper bound of the spectrum of `D⁻¹ A`; collective.
fn spectrum(matrix: &BlockMatrix, lines: Lines, ghosts: &Ghosts) -> (Inverses, f32) {
    let inverses = Inverses::new(matrix, lines);
    let radius = SAFETY * spectral_radius(matrix, &inverses, ghosts);
    (inverses, radius)
}

/// Spectral radius of `D⁻¹ A` by Arnoldi's iteration, from below.
fn spectral_radius(matrix: &BlockMatrix, inverses: &Inverses, ghosts: &Ghosts) -> f32 {
    let n = matrix.rows * matrix.height;
    let first: Vec<f32> = check::pseudo_random(n).into_iter().map(|v| v as f32).collect();
    let mut x = vec![0.0; ghosts.all() * matrix.height];
    let (zero, mut work) = (vec![0.0; n], vec![0.0; inverses.work()]);
    let mut hessenberg = [[0.0; ARNOLDI_STEPS]; ARNOLDI_STEPS];
    let (mut basis, mut next) = (Vec::with_capacity(ARNOLDI_STEPS), first);
    let mut size = ghosts.norm(&next);
    for k in 0..ARNOLDI_STEPS {
        if size == 0.0 {
            break;
        }
        scale_by(1.0 / size, &mut next);
        vector::copy(&next, &mut x[..n]);
        ghosts.spread(&mut x, matrix.height);
        basis.push(next);
        next = vec![0.0; n];
        inverses.step(0.0, &mut next, &mut work, |next| {
            matrix.smoothing_step(inverses.of_blocks(), &zero, &x, [0.0, -1.0], next);
        });
        let along = ghosts.orthogonalise(&basis, &mut next);
        (0..=k).for_each(|i| hessenberg[i][k] = along[i]);
        size = ghosts.norm(&next);
        if k + 1 < ARNOLDI_STEPS {
            hessenberg[k + 1][k] = size;
        }
    }
    (radius_of(hessenberg) as f32).max(f32::MIN_POSITIVE)
}

/// Spectral radius of a small matrix, `lim ‖Aᵏ‖^(1/k)` for `k` a power of two (Gelfand, 1941).
fn radius_of(mut power: [[f64; ARNOLDI_STEPS]; ARNOLDI_STEPS]) -> f64 {
    let (mut logarithm, mut share) = (0.0, 1.0);
    for _ in 0..SQUARINGS {
        let size = vector::norm(power.as_flattened());
        if size == 0.0 {
            return 0.0;
        }
        power.as_flattened_mut().iter_mut().for_each(|entry| *entry /= size);
        logarithm += share * size.ln();
        share *= 0.5;
        let entry = |i: usize, j: usize| (0..ARNOLDI_STEPS).map(|k| power[i][k] * power[k][j]).sum();
        power = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
    }
    logarithm.exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_radius_of_a_small_matrix_is_that_of_its_largest_eigenvalue() {
        // A rotation with growth 2, which no power iteration settles on, beside a defective block with the eigenvalue 1.9.
        let mut matrix = [[0.0; ARNOLDI_STEPS]; ARNOLDI_STEPS];
        (matrix[0][1], matrix[1][0]) = (-2.0, 2.0);
        (matrix[2][2], matrix[3][3], matrix[2][3]) = (1.9, 1.9, 30.0);
        let radius = radius_of(matrix);
        assert!((radius / 2.0 - 1.0).abs() < 1e-3, "{radius}");
        assert_eq!(radius_of([[0.0; ARNOLDI_STEPS]; ARNOLDI_STEPS]), 0.0);
    }

    /// The eigenvalues of D⁻¹ A of a chain of n points are 1 - cos(k π / (n + 1)).
    #[test]
    fn the_radius_of_a_chain_is_found_from_below() {
        let n = 2000;
        let chain = BlockMatrix::from_rows([n, n], [1, 1], |i, row| {
            row.block(i as u32)[0] = 2.0;
            for j in [i.wrapping_sub(1), i + 1].into_iter().filter(|&j| j < n) {
                row.block(j as u32)[0] = -1.0;
            }
        });
        let radius = spectral_radius(&chain, &Inverses::new(&chain, Lines::default()), &Ghosts::none(n));
        assert!((2.0 / f64::from(SAFETY)..2.0).contains(&f64::from(radius)), "{radius}");
    }
}
