//! Exchange between ranks that share a level of multigrid: rows of the prolongation, and rows of the coarse matrix that are made where
//! others own them.

use std::collections::BTreeMap;

use super::aggregation::{NONE, Tentative};
use super::block_matrix::BlockMatrix;
use crate::ghosts::{Ghosts, Owned, Ranks};

/// Aggregates as one rank counts them: its own, then those of others as it meets them.
pub(super) struct Aggregates {
    rank: u32,
    own: usize,
    others: Vec<Owned>,
    at: BTreeMap<Owned, u32>,
}

/// Block rows on their way: columns and entries of each.
type Rows = Vec<(Vec<u32>, Vec<f32>)>;

impl Aggregates {
    /// The own ones of a rank.
    pub(super) fn new(ghosts: &Ghosts, own: usize) -> Self {
        let rank = ghosts.ranks().map_or(0, |ranks| ranks.rank() as u32);
        Self { rank, own, others: Vec::new(), at: BTreeMap::new() }
    }

    /// Number of aggregates met so far.
    pub(super) fn all(&self) -> usize {
        self.own + self.others.len()
    }

    /// Number here of an aggregate.
    fn number(&mut self, name: Owned) -> u32 {
        if name.0 == self.rank {
            return name.1;
        }
        let next = self.all() as u32;
        *self.at.entry(name).or_insert_with(|| {
            self.others.push(name);
            next
        })
    }

    /// Name among all ranks of an aggregate by its number here.
    fn name(&self, number: u32) -> Owned {
        match (number as usize).checked_sub(self.own) {
            None => (self.rank, number),
            Some(at) => self.others[at],
        }
    }

    /// Appends the tentative prolongation of ghosts, of `wide` entries a block; collective.
    pub(super) fn complete(&mut self, ghosts: &Ghosts, tentative: &mut Tentative, wide: usize) {
        let Some(ranks) = ghosts.ranks() else { return };
        let message = |list: &Vec<u32>| -> Vec<f64> {
            let block = |&at: &u32| {
                let (aggregate, start) = (tentative.aggregate[at as usize], at as usize * wide);
                let named = if aggregate == NONE { -1.0 } else { f64::from(aggregate) };
                std::iter::once(named).chain(tentative.values[start..start + wide].iter().map(|&v| f64::from(v)))
            };
            list.iter().flat_map(block).collect()
        };
        let arrived = ranks.exchange_numbers(&ghosts.sent().iter().map(message).collect::<Vec<_>>());
        tentative.aggregate.resize(ghosts.all(), NONE);
        tentative.values.resize(ghosts.all() * wide, 0.0);
        for (owner, (list, arrived)) in ghosts.received().iter().zip(arrived).enumerate() {
            for (&at, block) in list.iter().zip(arrived.chunks_exact(wide + 1)) {
                if block[0] >= 0.0 {
                    tentative.aggregate[at as usize] = self.number((owner as u32, block[0] as u32));
                }
                let values = &mut tentative.values[at as usize * wide..(at as usize + 1) * wide];
                values.iter_mut().zip(&block[1..]).for_each(|(to, &value)| *to = value as f32);
            }
        }
    }

    /// `Pᵀ A P` of all ranks, the rows of own aggregates, and who owns its columns; collective.
    pub(super) fn product(
        mut self,
        ghosts: &Ghosts,
        matrix: &BlockMatrix,
        prolongation: &mut BlockMatrix,
        restriction: &mut BlockMatrix,
    ) -> (BlockMatrix, Ghosts) {
        let Some(ranks) = ghosts.ranks() else {
            return (restriction.times_product(matrix, prolongation), Ghosts::none(self.own));
        };
        let ranks = ranks.as_ref();
        let rows =
            ghosts.sent().iter().map(|list| list.iter().map(|&at| (None, prolongation.row(at as usize))).collect());
        let arrived = self.exchange(ranks, rows.collect(), prolongation.size());
        let mut of_ghosts: Rows = vec![Default::default(); ghosts.all() - ghosts.own()];
        for (list, arrived) in ghosts.received().iter().zip(arrived) {
            list.iter().zip(arrived).for_each(|(&at, (_, row))| of_ghosts[at as usize - ghosts.own()] = row);
        }
        let shape = [prolongation.height, prolongation.width];
        let whole = BlockMatrix::from_rows([ghosts.all(), self.all()], shape, |i, row| {
            let (columns, values) = match i.checked_sub(ghosts.own()) {
                None => prolongation.row(i),
                Some(at) => (&of_ghosts[at].0[..], &of_ghosts[at].1[..]),
            };
            for (&j, block) in columns.iter().zip(values.chunks_exact(shape[0] * shape[1])) {
                row.block(j).copy_from_slice(block);
            }
        });
        restriction.add_rows(self.all());
        let here = restriction.times_product(matrix, &whole);
        drop(whole);
        let mut sent = vec![Vec::new(); ranks.size()];
        for (at, &(owner, item)) in self.others.iter().enumerate() {
            sent[owner as usize].push((Some(item), here.row(self.own + at)));
        }
        let arrived = self.exchange(ranks, sent, here.size());
        let mut added: Vec<Rows> = vec![Vec::new(); self.own];
        for (item, row) in arrived.into_iter().flatten() {
            added[item as usize].push(row);
        }
        let size = here.size();
        let next = BlockMatrix::from_rows([self.own, self.all()], [here.height; 2], |i, row| {
            let others = added[i].iter().map(|(columns, values)| (&columns[..], &values[..]));
            for (columns, values) in std::iter::once(here.row(i)).chain(others) {
                for (&j, block) in columns.iter().zip(values.chunks_exact(size)) {
                    row.block(j).iter_mut().zip(block).for_each(|(sum, value)| *sum += value);
                }
            }
        });
        restriction.add_rows(self.all());
        prolongation.columns = self.all();
        let ghosts = Ghosts::after(ghosts.ranks().expect("several").clone(), self.own, &self.others);
        (next, ghosts)
    }

    /// Sends block rows, with a number each, to each rank; returns those from each. Collective.
    fn exchange(
        &mut self,
        ranks: &dyn Ranks,
        rows: Vec<Vec<(Option<u32>, (&[u32], &[f32]))>>,
        size: usize,
    ) -> Vec<Vec<(u32, (Vec<u32>, Vec<f32>))>> {
        let (mut indices, mut values) = (Vec::new(), Vec::new());
        for list in rows {
            let (mut of_list, mut entries) = (Vec::new(), Vec::new());
            for (item, (columns, blocks)) in list {
                of_list.extend([item.unwrap_or(0), columns.len() as u32]);
                of_list.extend(columns.iter().map(|&j| self.name(j)).flat_map(|(owner, item)| [owner, item]));
                entries.extend(blocks.iter().map(|&v| f64::from(v)));
            }
            indices.push(of_list);
            values.push(entries);
        }
        let (indices, values) = (ranks.exchange_indices(&indices), ranks.exchange_numbers(&values));
        let mut out = Vec::new();
        for (mut indices, values) in indices.iter().map(|list| &list[..]).zip(values) {
            let (mut rows, mut start) = (Vec::new(), 0);
            while let [item, count, rest @ ..] = indices {
                let (names, rest) = rest.split_at(2 * *count as usize);
                let columns: Vec<u32> = names.chunks_exact(2).map(|name| self.number((name[0], name[1]))).collect();
                let end = start + columns.len() * size;
                rows.push((*item, (columns, values[start..end].iter().map(|&v| v as f32).collect())));
                (indices, start) = (rest, end);
            }
            out.push(rows);
        }
        out
    }
}

/// The matrices of all ranks as one, on each of them, and how many of its rows are those of each; collective.
pub(super) fn gathered(ghosts: &Ghosts, matrix: &BlockMatrix) -> (BlockMatrix, Vec<usize>) {
    let Some(ranks) = ghosts.ranks() else { return (matrix.clone(), vec![matrix.rows]) };
    let counts: Vec<usize> = ranks.gather(&[matrix.rows as f64]).iter().map(|&count| count as usize).collect();
    let first = |rank: usize| counts[..rank].iter().sum::<usize>();
    let rank = ranks.rank();
    let number = |j: u32| match (j as usize).checked_sub(ghosts.own()) {
        None => first(rank) as u32 + j,
        Some(at) => {
            let (_, (owner, item)) = ghosts.owned()[at];
            first(owner as usize) as u32 + item
        }
    };
    let mut own = Vec::new();
    for i in 0..matrix.rows {
        let (columns, _) = matrix.row(i);
        own.push(columns.len() as u32);
        own.extend(columns.iter().map(|&j| number(j)));
    }
    let indices = ranks.exchange_indices(&vec![own; ranks.size()]);
    let own: Vec<f64> = matrix.entries().map(f64::from).collect();
    let values = ranks.exchange_numbers(&vec![own; ranks.size()]);
    let mut rows: Rows = Vec::new();
    for (mut indices, values) in indices.iter().map(|list| &list[..]).zip(&values) {
        let mut start = 0;
        while let [count, rest @ ..] = indices {
            let (columns, rest) = rest.split_at(*count as usize);
            let end = start + columns.len() * matrix.size();
            rows.push((columns.to_vec(), values[start..end].iter().map(|&v| v as f32).collect()));
            (indices, start) = (rest, end);
        }
    }
    let size = matrix.size();
    let all = BlockMatrix::from_rows([rows.len(); 2], [matrix.height; 2], |i, row| {
        for (&j, block) in rows[i].0.iter().zip(rows[i].1.chunks_exact(size)) {
            row.block(j).copy_from_slice(block);
        }
    });
    (all, counts)
}
