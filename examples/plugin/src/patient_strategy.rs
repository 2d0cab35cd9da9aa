//! Newton's iteration that continues once where it has not converged.

use zelus_core::assembly::{Assembler, System};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::ModelPart;
use zelus_core::register;
use zelus_core::strategies::{Monitor, NewtonRaphson, SolutionStrategy, StepRecord, StrategyEntry};
use zelus_core::{Result, State};

struct Patient(NewtonRaphson);

impl SolutionStrategy for Patient {
    fn solve_step(
        &mut self,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<StepRecord> {
        let mut record = self.0.solve_step(part, system, monitor)?;
        if !record.converged {
            let again = self.0.solve_step(part, system, monitor)?;
            let earlier = std::mem::take(&mut record.iterations);
            record = StepRecord { iterations: earlier.into_iter().chain(again.iterations.clone()).collect(), ..again };
        }
        Ok(record)
    }

    fn finalize_step(&mut self, part: &mut ModelPart, system: &mut System) -> Result<()> {
        self.0.finalize_step(part, system)
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        self.0.messages()
    }

    fn state(&self) -> Option<Box<dyn State>> {
        self.0.state()
    }

    fn resume(&mut self, part: &ModelPart, system: &System, state: Box<dyn State>) -> Result<()> {
        self.0.resume(part, system, state)
    }

    fn assembler(&self) -> &Assembler {
        self.0.assembler()
    }
}

register! { StrategyEntry "patient_newton",
    about: "Newton's iteration that continues once where it has not converged",
    build: |request| Ok(Box::new(Patient(request.newton()?))),
}
