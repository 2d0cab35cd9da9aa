//! The matrix of elements on all unknowns, on a pattern that lasts as long as the mesh.

use std::ops::Range;

use rayon::prelude::*;
use zelus_linear_algebra::Csr;

use super::dof_table::{Dof, DofTable};
use super::local::{BATCH, add_rhs, entity_lhs, evaluate, side_by_side};
use super::neighbours::Neighbours;
use super::rows::{ROWS, fill_rows, starts};
use crate::diagnostics::Result;
use crate::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, StepView, Want};

/// Pattern over all unknowns: a row of node `a` holds the bulk unknowns of every node that shares an element with `a`.
///
/// Multipliers have empty rows and columns.
#[derive(Debug, Clone, Default)]
pub struct BulkPattern {
    /// Neighbours of each node, itself included.
    neighbours: Neighbours,
    /// Where the unknowns of each neighbour begin inside a row.
    offsets: Vec<u32>,
    /// First bulk unknown of each node.
    first: Vec<u32>,
    /// The matrix without values.
    pub matrix: Csr,
}

impl BulkPattern {
    /// The pattern of these blocks.
    ///
    /// A node that no block touches has its own unknowns in its rows where `keeps` says so; `groups` are nodes that share
    /// more than elements.
    pub fn new<'a>(
        dofs: &DofTable,
        nodes: usize,
        blocks: impl Iterator<Item = &'a dyn EntityBlock>,
        groups: &[Vec<u32>],
        keeps: impl Fn(usize) -> bool + Sync,
    ) -> Self {
        let mut count = vec![0_u8; nodes];
        let mut first = vec![u32::MAX; nodes];
        for (number, dof) in dofs.dofs().iter().enumerate().filter(|(_, dof)| !dof.multiplier) {
            let node = dof.node as usize;
            first[node] = first[node].min(number as u32);
            count[node] += 1;
        }
        let mut members: Vec<&[u32]> = groups.iter().map(Vec::as_slice).collect();
        members.extend(blocks.flat_map(|block| (0..block.len()).map(|at| block.nodes(at))));
        let neighbours = Neighbours::new(nodes, &members, keeps);
        let width = |node: usize| neighbours.of(node).iter().map(|&b| u32::from(count[b as usize])).sum::<u32>();
        let widths: Vec<u32> = (0..nodes).into_par_iter().with_min_len(ROWS).map(width).collect();
        let mut offsets = vec![0; neighbours.list.len()];
        fill_rows(&neighbours.starts, &mut offsets, |node, offsets| {
            let mut end = 0;
            for (&b, offset) in neighbours.of(node).iter().zip(offsets) {
                *offset = end;
                end += u32::from(count[b as usize]);
            }
        });
        let entries = |dof: &Dof| if dof.multiplier { 0 } else { widths[dof.node as usize] as usize };
        let row_starts = starts(dofs.dofs().iter().map(entries));
        let mut columns = vec![0; row_starts[dofs.len()]];
        fill_rows(&row_starts, &mut columns, |row, columns| {
            let of_node = |&b: &u32| first[b as usize]..first[b as usize].wrapping_add(u32::from(count[b as usize]));
            let numbers = neighbours.of(dofs.dofs()[row].node as usize).iter().flat_map(of_node);
            columns.iter_mut().zip(numbers).for_each(|(column, number)| *column = number);
        });
        let matrix = Csr::without_values(row_starts, columns);
        Self { neighbours, offsets, first, matrix }
    }

    /// Place in a row of `a` where the unknowns of `b` begin.
    fn offset(&self, a: u32, b: u32) -> usize {
        let at = self.neighbours.of(a as usize).binary_search(&b).expect("nodes of one element are neighbours");
        self.offsets[self.neighbours.starts[a as usize] + at] as usize
    }

    /// Place of each unknown of an entity, whose nodes and unknowns these are, in the rows of its local node `of`.
    fn places(&self, nodes: &[u32], unknowns: &[LocalUnknown], numbers: &[u32], of: u8, places: &mut [usize]) {
        let mut known = (u8::MAX, 0);
        for ((unknown, &number), place) in unknowns.iter().zip(numbers).zip(places) {
            let node = nodes[unknown.node as usize];
            if known.0 != unknown.node {
                known = (unknown.node, self.offset(nodes[of as usize], node));
            }
            *place = known.1 + (number - self.first[node as usize]) as usize;
        }
    }

    /// Adds the local matrices of a block to `values`.
    ///
    /// `compute` writes the local systems of a range. Every entry receives its contributions in the order of the
    /// entities, whatever the number of threads.
    ///
    /// # Errors
    /// The first entity that cannot be computed.
    pub fn add(
        &self,
        block: &dyn EntityBlock,
        numbers: &[u32],
        values: &mut [f64],
        compute: &(dyn Fn(Range<usize>, &mut LocalSystems) -> Result<(), EntityError> + Sync),
    ) -> Result<(), EntityError> {
        let unknowns = block.unknowns();
        let size = unknowns.len();
        let mut buffers = Vec::new();
        for begin in (0..block.len()).step_by(BATCH) {
            let range = begin..(begin + BATCH).min(block.len());
            let chunks = &*evaluate(range.clone(), size, Want::Both, compute, &mut buffers)?;
            let touched = numbers[range.start * size..range.end * size].iter().copied();
            side_by_side(&self.matrix.row_starts, values, touched, |rows, base, part| {
                let is_here = |row: u32| rows.contains(&(row as usize));
                // Place of each unknown of an entity in the rows of one of its nodes.
                let mut places = vec![0; size];
                for at in range.clone() {
                    let entity_nodes = block.nodes(at);
                    let numbers = &numbers[at * size..(at + 1) * size];
                    if !numbers.iter().any(|&row| is_here(row)) {
                        continue;
                    }
                    let lhs = entity_lhs(chunks, at - begin);
                    let mut of_node = None;
                    for (i, &row) in numbers.iter().enumerate().filter(|(_, row)| is_here(**row)) {
                        if of_node.replace(unknowns[i].node) != Some(unknowns[i].node) {
                            self.places(entity_nodes, unknowns, numbers, unknowns[i].node, &mut places);
                        }
                        let start = self.matrix.row_starts[row as usize] - base;
                        for (place, value) in places.iter().zip(&lhs[i * size..(i + 1) * size]) {
                            part[start + place] += value;
                        }
                    }
                }
            });
        }
        Ok(())
    }
}

/// Numbers of the unknowns of every entity of a block, `unknowns().len()` each.
///
/// # Panics
/// When the block uses an unknown that was not numbered.
pub fn block_numbers(block: &dyn EntityBlock, dofs: &DofTable) -> Vec<u32> {
    let unknowns = block.unknowns();
    let columns: Vec<&[u32]> = unknowns.iter().map(|u| dofs.numbers(u.variable)).collect();
    let mut out = vec![0; block.len() * unknowns.len()];
    let entities = out.par_chunks_exact_mut(unknowns.len().max(1)).enumerate().with_min_len(ROWS);
    entities.for_each(|(at, out)| {
        let nodes = block.nodes(at);
        let numbers = unknowns.iter().zip(&columns).map(|(u, column)| column[nodes[u.node as usize] as usize]);
        out.iter_mut().zip(numbers).for_each(|(to, number)| *to = number);
    });
    out
}

/// Adds the right-hand sides of a block.
///
/// # Errors
/// The first entity that cannot be computed.
pub fn add_residual(
    block: &dyn EntityBlock,
    numbers: &[u32],
    view: &StepView<'_>,
    want: Want,
    rhs: &mut [f64],
) -> Result<(), EntityError> {
    let size = block.unknowns().len();
    let compute = |range, out: &mut LocalSystems| block.local_systems(view, range, want, out);
    let mut buffers = Vec::new();
    for begin in (0..block.len()).step_by(BATCH) {
        let range = begin..(begin + BATCH).min(block.len());
        let chunks = evaluate(range, size, want, &compute, &mut buffers)?;
        add_rhs(chunks, numbers, begin, size, rhs);
    }
    Ok(())
}
