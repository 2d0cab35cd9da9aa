//! Motion without inertia, slowed by Rayleigh's damping alone.
//!
//! C v_{n+1} + f_int(u_{n+1}) = f_ext with C = α M + β K, and the trapezoidal rule u_{n+1} = u_n + Δt/2 (v_n + v_{n+1}): of
//! second order where the first velocity is in balance. Without damping every step is a state of equilibrium.
//! ACCELERATION is the change of VELOCITY over the step and enters no equation.

use super::scheme::{Scheme, SchemeEntry, SchemeFactory, SchemeRequest, gather};
use crate::assembly::{DofTable, Inertia};
use crate::diagnostics::Result;
use crate::model::ModelPart;
use crate::model::variables::{ACCELERATION, DISPLACEMENT, VELOCITY};
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

    fn prepare(&self, part: &mut ModelPart) {
        part.nodes.history.add(&VELOCITY);
        part.nodes.history.add(&ACCELERATION);
    }

    /// Free displacements go on with the velocity of the last step.
    fn predict(&mut self, part: &mut ModelPart, dofs: &DofTable) -> Result<()> {
        let dt = part.info.delta_time;
        for dof in dofs.dofs() {
            if dof.variable.column == DISPLACEMENT.name() && !part.nodes.is_fixed(dof.variable, dof.node) {
                let at = 3 * dof.node as usize + dof.variable.offset();
                let old = |variable| part.nodes.history.values(variable, 1)[at];
                let guess = old(&DISPLACEMENT) + dt * old(&VELOCITY);
                part.nodes.history.values_mut(&DISPLACEMENT, 0)[at] = guess;
            }
        }
        Ok(())
    }

    fn update(&self, part: &mut ModelPart) {
        let dt = part.info.delta_time;
        let history = &mut part.nodes.history;
        let way = history.values(&DISPLACEMENT, 0).iter().zip(history.values(&DISPLACEMENT, 1)).map(|(u, old)| u - old);
        let old = history.values(&VELOCITY, 1);
        let velocity: Vec<f64> = way.zip(old).map(|(way, v)| 2.0 * way / dt - v).collect();
        let acceleration: Vec<f64> = velocity.iter().zip(old).map(|(v, old)| (v - old) / dt).collect();
        history.values_mut(&VELOCITY, 0).copy_from_slice(&velocity);
        history.values_mut(&ACCELERATION, 0).copy_from_slice(&acceleration);
    }

    fn inertia(&self, part: &ModelPart, dofs: &DofTable) -> Option<Inertia> {
        let [alpha, beta] = self.rayleigh;
        let velocity = part.nodes.history.values(&VELOCITY, 0);
        Some(Inertia {
            damping_factor: 2.0 / part.info.delta_time,
            alpha,
            beta,
            acceleration: gather(dofs, |_| 0.0),
            velocity: gather(dofs, |i| velocity[i]),
            ..Inertia::default()
        })
    }
}

register! { SchemeEntry "pseudo_static",
    about: "no inertia: Rayleigh's damping alone slows the motion, trapezoidal rule",
    source: "C v + f_int(u) = f_ext",
    build: SchemeFactory::Implicit(PseudoStaticScheme::from_settings),
}
