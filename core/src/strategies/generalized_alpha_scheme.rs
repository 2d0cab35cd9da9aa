//! The generalised-α scheme: second order, with a chosen spectral radius ρ∞ at infinite frequency.
//!
//! M a_α + C v_α = (1 − α_f) F_{n+1} + α_f F_n with a_α = (1 − α_m) a_{n+1} + α_m a_n, v_α = (1 − α_f) v_{n+1} + α_f v_n and F all
//! forces but those of inertia and damping, reactions included. α_m = (2ρ − 1)/(ρ + 1), α_f = ρ/(ρ + 1), and Newmark's relations hold
//! with γ = 1/2 − α_m + α_f, β = (1 − α_m + α_f)²/4. The code divides by 1 − α_f, so that the residual, its tangent and the reactions
//! are those of t_{n+1}. F_n is the force of inertia and damping in step n.

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use super::scheme::{Scheme, SchemeEntry, SchemeFactory, SchemeRequest, predict_ballistic, update_newmark};
use crate::assembly::{DofTable, Inertia};
use crate::diagnostics::Result;
use crate::model::{FIRST, ModelPart, Rates, SECOND};
use crate::register;

/// Parameters of the scheme and the forces of the last accepted step.
#[derive(Debug, Clone, PartialEq)]
pub struct GeneralizedAlphaScheme {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
    rayleigh: [f64; 2],
    forces: Option<Vec<f64>>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct GeneralizedAlphaState {
    forces: Option<Vec<f64>>,
}

stored_as_bytes!(GeneralizedAlphaState);

#[typetag::serde(name = "generalized_alpha")]
impl State for GeneralizedAlphaState {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.forces.iter_mut().for_each(|forces| mapper.by_unknown(forces));
    }
}

impl GeneralizedAlphaScheme {
    /// The scheme with spectral radius `rho` in [0, 1] at infinite frequency.
    pub fn new(rho: f64, rayleigh: [f64; 2]) -> Self {
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let beta = 0.25 * (1.0 - alpha_m + alpha_f).powi(2);
        Self { alpha_m, alpha_f, beta, gamma: 0.5 - alpha_m + alpha_f, rayleigh, forces: None }
    }

    fn from_settings(request: &SchemeRequest<'_>) -> Result<Box<dyn Scheme>> {
        Ok(Box::new(Self::new(request.settings.get_f64("rho_inf")?, request.rayleigh()?)))
    }
}

impl Scheme for GeneralizedAlphaScheme {
    fn prepare(&self, part: &mut ModelPart) {
        Rates::add(&mut part.nodes.history, &[FIRST, SECOND]);
    }

    fn predict(&mut self, part: &mut ModelPart, dofs: &DofTable) -> Result<()> {
        predict_ballistic(part, dofs);
        Ok(())
    }

    fn update(&self, part: &mut ModelPart) {
        update_newmark(part, self.beta, self.gamma);
    }

    fn inertia(&self, part: &ModelPart, dofs: &DofTable) -> Option<Inertia> {
        let dt = part.info.delta_time;
        let [a, a_old] = [0, 1].map(|level| dofs.column(part, SECOND, level));
        let [v, v_old] = [0, 1].map(|level| dofs.column(part, FIRST, level));
        let (m, f) = (self.alpha_m, self.alpha_f);
        let scale = 1.0 / (1.0 - f);
        Some(Inertia {
            mass_factor: scale * (1.0 - m) / (self.beta * dt * dt),
            damping_factor: self.gamma / (self.beta * dt),
            alpha: self.rayleigh[0],
            beta: self.rayleigh[1],
            acceleration: a.iter().zip(&a_old).map(|(a, old)| scale * ((1.0 - m) * a + m * old)).collect(),
            velocity: v.iter().zip(&v_old).map(|(v, old)| v + scale * f * old).collect(),
            carried: self.forces.iter().flatten().map(|force| scale * f * force).collect(),
        })
    }

    fn past_inertia(&self, part: &ModelPart, dofs: &DofTable) -> Option<Inertia> {
        let old = |column| dofs.column(part, column, 1);
        let [alpha, beta] = self.rayleigh;
        self.forces.is_none().then(|| Inertia {
            alpha,
            beta,
            acceleration: old(SECOND),
            velocity: old(FIRST),
            ..Inertia::default()
        })
    }

    fn keeps_forces(&self) -> bool {
        true
    }

    fn keep(&mut self, forces: Vec<f64>) {
        self.forces = Some(forces);
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(GeneralizedAlphaState { forces: self.forces.clone() }))
    }

    fn resume(&mut self, state: Box<dyn State>) -> Result<()> {
        self.forces = state.take::<GeneralizedAlphaState>()?.forces;
        Ok(())
    }

    fn kept(&mut self) -> Option<&mut Vec<f64>> {
        self.forces.as_mut()
    }
}

register! { SchemeEntry "generalized_alpha",
    aliases: &["generalized-alpha", "generalised_alpha"],
    about: "generalised-α: second order, damps high frequencies by rho_inf, keeps low ones",
    source: "Chung, Hulbert 1993",
    build: SchemeFactory::Implicit(GeneralizedAlphaScheme::from_settings),
}
