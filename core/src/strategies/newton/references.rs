//! Reference norms of the relative residual criterion: residuals at the start of the step, as far as forces of their size explain them.

use super::super::criterion::{Block, norms};
use super::NewtonRaphson;
use crate::assembly::{Distribution, System};
use crate::diagnostics::Result;
use crate::model::ModelPart;

/// Largest residual after the first solve that serves as reference, relative to the forces at the start. A first iterate may open
/// all contact of a body; its residual would make any later residual small.
const LARGEST: f64 = 100.0;

/// Residuals of a step that later ones are compared with.
#[derive(Debug, Default)]
pub(in crate::strategies) struct References {
    /// Before and after the first solve.
    pub start: Vec<Vec<f64>>,
    /// After the last change of state.
    pub switched: Option<Vec<f64>>,
    /// Sizes of the forces at the start by variable: loads, reactions and out-of-balance forces.
    forces: Vec<f64>,
}

impl NewtonRaphson {
    /// Takes the residual before the first solve, prescribed increments included. Collective.
    ///
    /// # Errors
    /// A load that cannot be computed.
    pub(super) fn refer_to_start(
        &self,
        part: &ModelPart,
        system: &System,
        residual: &[f64],
        to: &mut References,
    ) -> Result<()> {
        let loads = self.assembler.loads(part, system)?;
        let sizes = [residual, &loads[..]].map(|forces| self.sizes_of_forces(system, forces));
        to.forces = sizes[0].iter().zip(&sizes[1]).map(|(residual, load)| residual.hypot(*load)).collect();
        to.start.push(self.assembler.equations().balanced(residual).into_owned());
        Ok(())
    }

    /// Takes the residual after the first solve: where no force at the start explains it, a share of it. Collective.
    pub(super) fn refer_to_first(&self, system: &System, balanced: &[f64], to: &mut References) {
        let mut taken = balanced.to_vec();
        let sizes = self.sizes_of_forces(system, balanced);
        let shares = sizes.iter().zip(&to.forces).map(|(size, force)| (size, LARGEST * force));
        let beyond = shares.filter(|(size, largest)| *largest > 0.0 && *size > largest);
        let share = beyond.map(|(size, largest)| largest / size).fold(1.0, f64::min);
        if share < 1.0 {
            let forces = system.dofs.dofs().iter().zip(&mut taken).filter(|(dof, _)| !dof.multiplier);
            forces.for_each(|(_, force)| *force *= share);
        }
        to.start.push(taken);
    }

    /// Euclidean norm over all unknowns of each variable, zero for multipliers; collective.
    pub(super) fn sizes_of_forces(&self, system: &System, of: &[f64]) -> Vec<f64> {
        let own = (0..system.dofs.len()).filter(|n| self.assembler.counts(*n));
        let ranks = self.assembler.distribution().map(Distribution::ranks);
        norms(&system.dofs, own, Block::Primary, of, true, ranks).into_iter().map(|norm| norm.size).collect()
    }
}
