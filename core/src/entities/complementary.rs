//! Conditions of an interaction that are decided together, by one linear complementarity problem.

use super::interaction::{OuterLoop, SetChange};
use crate::diagnostics::Result;
use crate::model::{ModelPart, Owner, ScalarVariable};

/// One condition: its multiplier and the row of that multiplier's equation, one of which is zero.
#[derive(Debug, Clone, PartialEq)]
pub struct ComplementaryCondition {
    /// Owner of the multiplier.
    pub owner: Owner,
    /// The unknowns of the multiplier, each with its share of the direction in which the condition acts.
    pub direction: Vec<(ScalarVariable, f64)>,
    /// Whether it acts: its row is zero and its multiplier follows, otherwise the reverse.
    pub acts: bool,
}

/// Linear responses of conditions, about a state in balance, to what is given of each: the row of one that acts, the multiplier of
/// another.
///
/// Column j is the change by a unit force on row j where condition j acts, and by a unit multiplier j where it does not.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Responses {
    /// Residual of each row in the state, as if all conditions acted.
    pub rows: Vec<f64>,
    /// Change of multiplier i by what is given of condition j, at `i * n + j`.
    pub of_multipliers: Vec<f64>,
    /// Change of the residual of row i, as if all conditions acted, by what is given of condition j, at `i * n + j`.
    pub of_rows: Vec<f64>,
}

/// Conditions that are decided together.
pub trait Complementary {
    /// The conditions to decide on.
    fn conditions(&self, part: &ModelPart) -> Vec<ComplementaryCondition>;

    /// Lets all conditions act, whatever has been decided on them.
    fn activate_all(&mut self);

    /// Lets those conditions act that did before [`Complementary::activate_all`].
    fn restore_decisions(&mut self);

    /// Whether only joint decisions change the conditions of this step, not the rules of each.
    fn hold(&mut self, held: bool);

    /// Decides on all conditions by their responses, in a state that need not be converged.
    fn decide_states(&mut self, part: &mut ModelPart, responses: &Responses) -> SetChange;

    /// Decides on all conditions by their responses, without them one by one; gives a line for the log too, where they are decided
    /// together.
    ///
    /// # Errors
    /// A geometry that cannot be computed with.
    fn decide_together(
        &mut self,
        part: &mut ModelPart,
        responses: Option<&Responses>,
    ) -> Result<(OuterLoop, Option<String>)>;
}
