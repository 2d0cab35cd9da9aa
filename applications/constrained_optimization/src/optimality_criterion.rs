//! Converged when the residual is small and every constraint is obeyed: a method that stalls elsewhere is not accepted.

use zelus_core::register;
use zelus_core::strategies::{
    ConvergenceCheck, ConvergenceCriterion, CriterionEntry, Form, Measure, Measures, Verdict, both,
};

use crate::variables::CONSTRAINT_VIOLATION;

/// max(−g, λ of those that act) ≤ tolerance over all constraints.
struct Feasibility {
    tolerance: f64,
}

impl ConvergenceCriterion for Feasibility {
    fn judge(&self, measures: &Measures<'_>) -> Verdict {
        let violation = measures.nodes.values.values(&CONSTRAINT_VIOLATION, 0).iter().fold(0.0_f64, |m, v| m.max(*v));
        Verdict::all(vec![ConvergenceCheck {
            label: "violation",
            ratio: violation,
            ratio_tolerance: self.tolerance,
            absolute: violation,
            absolute_tolerance: self.tolerance,
            converged: violation <= self.tolerance,
        }])
    }
}

register! { CriterionEntry "optimality_criterion",
    about: "residual_criterion, and no constraint violated by more than feasibility_tolerance",
    source: "g ≥ 0, λ ≤ 0 (eqs. D.3a, D.5d)",
    build: |request| {
        let tolerance = request.settings.get_f64("feasibility_tolerance")?;
        Ok(both(Box::new(Measure::of_all(request.settings, Form::Residual)?), Box::new(Feasibility { tolerance })))
    },
}
