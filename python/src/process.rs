//! A process that is an object of Python.

use std::sync::Arc;

use zelus::Result;
use zelus::core::assembly::System;
use zelus::core::diagnostics::Report;
use zelus::core::entities::Interaction;
use zelus::core::model::Model;
use zelus::core::processes::Process;

use crate::event::Event;
use crate::line::{Answer, Line};
use crate::residual::{self, Description, PythonResidual};

/// Calls the methods of the object with its number, by the names that Kratos has for them.
pub(crate) struct PythonProcess {
    pub(crate) number: usize,
    pub(crate) line: Arc<Line>,
    /// Description of its residual, where it has one.
    pub(crate) residual: Option<Description>,
    /// Whether it was told that the loop begins; a restarted run does not tell.
    pub(crate) has_begun: bool,
}

impl PythonProcess {
    fn call(&self, method: &'static str, model: &mut Model, system: Option<&System>) -> Result<Answer> {
        self.line.ask(Event::Call(self.number, method), model, system)
    }
}

impl Process for PythonProcess {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        self.call("ExecuteInitialize", model, None).map(drop)
    }

    fn interaction(&mut self, model: &mut Model) -> Result<Option<(String, Box<dyn Interaction>)>> {
        let Some(own) = &self.residual else { return Ok(None) };
        let residual = PythonResidual::new(self.number, &self.line, own, model)?;
        Ok(Some((own.part.clone(), Box::new(residual))))
    }

    fn check(&self, model: &Model, system: &System, report: &mut Report) -> Result<()> {
        self.residual.as_ref().map_or(Ok(()), |own| residual::check(own, model, system, report))?;
        self.line.ask_of(Event::Call(self.number, "Check"), model).map(drop)
    }

    fn before_loop(&mut self, model: &mut Model) -> Result<()> {
        self.has_begun = true;
        self.call("ExecuteBeforeSolutionLoop", model, None).map(drop)
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        if !self.has_begun {
            self.before_loop(model)?;
        }
        self.call("ExecuteInitializeSolutionStep", model, None).map(drop)
    }

    fn end_step(&mut self, model: &mut Model, system: &System) -> Result<()> {
        self.call("ExecuteFinalizeSolutionStep", model, Some(system)).map(drop)
    }

    fn is_output_step(&mut self, model: &Model) -> bool {
        // an error here occurs again in the next call
        matches!(self.line.ask_of(Event::Call(self.number, "IsOutputStep"), model), Ok(Answer::Truth(true)))
    }

    fn before_output(&mut self, model: &mut Model, system: &System) -> Result<()> {
        self.call("ExecuteBeforeOutputStep", model, Some(system)).map(drop)
    }

    fn print_output(&mut self, model: &mut Model, system: &System) -> Result<()> {
        self.call("PrintOutput", model, Some(system)).map(drop)
    }

    fn after_output(&mut self, model: &mut Model, system: &System) -> Result<()> {
        self.call("ExecuteAfterOutputStep", model, Some(system)).map(drop)
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        self.call("ExecuteFinalize", model, None).map(drop)
    }
}
