//! Interactions between bodies that change with the state: contact above all.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::State;

use super::block::EntityBlock;
use super::complementary::Complementary;
use super::join::Join;
use super::pair_state::PairState;
use crate::diagnostics::{Diagnostic, Result};
use crate::model::{DofOwners, ModelPart};

/// Changes by the active-set update of an iteration.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SetChange {
    /// Ids of nodes that became active.
    pub activated: Vec<usize>,
    /// Ids of nodes that became inactive.
    pub deactivated: Vec<usize>,
    /// Ids of nodes that changed between stick and slip.
    pub stick_slip: Vec<usize>,
}

impl SetChange {
    /// Number of changes.
    pub fn count(&self) -> usize {
        self.activated.len() + self.deactivated.len() + self.stick_slip.len()
    }

    /// The changes of another interaction too.
    pub fn extend(&mut self, more: Self) {
        self.activated.extend(more.activated);
        self.deactivated.extend(more.deactivated);
        self.stick_slip.extend(more.stick_slip);
    }
}

/// Action after the iteration has converged.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum OuterLoop {
    /// The step is solved.
    Done,
    /// Something was changed that the iteration must follow: an outer loop goes on.
    Continue,
    /// Blocks were added that the state must obey too, and why: the iteration goes on with them.
    PairsAdded(String),
    /// The step is solved, but a shorter one would be better, and why.
    StepTooLarge(String),
    /// The interaction's conditions are to be decided together, see [`ActiveSet::complementary`].
    DecideTogether,
    /// The outer loop does not come to an end, and why.
    Failed(String),
}

/// Nodes whose mass others carry, ascending.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MasslessNodes {
    /// Nodes that are massless for the whole run, where other nodes can carry their mass.
    pub surface: Vec<u32>,
    /// Other nodes that are massless in this step.
    pub near: Vec<u32>,
}

/// A participant in the solution of steps: contact, ties, constraints that switch, an observer.
///
/// Its own methods are a name and the ends of steps. Its other roles are capabilities, each a trait of its own that it gives out where
/// it has it. The strategy calls them in the order in which they stand here. The model part they receive holds no interactions, so it
/// can be read and changed freely.
pub trait Interaction: Send + Sync {
    /// Short name for the log.
    fn name(&self) -> &str;

    /// The extension of a solver whose unknowns it acts on, where the solver has it; `None` for those of the solver itself.
    fn extension(&self) -> Option<&'static str> {
        None
    }

    /// Before anything runs: variables, geometry, parameters.
    ///
    /// # Errors
    /// Whatever is wrong with the deck's interfaces.
    fn initialize(&mut self, _part: &mut ModelPart) -> Result<()> {
        Ok(())
    }

    /// Step start, before the prediction: search, pairs, initial active set.
    ///
    /// # Errors
    /// A failed search.
    fn begin_step(&mut self, _part: &mut ModelPart) -> Result<()> {
        Ok(())
    }

    /// The step is accepted.
    ///
    /// # Errors
    /// A geometry that cannot be computed with.
    fn finalize_step(&mut self, _part: &mut ModelPart) -> Result<()> {
        Ok(())
    }

    /// State between steps beside the fields of the model, for the file of a saved run.
    fn state(&self) -> Option<Box<dyn State>> {
        None
    }

    /// Restores a saved state in place of [`Interaction::begin_step`] and later calls, once it is initialised and the fields are those
    /// of the saved run.
    ///
    /// # Errors
    /// The state of another kind of interaction.
    fn resume(&mut self, _part: &mut ModelPart, _state: Box<dyn State>) -> Result<()> {
        Ok(())
    }

    /// Version of its constraints in [`ModelPart::constraints`]: where it changes, the equations are derived again.
    fn constraints_version(&self) -> u64 {
        0
    }

    /// Factor of the length of explicit steps while it acts, at most 1.
    fn step_factor(&self, _part: &ModelPart) -> f64 {
        1.0
    }

    /// Numbers chosen once for the run, by name: printed at its start and kept in its report.
    fn parameters(&self, _part: &ModelPart) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// Numbers for the report of a step, by name.
    fn summary(&self, _part: &ModelPart) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// The pairs of bodies it acts between, as they are in a converged state; the same on every rank.
    fn pairs(&self, _part: &ModelPart) -> Vec<PairState> {
        Vec::new()
    }

    /// Before the first step: whether it may load or move the model by itself, as bodies that overlap do.
    fn drives(&self) -> bool {
        true
    }

    /// Before the first step: where it joins bodies; `None` when it does not know.
    fn joins(&self, _part: &ModelPart) -> Option<Vec<Join>> {
        None
    }

    /// Contact state at a node of its own (index), in a word: "is open", "sticks", "slides"; `None` at other nodes.
    fn node_state(&self, _node: u32) -> Option<&'static str> {
        None
    }

    /// Notes and warnings since they were last asked for; the stage passes them on.
    fn messages(&mut self) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// Warnings of events that never happened in any step, asked for once after the last.
    fn last_messages(&self, _part: &ModelPart) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// Its blocks and unknowns, where it has any.
    fn coupling(&self) -> Option<&dyn Coupling> {
        None
    }

    /// Its decisions within a step, where it takes any.
    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        None
    }

    /// Its part in the first iterate of a step, where that decides on the step's answer.
    fn first_iterate(&mut self) -> Option<&mut dyn FirstIterate> {
        None
    }

    /// Its nodes without mass, where it has any.
    fn massless(&mut self) -> Option<&mut dyn Massless> {
        None
    }

    /// Its state beside that of the model part, which a retried step must restore.
    fn retry(&mut self) -> Option<&mut dyn Retry> {
        None
    }

    /// Its look at iterates.
    fn observer(&mut self) -> Option<&mut dyn Observer> {
        None
    }

    /// Unknowns of its own beside those of the strategy, where both are to be found in one Newton's iteration.
    fn follower(&mut self) -> Option<&mut dyn Follower> {
        None
    }
}

/// Blocks of an interaction, and the unknowns it adds.
pub trait Coupling {
    /// Lagrange multipliers it adds (beside the unknowns of elements), with the mesh nodes or slave nodes that own them;
    /// constant over the stage. The owners have the columns of their variables.
    fn unknowns(&self, _part: &ModelPart) -> Vec<DofOwners> {
        Vec::new()
    }

    /// Blocks that act now.
    fn blocks(&self) -> Vec<&dyn EntityBlock>;

    /// Of the `at`-th entity of the `block`-th of [`Coupling::blocks`]: the place of its pair in [`Interaction::pairs`], and the nodes
    /// of the second side; `None` where it acts on something else.
    fn pair_of(&self, _block: usize, _at: usize) -> Option<(usize, Range<usize>)> {
        None
    }

    /// Changes whenever the connectivity of [`Coupling::blocks`] does.
    fn graph_version(&self) -> u64;

    /// Diagonal and right-hand side for unknowns of [`Coupling::unknowns`] that no block touches now.
    fn inactive_diagonal(&self) -> f64 {
        1.0
    }

    /// Term for the tangent's diagonal of its unknowns where constraints are redundant, as by supports at the edge of an interface;
    /// `None` where that must end the run.
    fn relaxation(&self) -> Option<f64> {
        None
    }
}

/// Decisions that follow the iterates of a step.
pub trait ActiveSet {
    /// After the prediction and before the first assembly of the step.
    ///
    /// # Errors
    /// A geometry that cannot be computed with.
    fn after_prediction(&mut self, _part: &mut ModelPart) -> Result<()> {
        Ok(())
    }

    /// Whether [`ActiveSet::after_update`] reads reactions, which are then those of the updated state.
    fn needs_reactions(&self) -> bool {
        false
    }

    /// After the update of iteration `iteration`: the active-set stage.
    ///
    /// # Errors
    /// A geometry that cannot be computed with.
    fn after_update(&mut self, part: &mut ModelPart, iteration: usize) -> Result<SetChange>;

    /// The iteration has converged: the blocks of elements in that state, before [`ActiveSet::after_convergence`].
    fn look_at(&mut self, _part: &mut ModelPart, _elements: &[Box<dyn EntityBlock>]) {}

    /// Writes its results into the fields, pressures and slips, as they are in the present state; decides nothing and keeps nothing of
    /// it, since that state may be one beside the iterates.
    fn show(&mut self, _part: &mut ModelPart) {}

    /// The iteration has converged: an outer loop, as Uzawa's, updates the quantities that the iteration held constant.
    ///
    /// # Errors
    /// A geometry that cannot be computed with.
    fn after_convergence(&mut self, _part: &mut ModelPart) -> Result<OuterLoop> {
        Ok(OuterLoop::Done)
    }

    /// Its conditions that one linear complementarity problem decides on; it asks for that by [`OuterLoop::DecideTogether`].
    fn complementary(&mut self) -> Option<&mut dyn Complementary> {
        None
    }

    /// The system is singular: activates contact of bodies that are free to move; `false` where there is none, or no more.
    /// The active set may release it after the solve.
    fn restrain_free_bodies(&mut self, _part: &mut ModelPart) -> bool {
        false
    }

    /// Length by which a body without restraint moves in an iteration of contact stabilisation, a share of the mesh size of the
    /// interface; `None` where the interaction restrains no body. Collective.
    fn stabilization_length(&self, _part: &ModelPart) -> Option<f64> {
        None
    }
}

/// A first iterate that decides on the answer of its step.
///
/// Statics then begin a step as the reference program does: prescribed displacements are in the field before the first solve,
/// some nodes follow them at once and the rest of the mesh after the solve.
pub trait FirstIterate {
    /// The nodes that follow prescribed displacements at once, ascending; `None` where the step begins as others do.
    fn moved_first(&self) -> Option<Vec<u32>>;

    /// The step is restarted without its first iterate: keeps the values that the solution takes from it.
    ///
    /// Called in place of [`ActiveSet::after_update`]; [`ActiveSet::after_prediction`] follows.
    fn keep(&mut self, part: &mut ModelPart);
}

/// Nodes that others carry the mass of.
pub trait Massless {
    /// A step in motion with inertia begins: finds the nodes whose mass others carry, since forces on them come and go at once.
    fn begin_dynamic_step(&mut self, part: &ModelPart);

    /// The nodes that [`Massless::begin_dynamic_step`] found.
    fn massless_nodes(&self) -> MasslessNodes;
}

/// A state that a retried step must restore.
pub trait Retry {
    /// Saves the state that a retried step must restore.
    fn save(&mut self) {}

    /// Restores the state of [`Retry::save`].
    fn restore(&mut self);

    /// Whether a step that fails again would next be solved by another method, whatever its length.
    fn has_alternative(&self) -> bool {
        false
    }
}

/// A look at iterates that changes nothing.
pub trait Observer {
    /// The balance of an iterate is known: of the starting one (iteration 0) and of each after a solve.
    ///
    /// `residual` holds the equations that are solved.
    fn observe(&mut self, part: &ModelPart, iteration: usize, residual: &[f64]);
}

/// Unknowns of another system, another physics', that follow those of a strategy through its iterations.
///
/// After each iteration they are brought into balance with the state found. The next increment then includes their effect on the
/// forces: with unknowns u and forces r(u, T) of the strategy, and T of the follower, it solves
///
/// K δu = r + ∂r/∂T δT, δT = (∂T/∂u) δu
///
/// by products alone, so that no derivative between both has to be known ([`Follower::respond`] and [`Follower::nudge`] give them by
/// differences).
pub trait Follower {
    /// Brings its unknowns into balance with the present state; why it cannot, if it cannot. Collective.
    ///
    /// # Errors
    /// As [`SolutionStrategy::solve_step`](crate::strategies::SolutionStrategy::solve_step).
    fn follow(&mut self, part: &mut ModelPart, elements: &[Box<dyn EntityBlock>]) -> Result<Option<String>>;

    /// Whether it reads results of the strategy's elements in the present state, as plastic work.
    fn reads_elements(&self) -> bool {
        false
    }

    /// Takes the present state as the one that differences refer to, and gives the increment that its unknowns lack there. Collective.
    ///
    /// # Errors
    /// As [`Follower::follow`].
    fn refer(&mut self, part: &mut ModelPart, elements: &[Box<dyn EntityBlock>]) -> Result<Vec<f64>>;

    /// The increment of its unknowns from the state referred to into balance with the present one, by the tangent it has. Collective.
    ///
    /// # Errors
    /// As [`Follower::follow`].
    fn respond(&mut self, part: &mut ModelPart, elements: &[Box<dyn EntityBlock>]) -> Result<Vec<f64>>;

    /// Moves its unknowns by a small share of an increment, and gives that share; 0 where the increment is none. Collective.
    fn nudge(&self, part: &mut ModelPart, increment: &[f64]) -> f64;

    /// Σ a b over its unknowns; collective.
    fn dot(&self, a: &[f64], b: &[f64]) -> f64;
}
