//! What the stage asks of the solution of a step, whether it iterates or not.

use super::records::{IterationRecord, Monitor, StepRecord};
use crate::assembly::{Assembler, System};
use crate::communication::world;
use crate::diagnostics::{Error, Result};
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

    /// What to try when steps fail.
    fn remedy(&self) -> &'static str {
        "a shorter \"time_step\", more \"max_iteration\", \"line_search\": true, at a limit load \"arc_length\""
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
    fn accept_step(&mut self, part: &mut ModelPart, system: &mut System) -> Result<()>;

    /// The system of the last step.
    fn assembler(&self) -> &Assembler;

    /// Seconds spent in linear solves: symbolic, numeric, solution.
    fn linear_seconds(&self) -> [f64; 3] {
        [0.0; 3]
    }
}

/// Lets blocks and interactions advance their history.
///
/// # Errors
/// An entity that cannot be computed.
pub(super) fn accept(part: &mut ModelPart, system: &mut System) -> Result<()> {
    let result = system.elements.iter_mut().try_for_each(|block| block.accept_step(&part.view()));
    world().agree(result.map_err(Error::from))?;
    system.interactions.iter_mut().try_for_each(|interaction| interaction.accept_step(part))
}

/// Lets interactions follow an update of the unknowns; what changed in all of them.
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
        change.extend(interaction.after_update(part, iteration)?);
    }
    Ok(change)
}

/// Runs `solve` and puts down what came of it: iterations and the reason of a failure.
///
/// # Errors
/// As `solve`, but an entity that cannot be computed becomes the reason of a failure.
pub(super) fn recorded<R>(part: &mut ModelPart, system: &mut System, solve: R) -> Result<StepRecord>
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
        Err(Error::Input(problems)) if problems.iter().all(|p| p.code == "entity") => {
            let iteration = part.info.nl_iteration;
            record.failure = Some(format!("in iteration {iteration}, {}", Error::Input(problems)));
        }
        Err(error) => return Err(error),
    }
    Ok(record)
}
