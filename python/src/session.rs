//! A run that Python drives.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use zelus::core::model::Model;
use zelus::{RunOptions, Simulation};

use crate::errors;
use crate::event::Event;
use crate::law::reals;
use crate::line::{Answer, Lent, Line, Root, Shelf, shelf};
use crate::outcome::outcome;
use crate::plain::plain;
use crate::worker::{Asking, Command, Last, work};

/// A run in a thread of its own. It computes after a command or an answer; [`Session::wait`] returns its events. While it waits the
/// model can be read and written.
#[pyclass(frozen, module = "zelus._zelus")]
pub(crate) struct Session {
    commands: Mutex<Option<Sender<Command>>>,
    answers: Mutex<Option<Sender<Answer>>>,
    events: Mutex<Receiver<Event>>,
    shelf: Shelf,
    root: Root,
    last: Last,
    thread: Mutex<Option<JoinHandle<Simulation>>>,
}

#[pymethods]
impl Session {
    /// Reads a deck: a file or, where `deck` is given, that value, whose paths begin in the folder `path`.
    #[new]
    fn new(
        path: PathBuf,
        deck: Option<Bound<'_, PyAny>>,
        changes: Vec<(String, Bound<'_, PyAny>)>,
        threads: Option<usize>,
        like: Option<String>,
        attended: bool,
    ) -> PyResult<Self> {
        let changes = changes.into_iter().map(|(key, value)| Ok((key, plain(&value)?))).collect::<PyResult<_>>()?;
        let options = RunOptions { threads, like, changes, ..RunOptions::default() };
        let opened = match deck {
            Some(deck) => Simulation::of_value(&plain(&deck)?, &path, &options),
            None => Simulation::open(&path, &options),
        };
        let mut simulation = opened.map_err(|error| PyRuntimeError::new_err(errors::error(&error)))?;
        let (commands, heard) = channel();
        let (answers, answered) = channel();
        let (events, told) = channel();
        let (shelf, root, last) = (Shelf::default(), Root::default(), Last::default());
        let line = Line::new(events, answered, Arc::clone(&shelf), Arc::clone(&root));
        simulation.set_driver(Box::new(Asking { line: Arc::clone(&line), attended, last: Arc::clone(&last) }));
        let thread =
            std::thread::Builder::new().name("zelus".to_owned()).spawn(move || work(simulation, &heard, &line));
        Ok(Self {
            commands: Mutex::new(Some(commands)),
            answers: Mutex::new(Some(answers)),
            events: Mutex::new(told),
            shelf,
            root,
            last,
            thread: Mutex::new(Some(thread?)),
        })
    }

    /// Begins to "prepare" the next stage, "step" or "finish".
    fn command(&self, command: &str) -> PyResult<()> {
        let command = match command {
            "prepare" => Command::Prepare,
            "step" => Command::Step,
            "finish" => Command::Finish,
            other => return Err(PyValueError::new_err(format!("there is no command {other}"))),
        };
        shelf(&self.shelf).take();
        let commands = self.commands.lock().unwrap_or_else(PoisonError::into_inner);
        let sent = commands.as_ref().map(|commands| commands.send(command));
        sent.and_then(Result::ok).ok_or_else(over)
    }

    /// Answers a question of the run: `None` to continue, "act", the number of a process with the description of its residual as JSON,
    /// yes or no, or the bytes of residual and tangent; `error` ends the run.
    #[pyo3(signature = (what=None, process=None, residual=None, truth=None, numbers=None, error=None))]
    fn answer(
        &self,
        what: Option<&str>,
        process: Option<usize>,
        residual: Option<&str>,
        truth: Option<bool>,
        numbers: Option<(Vec<u8>, Vec<u8>)>,
        error: Option<String>,
    ) -> PyResult<()> {
        let residual = residual.map(serde_json::from_str).transpose();
        let residual = residual.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let answer = match (error, process, truth, numbers, what) {
            (Some(error), ..) => Answer::Fail(error),
            (_, Some(number), ..) => Answer::Process(Some((number, residual))),
            (_, _, Some(truth), ..) => Answer::Truth(truth),
            (.., Some((residual, tangent)), _) => Answer::Numbers(reals(&residual), reals(&tangent)),
            (.., Some("act")) => Answer::Act,
            _ => Answer::Go,
        };
        shelf(&self.shelf).take();
        let answers = self.answers.lock().unwrap_or_else(PoisonError::into_inner);
        answers.as_ref().and_then(|answers| answers.send(answer).ok()).ok_or_else(over)
    }

    /// The next event, `None` when there is none for so many seconds.
    fn wait<'py>(&self, py: Python<'py>, seconds: f64) -> PyResult<Option<Bound<'py, PyTuple>>> {
        let pause = Duration::from_secs_f64(seconds);
        let heard = py.detach(|| self.events.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(pause));
        match heard {
            Ok(event) => event.into_tuple(py).map(Some),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(PyRuntimeError::new_err("the run has panicked")),
        }
    }

    /// Name of the part that is solved for; empty before that is known.
    fn root(&self) -> String {
        self.root.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The report up to now, the mesh and the fields; the session ends, and its buffers go over to the arrays.
    fn end<'py>(&self, py: Python<'py>) -> PyResult<Option<(String, Option<Bound<'py, PyDict>>)>> {
        shelf(&self.shelf).take();
        self.commands.lock().unwrap_or_else(PoisonError::into_inner).take();
        self.answers.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(thread) = self.thread.lock().unwrap_or_else(PoisonError::into_inner).take() else { return Ok(None) };
        let mut simulation =
            py.detach(|| thread.join()).map_err(|_| PyRuntimeError::new_err("the run has panicked"))?;
        let root = simulation.part().map(|part| part.name.clone());
        let mut model: Model = std::mem::take(simulation.model_mut());
        let part = root.and_then(|root| model.parts.remove(&root));
        let computed = self.last.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default();
        let report = simulation.into_report();
        let text = serde_json::to_string(&report).map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(Some((text, part.map(|part| outcome(py, part, computed)).transpose()?)))
    }
}

fn over() -> PyErr {
    PyRuntimeError::new_err("the run is over")
}

impl Session {
    /// Result of `work` on the model that is lent now.
    pub(crate) fn with<T>(&self, work: impl FnOnce(&mut Lent) -> PyResult<T>) -> PyResult<T> {
        let mut lent = shelf(&self.shelf);
        let lent = lent.as_mut().ok_or_else(|| {
            PyRuntimeError::new_err(
                "the model can be read and written between steps and in processes, not while a step is solved",
            )
        })?;
        work(lent)
    }
}
