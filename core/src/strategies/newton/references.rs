//! What the residuals of a step are measured by: those at its start, as far as forces of its size explain them.

use super::NewtonRaphson;
use crate::assembly::System;
use crate::diagnostics::Result;
use crate::model::ModelPart;

/// Largest residual after the first solve, in forces at the start, that others are measured by. A first iterate may let a body
/// go, and what it leaves then would make any later residual small.
const LARGEST: f64 = 100.0;

/// Residuals of a step that later ones are compared with.
#[derive(Debug, Default)]
pub(in crate::strategies) struct References {
    /// Before and after the first solve.
    pub start: Vec<Vec<f64>>,
    /// After the last change of state.
    pub switched: Option<Vec<f64>>,
    /// Size of the forces at the start: loads, reactions and what is out of balance.
    forces: f64,
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
        to.forces = self.size_of_forces(system, residual).hypot(self.size_of_forces(system, &loads));
        to.start.push(self.assembler.equations().balanced(residual).into_owned());
        Ok(())
    }

    /// Takes the residual after the first solve: where no force at the start explains it, a share of it. Collective.
    pub(super) fn refer_to_first(&self, system: &System, balanced: &[f64], to: &mut References) {
        let mut taken = balanced.to_vec();
        let (size, largest) = (self.size_of_forces(system, balanced), LARGEST * to.forces);
        if largest > 0.0 && size > largest {
            let forces = system.dofs.dofs().iter().zip(&mut taken).filter(|(dof, _)| !dof.multiplier);
            forces.for_each(|(_, force)| *force *= largest / size);
        }
        to.start.push(taken);
    }

    /// Euclidean norm over all unknowns but multipliers; collective.
    pub(super) fn size_of_forces(&self, system: &System, of: &[f64]) -> f64 {
        let own = system.dofs.dofs().iter().enumerate().filter(|(n, dof)| !dof.multiplier && self.assembler.counts(*n));
        self.assembler.total(own.map(|(n, _)| of[n] * of[n]).sum()).sqrt()
    }
}
