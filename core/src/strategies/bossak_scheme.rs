//! Bossak's scheme, of which Newmark's is the case without damping of the mass.
//!
//! M ((1 − α_m) a_{n+1} + α_m a_n) + C v_{n+1} + f_int(u_{n+1}) = f_ext, with Newmark's relations between u, v and a;
//! α_m in [−1/2, 0]. β = (1 − α_m)² β₀ and γ = 1/2 − α_m keep second order and damp high frequencies.

use super::scheme::{Scheme, SchemeEntry, SchemeFactory, SchemeRequest, predict_ballistic, update_newmark};
use crate::assembly::{DofTable, Inertia};
use crate::diagnostics::Result;
use crate::model::{FIRST, ModelPart, Rates, SECOND};
use crate::register;

/// Parameters of the scheme and of Rayleigh's damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BossakScheme {
    alpha_m: f64,
    beta: f64,
    gamma: f64,
    rayleigh: [f64; 2],
}

impl BossakScheme {
    /// The scheme with Bossak's `alpha_m` and Newmark's `beta` before its correction.
    pub fn new(alpha_m: f64, newmark_beta: f64, rayleigh: [f64; 2]) -> Self {
        Self { alpha_m, beta: (1.0 - alpha_m).powi(2) * newmark_beta, gamma: 0.5 - alpha_m, rayleigh }
    }

    fn from_settings(request: &SchemeRequest<'_>, alpha_m: f64) -> Result<Box<dyn Scheme>> {
        let settings = request.settings;
        let beta = settings.get_f64("newmark_beta")?;
        if beta <= 0.0 {
            let fact = format!("\"newmark_beta\" is {beta}, an implicit scheme needs a positive one");
            return Err(settings.error("newmark_beta", "newmark-beta", fact).remedy("0.25 is the usual choice").into());
        }
        Ok(Box::new(Self::new(alpha_m, beta, request.rayleigh()?)))
    }
}

impl Scheme for BossakScheme {
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
        Some(Inertia {
            mass_factor: (1.0 - self.alpha_m) / (self.beta * dt * dt),
            damping_factor: self.gamma / (self.beta * dt),
            alpha: self.rayleigh[0],
            beta: self.rayleigh[1],
            acceleration: a.iter().zip(&a_old).map(|(a, old)| (1.0 - self.alpha_m) * a + self.alpha_m * old).collect(),
            velocity: dofs.column(part, FIRST, 0),
            carried: Vec::new(),
        })
    }
}

register! { SchemeEntry "bossak",
    about: "Bossak's implicit scheme: second order, damps high frequencies by damp_factor_m",
    source: "Wood, Bossak, Zienkiewicz 1981",
    build: SchemeFactory::Implicit(|request| {
        BossakScheme::from_settings(request, request.settings.get_f64("damp_factor_m")?)
    }),
}
register! { SchemeEntry "newmark",
    about: "Newmark's implicit scheme: Bossak's without damping of the mass",
    source: "Newmark 1959",
    build: SchemeFactory::Implicit(|request| BossakScheme::from_settings(request, 0.0)),
}
