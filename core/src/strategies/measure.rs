//! A block of unknowns measured against its tolerances, each variable in its own units.

use std::cell::LazyCell;

use super::criterion::{
    Block, ConvergenceCheck, ConvergenceCriterion, Measures, Norm, Verdict, is_last_digit, is_round_off,
};
use crate::diagnostics::Result;
use crate::parameters::Settings;

/// Measured quantity of the unknowns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// ‖r‖ against the largest norm before and after the first solve of the step.
    Residual,
    /// ‖Δx‖ against ‖x‖.
    Increment,
}

impl Form {
    /// The word for it in the names of tolerances.
    pub fn word(self) -> &'static str {
        match self {
            Self::Residual => "residual",
            Self::Increment => "displacement",
        }
    }
}

/// A tolerance relative to a reference, and one of the norm an unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Tolerance of the ratio.
    pub relative: f64,
    /// Tolerance of the norm an unknown, in the unit of the variable.
    pub absolute: f64,
}

impl Tolerance {
    /// Reads `STEM_relative_tolerance` and `STEM_absolute_tolerance`.
    ///
    /// # Errors
    /// Settings that are not numbers.
    pub fn read(settings: &Settings, stem: &str) -> Result<Self> {
        Ok(Self {
            relative: settings.get_f64(&format!("{stem}_relative_tolerance"))?,
            absolute: settings.get_f64(&format!("{stem}_absolute_tolerance"))?,
        })
    }

    /// Whether a measure is within one of the two.
    pub fn met(self, ratio: f64, absolute: f64) -> bool {
        ratio <= self.relative || absolute <= self.absolute
    }
}

/// A measure of a block of unknowns: the worst of those of its variables.
///
/// Forces, volumetric strains, gaps and temperatures have no common unit: a sum of their squares would depend on the units
/// of the deck, and hide the smaller numbers. Kratos sums them (`criterion_sums_variables`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// Measured quantity.
    pub form: Form,
    /// Unknowns that are measured.
    pub block: Block,
    /// Tolerances to compare with.
    pub tolerance: Tolerance,
    /// Whether each variable is measured by itself.
    pub apart: bool,
}

impl Measure {
    /// With the tolerances that begin with `stem`, and as `criterion_sums_variables` says.
    ///
    /// # Errors
    /// Settings of another type.
    pub fn read(settings: &Settings, form: Form, block: Block, stem: &str) -> Result<Self> {
        let sums = settings.node().get("criterion_sums_variables").map(|node| node.bool()).transpose()?;
        Ok(Self { form, block, tolerance: Tolerance::read(settings, stem)?, apart: !sums.unwrap_or(false) })
    }

    /// Measure of all unknowns, with the tolerances of the solver settings.
    ///
    /// # Errors
    /// Settings of another type.
    pub fn of_all(settings: &Settings, form: Form) -> Result<Self> {
        // Heat has no displacements: its increments have tolerances of another name.
        let is_other = form == Form::Increment && settings.node().get("solution_relative_tolerance").is_some();
        Self::read(settings, form, Block::All, if is_other { "solution" } else { form.word() })
    }

    /// Measures, and says whether that is good enough; collective.
    pub fn check(&self, measures: &Measures<'_>) -> ConvergenceCheck {
        let norms = |vector: &[f64]| measures.norms(vector, self.block, self.apart);
        let residuals = norms(measures.residual);
        let round_offs = LazyCell::new(|| norms(&measures.round_off));
        let is_balanced = |kind: usize| is_round_off(residuals[kind].size, round_offs[kind].size);
        let mut checks = match self.form {
            Form::Residual => {
                let starts: Vec<Vec<Norm>> = measures.references.iter().map(|start| norms(start)).collect();
                let switched = measures.switched.map(norms);
                let check = |(kind, norm): (usize, &Norm)| {
                    let of_start = starts.iter().map(|start| start[kind].size).fold(0.0, f64::max);
                    // Equations without action at the start refer to their residual after the last change of state.
                    let of_switch = switched.as_ref().map_or(0.0, |left| left[kind].size);
                    let reference = [of_start, of_switch, norm.size].into_iter().find(|size| *size > 0.0);
                    self.of_variable(*norm, reference.unwrap_or(0.0), || is_balanced(kind))
                };
                residuals.iter().enumerate().map(check).collect::<Vec<_>>()
            }
            Form::Increment => {
                let totals = norms(measures.values);
                let check = |(norm, total): (Norm, &Norm)| {
                    let reference = if total.size > 0.0 { total.size } else { norm.size };
                    self.of_variable(norm, reference, || is_last_digit(norm.size, total.size))
                };
                let mut checks: Vec<ConvergenceCheck> =
                    norms(measures.increment).into_iter().zip(&totals).map(check).collect();
                // An unknown that is zero but for round-off moves by as much as its value: it does not hold up other variables.
                if checks.iter().any(|check| check.converged) {
                    for (kind, check) in checks.iter_mut().enumerate() {
                        check.converged = check.converged || is_balanced(kind);
                    }
                }
                checks
            }
        };
        // The ratio of a variable at round-off says nothing: one within its tolerance stands for both.
        let is_met = |check: &ConvergenceCheck| self.tolerance.met(check.ratio, check.absolute);
        let worse = |a: &ConvergenceCheck, b: &ConvergenceCheck| {
            let order = b.converged.cmp(&a.converged).then(is_met(a).cmp(&is_met(b)));
            order.then(a.ratio.total_cmp(&b.ratio))
        };
        checks.sort_by(worse);
        checks.pop().unwrap_or_else(|| self.of_variable(Norm::default(), 0.0, || true))
    }

    /// One variable: its norm against `reference`; `done` says whether it can become no smaller.
    fn of_variable(&self, norm: Norm, reference: f64, done: impl FnOnce() -> bool) -> ConvergenceCheck {
        let ratio = if norm.size > 0.0 && reference > 0.0 { norm.size / reference } else { 0.0 };
        let count = norm.count.max(1) as f64;
        // As Kratos divides: residuals of all unknowns by their number, all else by its root.
        let absolute =
            norm.size / if (self.block, self.form) == (Block::All, Form::Residual) { count } else { count.sqrt() };
        ConvergenceCheck {
            label: match (self.block, self.form) {
                (Block::Multiplier, Form::Residual) => "multiplier residual",
                (Block::Multiplier, Form::Increment) => "multiplier increment",
                (_, Form::Residual) => "residual",
                (Block::All, Form::Increment) => "displacement",
                (Block::Primary, Form::Increment) => "increment",
            },
            ratio,
            ratio_tolerance: self.tolerance.relative,
            absolute,
            absolute_tolerance: self.tolerance.absolute,
            converged: self.tolerance.met(ratio, absolute) || done(),
        }
    }
}

impl ConvergenceCriterion for Measure {
    fn judge(&self, measures: &Measures<'_>) -> Verdict {
        Verdict::all(vec![self.check(measures)])
    }

    fn residual_tolerance(&self) -> Option<f64> {
        (self.form == Form::Residual).then_some(self.tolerance.relative)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{DofTable, Equations};
    use crate::model::test_variables::{DISPLACEMENT, VELOCITY};
    use crate::model::{DofOwners, ModelPart, Nodes};

    /// Measures two variables at two nodes each, the second in a unit in which its numbers are `unit` times as large.
    fn check(form: Form, apart: bool, unit: f64, [start, now, moved]: [[f64; 2]; 3]) -> ConvergenceCheck {
        let mut part = ModelPart::new("Structure");
        part.nodes = Nodes::new(vec![1, 2], vec![[0.0; 3], [1.0, 0.0, 0.0]]);
        let mut dofs = DofTable::default();
        let carriers = [DISPLACEMENT.component(0), VELOCITY.component(0)];
        dofs.number(&part, &carriers.map(|variable| DofOwners::of_nodes(variable, vec![0, 1])), &[]);
        let equations = Equations::new(&dofs, &part).unwrap();
        let of = |[one, other]: [f64; 2]| vec![one, unit * other, one, unit * other];
        let tolerance = Tolerance { relative: 1e-4, absolute: 0.0 };
        Measure { form, block: Block::All, tolerance, apart }.check(&Measures {
            iteration: 2,
            nodes: &part.nodes,
            slave_nodes: &part.slave_nodes,
            dofs: &dofs,
            equations: &equations,
            distribution: None,
            residual: &of(now),
            references: &[of(start)],
            switched: None,
            increment: &of(moved),
            values: &of([1.0, 1e-17]),
            round_off: LazyCell::new(Box::new(|| of([1e-16, 1e-16]))),
        })
    }

    /// The second variable has a residual of round-off alone, 0.8 of which says nothing.
    #[test]
    fn the_ratio_shown_is_of_a_variable_with_a_tolerance_to_meet() {
        let numbers = [[1.0, 1e-17], [1e-5, 0.8e-17], [0.0; 2]];
        let shown = check(Form::Residual, true, 1.0, numbers);
        assert!(shown.converged && (shown.ratio - 1e-5).abs() < 1e-12, "{shown:?}");
    }

    const UNITS: [f64; 5] = [1e-12, 1e-6, 1.0, 1e6, 1e12];

    #[test]
    fn units_of_one_variable_change_no_verdict() {
        let half = [[1.0, 1.0], [0.5, 1e-9], [0.0; 2]];
        let both = [[1.0, 1.0], [1e-5, 1e-6], [0.0; 2]];
        let checks = |numbers| UNITS.map(|unit| check(Form::Residual, true, unit, numbers));
        assert!(checks(half).iter().all(|check| !check.converged && (check.ratio - 0.5).abs() < 1e-12));
        assert!(checks(both).iter().all(|check| check.converged && (check.ratio - 1e-5).abs() < 1e-12));
        // In one sum large numbers hide the small ones.
        let summed = UNITS.map(|unit| check(Form::Residual, false, unit, half).converged);
        assert_eq!(summed, [false, false, false, true, true]);
    }

    #[test]
    fn a_variable_that_is_zero_but_for_round_off_holds_up_none() {
        let numbers = |moved: f64, left: f64| [[1.0, 0.0], [1e-17, left], [moved, 1e-17]];
        let converged = |numbers| UNITS.map(|unit| check(Form::Increment, true, unit, numbers).converged);
        assert_eq!(converged(numbers(1e-5, 1e-16)), [true; 5]);
        assert_eq!(converged(numbers(1e-2, 1e-16)), [false; 5], "the other still moves");
        assert_eq!(converged(numbers(1e-5, 1e-9)), [false; 5], "it is out of balance");
    }
}
