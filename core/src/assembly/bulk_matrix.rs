//! The matrix of elements on all unknowns, on a pattern that lasts as long as the mesh.

use std::ops::Range;

use zelus_linear_algebra::prefetch::prefetch_as_many;
use zelus_linear_algebra::{Csr, parallel};

use super::dof_table::{Dof, DofTable};
use super::local::{BATCH, add_rhs, entity_lhs, evaluate, side_by_side};
use super::neighbours::Neighbours;
use super::rows::{ROWS, fill_rows, starts};
use crate::diagnostics::Result;
use crate::entities::{EntityBlock, EntityError, LocalOwner, LocalSystems, LocalUnknown, Request, StepView};
use crate::model::Owner;

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

/// An entity whose local matrix is added.
struct Entity<'a> {
    nodes: &'a [u32],
    unknowns: &'a [LocalUnknown],
    /// Numbers of its unknowns.
    numbers: &'a [u32],
}

/// Unknowns of one node of an entity that stand side by side in every row.
struct AdjacentDofs {
    /// The first of them in the entity.
    first: usize,
    length: usize,
    /// Where they begin in a row.
    place: usize,
}

impl Entity<'_> {
    /// Sets `runs` to those of the entity, without their places.
    fn find_runs(&self, runs: &mut Vec<AdjacentDofs>) {
        runs.clear();
        for at in 0..self.numbers.len() {
            let follows =
                |i: usize| self.unknowns[i].node == self.unknowns[at].node && self.numbers[i] + 1 == self.numbers[at];
            match runs.last_mut().filter(|_| follows(at - 1)) {
                Some(run) => run.length += 1,
                None => runs.push(AdjacentDofs { first: at, length: 1, place: 0 }),
            }
        }
    }
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
        let widths: Vec<u32> = parallel::map(nodes, ROWS, width);
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
        // Unknowns of a node have the same columns.
        let of_nodes = starts(widths.iter().zip(&count).map(|(&w, &count)| if count > 0 { w as usize } else { 0 }));
        let mut columns = vec![0; of_nodes[nodes]];
        fill_rows(&of_nodes, &mut columns, |node, columns| {
            let of_node = |&b: &u32| first[b as usize]..first[b as usize].wrapping_add(u32::from(count[b as usize]));
            let numbers = neighbours.of(node).iter().flat_map(of_node);
            columns.iter_mut().zip(numbers).for_each(|(column, number)| *column = number);
        });
        let column_starts = dofs.dofs().iter().map(|dof| of_nodes[dof.node as usize]).collect();
        let matrix = Csr::with_shared_columns(row_starts, columns, column_starts);
        Self { neighbours, offsets, first, matrix }
    }

    /// Place in a row of `a` where the unknowns of `b` begin.
    fn offset(&self, a: u32, b: u32) -> usize {
        let at = self.neighbours.of(a as usize).binary_search(&b).expect("nodes of one element are neighbours");
        self.offsets[self.neighbours.starts[a as usize] + at] as usize
    }

    /// Place of an unknown of an entity in rows of node `a`.
    fn place(&self, a: u32, entity: &Entity<'_>, unknown: usize) -> usize {
        let node = entity.nodes[entity.unknowns[unknown].node as usize];
        self.offset(a, node) + (entity.numbers[unknown] - self.first[node as usize]) as usize
    }

    /// Adds the local matrix of an entity with these runs to the `part` of the values that holds some rows, whose first entry is at `base`.
    fn add_entity(
        &self,
        entity: &Entity<'_>,
        runs: &mut [AdjacentDofs],
        lhs: &[f64],
        rows: &Range<usize>,
        base: usize,
        part: &mut [f64],
    ) {
        let mut of_node = None;
        let lines = entity.numbers.iter().zip(entity.unknowns).zip(lhs.chunks_exact(entity.numbers.len()));
        for ((&row, unknown), line) in lines.filter(|((row, _), _)| rows.contains(&(**row as usize))) {
            let node = entity.nodes[unknown.node as usize];
            if of_node.replace(node) != Some(node) {
                runs.iter_mut().for_each(|run| run.place = self.place(node, entity, run.first));
            }
            let sums = &mut part[self.matrix.row_starts[row as usize] - base..];
            for &AdjacentDofs { first, length, place } in &*runs {
                let (sums, values) = (&mut sums[place..place + length], &line[first..first + length]);
                // A length that is known makes no loop.
                match (<&mut [f64; 3]>::try_from(&mut *sums), <&[f64; 3]>::try_from(values)) {
                    (Ok(sums), Ok(values)) => (0..3).for_each(|i| sums[i] += values[i]),
                    _ => sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value),
                }
            }
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
        let starts = &self.matrix.row_starts[..];
        let numbers_of = |at: usize| &numbers[at * size..(at + 1) * size];
        let mut buffers = Vec::new();
        for begin in (0..block.len()).step_by(BATCH) {
            let range = begin..(begin + BATCH).min(block.len());
            let chunks = &*evaluate(range.clone(), size, Request::Both, compute, &mut buffers)?;
            // Rows of each entity, from the first to the last.
            let reach = |at| numbers_of(at).iter().fold([u32::MAX, 0], |[a, b], &n| [a.min(n), b.max(n)]);
            let reaches: Vec<[u32; 2]> = range.clone().map(reach).collect();
            // One without unknowns reaches none.
            let touched = reaches.iter().filter(|[first, last]| first <= last).flatten().copied();
            side_by_side(starts, values, touched, |rows, base, part| {
                let mut runs = Vec::new();
                let is_near = |[first, last]: [u32; 2]| rows.start <= last as usize && (first as usize) < rows.end;
                for at in range.clone().filter(|at| is_near(reaches[at - begin])) {
                    // Rows of the next entity are on their way while this one is added.
                    if at + 1 < range.end {
                        let next = numbers_of(at + 1).iter().map(|row| *row as usize).filter(|row| rows.contains(row));
                        next.for_each(|row| prefetch_as_many(&part[starts[row] - base..starts[row + 1] - base], 0));
                    }
                    let entity = Entity { nodes: block.nodes(at), unknowns, numbers: numbers_of(at) };
                    entity.find_runs(&mut runs);
                    self.add_entity(&entity, &mut runs, entity_lhs(chunks, at - begin), &rows, base, part);
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
    let numbers = |u: &LocalUnknown| match u.owner {
        LocalOwner::Node => dofs.numbers(u.variable),
        LocalOwner::Slave(_) => dofs.slave_numbers(u.variable),
    };
    let columns: Vec<&[u32]> = unknowns.iter().map(numbers).collect();
    let mut out = vec![0; block.len() * unknowns.len()];
    parallel::groups_mut(&mut out, unknowns.len(), ROWS, |at, out| {
        let (nodes, slaves) = (block.nodes(at), block.slave_owners(at));
        let numbers = unknowns.iter().zip(&columns).map(|(u, column)| {
            let (Owner::Node(index) | Owner::Slave(index)) = u.owner_among(nodes, slaves);
            column[index as usize]
        });
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
    request: Request,
    rhs: &mut [f64],
) -> Result<(), EntityError> {
    let size = block.unknowns().len();
    let compute = |range, out: &mut LocalSystems| block.local_systems(view, range, request, out);
    let mut buffers = Vec::new();
    for begin in (0..block.len()).step_by(BATCH) {
        let range = begin..(begin + BATCH).min(block.len());
        let chunks = evaluate(range, size, request, &compute, &mut buffers)?;
        add_rhs(chunks, numbers, begin, size, rhs);
    }
    Ok(())
}
