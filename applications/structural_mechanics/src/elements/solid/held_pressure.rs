//! The pressure that an element holds: p = Σ p_k φ_k, with the volume as constraint.
//!
//! ∫ φ_k (J − θ³ + θ³ p/κ) dV = 0 gives p = −κ M⁻¹ b, M_kl = ∫ φ_k φ_l θ³ dV, b_k = ∫ φ_k (J − θ³) dV. φ is 1, of a linear pressure
//! also the coordinates from the mean of the nodes, over the size of the element. θ³ is the volume at which a law that expands is free.
//!
//! An increment that is far from the solution changes J by its square, and the pressure by κ times that: pressures of neighbours differ
//! by many shear moduli μ, and with them in the geometric stiffness the matrix is no longer positive. The tangent therefore takes a
//! pressure within μ of the one at the start of the step, at which it is exact, and the forces take p. Iterations that converge within
//! μ keep their rate.

use nalgebra::Matrix4;
use zelus_core::entities::{EntityView, StepView};

use super::Solid;
use super::kinematics::ElementMotion;
use crate::elements::formulation::Formulation;
use crate::elements::material::Material;

/// Largest number of functions of the pressure.
pub(super) const MODES: usize = 4;

/// Pressure of an element.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeldPressure {
    /// M⁻¹.
    pub(super) inverse: Matrix4<f64>,
    /// p_k.
    coefficients: [f64; MODES],
}

impl HeldPressure {
    /// No pressure.
    pub(super) const NONE: Self = Self {
        inverse: Matrix4::new(1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0),
        coefficients: [0.0; MODES],
    };

    /// From M, of which rows without a function are those of the unit matrix, b and κ.
    fn new(matrix: &Matrix4<f64>, change: [f64; MODES], bulk: f64) -> Self {
        let inverse = matrix.try_inverse().unwrap_or(Matrix4::repeat(f64::NAN));
        let coefficients = (inverse * nalgebra::Vector4::from(change)).map(|value| -bulk * value);
        Self { inverse, coefficients: coefficients.into() }
    }

    /// Pressure where the functions are `modes`.
    pub(super) fn at(&self, modes: &[f64; MODES]) -> f64 {
        self.coefficients.iter().zip(modes).map(|(p, mode)| p * mode).sum()
    }
}

impl<F: Formulation, const NODES: usize, const DIM: usize, const S: usize> Solid<F, NODES, DIM, S> {
    /// φ_k where the shape functions are `n`; those that the element does not have are 0.
    pub(super) fn modes(n: &[f64; NODES], entity: &EntityView<'_, NODES>) -> [f64; MODES] {
        let mut modes = [1.0, 0.0, 0.0, 0.0];
        if F::LINEAR_PRESSURE {
            let x = &entity.initial;
            for a in 0..DIM {
                let mean = x.iter().map(|x| x[a]).sum::<f64>() / NODES as f64;
                let size = x.iter().map(|x| (x[a] - mean).abs()).fold(0.0, f64::max);
                modes[a + 1] = n.iter().zip(x).map(|(n, x)| n * (x[a] - mean)).sum::<f64>() / size;
            }
        }
        modes
    }

    /// Pressure of an element whose law leaves the volume to it; none in others.
    pub(super) fn pressure(
        material: &Material<S>,
        entity: &EntityView<'_, NODES>,
        motion: &ElementMotion<NODES>,
        state: &[f64],
    ) -> Result<HeldPressure, String> {
        let Some(bulk) = material.law.bulk_of_element() else { return Ok(HeldPressure::NONE) };
        let (mut matrix, mut change) = (Matrix4::zeros(), [0.0; MODES]);
        for g in 0..material.rule.len() {
            let point = Self::point(material, g, entity, motion, &[[0.0; DIM]; NODES], state)?;
            let free = material.law.free_volume(point.state.temperature);
            let modes = Self::modes(&material.rule.n()[g], entity);
            for k in 0..MODES {
                change[k] += point.weight * modes[k] * (point.state.det_f - free);
                (0..MODES).for_each(|l| matrix[(k, l)] += point.weight * free * modes[k] * modes[l]);
            }
        }
        let held = if F::LINEAR_PRESSURE { DIM + 1 } else { 1 };
        (held..MODES).for_each(|k| matrix[(k, k)] = 1.0);
        Ok(HeldPressure::new(&matrix, change, bulk))
    }

    /// The pressure at the start of the step, near which the tangent takes its own; `None` where that is not known or needed.
    pub(super) fn pressure_before(
        material: &Material<S>,
        entity: &EntityView<'_, NODES>,
        view: &StepView<'_>,
        motion: &ElementMotion<NODES>,
        state: &[f64],
    ) -> Option<HeldPressure> {
        // a body that has been heated has another free volume than before
        if !F::CONSTANT_PRESSURE || material.law.expands() {
            return None;
        }
        Self::pressure(material, entity, &Self::motion_before(entity, view, motion), state).ok()
    }
}
