//! The equations of all ranks added up on rank 0, where one direct solver serves them all.

use std::sync::OnceLock;

use rayon::ThreadPool;
use zelus_linear_algebra::{Csr, NotCondensable, System};

use crate::communication::{threads_while_others_wait, world};

/// The three matrices of a system on rank 0; empty on the others.
#[derive(Default)]
pub(super) struct Gathered {
    bulk: GatheredMatrix,
    coupling: GatheredMatrix,
    loads: GatheredMatrix,
    solves: u64,
    /// As many threads as there are on the machine of rank 0, on rank 0.
    threads: OnceLock<Option<ThreadPool>>,
    /// Solves where the rows are, in place of rank 0.
    #[cfg(feature = "petsc")]
    pub(super) petsc: Option<super::owned_rows::OwnedRows>,
}

impl Gathered {
    /// Brings rank 0 up to date with what the ranks have, as far as its stamps have changed; collective.
    pub(super) fn update(&mut self, own: &System<'_>, loads: Option<&Csr>) {
        self.bulk.update(own.bulk, own.bulk_graph, own.bulk_values);
        let none = Csr::empty(own.equations());
        self.coupling.update(own.coupling.unwrap_or(&none), own.coupling_graph, own.coupling_values);
        self.solves += 1;
        if world().any(loads.is_some()) {
            // Which follower loads act may change at any time.
            self.loads.update(loads.unwrap_or(&none), self.solves, self.solves);
        } else {
            self.loads = GatheredMatrix::default();
        }
    }

    /// Does what the other ranks wait for, with the threads of those on this machine.
    pub(super) fn while_others_wait<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let count = threads_while_others_wait();
        if count == rayon::current_num_threads() {
            return work();
        }
        // Without more threads the own ones do the same work.
        let threads = self.threads.get_or_init(|| rayon::ThreadPoolBuilder::new().num_threads(count).build().ok());
        match threads {
            Some(threads) => threads.install(work),
            None => work(),
        }
    }

    /// Why the last solve where the rows are did not condense multipliers that it should have.
    pub(super) fn not_condensed(&self) -> Option<NotCondensable> {
        #[cfg(feature = "petsc")]
        return self.petsc.as_ref().and_then(super::owned_rows::OwnedRows::not_condensed);
        #[cfg(not(feature = "petsc"))]
        None
    }

    /// The whole system, on rank 0, and the tangents of follower loads.
    pub(super) fn system<'a>(&'a self, own: &System<'a>) -> (System<'a>, Option<&'a Csr>) {
        let coupling = (self.coupling.sum.entries() > 0).then_some(&self.coupling.sum);
        let loads = (self.loads.sum.entries() > 0).then_some(&self.loads.sum);
        (System { bulk: &self.bulk.sum, coupling, ..*own }, loads)
    }
}

/// A matrix that is the sum of one matrix a rank.
#[derive(Default)]
struct GatheredMatrix {
    graph: Option<u64>,
    values: Option<u64>,
    sum: Csr,
    /// Place in the sum of each entry of each rank.
    places: Vec<Vec<u32>>,
}

impl GatheredMatrix {
    fn update(&mut self, own: &Csr, graph: u64, values: u64) {
        let new_graph = self.graph != Some(graph);
        if !new_graph && self.values == Some(values) {
            return;
        }
        let world = world();
        if new_graph {
            let starts: Vec<u32> = own.row_starts.iter().map(|&start| start as u32).collect();
            let starts = world.exchange_indices(&to_root(starts));
            let columns = world.exchange_indices(&to_root(own.columns.clone()));
            if world.is_root() {
                self.join(&starts, &columns);
            }
        }
        let counts: Vec<usize> = self.places.iter().map(Vec::len).collect();
        let of_ranks = world.gather_to_root(&own.values, &counts);
        self.sum.zero();
        let places = self.places.iter().flatten();
        places.zip(of_ranks).for_each(|(&place, value)| self.sum.values[place as usize] += value);
        (self.graph, self.values) = (Some(graph), Some(values));
    }

    /// The union of the patterns, and where the entries of each rank are in it.
    fn join(&mut self, starts: &[Vec<u32>], columns: &[Vec<u32>]) {
        let rows = starts[0].len() - 1;
        let row = |rank: usize, row: usize| &columns[rank][starts[rank][row] as usize..starts[rank][row + 1] as usize];
        let mut row_starts = vec![0];
        let mut joined: Vec<u32> = Vec::new();
        self.places = columns.iter().map(|list| Vec::with_capacity(list.len())).collect();
        let mut merged: Vec<u32> = Vec::new();
        for i in 0..rows {
            merged.clear();
            (0..starts.len()).for_each(|rank| merged.extend_from_slice(row(rank, i)));
            merged.sort_unstable();
            merged.dedup();
            for (rank, places) in self.places.iter_mut().enumerate() {
                let mut at = 0;
                for &column in row(rank, i) {
                    while merged[at] != column {
                        at += 1;
                    }
                    places.push((joined.len() + at) as u32);
                }
            }
            joined.extend_from_slice(&merged);
            row_starts.push(joined.len());
        }
        self.sum = Csr::from_sorted_pattern(row_starts, joined);
    }
}

fn to_root<T>(list: Vec<T>) -> Vec<Vec<T>> {
    let mut parts: Vec<Vec<T>> = (0..world().size()).map(|_| Vec::new()).collect();
    parts[0] = list;
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_are_joined() {
        let mut matrix = GatheredMatrix::default();
        matrix.join(&[vec![0, 2, 2], vec![0, 1, 2]], &[vec![0, 1], vec![1, 0]]);
        assert_eq!((&matrix.sum.row_starts[..], &matrix.sum.columns[..]), (&[0, 2, 3][..], &[0, 1, 0][..]));
        assert_eq!(matrix.places, [vec![0, 1], vec![1, 2]]);
    }
}
