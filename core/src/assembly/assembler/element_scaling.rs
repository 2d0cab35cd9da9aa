//! Mass added to elements of high frequency: selective mass scaling of explicit steps.
//!
//! The highest frequency of a mesh is at most that of its elements by themselves (Irons and Treharne), ω_e² = max x·K_e x / x·M_e x
//! with the lumped mass M_e. An element above ω² gets the mass (ω_e²/ω² − 1) M_e more, which lowers its frequency to ω.

use zelus_linear_algebra::vector::dot;

use super::Assembler;
use super::inertia_matrices::undeformed;
use crate::assembly::System;
use crate::assembly::local::{BATCH, entity_lhs, evaluate};
use crate::diagnostics::Result;
use crate::entities::{EntityBlock, LocalSystems, Request, StepView};
use crate::model::ModelPart;

/// Products with the matrix of an element at most.
const PRODUCTS: usize = 2000;
/// Relative change of the eigenvalue at which the iteration stops.
const CHANGE: f64 = 1e-13;

/// Mass that elements get so that none is above a frequency.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ScaledMass {
    /// Lumped mass added, a number an unknown.
    pub added: Vec<f64>,
    /// Number of elements that it belongs to, over all ranks.
    pub elements: usize,
    /// Largest factor by which the mass of an element grows; 1 where none does.
    pub largest_factor: f64,
}

impl Assembler {
    /// Mass that brings the square ω_e² of the frequency of every element down to `square` (1/time²), with the tangents of the present
    /// state and the masses of the initial positions. Elements without mass at a node stay. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn scale_mass(&self, part: &ModelPart, system: &System, square: f64) -> Result<ScaledMass> {
        let mut out = part.ranks.agree(self.own_scaled_mass(part, system, square))?;
        self.parallel.sum(&mut out.added);
        out.elements = part.ranks.total(out.elements as f64) as usize;
        let factors = part.ranks.gather_numbers(&[out.largest_factor]).concat();
        out.largest_factor = factors.into_iter().fold(1.0, f64::max);
        Ok(out)
    }

    /// The share of this rank's elements.
    fn own_scaled_mass(&self, part: &ModelPart, system: &System, square: f64) -> Result<ScaledMass> {
        let mut out = ScaledMass { added: vec![0.0; system.dofs.len()], elements: 0, largest_factor: 1.0 };
        let nodes = undeformed(part);
        let (view, initial) = (part.view(), StepView { nodes: &nodes, ..part.view() });
        for (block, numbers) in self.bulk.elements(system) {
            let size = block.unknowns().len();
            if size != block.equations() {
                continue;
            }
            for_each_element(block, &view, &initial, |at, stiffness, mass| {
                let Some(factor) = factor(stiffness, &mass, square) else { return };
                let numbers = &numbers[at * size..(at + 1) * size];
                numbers.iter().zip(mass).for_each(|(&n, mass)| out.added[n as usize] += (factor - 1.0) * mass);
                out.elements += 1;
                out.largest_factor = out.largest_factor.max(factor);
            })?;
        }
        Ok(out)
    }
}

/// Hands on the tangent and the lumped mass of each element of a block.
fn for_each_element(
    block: &dyn EntityBlock,
    view: &StepView<'_>,
    initial: &StepView<'_>,
    mut take: impl FnMut(usize, &[f64], Vec<f64>),
) -> Result<()> {
    let size = block.unknowns().len();
    let stiffness = |range, out: &mut LocalSystems| block.local_systems(view, range, Request::Both, out);
    let mass = |range, out: &mut LocalSystems| block.mass(initial, range, true, out).map(|_| ());
    let mut buffers = [Vec::new(), Vec::new()];
    for begin in (0..block.len()).step_by(BATCH) {
        let range = begin..(begin + BATCH).min(block.len());
        let [of_stiffness, of_mass] = &mut buffers;
        let stiffnesses = &*evaluate(range.clone(), size, Request::Both, &stiffness, of_stiffness)?;
        let masses = &*evaluate(range.clone(), size, Request::Both, &mass, of_mass)?;
        for at in range {
            let lumped = entity_lhs(masses, at - begin).chunks_exact(size).map(|row| row.iter().sum()).collect();
            take(at, entity_lhs(stiffnesses, at - begin), lumped);
        }
    }
    Ok(())
}

/// Factor of the mass of an element that is above the frequency; `None` where it is not, and where a mass is none.
fn factor(stiffness: &[f64], mass: &[f64], square: f64) -> Option<f64> {
    if mass.iter().any(|&m| m <= 0.0) {
        return None;
    }
    let rows = || stiffness.chunks_exact(mass.len()).zip(mass);
    // Gershgorin's bound spares most elements the iteration.
    let bound = rows().map(|(row, m)| row.iter().map(|k| k.abs()).sum::<f64>() / m).fold(0.0, f64::max);
    if bound <= square {
        return None;
    }
    let mut x: Vec<f64> = (0..mass.len()).map(|i| 1.0 / (1.0 + (i * i % 11) as f64)).collect();
    let mut found = 0.0;
    for _ in 0..PRODUCTS {
        let weighted: Vec<f64> = x.iter().zip(mass).map(|(x, m)| x * m).collect();
        let size = dot(&weighted, &x).sqrt();
        if size == 0.0 {
            break;
        }
        x.iter_mut().for_each(|x| *x /= size);
        let force: Vec<f64> = rows().map(|(row, _)| dot(row, &x)).collect();
        let next = dot(&force, &x);
        x = force.iter().zip(mass).map(|(f, m)| f / m).collect();
        let done = (next - found).abs() <= CHANGE * next.abs();
        found = next;
        if done {
            break;
        }
    }
    (found > square).then(|| found / square)
}

#[cfg(test)]
mod tests {
    use super::factor;

    /// ANALYTIC: two masses m/2 on a spring k vibrate with ω² = 4 k/m. Tolerance: round-off of the iteration.
    #[test]
    fn a_spring_between_two_masses_has_its_frequency() {
        let (k, m) = (3.0, 0.25);
        let of = |square: f64| factor(&[k, -k, -k, k], &[m / 2.0; 2], square);
        let expected = 4.0 * k / m;
        assert!((of(expected / 7.0).unwrap() / 7.0 - 1.0).abs() < 1e-12);
        assert_eq!(of(expected * (1.0 + 1e-12)), None);
        assert_eq!(factor(&[k, -k, -k, k], &[m, 0.0], 1e-3), None);
    }

    /// ANALYTIC: unlike masses a, b on a spring k vibrate with ω² = k (1/a + 1/b). Tolerance: round-off of the iteration.
    #[test]
    fn unlike_masses_have_their_frequency() {
        let (k, a, b) = (2.0, 0.5, 3.0);
        let found = factor(&[k, -k, -k, k], &[a, b], 1e-2).unwrap();
        assert!((found * 1e-2 / (k * (1.0 / a + 1.0 / b)) - 1.0).abs() < 1e-12);
    }
}
