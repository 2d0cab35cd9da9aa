//! Converged when the out-of-balance force is small.

use super::criterion::{CriterionEntry, both, either};
use super::measure::{Form, Measure};
use crate::register;

register! { CriterionEntry "residual_criterion",
    about: "out-of-balance force small, relative to that at the start of the step or absolutely; each variable in its own units",
    source: "‖r‖/‖r₀‖ ≤ residual_relative_tolerance or ‖r‖/n ≤ residual_absolute_tolerance",
    build: |request| Ok(Box::new(Measure::of_all(request.settings, Form::Residual)?)),
}
register! { CriterionEntry "and_criterion",
    about: "both residual_criterion and displacement_criterion",
    source: "formulas of both criteria",
    build: |request| {
        let [residual, increment] = [Form::Residual, Form::Increment].map(|form| Measure::of_all(request.settings, form));
        Ok(both(Box::new(residual?), Box::new(increment?)))
    },
}
register! { CriterionEntry "or_criterion",
    about: "residual_criterion or displacement_criterion",
    source: "formulas of both criteria",
    build: |request| {
        let [residual, increment] = [Form::Residual, Form::Increment].map(|form| Measure::of_all(request.settings, form));
        Ok(either(Box::new(residual?), Box::new(increment?)))
    },
}
