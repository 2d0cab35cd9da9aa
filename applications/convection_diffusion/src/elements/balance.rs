//! The balance of heat at a point: the factors of the shape functions and of their gradients.
//!
//! ρc (∂T/∂t + v·∇T) = ∇·(k ∇T) + Q is weighted by N_i + τ v·∇N_i (SUPG): the residual is −∫ (N_i a + ∇N_i·b) with
//! a = ρc (T − T₀)/Δt + ρc v·(θ ∇T + (1 − θ) ∇T₀) − Q and b = k (θ ∇T + (1 − θ) ∇T₀) + τ v a, where
//! τ = ρc/(ρc (β/Δt + 2|v|/h) + 4k/h²). ρc of the rate is the mean of those at both ends of the step, which for linear tables is
//! the heat the step stores. Against wiggles across the flow Codina's cross-wind diffusion adds D to k: D = α I + (max(α − ρcτ|v|², 0) − α)
//! v⊗v/|v|² with α = C h |r|/|g|, r the residual and g = (∇T + ∇T₀)/2.

use std::f64::consts::PI;

use zelus_core::model::ProcessInfo;
use zelus_core::scalar::Real;

use super::contribution::Pointwise;
use super::marks::{ABOUT_Y, AT_REST, CROSS_WIND_OF_ITERATE, CROSS_WIND_OF_STEP_START};
use crate::coefficient::Local;

/// Data of the whole step.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Its length in time; infinite where heat is at rest.
    pub length: f64,
    /// Weight of its end in conduction and convection, 0 to 1.
    pub theta: f64,
    /// β of the stabilisation.
    pub dynamic_tau: f64,
    /// C of the cross-wind diffusion.
    pub cross_wind: f64,
    /// Gradients below this have no cross-wind diffusion (temperature per length).
    pub least_gradient: f64,
    /// The state that gives the cross-wind diffusion.
    pub cross_wind_state: CrossWindState,
}

/// The state that gives the cross-wind diffusion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrossWindState {
    /// That of the iterate, with its derivatives in the tangent.
    Present,
    /// That of the iterate, a constant in the tangent.
    Iterate,
    /// That at the start of the step, which leaves the step linear.
    StepStart,
}

/// Value of the step data: weight of the end of the step.
pub const THETA: &str = "THETA";
/// Value of the step data: β of the stabilisation.
pub const DYNAMIC_TAU: &str = "DYNAMIC_TAU";
/// Value of the step data: factor of the cross-wind diffusion.
pub const CROSS_WIND: &str = "CROSS_WIND_STABILIZATION_FACTOR";
/// Value of the step data: gradients below it have no cross-wind diffusion.
pub const LEAST_GRADIENT: &str = "CROSS_WIND_LEAST_GRADIENT";
impl Step {
    /// As the step data say.
    pub fn of(info: &ProcessInfo) -> Self {
        Self {
            length: if info.has(AT_REST) { f64::INFINITY } else { info.delta_time },
            theta: info.value_or(THETA, 0.5),
            dynamic_tau: info.value_or(DYNAMIC_TAU, 1.0),
            cross_wind: info.value_or(CROSS_WIND, 0.0),
            least_gradient: info.value_or(LEAST_GRADIENT, 0.0),
            cross_wind_state: match (info.has(CROSS_WIND_OF_ITERATE), info.has(CROSS_WIND_OF_STEP_START)) {
                (true, _) => CrossWindState::Iterate,
                (_, true) => CrossWindState::StepStart,
                _ => CrossWindState::Present,
            },
        }
    }
}

/// Data of a point that do not depend on its temperature.
#[derive(Clone, Copy)]
pub struct BalancePoint<'a, const NODES: usize> {
    /// Step, with the weights of its ends.
    pub step: Step,
    /// Shape functions.
    pub n: &'a [f64; NODES],
    /// Heat conductivity.
    pub conductivity: &'a Local<'a, NODES>,
    /// Density.
    pub density: &'a Local<'a, NODES>,
    /// Specific heat.
    pub specific_heat: &'a Local<'a, NODES>,
    /// Whether heat is stored.
    pub stores: bool,
    /// Temperature at the beginning of the step.
    pub old: f64,
    /// Its gradient.
    pub old_gradient: [f64; 3],
    /// Velocity relative to the mesh.
    pub velocity: [f64; 3],
    /// Power per volume.
    pub source: f64,
    /// Size of the element along the flow (length).
    pub size: f64,
    /// Distance from the axis, in a body of revolution.
    pub radius: Option<f64>,
    /// The coordinate that is the distance from the axis.
    pub radial: usize,
}

/// The coordinate that is the distance from the axis: y, but x beside a structure, whose axis is y.
pub fn radial(info: &ProcessInfo) -> usize {
    if info.has(ABOUT_Y) { 0 } else { 1 }
}

/// Factor of volumes: the circumference around the axis, 2π r, where there is an axis.
pub(super) fn round(radius: Option<f64>) -> f64 {
    radius.map_or(1.0, |radius| 2.0 * PI * radius)
}

impl<const NODES: usize> BalancePoint<'_, NODES> {
    /// Factor of volumes: the circumference around the axis.
    pub fn round(&self) -> f64 {
        round(self.radius)
    }

    /// Heat capacity per volume.
    fn capacity<R: Real>(&self, temperature: R) -> R {
        self.density.mean(temperature) * self.specific_heat.mean(temperature)
    }

    /// Heat that is stored in a volume, by time.
    pub fn stored<R: Real>(&self, temperature: R) -> R {
        if !self.stores {
            return R::zero();
        }
        let mean = (self.capacity(temperature) + self.capacity(self.old)) * 0.5;
        mean * ((temperature - self.old) / self.step.length)
    }
}

impl<const NODES: usize> Pointwise for BalancePoint<'_, NODES> {
    fn balance<R: Real>(&self, temperature: R, gradient: [R; 3]) -> (R, [R; 3]) {
        let Self { step, old, old_gradient, velocity, .. } = *self;
        let (end, begin) = (step.theta, 1.0 - step.theta);
        let (k, k_old) = (self.conductivity.at(self.n, temperature), self.conductivity.at(self.n, old));
        let (c, c_old) = match self.stores {
            true => (self.capacity(temperature), self.capacity(old)),
            false => (R::zero(), 0.0),
        };
        let now_along = along(velocity, gradient);
        let old_along = along(velocity, old_gradient);
        let a = self.stored(temperature) + c * now_along * end + c_old * old_along * begin - self.source;
        let mut b: [R; 3] = std::array::from_fn(|i| k * gradient[i] * end + k_old * old_gradient[i] * begin);
        let speed = along(velocity, velocity).sqrt();
        let inverse =
            c * (step.dynamic_tau / step.length + 2.0 * speed / self.size) + k * (4.0 / (self.size * self.size));
        if speed == 0.0 || inverse.value() <= 0.0 {
            return (a, b);
        }
        let tau = c / inverse;
        // Term of the strong form from conduction towards the axis.
        let strong = self.radius.map_or(a, |radius| a - b[self.radial] / radius);
        (0..3).for_each(|i| b[i] += tau * strong * velocity[i]);
        if step.cross_wind > 0.0 {
            let (t, g) = match step.cross_wind_state {
                CrossWindState::Present => (temperature, gradient),
                CrossWindState::Iterate => (R::constant(temperature.value()), gradient.map(|g| R::constant(g.value()))),
                CrossWindState::StepStart => (R::constant(old), old_gradient.map(R::constant)),
            };
            let mean: [R; 3] = std::array::from_fn(|i| (g[i] + old_gradient[i]) * 0.5);
            let slope = mean.iter().fold(R::zero(), |sum, g| sum + *g * *g);
            if slope.value() > step.least_gradient * step.least_gradient {
                let residual = c * ((t - old) / step.length + along(velocity, mean) - self.source);
                let across = residual.abs() / slope.sqrt() * (step.cross_wind * self.size);
                let left = across - c * tau * (speed * speed);
                let left = if left.value() > 0.0 { left } else { R::zero() };
                let weighted: [R; 3] = std::array::from_fn(|i| gradient[i] * end + old_gradient[i] * begin);
                let stream = along(velocity, weighted) * (left - across) / (speed * speed);
                (0..3).for_each(|i| b[i] += across * weighted[i] + stream * velocity[i]);
            }
        }
        (a, b)
    }
}

/// v·g.
pub(super) fn along<R: Real>(velocity: [f64; 3], gradient: [R; 3]) -> R {
    velocity.iter().zip(gradient).fold(R::zero(), |sum, (v, g)| sum + g * *v)
}
