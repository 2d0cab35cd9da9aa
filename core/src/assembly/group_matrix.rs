//! The matrix of a few blocks that touch few unknowns: loads, contact pairs.

use std::ops::Range;

use zelus_linear_algebra::Csr;

use super::bulk_matrix::block_numbers;
use super::dof_table::DofTable;
use super::local::{each_of_runs, own_runs};
use crate::entities::{EntityBlock, EntityError, StepView, Want};

/// A matrix over all unknowns whose rows are empty except where its blocks act.
#[derive(Debug, Clone, Default)]
pub struct GroupMatrix {
    /// The matrix.
    pub matrix: Csr,
    numbers: Vec<Vec<u32>>,
    /// Entities of each block that are evaluated here.
    runs: Vec<Vec<Range<usize>>>,
    /// Unknowns that only the blocks of the group touch, if any does.
    lonely: Vec<u32>,
}

impl GroupMatrix {
    /// The pattern of these blocks; unknowns of `lonely` that nothing touches get a diagonal entry.
    ///
    /// `is_own` says of the nodes of an entity whether it is evaluated here.
    pub fn new(dofs: &DofTable, blocks: &[&dyn EntityBlock], lonely: &[u32], is_own: impl Fn(&[u32]) -> bool) -> Self {
        let numbers: Vec<Vec<u32>> = blocks.iter().map(|block| block_numbers(*block, dofs)).collect();
        let runs: Vec<Vec<Range<usize>>> =
            blocks.iter().map(|block| own_runs(block.len(), |at| is_own(block.nodes(at)))).collect();
        let mut adjacency = vec![Vec::new(); dofs.len()];
        for ((block, numbers), runs) in blocks.iter().zip(&numbers).zip(&runs) {
            let size = block.unknowns().len();
            for at in runs.iter().flat_map(Clone::clone) {
                let rows = &numbers[at * size..(at + 1) * size];
                for &row in rows {
                    adjacency[row as usize].extend_from_slice(rows);
                }
            }
        }
        lonely.iter().for_each(|&n| adjacency[n as usize].push(n));
        Self { matrix: Csr::from_pattern(&adjacency), numbers, runs, lonely: lonely.to_vec() }
    }

    /// Evaluates the entities of `blocks` and hands on, in their order, the place of each one's block, its place there, its
    /// unknowns and its local system (tangent, right-hand side).
    fn each(
        &self,
        blocks: &[&dyn EntityBlock],
        view: &StepView<'_>,
        want: Want,
        mut add: impl FnMut(usize, usize, &[u32], &[f64], &[f64]),
    ) -> Result<(), EntityError> {
        for (place, ((block, numbers), runs)) in blocks.iter().zip(&self.numbers).zip(&self.runs).enumerate() {
            let size = block.unknowns().len();
            each_of_runs(*block, view, runs, want, |at, lhs, rhs| {
                add(place, at, &numbers[at * size..(at + 1) * size], lhs, rhs);
            })?;
        }
        Ok(())
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
        self.each_residual(blocks, view, |_, _, numbers, local| {
            numbers.iter().zip(local).for_each(|(&number, value)| rhs[number as usize] += value);
        })
    }

    /// Hands on each entity's block and place there, its unknowns and its right-hand side.
    ///
    /// # Errors
    /// The first entity that cannot be computed.
    pub fn each_residual(
        &self,
        blocks: &[&dyn EntityBlock],
        view: &StepView<'_>,
        mut add: impl FnMut(usize, usize, &[u32], &[f64]),
    ) -> Result<(), EntityError> {
        self.each(blocks, view, Want::Residual, |block, at, numbers, _, local| add(block, at, numbers, local))
    }

    /// Recomputes the matrix.
    ///
    /// # Errors
    /// The first entity that cannot be computed.
    pub fn assemble(&mut self, blocks: &[&dyn EntityBlock], view: &StepView<'_>) -> Result<(), EntityError> {
        let mut matrix = std::mem::take(&mut self.matrix);
        matrix.zero();
        let mut places = Vec::new();
        let result = self.each(blocks, view, Want::Both, |block, at, rows, lhs, _| {
            if blocks[block].is_active(at, view) {
                for (i, &row) in rows.iter().enumerate() {
                    let columns = matrix.row(row as usize).0;
                    // Unknowns of a node have rows with the same columns.
                    if i == 0 || columns != matrix.row(rows[i - 1] as usize).0 {
                        find_all(columns, rows, &mut places);
                    }
                    let values = &mut matrix.values[matrix.row_starts[row as usize]..];
                    for (&place, value) in places.iter().zip(&lhs[i * rows.len()..]) {
                        values[place] += value;
                    }
                }
            }
        });
        self.matrix = matrix;
        result
    }

    /// Of each lonely unknown, whether its row has an entry that is not zero.
    pub fn lonely_rows_in_use(&self) -> Vec<bool> {
        self.lonely.iter().map(|&row| self.matrix.row(row as usize).1.iter().any(|v| *v != 0.0)).collect()
    }

    /// Gives each row of a lonely unknown that is not in use its `diagonal`.
    pub fn set_idle_diagonal(
        &mut self,
        in_use: &[bool],
        diagonals: impl Iterator<Item = f64>,
        is_own: impl Fn(usize) -> bool,
    ) {
        for ((&number, in_use), diagonal) in self.lonely.iter().zip(in_use).zip(diagonals) {
            let row = number as usize;
            if !in_use && is_own(row) {
                self.matrix.add(row, row, diagonal);
            }
        }
    }
}

/// Places of `wanted` among ascending `columns`, which hold them all.
fn find_all(columns: &[u32], wanted: &[u32], places: &mut Vec<usize>) {
    places.clear();
    for &column in wanted {
        let next = places.last().map_or(0, |place| place + 1);
        let place = match columns.get(next) {
            Some(&follows) if follows == column => next,
            _ => columns.binary_search(&column).expect("the pattern holds all entities"),
        };
        places.push(place);
    }
}
