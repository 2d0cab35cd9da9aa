//! Converged when the increment of the iteration is small.

use super::criterion::{Block, Check, ConvergenceCriterion, CriterionRequest, Measures, Verdict, is_last_digit};
use crate::diagnostics::Result;
use crate::register;
use crate::strategies::CriterionEntry;

/// ‖Δu‖ ≤ relative · ‖u‖, or ‖Δu‖ / √n ≤ absolute, over all unknowns that are solved for.
#[derive(Debug, Clone, Copy)]
pub struct DisplacementCriterion {
    /// Tolerance of the ratio.
    pub relative: f64,
    /// Tolerance of the root mean square of the increment.
    pub absolute: f64,
}

impl DisplacementCriterion {
    /// From `displacement_relative_tolerance` and `displacement_absolute_tolerance`.
    ///
    /// # Errors
    /// Settings that are not numbers.
    pub fn from_settings(request: &CriterionRequest<'_>) -> Result<Self> {
        Ok(Self {
            relative: request.settings.get_f64("displacement_relative_tolerance")?,
            absolute: request.settings.get_f64("displacement_absolute_tolerance")?,
        })
    }
}

impl ConvergenceCriterion for DisplacementCriterion {
    fn judge(&self, measures: &Measures<'_>) -> Verdict {
        let (increment, count) = measures.block(measures.increment, Block::All);
        let (total, _) = measures.block(measures.values, Block::All);
        let ratio = if increment == 0.0 { 0.0 } else { increment / if total > 0.0 { total } else { increment } };
        let absolute = increment / (count.max(1) as f64).sqrt();
        let converged = ratio <= self.relative || absolute <= self.absolute || is_last_digit(increment, total);
        Verdict::all(vec![Check {
            label: "displacement",
            ratio,
            ratio_tolerance: self.relative,
            absolute,
            absolute_tolerance: self.absolute,
            converged,
        }])
    }
}

register! { CriterionEntry "displacement_criterion",
    about: "increment of the iteration small, relative to the displacements or absolutely",
    source: "‖Δu‖/‖u‖ ≤ displacement_relative_tolerance or ‖Δu‖/√n ≤ displacement_absolute_tolerance",
    build: |request| Ok(Box::new(DisplacementCriterion::from_settings(request)?)),
}
