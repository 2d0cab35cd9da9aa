//! What acts between bodies and changes with the state: contact above all.

use super::block::EntityBlock;
use crate::diagnostics::Result;
use crate::model::{ModelPart, ScalarVariable};

/// What the active-set stage of an iteration changed.
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

/// What follows when the iteration has converged.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outer {
    /// The step is solved.
    Done,
    /// Something was changed that the iteration must follow: an outer loop goes on.
    Again,
    /// Blocks were added that the state must obey too, and why: the iteration goes on with them.
    Widened(String),
    /// The step is solved, but a shorter one would be better, and why.
    Coarse(String),
    /// The outer loop does not come to an end, and why.
    Failed(String),
}

/// Nodes whose mass others carry, ascending.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MasslessNodes {
    /// Those that have none for the whole run, where nodes that are not among them can carry it.
    pub surface: Vec<u32>,
    /// Of the others, those that have none in this step.
    pub near: Vec<u32>,
}

/// A participant in the Newton loop that owns blocks of its own and decides which of them act.
///
/// Called by the strategy in the order of the methods below. The model part it receives holds no interactions while they
/// run, so it can be read and changed freely.
pub trait Interaction: Send + Sync {
    /// Short name for the log.
    fn name(&self) -> &str;

    /// Before anything runs: variables, geometry, parameters.
    ///
    /// # Errors
    /// Whatever is wrong with the deck's interfaces.
    fn initialize(&mut self, part: &mut ModelPart) -> Result<()>;

    /// Unknowns it adds (beside those of elements), with the nodes that carry them; constant over the run.
    fn unknowns(&self, part: &ModelPart) -> Vec<(ScalarVariable, Vec<u32>)>;

    /// Step start, before the prediction: search, pairs, initial active set.
    ///
    /// # Errors
    /// A failed search.
    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()>;

    /// After the prediction and before the first assembly of the step.
    ///
    /// # Errors
    /// A geometry that cannot be computed with.
    fn after_prediction(&mut self, part: &mut ModelPart) -> Result<()>;

    /// After the update of iteration `iteration`: the active-set stage.
    ///
    /// # Errors
    /// A geometry that cannot be computed with.
    fn after_update(&mut self, part: &mut ModelPart, iteration: usize) -> Result<SetChange>;

    /// The iteration has converged: an outer loop, as Uzawa's, changes what the iteration held constant.
    ///
    /// # Errors
    /// A geometry that cannot be computed with.
    fn after_convergence(&mut self, _part: &mut ModelPart) -> Result<Outer> {
        Ok(Outer::Done)
    }

    /// The system is singular: takes hold of bodies that it keeps apart, so that none of them is free to move; `false` where
    /// there are none, or no more. What has been taken hold of may be let go after the solve as anything else.
    fn reach_out(&mut self, _part: &mut ModelPart) -> bool {
        false
    }

    /// The step is accepted.
    ///
    /// # Errors
    /// A geometry that cannot be computed with.
    fn accept_step(&mut self, part: &mut ModelPart) -> Result<()>;

    /// Blocks that act now.
    fn blocks(&self) -> Vec<&dyn EntityBlock>;

    /// Changes whenever the connectivity of [`Interaction::blocks`] does.
    fn graph_version(&self) -> u64;

    /// Changes whenever what it wrote into [`ModelPart::constraints`] does; the equations are then derived again.
    fn constraints_version(&self) -> u64 {
        0
    }

    /// Whether [`Interaction::after_update`] reads REACTION, which is then that of the updated state.
    fn needs_reactions(&self) -> bool {
        false
    }

    /// Diagonal and right-hand side for unknowns of [`Interaction::unknowns`] that no block touches now.
    fn idle_diagonal(&self) -> f64 {
        1.0
    }

    /// What may be added to the tangent's diagonal of its unknowns where constraints are redundant, as by supports at
    /// the edge of an interface; `None` where that must end the run.
    fn relaxation(&self) -> Option<f64> {
        None
    }

    /// The balance of an iterate is known: of the starting one (iteration 0) and of each after a solve.
    ///
    /// `residual` holds the equations that are solved. For those who watch; nothing may change.
    fn observe(&mut self, _part: &ModelPart, _iteration: usize, _residual: &[f64]) {}

    /// The nodes it looks at, ascending, when the first iterate of a step decides on its answer.
    ///
    /// Statics then begin a step as the reference program does: prescribed displacements are in the field before the first
    /// solve, these nodes follow them at once and the rest of the mesh after the solve.
    fn led_nodes(&self) -> Option<Vec<u32>> {
        None
    }

    /// The first iterate is there, and the step begins again without it: keeps what the step's answer takes from it.
    ///
    /// Called in place of [`Interaction::after_update`]; [`Interaction::after_prediction`] follows.
    fn keep_first_iterate(&mut self, _part: &mut ModelPart) {}

    /// Step start, in motion with inertia: nodes that others carry the mass of, since forces on them come and go at once.
    fn massless_nodes(&mut self, _part: &ModelPart) -> MasslessNodes {
        MasslessNodes::default()
    }

    /// Whether a step that fails again would be gone another way than the last time, whatever its length.
    fn has_another_way(&self) -> bool {
        false
    }

    /// Keeps what a retried step must restore.
    fn save(&mut self);

    /// Brings back what [`Interaction::save`] kept.
    fn restore(&mut self);

    /// Numbers chosen once for the run, by name: printed at its start and kept in its report.
    fn parameters(&self, _part: &ModelPart) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// Numbers for the report of a step, by name.
    fn summary(&self, _part: &ModelPart) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}
