//! Converged when the increment of the iteration is small.

use super::criterion::CriterionEntry;
use super::measure::{Form, Measure};
use crate::register;

register! { CriterionEntry "displacement_criterion",
    aliases: &["solution_criterion"],
    about: "increment of the iteration small, relative to the unknowns or absolutely; each variable in its own units",
    source: "‖Δu‖/‖u‖ ≤ displacement_relative_tolerance or ‖Δu‖/√n ≤ displacement_absolute_tolerance",
    build: |request| Ok(Box::new(Measure::of_all(request.settings, Form::Increment)?)),
}
