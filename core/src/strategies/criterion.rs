//! Convergence criteria: their inputs and their verdict.

use std::cell::LazyCell;

use crate::assembly::{Distribution, Dof, DofTable, Equations};
use crate::communication::Ranks;
use crate::diagnostics::{Report, Result};
use crate::model::{Nodes, ScalarVariable, SlaveNodes};
use crate::names::{self, Name};
use crate::parameters::{Node, Settings};
use crate::registered_kind;

/// A block of unknowns that is measured by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Block {
    /// Every unknown that is solved for.
    All,
    /// Displacement-like unknowns.
    Primary,
    /// Lagrange multipliers.
    Multiplier,
}

impl Block {
    /// Whether an unknown belongs to the block.
    pub fn holds(self, dof: &Dof) -> bool {
        self.has(dof.multiplier)
    }

    fn has(self, multiplier: bool) -> bool {
        match self {
            Self::All => true,
            Self::Primary => !multiplier,
            Self::Multiplier => multiplier,
        }
    }
}

/// The state after an iteration, over all unknowns.
pub struct Measures<'a> {
    /// Iteration, from 1.
    pub iteration: usize,
    /// Nodes, for flags and fields.
    pub nodes: &'a Nodes,
    /// Slave nodes with their fields.
    pub slave_nodes: &'a SlaveNodes,
    /// Unknowns.
    pub dofs: &'a DofTable,
    /// Equations: the unknowns that are solved for.
    pub equations: &'a Equations,
    /// Unknowns that this rank counts; `None` when it has all.
    pub distribution: Option<&'a Distribution>,
    /// External minus internal forces.
    pub residual: &'a [f64],
    /// Residuals that a relative measure refers to: before the first solve, prescribed increments included, and after it.
    pub references: &'a [Vec<f64>],
    /// Residual after the last iteration in which interactions changed state: the remainder of equations that did not act before.
    /// `None` before the first such change.
    pub switched: Option<&'a [f64]>,
    /// Increment of the iteration.
    pub increment: &'a [f64],
    /// Values after the update.
    pub values: &'a [f64],
    /// Size of the round-off of each entry of the residual; collective. It takes a pass over the matrix, so it is computed for the
    /// first criterion that asks.
    pub round_off: LazyCell<Vec<f64>, Box<dyn FnOnce() -> Vec<f64> + 'a>>,
}

impl Measures<'_> {
    /// Σ a b over a block of the unknowns that are solved for, and number of its entries, on all ranks; collective.
    pub fn dot(&self, a: &[f64], b: &[f64], block: Block) -> (f64, usize) {
        let dofs = self.dofs.dofs();
        let counts = |n: &usize| block.holds(&dofs[*n]) && self.distribution.is_none_or(|d| d.is_own(*n));
        let own = self.equations.unknowns().iter().map(|&n| n as usize).filter(counts);
        let mut sums = own.fold([0.0; 2], |[sum, count], n| [sum + a[n] * b[n], count + 1.0]);
        if let Some(distribution) = self.distribution {
            distribution.ranks().sum(&mut sums);
        }
        (sums[0], sums[1] as usize)
    }

    /// Norms over a block: of each variable where they are measured `apart`, else of all together; collective.
    pub fn norms(&self, vector: &[f64], block: Block, apart: bool) -> Vec<Norm> {
        let counts = |n: &usize| self.distribution.is_none_or(|d| d.is_own(*n));
        let own = self.equations.unknowns().iter().map(|&n| n as usize).filter(counts);
        let ranks = self.distribution.map(Distribution::ranks);
        norms(self.dofs, own, block, vector, apart, ranks).into_iter().filter(|norm| norm.count > 0).collect()
    }
}

/// Norm of the entries of a variable.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Norm {
    /// Euclidean norm.
    pub size: f64,
    /// Number of entries.
    pub count: usize,
}

/// Norms of those entries `own` of a vector that are of a block, by variable or of all together, with those of other ranks; collective
/// over `ranks`.
pub(super) fn norms(
    dofs: &DofTable,
    own: impl Iterator<Item = usize>,
    block: Block,
    vector: &[f64],
    apart: bool,
    ranks: Option<&Ranks>,
) -> Vec<Norm> {
    let mut columns: Vec<&str> = dofs.variables().map(|variable| variable.column).collect();
    columns.dedup();
    if !apart {
        columns.truncate(1);
    }
    // Of each variable the place of its norm, behind all of them where it is not of the block.
    let place = |(variable, &multiplier): (ScalarVariable, &bool)| match block.has(multiplier) {
        true => columns.iter().position(|own| *own == variable.column).unwrap_or(0),
        false => columns.len(),
    };
    let places: Vec<usize> = dofs.variables().zip(dofs.multipliers()).map(place).collect();
    let kinds = dofs.kinds();
    let mut sums = vec![0.0; 2 * (columns.len() + 1)];
    for n in own {
        let at = places[kinds[n] as usize];
        sums[2 * at] += vector[n] * vector[n];
        sums[2 * at + 1] += 1.0;
    }
    sums.truncate(2 * columns.len());
    if let Some(ranks) = ranks {
        ranks.sum(&mut sums);
    }
    sums.chunks_exact(2).map(|sum| Norm { size: sum[0].sqrt(), count: sum[1] as usize }).collect()
}

/// Whether a residual norm is no larger than the round-off of the terms it is the sum of.
///
/// Such a residual cannot fall further, whatever the tolerance. The bound is well above round-off: in the middle of it, chance would
/// decide the number of iterations of a step.
pub fn is_round_off(residual: f64, round_off: f64) -> bool {
    residual <= 16.0 * round_off
}

/// Whether an increment is no more than the last digits of the value it is added to.
pub fn is_last_digit(increment: f64, value: f64) -> bool {
    increment <= 16.0 * f64::EPSILON * value
}

/// One measured block.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ConvergenceCheck {
    /// Measured quantity, e.g. `residual`.
    #[serde(deserialize_with = "names::read")]
    pub label: Name,
    /// Norm divided by its reference.
    pub ratio: f64,
    /// Tolerance of the ratio.
    pub ratio_tolerance: f64,
    /// Norm an unknown.
    pub absolute: f64,
    /// Tolerance of the norm an unknown.
    pub absolute_tolerance: f64,
    /// Whether it is good enough.
    pub converged: bool,
}

/// Verdict of a criterion on an iteration.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Verdict {
    /// Whether the iteration is good enough.
    pub converged: bool,
    /// Measured quantities.
    pub checks: Vec<ConvergenceCheck>,
}

impl Verdict {
    /// Converged when every check is.
    pub fn all(checks: Vec<ConvergenceCheck>) -> Self {
        Self { converged: checks.iter().all(|check| check.converged), checks }
    }
}

/// Judges an iteration; changes nothing.
pub trait ConvergenceCriterion: Send {
    /// Measures and judges.
    fn judge(&self, measures: &Measures<'_>) -> Verdict;

    /// Tolerance of forces out of balance, relative to forces; `None` where forces are not measured.
    fn residual_tolerance(&self) -> Option<f64> {
        None
    }
}

/// Arguments from which a criterion is made.
pub struct CriterionRequest<'a> {
    /// The solver settings, defaults filled in.
    pub settings: &'a Settings,
    /// The solver settings as the user wrote them.
    pub user: &'a Node,
    /// Takes warnings.
    pub report: &'a mut Report,
}

/// Makes a criterion.
pub type CriterionFactory = fn(&mut CriterionRequest<'_>) -> Result<Box<dyn ConvergenceCriterion>>;

registered_kind! {
    /// A convergence criterion that decks name.
    pub struct CriterionEntry("convergence_criterion", "unknown-criterion") {
        build: CriterionFactory;
    }
}

struct Pair {
    first: Box<dyn ConvergenceCriterion>,
    second: Box<dyn ConvergenceCriterion>,
    both: bool,
}

impl ConvergenceCriterion for Pair {
    fn judge(&self, measures: &Measures<'_>) -> Verdict {
        let (mut first, second) = (self.first.judge(measures), self.second.judge(measures));
        first.converged =
            if self.both { first.converged && second.converged } else { first.converged || second.converged };
        first.checks.extend(second.checks);
        first
    }

    fn residual_tolerance(&self) -> Option<f64> {
        let [first, second] = [&self.first, &self.second].map(|criterion| criterion.residual_tolerance());
        if self.both { first.or(second) } else { None }
    }
}

/// Converged when both are.
pub fn both(
    first: Box<dyn ConvergenceCriterion>,
    second: Box<dyn ConvergenceCriterion>,
) -> Box<dyn ConvergenceCriterion> {
    Box::new(Pair { first, second, both: true })
}

/// Converged when one of them is.
pub fn either(
    first: Box<dyn ConvergenceCriterion>,
    second: Box<dyn ConvergenceCriterion>,
) -> Box<dyn ConvergenceCriterion> {
    Box::new(Pair { first, second, both: false })
}
