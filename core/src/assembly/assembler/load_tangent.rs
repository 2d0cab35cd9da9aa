//! The tangent of follower loads: small, and not symmetric.

use zelus_linear_algebra::Csr;

use crate::assembly::group_matrix::GroupMatrix;
use crate::assembly::{Equations, System};
use crate::diagnostics::Result;
use crate::entities::{EntityBlock, StepView, Tangent};

/// Matrix of the follower loads over all unknowns, and on the equations.
#[derive(Default)]
pub(super) struct LoadTangent {
    group: GroupMatrix,
    reduced: Csr,
}

impl LoadTangent {
    /// The pattern of the follower loads of `system`.
    pub fn new(system: &System) -> Self {
        let group = GroupMatrix::new(&system.dofs, &loads_of(system), &[], |_| true);
        Self { group, reduced: Csr::default() }
    }

    /// The matrix over all unknowns.
    pub fn matrix(&self) -> &Csr {
        &self.group.matrix
    }

    /// The matrix over all unknowns, where an entry is not zero.
    pub fn nonzero(&self) -> Option<&Csr> {
        self.group.nonzero()
    }

    /// Recomputes the matrix.
    ///
    /// # Errors
    /// A load that cannot be computed.
    pub fn assemble(&mut self, system: &System, view: &StepView<'_>) -> Result<()> {
        Ok(self.group.assemble(&loads_of(system), view)?)
    }

    /// Multiplies the matrix, until it is assembled again.
    pub fn scale(&mut self, factor: f64) {
        self.group.matrix.values.iter_mut().for_each(|v| *v *= factor);
    }

    /// The matrix on the equations; `None` when no entry is other than zero.
    pub fn reduce(&mut self, equations: &Equations) -> Option<&Csr> {
        let loads = self.group.nonzero()?;
        equations.reduce_matrix(loads, &loads.values, &mut self.reduced, false);
        Some(&self.reduced)
    }
}

/// The conditions whose tangent is not symmetric.
fn loads_of(system: &System) -> Vec<&dyn EntityBlock> {
    system
        .conditions
        .iter()
        .map(AsRef::as_ref)
        .filter(|b: &&dyn EntityBlock| b.tangent() == Tangent::Unsymmetric)
        .collect()
}
