//! Engine of large systems: flexible GMRES on the whole system in double precision, preconditioned by a single-precision multigrid solve
//! of the reduced system ([`Blocks`]), or by one cycle where a hierarchy of an earlier matrix needs few iterations.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::check;
use crate::csr::{Csr, Runs};
use crate::direct::DirectSolver;
use crate::iterations::{Gmres, PreviousSolution, PreviousSolutions, Progress};
use crate::memory;
use crate::precondition::{Constrained, Multigrid, ReducedSystemCache};
use crate::reduced::Reduced;
use crate::solver::{DirectSettings, LinearSolver, MultigridSettings, SolveError, SolveReport};
use crate::state::{State, StateMapper, WrongState};
use crate::stored_as_bytes;
use crate::system::{Stamps, System};
use crate::vector;

/// Directions kept before a restart.
const RESTART: usize = 80;
/// Iterations from which on it pays to make the reduced system, where the hierarchy is one of an earlier matrix: of a new bulk, and of
/// one that only has other constraints, most of whose rows are known.
const PAYS: [f64; 2] = [10.0, 3.0];
/// Share of a residual that a solve leaves at least: beyond it rounding counts.
const REACHED: f64 = 1e-4;
/// Largest share of a residual that a solve may leave.
const LOOSEST_FORCING_TERM: f64 = 0.5;
/// Accuracy of a solve, relative to the gain of the one before for the whole system: beyond it the constraints that the blocks leave
/// out count.
const WORTH: f64 = 0.3;
/// Share of the digits asked of a solve that the residual of the whole system gains at least.
const GAINED: f64 = 0.5;
/// Growth of the iterations by digit, and their number beside it, from which on the hierarchy is made anew.
const STALE: (f64, f64) = (1.3, 0.3);
/// Digits from which on they say how well a hierarchy does.
const TELLING: f64 = 2.0;
/// Failures in a row after which multigrid is not tried again.
const FAILURES: usize = 2;
/// Share of the nodes with multipliers that may prescribe other motions than when the hierarchy was made.
const CHANGED: f64 = 0.01;
/// Residual, as a multiple of the tolerance, that rounding in the recurrence of the residual excuses.
const DRIFT: f64 = 10.0;

/// Nanoseconds of an iteration for an entry of the matrix and of its levels, of a factorisation in space for the square of the
/// equations, and of that of an interface for the cube of its own: by their ratios alone it is judged which is less.
const COSTS: [f64; 3] = [4.0, 0.8, 0.02];
/// Iterations that levels cost as much as.
const SET_UP: usize = 16;
/// Equations up to which factors may take over; more would take more than a gigabyte.
const FALLS_BACK_UP_TO: usize = 70_000;

/// A hierarchy, and how well it did when it was new.
#[derive(Clone, Serialize, Deserialize)]
struct Hierarchy {
    levels: Arc<Multigrid>,
    /// Divisor of their matrix.
    size: f64,
    bulk_graph: u64,
    /// Motions that the nodes with multipliers prescribed.
    prescribed: Vec<(u32, u32)>,
    /// Whether the matrix has changed since.
    is_old: bool,
    /// Whether it serves the matrix that it was made of and no other.
    is_bound: bool,
    /// Iterations by digit, of the first solve and of the last.
    first: Option<f64>,
    last: f64,
}

impl Hierarchy {
    fn suits(&self, system: &System<'_>, constrained: &Constrained) -> bool {
        if self.bulk_graph != system.bulk_graph {
            return false;
        }
        if !self.is_old {
            return true;
        }
        let prescribed = constrained.prescribed();
        let before: BTreeSet<_> = self.prescribed.iter().collect();
        let changed = prescribed.iter().filter(|now| !before.contains(now)).count()
            + self.prescribed.len().saturating_sub(prescribed.len());
        let ghosts = constrained.ghosts();
        let (changed, before) = (ghosts.total(changed as f64), ghosts.total(self.prescribed.len() as f64));
        self.last <= STALE.0 * self.first.unwrap_or(self.last) + STALE.1 && changed <= CHANGED * before
    }
}

/// The engine [`crate::Engine::Multigrid`]; the direct engine takes over systems that it cannot solve, and the report says so.
pub(crate) struct MultigridSolver {
    settings: MultigridSettings,
    constrained: Option<(Constrained, Stamps)>,
    reduced: ReducedSystemCache,
    /// Stamps of the last bulk that was checked, and its equations that are zero.
    seen: Option<([u64; 2], Vec<usize>)>,
    /// Runs of the bulk's rows, with the stamp of its graph.
    runs: Option<(u64, Runs)>,
    hierarchy: Option<Hierarchy>,
    history: SolveHistory,
    /// The iterations on the whole system, and on the reduced system.
    outer: Gmres<f64>,
    inner: Gmres<f32>,
    /// Relative residual to reach.
    tolerance: f64,
    stand_in: DirectSolver,
}

/// State that the engine keeps between solves.
#[derive(Clone, Default, Serialize, Deserialize)]
struct SolveHistory {
    previous_solutions: PreviousSolutions,
    /// Solves one after the other that multigrid did not do; one more once that is told.
    failures: usize,
    /// Graph of the bulk for which solves of the reduced system gained little for the whole one: cycles alone serve it.
    takes_cycles: Option<u64>,
    /// Whether a solve would have paid for a factorisation: the direct engine solves.
    has_fallen_back: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct MultigridState {
    history: SolveHistory,
    /// Hierarchy of an earlier matrix than the last.
    hierarchy: Option<Hierarchy>,
    stand_in: Option<Box<dyn State>>,
}

stored_as_bytes!(MultigridState);

#[typetag::serde(name = "multigrid")]
impl State for MultigridState {
    /// Levels and previous solutions are of the equations of a rank.
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        (self.hierarchy, self.history.previous_solutions) = (None, PreviousSolutions::default());
        self.stand_in.iter_mut().for_each(|state| state.remap(mapper));
    }
}

impl MultigridSolver {
    pub(crate) fn new(settings: MultigridSettings) -> Self {
        let stand_in = DirectSolver::new(DirectSettings::default());
        let (tolerance, history) = (settings.tolerance, SolveHistory::default());
        let (outer, inner) = Default::default();
        let (constrained, reduced, seen, runs, hierarchy) = Default::default();
        Self { settings, constrained, reduced, seen, runs, hierarchy, history, outer, inner, tolerance, stand_in }
    }

    /// Solves a system that several ranks share; one that does not does less than the rest, so all agree on errors.
    fn solve_shared(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Result<SolveReport, SolveError> {
        let checked = check::input(system, rhs, x).and_then(|()| check::empty_rows(system));
        if system.ghosts().any(checked.is_err()) {
            return Err(checked
                .err()
                .unwrap_or_else(|| SolveError::Failed("input of another rank is unusable".to_owned())));
        }
        let solved = self.attempt(system, rhs, x).map_err(SolveError::Failed);
        self.history.failures = if solved.is_ok() { 0 } else { self.history.failures + 1 };
        solved
    }

    /// Whether multigrid is to solve a system, by its size and the outcome of earlier solves.
    fn serves(&self, system: &System<'_>) -> bool {
        self.shares(system.free(), system.bulk.entries())
    }

    /// Iterations of a solve after which a factorisation would have been cheaper than these and the levels.
    fn patience(&self, system: &System<'_>) -> usize {
        let (equations, entries) = (system.free(), system.bulk.entries());
        let may_fall_back = self.settings.falls_back && system.shared.is_none() && equations <= FALLS_BACK_UP_TO;
        if may_fall_back && memory::is_dense(equations, entries) {
            let coupled = |coupling: &Csr| (0..coupling.rows).filter(|&i| !coupling.row(i).0.is_empty()).count();
            let [iteration, bulk, interface] = COSTS;
            let interface = interface * (system.coupling.map_or(0, coupled) as f64).powi(3);
            let of_levels = self.hierarchy.as_ref().map_or(1.0, |hierarchy| hierarchy.levels.complexity());
            let iteration = iteration * of_levels * entries as f64;
            let iterations = (bulk * (equations as f64).powi(2) + interface) / iteration;
            (iterations as usize).saturating_sub(SET_UP)
        } else {
            usize::MAX
        }
    }

    fn is_large(&self, equations: usize, entries: usize) -> bool {
        equations >= self.settings.least[usize::from(!memory::is_dense(equations, entries))]
    }

    /// Brings the constraints and the hierarchy up to date, or says which multiplier nothing determines; collective.
    fn prepare(&mut self, system: &System<'_>) -> Result<(), String> {
        if self.runs.as_ref().is_none_or(|(graph, _)| *graph != system.bulk_graph) {
            self.runs = Some((system.bulk_graph, system.bulk.runs()));
        }
        let stamps = Stamps::of(system);
        if self.constrained.as_ref().is_none_or(|(_, old)| *old != stamps) {
            self.constrained = None;
            let made = Constrained::new(system).map_err(|m| format!("no unknown of its own determines multiplier {m}"));
            if system.ghosts().any(made.is_err()) {
                return Err(made.err().unwrap_or_else(|| "a multiplier of another rank is not determined".to_owned()));
            }
            self.constrained = made.ok().map(|constrained| (constrained, stamps));
            self.hierarchy = self.hierarchy.take().filter(|hierarchy| !hierarchy.is_bound);
            self.hierarchy.iter_mut().for_each(|hierarchy| hierarchy.is_old = true);
        }
        self.hierarchy.iter_mut().for_each(|hierarchy| hierarchy.is_bound = false);
        let (constrained, _) = self.constrained.as_ref().expect("made above");
        if !self.hierarchy.as_ref().is_some_and(|hierarchy| hierarchy.suits(system, constrained)) {
            self.hierarchy = None;
            let reduced = self.reduced.up_to_date(constrained, system);
            self.hierarchy = Some(Hierarchy {
                levels: Arc::new(constrained.hierarchy(system, reduced)),
                size: reduced.size,
                bulk_graph: system.bulk_graph,
                prescribed: constrained.prescribed(),
                is_old: false,
                is_bound: false,
                first: None,
                last: 0.0,
            });
            if system.shared.is_some() {
                memory::give_back();
            }
        }
        Ok(())
    }

    /// At most `most` iterations.
    fn iterate(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64], most: usize) -> Progress {
        let (constrained, _) = self.constrained.as_ref().expect("prepared");
        let hierarchy = self.hierarchy.as_mut().expect("prepared");
        let (_, runs) = self.runs.as_ref().expect("prepared");
        let ghosts = constrained.ghosts();
        let scales = &ghosts.narrow(&constrained.row_scales);
        let scale = |r: &mut [f64]| vector::scale_each(scales, r);
        let (mut b, mut start) = (ghosts.narrow(rhs), ghosts.narrow(x));
        // Over several ranks no equation that a rank owns is inactive.
        if system.shared.is_none() {
            system.clear_inactive(&mut b);
        }
        scale(&mut b);
        // Completes a product with the bulk to one with the whole system.
        let complete = |x: &[f64], y: &mut [f64]| {
            system.add_coupling_product(x, y);
            system.clear_inactive(y);
            scale(y);
        };
        // The bulk's product of the latest vector, which is the answer in the end.
        let mut bulk_product = Vec::new();
        let mut multiply = |x: &[f64], y: &mut [f64]| {
            if system.shared.is_none() {
                system.bulk_product(runs, x, y);
                vector::set_length(&mut bulk_product, y.len());
                vector::copy(y, &mut bulk_product);
                return complete(x, y);
            }
            let (mut all, mut found) = (ghosts.widen(x), vec![0.0; system.equations()]);
            ghosts.spread(&mut all, 1);
            system.mul_vec_by_runs(runs, &all, &mut found);
            y.copy_from_slice(&ghosts.narrow(&found));
            scale(y);
        };
        let mut known = None;
        if !ghosts.any(start.iter().any(|x| *x != 0.0)) {
            let product = |answer: &mut PreviousSolution, y: &mut [f64]| {
                if system.shared.is_some() {
                    return multiply(&answer.x, y);
                }
                vector::copy(answer.product(system.bulk_values, |x, y| system.bulk_product(runs, x, y)), y);
                complete(&answer.x, y);
            };
            let enough = 0.5 * self.tolerance;
            known =
                Some(self.history.previous_solutions.start(system.bulk_graph, ghosts, product, &b, enough, &mut start));
        }
        let (tolerance, most) = (self.tolerance, self.settings.iterations.min(most));
        let takes_cycles = &mut self.history.takes_cycles;
        let (mut iterations, mut before, mut rate, mut asked) = (0, None, 0.0_f64, f64::INFINITY);
        let mut solves_left = !hierarchy.is_old;
        let (cache, inner) = (&mut self.reduced, &mut self.inner);
        let knows_most = system.shared.is_none() && cache.has_bulk_of(system);
        let pays = PAYS[usize::from(knows_most)];
        let precondition = |r: &mut [f64], share: f64| {
            let room = most - iterations;
            if room == 0 {
                return r.fill(0.0);
            }
            if iterations == 0 {
                solves_left |= -hierarchy.last * share.log10() > pays;
            }
            rate = before.replace(share).map_or(rate, |before| before / share);
            if rate > asked.powf(GAINED) {
                *takes_cycles = Some(system.bulk_graph);
            }
            let solve = |b: &mut [f64]| {
                if solves_left && *takes_cycles != Some(system.bulk_graph) {
                    let solves = (share.ln() / REACHED.ln()).ceil().max(1.0);
                    asked = share.powf(1.0 / solves).max(WORTH * rate).min(LOOSEST_FORCING_TERM);
                    let reduced = cache.up_to_date(constrained, system);
                    iterations += reduced.solve(&hierarchy.levels, inner, b, asked, room);
                } else {
                    iterations += 1;
                    hierarchy.levels.apply_double(b, hierarchy.size);
                }
            };
            vector::divide_each(scales, r);
            if system.shared.is_none() {
                constrained.apply(system, solve, r);
            } else {
                let mut all = ghosts.widen(r);
                constrained.apply(system, solve, &mut all);
                r.copy_from_slice(&ghosts.narrow(&all));
            }
        };
        let outer = &mut self.outer;
        let known = known.as_deref();
        let progress = outer.solve(known, ghosts, multiply, precondition, &b, &mut start, RESTART, most, tolerance);
        let progress = Progress { iterations, ..progress };
        let digits = (progress.start / progress.relative_residual).log10();
        if digits > TELLING {
            hierarchy.last = progress.iterations as f64 / digits;
            hierarchy.first.get_or_insert(hierarchy.last);
        }
        if progress.relative_residual <= DRIFT * tolerance {
            // Within the tolerance the latest product was that of the answer, if one was needed at all.
            let is_known =
                system.shared.is_none() && progress.iterations > 0 && progress.relative_residual <= tolerance;
            let product = is_known.then_some((system.bulk_values, &*bulk_product));
            self.history.previous_solutions.keep(system.bulk_graph, ghosts, &start, product);
        }
        vector::copy(&ghosts.widen(&start), x);
        progress
    }

    /// Lets the direct engine solve.
    fn solve_by_stand_in(
        &mut self,
        system: &System<'_>,
        rhs: &[f64],
        x: &mut [f64],
    ) -> Result<SolveReport, SolveError> {
        if system.layout.inactive.is_empty() || self.stand_in.takes_inactive_rows(system.free(), system.bulk.entries())
        {
            return self.stand_in.solve(system, rhs, x);
        }
        let reduced = Reduced::new(system);
        let (rhs, mut left) = (reduced.gather(rhs), reduced.gather(x));
        let report = self.stand_in.solve(&reduced.system(system), &rhs, &mut left).map_err(|error| match error {
            SolveError::Singular { mut equations, rank_deficiency } => {
                equations.iter_mut().for_each(|equation| *equation = reduced.whole(*equation));
                SolveError::Singular { equations, rank_deficiency }
            }
            other => other,
        })?;
        reduced.scatter(&left, x);
        Ok(report)
    }

    /// The answer, or why there is none.
    fn attempt(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Result<SolveReport, String> {
        let start = Instant::now();
        self.prepare(system)?;
        let mut seconds_numeric = start.elapsed().as_secs_f64();
        let guess = vector::copied(x);
        let patience = self.patience(system);
        let mut progress = self.iterate(system, rhs, x, patience);
        let accepted = DRIFT * self.tolerance;
        let is_good = |progress: Progress| progress.relative_residual <= accepted;
        if !is_good(progress) && progress.iterations >= patience {
            (self.history.has_fallen_back, self.hierarchy) = (true, None);
            return Err(format!(
                "after {patience} iterations a factorisation costs less: the direct engine solves from here on"
            ));
        }
        if !is_good(progress) && self.hierarchy.as_ref().is_some_and(|h| h.is_old) {
            let start = Instant::now();
            self.hierarchy = None;
            self.prepare(system)?;
            seconds_numeric += start.elapsed().as_secs_f64();
            x.copy_from_slice(&guess);
            progress = self.iterate(system, rhs, x, patience);
        }
        if !is_good(progress) {
            self.hierarchy = None;
            let Progress { iterations, relative_residual, .. } = progress;
            return Err(format!("multigrid reached only {relative_residual:.1e} after {iterations} iterations"));
        }
        let ghosts = system.ghosts();
        ghosts.spread(x, 1);
        let (constrained, _) = self.constrained.as_ref().expect("prepared");
        let mut residual = vector::copied(self.outer.residual());
        vector::divide_each(&ghosts.narrow(&constrained.row_scales), &mut residual);
        let (size, left) = (ghosts.norm(&ghosts.narrow(rhs)), ghosts.norm(&residual));
        Ok(SolveReport {
            engine: if system.shared.is_some() { "multigrid over ranks" } else { self.name() },
            relative_residual: if size > 0.0 { left / size } else { 0.0 },
            iterations: progress.iterations,
            fallback: None,
            seconds_symbolic: 0.0,
            seconds_numeric,
            seconds_solve: start.elapsed().as_secs_f64() - seconds_numeric,
        })
    }
}

impl LinearSolver for MultigridSolver {
    fn name(&self) -> &'static str {
        "multigrid"
    }

    fn says(&self) -> String {
        match self.settings.least {
            [0, 0] => self.name().to_owned(),
            [solid, plane] if solid == plane => format!("multigrid, or direct below {solid} equations"),
            [solid, plane] => {
                format!("direct, or multigrid from {solid} equations in space and {plane} in the plane on")
            }
        }
    }

    fn forget(&mut self) {
        self.stand_in.forget();
        self.reduced.forget();
        // Levels that ranks share are not saved.
        self.hierarchy = self.hierarchy.take().filter(|hierarchy| !hierarchy.is_old || !hierarchy.levels.is_shared());
        if let Some(hierarchy) = self.hierarchy.as_mut().filter(|hierarchy| !hierarchy.is_old) {
            (hierarchy.is_bound, hierarchy.first, hierarchy.last) = (true, None, 0.0);
        }
    }

    fn state(&self) -> Option<Box<dyn State>> {
        let hierarchy = self.hierarchy.clone().filter(|hierarchy| hierarchy.is_old && !hierarchy.levels.is_shared());
        Some(Box::new(MultigridState { history: self.history.clone(), hierarchy, stand_in: self.stand_in.state() }))
    }

    fn resume(&mut self, state: Box<dyn State>) -> Result<(), WrongState> {
        let MultigridState { history, hierarchy, stand_in } = state.take()?;
        (self.history, self.hierarchy) = (history, hierarchy);
        stand_in.map_or(Ok(()), |state| self.stand_in.resume(state))
    }

    fn set_forcing_term(&mut self, tolerance: f64) {
        let MultigridSettings { tolerance: tightest, loosest, .. } = self.settings;
        self.tolerance = tolerance.clamp(tightest, loosest.max(tightest));
    }

    fn needs(&self, equations: usize, entries: usize) -> u64 {
        if self.is_large(equations, entries) {
            memory::multigrid(equations, entries)
        } else {
            self.stand_in.needs(equations, entries)
        }
    }

    fn takes_loads(&self, system: &System<'_>) -> bool {
        self.serves(system)
    }

    fn takes_inactive_rows(&self, equations: usize, entries: usize) -> bool {
        self.shares(equations, entries) || self.stand_in.takes_inactive_rows(equations, entries)
    }

    fn keeps_factors(&self, equations: usize, entries: usize) -> bool {
        !self.shares(equations, entries)
    }

    fn shares(&self, equations: usize, entries: usize) -> bool {
        let has_given_up = self.history.has_fallen_back || self.history.failures >= FAILURES;
        !has_given_up && self.is_large(equations, entries)
    }

    fn solve(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Result<SolveReport, SolveError> {
        if system.shared.is_some() {
            return self.solve_shared(system, rhs, x);
        }
        check::vectors(system, rhs, x)?;
        let values = [system.bulk_graph, system.bulk_values];
        let seen = self.seen.take().filter(|(of, _)| *of == values);
        check::matrices(system, seen.is_none())?;
        let (_, zero_in_bulk) = self.seen.insert(seen.unwrap_or_else(|| (values, check::zero_in_bulk(system))));
        check::empty_rows_among(system, zero_in_bulk)?;
        if x.iter().any(|x| !x.is_finite()) {
            x.fill(0.0);
        }
        if !self.serves(system) {
            let mut report = self.solve_by_stand_in(system, rhs, x)?;
            if self.history.failures == FAILURES {
                self.history.failures += 1;
                let reason = "multigrid failed before; the direct engine solves from here on";
                report.fallback.get_or_insert_with(|| reason.to_owned());
            }
            return Ok(report);
        }
        match self.attempt(system, rhs, x) {
            Ok(report) => {
                self.history.failures = 0;
                Ok(report)
            }
            Err(why) => {
                self.history.failures += 1;
                let mut report = self.solve_by_stand_in(system, rhs, x)?;
                let reasons = [Some(why), report.fallback.take()];
                report.fallback = Some(reasons.into_iter().flatten().collect::<Vec<_>>().join("; "));
                Ok(report)
            }
        }
    }
}
