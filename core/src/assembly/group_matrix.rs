//! The matrix of a few blocks that touch few unknowns: loads, contact pairs.

use zelus_linear_algebra::Csr;

use super::bulk_matrix::block_numbers;
use super::dof_table::DofTable;
use super::local::{BATCH, entity_lhs, evaluate};
use crate::entities::{EntityBlock, EntityError, LocalSystems, StepView, Want};

/// A matrix over all unknowns whose rows are empty except where its blocks act.
#[derive(Debug, Clone, Default)]
pub struct GroupMatrix {
    /// The matrix.
    pub matrix: Csr,
    numbers: Vec<Vec<u32>>,
    /// Unknowns that only the blocks of the group touch, if any does.
    lonely: Vec<u32>,
}

impl GroupMatrix {
    /// The pattern of these blocks; unknowns of `lonely` that nothing touches get a diagonal entry.
    pub fn new(dofs: &DofTable, blocks: &[&dyn EntityBlock], lonely: &[u32]) -> Self {
        let numbers: Vec<Vec<u32>> = blocks.iter().map(|block| block_numbers(*block, dofs)).collect();
        let mut adjacency = vec![Vec::new(); dofs.len()];
        for (block, numbers) in blocks.iter().zip(&numbers) {
            let size = block.unknowns().len();
            for at in 0..block.len() {
                let rows = &numbers[at * size..(at + 1) * size];
                for &row in rows {
                    adjacency[row as usize].extend_from_slice(rows);
                }
            }
        }
        lonely.iter().for_each(|&n| adjacency[n as usize].push(n));
        Self { matrix: Csr::from_pattern(&adjacency), numbers, lonely: lonely.to_vec() }
    }

    /// Adds the right-hand sides of the blocks the group was made for.
    ///
    /// # Errors
    /// The first entity that cannot be computed.
    pub fn add_residual(
        &self,
        blocks: &[&dyn EntityBlock],
        view: &StepView<'_>,
        rhs: &mut [f64],
    ) -> Result<(), EntityError> {
        for (block, numbers) in blocks.iter().zip(&self.numbers) {
            super::bulk_matrix::add_residual(*block, numbers, view, Want::Residual, rhs)?;
        }
        Ok(())
    }

    /// Recomputes the matrix; rows of lonely unknowns that stay empty get `diagonal`.
    ///
    /// # Errors
    /// The first entity that cannot be computed.
    pub fn assemble(
        &mut self,
        blocks: &[&dyn EntityBlock],
        view: &StepView<'_>,
        diagonal: f64,
    ) -> Result<(), EntityError> {
        self.matrix.zero();
        for (block, numbers) in blocks.iter().zip(&self.numbers) {
            let size = block.unknowns().len();
            let compute = |range, out: &mut LocalSystems| block.local_systems(view, range, Want::Both, out);
            for begin in (0..block.len()).step_by(BATCH) {
                let range = begin..(begin + BATCH).min(block.len());
                let chunks = evaluate(range.clone(), size, Want::Both, &compute)?;
                for at in range.filter(|&at| block.is_active(at, view)) {
                    let lhs = entity_lhs(&chunks, at - begin, size);
                    let rows = &numbers[at * size..(at + 1) * size];
                    for (i, &row) in rows.iter().enumerate() {
                        for (j, &column) in rows.iter().enumerate() {
                            self.matrix.add(row as usize, column as usize, lhs[i * size + j]);
                        }
                    }
                }
            }
        }
        for &number in &self.lonely {
            let row = number as usize;
            if self.matrix.row(row).1.iter().all(|v| *v == 0.0) {
                self.matrix.add(row, row, diagonal);
            }
        }
        Ok(())
    }
}
