//! Krylov engines: conjugate gradients and restarted GMRES with a preconditioner.

mod conjugate_gradient;
mod gmres;

use std::time::Instant;

pub(crate) use conjugate_gradient::conjugate_gradient;
pub(crate) use gmres::gmres;

use crate::check;
use crate::csr::Csr;
use crate::direct::DirectSolver;
use crate::precondition::{self, Precondition};
use crate::solver::{DirectSettings, KrylovSettings, LinearSolver, SolveError, SolveReport};
use crate::system::{Stamps, System};
use crate::vector;

/// How far an iteration came.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Progress {
    pub(crate) iterations: usize,
    pub(crate) relative_residual: f64,
}

/// Which iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Method {
    ConjugateGradient,
    Gmres { restart: usize },
}

impl Method {
    fn name(self) -> &'static str {
        match self {
            Self::ConjugateGradient => "conjugate_gradient",
            Self::Gmres { .. } => "gmres",
        }
    }
}

/// Directions kept when GMRES stands in for conjugate gradients.
const STAND_IN_RESTART: usize = 60;

/// The engines [`crate::Engine::ConjugateGradient`] and [`crate::Engine::Gmres`]; the direct engine takes over what
/// they cannot do, and the report says so.
pub(crate) struct KrylovSolver {
    method: Method,
    settings: KrylovSettings,
    preconditioner: Option<(Box<dyn Precondition>, Stamps)>,
    stand_in: DirectSolver,
}

impl KrylovSolver {
    pub(crate) fn new(method: Method, settings: KrylovSettings) -> Self {
        Self { method, settings, preconditioner: None, stand_in: DirectSolver::new(DirectSettings::default()) }
    }

    /// Iterates on the matrix; `None` when the iteration did not get there.
    fn iterate(&mut self, method: Method, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> (Progress, f64) {
        let start = Instant::now();
        let stamps = Stamps::of(system);
        if self.preconditioner.as_ref().is_none_or(|(_, old)| *old != stamps) {
            let merged: Option<Csr> = system.active_coupling().map(|_| system.merged());
            let matrix = merged.as_ref().unwrap_or(system.bulk);
            let made = precondition::create(self.settings.preconditioner, matrix, system.layout);
            self.preconditioner = Some((made, stamps));
        }
        let seconds = start.elapsed().as_secs_f64();
        let (preconditioner, _) = self.preconditioner.as_ref().expect("made above");
        let multiply = |x: &[f64], y: &mut [f64]| system.mul_vec(x, y);
        let apply = |r: &mut [f64]| preconditioner.apply(r);
        let (most, tolerance) = (self.settings.iterations, self.settings.tolerance);
        let mut progress = match method {
            Method::ConjugateGradient => conjugate_gradient(multiply, apply, rhs, x, most, tolerance),
            Method::Gmres { restart } => gmres(multiply, apply, rhs, x, restart, most, tolerance),
        };
        let scale = vector::norm(rhs);
        if scale > 0.0 {
            let mut residual = vec![0.0; rhs.len()];
            progress.relative_residual = system.residual(rhs, x, &mut residual) / scale;
        }
        (progress, seconds)
    }
}

/// Residual, as a multiple of the tolerance, that rounding in the recurrence of the residual excuses.
const DRIFT: f64 = 10.0;

impl LinearSolver for KrylovSolver {
    fn name(&self) -> &'static str {
        self.method.name()
    }

    fn solve(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Result<SolveReport, SolveError> {
        check::input(system, rhs, x)?;
        check::empty_rows(system)?;
        if x.iter().any(|x| !x.is_finite()) {
            x.fill(0.0);
        }
        let is_saddle = (0..system.equations()).any(|i| system.layout.multiplier[i] || system.bulk.row(i).0.is_empty());
        let mut reasons = Vec::new();
        if is_saddle {
            reasons.push(format!("{} does not solve systems with multipliers", self.name()));
        } else {
            let method = match self.method {
                Method::ConjugateGradient if !system.is_symmetric() => {
                    reasons.push("the matrix is not symmetric".into());
                    Method::Gmres { restart: STAND_IN_RESTART }
                }
                method => method,
            };
            let start = Instant::now();
            let (progress, seconds_numeric) = self.iterate(method, system, rhs, x);
            if progress.relative_residual <= DRIFT * self.settings.tolerance {
                return Ok(SolveReport {
                    engine: method.name(),
                    relative_residual: progress.relative_residual,
                    iterations: progress.iterations,
                    fallback: reasons.pop(),
                    seconds_symbolic: 0.0,
                    seconds_numeric,
                    seconds_solve: start.elapsed().as_secs_f64() - seconds_numeric,
                });
            }
            reasons.push(format!(
                "{} reached only {:.1e} after {} iterations",
                method.name(),
                progress.relative_residual,
                progress.iterations
            ));
        }
        let mut report = self.stand_in.solve(system, rhs, x)?;
        reasons.extend(report.fallback.take());
        report.fallback = Some(reasons.join("; "));
        Ok(report)
    }
}
