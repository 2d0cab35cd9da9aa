//! Processes and functions of the program as objects of Python.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use zelus::core::assembly::System;
use zelus::core::diagnostics::{Place, Report};
use zelus::core::parameters::{Expression, Interval, Node, SpaceTime};
use zelus::core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus::core::registry;

use crate::access::read_only;
use crate::errors;
use crate::plain::plain;
use crate::session::Session;

/// A process of the registry that Python calls itself.
#[pyclass(frozen, module = "zelus._zelus")]
pub(crate) struct Builtin {
    session: Py<Session>,
    process: Mutex<Box<dyn Process>>,
}

#[pymethods]
impl Builtin {
    /// Makes the process of that name from its "Parameters"; relative file names start in `folder`.
    #[new]
    fn new(session: Py<Session>, name: &str, parameters: Bound<'_, PyAny>, folder: PathBuf) -> PyResult<Self> {
        let entry = registry::require::<ProcessEntry>(name).map_err(|problem| failed(&problem.into()))?;
        let place = Place::file(format!("the parameters of {name}"));
        let node = Node::from_json(&plain(&parameters)?, &place).map_err(|error| failed(&error))?;
        let process = session.get().with(|lent| {
            let model = lent.model_mut().ok_or_else(read_only)?;
            let mut report = Report::new();
            let (parameters, folder) = (&node, folder.as_path());
            let request =
                &mut ProcessRequest { entry, parameters, model, folder, results: folder, report: &mut report };
            let made = (entry.build)(request).map_err(|error| error.at(&place));
            let made = made.and_then(|made| report.finish().map(|_| made));
            made.map_err(|error| failed(&error))
        })?;
        Ok(Self { session, process: Mutex::new(process) })
    }

    /// Calls a method by the name that Kratos has for it; gives whether it is an output step where it asks that.
    fn call(&self, method: &str) -> PyResult<bool> {
        self.session.get().with(|lent| {
            let mut process = self.process.lock().unwrap_or_else(PoisonError::into_inner);
            if method == "IsOutputStep" {
                return Ok(process.is_output_step(lent.model()));
            }
            let none = System::default();
            let (model, system) = lent.both().ok_or_else(read_only)?;
            let system = system.unwrap_or(&none);
            let done = match method {
                "ExecuteInitialize" => {
                    process.initialize(model).map_err(|error| failed(&error))?;
                    let brings = process.interaction(model).map_err(|error| failed(&error))?;
                    if brings.is_some() {
                        let fact = "a process that brings contact or ties belongs into the lists of the deck";
                        return Err(PyRuntimeError::new_err(fact));
                    }
                    Ok(())
                }
                "ExecuteBeforeSolutionLoop" => process.before_loop(model),
                "ExecuteInitializeSolutionStep" => process.begin_step(model).and_then(|()| process.constrain(model)),
                "ExecuteFinalizeSolutionStep" => process.end_step(model, system),
                "ExecuteBeforeOutputStep" => process.before_output(model, system),
                "PrintOutput" => process.print_output(model, system),
                "ExecuteAfterOutputStep" => process.after_output(model, system),
                "ExecuteFinalize" => process.finalize(model),
                other => return Err(PyValueError::new_err(format!("processes have no {other}"))),
            };
            done.map(|()| false).map_err(|error| failed(&error))
        })
    }
}

/// The error as JSON, for Python to make an exception of.
fn failed(error: &zelus::Error) -> PyErr {
    PyRuntimeError::new_err(errors::error(error))
}

/// A function of space and time as decks write it.
#[pyclass(frozen, module = "zelus._zelus")]
pub(crate) struct Function(Expression);

#[pymethods]
impl Function {
    /// Compiles a text such as "2.0*t + sin(pi*X)".
    #[new]
    fn new(text: &str) -> PyResult<Self> {
        let wrong = |error: zelus::core::parameters::ExpressionError| {
            PyValueError::new_err(format!("{text:?}, character {}: {}", error.column, error.fact))
        };
        Expression::parse(text).map(Self).map_err(wrong)
    }

    /// Its value at a position, now and initial, and a time.
    fn value(&self, current: [f64; 3], initial: [f64; 3], time: f64) -> f64 {
        self.0.value(&SpaceTime { current, initial, time })
    }

    /// Whether it depends on the position.
    fn depends_on_space(&self) -> bool {
        self.0.uses_space()
    }
}

/// Whether a time lies in an interval, as processes see it.
#[pyfunction]
pub(crate) fn in_interval(begin: f64, end: f64, time: f64) -> bool {
    Interval { begin, end }.contains(time)
}

/// Whether the registry has a process of that name.
#[pyfunction]
pub(crate) fn is_process(name: &str) -> bool {
    registry::find::<ProcessEntry>(name).is_some()
}
