//! Steps of every engine before and after its own work: check of the input, refinement and check of the solution.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::ghosts::Ghosts;
use crate::parallel;
use crate::prefetch::ROWS_AHEAD;
use crate::solver::SolveError;
use crate::system::System;
use crate::vector::{self, CHUNK};

/// Largest number of equations named in an error.
pub(crate) const NAMED_EQUATIONS: usize = 16;

/// Nodes without equations that a layout may have, for each equation.
const NODES_PER_EQUATION: usize = 64;

/// Refuses input whose sizes do not fit or that is not finite.
pub(crate) fn input(system: &System<'_>, rhs: &[f64], x: &[f64]) -> Result<(), SolveError> {
    vectors(system, rhs, x)?;
    matrices(system, true)
}

/// Refuses vectors whose sizes do not fit, and a right-hand side that is not finite.
pub(crate) fn vectors(system: &System<'_>, rhs: &[f64], x: &[f64]) -> Result<(), SolveError> {
    let n = system.equations();
    let sizes = [
        ("layout.node", system.layout.node.len()),
        ("layout.multiplier", system.layout.multiplier.len()),
        ("coupling", system.coupling.map_or(n, |coupling| coupling.rows)),
        ("right-hand side", rhs.len()),
        ("solution", x.len()),
    ];
    for (what, size) in sizes {
        if size != n {
            return Err(SolveError::Failed(format!("{what} has {size} equations, the matrix {n}")));
        }
    }
    if let Some(i) = system.layout.node.iter().position(|&node| node as usize > NODES_PER_EQUATION * (n + 1024)) {
        let node = system.layout.node[i];
        return Err(SolveError::Failed(format!("layout: node {node} of equation {i} is out of range, count from 0")));
    }
    if let Some(i) = rhs.iter().position(|b| !b.is_finite()) {
        return Err(SolveError::Failed(format!("right-hand side of equation {i} is {}", rhs[i])));
    }
    Ok(())
}

/// Refuses matrices that are not finite; the bulk is checked where asked for.
pub(crate) fn matrices(system: &System<'_>, looks_at_bulk: bool) -> Result<(), SolveError> {
    let bulk = Some(system.bulk).filter(|_| looks_at_bulk);
    for (what, matrix) in [("matrix", bulk), ("coupling matrix", system.coupling)] {
        let Some(matrix) = matrix else { continue };
        let is_whole = |chunk: &[f64]| chunk.iter().fold(true, |whole, a| whole & a.is_finite());
        let is_bad = AtomicBool::new(false);
        parallel::ranges(matrix.values.len(), CHUNK, &|own| {
            if !is_whole(&matrix.values[own]) {
                is_bad.store(true, Ordering::Relaxed);
            }
        });
        if is_bad.into_inner() {
            let at = matrix.values.iter().take_while(|a| a.is_finite()).count();
            let row = matrix.row_starts.partition_point(|&start| start <= at) - 1;
            let (column, value) = (matrix.columns_of(row)[at - matrix.row_starts[row]], matrix.values[at]);
            return Err(SolveError::Failed(format!("entry ({row}, {column}) of the {what} is {value}")));
        }
    }
    Ok(())
}

/// Equations whose row in the bulk is zero, such as those of multipliers.
pub(crate) fn zero_in_bulk(system: &System<'_>) -> Vec<usize> {
    let is_own = system.shared.map(Ghosts::is_own);
    let is_here = |i: &usize| is_own.as_ref().is_none_or(|is_own| is_own[*i]) && !system.layout.is_inactive(*i);
    let alone = System { coupling: None, ..*system };
    let is_zero = |i: &usize| {
        system.bulk.prefetch_row(*i + ROWS_AHEAD);
        alone.row(*i).next().is_none()
    };
    let found = parallel::select(system.equations(), CHUNK, |i| is_here(&i) && is_zero(&i));
    found.into_iter().map(|i| i as usize).collect()
}

/// Names equations whose row is zero, which no solver can solve.
pub(crate) fn empty_rows(system: &System<'_>) -> Result<(), SolveError> {
    empty_rows_among(system, &zero_in_bulk(system))
}

/// The same where [`zero_in_bulk`] is known.
pub(crate) fn empty_rows_among(system: &System<'_>, zero_in_bulk: &[usize]) -> Result<(), SolveError> {
    let is_zero = |i: &usize| system.row(*i).next().is_none();
    let empty: Vec<usize> = zero_in_bulk.iter().copied().filter(is_zero).collect();
    if empty.is_empty() {
        return Ok(());
    }
    let rank_deficiency = Some(empty.len());
    Err(SolveError::Singular { equations: empty.into_iter().take(NAMED_EQUATIONS).collect(), rank_deficiency })
}

/// Residual of a solution after steps of iterative refinement.
pub(crate) struct Refined {
    pub(crate) relative_residual: f64,
    pub(crate) steps: usize,
}

impl Refined {
    /// Whether the residual is small enough; never when it is not a number.
    pub(crate) fn reaches(&self, tolerance: f64) -> bool {
        self.relative_residual <= tolerance
    }
}

/// Share of `|A| |x|` that rounding may leave in a residual.
const ROUNDING: f64 = 1e-14;
/// Residual at which further refinement gains nothing.
pub(crate) const GOOD_ENOUGH: f64 = 1e-10;

/// `x = A⁻¹ rhs` by `inverse` (in place), improved while the true residual drops by at least a factor of two, until it is `enough`.
pub(crate) fn refine(
    system: &System<'_>,
    rhs: &[f64],
    x: &mut [f64],
    most_steps: usize,
    enough: f64,
    mut inverse: impl FnMut(&mut [f64]),
) -> Refined {
    let scale = vector::norm(rhs);
    x.fill(0.0);
    if scale == 0.0 {
        return Refined { relative_residual: 0.0, steps: 0 };
    }
    let mut correction = rhs.to_vec();
    inverse(&mut correction);
    x.copy_from_slice(&correction);
    let mut residual = vec![0.0; rhs.len()];
    let mut best = system.residual(rhs, x, &mut residual) / scale;
    let mut trial = vec![0.0; rhs.len()];
    for step in 0..most_steps {
        if best <= enough || best.is_nan() {
            return Refined { relative_residual: best, steps: step };
        }
        correction.copy_from_slice(&residual);
        inverse(&mut correction);
        trial.copy_from_slice(x);
        vector::add_scaled(1.0, &correction, &mut trial);
        let size = system.residual(rhs, &trial, &mut residual) / scale;
        if size < best {
            x.copy_from_slice(&trial);
        }
        if size.is_nan() || size > 0.5 * best {
            return Refined { relative_residual: best.min(size), steps: step + 1 };
        }
        best = size;
    }
    Refined { relative_residual: best, steps: most_steps }
}

/// `|A| |x|`, row by row, `x` being zero at inactive equations.
pub(crate) fn magnitude(system: &System<'_>, x: &[f64]) -> Vec<f64> {
    let of_row = |i: usize| {
        let matrices = [Some(system.bulk), system.active_coupling()].into_iter().flatten();
        matrices
            .map(|matrix| {
                let (columns, values) = matrix.row(i);
                columns.iter().zip(values).map(|(&j, a)| (a * x[j as usize]).abs()).sum::<f64>()
            })
            .sum()
    };
    (0..x.len()).map(|i| if system.layout.is_inactive(i) { 0.0 } else { of_row(i) }).collect()
}

/// Whether the residual of `x` is the rounding error of its own products, so that no method does better.
pub(crate) fn is_rounding(system: &System<'_>, rhs: &[f64], x: &[f64]) -> bool {
    let mut residual = vec![0.0; x.len()];
    system.residual(rhs, x, &mut residual) <= ROUNDING * vector::norm(&magnitude(system, x))
}

/// The error for a solution whose residual is too large.
pub(crate) fn refused(engine: &'static str, refined: &Refined, tolerance: f64) -> SolveError {
    SolveError::NotConverged {
        engine,
        iterations: refined.steps,
        relative_residual: refined.relative_residual,
        tolerance,
    }
}

/// Entries without pattern, the same every time.
pub(crate) fn pseudo_random(n: usize) -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    (0..n)
        .map(|_| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        })
        .collect()
}
