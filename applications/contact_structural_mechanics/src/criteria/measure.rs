//! One block of unknowns measured against its tolerances, by its residual or by its increment.

use zelus_core::Result;
use zelus_core::parameters::Settings;
use zelus_core::strategies::{Block, Check, Measures, is_last_digit, is_round_off};

/// What of a block is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// ‖r‖ against the largest norm at the start of the step; absolutely, ‖r‖/√n.
    Residual,
    /// ‖Δx‖ against ‖x‖; absolutely, ‖Δx‖/√n.
    Increment,
}

impl Form {
    /// The word for it in the names of tolerances.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Residual => "residual",
            Self::Increment => "displacement",
        }
    }
}

/// A tolerance relative to a reference, and one of the root mean square.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tolerance {
    pub(super) relative: f64,
    pub(super) absolute: f64,
}

impl Tolerance {
    /// Reads `STEM_relative_tolerance` and `STEM_absolute_tolerance`.
    pub(super) fn read(settings: &Settings, stem: &str) -> Result<Self> {
        Ok(Self {
            relative: settings.get_f64(&format!("{stem}_relative_tolerance"))?,
            absolute: settings.get_f64(&format!("{stem}_absolute_tolerance"))?,
        })
    }

    /// Whether a measure is within one of the two.
    pub(super) fn met(self, ratio: f64, absolute: f64) -> bool {
        ratio <= self.relative || absolute <= self.absolute
    }
}

/// The check of a block in its form.
pub(super) fn check(measures: &Measures<'_>, block: Block, (form, tolerance): (Form, Tolerance)) -> Check {
    let (size, count, reference, done) = match form {
        Form::Residual => {
            let (residual, count) = measures.block(measures.residual, block);
            let (round_off, _) = measures.block(measures.round_off, block);
            let of_start = measures.references.iter().map(|r| measures.block(r, block).0).fold(0.0, f64::max);
            // Equations that nothing acted in at the start refer to what the last change of state left of them.
            let of_switch = measures.switched.map_or(0.0, |r| measures.block(r, block).0);
            let reference = [of_start, of_switch, residual].into_iter().find(|size| *size > 0.0).unwrap_or(0.0);
            (residual, count, reference, is_round_off(residual, round_off))
        }
        Form::Increment => {
            let (increment, count) = measures.block(measures.increment, block);
            let (total, _) = measures.block(measures.values, block);
            (increment, count, if total > 0.0 { total } else { increment }, is_last_digit(increment, total))
        }
    };
    let ratio = if size > 0.0 && reference > 0.0 { size / reference } else { 0.0 };
    let absolute = size / (count.max(1) as f64).sqrt();
    Check {
        label: match (block, form) {
            (Block::Multiplier, Form::Residual) => "multiplier residual",
            (Block::Multiplier, Form::Increment) => "multiplier increment",
            (_, Form::Residual) => "residual",
            (_, Form::Increment) => "increment",
        },
        ratio,
        ratio_tolerance: tolerance.relative,
        absolute,
        absolute_tolerance: tolerance.absolute,
        converged: done || tolerance.met(ratio, absolute),
    }
}
