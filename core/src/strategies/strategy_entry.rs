//! Strategies by their registered names, and the parts that they are made of.

use zelus_linear_algebra::LinearSolver;

#[cfg(feature = "petsc")]
use super::condensing::multipliers;
use super::criterion::ConvergenceCriterion;
#[cfg(feature = "petsc")]
use super::linear_solvers;
use super::memory::{self, Size};
use super::newton::{NewtonRaphson, NewtonSettings};
use super::scheme::Scheme;
use super::strategy::SolutionStrategy;
use crate::assembly::{Assembler, System};
use crate::diagnostics::{Report, Result};
use crate::model::ModelPart;
use crate::parameters::{Node, Settings};
use crate::registered_kind;

/// Parts of a strategy, ready: the objects that the deck names beside it.
pub struct StrategyRequest<'a> {
    /// The solver settings, defaults filled in.
    pub settings: &'a Settings,
    /// The `advanced_settings` of the strategy, as the user wrote them.
    pub advanced: &'a Node,
    /// How a step is iterated.
    pub iteration: NewtonSettings,
    /// Registered name of the time scheme.
    pub scheme_name: &'a str,
    /// The time scheme.
    pub scheme: Box<dyn Scheme>,
    /// Judges each iteration.
    pub criterion: Box<dyn ConvergenceCriterion>,
    /// Solves the linear systems.
    pub solver: Box<dyn LinearSolver>,
    /// Solves them where those that `solver` takes do not fit in memory, if another may.
    pub frugal: Option<Box<dyn LinearSolver>>,
    /// Takes warnings.
    pub report: &'a mut Report,
    /// The part.
    pub part: &'a mut ModelPart,
    /// The system over it, whose blocks and interactions are ready.
    pub system: &'a mut System,
    /// Whether engines over all ranks may take the solver's place.
    pub replaceable: bool,
    /// Says which engine solves the linear systems.
    pub says: &'a mut String,
}

impl StrategyRequest<'_> {
    /// Newton's iteration of all of these, which other strategies may be made of.
    ///
    /// # Errors
    /// An engine of PETSc that does not exist; too little memory.
    pub fn newton(self) -> Result<NewtonRaphson> {
        let named = self.settings.sub("linear_solver_settings")?;
        let assembler = Assembler::new(self.part, self.system, self.scheme.lumped_mass());
        let reduced = self.part.constraints.iter().any(|constraint| constraint.active);
        let size = Size { unknowns: self.system.dofs.len(), entries: assembler.entries(), reduced };
        let (solver, warning) = memory::fitting(&self.part.ranks, self.solver, self.frugal, size, &named)?;
        if let Some(warning) = warning {
            *self.says = format!("linear solver: {}, chosen because it fits in memory", solver.name());
            self.report.push(warning);
        }
        let mut newton = NewtonRaphson::new(self.iteration, self.scheme, self.criterion, solver, assembler);
        newton.solver_named_at(named.key_place("solver_type"));
        #[cfg(feature = "petsc")]
        if self.part.share.is_some() && self.replaceable {
            let unknowns = linear_solvers::unknowns_of_all(self.part, self.system);
            let entries = self.part.ranks.total(newton.assembler.entries() as f64);
            let is_shared = newton.solver.shares(unknowns, entries as usize);
            let has_multipliers = self.system.dofs.dofs().iter().any(|dof| dof.multiplier);
            if let Some((petsc, by_petsc)) = linear_solvers::petsc(&named, unknowns, has_multipliers, is_shared)?
                && let Some(communicator) = self.part.ranks.petsc()
            {
                newton.solve_by_petsc(communicator?, petsc, multipliers(&self.part.info));
                *self.says = by_petsc;
            }
        }
        Ok(newton)
    }
}

/// Makes a strategy.
pub type StrategyFactory = fn(StrategyRequest<'_>) -> Result<Box<dyn SolutionStrategy>>;

registered_kind! {
    /// A strategy that decks name.
    pub struct StrategyEntry("strategy", "unknown-name") {
        build: StrategyFactory;
        /// Whether the load factor is an unknown, which interactions must know.
        unknown_load_factor: bool = false,
    }
}
