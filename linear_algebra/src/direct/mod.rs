//! The default engine: multifrontal factorisation of the bulk, the interface in a dense Schur complement.
//!
//! Order I (interior) before B (interface): `A = [K_II K_IB; K_BI K_BB + C]`. The bulk is eliminated once,
//! `S = K_BB - K_BI K_II⁻¹ K_IB`, and kept while its stamp is unchanged; a changed coupling `C` costs one dense LU of
//! `S + C`. Bodies that only contact holds need no care, as `K_II` is regular when B is held.

mod solution_checks;
mod factorized_system;

use std::borrow::Cow;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::check::{self, Refined};
use crate::interface::Interface;
use crate::lu::SparseLu;
use crate::memory;
use crate::multifrontal::Precision;
use crate::solver::{DirectSettings, LinearSolver, SolveError, SolveReport};
use crate::state::{State, StateMapper, WrongState};
use crate::stored_as_bytes;
use crate::system::{Stamps, Symmetry, System};
use crate::vector;
use factorized_system::{FactorizedSystem, Sparse};
use solution_checks::{is_regular, krylov, largest_entries, null_vector};

/// Interfaces up to this size are always worth their dense block.
const SMALL_INTERFACE: usize = 1500;
/// Multiplications of an LU of the whole matrix, divided by the square of its size; typical of solids.
const WHOLE_WORK: f64 = 40.0;
/// Share of a renewed factorisation of the bulk that a larger dense block may cost at each solve instead.
const RENEWAL_SHARE: f64 = 0.05;
/// Largest system given to the slow last resort.
const SPARSE_LU_LIMIT: usize = 60_000;
/// Residual at which refinement with factors in single precision ends, as far as those in double precision get at once.
const SINGLE_ENOUGH: f64 = 1e-12;
/// Largest number of its steps.
const SINGLE_REFINEMENTS: usize = 8;
/// Residual that refinement should reach; above it Krylov iteration is tried.
const WANTED: f64 = 1e-10;
/// Residual up to which an answer counts that only rounding keeps from being better.
const ROUNDED: f64 = 1e-4;
/// Factorisations without another attempt at Cholesky, after one failed.
const CHOLESKY_PAUSE: usize = 4;
/// `‖A v‖ / ‖|A| 1‖` below which a vector `v` of size one proves the matrix singular.
const NULL_VECTOR: f64 = 1e-10;

/// The ways, from the preferred one to the last resort.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum FactorizationMethod {
    Dense,
    InterfaceCholesky,
    InterfaceLu,
    WholeCholesky,
    WholeLu,
    SparseLu,
}

impl FactorizationMethod {
    fn name(self) -> &'static str {
        match self {
            Self::Dense => "dense_lu",
            Self::InterfaceCholesky => "cholesky+interface",
            Self::InterfaceLu => "multifrontal_lu+interface",
            Self::WholeCholesky => "cholesky",
            Self::WholeLu => "multifrontal_lu",
            Self::SparseLu => "sparse_lu",
        }
    }
}

/// The engine [`crate::Engine::Direct`].
pub(crate) struct DirectSolver {
    settings: DirectSettings,
    current: Option<(FactorizationMethod, FactorizedSystem, Stamps)>,
    history: DirectState,
    /// Multiplications of a factorisation of the whole matrix with these graphs.
    whole_work: Option<((u64, u64), f64)>,
    seconds_symbolic: f64,
    seconds_numeric: f64,
}

/// State that the engine keeps between solves.
#[derive(Clone, Default, Serialize, Deserialize)]
#[serde(remote = "Self")]
struct DirectState {
    /// The way of the last answer, with the stamps of its system.
    served: Option<(FactorizationMethod, Stamps)>,
    /// Equations kept in the interface, with the stamp of the bulk's graph they belong to.
    kept: Option<(Vec<bool>, u64)>,
    cholesky_pause: usize,
    /// Whether factors in single precision did not serve.
    needs_double: bool,
}

stored_as_bytes!(DirectState);

#[typetag::serde(name = "direct")]
impl State for DirectState {
    /// All of it is of the equations of a rank.
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {
        *self = Self::default();
    }
}

impl DirectSolver {
    pub(crate) fn new(settings: DirectSettings) -> Self {
        Self {
            settings,
            current: None,
            history: DirectState::default(),
            whole_work: None,
            seconds_symbolic: 0.0,
            seconds_numeric: 0.0,
        }
    }

    /// Ways to try, best first.
    fn ways(&mut self, system: &System<'_>) -> Result<Vec<FactorizationMethod>, SolveError> {
        let n = system.equations();
        // The dense matrix and the last resort know nothing of inactive equations.
        let is_whole = system.layout.inactive.is_empty();
        if is_whole && n <= self.settings.dense_below {
            return Ok(vec![FactorizationMethod::Dense]);
        }
        let mut ways = Vec::new();
        let cholesky = system.bulk_symmetry != Symmetry::General && self.history.cholesky_pause == 0;
        let kept = self.interface(system);
        if kept == 0 {
            ways.extend(cholesky.then_some(FactorizationMethod::WholeCholesky));
        } else if kept <= self.settings.interface_limit && !self.is_too_dense(kept, system)? {
            ways.extend(cholesky.then_some(FactorizationMethod::InterfaceCholesky));
            ways.push(FactorizationMethod::InterfaceLu);
        }
        ways.push(FactorizationMethod::WholeLu);
        ways.extend((is_whole && n <= SPARSE_LU_LIMIT).then_some(FactorizationMethod::SparseLu));
        Ok(ways)
    }

    /// Decides which equations stay in the interface and counts them.
    ///
    /// The interface of the previous solve is kept while it covers the new one and is not much larger, since a new one
    /// means a new factorisation of the bulk; a moving interface grows for the same reason.
    fn interface(&mut self, system: &System<'_>) -> usize {
        let wanted = factorized_system::interface_equations(system);
        let count = |kept: &[bool]| kept.iter().filter(|&&kept| kept).count();
        let needed = count(&wanted);
        if let Some((old, graph)) = &mut self.history.kept
            && *graph == system.bulk_graph
            && old.len() == wanted.len()
        {
            let cube = |order: usize| 2.0 / 3.0 * (order as f64).powi(3);
            let renewal = RENEWAL_SHARE * WHOLE_WORK * (wanted.len() as f64).powi(2);
            let union: Vec<bool> = old.iter().zip(&wanted).map(|(a, b)| *a || *b).collect();
            let size = count(&union);
            if size <= self.settings.interface_limit && cube(size) <= 2.0 * cube(needed) + renewal {
                *old = union;
                return size;
            }
        }
        self.history.kept = Some((wanted, system.bulk_graph));
        needed
    }

    /// Makes `way` ready for `system`, with the reuse that the stamps allow; `None` when the matrix does not suit the way.
    fn prepare(
        &mut self,
        way: FactorizationMethod,
        system: &System<'_>,
    ) -> Result<Option<FactorizedSystem>, SolveError> {
        let stamps = Stamps::of(system);
        let (old, old_stamps) = match self.current.take() {
            Some((old_way, path, old_stamps)) if old_way == way => (Some(path), Some(old_stamps)),
            _ => (None, None),
        };
        if old_stamps == Some(stamps) && !old.as_ref().is_some_and(FactorizedSystem::is_lost) {
            return Ok(old);
        }
        let same_bulk_graph = old_stamps.is_some_and(|old| old.bulk_graph == stamps.bulk_graph);
        let same_bulk = same_bulk_graph && old_stamps.is_some_and(|old| old.bulk_values == stamps.bulk_values);
        let start = Instant::now();
        match way {
            FactorizationMethod::Dense => {
                let path = factorized_system::dense(system);
                self.seconds_numeric += start.elapsed().as_secs_f64();
                Ok(Some(path))
            }
            FactorizationMethod::SparseLu => {
                let path = FactorizedSystem::SparseLu(SparseLu::new(&system.merged())?);
                self.seconds_numeric += start.elapsed().as_secs_f64();
                Ok(Some(path))
            }
            FactorizationMethod::WholeCholesky | FactorizationMethod::WholeLu => {
                let same_graph = same_bulk_graph
                    && old_stamps.is_some_and(|old| {
                        old.is_coupled == stamps.is_coupled && old.coupling_graph == stamps.coupling_graph
                    });
                let merged = system.active_coupling().map(|_| system.merged());
                let matrix = merged.as_ref().unwrap_or(system.bulk);
                let mut sparse = match old {
                    Some(FactorizedSystem::Whole(sparse)) if same_graph => sparse,
                    _ => Sparse::new(matrix, system, &vec![false; system.equations()])?,
                };
                self.seconds_symbolic += start.elapsed().as_secs_f64();
                let start = Instant::now();
                let precision = self.precision(&sparse);
                let done = sparse.factorise(matrix, way == FactorizationMethod::WholeCholesky, precision);
                self.seconds_numeric += start.elapsed().as_secs_f64();
                Ok(done.ok().map(|()| FactorizedSystem::Whole(sparse)))
            }
            FactorizationMethod::InterfaceCholesky | FactorizationMethod::InterfaceLu => {
                let (kept, _) = self.history.kept.as_ref().expect("decided in `interface`");
                let (mut sparse, mut old_interface) = match old {
                    Some(FactorizedSystem::Interface(sparse, interface))
                        if same_bulk_graph && covers(&sparse, kept) =>
                    {
                        (sparse, Some(interface))
                    }
                    _ => (Sparse::new(system.bulk, system, kept)?, None),
                };
                self.seconds_symbolic += start.elapsed().as_secs_f64();
                let start = Instant::now();
                if !(same_bulk && sparse.factor.is_some()) {
                    old_interface.iter_mut().for_each(Interface::forget);
                    let precision = self.precision(&sparse);
                    if sparse.factorise(system.bulk, way == FactorizationMethod::InterfaceCholesky, precision).is_err()
                    {
                        self.seconds_numeric += start.elapsed().as_secs_f64();
                        return Ok(None);
                    }
                }
                let symbolic = &sparse.symbolic;
                let interior = symbolic.interior;
                let equations = &symbolic.equation[interior..];
                let local = |equation| symbolic.position_of(equation).map(|position| position - interior);
                let interface = Interface::new(
                    &sparse.factor.as_ref().expect("factorised").root,
                    factorized_system::local_coupling(system, equations, local),
                    |at| system.bulk.row(equations[at] as usize).1.iter().any(|&value| value != 0.0),
                    old_interface,
                );
                self.seconds_numeric += start.elapsed().as_secs_f64();
                Ok(Some(FactorizedSystem::Interface(sparse, interface)))
            }
        }
    }

    /// In which precision factors are kept.
    fn precision(&self, sparse: &Sparse) -> Precision {
        if !self.history.needs_double && sparse.symbolic.factor_size() >= self.settings.single_from {
            Precision::Single
        } else {
            Precision::Double
        }
    }

    /// Whether a dense interface of `order` equations costs more than eliminating the whole matrix.
    fn is_too_dense(&mut self, order: usize, system: &System<'_>) -> Result<bool, SolveError> {
        let n = system.equations() as f64;
        let work = 2.0 / 3.0 * (order as f64).powi(3);
        if order <= SMALL_INTERFACE || work < WHOLE_WORK * n * n {
            return Ok(false);
        }
        let graphs = (system.bulk_graph, system.coupling_graph);
        let whole = match self.whole_work {
            Some((known, whole)) if known == graphs => whole,
            _ => {
                let start = Instant::now();
                let whole = Sparse::new(&system.merged(), system, &vec![false; system.equations()])?.symbolic.work();
                self.seconds_symbolic += start.elapsed().as_secs_f64();
                self.whole_work = Some((graphs, whole));
                whole
            }
        };
        // The whole matrix takes an LU, twice the work of Cholesky, in blocks smaller than the dense one.
        Ok(work > 3.0 * 2.0 * whole)
    }

    /// Solves by one way; `None` when another one should be tried.
    fn attempt(
        &mut self,
        way: FactorizationMethod,
        system: &System<'_>,
        rhs: &[f64],
        x: &mut [f64],
    ) -> Result<Option<Refined>, SolveError> {
        let known = self
            .current
            .as_ref()
            .is_some_and(|(old, path, stamps)| *old == way && *stamps == Stamps::of(system) && !path.is_lost());
        let Some(path) = self.prepare(way, system)? else { return Ok(None) };
        if !known && path.suspicious() > 0 && path.is_single() {
            return self.in_double(way, path, system, rhs, x);
        }
        if !known && path.suspicious() > 0 && !is_regular(system, &path) {
            let (vector, ratio) = null_vector(system, &path);
            if ratio < NULL_VECTOR {
                return Err(SolveError::Singular {
                    equations: largest_entries(&vector),
                    rank_deficiency: Some(path.suspicious()),
                });
            }
            return Ok(None);
        }
        let (steps, enough) = match path.is_single() {
            true => (SINGLE_REFINEMENTS, SINGLE_ENOUGH),
            false => (self.settings.refinements, check::GOOD_ENOUGH),
        };
        let mut refined = check::refine(system, rhs, x, steps, enough, |r| path.apply(r));
        if path.is_lost() {
            self.current = Some((way, path, Stamps::of(system)));
            return self.attempt(way, system, rhs, x);
        }
        if !refined.reaches(WANTED) && !check::is_rounding(system, rhs, x) {
            if path.is_single() {
                return self.in_double(way, path, system, rhs, x);
            }
            refined = krylov(system, &path, rhs, x, refined);
        }
        let good = refined.reaches(self.settings.tolerance)
            || (refined.reaches(ROUNDED) && check::is_rounding(system, rhs, x));
        if good {
            self.current = Some((way, path, Stamps::of(system)));
        }
        Ok(good.then_some(refined))
    }

    /// Solves by the way of `single`, whose factors in single precision do not serve, with factors in double precision.
    fn in_double(
        &mut self,
        way: FactorizationMethod,
        single: FactorizedSystem,
        system: &System<'_>,
        rhs: &[f64],
        x: &mut [f64],
    ) -> Result<Option<Refined>, SolveError> {
        drop(single);
        self.history.needs_double = true;
        let needed = memory::factor(system.equations(), system.bulk.entries(), usize::MAX);
        if let Some(free) = memory::available().filter(|free| *free < needed) {
            return Err(SolveError::Failed(format!(
                "factors in single precision do not serve the system, those in double precision take {:.1} GB, and {:.1} GB \
                 are free: use another engine or more memory",
                needed as f64 / 1e9,
                free as f64 / 1e9
            )));
        }
        self.attempt(way, system, rhs, x)
    }
}

/// Whether the interface of a factorisation is the one wanted.
fn covers(sparse: &Sparse, kept: &[bool]) -> bool {
    let symbolic = &sparse.symbolic;
    let count = kept.iter().filter(|&&kept| kept).count();
    symbolic.equations() == kept.len()
        && symbolic.equation.len() - symbolic.interior == count
        && symbolic.equation[symbolic.interior..].iter().all(|&i| kept[i as usize])
}

impl LinearSolver for DirectSolver {
    fn name(&self) -> &'static str {
        "direct"
    }

    fn needs(&self, equations: usize, entries: usize) -> u64 {
        memory::factor(equations, entries, self.settings.single_from)
    }

    /// Where a second copy of the matrix would weigh, and all ways do.
    fn takes_inactive_rows(&self, equations: usize, _: usize) -> bool {
        equations > SPARSE_LU_LIMIT.max(self.settings.dense_below)
    }

    fn keeps_factors(&self, _: usize, _: usize) -> bool {
        true
    }

    /// Factors of an interface whose coupling has changed since would be iterated with.
    fn forget(&mut self) {
        if let Some((_, FactorizedSystem::Interface(_, interface), _)) = &mut self.current {
            interface.forget();
        }
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(self.history.clone()))
    }

    fn resume(&mut self, state: Box<dyn State>) -> Result<(), WrongState> {
        self.history = state.take()?;
        Ok(())
    }

    fn solve(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Result<SolveReport, SolveError> {
        check::input(system, rhs, x)?;
        check::empty_rows(system)?;
        let mut free = Cow::Borrowed(rhs);
        if !system.layout.inactive.is_empty() {
            system.clear_inactive(free.to_mut());
        }
        let rhs = &*free;
        (self.seconds_symbolic, self.seconds_numeric) = (0.0, 0.0);
        let start = Instant::now();
        let mut failed: Vec<&'static str> = Vec::new();
        let mut ways = self.ways(system)?;
        // A way that served the same bulk before is tried first, so that a failing one is not tried at each solve.
        if let Some((way, stamps)) = self.history.served.take()
            && stamps.bulk_graph == system.bulk_graph
            && stamps.bulk_values == system.bulk_values
            && let Some(at) = ways.iter().position(|candidate| *candidate == way)
        {
            ways.drain(..at);
        }
        for way in ways {
            let Some(refined) = self.attempt(way, system, rhs, x)? else {
                if matches!(way, FactorizationMethod::WholeCholesky | FactorizationMethod::InterfaceCholesky) {
                    self.history.cholesky_pause = CHOLESKY_PAUSE + 1;
                }
                failed.push(way.name());
                continue;
            };
            self.history.served = Some((way, Stamps::of(system)));
            self.history.cholesky_pause = self.history.cholesky_pause.saturating_sub(1);
            let before_solve = self.seconds_symbolic + self.seconds_numeric;
            return Ok(SolveReport {
                engine: way.name(),
                relative_residual: refined.relative_residual,
                iterations: refined.steps,
                fallback: (!failed.is_empty()).then(|| format!("{} failed", failed.join(", "))),
                seconds_symbolic: self.seconds_symbolic,
                seconds_numeric: self.seconds_numeric,
                seconds_solve: start.elapsed().as_secs_f64() - before_solve,
            });
        }
        let mut residual = vec![0.0; x.len()];
        let relative_residual = system.residual(rhs, x, &mut residual) / vector::norm(rhs);
        Err(SolveError::NotConverged {
            engine: self.name(),
            iterations: self.settings.refinements,
            relative_residual,
            tolerance: self.settings.tolerance,
        })
    }
}
