//! Solves distributed systems, keeps reusable data, and judges every solution by its true residual.

use std::ffi::{CStr, CString, c_int};

use zelus_linear_algebra::{SolveError, SolveReport, Symmetry};

use crate::engine::PetscEngine;
use crate::ffi::{self, Handle, RawReport};
use crate::matrix::{DistributedMatrix, Packed};
use crate::session::{Communicator, check};

/// Equations named in an error, of each rank.
const NAMED: usize = 4;
/// Share of the largest number of a free motion above which an equation is suspicious.
const SUSPICIOUS: f64 = 1e-6;
/// Residual, as a share of `‖A‖ ‖x‖`, that rounding alone may leave.
const ROUNDING: f64 = 1e-13;
/// `‖A‖ ‖x‖ / ‖b‖` from which an answer that misses its equations shows a free motion.
const FREE: f64 = 1e13;

/// Settings of the distributed solver.
#[derive(Debug, Clone, PartialEq)]
pub struct PetscSettings {
    /// The engine; `None` follows the rule of [`PetscEngine::choose`].
    pub engine: Option<PetscEngine>,
    /// Relative residual at which Krylov iteration stops.
    pub tolerance: f64,
    /// Largest number of Krylov iterations.
    pub iterations: usize,
    /// Relative residual above which a solution is refused.
    pub refused_above: f64,
    /// Options of PETSc, as on its command line; they win over those of the engine.
    pub options: String,
}

impl Default for PetscSettings {
    fn default() -> Self {
        Self { engine: None, tolerance: 1e-9, iterations: 1000, refused_above: 1e-6, options: String::new() }
    }
}

/// A solver of distributed systems.
///
/// The symbolic factorisation is kept while the pattern is unchanged, the numeric one while the values are.
pub struct DistributedSolver {
    comm: Communicator,
    settings: PetscSettings,
    kept: Option<Kept>,
    /// The engine that replaces one which failed, from then on, and why.
    spare: Option<(PetscEngine, String)>,
}

struct Kept {
    handle: *mut Handle,
    engine: PetscEngine,
    packed: Packed,
    graph: u64,
    stamp: u64,
    symmetry: Symmetry,
    /// Whether the present factors have passed the test for singularity.
    trusted: bool,
}

// SAFETY: the handle is used by whoever holds the solver, one thread at a time.
unsafe impl Send for DistributedSolver {}

impl Drop for Kept {
    fn drop(&mut self) {
        // SAFETY: the handle came from zp_create and is not used again.
        unsafe { ffi::zp_destroy(self.handle) };
    }
}

impl DistributedSolver {
    /// A solver on the ranks of `comm`; keep the [`crate::Session`] alive as long.
    pub fn new(comm: Communicator, settings: PetscSettings) -> Self {
        Self { comm, settings, kept: None, spare: None }
    }

    /// Solves `matrix x = rhs`; both hold the owned entries. Collective.
    ///
    /// An engine of multigrid that fails is replaced by a factorisation without the user's options, for all solves to
    /// come, and the report says so.
    ///
    /// # Errors
    /// The same on all ranks: [`SolveError::Singular`] with equations counted over all ranks, [`SolveError::NotConverged`] when the
    /// residual stays too large, [`SolveError::Failed`] for input that does not fit or is not finite, and for errors of PETSc.
    pub fn solve(
        &mut self,
        matrix: &DistributedMatrix<'_>,
        rhs: &[f64],
        x: &mut [f64],
    ) -> Result<SolveReport, SolveError> {
        let equations = matrix.check(self.comm)?;
        let fits = rhs.len() == matrix.rows() && x.len() == matrix.rows() && rhs.iter().all(|b| b.is_finite());
        if !self.comm.all(fits) {
            return Err(SolveError::Failed("right-hand side: it is not finite or does not fit the matrix".to_owned()));
        }
        let chosen = || PetscEngine::choose(equations, matrix.symmetry, matrix.has_multipliers);
        let engine = self.settings.engine.unwrap_or_else(chosen);
        if self.spare.is_none() {
            match self.attempt(engine, matrix, rhs, x) {
                Err(problem) if !engine.is_direct() => {
                    let general = matrix.symmetry == Symmetry::General;
                    let spare = if general { PetscEngine::MumpsLu } else { PetscEngine::MumpsLdlt };
                    self.spare = Some((spare, format!("{}: {problem}", engine.name())));
                }
                other => return other,
            }
        }
        let (spare, why) = self.spare.clone().unwrap_or((PetscEngine::MumpsLu, String::new()));
        let report = self.attempt(spare, matrix, rhs, x)?;
        Ok(SolveReport { fallback: Some(why), ..report })
    }

    /// Names of the user's options that nothing has read so far.
    pub fn unread_options(&self) -> Vec<String> {
        let Some(kept) = &self.kept else { return Vec::new() };
        let mut text = [0; 1024];
        // SAFETY: the handle is live and the text has the size given.
        unsafe { ffi::zp_unread_options(kept.handle, text.as_mut_ptr(), text.len() as c_int) };
        // SAFETY: the C side ends the text in 0 within its size.
        let text = unsafe { CStr::from_ptr(text.as_ptr()) }.to_string_lossy();
        let given = |name: &&str| self.settings.options.split_whitespace().any(|word| word == *name);
        text.split_whitespace().filter(given).map(str::to_owned).collect()
    }

    fn attempt(
        &mut self,
        engine: PetscEngine,
        matrix: &DistributedMatrix<'_>,
        rhs: &[f64],
        x: &mut [f64],
    ) -> Result<SolveReport, SolveError> {
        self.prepare(engine, matrix)?;
        let result = self.run(engine, matrix, rhs, x);
        if result.is_err() {
            self.kept = None;
        }
        result
    }

    /// Brings the matrix to PETSc: nothing, its values, or all of it.
    fn prepare(&mut self, engine: PetscEngine, matrix: &DistributedMatrix<'_>) -> Result<(), SolveError> {
        if let Some(kept) = &mut self.kept
            && (kept.engine, kept.graph, kept.symmetry) == (engine, matrix.graph, matrix.symmetry)
        {
            if kept.stamp == matrix.stamp {
                return Ok(());
            }
            kept.packed.refill(matrix.values);
            // SAFETY: the handle is live and its pattern has as many entries as `packed`.
            check("new values", unsafe { ffi::zp_update(kept.handle, kept.packed.values.as_ptr()) })?;
            kept.stamp = matrix.stamp;
            kept.trusted = false;
            return Ok(());
        }
        self.kept = None;
        let packed = Packed::new(matrix);
        let of_user = if self.spare.is_some() { "" } else { self.settings.options.as_str() };
        let options = format!("{} {of_user}", engine.options(self.settings.tolerance, self.settings.iterations));
        let options = CString::new(options).map_err(|_| SolveError::Failed("PETSc options hold a zero".to_owned()))?;
        let symmetry = match matrix.symmetry {
            Symmetry::General => 0,
            _ if engine.is_direct() => 1,
            Symmetry::Symmetric => 1,
            Symmetry::PositiveDefinite => 2,
        };
        let block = self.block_size(matrix);
        let rows = matrix.rows() as i64;
        let mut handle = std::ptr::null_mut();
        // SAFETY: the arrays have the lengths that `rows` and `starts` tell, columns were checked, options end in 0.
        let code = unsafe {
            ffi::zp_create(
                self.comm.raw(),
                rows,
                packed.starts.as_ptr(),
                packed.columns.as_ptr(),
                packed.values.as_ptr(),
                symmetry,
                block,
                options.as_ptr(),
                &mut handle,
            )
        };
        check("the matrix", code)?;
        let (graph, stamp, symmetry) = (matrix.graph, matrix.stamp, matrix.symmetry);
        self.kept = Some(Kept { handle, engine, packed, graph, stamp, symmetry, trusted: false });
        if let (Some(modes), false) = (matrix.modes, engine.is_direct()) {
            let vectors = modes.vectors(self.centre(&modes.coordinates));
            let all: Vec<f64> = vectors.concat();
            // SAFETY: `all` holds `rows` numbers for each vector; the handle is live.
            let code = unsafe { ffi::zp_near_null_space(handle, vectors.len() as c_int, rows, all.as_ptr()) };
            check("the near null space", code)?;
        }
        Ok(())
    }

    /// Equations a node, where all nodes on all ranks have all of theirs in order; else 1. Collective.
    fn block_size(&self, matrix: &DistributedMatrix<'_>) -> c_int {
        let whole = |dimension: usize, components: &[u8]| {
            components.len().is_multiple_of(dimension)
                && components.chunks_exact(dimension).all(|node| node.iter().enumerate().all(|(a, &c)| a == c.into()))
        };
        let dimension = matrix.modes.map_or(1, |modes| modes.dimension).max(1);
        let is_whole = matrix.modes.is_none_or(|modes| whole(dimension, &modes.components));
        if self.comm.all(is_whole) { dimension as c_int } else { 1 }
    }

    /// Mean position over all ranks. Collective.
    fn centre(&self, coordinates: &[[f64; 3]]) -> [f64; 3] {
        let mut own = [0.0, 0.0, 0.0, coordinates.len() as f64];
        coordinates.iter().for_each(|x| (0..3).for_each(|k| own[k] += x[k]));
        let mut sum = [0.0; 4];
        self.comm.gather(&own).chunks_exact(4).for_each(|of_rank| (0..4).for_each(|k| sum[k] += of_rank[k]));
        [0, 1, 2].map(|k| sum[k] / sum[3].max(1.0))
    }

    fn raw_solve(&self, rhs: &[f64], x: &mut [f64], residual: Option<&mut [f64]>) -> Result<RawReport, SolveError> {
        let Some(kept) = &self.kept else { return Err(SolveError::Failed("PETSc: there is no matrix".to_owned())) };
        let mut report = RawReport::default();
        let refinements = if kept.engine.is_direct() { 3 } else { 0 };
        let residual = residual.map_or(std::ptr::null_mut(), <[f64]>::as_mut_ptr);
        // SAFETY: the handle is live, the vectors have as many entries as it has owned rows.
        let code = unsafe {
            let (rows, x) = (rhs.len() as i64, x.as_mut_ptr());
            ffi::zp_solve(kept.handle, rows, rhs.as_ptr(), x, residual, refinements, &mut report)
        };
        check("solving", code)?;
        Ok(report)
    }

    fn run(
        &mut self,
        engine: PetscEngine,
        matrix: &DistributedMatrix<'_>,
        rhs: &[f64],
        x: &mut [f64],
    ) -> Result<SolveReport, SolveError> {
        let raw = self.raw_solve(rhs, x, None)?;
        if !raw.rhs_norm.is_finite() || !raw.matrix_norm.is_finite() {
            return Err(SolveError::Failed(
                "the norm of the matrix or of the right-hand side is not finite".to_owned(),
            ));
        }
        if raw.pc_failed != 0 {
            return Err(self.failed_setup(engine, &raw));
        }
        let trusted = self.kept.as_ref().is_some_and(|kept| kept.trusted);
        if raw.null_pivots > 0 && !trusted {
            self.probe(matrix, raw.null_pivots)?;
        }
        if let Some(kept) = &mut self.kept {
            kept.trusted = true;
        }
        let scale = if raw.rhs_norm > 0.0 { raw.rhs_norm } else { 1.0 };
        let relative_residual = raw.residual_norm / scale;
        let is_rounding = raw.residual_norm <= ROUNDING * raw.matrix_norm * raw.answer_norm;
        if engine.is_direct() && relative_residual > self.settings.refused_above && raw.growth() > FREE {
            return Err(self.singular(matrix.first_row, x, raw.null_pivots.max(1)));
        }
        if raw.rhs_norm > 0.0 && !(relative_residual <= self.settings.refused_above || is_rounding) {
            return Err(SolveError::NotConverged {
                engine: engine.name(),
                iterations: raw.iterations as usize,
                relative_residual,
                tolerance: self.settings.refused_above,
            });
        }
        if raw.reason < 0 && !is_rounding && relative_residual > 10.0 * self.settings.tolerance {
            // SAFETY: PETSc's table of words holds every reason it gives.
            let word = unsafe { CStr::from_ptr(ffi::zp_reason(raw.reason)) }.to_string_lossy();
            let fact = format!("{} stopped after {} iterations: {word}", engine.name(), raw.iterations);
            return Err(SolveError::Failed(format!("{fact}, relative residual {relative_residual:.3e}")));
        }
        Ok(SolveReport {
            engine: engine.name(),
            relative_residual,
            iterations: if engine.is_direct() { raw.refinements } else { raw.iterations } as usize,
            fallback: None,
            seconds_symbolic: 0.0,
            seconds_numeric: raw.seconds_setup,
            seconds_solve: raw.seconds_solve,
        })
    }

    /// Solves for a right-hand side no motion is free of: a singular matrix leaves a residual, and where it does.
    fn probe(&self, matrix: &DistributedMatrix<'_>, null_pivots: i64) -> Result<(), SolveError> {
        let rows = matrix.rows();
        let mut state = 0x9e37_79b9_7f4a_7c15_u64 ^ matrix.first_row.wrapping_mul(0x2545_f491_4f6c_dd1d);
        let mut random = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let rhs: Vec<f64> = (0..rows).map(|_| random()).collect();
        let (mut x, mut residual) = (vec![0.0; rows], vec![0.0; rows]);
        let raw = self.raw_solve(&rhs, &mut x, Some(&mut residual))?;
        if raw.growth() > FREE {
            return Err(self.singular(matrix.first_row, &x, null_pivots));
        }
        let limit = raw.rhs_norm * self.settings.refused_above;
        if raw.residual_norm <= limit || raw.residual_norm <= ROUNDING * raw.matrix_norm * raw.answer_norm {
            return Ok(());
        }
        Err(self.singular(matrix.first_row, &residual, null_pivots))
    }

    /// The error that names the equations with the largest of these numbers, over all ranks. Collective.
    fn singular(&self, first_row: u64, sizes: &[f64], null_pivots: i64) -> SolveError {
        let mut worst: Vec<usize> = (0..sizes.len()).collect();
        worst.sort_by(|&a, &b| sizes[b].abs().total_cmp(&sizes[a].abs()));
        let mut own = [0.0_f64; 2 * NAMED];
        for (pair, &row) in own.chunks_exact_mut(2).zip(&worst) {
            pair.copy_from_slice(&[(first_row + row as u64) as f64, sizes[row].abs()]);
        }
        let all = self.comm.gather(&own);
        let mut named: Vec<(f64, usize)> =
            all.chunks_exact(2).map(|pair| (pair[1], pair[0] as usize)).filter(|(size, _)| *size > 0.0).collect();
        named.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let largest = named.first().map_or(0.0, |(size, _)| *size);
        named.retain(|(size, _)| *size > SUSPICIOUS * largest);
        SolveError::Singular {
            equations: named.into_iter().map(|(_, equation)| equation).take(4 * NAMED).collect(),
            rank_deficiency: Some(null_pivots as usize),
        }
    }

    /// Error of MUMPS or GAMG in the setup.
    fn failed_setup(&self, engine: PetscEngine, raw: &RawReport) -> SolveError {
        let detail = raw.factor_detail;
        match raw.factor_error {
            -10 | -6 => SolveError::Singular { equations: Vec::new(), rank_deficiency: None },
            0 => SolveError::Failed(format!("{}: the preconditioner cannot be set up", engine.name())),
            -13 | -7 | -19 => SolveError::Failed(format!(
                "{}: not enough memory for the factors (MUMPS {}, {detail}); more ranks on more machines share them",
                engine.name(),
                raw.factor_error
            )),
            error => SolveError::Failed(format!("{}: MUMPS gave up with error {error} ({detail})", engine.name())),
        }
    }
}
