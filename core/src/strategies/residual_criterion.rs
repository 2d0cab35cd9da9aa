//! Converged when the out-of-balance force is small.

use super::criterion::{
    Block, Check, ConvergenceCriterion, CriterionRequest, Measures, Verdict, both, either, is_round_off,
};
use super::displacement_criterion::DisplacementCriterion;
use crate::diagnostics::Result;
use crate::register;
use crate::strategies::CriterionEntry;

/// ‖r‖ ≤ relative · ‖r‖_reference, or ‖r‖ / n ≤ absolute, over all unknowns that are solved for.
///
/// The reference is the larger of the norms before and after the first solve of the step. The absolute measure divides
/// the norm by the number of unknowns, as Kratos does.
#[derive(Debug, Clone, Copy)]
pub struct ResidualCriterion {
    /// Tolerance of the ratio.
    pub relative: f64,
    /// Tolerance of the norm an unknown (force).
    pub absolute: f64,
}

impl ResidualCriterion {
    /// From `residual_relative_tolerance` and `residual_absolute_tolerance`.
    ///
    /// # Errors
    /// Settings that are not numbers.
    pub fn from_settings(request: &CriterionRequest<'_>) -> Result<Self> {
        Ok(Self {
            relative: request.settings.get_f64("residual_relative_tolerance")?,
            absolute: request.settings.get_f64("residual_absolute_tolerance")?,
        })
    }
}

impl ConvergenceCriterion for ResidualCriterion {
    fn judge(&self, measures: &Measures<'_>) -> Verdict {
        let (residual, count) = measures.block(measures.residual, Block::All);
        let (round_off, _) = measures.block(measures.round_off, Block::All);
        let reference = measures.references.iter().map(|r| measures.block(r, Block::All).0).fold(0.0, f64::max);
        let ratio = if reference > 0.0 { residual / reference } else { 0.0 };
        let absolute = residual / count.max(1) as f64;
        let converged = ratio <= self.relative || absolute <= self.absolute || is_round_off(residual, round_off);
        Verdict::all(vec![Check {
            label: "residual",
            ratio,
            ratio_tolerance: self.relative,
            absolute,
            absolute_tolerance: self.absolute,
            converged,
        }])
    }
}

register! { CriterionEntry "residual_criterion",
    about: "out-of-balance force small, relative to that at the start of the step or absolutely",
    source: "‖r‖/‖r₀‖ ≤ residual_relative_tolerance or ‖r‖/n ≤ residual_absolute_tolerance",
    build: |request| Ok(Box::new(ResidualCriterion::from_settings(request)?)),
}
register! { CriterionEntry "and_criterion",
    about: "both residual_criterion and displacement_criterion",
    build: |request| {
        Ok(both(
            Box::new(ResidualCriterion::from_settings(request)?),
            Box::new(DisplacementCriterion::from_settings(request)?),
        ))
    },
}
register! { CriterionEntry "or_criterion",
    about: "residual_criterion or displacement_criterion",
    build: |request| {
        Ok(either(
            Box::new(ResidualCriterion::from_settings(request)?),
            Box::new(DisplacementCriterion::from_settings(request)?),
        ))
    },
}
