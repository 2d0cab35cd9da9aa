//! Time schemes: what inertia adds to the system, and how rates follow displacements.

use super::central_differences::CentralDifferences;
use crate::assembly::{DofTable, Inertia};
use crate::diagnostics::Result;
use crate::model::ModelPart;
use crate::model::variables::{ACCELERATION, DISPLACEMENT, VELOCITY};
use crate::parameters::Settings;
use crate::{register, registered_kind};

/// Integration in time of the equations of motion.
pub trait Scheme: Send {
    /// Variables with history it needs on the nodes, beside the unknowns.
    fn prepare(&self, _part: &mut ModelPart) {}

    /// Whether it uses the lumped mass.
    fn lumped_mass(&self) -> bool {
        false
    }

    /// Whether nothing but the unknowns themselves follows from a step.
    fn is_static(&self) -> bool {
        false
    }

    /// Whether mass resists the motion.
    fn has_inertia(&self) -> bool {
        !self.is_static()
    }

    /// Step start: first guess of the unknowns that are free.
    ///
    /// # Errors
    /// A step the scheme cannot take.
    fn predict(&mut self, _part: &mut ModelPart, _dofs: &DofTable) -> Result<()> {
        Ok(())
    }

    /// Rates from the present displacements.
    fn update(&self, _part: &mut ModelPart) {}

    /// What inertia and damping add in the present state; `None` when the problem is static.
    fn inertia(&self, _part: &ModelPart, _dofs: &DofTable) -> Option<Inertia> {
        None
    }

    /// Step start: what inertia and damping were at the end of the last step, when the scheme has still to be told.
    ///
    /// [`Scheme::keep`] is then called with the forces that come of it.
    fn past_inertia(&self, _part: &ModelPart, _dofs: &DofTable) -> Option<Inertia> {
        None
    }

    /// Whether [`Scheme::keep`] is to be called with the forces of an accepted step.
    fn keeps_forces(&self) -> bool {
        false
    }

    /// The forces that inertia and damping took up at the end of an accepted step, a number an unknown.
    fn keep(&mut self, _forces: Vec<f64>) {}

    /// Step start: what it keeps of forces, for changes.
    fn kept(&mut self) -> Option<&mut Vec<f64>> {
        None
    }
}

/// One number an unknown: `value` at the place of its component in a vector column, 0 for all but displacements.
pub(super) fn gather(dofs: &DofTable, value: impl Fn(usize) -> f64) -> Vec<f64> {
    let displacement = |dof: &crate::assembly::Dof| dof.variable.column == DISPLACEMENT.name();
    let all = dofs.dofs().iter();
    all.map(|dof| if displacement(dof) { value(3 * dof.node as usize + dof.variable.offset()) } else { 0.0 }).collect()
}

/// Moves free displacements to u + Δt v + Δt²/2 a of the last step.
pub(super) fn predict_ballistic(part: &mut ModelPart, dofs: &DofTable) {
    let dt = part.info.delta_time;
    for dof in dofs.dofs() {
        let at = 3 * dof.node as usize + dof.variable.offset();
        if dof.variable.column == DISPLACEMENT.name() && !part.nodes.is_fixed(dof.variable, dof.node) {
            let old = |variable| part.nodes.history.values(variable, 1)[at];
            let guess = old(&DISPLACEMENT) + dt * old(&VELOCITY) + 0.5 * dt * dt * old(&ACCELERATION);
            part.nodes.history.values_mut(&DISPLACEMENT, 0)[at] = guess;
        }
    }
}

/// Newmark's relations: VELOCITY and ACCELERATION from DISPLACEMENT and the last step, at every node.
pub(super) fn update_newmark(part: &mut ModelPart, beta: f64, gamma: f64) {
    let dt = part.info.delta_time;
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

/// No inertia: time only orders the loads.
#[derive(Debug, Clone, Copy, Default)]
pub struct StaticScheme;

impl Scheme for StaticScheme {
    fn is_static(&self) -> bool {
        true
    }
}

/// What a scheme is made from.
pub struct SchemeRequest<'a> {
    /// The solver settings, defaults filled in.
    pub settings: &'a Settings,
}

impl SchemeRequest<'_> {
    /// Rayleigh's factors of mass (1/time) and stiffness (time).
    ///
    /// # Errors
    /// Settings that are not numbers.
    pub fn rayleigh(&self) -> Result<[f64; 2]> {
        Ok([self.settings.get_f64("rayleigh_alpha")?, self.settings.get_f64("rayleigh_beta")?])
    }
}

/// Makes a scheme of one of the two methods.
#[derive(Clone, Copy)]
pub enum SchemeFactory {
    /// Solved for by iteration.
    Implicit(fn(&SchemeRequest<'_>) -> Result<Box<dyn Scheme>>),
    /// From forces to motion directly.
    Explicit(fn(&SchemeRequest<'_>) -> Result<CentralDifferences>),
}

registered_kind! {
    /// A time scheme that decks name.
    pub struct SchemeEntry("scheme", "unknown-name") {
        build: SchemeFactory;
    }
}

register! { SchemeEntry "static",
    about: "no inertia: time only orders the loads",
    build: SchemeFactory::Implicit(|_| Ok(Box::new(StaticScheme))),
}
