//! Residual or increment of each block, against tolerances of its own.

use zelus_core::Result;
use zelus_core::register;
use zelus_core::strategies::{
    Block, ConvergenceCriterion, CriterionEntry, CriterionRequest, Form, Measure, Measures, Verdict, both, either,
};

use super::frictional_criterion::FrictionalCriterion;
use crate::pairs::{Formulation, find_formulation};

/// Displacements and multipliers, each in its form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactCriterion {
    primary: Measure,
    multiplier: Measure,
}

impl ContactCriterion {
    /// With the tolerances of the solver settings and of `contact_settings` for these forms.
    ///
    /// # Errors
    /// Settings that are not numbers.
    pub fn from_settings(request: &CriterionRequest<'_>, primary: Form, multiplier: Form) -> Result<Self> {
        let of_contact = format!("contact_settings.contact_{}", multiplier.word());
        let contact = request.settings.node().get("contact_settings").is_some();
        let stem = if contact { &of_contact } else { primary.word() };
        Ok(Self {
            primary: Measure::read(request.settings, primary, Block::Primary, primary.word())?,
            multiplier: Measure::read(request.settings, multiplier, Block::Multiplier, stem)?,
        })
    }
}

impl ConvergenceCriterion for ContactCriterion {
    fn judge(&self, measures: &Measures<'_>) -> Verdict {
        let mut checks = vec![self.primary.check(measures)];
        if measures.dofs.dofs().iter().any(|dof| dof.multiplier) {
            checks.push(self.multiplier.check(measures));
        }
        Verdict::all(checks)
    }

    fn residual_tolerance(&self) -> Option<f64> {
        self.primary.residual_tolerance()
    }
}

fn single(request: &CriterionRequest<'_>, primary: Form, multiplier: Form) -> Result<Box<dyn ConvergenceCriterion>> {
    let settings = request.settings;
    let decomposed = settings.node().get("contact_settings").is_some()
        && settings.get_bool("contact_settings.frictional_decomposed")?
        && find_formulation(settings.get_str("contact_settings.mortar_type")?).is_ok_and(Formulation::frictional);
    if decomposed {
        return Ok(Box::new(FrictionalCriterion::from_settings(request, primary, multiplier)?));
    }
    Ok(Box::new(ContactCriterion::from_settings(request, primary, multiplier)?))
}

register! { CriterionEntry "contact_residual_criterion",
    about: "residuals of displacements and of multipliers small",
    source: "formula of residual_criterion, of multipliers with the tolerances contact_residual_… of contact_settings",
    build: |request| single(request, Form::Residual, Form::Residual),
}
register! { CriterionEntry "contact_displacement_criterion",
    about: "increments of displacements and of multipliers small",
    source: "formula of displacement_criterion, of multipliers with the tolerances contact_displacement_… of contact_settings",
    build: |request| single(request, Form::Increment, Form::Increment),
}
register! { CriterionEntry "contact_mixed_criterion",
    about: "residual of displacements and increment of multipliers small",
    source: "formula of residual_criterion, of multipliers that of displacement_criterion with the tolerances contact_displacement_… of contact_settings",
    build: |request| single(request, Form::Residual, Form::Increment),
}
register! { CriterionEntry "contact_and_criterion",
    about: "both contact_residual_criterion and contact_displacement_criterion",
    source: "formulas of both criteria",
    build: |request| {
        Ok(both(single(request, Form::Residual, Form::Residual)?, single(request, Form::Increment, Form::Increment)?))
    },
}
register! { CriterionEntry "contact_or_criterion",
    about: "contact_residual_criterion or contact_displacement_criterion",
    source: "formulas of both criteria",
    build: |request| {
        Ok(either(single(request, Form::Residual, Form::Residual)?, single(request, Form::Increment, Form::Increment)?))
    },
}
