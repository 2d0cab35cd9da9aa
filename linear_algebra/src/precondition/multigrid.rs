//! Smoothed-aggregation multigrid on node blocks: one V-cycle with Chebyshev smoothing in single precision, symmetric for
//! a symmetric matrix.
//!
//! Vaněk, Mandel and Brezina, Computing 56 (1996). The prolongation is `P = (I - ω D⁻¹ A) T` with the tentative `T`
//! of [`super::aggregation`], `D` the diagonal blocks and `ω = 4 / (3 ρ(D⁻¹ A))`.

use std::sync::{Arc, Mutex};

use serde::{Deserialize, Serialize};

use super::aggregation::{NONE, coarsen};
use super::block_matrix::{BlockMatrix, BlockRow, Into, multiplier};
use crate::check;
use crate::dense_lu;
use crate::multifrontal::{Factor, Kind, Precision, Scatter};
use crate::symbolic::Symbolic;
use crate::system::Layout;

/// Equations below which a level is solved directly.
const COARSEST: usize = 1500;
/// Largest number of levels.
const LEVELS: usize = 12;
/// Steps of the power iteration for the spectral radius.
const POWER_STEPS: usize = 10;
/// What the power iteration may have missed.
const SAFETY: f32 = 1.1;
/// Polynomial degree of the smoother.
const DEGREE: usize = 2;
/// Share of the spectrum that the smoother damps, counted from above.
const DAMPED_FROM: f32 = 0.1;

#[derive(Serialize, Deserialize)]
#[serde(from = "SavedLevel")]
struct Level {
    matrix: BlockMatrix,
    /// Inverse diagonal blocks, by rows.
    #[serde(skip_serializing)]
    inverse: Vec<f32>,
    /// Upper bound of the spectrum of `D⁻¹ A`.
    #[serde(skip_serializing)]
    radius: f32,
    prolongation: BlockMatrix,
    #[serde(skip_serializing)]
    restriction: BlockMatrix,
}

/// What a level is made of again.
#[derive(Deserialize)]
struct SavedLevel {
    matrix: BlockMatrix,
    prolongation: BlockMatrix,
}

impl From<SavedLevel> for Level {
    fn from(SavedLevel { matrix, prolongation }: SavedLevel) -> Self {
        let (inverse, radius) = spectrum(&matrix);
        let restriction = prolongation.transpose();
        Self { matrix, inverse, radius, prolongation, restriction }
    }
}

/// Vectors of a level during a cycle.
#[derive(Default)]
struct Vectors {
    b: Vec<f32>,
    x: Vec<f32>,
    step: Vec<f32>,
}

/// The hierarchy.
#[derive(Serialize, Deserialize)]
#[serde(from = "SavedMultigrid")]
pub(crate) struct Multigrid {
    levels: Vec<Level>,
    coarsest: BlockMatrix,
    /// Of the coarsest matrix; `None` when it has no equations.
    #[serde(skip_serializing)]
    factor: Option<Factor>,
    #[serde(skip_serializing)]
    vectors: Mutex<Vec<Vectors>>,
}

/// What a hierarchy is made of again.
#[derive(Deserialize)]
struct SavedMultigrid {
    levels: Vec<Level>,
    coarsest: BlockMatrix,
}

impl From<SavedMultigrid> for Multigrid {
    fn from(SavedMultigrid { levels, coarsest }: SavedMultigrid) -> Self {
        let matrices = levels.iter().map(|level| &level.matrix).chain([&coarsest]);
        let vectors = matrices.map(|matrix| {
            let rows = equations(matrix);
            Vectors { b: vec![0.0; rows], x: vec![0.0; rows], step: vec![0.0; rows] }
        });
        let vectors = Mutex::new(vectors.collect());
        Self { levels, factor: factorise(&coarsest), coarsest, vectors }
    }
}

fn equations(matrix: &BlockMatrix) -> usize {
    matrix.rows * matrix.height
}

impl Multigrid {
    /// Builds the hierarchy on `matrix`, whose near-null vectors have one entry for each of its rows.
    pub(super) fn new(mut matrix: BlockMatrix, mut near_null_space: Vec<Vec<f64>>) -> Self {
        let mut levels: Vec<Level> = Vec::new();
        while equations(&matrix) > COARSEST && levels.len() < LEVELS {
            let Some(coarse) = coarsen(&matrix, &near_null_space) else { break };
            if coarse.aggregates * near_null_space.len() * 4 > equations(&matrix) * 3 {
                break;
            }
            let (level, next) = Level::new(matrix, &coarse.aggregate, coarse.aggregates, &coarse.values);
            levels.push(level);
            matrix = next;
            near_null_space = coarse.modes;
        }
        SavedMultigrid { levels, coarsest: matrix }.into()
    }

    /// Replaces `x` by an approximation of `A⁻¹ x`.
    pub(crate) fn apply(&self, x: &mut [f64]) {
        let largest = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        if largest == 0.0 || !largest.is_finite() {
            return;
        }
        let mut vectors = self.vectors.lock().expect("no cycle panics");
        vectors[0].b.iter_mut().zip(x.iter()).for_each(|(b, x)| *b = (x / largest) as f32);
        self.cycle(0, &mut vectors);
        x.iter_mut().zip(&vectors[0].x).for_each(|(x, v)| *x = largest * f64::from(*v));
    }

    fn cycle(&self, depth: usize, vectors: &mut [Vectors]) {
        let (here, below) = vectors.split_first_mut().expect("vectors of each level");
        let Some(level) = self.levels.get(depth) else {
            let mut x: Vec<f64> = here.b.iter().map(|&b| f64::from(b)).collect();
            if let Some(factor) = &self.factor {
                factor.solve(&mut x, |_| {});
            }
            here.x.iter_mut().zip(x).for_each(|(to, x)| *to = x as f32);
            return;
        };
        level.smooth(here, true);
        level.matrix.residual(&here.b, &here.x, &mut here.step);
        level.restriction.mul_vec(&here.step, &mut below[0].b, Into::Set);
        self.cycle(depth + 1, below);
        level.prolongation.mul_vec(&below[0].x, &mut here.x, Into::Add);
        level.smooth(here, false);
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
    Factor::new(&symbolic, &scatter, &csr, Kind::Lu { limit: 1e-9 }, Precision::Double, scaling, None).ok()
}

impl Level {
    /// A level with this tentative prolongation, and the matrix of the next one.
    fn new(matrix: BlockMatrix, aggregate: &[u32], aggregates: usize, tentative: &[f32]) -> (Self, BlockMatrix) {
        let (inverse, radius) = spectrum(&matrix);
        let omega = 4.0 / 3.0 * SAFETY / radius;
        let (height, width) = (matrix.height, tentative.len() / (matrix.rows * matrix.height).max(1));
        let (size, wide) = (height * height, height * width);
        let multiply = multiplier([height, height, width]);
        let smoothed = |i: usize, row: &mut BlockRow| {
            let (columns, values) = matrix.row(i);
            let mut damped = vec![0.0; size];
            for (&k, block) in columns.iter().zip(values.chunks_exact(size)) {
                let a = aggregate[k as usize];
                if a == NONE {
                    continue;
                }
                damped.fill(0.0);
                for h in 0..height {
                    for l in 0..height {
                        let factor = -omega * inverse[i * size + h * height + l];
                        (0..height).for_each(|w| damped[w * height + h] += factor * block[w * height + l]);
                    }
                }
                if k as usize == i {
                    (0..height).for_each(|h| damped[h * height + h] += 1.0);
                }
                let from = &tentative[k as usize * wide..(k as usize + 1) * wide];
                multiply([height, height, width], &damped, from, row.block(a));
            }
        };
        let prolongation = BlockMatrix::from_rows([matrix.rows, aggregates], [height, width], smoothed);
        let restriction = prolongation.transpose();
        let next = restriction.times(&matrix.times(&prolongation));
        (Self { matrix, inverse, radius, prolongation, restriction }, next)
    }

    /// Chebyshev iteration on the upper part of the spectrum of `D⁻¹ A`.
    fn smooth(&self, vectors: &mut Vectors, from_zero: bool) {
        let (low, high) = (DAMPED_FROM * self.radius, self.radius);
        let (middle, half) = (0.5 * (high + low), 0.5 * (high - low));
        let sigma = middle / half;
        let mut rho = 1.0 / sigma;
        let Vectors { b, x, step } = vectors;
        if from_zero {
            x.fill(0.0);
        }
        for k in 0..DEGREE {
            let factors = if k == 0 {
                [0.0, 1.0 / middle]
            } else {
                let next = 1.0 / (2.0 * sigma - rho);
                let factors = [next * rho, 2.0 * next / half];
                rho = next;
                factors
            };
            if k == 0 {
                step.fill(0.0);
            }
            if k == 0 && from_zero {
                diagonal_step(&self.inverse, self.matrix.height, b, factors[1], step);
            } else {
                self.matrix.smoothing_step(&self.inverse, b, x, factors, step);
            }
            x.iter_mut().zip(step.iter()).for_each(|(x, s)| *x += s);
        }
    }
}

/// `step = gain D⁻¹ b`.
fn diagonal_step(inverse: &[f32], height: usize, b: &[f32], gain: f32, step: &mut [f32]) {
    let blocks = b.chunks_exact(height).zip(step.chunks_exact_mut(height)).zip(inverse.chunks_exact(height * height));
    for ((b, step), inverse) in blocks {
        for (step, row) in step.iter_mut().zip(inverse.chunks_exact(height)) {
            *step = gain * row.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
        }
    }
}

/// Inverses of the diagonal blocks, by rows; tiny pivots are lifted, so that they always exist.
fn inverse_diagonal(matrix: &BlockMatrix) -> Vec<f32> {
    let h = matrix.height;
    let mut out = vec![0.0; matrix.rows * h * h];
    for (i, out) in out.chunks_exact_mut(h * h).enumerate() {
        let (columns, values) = matrix.row(i);
        let Ok(at) = columns.binary_search(&(i as u32)) else { continue };
        let block = &values[at * h * h..(at + 1) * h * h];
        let mut lu: Vec<f64> = block.iter().map(|&v| f64::from(v)).collect();
        let largest = lu.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        if largest == 0.0 {
            continue;
        }
        for k in 0..h {
            if (0..h).all(|l| lu[k + h * l] == 0.0) {
                lu[k + h * k] = largest;
            }
        }
        let pivots = dense_lu::factorise(&mut lu, h, 1e-6 * largest);
        let mut column = vec![0.0; h];
        for w in 0..h {
            column.fill(0.0);
            column[w] = 1.0;
            dense_lu::solve(&lu, h, &pivots, &mut column);
            (0..h).for_each(|k| out[k * h + w] = column[k] as f32);
        }
    }
    out
}

/// Inverse diagonal blocks, and the upper bound of the spectrum of `D⁻¹ A`.
fn spectrum(matrix: &BlockMatrix) -> (Vec<f32>, f32) {
    let inverse = inverse_diagonal(matrix);
    let radius = SAFETY * spectral_radius(matrix, &inverse);
    (inverse, radius)
}

/// Spectral radius of `D⁻¹ A` by power iteration, from below.
fn spectral_radius(matrix: &BlockMatrix, inverse: &[f32]) -> f32 {
    let n = matrix.rows * matrix.height;
    let mut x: Vec<f32> = check::pseudo_random(n).into_iter().map(|v| v as f32).collect();
    let (zero, mut y) = (vec![0.0; n], vec![0.0; n]);
    let norm = |v: &[f32]| v.iter().map(|&v| f64::from(v).powi(2)).sum::<f64>().sqrt() as f32;
    let mut radius = 1.0;
    for _ in 0..POWER_STEPS {
        let length = norm(&x);
        x.iter_mut().for_each(|x| *x /= length);
        matrix.smoothing_step(inverse, &zero, &x, [0.0, -1.0], &mut y);
        radius = norm(&y);
        std::mem::swap(&mut x, &mut y);
    }
    radius.max(f32::MIN_POSITIVE)
}
