//! The matrix of a few blocks that touch few unknowns: loads, contact pairs.

use std::ops::Range;

use zelus_linear_algebra::Csr;

use super::bulk_matrix::block_numbers;
use super::dof_table::DofTable;
use super::local::{batches_of_runs, each_of_runs, own_runs, side_by_side};
use super::neighbours::Neighbours;
use crate::entities::{EntityBlock, EntityError, Request, StepView};

/// A matrix over all unknowns whose rows are empty except where its blocks act.
#[derive(Debug, Clone, Default)]
pub struct GroupMatrix {
    /// The matrix.
    pub matrix: Csr,
    numbers: Vec<Vec<u32>>,
    /// Entities of each block that are evaluated here.
    runs: Vec<Vec<Range<usize>>>,
    /// Unknowns that only the blocks of the group touch, if any does.
    multipliers: Vec<u32>,
}

impl GroupMatrix {
    /// The pattern of these blocks; unknowns of `multipliers` that nothing touches get a diagonal entry.
    ///
    /// `is_own` says of the nodes of an entity whether it is evaluated here.
    pub fn new(
        dofs: &DofTable,
        blocks: &[&dyn EntityBlock],
        multipliers: &[u32],
        is_own: impl Fn(&[u32]) -> bool,
    ) -> Self {
        let numbers: Vec<Vec<u32>> = blocks.iter().map(|block| block_numbers(*block, dofs)).collect();
        let runs: Vec<Vec<Range<usize>>> =
            blocks.iter().map(|block| own_runs(block.len(), |at| is_own(block.nodes(at)))).collect();
        let mut groups: Vec<&[u32]> = multipliers.chunks_exact(1).collect();
        for ((block, numbers), runs) in blocks.iter().zip(&numbers).zip(&runs) {
            let size = block.unknowns().len();
            groups.extend(runs.iter().flat_map(Clone::clone).map(|at| &numbers[at * size..(at + 1) * size]));
        }
        let Neighbours { starts, list } = Neighbours::new(dofs.len(), &groups, |_| false);
        Self { matrix: Csr::from_sorted_pattern(starts, list), numbers, runs, multipliers: multipliers.to_vec() }
    }

    /// Evaluates the entities of `blocks` and hands on, in their order, the place of each one's block, its place there, its
    /// unknowns and its local system (tangent, right-hand side).
    fn each(
        &self,
        blocks: &[&dyn EntityBlock],
        view: &StepView<'_>,
        request: Request,
        mut add: impl FnMut(usize, usize, &[u32], &[f64], &[f64]),
    ) -> Result<(), EntityError> {
        for (place, ((block, numbers), runs)) in blocks.iter().zip(&self.numbers).zip(&self.runs).enumerate() {
            let size = block.unknowns().len();
            each_of_runs(*block, view, runs, request, |at, lhs, rhs| {
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
        self.each(blocks, view, Request::Residual, |block, at, numbers, _, local| add(block, at, numbers, local))
    }

    /// Recomputes the matrix.
    ///
    /// # Errors
    /// The first entity that cannot be computed.
    pub fn assemble(&mut self, blocks: &[&dyn EntityBlock], view: &StepView<'_>) -> Result<(), EntityError> {
        let Self { matrix, numbers, runs, .. } = self;
        matrix.zero();
        let Csr { row_starts, columns, values, .. } = matrix;
        let columns_of = |row: u32| &columns[row_starts[row as usize]..row_starts[row as usize + 1]];
        for ((block, numbers), runs) in blocks.iter().zip(numbers).zip(runs) {
            let size = block.unknowns().len();
            let columns_of_entity = |at: usize| &numbers[at * size..(at + 1) * size];
            let rows_of = |at: usize| &columns_of_entity(at)[..block.equations()];
            batches_of_runs(*block, view, runs, Request::Both, |batch| {
                let active = || batch.iter().filter(|(at, ..)| block.is_active(*at, view));
                let touched = active().flat_map(|(at, ..)| rows_of(*at)).copied();
                side_by_side(row_starts, values, touched, |here, base, values| {
                    let mut places = Vec::new();
                    for &(at, lhs, _) in active() {
                        let (rows, wanted) = (rows_of(at), columns_of_entity(at));
                        let mut known: &[u32] = &[];
                        for (i, &row) in rows.iter().enumerate().filter(|(_, row)| here.contains(&(**row as usize))) {
                            let columns = columns_of(row);
                            // Unknowns of a node have rows with the same columns.
                            if columns != known {
                                find_all(columns, wanted, &mut places);
                                known = columns;
                            }
                            let values = &mut values[row_starts[row as usize] - base..];
                            for (&place, value) in places.iter().zip(&lhs[i * size..]) {
                                values[place] += value;
                            }
                        }
                    }
                });
            })?;
        }
        Ok(())
    }

    /// The matrix, where an entry is not zero.
    pub fn nonzero(&self) -> Option<&Csr> {
        Some(&self.matrix).filter(|matrix| matrix.values.iter().any(|v| *v != 0.0))
    }

    /// For each inactive unknown, whether its row has a nonzero entry.
    pub fn lonely_rows_in_use(&self) -> Vec<bool> {
        self.multipliers.iter().map(|&row| self.matrix.row(row as usize).1.iter().any(|v| *v != 0.0)).collect()
    }

    /// Sets the `diagonal` of each row of an inactive unknown that is not in use.
    pub fn set_idle_diagonal(
        &mut self,
        in_use: &[bool],
        diagonals: impl Iterator<Item = f64>,
        is_own: impl Fn(usize) -> bool,
    ) {
        for ((&number, in_use), diagonal) in self.multipliers.iter().zip(in_use).zip(diagonals) {
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
