//! The tangent of interactions, e.g. contact, on a pattern that is laid out anew when their pairs change.

use zelus_linear_algebra::Csr;

use super::parallel_layout::ParallelLayout;
use crate::assembly::group_matrix::GroupMatrix;
use crate::assembly::{DofTable, System};
use crate::diagnostics::Result;
use crate::entities::{Coupling, EntityBlock, StepView};
use crate::model::{DofOwners, ModelPart};

/// Matrix of the interactions and the unknowns that are theirs, the multipliers.
#[derive(Default)]
pub(super) struct CouplingTangent {
    group: GroupMatrix,
    /// Graph of the interactions that the pattern is of; `None` where it is to be laid out anew.
    graph: Option<u64>,
    /// Numbers of the multipliers, ascending.
    multipliers: Vec<u32>,
    /// Place of each multiplier's interaction among those that couple.
    couplings: Vec<usize>,
}

impl CouplingTangent {
    /// No pairs yet; `carriers` are those of the multipliers of each interaction that couples, which are numbered.
    pub fn new(system: &System, carriers: &[Vec<DofOwners>]) -> Self {
        let dofs = &system.dofs;
        let multipliers: Vec<u32> = (0..dofs.len() as u32).filter(|&n| dofs.dofs()[n as usize].multiplier).collect();
        let mut couplings = vec![0; multipliers.len()];
        for (at, of_coupling) in carriers.iter().enumerate() {
            for own in of_coupling {
                let numbers = own.owners().filter_map(|owner| dofs.number_of(own.variable, owner));
                let places = numbers.filter_map(|number| multipliers.binary_search(&number).ok());
                places.for_each(|place| couplings[place] = at);
            }
        }
        Self { multipliers, couplings, ..Self::default() }
    }

    /// The matrix over all unknowns.
    pub fn matrix(&self) -> &Csr {
        &self.group.matrix
    }

    /// Lets the next [`CouplingTangent::lay_out`] make the pattern anew.
    pub fn forget_graph(&mut self) {
        self.graph = None;
    }

    /// Whether the pattern is that of the present pairs.
    pub fn is_present(&self, system: &System) -> bool {
        self.graph == Some(graph_of(system))
    }

    /// Lays out the pattern of the present pairs where it is another; whether it was.
    pub fn lay_out(&mut self, part: &ModelPart, system: &System) -> bool {
        let graph = graph_of(system);
        let changed = self.graph != Some(graph);
        if changed {
            let is_own = |nodes: &[u32]| part.evaluates_pair(nodes);
            self.group = GroupMatrix::new(&system.dofs, &blocks_of(system), &self.multipliers, is_own);
            self.graph = Some(graph);
        }
        changed
    }

    /// Puts the present pairs in the place of those of the matrix, which the caller keeps and [puts
    /// back](CouplingTangent::put_back).
    pub fn replace_pairs(&mut self, part: &ModelPart, system: &System) -> GroupMatrix {
        let is_own = |nodes: &[u32]| part.evaluates_pair(nodes);
        let present = GroupMatrix::new(&system.dofs, &blocks_of(system), &[], is_own);
        std::mem::replace(&mut self.group, present)
    }

    /// Puts the pairs of the matrix back.
    pub fn put_back(&mut self, kept: GroupMatrix) {
        self.group = kept;
    }

    /// Adds the forces of the interactions to `rhs`.
    ///
    /// # Errors
    /// A pair that cannot be computed.
    pub fn add_residual(&self, system: &System, view: &StepView<'_>, rhs: &mut [f64]) -> Result<()> {
        Ok(self.group.add_residual(&blocks_of(system), view, rhs)?)
    }

    /// Hands on the block of each pair and its place there, its unknowns and its forces.
    ///
    /// # Errors
    /// A pair that cannot be computed.
    pub fn each_residual(
        &self,
        blocks: &[&dyn EntityBlock],
        view: &StepView<'_>,
        add: impl FnMut(usize, usize, &[u32], &[f64]),
    ) -> Result<()> {
        Ok(self.group.each_residual(blocks, view, add)?)
    }

    /// Recomputes the matrix.
    ///
    /// # Errors
    /// A pair that cannot be computed.
    pub fn assemble(&mut self, system: &System, view: &StepView<'_>) -> Result<()> {
        Ok(self.group.assemble(&blocks_of(system), view)?)
    }

    /// Gives each multiplier without equation a diagonal entry; collective.
    pub fn set_inactive_diagonals(&mut self, part: &ModelPart, system: &System, parallel: &ParallelLayout) {
        let inactive = |own: &dyn Coupling| if own.blocks().is_empty() { 1.0 } else { own.inactive_diagonal() };
        let inactive: Vec<f64> = couplings(system).map(inactive).collect();
        let mut in_use = self.group.lonely_rows_in_use();
        part.ranks.any_of(&mut in_use);
        let diagonals = self.couplings.iter().map(|&coupling| inactive[coupling]);
        self.group.set_idle_diagonal(&in_use, diagonals, |number| parallel.counts(number));
    }

    /// Adds `amount` to the diagonals of the multipliers.
    pub fn relax(&mut self, dofs: &DofTable, amount: f64, parallel: &ParallelLayout) {
        for (number, _) in dofs.dofs().iter().enumerate().filter(|(_, dof)| dof.multiplier) {
            if parallel.counts(number) {
                self.group.matrix.add(number, number, amount);
            }
        }
    }
}

/// The interactions that couple.
pub(super) fn couplings(system: &System) -> impl Iterator<Item = &dyn Coupling> {
    system.interactions.iter().filter_map(|interaction| interaction.coupling())
}

/// The blocks of all interactions.
pub(super) fn blocks_of(system: &System) -> Vec<&dyn EntityBlock> {
    couplings(system).flat_map(|own| own.blocks()).collect()
}

/// A number that changes whenever the pairs of an interaction do.
fn graph_of(system: &System) -> u64 {
    couplings(system).fold(1, |sum, own| sum.wrapping_mul(31).wrapping_add(own.graph_version()))
}
