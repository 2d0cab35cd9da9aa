//! Interface between the stage and the solution of a step, whether it iterates or not.

use zelus_linear_algebra::State;

use super::location::inside_out;
use super::phases::Phases;
use super::records::{IterationRecord, Monitor, StepRecord};
use crate::assembly::{Assembler, System};
use crate::diagnostics::{Diagnostic, Error, Result};
use crate::entities::{Interaction, SetChange};
use crate::model::ModelPart;

/// Solves the steps of one model part, one after another.
pub trait SolutionStrategy: Send {
    /// Length of the next step, from the one that `time_stepping` gives.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    fn step_length(&mut self, _part: &mut ModelPart, _system: &System, asked: f64) -> Result<f64> {
        Ok(asked)
    }

    /// Whether a step that fails may be tried again in shorter ones.
    fn can_retry(&self) -> bool {
        true
    }

    /// An attempt at a step has failed: takes up another way to iterate until a step is accepted, and names it; `None` where none would
    /// help, or where the other way itself has failed and is given up.
    fn other_way(&mut self, _failed: &StepRecord) -> Option<&'static str> {
        None
    }

    /// Remedy when steps fail.
    fn remedy(&self) -> &'static str {
        "a shorter \"time_step\", more \"max_iteration\", the strategy \"line_search\", at a limit load \"arc_length\""
    }

    /// Steps between two that are announced: more than 1 where steps are many and short.
    fn announce_every(&self) -> usize {
        1
    }

    /// Solves the step whose time, fixities and prescribed values are set; the record says whether it converged.
    ///
    /// # Errors
    /// A singular system, a failed solver or search. An entity that cannot be computed (e.g. inverted), and with interactions
    /// a singular system, make the step not converged instead.
    fn solve_step(
        &mut self,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<StepRecord>;

    /// The step is accepted: history advances, once.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    fn finalize_step(&mut self, part: &mut ModelPart, system: &mut System) -> Result<()>;

    /// Numbers chosen for the run since they were last asked for, by name: kept in its report.
    fn chosen_numbers(&mut self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// Notes and warnings since they were last asked for; the stage passes them on.
    fn messages(&mut self) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// Warnings of events that never happened in any step to interactions of its own, asked for once after the last.
    fn last_messages(&self, _part: &ModelPart) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// The system of the last step.
    fn assembler(&self) -> &Assembler;

    /// State between steps, for the file of a saved run; a strategy that wraps another passes on the other's.
    fn state(&self) -> Option<Box<dyn State>>;

    /// Takes up a saved state; `part` and `system` have theirs already.
    ///
    /// # Errors
    /// The state of another strategy.
    fn resume(&mut self, part: &ModelPart, system: &System, state: Box<dyn State>) -> Result<()>;

    /// Seconds spent beside assembly.
    fn phases(&self) -> Phases {
        Phases::default()
    }

    /// Its balance near the state it has solved, where it has a tangent there.
    fn linearized(&mut self) -> Option<&mut dyn Linearized> {
        None
    }

    /// Whether its iterations take a [`Follower`](crate::entities::Follower) with them.
    fn takes_followers(&self) -> bool {
        false
    }
}

/// A balance with its tangent.
pub trait Linearized {
    /// Out-of-balance residual in the present state, a number an unknown of `system`; blocks of interactions may be others than those
    /// of the tangent. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    fn out_of_balance(&mut self, part: &ModelPart, system: &System) -> Result<Vec<f64>>;

    /// The increment of the unknowns that the last tangent answers this with. Collective.
    ///
    /// # Errors
    /// A singular tangent, a solver that fails.
    fn answer(&mut self, part: &ModelPart, system: &System, out_of_balance: &[f64]) -> Result<Vec<f64>>;
}

/// Lets blocks and interactions advance their history.
///
/// # Errors
/// An entity that cannot be computed.
pub fn accept(part: &mut ModelPart, system: &mut System) -> Result<()> {
    let result = system.elements.iter_mut().try_for_each(|block| block.finalize_step(&part.view()));
    part.ranks.agree(result.map_err(Error::from))?;
    system.interactions.iter_mut().try_for_each(|interaction| interaction.finalize_step(part))
}

/// The prediction is made: lets the interactions follow it.
///
/// # Errors
/// A geometry that cannot be computed with.
pub(super) fn after_prediction(part: &mut ModelPart, interactions: &mut [Box<dyn Interaction>]) -> Result<()> {
    interactions.iter_mut().filter_map(|i| i.active_set()).try_for_each(|set| set.after_prediction(part))
}

/// Term for the diagonal of interactions whose constraints are redundant.
pub(super) fn relaxation(interactions: &[Box<dyn Interaction>]) -> Option<f64> {
    interactions.iter().filter_map(|interaction| interaction.coupling()).find_map(|coupling| coupling.relaxation())
}

/// Lets interactions follow an update of the unknowns; returns the changes in all of them.
///
/// # Errors
/// A pair that cannot be computed.
pub(super) fn update_interactions(
    part: &mut ModelPart,
    interactions: &mut [Box<dyn Interaction>],
    iteration: usize,
) -> Result<SetChange> {
    let mut change = SetChange::default();
    for interaction in interactions {
        if let Some(set) = interaction.active_set() {
            change.extend(set.after_update(part, iteration)?);
        }
    }
    Ok(change)
}

/// Whether it says that entities cannot be computed in their present state, as where they are turned inside out.
pub(super) fn is_of_entities(error: &Error) -> bool {
    matches!(error, Error::Input(problems) if problems.iter().all(|problem| problem.code == "entity"))
}

/// Runs `solve` and records the outcome: iterations and the reason of a failure.
///
/// # Errors
/// As `solve`, but an entity that cannot be computed becomes the reason of a failure.
pub fn recorded<R>(part: &mut ModelPart, system: &mut System, solve: R) -> Result<StepRecord>
where
    R: FnOnce(&mut ModelPart, &mut System) -> Result<(Vec<IterationRecord>, Option<String>)>,
{
    let result = solve(part, system);
    let numbers = system.interactions.iter().flat_map(|i| i.summary(part));
    let mut record = StepRecord {
        step: part.info.step,
        time: part.info.time,
        delta_time: part.info.delta_time,
        interactions: numbers.map(|(name, value)| (name.to_owned(), value)).collect(),
        ..StepRecord::default()
    };
    match result {
        Ok((iterations, failure)) => {
            record.iterations = iterations;
            record.converged = failure.is_none();
            record.failure = failure;
        }
        Err(error) if is_of_entities(&error) => {
            let iteration = part.info.nl_iteration;
            let inverted = inside_out(part).map_or(String::new(), |which| format!("; {which}"));
            record.failure = Some(format!("in iteration {iteration}, {error}{inverted}"));
        }
        Err(error) => return Err(error),
    }
    Ok(record)
}
