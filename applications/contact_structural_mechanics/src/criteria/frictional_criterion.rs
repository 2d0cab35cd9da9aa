//! Displacements and, of the multipliers, normal, sticking and sliding parts, each against tolerances of its own.
//!
//! The multiplier entries r of a node split into (r·n) n and the rest. The rest belongs to the sticking or the sliding
//! part by the state of the node; without friction or contact the whole node belongs to the normal part. Equations of
//! sliding nodes state tractions, and are measured by these besides.

use std::cell::LazyCell;

use zelus_core::Result;
use zelus_core::model::Owner;
use zelus_core::strategies::{
    Block, ConvergenceCheck, ConvergenceCriterion, CriterionRequest, Form, Measure, Measures, Tolerance, Verdict,
    is_last_digit, is_round_off,
};
use zelus_core::vector3::{dot, sub};
use zelus_structural_mechanics::variables::NORMAL;

use crate::mortar::tangential;
use crate::slave_nodes::SlaveStatus;
use crate::variables::MULTIPLIER_WEIGHT;

/// The criterion of the formulations with friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionalCriterion {
    primary: Measure,
    multiplier: Form,
    tolerances: [Tolerance; 3],
    /// Tangential measure, relative to the normal one, that counts as none.
    threshold: f64,
}

/// Parts of the multipliers: positions in arrays.
const PARTS: [&[&str; 2]; 3] = [
    &["normal multiplier residual", "normal multiplier increment"],
    &["stick residual", "stick increment"],
    &["slip residual", "slip increment"],
];

impl FrictionalCriterion {
    /// With the tolerances of the solver settings and of `contact_settings` for these forms.
    ///
    /// # Errors
    /// Settings that are not numbers.
    pub fn from_settings(request: &CriterionRequest<'_>, primary: Form, multiplier: Form) -> Result<Self> {
        let of =
            |stem: &str| Tolerance::read(request.settings, &format!("contact_settings.{stem}_{}", multiplier.word()));
        Ok(Self {
            primary: Measure::read(request.settings, primary, Block::Primary, primary.word())?,
            multiplier,
            tolerances: [of("contact")?, of("frictional_stick_contact")?, of("frictional_slip_contact")?],
            threshold: request.settings.get_f64("contact_settings.ratio_normal_tangent_threshold")?,
        })
    }
}

/// Sum of squares and number of entries of each part.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Sizes {
    squares: [f64; 3],
    counts: [usize; 3],
}

impl Sizes {
    fn norm(&self, part: usize) -> f64 {
        self.squares[part].sqrt()
    }

    fn add(&mut self, part: usize, vector: [f64; 3], entries: usize) {
        self.squares[part] += dot(vector, vector);
        self.counts[part] += entries;
    }
}

/// Splits the multiplier entries of a vector over all unknowns, slave node by slave node. Sizes of round-off, which have no sign,
/// count in full in all parts of a slave node.
fn split(measures: &Measures<'_>, vector: &[f64], signed: bool) -> Sizes {
    let slaves = measures.slave_nodes;
    let mut entries = vec![([0.0; 3], 0_usize); slaves.len()];
    let mut sizes = Sizes::default();
    for &unknown in measures.equations.unknowns() {
        let dof = &measures.dofs.dofs()[unknown as usize];
        match dof.owner {
            _ if !dof.multiplier => {}
            Owner::Slave(slave) => {
                let (values, count) = &mut entries[slave as usize];
                values[dof.variable.offset()] = vector[unknown as usize];
                *count += 1;
            }
            // Multipliers of others count with the normal ones.
            Owner::Node(_) => sizes.add(0, [vector[unknown as usize], 0.0, 0.0], 1),
        }
    }
    let normals = slaves.history.get(NORMAL.name());
    for (at, (values, count)) in entries.into_iter().enumerate().filter(|(_, (_, count))| *count > 0) {
        let part = match SlaveStatus::at(slaves, at) {
            SlaveStatus::Inactive => {
                sizes.add(0, values, count);
                continue;
            }
            SlaveStatus::Frictionless => 0,
            SlaveStatus::Stick => 1,
            SlaveStatus::Slip => 2,
        };
        let normal = normals.map_or([0.0; 3], |n| n.vector(0, at));
        let along = if signed { tangential(values, normal) } else { values };
        let across = if signed { sub(values, along) } else { values };
        sizes.add(0, across, 1);
        sizes.add(part, along, count - 1);
    }
    sizes
}

/// Size of the tractions between the bodies, as the equations of sliding slave nodes state them: tangential parts of those in
/// contact with friction, normal parts of those without.
fn tractions(measures: &Measures<'_>) -> Sizes {
    let slaves = measures.slave_nodes;
    let weights = slaves.history.values(&MULTIPLIER_WEIGHT, 0);
    let mut sizes = Sizes::default();
    for &unknown in measures.equations.unknowns() {
        let dof = &measures.dofs.dofs()[unknown as usize];
        let Owner::Slave(slave) = dof.owner else { continue };
        let at = slave as usize;
        let part = match SlaveStatus::at(slaves, at) {
            SlaveStatus::Inactive => continue,
            SlaveStatus::Frictionless => 0,
            SlaveStatus::Stick | SlaveStatus::Slip => 2,
        };
        if dof.multiplier {
            let size = weights.get(at).map_or(0.0, |weight| weight * measures.values[unknown as usize]);
            sizes.squares[part] += size * size;
        }
    }
    sizes
}

/// The sizes that a relative measure of residuals refers to. A node that has come to slide obeys another equation than at the start of
/// the step, so its residual when states last changed counts too. Where nodes slide, the present friction of the bodies counts: a drag
/// far beyond it begins with residuals that tell nothing of it.
fn references(measures: &Measures<'_>) -> [f64; 3] {
    let start = measures.references.iter().map(Vec::as_slice);
    let left: Vec<Sizes> = start.chain(measures.switched).map(|r| split(measures, r, true)).collect();
    let now = tractions(measures);
    std::array::from_fn(|part| match now.norm(part) {
        of_slip if part == 2 && of_slip > 0.0 => of_slip,
        of_now => left.iter().map(|sizes| sizes.norm(part)).fold(of_now, f64::max),
    })
}

impl ConvergenceCriterion for FrictionalCriterion {
    fn judge(&self, measures: &Measures<'_>) -> Verdict {
        let mut checks = vec![self.primary.check(measures)];
        if !measures.dofs.dofs().iter().any(|dof| dof.multiplier) {
            return Verdict::all(checks);
        }
        let (sizes, references) = match self.multiplier {
            Form::Residual => (split(measures, measures.residual, true), references(measures)),
            Form::Increment => {
                let values = split(measures, measures.values, true);
                (split(measures, measures.increment, true), std::array::from_fn(|part| values.norm(part)))
            }
        };
        let round_off = LazyCell::new(|| split(measures, &measures.round_off, false));
        let is_done = |part: usize, size: f64, reference: f64| match self.multiplier {
            Form::Residual => is_round_off(size, round_off.norm(part)),
            Form::Increment => is_last_digit(size, reference),
        };
        let normal = sizes.norm(0) / (sizes.counts[0].max(1) as f64).sqrt();
        for part in 0..3 {
            let size = sizes.norm(part);
            let absolute = size / (sizes.counts[part].max(1) as f64).sqrt();
            let reference = if references[part] > 0.0 { references[part] } else { size };
            let ratio = if size > 0.0 { size / reference } else { 0.0 };
            let tolerance = self.tolerances[part];
            let converged = tolerance.met(ratio, absolute)
                || (part > 0 && absolute <= self.threshold * normal)
                || is_done(part, size, reference);
            checks.push(ConvergenceCheck {
                label: PARTS[part][usize::from(self.multiplier == Form::Increment)],
                ratio,
                ratio_tolerance: tolerance.relative,
                absolute,
                absolute_tolerance: tolerance.absolute,
                converged,
            });
        }
        Verdict::all(checks)
    }

    fn residual_tolerance(&self) -> Option<f64> {
        self.primary.residual_tolerance()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::vector3::norm;

    #[test]
    fn parts_add_up() {
        let (n, r) = ([0.6, 0.8, 0.0], [1.0, -2.0, 0.0]);
        let t = tangential(r, n);
        let mut sizes = Sizes::default();
        sizes.add(0, sub(r, t), 1);
        sizes.add(2, t, 1);
        assert!((sizes.squares[0] + sizes.squares[2] - 5.0).abs() < 1e-14);
        assert!((sizes.norm(0) - 1.0).abs() < 1e-14 && (norm(t) - sizes.norm(2)).abs() < 1e-14);
        assert_eq!(sizes.counts, [1, 0, 1]);
    }
}
