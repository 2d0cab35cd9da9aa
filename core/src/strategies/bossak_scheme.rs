//! Bossak's scheme, of which Newmark's is the case without damping of the mass.
//!
//! M ((1 − α_m) a_{n+1} + α_m a_n) + C v_{n+1} + f_int(u_{n+1}) = f_ext, with Newmark's relations between u, v and a;
//! α_m in [−1/2, 0]. β = (1 − α_m)² β₀ and γ = 1/2 − α_m keep second order and damp high frequencies.

use super::scheme::{Scheme, SchemeFactory, SchemeRequest};
use crate::assembly::Inertia;
use crate::diagnostics::Result;
use crate::model::{
    ModelPart,
    variables::{ACCELERATION, DISPLACEMENT, VELOCITY},
};
use crate::register;
use crate::registry::Build;

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
        if !(-0.5..=0.0).contains(&alpha_m) {
            let fact = format!("\"damp_factor_m\" is {alpha_m}, it must lie in [-0.5, 0]");
            return Err(settings.error("damp_factor_m", "damp-factor", fact).into());
        }
        let beta = settings.get_f64("newmark_beta")?;
        if beta <= 0.0 {
            let fact = format!("\"newmark_beta\" is {beta}, an implicit scheme needs a positive one");
            return Err(settings.error("newmark_beta", "newmark-beta", fact).remedy("0.25 is the usual choice").into());
        }
        let rayleigh = [settings.get_f64("rayleigh_alpha")?, settings.get_f64("rayleigh_beta")?];
        Ok(Box::new(Self::new(alpha_m, beta, rayleigh)))
    }
}

impl Scheme for BossakScheme {
    fn prepare(&self, part: &mut ModelPart) {
        part.nodes.history.add(&VELOCITY);
        part.nodes.history.add(&ACCELERATION);
    }

    fn predict(&mut self, part: &mut ModelPart) -> Result<()> {
        let dt = part.info.delta_time;
        for dof in part.dofs.dofs() {
            let at = 3 * dof.node as usize + dof.variable.offset();
            if dof.variable.column == DISPLACEMENT.name() && !part.dofs.is_fixed(dof.variable, dof.node) {
                let old = |variable| part.nodes.history.values(variable, 1)[at];
                let guess = old(&DISPLACEMENT) + dt * old(&VELOCITY) + 0.5 * dt * dt * old(&ACCELERATION);
                part.nodes.history.values_mut(&DISPLACEMENT, 0)[at] = guess;
            }
        }
        Ok(())
    }

    fn update(&self, part: &mut ModelPart) {
        let dt = part.info.delta_time;
        let (beta, gamma) = (self.beta, self.gamma);
        let history = &mut part.nodes.history;
        let u = history.values(&DISPLACEMENT, 0).to_vec();
        let old = [history.values(&DISPLACEMENT, 1), history.values(&VELOCITY, 1), history.values(&ACCELERATION, 1)]
            .map(<[f64]>::to_vec);
        let [u_old, v_old, a_old] = &old;
        let a: Vec<f64> = (0..u.len())
            .map(|i| (u[i] - u_old[i]) / (beta * dt * dt) - v_old[i] / (beta * dt) - (0.5 / beta - 1.0) * a_old[i])
            .collect();
        let velocity = history.values_mut(&VELOCITY, 0);
        for i in 0..u.len() {
            velocity[i] = v_old[i] + dt * ((1.0 - gamma) * a_old[i] + gamma * a[i]);
        }
        history.values_mut(&ACCELERATION, 0).copy_from_slice(&a);
    }

    fn inertia(&self, part: &ModelPart) -> Option<Inertia> {
        let dt = part.info.delta_time;
        let history = &part.nodes.history;
        let gather = |values: &dyn Fn(usize) -> f64| -> Vec<f64> {
            part.dofs
                .dofs()
                .iter()
                .map(|dof| {
                    let displacement = dof.variable.column == DISPLACEMENT.name();
                    if displacement { values(3 * dof.node as usize + dof.variable.offset()) } else { 0.0 }
                })
                .collect()
        };
        let (a, a_old) = (history.values(&ACCELERATION, 0), history.values(&ACCELERATION, 1));
        let v = history.values(&VELOCITY, 0);
        Some(Inertia {
            mass_factor: (1.0 - self.alpha_m) / (self.beta * dt * dt),
            damping_factor: self.gamma / (self.beta * dt),
            alpha: self.rayleigh[0],
            beta: self.rayleigh[1],
            acceleration: gather(&|i| (1.0 - self.alpha_m) * a[i] + self.alpha_m * a_old[i]),
            velocity: gather(&|i| v[i]),
        })
    }
}

register! { Scheme "bossak",
    about: "Bossak's implicit scheme: second order, damps high frequencies by damp_factor_m",
    source: "Wood, Bossak, Zienkiewicz 1981",
    build: Build::Factory(&((|request| {
        BossakScheme::from_settings(request, request.settings.get_f64("damp_factor_m")?)
    }) as SchemeFactory)),
}
register! { Scheme "newmark",
    about: "Newmark's implicit scheme: Bossak's without damping of the mass",
    source: "Newmark 1959",
    build: Build::Factory(&((|request| BossakScheme::from_settings(request, 0.0)) as SchemeFactory)),
}
