//! Output of the program while it runs: a line a step, a table of the iterations, a summary.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use zelus_core::analysis::RunReport;
use zelus_core::diagnostics::{Diagnostic, Severity};
use zelus_core::strategies::{IterationRecord, Monitor, Plan, StepRecord};

use super::log::Log;
use super::progress::Progress;
use super::say::{plural, say};
use super::warnings::Warnings;

/// How much is said, from little to much.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Level {
    /// Warnings and errors.
    Quiet,
    /// Steps and iterations, too.
    Usual,
    /// Also who solved how, which nodes changed their state, and where the time went.
    Verbose,
}

/// Prints plain lines, and on a terminal a line below them that tells how far the run has come.
pub(super) struct Terminal {
    level: Level,
    log: Option<Log>,
    bar: Option<ProgressBar>,
    progress: Progress,
    warnings: Warnings,
    begun: Instant,
    columns: usize,
}

impl Terminal {
    pub(super) fn new(level: Level, log: Option<Log>) -> Self {
        let shown = level > Level::Quiet && std::io::stderr().is_terminal();
        let bar = shown.then(|| {
            let style = ProgressStyle::with_template("{spinner} {msg} [{elapsed}]")
                .unwrap_or_else(|_| ProgressStyle::default_spinner());
            let bar = ProgressBar::new_spinner().with_style(style);
            bar.enable_steady_tick(Duration::from_millis(120));
            bar
        });
        let (progress, warnings) = (Progress::default(), Warnings::default());
        Self { level, log, bar, progress, warnings, begun: Instant::now(), columns: 0 }
    }

    /// Says a line of this level, which the log has in any case.
    fn line(&mut self, level: Level, text: &str) {
        self.log.iter_mut().for_each(|log| log.line(text));
        if level <= self.level {
            match &self.bar {
                Some(bar) => bar.suspend(|| say(text)),
                None => say(text),
            }
        }
    }

    fn update(&self) {
        self.bar.iter().for_each(|bar| bar.set_message(self.progress.line(self.begun.elapsed())));
    }

    /// The last lines: warnings once more, where results are, and how long it took; for a run that has `failed`, the error.
    pub(super) fn finish(&mut self, report: &RunReport, failed: Option<&str>) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
        for (phase, seconds) in &report.seconds {
            self.line(Level::Verbose, &format!("{phase}: {seconds:.3} s"));
        }
        self.warnings.lines().iter().for_each(|line| self.line(Level::Usual, line));
        for output in &report.outputs {
            self.line(Level::Usual, &format!("results: {}", output.display()));
        }
        if let Some(failed) = failed {
            self.log.iter_mut().for_each(|log| log.line(failed));
        } else if report.exit_code == 0 {
            let text = format!(
                "{} step{} converged in {} iteration{}, {:.2} s, {} unknowns, {} thread{}",
                report.converged_steps,
                plural(report.converged_steps),
                report.iterations,
                plural(report.iterations),
                self.begun.elapsed().as_secs_f64(),
                report.sizes.unknowns,
                report.threads,
                plural(report.threads)
            );
            self.line(Level::Usual, &text);
        }
    }
}

impl Monitor for Terminal {
    fn begin_stage(&mut self, plan: &Plan) {
        self.progress.begin_stage(*plan);
        self.update();
    }

    fn begin_step(&mut self, step: usize, time: f64, delta_time: f64) {
        self.columns = 0;
        self.progress.begin_step(step, time - delta_time, self.begun.elapsed());
        self.update();
        self.line(Level::Usual, &format!("step {step}, time {time:.6}, step length {delta_time:.3e}"));
    }

    fn phase(&mut self, phase: &'static str) {
        self.progress.phase(phase);
        self.update();
    }

    fn iteration(&mut self, record: &IterationRecord) {
        self.progress.end_iteration(record.iteration);
        self.update();
        if self.columns != record.checks.len() {
            self.columns = record.checks.len();
            let heads: Vec<String> = record
                .checks
                .iter()
                .map(|c| format!("{:>33}", format!("{} (tol {:.0e})", c.label, c.ratio_tolerance)))
                .collect();
            self.line(Level::Usual, &format!("   it {}  set changes", heads.join("")));
        }
        let cells: Vec<String> = record
            .checks
            .iter()
            .map(|c| format!("{:>31.3e} {}", c.ratio, if c.converged { "✓" } else { " " }))
            .collect();
        let changes = record.active_set_changes + record.stick_slip_changes;
        let condition = record.condition_number.map(|c| format!("   condition number {c:.3e}")).unwrap_or_default();
        self.line(Level::Usual, &format!("  {:>3} {}  {changes:>6}{condition}", record.iteration, cells.join("")));
        let IterationRecord { engine, linear_iterations, linear_residual, .. } = record;
        let solved = format!(
            "      {engine}: {linear_iterations} iteration{}, relative residual {linear_residual:.1e}",
            plural(*linear_iterations)
        );
        let nodes: Vec<String> = record.changed_nodes.iter().map(ToString::to_string).collect();
        let changed = if nodes.is_empty() {
            String::new()
        } else {
            format!("; changed: node{} {}", plural(nodes.len()), nodes.join(" "))
        };
        self.line(Level::Verbose, &format!("{solved}{changed}"));
    }

    fn end_step(&mut self, record: &StepRecord) {
        if record.converged {
            self.progress.end_step(record.time);
            self.update();
        }
        let short = |value: f64| if value.fract() == 0.0 { format!("{value}") } else { format!("{value:.3e}") };
        let numbers: Vec<String> =
            record.interactions.iter().map(|(name, value)| format!("{name} {}", short(*value))).collect();
        let state = match (record.converged, record.iterations.len()) {
            (true, 0) => "done".to_owned(),
            (true, count) => format!("converged in {count} iteration{}", plural(count)),
            (false, count) => format!("not converged in {count} iteration{}", plural(count)),
        };
        let extra = if numbers.is_empty() { String::new() } else { format!("; {}", numbers.join(", ")) };
        self.line(Level::Usual, &format!("  {state}{extra}"));
    }

    fn note(&mut self, text: &str) {
        self.line(Level::Usual, text);
    }

    fn warn(&mut self, warning: &Diagnostic) {
        self.warnings.push(warning);
        let level = if warning.severity == Severity::Warning { Level::Quiet } else { Level::Usual };
        self.line(level, &warning.to_string());
    }
}
