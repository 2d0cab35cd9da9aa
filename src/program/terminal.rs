//! What the program says while it runs: a line a step, a table of the iterations, a summary.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use zelus_core::analysis::RunReport;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::strategies::{IterationRecord, Monitor, StepRecord};

use super::say::say;

/// Prints plain lines, and on a terminal a spinner with the step under way.
pub(super) struct Terminal {
    spinner: Option<ProgressBar>,
    begun: Instant,
    columns: usize,
}

impl Terminal {
    pub(super) fn new() -> Self {
        let spinner = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("{spinner} {msg} [{elapsed}]")
                .unwrap_or_else(|_| ProgressStyle::default_spinner());
            let bar = ProgressBar::new_spinner().with_style(style);
            bar.enable_steady_tick(Duration::from_millis(120));
            bar
        });
        Self { spinner, begun: Instant::now(), columns: 0 }
    }

    fn line(&self, text: &str) {
        match &self.spinner {
            Some(bar) => bar.suspend(|| say(text)),
            None => say(text),
        }
    }

    /// The last lines: where results are, and how long it took.
    pub(super) fn finish(&mut self, report: &RunReport, done: bool) {
        if let Some(bar) = self.spinner.take() {
            bar.finish_and_clear();
        }
        for output in &report.outputs {
            say(&format!("results: {}", output.display()));
        }
        if done {
            let converged: Vec<&StepRecord> = report.steps.iter().filter(|s| s.converged).collect();
            let iterations: usize = converged.iter().map(|s| s.iterations.len()).sum();
            say(&format!(
                "{} steps converged in {iterations} iterations, {:.2} s, {} unknowns, {} thread{}",
                converged.len(),
                self.begun.elapsed().as_secs_f64(),
                report.sizes.unknowns,
                report.threads,
                if report.threads == 1 { "" } else { "s" }
            ));
        }
    }
}

impl Monitor for Terminal {
    fn begin_step(&mut self, step: usize, time: f64, delta_time: f64) {
        self.columns = 0;
        let text = format!("step {step}, time {time:.6}, step length {delta_time:.3e}");
        if let Some(bar) = &self.spinner {
            bar.set_message(text.clone());
        }
        self.line(&text);
    }

    fn iteration(&mut self, record: &IterationRecord) {
        if self.columns != record.checks.len() {
            self.columns = record.checks.len();
            let heads: Vec<String> = record
                .checks
                .iter()
                .map(|c| format!("{:>33}", format!("{} (tol {:.0e})", c.label, c.ratio_tolerance)))
                .collect();
            self.line(&format!("   it {}  set changes", heads.join("")));
        }
        let cells: Vec<String> = record
            .checks
            .iter()
            .map(|c| format!("{:>31.3e} {}", c.ratio, if c.converged { "✓" } else { " " }))
            .collect();
        let changes = record.active_set_changes + record.stick_slip_changes;
        let condition = record.condition_number.map(|c| format!("   condition number {c:.3e}")).unwrap_or_default();
        self.line(&format!("  {:>3} {}  {changes:>6}{condition}", record.iteration, cells.join("")));
    }

    fn end_step(&mut self, record: &StepRecord) {
        let short = |value: f64| if value.fract() == 0.0 { format!("{value}") } else { format!("{value:.3e}") };
        let numbers: Vec<String> =
            record.interactions.iter().map(|(name, value)| format!("{name} {}", short(*value))).collect();
        let state = match (record.converged, record.iterations.len()) {
            (true, 0) => "done".to_owned(),
            (true, count) => format!("converged in {count} iterations"),
            (false, count) => format!("not converged in {count} iterations"),
        };
        let extra = if numbers.is_empty() { String::new() } else { format!("; {}", numbers.join(", ")) };
        self.line(&format!("  {state}{extra}"));
    }

    fn note(&mut self, text: &str) {
        self.line(text);
    }

    fn warn(&mut self, warning: &Diagnostic) {
        self.line(&warning.to_string());
    }
}
