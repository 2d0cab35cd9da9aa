//! The run that a stage is part of.

use std::collections::BTreeMap;

use super::super::driver::Driver;
use super::super::report::RunReport;
use crate::assembly::System;
use crate::model::Model;
use crate::strategies::Monitor;

/// The systems of earlier stages by their root parts; their elements keep their states.
pub(in crate::analysis) type Systems = BTreeMap<String, System>;

/// Parts of a run that a stage reads and changes while it is prepared and steps.
pub(in crate::analysis) struct RunContext<'a> {
    /// Parts of earlier stages; the stage adds its own.
    pub model: &'a mut Model,
    /// Systems of earlier stages; the stage takes that of its root part.
    pub systems: &'a mut Systems,
    /// The report of the run.
    pub report: &'a mut RunReport,
    /// The log of the run.
    pub monitor: &'a mut dyn Monitor,
    /// The program that drives the run.
    pub driver: &'a mut dyn Driver,
}
