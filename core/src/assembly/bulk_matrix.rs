//! The matrix of elements on all unknowns, on a pattern that lasts as long as the mesh.

use rayon::prelude::*;
use zelus_linear_algebra::Csr;

use super::dof_table::DofTable;
use super::local::{BATCH, evaluate};
use crate::diagnostics::Result;
use crate::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, StepView, Want};

/// Row ranges that are filled side by side; fixed, so that results do not depend on the number of threads.
const ROW_PARTS: usize = 4;

/// Pattern over all unknowns: a row of node `a` holds the bulk unknowns of every node that shares an element with `a`.
///
/// Multipliers have empty rows and columns.
#[derive(Debug, Clone, Default)]
pub struct BulkPattern {
    /// Neighbours of each node, ascending, itself included: starts and list.
    starts: Vec<usize>,
    neighbours: Vec<u32>,
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
        keeps: impl Fn(usize) -> bool,
    ) -> Self {
        let mut count = vec![0_u8; nodes];
        let mut first = vec![u32::MAX; nodes];
        for (number, dof) in dofs.dofs().iter().enumerate().filter(|(_, dof)| !dof.multiplier) {
            let node = dof.node as usize;
            first[node] = first[node].min(number as u32);
            count[node] += 1;
        }
        let mut lists: Vec<Vec<u32>> =
            (0..nodes as u32).map(|n| if keeps(n as usize) { vec![n] } else { Vec::new() }).collect();
        for block in blocks {
            for at in 0..block.len() {
                let members = block.nodes(at);
                for &a in members {
                    lists[a as usize].extend_from_slice(members);
                }
            }
        }
        for group in groups {
            group.iter().for_each(|&a| lists[a as usize].extend_from_slice(group));
        }
        lists.par_iter_mut().with_min_len(256).for_each(|list| {
            list.sort_unstable();
            list.dedup();
        });
        let mut starts = vec![0];
        let mut neighbours = Vec::new();
        let mut offsets = Vec::new();
        for list in &lists {
            let mut offset = 0;
            for &b in list {
                neighbours.push(b);
                offsets.push(offset);
                offset += u32::from(count[b as usize]);
            }
            starts.push(neighbours.len());
        }
        let bulk = || dofs.dofs().iter().filter(|dof| !dof.multiplier).map(|dof| dof.node as usize);
        let entries =
            |node: usize| neighbours[starts[node]..starts[node + 1]].iter().map(|&b| count[b as usize] as usize);
        let mut row_starts = vec![0];
        let mut columns = Vec::with_capacity(bulk().flat_map(entries).sum());
        for dof in dofs.dofs() {
            if !dof.multiplier {
                let node = dof.node as usize;
                for &b in &neighbours[starts[node]..starts[node + 1]] {
                    let b = b as usize;
                    columns.extend(first[b]..first[b].wrapping_add(u32::from(count[b])));
                }
            }
            row_starts.push(columns.len());
        }
        let matrix = Csr::without_values(row_starts, columns);
        Self { starts, neighbours, offsets, first, matrix }
    }

    /// Place in a row of `a` where the unknowns of `b` begin.
    fn offset(&self, a: u32, b: u32) -> usize {
        let range = self.starts[a as usize]..self.starts[a as usize + 1];
        let at = self.neighbours[range.clone()].binary_search(&b).expect("nodes of one element are neighbours");
        self.offsets[range.start + at] as usize
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
        compute: &(dyn Fn(std::ops::Range<usize>, &mut LocalSystems) -> Result<(), EntityError> + Sync),
    ) -> Result<(), EntityError> {
        let unknowns = block.unknowns();
        let size = unknowns.len();
        let rows = self.matrix.rows;
        let bounds: Vec<usize> = (0..=ROW_PARTS).map(|part| rows * part / ROW_PARTS).collect();
        for begin in (0..block.len()).step_by(BATCH) {
            let range = begin..(begin + BATCH).min(block.len());
            let chunks = evaluate(range.clone(), size, Want::Both, compute)?;
            let mut parts: Vec<(usize, usize, &mut [f64])> = Vec::with_capacity(ROW_PARTS);
            let mut rest = &mut *values;
            for pair in bounds.windows(2) {
                let length = self.matrix.row_starts[pair[1]] - self.matrix.row_starts[pair[0]];
                let (head, tail) = rest.split_at_mut(length);
                parts.push((pair[0], pair[1], head));
                rest = tail;
            }
            parts.into_par_iter().for_each(|(first_row, last_row, part)| {
                let is_here = |row: u32| (first_row..last_row).contains(&(row as usize));
                let base = self.matrix.row_starts[first_row];
                // Place of each unknown of an entity in the rows of one of its nodes.
                let mut places = vec![0; size];
                for at in range.clone() {
                    let entity_nodes = block.nodes(at);
                    let numbers = &numbers[at * size..(at + 1) * size];
                    if !numbers.iter().any(|&row| is_here(row)) {
                        continue;
                    }
                    let lhs = super::local::entity_lhs(&chunks, at - begin, size);
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
    let mut out = Vec::with_capacity(block.len() * unknowns.len());
    for at in 0..block.len() {
        let nodes = block.nodes(at);
        out.extend(unknowns.iter().zip(&columns).map(|(u, column)| column[nodes[u.node as usize] as usize]));
    }
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
    for begin in (0..block.len()).step_by(BATCH) {
        let range = begin..(begin + BATCH).min(block.len());
        let chunks = evaluate(range, size, want, &compute)?;
        super::local::add_rhs(&chunks, numbers, begin, size, rhs);
    }
    Ok(())
}
