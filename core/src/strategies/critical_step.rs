//! The longest stable step of explicit integration.

use crate::assembly::Assembler;

/// Products with the tangent at most.
const PRODUCTS: usize = 100;
/// Relative change of the eigenvalue at which the iteration stops.
const CHANGE: f64 = 1e-4;
/// The iteration reaches the largest eigenvalue from below; this is added for what it lacks.
const MARGIN: f64 = 1.02;

/// Estimates the longest stable step, 2/ω (√(1+ξ²) − ξ) with ξ = (α/ω + β ω)/2, in units of time.
///
/// ω² is the largest eigenvalue of M⁻¹ K on the present equations, by power iteration; `mass` has a positive number an
/// equation. Infinite without stiffness.
pub(super) fn critical_step(assembler: &Assembler, mass: &[f64], [alpha, beta]: [f64; 2]) -> f64 {
    let equations = assembler.equations();
    let mut x: Vec<f64> =
        (0..mass.len()).map(|i| (1.0 + (i % 7) as f64 / 7.0) * if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
    let weighted = |x: &[f64]| x.iter().zip(mass).map(|(x, m)| m * x * x).sum::<f64>().sqrt();
    let mut square = 0.0;
    for _ in 0..PRODUCTS {
        let size = weighted(&x);
        if size == 0.0 {
            break;
        }
        x.iter_mut().for_each(|x| *x /= size);
        let motion = equations.expand(&x);
        let mut force = vec![0.0; motion.len()];
        assembler.subtract_product(&motion, &mut force);
        x = equations.reduce(&force).iter().zip(mass).map(|(f, m)| f / m).collect();
        let next = weighted(&x);
        let done = (next - square).abs() <= CHANGE * next;
        square = next;
        if done {
            break;
        }
    }
    let omega = (MARGIN * square).sqrt();
    if omega == 0.0 {
        return f64::INFINITY;
    }
    let ratio = 0.5 * (alpha / omega + beta * omega);
    2.0 / omega * ((1.0 + ratio * ratio).sqrt() - ratio)
}
