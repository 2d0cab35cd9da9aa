//! The thread of a run: executes the commands of Python, and asks it on the way.

use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex};

use zelus::core::analysis::{Driver, LoopPoint};
use zelus::core::assembly::System;
use zelus::core::diagnostics::Diagnostic;
use zelus::core::io::results::Dataset;
use zelus::core::model::Model;
use zelus::core::parameters::Node;
use zelus::core::processes::{Process, ProcessEntry, usual_results};
use zelus::core::registry;
use zelus::core::strategies::{IterationRecord, Plan, StepRecord};
use zelus::{Error, Monitor, Result, Simulation};

use crate::errors;
use crate::event::Event;
use crate::line::{Answer, Line};
use crate::process::PythonProcess;

/// Commands from Python.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Command {
    Prepare,
    Step,
    Finish,
}

/// Data of the elements at the end of a run, which end with it.
pub(crate) type Last = Arc<Mutex<Option<Dataset>>>;

/// Runs commands until there are none; gives the simulation back.
pub(crate) fn work(mut simulation: Simulation, commands: &Receiver<Command>, line: &Line) -> Simulation {
    let mut watch = Watch(line);
    while let Ok(command) = commands.recv() {
        let done = match command {
            Command::Prepare => simulation.prepare(&mut watch).map(|()| true),
            Command::Step => simulation.step(&mut watch),
            Command::Finish => simulation.finish().map(|()| false),
        };
        let event = Event::Idle(done.map_err(|error| errors::error(&error)));
        if let Some(part) = simulation.part() {
            line.solves_for(&part.name);
        }
        let system = simulation.system().map(std::ptr::from_ref);
        // SAFETY: the system outlives the loan, which ends with the next command.
        let system = system.map(|system| unsafe { &*system });
        line.lend(event, simulation.model_mut(), system);
    }
    simulation
}

/// Tells Python of progress.
struct Watch<'a>(&'a Line);

impl Monitor for Watch<'_> {
    fn begin_stage(&mut self, plan: &Plan) {
        self.0.tell(Event::Stage(*plan));
    }

    fn begin_step(&mut self, step: usize, time: f64, delta_time: f64) {
        self.0.tell(Event::Begin(step, time, delta_time));
    }

    fn iteration(&mut self, record: &IterationRecord) {
        self.0.tell(Event::Iteration(serde_json::to_string(record).unwrap_or_default()));
    }

    fn end_step(&mut self, record: &StepRecord) {
        self.0.tell(Event::End(record.clone()));
    }

    fn note(&mut self, text: &str) {
        self.0.tell(Event::Note(text.to_owned()));
    }

    fn warn(&mut self, warning: &Diagnostic) {
        self.0.tell(Event::Warning(warning.clone()));
    }
}

/// Asks Python at the points of the loop, and for processes.
pub(crate) struct Asking {
    pub(crate) line: Arc<Line>,
    /// Whether Python decides the work at the points; else all is done by the deck.
    pub(crate) attended: bool,
    pub(crate) last: Last,
}

impl Driver for Asking {
    fn process(&mut self, entry: &Node, model: &mut Model) -> Result<Option<Box<dyn Process>>> {
        let module = entry.get("python_module").or_else(|| entry.get("name")).and_then(Node::as_str);
        let name = module.and_then(|module| module.rsplit('.').next()).unwrap_or_default();
        let known = registry::find::<ProcessEntry>(name).is_some();
        match self.line.ask(Event::Make(entry.to_json().to_string(), known), model, None)? {
            Answer::Process(Some((number, residual))) => {
                let line = Arc::clone(&self.line);
                Ok(Some(Box::new(PythonProcess { number, line, residual, has_begun: false })))
            }
            _ => Ok(None),
        }
    }

    fn at(
        &mut self,
        point: LoopPoint,
        root: &str,
        model: &mut Model,
        system: &System,
        act: &mut dyn FnMut(&mut Model) -> Result<()>,
    ) -> Result<()> {
        if point == LoopPoint::Finalize {
            *self.last.lock().map_err(|_| lost())? = Some(usual_results(model.root(root)?, system));
        }
        self.line.solves_for(root);
        if !self.attended {
            return act(model);
        }
        let mut answer = self.line.ask(Event::At(point), model, Some(system))?;
        while matches!(answer, Answer::Act) {
            act(model)?;
            answer = self.line.ask(Event::Acted(point), model, Some(system))?;
        }
        Ok(())
    }
}

fn lost() -> Error {
    Error::System("a thread of the run has panicked".to_owned())
}
