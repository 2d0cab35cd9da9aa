//! Time schemes: the inertia terms of the system, and the rates from displacements.

use zelus_linear_algebra::State;

use super::central_differences::CentralDifferences;
use crate::assembly::{DofTable, Inertia};
use crate::diagnostics::Result;
use crate::model::{FIRST, ModelPart, Rates, SECOND, UNKNOWN};
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

    /// Whether it moves unknowns too that have a first derivative by time and no second.
    fn takes_first_order(&self) -> bool {
        self.is_static()
    }

    /// Whether prescribed values are in the fields before the first iteration, as where no element minds a jump; they enter
    /// through the tangent otherwise.
    fn begins_at_prescribed(&self) -> bool {
        false
    }

    /// Step start: first guess of the unknowns that are free.
    ///
    /// # Errors
    /// A step the scheme cannot take.
    fn predict(&mut self, _part: &mut ModelPart, _dofs: &DofTable) -> Result<()> {
        Ok(())
    }

    /// Derivatives from the present unknowns.
    fn update(&self, _part: &mut ModelPart) {}

    /// Contribution of inertia and damping in the present state; `None` when the problem is static.
    fn inertia(&self, _part: &ModelPart, _dofs: &DofTable) -> Option<Inertia> {
        None
    }

    /// Step start: inertia and damping at the end of the last step, when the scheme has still to be told.
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

    /// State between steps beside the fields of the model, for the file of a saved run.
    fn state(&self) -> Option<Box<dyn State>> {
        None
    }

    /// Takes up a saved state.
    ///
    /// # Errors
    /// The state of another scheme.
    fn resume(&mut self, _state: Box<dyn State>) -> Result<()> {
        Ok(())
    }

    /// Step start: the forces that it keeps, for changes.
    fn kept(&mut self) -> Option<&mut Vec<f64>> {
        None
    }
}

/// Moves free unknowns with rates to u + Δt v + Δt²/2 a of the last step.
pub(super) fn predict_ballistic(part: &mut ModelPart, dofs: &DofTable) {
    let dt = part.info.delta_time;
    let [u, v, a] = [UNKNOWN, FIRST, SECOND].map(|column| dofs.column(part, column, 1));
    predict(part, dofs, |n| u[n] + dt * v[n] + 0.5 * dt * dt * a[n]);
}

/// Moves free unknowns with rates to their predicted values.
pub(super) fn predict(part: &mut ModelPart, dofs: &DofTable, guess: impl Fn(usize) -> f64) {
    let mut values = dofs.column(part, UNKNOWN, 0);
    for (number, dof) in dofs.dofs().iter().enumerate() {
        if !part.nodes.is_fixed(dof.variable, dof.node) {
            values[number] = guess(number);
        }
    }
    dofs.write_column(part, UNKNOWN, 0, &values);
}

/// Newmark's relations: first and second derivatives from unknowns and the last step, at every node.
pub(super) fn update_newmark(part: &mut ModelPart, beta: f64, gamma: f64) {
    let dt = part.info.delta_time;
    let history = &mut part.nodes.history;
    for (rates, _) in Rates::within(history) {
        let Some(second) = rates.second else { continue };
        let u = history.level(rates.unknown, 0);
        let [u_old, v_old, a_old] = [rates.unknown, rates.first, second].map(|column| history.level(column, 1));
        let a: Vec<f64> = (0..u.len())
            .map(|i| (u[i] - u_old[i]) / (beta * dt * dt) - v_old[i] / (beta * dt) - (0.5 / beta - 1.0) * a_old[i])
            .collect();
        let v: Vec<f64> = (0..u.len()).map(|i| v_old[i] + dt * ((1.0 - gamma) * a_old[i] + gamma * a[i])).collect();
        history.write_level(rates.first, 0, &v);
        history.write_level(second, 0, &a);
    }
}

/// No inertia: time is the load factor.
#[derive(Debug, Clone, Copy, Default)]
pub struct StaticScheme;

impl Scheme for StaticScheme {
    fn is_static(&self) -> bool {
        true
    }
}

/// Arguments from which a scheme is made.
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
    about: "no inertia: time is the load factor",
    source: "f_int(u) = f_ext(t)",
    build: SchemeFactory::Implicit(|_| Ok(Box::new(StaticScheme))),
}
