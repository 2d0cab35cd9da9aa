//! Motion without inertia, slowed by Rayleigh's damping alone.
//!
//! C v_{n+1} + f_int(u_{n+1}) = f_ext with C = α M + β K, and the trapezoidal rule u_{n+1} = u_n + Δt/2 (v_n + v_{n+1}): of
//! second order where the first velocity is in balance. Without damping every step is a state of equilibrium.
//! A second derivative is the change of the first over the step and enters no equation.

use super::scheme::{Scheme, SchemeEntry, SchemeFactory, SchemeRequest, predict};
use crate::assembly::{DofTable, Inertia};
use crate::diagnostics::Result;
use crate::model::{FIRST, ModelPart, Rates, SECOND, UNKNOWN};
use crate::register;

/// Rayleigh's factors of mass (1/time) and stiffness (time).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PseudoStaticScheme {
    rayleigh: [f64; 2],
}

impl PseudoStaticScheme {
    /// The scheme with these factors.
    pub fn new(rayleigh: [f64; 2]) -> Self {
        Self { rayleigh }
    }

    fn from_settings(request: &SchemeRequest<'_>) -> Result<Box<dyn Scheme>> {
        Ok(Box::new(Self::new(request.rayleigh()?)))
    }
}

impl Scheme for PseudoStaticScheme {
    fn has_inertia(&self) -> bool {
        false
    }

    fn takes_first_order(&self) -> bool {
        true
    }

    fn prepare(&self, part: &mut ModelPart) {
        Rates::add(&mut part.nodes.history, &[FIRST, SECOND]);
    }

    /// Free unknowns go on with the rate of the last step.
    fn predict(&mut self, part: &mut ModelPart, dofs: &DofTable) -> Result<()> {
        let dt = part.info.delta_time;
        let [u, v] = [UNKNOWN, FIRST].map(|column| dofs.column(part, column, 1));
        predict(part, dofs, |n| u[n] + dt * v[n]);
        Ok(())
    }

    fn update(&self, part: &mut ModelPart) {
        let dt = part.info.delta_time;
        let history = &mut part.nodes.history;
        for (rates, _) in Rates::within(history) {
            let [u, u_old] = [0, 1].map(|level| history.level(rates.unknown, level));
            let old = history.level(rates.first, 1);
            let way = u.iter().zip(u_old).map(|(u, old)| u - old);
            let velocity: Vec<f64> = way.zip(old).map(|(way, v)| 2.0 * way / dt - v).collect();
            let acceleration: Vec<f64> = velocity.iter().zip(old).map(|(v, old)| (v - old) / dt).collect();
            history.write_level(rates.first, 0, &velocity);
            if let Some(second) = rates.second {
                history.write_level(second, 0, &acceleration);
            }
        }
    }

    fn inertia(&self, part: &ModelPart, dofs: &DofTable) -> Option<Inertia> {
        let [alpha, beta] = self.rayleigh;
        Some(Inertia {
            damping_factor: 2.0 / part.info.delta_time,
            alpha,
            beta,
            acceleration: vec![0.0; dofs.len()],
            velocity: dofs.column(part, FIRST, 0),
            ..Inertia::default()
        })
    }
}

register! { SchemeEntry "pseudo_static",
    about: "no inertia: Rayleigh's damping alone slows the motion, trapezoidal rule",
    source: "C v + f_int(u) = f_ext",
    build: SchemeFactory::Implicit(PseudoStaticScheme::from_settings),
}
