//! Residual or increment of each block, against tolerances of its own.

use zelus_core::Result;
use zelus_core::parameters::Settings;
use zelus_core::register;
use zelus_core::registry::Build;
use zelus_core::strategies::{
    Block, Check, ConvergenceCriterion, CriterionFactory, CriterionRequest, Measures, Verdict, both, either,
    is_round_off,
};

use super::frictional_criterion::FrictionalCriterion;
use crate::pairs::{Multiplier, find_family};

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

/// Displacements and multipliers, each in its form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactCriterion {
    primary: (Form, Tolerance),
    multiplier: (Form, Tolerance),
}

impl ContactCriterion {
    /// With the tolerances of the solver settings and of `contact_settings` for these forms.
    ///
    /// # Errors
    /// Settings that are not numbers.
    pub fn from_settings(request: &CriterionRequest<'_>, primary: Form, multiplier: Form) -> Result<Self> {
        let primary_tolerance = Tolerance::read(request.settings, primary.word())?;
        let contact = request.settings.node().get("contact_settings").is_some();
        let multiplier_tolerance = if contact {
            Tolerance::read(request.settings, &format!("contact_settings.contact_{}", multiplier.word()))?
        } else {
            primary_tolerance
        };
        Ok(Self { primary: (primary, primary_tolerance), multiplier: (multiplier, multiplier_tolerance) })
    }
}

impl ConvergenceCriterion for ContactCriterion {
    fn judge(&self, measures: &Measures<'_>) -> Verdict {
        let mut checks = vec![check(measures, Block::Primary, self.primary)];
        if measures.dofs.dofs().iter().any(|dof| dof.multiplier) {
            checks.push(check(measures, Block::Multiplier, self.multiplier));
        }
        Verdict::all(checks)
    }
}

/// The check of displacements.
pub(super) fn measure_primary(measures: &Measures<'_>, primary: (Form, Tolerance)) -> Check {
    check(measures, Block::Primary, primary)
}

fn check(measures: &Measures<'_>, block: Block, (form, tolerance): (Form, Tolerance)) -> Check {
    let (size, count, reference, done) = match form {
        Form::Residual => {
            let (residual, count) = measures.block(measures.residual, block);
            let (round_off, _) = measures.block(measures.round_off, block);
            let reference = measures.references.iter().map(|r| measures.block(r, block).0).fold(0.0, f64::max);
            (residual, count, reference, is_round_off(residual, round_off))
        }
        Form::Increment => {
            let (increment, count) = measures.block(measures.increment, block);
            let (total, _) = measures.block(measures.values, block);
            (increment, count, if total > 0.0 { total } else { increment }, false)
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

fn single(request: &CriterionRequest<'_>, primary: Form, multiplier: Form) -> Result<Box<dyn ConvergenceCriterion>> {
    let settings = request.settings;
    let decomposed = settings.node().get("contact_settings").is_some()
        && settings.get_bool("contact_settings.frictional_decomposed")?
        && find_family(settings.get_str("contact_settings.mortar_type")?)
            .is_ok_and(|family| family.frictional() && !matches!(family.multiplier, Multiplier::None));
    if decomposed {
        return Ok(Box::new(FrictionalCriterion::from_settings(request, primary, multiplier)?));
    }
    Ok(Box::new(ContactCriterion::from_settings(request, primary, multiplier)?))
}

register! { ConvergenceCriterion "contact_residual_criterion",
    about: "residuals of displacements and of multipliers small",
    build: Build::Factory(&((|request| single(request, Form::Residual, Form::Residual)) as CriterionFactory)),
}
register! { ConvergenceCriterion "contact_displacement_criterion",
    about: "increments of displacements and of multipliers small",
    build: Build::Factory(&((|request| single(request, Form::Increment, Form::Increment)) as CriterionFactory)),
}
register! { ConvergenceCriterion "contact_mixed_criterion",
    about: "residual of displacements and increment of multipliers small",
    build: Build::Factory(&((|request| single(request, Form::Residual, Form::Increment)) as CriterionFactory)),
}
register! { ConvergenceCriterion "contact_and_criterion",
    about: "both contact_residual_criterion and contact_displacement_criterion",
    build: Build::Factory(&((|request| {
        Ok(both(single(request, Form::Residual, Form::Residual)?, single(request, Form::Increment, Form::Increment)?))
    }) as CriterionFactory)),
}
register! { ConvergenceCriterion "contact_or_criterion",
    about: "contact_residual_criterion or contact_displacement_criterion",
    build: Build::Factory(&((|request| {
        Ok(either(single(request, Form::Residual, Form::Residual)?, single(request, Form::Increment, Form::Increment)?))
    }) as CriterionFactory)),
}
