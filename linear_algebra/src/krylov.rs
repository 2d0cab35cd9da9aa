//! Krylov engines: conjugate gradients and restarted GMRES with a preconditioner, on systems whose multipliers are
//! condensed.

use std::time::Instant;

use crate::check;
use crate::condensation::{Condensation, CondensationSettings, NotCondensable};
use crate::csr::Csr;
use crate::direct::DirectSolver;
use crate::ghosts::Ghosts;
use crate::iterations::{Gmres, Progress, conjugate_gradient};
use crate::memory;
use crate::precondition::{self, Precondition};
use crate::solver::{DirectSettings, KrylovSettings, LinearSolver, Multipliers, SolveError, SolveReport};
use crate::state::{State, WrongState};
use crate::system::{Stamps, System};
use crate::vector;

/// Krylov method.
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

    /// The name when multipliers are condensed.
    fn condensed_name(self) -> &'static str {
        match self {
            Self::ConjugateGradient => "conjugate_gradient, condensed",
            Self::Gmres { .. } => "gmres, condensed",
        }
    }
}

/// Directions kept when GMRES stands in for conjugate gradients.
const STAND_IN_RESTART: usize = 60;

/// The engines [`crate::Engine::ConjugateGradient`] and [`crate::Engine::Gmres`]; the direct engine takes over systems that they cannot
/// solve, and the report says so.
pub(crate) struct KrylovSolver {
    method: Method,
    settings: KrylovSettings,
    preconditioner: Option<(Box<dyn Precondition>, Stamps)>,
    stand_in: DirectSolver,
    condensed: Option<(Condensation, Stamps)>,
    condensations: u64,
    refused: Option<NotCondensable>,
}

/// Result and cost of an iteration.
struct Iterated {
    progress: Progress,
    method: Method,
    seconds_preconditioner: f64,
}

impl KrylovSolver {
    pub(crate) fn new(method: Method, settings: KrylovSettings) -> Self {
        Self {
            method,
            settings,
            preconditioner: None,
            stand_in: DirectSolver::new(DirectSettings::default()),
            condensed: None,
            condensations: 0,
            refused: None,
        }
    }

    /// The iteration that suits a system.
    fn method_for(&self, system: &System<'_>) -> Method {
        match self.method {
            Method::ConjugateGradient if !system.is_symmetric() => Method::Gmres { restart: STAND_IN_RESTART },
            method => method,
        }
    }

    /// Iterates on the matrix, as far as the iteration gets.
    fn iterate(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Iterated {
        let start = Instant::now();
        let method = self.method_for(system);
        let stamps = Stamps::of(system);
        if self.preconditioner.as_ref().is_none_or(|(_, old)| *old != stamps) {
            let merged: Option<Csr> = system.active_coupling().map(|_| system.merged());
            let matrix = merged.as_ref().unwrap_or(system.bulk);
            let made = precondition::create(self.settings.preconditioner, matrix, system.layout);
            self.preconditioner = Some((made, stamps));
        }
        let seconds_preconditioner = start.elapsed().as_secs_f64();
        let (preconditioner, _) = self.preconditioner.as_ref().expect("made above");
        let multiply = |x: &[f64], y: &mut [f64]| system.mul_vec(x, y);
        let apply = |r: &mut [f64]| preconditioner.apply(r);
        let (most, tolerance) = (self.settings.iterations, self.settings.tolerance);
        let mut progress = match method {
            Method::ConjugateGradient => {
                conjugate_gradient(&Ghosts::none(rhs.len()), multiply, apply, rhs, x, most, tolerance)
            }
            Method::Gmres { restart } => {
                let (ghosts, apply) = (Ghosts::none(rhs.len()), |r: &mut [f64], _| apply(r));
                Gmres::default().solve(None, &ghosts, multiply, apply, rhs, x, restart, most, tolerance)
            }
        };
        let scale = vector::norm(rhs);
        if scale > 0.0 {
            let mut residual = vec![0.0; rhs.len()];
            progress.relative_residual = system.residual(rhs, x, &mut residual) / scale;
        }
        Iterated { progress, method, seconds_preconditioner }
    }

    /// Iterates on the system without multipliers, and corrects for the terms that the condensation left out.
    fn iterate_condensed(
        &mut self,
        settings: &CondensationSettings,
        system: &System<'_>,
        rhs: &[f64],
        x: &mut [f64],
    ) -> Result<Iterated, NotCondensable> {
        let start = Instant::now();
        let stamps = Stamps::of(system);
        let (condensation, _) = match self.condensed.take().filter(|(_, old)| *old == stamps) {
            Some(kept) => kept,
            None => {
                self.condensations += 1;
                (Condensation::new(system, settings, self.condensations)?, stamps)
            }
        };
        let left = condensation.system();
        let mut sum = Iterated {
            progress: Progress { iterations: 0, start: 1.0, relative_residual: 1.0 },
            method: self.method_for(&left),
            seconds_preconditioner: start.elapsed().as_secs_f64(),
        };
        let scale = vector::norm(rhs);
        let mut residual = rhs.to_vec();
        let (mut trial, mut correction) = (vec![0.0; rhs.len()], vec![0.0; rhs.len()]);
        x.fill(0.0);
        for _ in 0..CORRECTIONS {
            let mut solution = vec![0.0; left.equations()];
            let inner = self.iterate(&left, &condensation.reduce(&residual), &mut solution);
            sum.progress.iterations += inner.progress.iterations;
            sum.seconds_preconditioner += inner.seconds_preconditioner;
            condensation.expand(&residual, &solution, &mut correction);
            trial.copy_from_slice(x);
            vector::add_scaled(1.0, &correction, &mut trial);
            let size = system.residual(rhs, &trial, &mut residual);
            let relative_residual = if scale > 0.0 { size / scale } else { 0.0 };
            let before = sum.progress.relative_residual;
            if relative_residual.is_nan() || relative_residual >= before {
                break;
            }
            x.copy_from_slice(&trial);
            sum.progress.relative_residual = relative_residual;
            let has_solved = inner.progress.relative_residual <= DRIFT * self.settings.tolerance;
            if relative_residual <= DRIFT * self.settings.tolerance || relative_residual > 0.5 * before || !has_solved {
                break;
            }
        }
        self.condensed = Some((condensation, stamps));
        Ok(sum)
    }
}

/// Solves of the condensed system before an answer is given up.
const CORRECTIONS: usize = 4;
/// Residual, as a multiple of the tolerance, that rounding in the recurrence of the residual excuses.
const DRIFT: f64 = 10.0;

impl LinearSolver for KrylovSolver {
    fn name(&self) -> &'static str {
        self.method.name()
    }

    fn says(&self) -> String {
        let condenses = matches!(self.settings.multipliers, Multipliers::Condense(_));
        format!("{}{}", self.name(), if condenses { ", multipliers are condensed" } else { "" })
    }

    fn not_condensed(&self) -> Option<NotCondensable> {
        self.refused
    }

    fn forget(&mut self) {
        self.stand_in.forget();
    }

    fn state(&self) -> Option<Box<dyn State>> {
        self.stand_in.state()
    }

    fn resume(&mut self, state: Box<dyn State>) -> Result<(), WrongState> {
        self.stand_in.resume(state)
    }

    fn needs(&self, equations: usize, entries: usize) -> u64 {
        memory::incomplete(equations, entries)
    }

    fn solve(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Result<SolveReport, SolveError> {
        check::input(system, rhs, x)?;
        check::empty_rows(system)?;
        if x.iter().any(|x| !x.is_finite()) {
            x.fill(0.0);
        }
        self.refused = None;
        let has_multipliers = system.layout.multiplier.contains(&true);
        let is_saddle = has_multipliers || (0..system.equations()).any(|i| system.bulk.row(i).0.is_empty());
        let start = Instant::now();
        let (iterated, condensed) = match self.settings.multipliers {
            Multipliers::Condense(settings) if has_multipliers => {
                match self.iterate_condensed(&settings, system, rhs, x) {
                    Ok(iterated) => (Ok(iterated), true),
                    Err(why) if settings.fallback => {
                        self.refused = Some(why);
                        (Err(format!("the multipliers are not condensed: {why}")), true)
                    }
                    Err(why) => return Err(SolveError::NotCondensable(why)),
                }
            }
            Multipliers::Keep => (Ok(self.iterate(system, rhs, x)), false),
            _ if is_saddle => (Err(format!("{} does not solve systems with multipliers", self.name())), false),
            _ => (Ok(self.iterate(system, rhs, x)), false),
        };
        let mut reasons = Vec::new();
        match iterated {
            Ok(Iterated { progress, method, seconds_preconditioner }) => {
                if method != self.method {
                    reasons.push("the matrix is not symmetric".into());
                }
                if progress.relative_residual <= DRIFT * self.settings.tolerance {
                    return Ok(SolveReport {
                        engine: if condensed { method.condensed_name() } else { method.name() },
                        relative_residual: progress.relative_residual,
                        iterations: progress.iterations,
                        fallback: reasons.pop(),
                        seconds_symbolic: 0.0,
                        seconds_numeric: seconds_preconditioner,
                        seconds_solve: start.elapsed().as_secs_f64() - seconds_preconditioner,
                    });
                }
                reasons.push(format!(
                    "{} reached only {:.1e} after {} iterations",
                    method.name(),
                    progress.relative_residual,
                    progress.iterations
                ));
            }
            Err(why) => reasons.push(why),
        }
        let mut report = self.stand_in.solve(system, rhs, x)?;
        reasons.extend(report.fallback.take());
        report.fallback = Some(reasons.join("; "));
        Ok(report)
    }
}
