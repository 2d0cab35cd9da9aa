//! The longest stable step of explicit integration.

use crate::assembly::{Assembler, DofTable};

/// Products with the tangent at most.
const PRODUCTS: usize = 100;
/// Relative change of the eigenvalue at which the iteration stops.
const CHANGE: f64 = 1e-4;
/// The iteration reaches the largest eigenvalue from below; this factor compensates for the rest.
const MARGIN: f64 = 1.02;

/// Estimates the longest stable step, 2/ω (√(1+ξ²) − ξ) with ξ = (α/ω + β ω)/2, in units of time.
///
/// ω² is the largest eigenvalue of M⁻¹ K on the present equations, by power iteration; `mass` has a number an
/// equation; those without mass are taken for supported. Infinite without stiffness. Collective.
pub fn critical_step(assembler: &Assembler, dofs: &DofTable, mass: &[f64], rayleigh: [f64; 2]) -> f64 {
    let equations = assembler.equations();
    // Any start will do that is the same for every number of ranks.
    let start = |&number: &u32| {
        let dof = &dofs.dofs()[number as usize];
        let node = assembler.distribution().map_or(dof.node, |distribution| distribution.place(number as usize));
        let i = 3 * node as usize + dof.variable.offset();
        (1.0 + (i % 7) as f64 / 7.0) * if i.is_multiple_of(2) { 1.0 } else { -1.0 }
    };
    let mut x: Vec<f64> = equations.unknowns().iter().map(start).collect();
    let counts = |at: usize| assembler.counts(equations.unknowns()[at] as usize);
    let weighted = |x: &[f64]| {
        let own = (0..x.len()).filter(|&at| counts(at)).map(|at| mass[at] * x[at] * x[at]);
        assembler.total(own.sum()).sqrt()
    };
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
        x = equations.reduce(&force).iter().zip(mass).map(|(f, &m)| if m > 0.0 { f / m } else { 0.0 }).collect();
        let next = weighted(&x);
        let done = (next - square).abs() <= CHANGE * next;
        square = next;
        if done {
            break;
        }
    }
    longest_step(square, rayleigh)
}

/// 2/ω (√(1+ξ²) − ξ) with the margin on ω²; infinite for ω = 0.
fn longest_step(square: f64, [alpha, beta]: [f64; 2]) -> f64 {
    let omega = (MARGIN * square).sqrt();
    if omega == 0.0 {
        return f64::INFINITY;
    }
    let ratio = 0.5 * (alpha / omega + beta * omega);
    2.0 / omega * ((1.0 + ratio * ratio).sqrt() - ratio)
}

/// The square of the highest frequency (1/time²) at which [`critical_step`] is still `step`; `None` where damping by mass alone makes
/// such steps unstable.
///
/// From Δt = 2/ω (√(1+ξ²) − ξ): Δt²/4 ω² + Δt/2 (α + β ω²) = 1.
pub(super) fn largest_square(step: f64, [alpha, beta]: [f64; 2]) -> Option<f64> {
    let square = (1.0 - 0.5 * alpha * step) / (0.25 * step * step + 0.5 * beta * step);
    (square > 0.0).then_some(square / MARGIN)
}

#[cfg(test)]
mod tests {
    use super::{MARGIN, largest_square, longest_step};

    /// ANALYTIC: both formulas are each other's inverse; without damping ω² = 4/Δt². Tolerance: round-off.
    #[test]
    fn the_largest_frequency_has_the_step_as_its_longest() {
        for rayleigh in [[0.0, 0.0], [3.0, 0.0], [0.0, 0.02], [1.5, 0.01]] {
            let square = largest_square(0.1, rayleigh).unwrap();
            assert!((longest_step(square, rayleigh) / 0.1 - 1.0).abs() < 1e-12, "{rayleigh:?}");
        }
        assert!((largest_square(0.1, [0.0; 2]).unwrap() * MARGIN / 400.0 - 1.0).abs() < 1e-14);
        assert_eq!(largest_square(0.1, [25.0, 0.0]), None);
    }
}
