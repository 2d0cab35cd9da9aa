//! Interface of a program that drives a run: its calls at the points of the loop.

use crate::assembly::System;
use crate::diagnostics::Result;
use crate::model::Model;
use crate::parameters::Node;
use crate::processes::Process;

/// A point of the loop of a stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LoopPoint {
    /// Mesh and materials are read; no process is made yet, and the stage does nothing here.
    Read,
    /// All is ready to run; the stage does nothing here.
    Ready,
    /// Before the first step: [`Process::before_loop`] of all processes.
    BeforeLoop,
    /// Time has advanced, nothing is solved: [`Process::begin_step`] of all processes. Once more where a step is cut.
    BeginStep,
    /// The step is solved and accepted: [`Process::end_step`] of all processes.
    EndStep,
    /// Output of those processes that write now.
    Output,
    /// After the last step, also when a step failed: [`Process::finalize`] of all processes.
    Finalize,
}

/// Drives a run from outside, as bindings to another language do: makes processes that no registry knows, and decides at the
/// points of the loop when the stage acts. Over ranks all of them have one that does the same.
pub trait Driver: Send {
    /// Makes the process that an entry of the deck's lists names; `None` leaves it to the registry.
    ///
    /// # Errors
    /// An entry from which it cannot be made.
    fn process(&mut self, _entry: &Node, _model: &mut Model) -> Result<Option<Box<dyn Process>>> {
        Ok(None)
    }

    /// The stage that solves for the part `root` is at `point`; each call of `act` performs the stage's work there. `system` is without
    /// unknowns before [`LoopPoint::Ready`].
    ///
    /// # Errors
    /// As `act`; whatever ends the run.
    fn at(
        &mut self,
        _point: LoopPoint,
        _root: &str,
        model: &mut Model,
        _system: &System,
        act: &mut dyn FnMut(&mut Model) -> Result<()>,
    ) -> Result<()> {
        act(model)
    }
}

/// Leaves all to the deck.
#[derive(Debug, Default)]
pub struct Unattended;

impl Driver for Unattended {}
