//! Mass scaling of explicit steps: mass added where elements would shorten the step, and its share.

use serde::{Deserialize, Serialize};

use super::body_in_words;
use super::critical_step::largest_square;
use crate::assembly::{Assembler, ScaledMass, System};
use crate::diagnostics::{Diagnostic, Result};
use crate::model::{ModelPart, NumberedBodies};

/// Share of the mass, of the model or of a body, above which added mass is warned of.
const WORTH_A_WARNING: f64 = 0.05;

/// Mass that elements have got, and its share.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct MassScaling {
    /// Lumped mass added, a number an unknown.
    pub added: Vec<f64>,
    /// Added mass by that of the model without it.
    pub share: f64,
    /// The largest such share of a body.
    pub largest_of_body: f64,
}

impl MassScaling {
    /// No mass for so many unknowns.
    pub fn none(unknowns: usize) -> Self {
        Self { added: vec![0.0; unknowns], ..Self::default() }
    }

    /// Mass by which the `critical` step of every element becomes that long, of a model of `mass` (a number an unknown); with a note
    /// or a warning. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn of(
        part: &ModelPart,
        system: &System,
        assembler: &Assembler,
        mass: &[f64],
        critical: f64,
        rayleigh: [f64; 2],
    ) -> Result<(Self, Option<Diagnostic>)> {
        let Some(square) = largest_square(critical, rayleigh) else {
            let fact = format!("damping alone makes steps of {critical:.3e} unstable: mass scaling cannot reach them");
            let remedy = "lower \"rayleigh_alpha\", or \"mass_scaling_time_step\"";
            return Err(Diagnostic::error("mass-scaling", fact).remedy(remedy).into());
        };
        let ScaledMass { added, elements, largest_factor } = assembler.scale_mass(part, system, square)?;
        let bodies = NumberedBodies::of(part);
        // Added and whole mass of each body, then of nodes without elements; components of a node have the same mass.
        let mut sums = vec![[0.0; 2]; bodies.first.len() + 1];
        for n in (0..mass.len()).filter(|&n| assembler.counts(n)) {
            let body = bodies.of_node[system.dofs.dofs()[n].node as usize].unwrap_or(bodies.first.len());
            sums[body][0] += added[n];
            sums[body][1] += mass[n];
        }
        part.ranks.sum(sums.as_flattened_mut());
        let ratio = |[added, mass]: [f64; 2]| if mass > 0.0 { added / mass } else { 0.0 };
        let share = ratio(sums.iter().fold([0.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]));
        let of_bodies = sums[..bodies.first.len()].iter().enumerate().map(|(body, own)| (body, ratio(*own)));
        let largest = of_bodies.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        let largest_of_body = largest.map_or(0.0, |(_, share)| share);
        let out = Self { added, share, largest_of_body };
        if elements == 0 {
            return Ok((out, None));
        }
        let mut fact = format!(
            "{elements} element{} of a critical step below {critical:.3e} got up to {largest_factor:.3} times their mass: {:.3} % of \
             the mass of the model added",
            if elements == 1 { "" } else { "s" },
            100.0 * share
        );
        if let Some((body, of_body)) = largest.filter(|_| bodies.first.len() > 1) {
            let name = part.ranks.first_to_say(body_in_words(part, bodies.first[body])).unwrap_or_default();
            fact += &format!(", and {:.3} % of that of {name}", 100.0 * of_body);
        }
        let said = if share.max(largest_of_body) > WORTH_A_WARNING {
            let remedy = "inertia of the motion is that much too large: lower \"mass_scaling_time_step\", or make the small elements \
                          larger";
            Diagnostic::warning("mass-scaling", fact).remedy(remedy)
        } else {
            Diagnostic::note("mass-scaling", fact)
        };
        Ok((out, Some(said)))
    }
}
