//! Sparse LU with column ordering (COLAMD) and partial pivoting: slow, but asks nothing of the matrix.

use std::time::Instant;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::lu::{LuRef, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};

use crate::check;
use crate::csr::Csr;
use crate::equilibrate;
use crate::multifrontal::Scaling;
use crate::solver::{LinearSolver, SolveError, SolveReport};
use crate::system::{Stamps, System};

/// Relative residual above which a solution is refused.
const TOLERANCE: f64 = 1e-6;
/// Largest number of steps of iterative refinement.
const REFINEMENTS: usize = 5;

/// A factorised matrix.
pub(crate) struct SparseLu {
    scaling: Scaling,
    symbolic: SymbolicLu<usize>,
    numeric: NumericLu<usize, f64>,
}

impl SparseLu {
    /// Orders and factorises `matrix`.
    ///
    /// # Errors
    /// [`SolveError::Singular`] when the pattern is singular, [`SolveError::Failed`] when memory runs out.
    pub(crate) fn new(matrix: &Csr) -> Result<Self, SolveError> {
        let scaling = equilibrate::factors(matrix);
        let by_columns = Csr { values: scaling.apply(matrix), ..matrix.clone() }.transpose();
        let columns: Vec<usize> = by_columns.columns.iter().map(|&j| j as usize).collect();
        let n = matrix.rows;
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &by_columns.row_starts, None, &columns);
        let failed = |error: LuError| match error {
            LuError::SymbolicSingular { index } => {
                SolveError::Singular { equations: vec![index], rank_deficiency: None }
            }
            LuError::Generic(error) => SolveError::Failed(format!("sparse LU: {error:?}")),
        };
        let symbolic =
            factorize_symbolic_lu(pattern, Default::default()).map_err(|error| failed(LuError::Generic(error)))?;
        let mut numeric = NumericLu::new();
        let need = symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(need).map_err(|_| SolveError::Failed("sparse LU: out of memory".into()))?;
        symbolic
            .factorize_numeric_lu(
                &mut numeric,
                SparseColMatRef::new(pattern, &by_columns.values),
                Par::Seq,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .map_err(failed)?;
        Ok(Self { scaling, symbolic, numeric })
    }

    /// Replaces `x` by `A⁻¹ x`.
    pub(crate) fn solve_in_place(&self, x: &mut [f64]) {
        let n = x.len();
        x.iter_mut().zip(&self.scaling.row).for_each(|(x, scale)| *x *= scale);
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        LuRef::new_unchecked(&self.symbolic, &self.numeric).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, n, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        x.iter_mut().zip(&self.scaling.column).for_each(|(x, scale)| *x *= scale);
    }
}

/// The engine `sparse_lu`: one [`SparseLu`] of the whole matrix, kept while no value changes.
#[derive(Default)]
pub(crate) struct LuSolver {
    factor: Option<(SparseLu, Stamps)>,
}

impl LinearSolver for LuSolver {
    fn name(&self) -> &'static str {
        "sparse_lu"
    }

    fn keeps_factors(&self, _: usize, _: usize) -> bool {
        true
    }

    fn solve(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Result<SolveReport, SolveError> {
        check::input(system, rhs, x)?;
        let start = Instant::now();
        let stamps = Stamps::of(system);
        if self.factor.as_ref().is_none_or(|(_, old)| *old != stamps) {
            self.factor = None;
            check::empty_rows(system)?;
            self.factor = Some((SparseLu::new(&system.merged())?, stamps));
        }
        let numeric = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let (factor, _) = self.factor.as_ref().expect("factorised above");
        let refined = check::refine(system, rhs, x, REFINEMENTS, check::GOOD_ENOUGH, |r| factor.solve_in_place(r));
        if !refined.reaches(TOLERANCE) {
            return Err(check::refused(self.name(), &refined, TOLERANCE));
        }
        Ok(SolveReport {
            engine: self.name(),
            relative_residual: refined.relative_residual,
            iterations: refined.steps,
            fallback: None,
            seconds_symbolic: 0.0,
            seconds_numeric: numeric,
            seconds_solve: start.elapsed().as_secs_f64(),
        })
    }
}
