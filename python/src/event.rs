//! Events of a run that Python receives.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use zelus::core::analysis::LoopPoint;
use zelus::core::diagnostics::Diagnostic;
use zelus::core::strategies::{Plan, StepRecord};

use crate::buffer::Buffer;
use crate::errors;

/// One event; those that wait for an answer say so.
pub(crate) enum Event {
    /// A point of the loop; waits.
    At(LoopPoint),
    /// The work at this point of the loop is done; waits.
    Acted(LoopPoint),
    /// An entry of the deck's lists of processes, as JSON, and whether the registry knows it; waits.
    Make(String, bool),
    /// A method of the process of that number is to be called; waits.
    Call(usize, &'static str),
    /// Entities that a process has a residual for: its number, that of the block, ids, nodes, nodes of each; waits.
    Block(usize, usize, Vec<usize>, Vec<u32>, usize),
    /// The residual of a block is wanted, or `both` it and its tangent, for these values of the unknowns; waits.
    Evaluate { process: usize, block: usize, values: Vec<f64>, time: f64, length: f64, both: bool },
    /// A stage is ready.
    Stage(Plan),
    /// A step begins: number, time, length.
    Begin(usize, f64, f64),
    /// An iteration is done: its record, as JSON.
    Iteration(String),
    /// A step, or an attempt at it, is over.
    End(StepRecord),
    /// A line worth reading.
    Note(String),
    /// A warning or note with its code.
    Warning(Diagnostic),
    /// The command is done, and whether there was a step to make; or it failed, as JSON.
    Idle(Result<bool, String>),
}

/// The word for a point.
fn word(point: LoopPoint) -> &'static str {
    match point {
        LoopPoint::Read => "read",
        LoopPoint::Ready => "ready",
        LoopPoint::BeforeLoop => "before_loop",
        LoopPoint::BeginStep => "begin_step",
        LoopPoint::EndStep => "end_step",
        LoopPoint::Output => "output",
        LoopPoint::Finalize => "finalize",
    }
}

impl Event {
    /// A tuple that begins with the word for the event.
    pub(crate) fn into_tuple(self, py: Python<'_>) -> PyResult<Bound<'_, PyTuple>> {
        match self {
            Self::At(point) => ("at", word(point)).into_pyobject(py),
            Self::Acted(point) => ("acted", word(point)).into_pyobject(py),
            Self::Make(entry, known) => ("make", entry, known).into_pyobject(py),
            Self::Call(process, method) => ("call", process, method).into_pyobject(py),
            Self::Block(process, block, ids, nodes, width) => {
                let nodes = Buffer::whole(nodes.into_iter().map(i64::from).collect(), width);
                ("block", process, block, Buffer::list(&ids), nodes, width).into_pyobject(py)
            }
            Self::Evaluate { process, block, values, time, length, both } => {
                ("evaluate", process, block, Buffer::real(values, 1), time, length, both).into_pyobject(py)
            }
            Self::Stage(plan) => ("stage", plan.stage, plan.stages, plan.start, plan.end, plan.steps).into_pyobject(py),
            Self::Begin(step, time, length) => ("begin", step, time, length).into_pyobject(py),
            Self::Iteration(record) => ("iteration", record).into_pyobject(py),
            Self::End(record) => {
                ("end", record.step, record.time, record.converged, record.iterations.len()).into_pyobject(py)
            }
            Self::Note(text) => ("note", text).into_pyobject(py),
            Self::Warning(warning) => ("warning", errors::problem(&warning).to_string()).into_pyobject(py),
            Self::Idle(Ok(more)) => ("idle", more, None::<String>).into_pyobject(py),
            Self::Idle(Err(error)) => ("idle", false, Some(error)).into_pyobject(py),
        }
    }
}
