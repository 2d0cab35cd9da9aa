//! The equations of all ranks added up on rank 0, where one direct solver serves them all.
//!
//! There they stand in the order in which one rank would count them, so that its solution is that of one rank.

use std::sync::OnceLock;

use zelus_linear_algebra::parallel::{self, ThreadPool};
use zelus_linear_algebra::{Csr, Layout, NotCondensable, System};

use super::distributed_rows::DistributedRows;
use super::dof_name::DofName;
use crate::assembly::{Assembler, DofPosition, DofTable, Numbering, near_null_space};
use crate::communication::{Ranks, threads_while_others_wait};
use crate::model::Nodes;

/// The three matrices of a system on rank 0; empty on the others.
#[derive(Default)]
pub(super) struct RootGather {
    whole: AllEquations,
    bulk: RootMatrix,
    coupling: RootMatrix,
    loads: RootMatrix,
    solves: u64,
    /// As many threads as there are on the machine of rank 0, on rank 0.
    threads: OnceLock<Option<ThreadPool>>,
    /// Distributed rows, for solvers that use them in place of rank 0.
    pub(super) shared: DistributedRows,
    /// Solves where the rows are, in place of rank 0.
    #[cfg(feature = "petsc")]
    pub(super) petsc: Option<super::petsc_rows::PetscRows>,
}

/// Flag in the stamps of graphs gathered here, which tells them from graphs of one rank.
const GATHERED: u64 = 1 << 32;

/// Numbers that describe an equation: place of its node, name, position.
const NUMBERS: usize = 8;

/// All equations on rank 0.
#[derive(Default)]
struct AllEquations {
    graph: Option<u64>,
    /// Place here of each equation, by its number over all ranks.
    places: Vec<u32>,
    layout: Layout,
    dof_names: Vec<DofName>,
}

impl AllEquations {
    /// Puts the equations of all ranks in the order of their nodes; collective.
    fn lay_out(&mut self, assembler: &Assembler, numbering: &Numbering, dofs: &DofTable, nodes: &Nodes) {
        let unknowns = assembler.equations().unknowns();
        let row = |&equation: &u32| {
            let number = unknowns[equation as usize];
            let place = assembler.distribution().map_or(0, |distribution| distribution.place(number as usize));
            let [variable, node, multiplier, set] = DofName::of(dofs, nodes, number).pack(dofs);
            let [x, y, z] = nodes.initial[dofs.dofs()[number as usize].node as usize];
            [f64::from(place), variable, node, multiplier, set, x, y, z]
        };
        let own: Vec<f64> = numbering.own.iter().flat_map(row).collect();
        let counts: Vec<usize> = numbering.counts().iter().map(|count| NUMBERS * count).collect();
        let rows = assembler.ranks().gather_to_root(&own, &counts);
        let rows: Vec<&[f64]> = rows.chunks_exact(NUMBERS).collect();
        let mut order: Vec<u32> = (0..rows.len() as u32).collect();
        // Equations of a node stand together already, in their order.
        order.sort_by_key(|&number| rows[number as usize][0] as u32);
        self.places = vec![0; rows.len()];
        order.iter().enumerate().for_each(|(place, &number)| self.places[number as usize] = place as u32);
        let sorted = || order.iter().map(|&number| rows[number as usize]);
        self.dof_names = sorted().filter_map(|row| DofName::unpack(&row[1..5], dofs)).collect();
        let positions = sorted().map(|row| [row[5], row[6], row[7]]);
        let place = |(dof_name, at): (&DofName, _)| (!dof_name.multiplier).then_some((dof_name.variable, at));
        let places: Vec<DofPosition> = self.dof_names.iter().zip(positions).map(place).collect();
        self.layout = Layout {
            node: sorted().map(|row| row[0] as u32).collect(),
            multiplier: self.dof_names.iter().map(|dof_name| dof_name.multiplier).collect(),
            near_null_space: near_null_space(&places),
            ..Layout::default()
        };
    }
}

impl RootGather {
    /// Whether PETSc solves.
    pub(super) fn has_petsc(&self) -> bool {
        #[cfg(feature = "petsc")]
        return self.petsc.is_some();
        #[cfg(not(feature = "petsc"))]
        false
    }

    /// Brings rank 0 up to date with the data of the ranks, as far as its stamps have changed; collective.
    pub(super) fn update(&mut self, assembler: &Assembler, loads: Option<&Csr>, dofs: &DofTable, nodes: &Nodes) {
        let (ranks, own) = (assembler.ranks(), assembler.system());
        let Some(numbering) = assembler.numbering() else { return };
        if self.whole.graph != Some(own.bulk_graph) {
            self.whole.lay_out(assembler, numbering, dofs, nodes);
            self.whole.graph = Some(own.bulk_graph);
            (self.bulk, self.coupling, self.loads) = Default::default();
        }
        let places = &self.whole.places;
        self.bulk.update(ranks, own.bulk, numbering, places, own.bulk_graph, own.bulk_values);
        let none = Csr::empty(own.equations());
        let coupling = own.coupling.unwrap_or(&none);
        self.coupling.update(ranks, coupling, numbering, places, own.coupling_graph, own.coupling_values);
        self.solves += 1;
        if ranks.any(loads.is_some()) {
            // Which follower loads act may change at any time.
            self.loads.update(ranks, loads.unwrap_or(&none), numbering, places, self.solves, self.solves);
        } else {
            self.loads = RootMatrix::default();
        }
    }

    /// The vector of all equations on rank 0, from one over those of each rank; collective.
    pub(super) fn gather(&self, ranks: &Ranks, own: &[f64], numbering: &Numbering) -> Vec<f64> {
        let all = ranks.gather_to_root(&numbering.own_of(own), &numbering.counts());
        let mut out = vec![0.0; all.len()];
        self.whole.places.iter().zip(all).for_each(|(&place, value)| out[place as usize] = value);
        out
    }

    /// Gives every rank its own entries of a vector that rank 0 has; collective.
    pub(super) fn scatter(&self, ranks: &Ranks, whole: &[f64], numbering: &Numbering) -> Vec<f64> {
        let of = |number: usize| whole[self.whole.places[number] as usize];
        let parts: Vec<Vec<f64>> = match ranks.is_root() {
            true => numbering.starts.windows(2).map(|range| (range[0]..range[1]).map(of).collect()).collect(),
            false => vec![Vec::new(); ranks.size()],
        };
        ranks.exchange_numbers(&parts).swap_remove(0)
    }

    /// Runs the work that the other ranks wait for, with the threads of those on this machine.
    pub(super) fn while_others_wait<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let count = threads_while_others_wait();
        if count == parallel::threads() {
            return work();
        }
        // Without more threads the own ones do the same work.
        let threads = self.threads.get_or_init(|| ThreadPool::new(count).ok());
        match threads {
            Some(threads) => threads.run(work),
            None => work(),
        }
    }

    /// Why the last solve where the rows are did not condense multipliers that it should have.
    pub(super) fn not_condensed(&self) -> Option<NotCondensable> {
        #[cfg(feature = "petsc")]
        return self.petsc.as_ref().and_then(super::petsc_rows::PetscRows::not_condensed);
        #[cfg(not(feature = "petsc"))]
        None
    }

    /// Names of the equations, on rank 0.
    pub(super) fn dof_names(&self) -> &[DofName] {
        &self.whole.dof_names
    }

    /// Name of an equation that [`RootGather::not_condensed`] or the solver of rank 0 names.
    pub(super) fn dof_name(&self, equation: usize) -> Option<DofName> {
        #[cfg(feature = "petsc")]
        if let Some(rows) = &self.petsc {
            return rows.dof_name(equation);
        }
        self.whole.dof_names.get(equation).copied()
    }

    /// The whole system, on rank 0, and the tangents of follower loads. Its stamps are not those of the shared systems.
    pub(super) fn system<'a>(&'a self, own: &System<'a>) -> (System<'a>, Option<&'a Csr>) {
        let coupling = (self.coupling.sum.entries() > 0).then_some(&self.coupling.sum);
        let loads = (self.loads.sum.entries() > 0).then_some(&self.loads.sum);
        let bulk_graph = own.bulk_graph + GATHERED;
        (System { layout: &self.whole.layout, bulk: &self.bulk.sum, bulk_graph, coupling, ..*own }, loads)
    }
}

/// A matrix that is the sum of one matrix a rank.
#[derive(Default)]
struct RootMatrix {
    graph: Option<u64>,
    values: Option<u64>,
    sum: Csr,
    /// Place in the sum of each entry of each rank.
    places: Vec<Vec<u32>>,
}

impl RootMatrix {
    /// `places` says where each equation is on rank 0, by its number.
    fn update(&mut self, ranks: &Ranks, own: &Csr, numbering: &Numbering, places: &[u32], graph: u64, values: u64) {
        let new_graph = self.graph != Some(graph);
        if !new_graph && self.values == Some(values) {
            return;
        }
        if new_graph {
            // Each row with entries: its number and how many it has.
            let counts = own.row_starts.windows(2).map(|pair| (pair[1] - pair[0]) as u32);
            let rows = numbering.numbers.iter().zip(counts).filter(|(_, count)| *count > 0);
            let rows: Vec<u32> = rows.flat_map(|(&number, count)| [number, count]).collect();
            let columns: Vec<u32> = own.columns_of_entries().map(|column| numbering.numbers[column as usize]).collect();
            let rows = ranks.exchange_indices(&ranks.for_root(rows));
            let columns = ranks.exchange_indices(&ranks.for_root(columns));
            if ranks.is_root() {
                self.join(&rows, &columns, places);
            }
        }
        let counts: Vec<usize> = self.places.iter().map(Vec::len).collect();
        let of_ranks = ranks.gather_to_root(&own.values, &counts);
        self.sum.zero();
        let entries = self.places.iter().flatten();
        entries.zip(of_ranks).for_each(|(&entry, value)| self.sum.values[entry as usize] += value);
        (self.graph, self.values) = (Some(graph), Some(values));
    }

    /// The union of the patterns, and where the entries of each rank are in it.
    ///
    /// A rank has its rows, and the columns of a row, in the order of the places here.
    fn join(&mut self, rows: &[Vec<u32>], columns: &[Vec<u32>], places: &[u32]) {
        let place = |number: &u32| places[*number as usize];
        let mut row_starts = vec![0];
        let mut joined: Vec<u32> = Vec::new();
        self.places = columns.iter().map(|list| Vec::with_capacity(list.len())).collect();
        let mut rest: Vec<(&[u32], &[u32])> = rows.iter().zip(columns).map(|(r, c)| (&r[..], &c[..])).collect();
        let mut merged: Vec<u32> = Vec::new();
        let mut found: Vec<(usize, &[u32])> = Vec::new();
        for row in 0..places.len() as u32 {
            found.clear();
            merged.clear();
            for (rank, (rows, columns)) in rest.iter_mut().enumerate() {
                if let [number, count, others @ ..] = rows
                    && place(number) == row
                {
                    let (own, of_others) = columns.split_at(*count as usize);
                    (*rows, *columns) = (others, of_others);
                    merged.extend(own.iter().map(place));
                    found.push((rank, own));
                }
            }
            merged.sort_unstable();
            merged.dedup();
            for (rank, own) in &found {
                let mut at = 0;
                for column in own.iter().map(place) {
                    while merged[at] != column {
                        at += 1;
                    }
                    self.places[*rank].push((joined.len() + at) as u32);
                }
            }
            joined.extend_from_slice(&merged);
            row_starts.push(joined.len());
        }
        self.sum = Csr::from_sorted_pattern(row_starts, joined);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_are_joined_in_the_order_of_one_process() {
        let mut matrix = RootMatrix::default();
        // Equation 0 of rank 0 comes second, equation 1, of rank 1, first.
        matrix.join(&[vec![0, 1], vec![1, 1, 0, 2]], &[vec![0], vec![1, 1, 0]], &[1, 0]);
        assert_eq!((&matrix.sum.row_starts[..], &matrix.sum.columns[..]), (&[0, 1, 3][..], &[0, 0, 1][..]));
        assert_eq!(matrix.places, [vec![2], vec![0, 1, 2]]);
    }
}
