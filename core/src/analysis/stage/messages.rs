//! Notes and warnings of a stage, on their way to log and report.

use super::super::report::RunReport;
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Severity};
use crate::processes::Process;
use crate::strategies::Monitor;

/// Notes and warnings of processes and interactions.
pub(super) fn messages_of(processes: &mut [Box<dyn Process>], system: &mut System) -> Vec<Diagnostic> {
    let of_processes = processes.iter_mut().flat_map(|process| process.messages());
    of_processes.chain(system.interactions.iter_mut().flat_map(|interaction| interaction.messages())).collect()
}

/// Hands notes and warnings to the monitor and the report.
pub(super) fn tell(messages: Vec<Diagnostic>, report: &mut RunReport, monitor: &mut dyn Monitor) {
    for message in messages {
        let list = if message.severity == Severity::Note { &mut report.notes } else { &mut report.warnings };
        list.push(message.to_string());
        monitor.warn(&message);
    }
}
