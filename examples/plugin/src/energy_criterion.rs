//! Converged when the work of the out-of-balance force along the increment is small.
//!
//! |r · Δu| ≤ tolerance · |r₀ · u|, r₀ being the residual before the first solve of the step and u the total values.

use zelus_core::Result;
use zelus_core::analysis::{ExtensionDefinition, SolverExtensionEntry};
use zelus_core::register;
use zelus_core::strategies::{
    Block, ConvergenceCheck, ConvergenceCriterion, CriterionEntry, CriterionRequest, Measures, Verdict,
};

/// Defaults of the object `"energy_settings"` that a deck may write among its solver settings.
const DEFAULTS: &str = r#"// Settings of energy_criterion.
{
    "relative_tolerance": 1.0e-10 // of the work of the increment
}"#;

struct EnergyCriterion {
    tolerance: f64,
}

fn make(request: &mut CriterionRequest<'_>) -> Result<Box<dyn ConvergenceCriterion>> {
    let given = request.settings.node().get("energy_settings").is_some();
    let tolerance = if given { request.settings.get_f64("energy_settings.relative_tolerance")? } else { 1e-10 };
    Ok(Box::new(EnergyCriterion { tolerance }))
}

/// |Σ a_i b_i| over the unknowns that are solved for.
fn work(measures: &Measures<'_>, a: &[f64], b: &[f64]) -> f64 {
    measures.dot(a, b, Block::All).0.abs()
}

impl ConvergenceCriterion for EnergyCriterion {
    fn judge(&self, measures: &Measures<'_>) -> Verdict {
        let work_of_increment = work(measures, measures.residual, measures.increment);
        let reference = measures.references.first().map_or(0.0, |first| work(measures, first, measures.values));
        let ratio = if reference > 0.0 { work_of_increment / reference } else { work_of_increment };
        Verdict::all(vec![ConvergenceCheck {
            label: "energy",
            ratio,
            ratio_tolerance: self.tolerance,
            absolute: work_of_increment,
            absolute_tolerance: 0.0,
            converged: ratio <= self.tolerance,
        }])
    }
}

register! { CriterionEntry "energy_criterion",
    about: "work of the residual along the increment small, relative to that of the load",
    source: "|r·Δu| / |r₀·u| ≤ energy_settings.relative_tolerance",
    build: make,
}
register! { SolverExtensionEntry "energy_settings",
    about: "settings of energy_criterion",
    defaults: DEFAULTS,
    build: ExtensionDefinition {
        variables: |_| Ok(Vec::new()),
        marks: |_| Ok(Vec::new()),
        cutting: |_| Ok(None),
        values: |_| Ok(Vec::new()),
        ..ExtensionDefinition::NOTHING
    },
}
