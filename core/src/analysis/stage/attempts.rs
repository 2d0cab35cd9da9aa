//! Attempts at a step of the deck: cut where they do not converge, accepted where they do.

use std::time::Instant;

use super::super::cutting::{Cutting, Lengths};
use super::super::driver::LoopPoint;
use super::super::step_backup::StepBackup;
use super::support_reactions::support_reactions;
use super::{RunContext, Stage};
use crate::assembly::System;
use crate::diagnostics::{Error, Result};
use crate::model::Model;
use crate::processes::Process;
use crate::strategies::StepRecord;

impl Stage {
    /// Solves up to `target`, in one step or, where that does not converge, in shorter ones.
    pub(super) fn advance_to(&mut self, target: f64, run: &mut RunContext<'_>) -> Result<()> {
        let whole = target - run.model.root(&self.root)?.info.time;
        let mut lengths = Lengths::new(self.schedule.cutting, whole, self.first_length.take());
        let mut failed: Option<StepRecord> = None;
        loop {
            let from = run.model.root(&self.root)?.info.time;
            let (to, last) = lengths.next(from, target);
            let part = run.model.root_mut(&self.root)?;
            let saved = self.strategy.can_retry().then(|| StepBackup::of(part, &mut self.system));
            let record = self.attempt(to, run)?;
            if let Some(why) = record.coarse.as_ref().filter(|_| saved.is_some() && lengths.refine(to - from)) {
                let factor = self.schedule.cutting.factor;
                run.monitor
                    .note(&format!("step {} to time {to}: {why}; repeated with 1/{factor} of the step", record.step));
                saved.expect("just asked for").restore(run.model.root_mut(&self.root)?, &mut self.system);
                continue;
            }
            if record.converged {
                self.accept(run)?;
                lengths.grow();
                failed = None;
                if last {
                    self.first_length = lengths.carry();
                    return Ok(());
                }
                continue;
            }
            let failure = record.failure.clone().unwrap_or_default();
            let can_cut = saved.is_some() && self.schedule.cutting.times > 0;
            let other_way = if can_cut && !record.unrestrained { self.strategy.other_way(&record) } else { None };
            if let Some(how) = other_way {
                run.monitor.note(&format!("step {} to time {to}: {failure}; retried {how}", record.step));
                saved.expect("just asked for").restore(run.model.root_mut(&self.root)?, &mut self.system);
                continue;
            }
            let is_in_vain = failed.as_ref().is_some_and(|before| before.fails_like(&record))
                && !self.system.interactions.iter_mut().filter_map(|i| i.retry()).any(|own| own.has_alternative());
            let is_in_vain = is_in_vain || record.unrestrained;
            let Some(saved) = saved.filter(|_| !is_in_vain && lengths.cut(to - from)) else {
                let tried = match self.schedule.cutting {
                    _ if !can_cut => "the solver does not cut steps".to_owned(),
                    _ if record.unrestrained => {
                        "the body moves on without meeting anything: a shorter step does not help".to_owned()
                    }
                    _ if is_in_vain => "a shorter step failed in the same way: it is the same problem".to_owned(),
                    Cutting { times, factor } => {
                        format!("{times} cut{} of the step by {factor} did not help", if times == 1 { "" } else { "s" })
                    }
                };
                let kept = self.keep_last_iterate(run.model);
                if record.singular {
                    return Err(Error::System(format!(
                        "step {} to time {to}: {failure}\n    {tried}{kept}",
                        record.step
                    )));
                }
                let written = match from > self.schedule.start_time {
                    true => format!("results up to time {from} are written"),
                    false => "no step has converged".to_owned(),
                };
                return Err(Error::NotConverged(format!(
                    "step {} to time {to}: {failure}\n    {tried}; {written}{kept}. Try {}, or look at the nodes named",
                    record.step,
                    self.strategy.remedy()
                )));
            };
            let factor = self.schedule.cutting.factor;
            run.monitor
                .note(&format!("step {} to time {to}: {failure}; retried with 1/{factor} of the step", record.step));
            saved.restore(run.model.root_mut(&self.root)?, &mut self.system);
            failed = Some(record);
        }
    }

    /// Writes the state of a step that has failed, apart from results, and says where; collective.
    fn keep_last_iterate(&mut self, model: &mut Model) -> String {
        let mut said = String::new();
        for process in &mut self.processes {
            match model.ranks.clone().agree(process.print_last_iterate(model, &self.system)) {
                Ok(Some(folder)) => said += &format!("; its last iterate, no result, is in {}", folder.display()),
                Ok(None) => {}
                Err(error) => said += &format!("; its last iterate cannot be written: {error}"),
            }
        }
        said
    }

    fn attempt(&mut self, to: f64, run: &mut RunContext<'_>) -> Result<StepRecord> {
        let part = run.model.root_mut(&self.root)?;
        part.info.step += 1;
        part.clone_time_step(to);
        let announced = (part.info.step - 1) % self.strategy.announce_every() == 0;
        if announced {
            run.monitor.begin_step(part.info.step, part.info.time, part.info.delta_time);
        }
        let ranks = run.model.ranks.clone();
        let processes = &mut self.processes;
        run.driver.at(LoopPoint::BeginStep, &self.root, run.model, &self.system, &mut |model| {
            processes.iter_mut().try_for_each(|process| ranks.agree(process.begin_step(model)))?;
            processes.iter_mut().try_for_each(|process| ranks.agree(process.constrain(model)))
        })?;
        let start = Instant::now();
        let record = self.strategy.solve_step(run.model.root_mut(&self.root)?, &mut self.system, run.monitor)?;
        run.report.add_seconds("solve steps", start.elapsed().as_secs_f64());
        self.pass_on_messages(run);
        if announced || !record.converged {
            run.monitor.end_step(&record);
        }
        run.report.record(record.clone());
        Ok(record)
    }

    fn accept(&mut self, run: &mut RunContext<'_>) -> Result<()> {
        let part = run.model.root_mut(&self.root)?;
        self.strategy.finalize_step(part, &mut self.system)?;
        // Explicit steps are many and short: the state at their end tells.
        if !part.info.solver.explicit {
            self.largest.see(part, &self.system);
        }
        run.monitor.phase("output");
        let start = Instant::now();
        let ranks = run.model.ranks.clone();
        let Self { processes, system, root, .. } = self;
        let part = run.model.root(root)?;
        run.report.add_supports(|balance| support_reactions(part, processes, balance));
        run.driver.at(LoopPoint::EndStep, root, run.model, system, &mut |model| {
            processes.iter_mut().try_for_each(|process| ranks.agree(process.end_step(model, system)))
        })?;
        run.report.add_numbers(processes.iter().flat_map(|process| process.summary()));
        run.driver
            .at(LoopPoint::Output, root, run.model, system, &mut |model| write_output(processes, model, system))?;
        run.report.add_seconds("output", start.elapsed().as_secs_f64());
        self.pass_on_messages(run);
        Ok(())
    }
}

/// Lets those processes write that have output to write now.
fn write_output(processes: &mut [Box<dyn Process>], model: &mut Model, system: &System) -> Result<()> {
    let ranks = model.ranks.clone();
    let writes: Vec<bool> = processes.iter_mut().map(|process| process.is_output_step(model)).collect();
    if !writes.contains(&true) {
        return Ok(());
    }
    processes.iter_mut().try_for_each(|process| ranks.agree(process.before_output(model, system)))?;
    let mut writers = processes.iter_mut().zip(writes).filter(|(_, writes)| *writes);
    writers.try_for_each(|(process, _)| ranks.agree(process.print_output(model, system)))?;
    processes.iter_mut().try_for_each(|process| ranks.agree(process.after_output(model, system)))
}
