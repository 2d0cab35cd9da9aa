//! The system of all ranks for a solver that works where the rows are: each rank has its own rows complete, and those of
//! nodes with multipliers beside them.
//!
//! The bulk stays where it is: contributions of other ranks to own rows join the coupling, as do the rows of ghosts with multipliers.
//! Multigrid needs two rings of them around own rows to eliminate these multipliers from own rows.

use std::sync::Arc;

use zelus_linear_algebra::{Csr, Ghosts, Layout, System};

use super::local_to_global::LocalToGlobalMap;
use crate::assembly::{DofPosition, DofTable, Numbering, near_null_space_of_all};
use crate::communication::Ranks;
use crate::model::Nodes;

/// Rings of nodes with multipliers around own rows whose rows are fetched.
const RINGS: usize = 2;
/// Share of an entry below which a difference is round-off.
const ROUND_OFF: f64 = 1e-14;

/// A row on its way: its number, columns by numbers, and values.
type NumberedRow = (u32, Vec<u32>, Vec<f64>);
/// A value with its row and column.
type MatrixEntry = (u32, u32, f64);

/// Share of a rank in the system of all ranks.
pub(super) struct SystemShare<'a> {
    pub(super) ranks: &'a Ranks,
    /// Numbering of its equations; inactive ones have no number.
    pub(super) numbering: &'a Numbering,
    pub(super) system: System<'a>,
    /// Tangents of follower loads.
    pub(super) loads: Option<&'a Csr>,
    /// Unknown of each equation; where `None`, equations are unknowns.
    pub(super) unknowns: Option<&'a [u32]>,
}

/// Entries of the system of all ranks that this rank has beside its bulk.
#[derive(Default)]
pub(super) struct DistributedRows {
    /// Stamps of its sources.
    made_of: Option<[u64; 4]>,
    /// The equations of own rows of the bulk.
    of_bulk: LocalToGlobalMap,
    /// The motions of bodies, at own equations.
    motions: Vec<Vec<f64>>,
    /// Own rows of the coupling with the contributions of others to own rows, and all rows that were fetched.
    coupling: Csr,
    /// Whether anything but elements and conditions gives to it.
    is_coupled: bool,
    layout: Layout,
    ghosts: Option<Ghosts>,
    stamp: u64,
}

impl DistributedRows {
    /// Brings the rows up to date with the data of the ranks, as far as stamps have changed; collective.
    pub(super) fn update(&mut self, share: &SystemShare<'_>, dofs: &DofTable, nodes: &Nodes) {
        let SystemShare { ranks, numbering, system, loads, .. } = *share;
        let has_loads = ranks.any(loads.is_some());
        let stamps = [system.bulk_graph, system.bulk_values, system.coupling_graph, system.coupling_values];
        if !has_loads && self.made_of == Some(stamps) {
            return;
        }
        if self.made_of.is_none_or(|made_of| made_of[0] != stamps[0]) {
            self.of_bulk = LocalToGlobalMap::new(ranks, numbering, system.layout);
            self.of_bulk.meet(ranks, numbering, columns(numbering, &[system.bulk]).into_iter());
            self.motions = motions(share, dofs, nodes);
        }
        self.is_coupled = has_loads || ranks.any(system.active_coupling().is_some());
        self.couple(ranks, numbering, &system, loads);
        self.stamp += 1;
        self.made_of = Some(stamps);
        if has_loads {
            // Which follower loads act may change at any time, the rest stays.
            self.made_of = Some([stamps[0], u64::MAX, u64::MAX, u64::MAX]);
        }
    }

    /// Makes the entries of this rank beside its bulk; collective.
    fn couple(&mut self, ranks: &Ranks, numbering: &Numbering, system: &System<'_>, loads: Option<&Csr>) {
        let mut places = self.of_bulk.clone();
        let beside: Vec<&Csr> = system.coupling.into_iter().chain(loads).collect();
        let all: Vec<&Csr> = std::iter::once(system.bulk).chain(beside.iter().copied()).collect();
        let arrived = exchange(ranks, rows_of_others(ranks, numbering, &places, &all));
        let met = columns(numbering, &beside).into_iter().chain(arrived.iter().flat_map(|row| row.1.iter().copied()));
        places.meet(ranks, numbering, met);
        let mut entries: Vec<MatrixEntry> = Vec::new();
        for &row in &numbering.own {
            for (columns, values) in beside.iter().map(|matrix| matrix.row(row as usize)) {
                // As places, equations of this rank keep their numbers here.
                let filled = columns.iter().zip(values).filter(|(column, _)| numbering.number(**column).is_some());
                entries.extend(filled.map(|(&column, &value)| (row, column, value)));
            }
        }
        entries.extend(arrived.iter().flat_map(|row| placed(&places, row)));
        let mut own = summed(places.len(), entries);
        let fetched = fetch(ranks, numbering, system.bulk, &own, &mut places);
        let rows = fetched.iter().flat_map(|row| complement(system.bulk, placed(&places, row).collect()));
        let of_ghosts = summed(places.len(), rows.collect());
        own.row_starts.resize(places.len() + 1, own.columns.len());
        own.rows = places.len();
        self.coupling = own.plus(&of_ghosts);
        self.layout = places.layout(system.layout);
        let pad = |motion: &Vec<f64>| {
            let mut motion = motion.clone();
            motion.resize(places.len(), 0.0);
            motion
        };
        self.layout.near_null_space = self.motions.iter().map(pad).collect();
        self.layout.corner_interpolation = system.layout.corner_interpolation.clone();
        let (own, ghosts) = (numbering.own.clone(), places.ghosts(numbering));
        self.ghosts = Some(Ghosts::new(Arc::new(ranks.clone()), own, places.len(), ghosts));
    }

    /// The system as this rank has it, of which `own` is its part.
    pub(super) fn system<'a>(&'a self, own: &System<'a>) -> System<'a> {
        System {
            layout: &self.layout,
            coupling: Some(&self.coupling),
            coupling_graph: self.stamp,
            coupling_values: self.stamp,
            coupling_symmetric: !self.is_coupled,
            bulk_symmetry: if self.is_coupled { zelus_linear_algebra::Symmetry::General } else { own.bulk_symmetry },
            shared: self.ghosts.as_ref(),
            ..*own
        }
    }

    /// The own values of a vector over the equations that this rank has, with zeros elsewhere.
    pub(super) fn of_own(&self, numbering: &Numbering, values: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.layout.equations()];
        numbering.own.iter().for_each(|&e| all[e as usize] = values[e as usize]);
        all
    }
}

/// Numbers of the columns of own rows of these matrices.
fn columns(numbering: &Numbering, matrices: &[&Csr]) -> Vec<u32> {
    let mut is_met = vec![false; numbering.numbers.len()];
    for &row in &numbering.own {
        let columns = matrices.iter().flat_map(|matrix| matrix.row(row as usize).0);
        columns.for_each(|&column| is_met[column as usize] = true);
    }
    numbering.numbered().filter(|(equation, _)| is_met[*equation as usize]).map(|(_, number)| number).collect()
}

/// A row with its parts one after the other, without the columns that have no number.
fn numbered_row<'a>(
    row: u32,
    parts: impl Iterator<Item = (&'a [u32], &'a [f64])>,
    number: impl Fn(u32) -> Option<u32>,
) -> NumberedRow {
    let entries = parts.flat_map(|(columns, values)| columns.iter().zip(values));
    let (columns, values) =
        entries.filter_map(|(&column, &value)| number(column).map(|column| (column, value))).unzip();
    (row, columns, values)
}

/// Entries of this rank in the rows of each other rank.
fn rows_of_others(
    ranks: &Ranks,
    numbering: &Numbering,
    places: &LocalToGlobalMap,
    matrices: &[&Csr],
) -> Vec<Vec<NumberedRow>> {
    let mut rows = vec![Vec::new(); ranks.size()];
    for (e, number) in numbering.numbered().filter(|(_, number)| places.own(*number).is_none()) {
        let parts = matrices.iter().map(|matrix| matrix.row(e as usize));
        let row = numbered_row(number, parts, |column| numbering.number(column));
        if !row.1.is_empty() {
            rows[numbering.owner(number)].push(row);
        }
    }
    rows
}

/// Sends rows to each rank; gives those that come from all of them. Collective.
fn exchange(ranks: &Ranks, rows: Vec<Vec<NumberedRow>>) -> Vec<NumberedRow> {
    let (mut indices, mut values) = (Vec::new(), Vec::new());
    for list in rows {
        let (mut of_list, mut entries) = (Vec::new(), Vec::new());
        for (number, columns, found) in list {
            of_list.extend([number, columns.len() as u32]);
            of_list.extend(columns);
            entries.extend(found);
        }
        indices.push(of_list);
        values.push(entries);
    }
    let (indices, values) = (ranks.exchange_indices(&indices), ranks.exchange_numbers(&values));
    let mut arrived = Vec::new();
    for (mut indices, mut values) in indices.iter().map(|list| &list[..]).zip(values.iter().map(|list| &list[..])) {
        while let [number, count, rest @ ..] = indices {
            let (columns, others) = rest.split_at(*count as usize);
            let (of_row, of_others) = values.split_at(*count as usize);
            arrived.push((*number, columns.to_vec(), of_row.to_vec()));
            (indices, values) = (others, of_others);
        }
    }
    arrived
}

/// The complete rows of ghosts with multipliers around own rows; collective.
fn fetch(
    ranks: &Ranks,
    numbering: &Numbering,
    bulk: &Csr,
    coupling: &Csr,
    places: &mut LocalToGlobalMap,
) -> Vec<NumberedRow> {
    let mut fetched: Vec<NumberedRow> = Vec::new();
    let mut done = 0;
    for _ in 0..RINGS {
        let mut wanted = vec![Vec::new(); ranks.size()];
        let nodes = &places.with_multipliers()[done..];
        nodes.iter().for_each(|&[first, count]| wanted[numbering.owner(first)].extend(first..first + count));
        done += nodes.len();
        let complete = |number: u32| {
            let row = places.own(number).expect("a row that this rank owns") as usize;
            let parts = [bulk.row(row), coupling.row(row)];
            numbered_row(number, parts.into_iter(), |place| places.number(place))
        };
        let asked = ranks.exchange_indices(&wanted);
        let rows = asked.into_iter().map(|list| list.into_iter().map(complete).collect()).collect();
        let arrived = exchange(ranks, rows);
        places.meet(ranks, numbering, arrived.iter().flat_map(|row| row.1.iter().copied()));
        fetched.extend(arrived);
    }
    fetched
}

/// The entries of a row by places.
fn placed<'a>(
    places: &'a LocalToGlobalMap,
    (number, columns, values): &'a NumberedRow,
) -> impl Iterator<Item = MatrixEntry> + 'a {
    let row = places.at(*number);
    columns.iter().zip(values).map(move |(&column, &value)| (row, places.at(column), value))
}

/// Entries of a complete row that the bulk of this rank lacks.
fn complement(bulk: &Csr, mut row: Vec<MatrixEntry>) -> Vec<MatrixEntry> {
    let Some(&(at, ..)) = row.first() else { return row };
    row.sort_by_key(|entry| entry.1);
    row.dedup_by(|entry, sum| {
        let is_same = entry.1 == sum.1;
        sum.2 += if is_same { entry.2 } else { 0.0 };
        is_same
    });
    if (at as usize) < bulk.rows {
        for entry in &mut row {
            let here = bulk.find(at as usize, entry.1 as usize).map_or(0.0, |found| bulk.values[found]);
            let left = entry.2 - here;
            entry.2 = if left.abs() > ROUND_OFF * here.abs() { left } else { 0.0 };
        }
        row.retain(|entry| entry.2 != 0.0);
    }
    row
}

/// The matrix of these entries, those of one place added up in their order.
fn summed(rows: usize, mut entries: Vec<MatrixEntry>) -> Csr {
    entries.sort_by_key(|&(row, column, _)| (row, column));
    let mut matrix = Csr::empty(rows);
    for of_place in entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        matrix.row_starts[of_place[0].0 as usize + 1] += 1;
        matrix.columns.push(of_place[0].1);
        matrix.values.push(of_place.iter().map(|entry| entry.2).sum());
    }
    (0..rows).for_each(|row| matrix.row_starts[row + 1] += matrix.row_starts[row]);
    matrix
}

/// The motions of bodies at own equations; collective.
fn motions(share: &SystemShare<'_>, dofs: &DofTable, nodes: &Nodes) -> Vec<Vec<f64>> {
    let mut places: Vec<DofPosition> = vec![None; share.numbering.numbers.len()];
    for &equation in &share.numbering.own {
        let unknown = share.unknowns.map_or(equation, |unknowns| unknowns[equation as usize]);
        let dof = &dofs.dofs()[unknown as usize];
        places[equation as usize] = (!dof.multiplier).then(|| (dof.variable, nodes.initial[dof.node as usize]));
    }
    near_null_space_of_all(share.ranks, &dofs.variables().collect::<Vec<_>>(), &places)
}
