//! The system of all ranks for a solver that works where the rows are: each rank has its own rows complete, and those of
//! nodes with multipliers beside them.
//!
//! Equations are counted over all ranks as [`Numbering`] does; here the own ones come first, then *ghosts*, whole nodes of
//! others that own rows refer to, in the order in which the rank met them. Two rings of rows of ghosts with multipliers are
//! what [`zelus_linear_algebra`] needs to eliminate these from own rows.

use std::collections::BTreeMap;
use std::sync::Arc;

use zelus_linear_algebra::{Csr, Ghosts, Layout, Symmetry, System};

use super::owned_matrix::{OwnedMatrix, OwnedNodes, Places};
use crate::assembly::{Assembler, DofTable, Numbering, Place, near_null_space_of_all};
use crate::communication::Ranks;
use crate::model::Nodes;

/// Rings of nodes with multipliers around own rows whose rows are fetched.
const RINGS: usize = 2;

/// Own rows of the system and those of ghosts with multipliers.
#[derive(Default)]
pub(super) struct SharedRows {
    /// Stamps of what it was made of.
    made_of: Option<[u64; 4]>,
    nodes: OwnedNodes,
    /// The equations of own rows of the bulk.
    of_bulk: Places,
    bulk: OwnedMatrix,
    /// The motions of bodies, at own equations.
    motions: Vec<Vec<f64>>,
    /// Own rows of the coupling, and all of those that were fetched.
    coupling: Csr,
    is_coupled: bool,
    layout: Layout,
    ghosts: Option<Ghosts>,
    stamp: u64,
}

impl SharedRows {
    /// Brings the rows up to date with what the ranks have, as far as stamps have changed; collective.
    pub(super) fn update(
        &mut self,
        assembler: &Assembler,
        numbering: &Numbering,
        loads: Option<&Csr>,
        dofs: &DofTable,
        nodes: &Nodes,
    ) {
        let (ranks, system) = (assembler.ranks(), assembler.system());
        let has_loads = ranks.any(loads.is_some());
        let stamps = [system.bulk_graph, system.bulk_values, system.coupling_graph, system.coupling_values];
        if !has_loads && self.made_of == Some(stamps) {
            return;
        }
        let known = self.made_of.map_or([None; 2], |made_of| [Some(made_of[0]), Some(made_of[1])]);
        if known[0] != Some(stamps[0]) {
            self.nodes = OwnedNodes::new(ranks, numbering, system.layout);
            self.of_bulk = Places::new(&self.nodes);
            self.bulk = OwnedMatrix::new(ranks, numbering, system.bulk, &self.nodes, &mut self.of_bulk);
            self.motions = motions(assembler, numbering, dofs, nodes);
        }
        if known != [Some(stamps[0]), Some(stamps[1])] {
            self.bulk.fill(ranks, system.bulk);
        }
        let part = match (system.coupling, loads) {
            (Some(coupling), Some(loads)) => coupling.plus(loads),
            (Some(part), None) | (None, Some(part)) => part.clone(),
            (None, None) => Csr::empty(system.equations()),
        };
        self.is_coupled = ranks.any(part.entries() > 0);
        self.couple(ranks, numbering, &part);
        self.stamp += 1;
        self.made_of = Some(stamps);
        if has_loads {
            // Which follower loads act may change at any time, the rest stays.
            self.made_of = Some([stamps[0], stamps[1], u64::MAX, u64::MAX]);
        }
    }

    /// Makes what depends on the coupling, of which this rank has `part`; collective.
    fn couple(&mut self, ranks: &Ranks, numbering: &Numbering, part: &Csr) {
        let mut places = self.of_bulk.clone();
        let mut own = OwnedMatrix::new(ranks, numbering, part, &self.nodes, &mut places);
        own.fill(ranks, part);
        let fetched = self.fetch(ranks, numbering, &own.matrix, &mut places);
        self.coupling = own.matrix;
        let mut rows: Vec<BTreeMap<u32, f64>> = vec![BTreeMap::new(); places.len() - self.nodes.equations()];
        for (row, columns, values) in fetched {
            let sums = &mut rows[places.at(row) as usize - self.nodes.equations()];
            for (column, value) in columns.into_iter().zip(values) {
                *sums.entry(places.at(column)).or_default() += value;
            }
        }
        for row in rows {
            self.coupling.columns.extend(row.keys());
            self.coupling.values.extend(row.values());
            self.coupling.row_starts.push(self.coupling.columns.len());
        }
        self.coupling.rows = places.len();
        let bulk = &mut self.bulk.matrix;
        bulk.rows = places.len();
        bulk.row_starts.truncate(self.nodes.equations() + 1);
        bulk.row_starts.resize(places.len() + 1, bulk.columns.len());
        self.layout = places.layout(&self.nodes);
        let pad = |motion: &Vec<f64>| {
            let mut motion = motion.clone();
            motion.resize(places.len(), 0.0);
            motion
        };
        self.layout.near_null_space = self.motions.iter().map(pad).collect();
        self.ghosts = Some(Ghosts::new(Arc::new(ranks.clone()), self.nodes.equations(), places.owned(numbering)));
    }

    /// The rows of ghosts with multipliers around own rows: number, columns and values; collective.
    fn fetch(
        &self,
        ranks: &Ranks,
        numbering: &Numbering,
        coupling: &Csr,
        places: &mut Places,
    ) -> Vec<(u32, Vec<u32>, Vec<f64>)> {
        let mut fetched = Vec::new();
        let mut done = 0;
        for _ in 0..RINGS {
            let mut wanted = vec![Vec::new(); ranks.size()];
            let nodes = &places.with_multipliers()[done..];
            nodes.iter().for_each(|&[first, count]| wanted[numbering.owner(first)].extend(first..first + count));
            done += nodes.len();
            let asked = ranks.exchange_indices(&wanted);
            let (mut indices, mut values) = (Vec::new(), Vec::new());
            for list in asked {
                let (mut of_list, mut entries) = (Vec::new(), Vec::new());
                for number in list {
                    let row = (number - self.nodes.first()) as usize;
                    let parts = [self.bulk.matrix.row(row), coupling.row(row)];
                    of_list.extend([number, parts.iter().map(|(columns, _)| columns.len() as u32).sum()]);
                    for (columns, found) in parts {
                        of_list.extend(columns.iter().map(|&column| places.number(column)));
                        entries.extend_from_slice(found);
                    }
                }
                indices.push(of_list);
                values.push(entries);
            }
            let (indices, values) = (ranks.exchange_indices(&indices), ranks.exchange_numbers(&values));
            let before = fetched.len();
            for (mut indices, mut values) in
                indices.iter().map(|list| &list[..]).zip(values.iter().map(|list| &list[..]))
            {
                while let [number, count, rest @ ..] = indices {
                    let (columns, others) = rest.split_at(*count as usize);
                    let (of_row, of_others) = values.split_at(*count as usize);
                    fetched.push((*number, columns.to_vec(), of_row.to_vec()));
                    (indices, values) = (others, of_others);
                }
            }
            places.learn(
                ranks,
                numbering,
                &self.nodes,
                fetched[before..].iter().flat_map(|(_, columns, _)| columns.clone()),
            );
        }
        fetched
    }

    /// The system as this rank has it, of which `own` is its part.
    pub(super) fn system<'a>(&'a self, own: &System<'a>) -> System<'a> {
        System {
            layout: &self.layout,
            bulk: &self.bulk.matrix,
            bulk_symmetry: if self.is_coupled { Symmetry::General } else { own.bulk_symmetry },
            coupling: self.is_coupled.then_some(&self.coupling),
            coupling_graph: self.stamp,
            coupling_values: self.stamp,
            coupling_symmetric: false,
            shared: self.ghosts.as_ref(),
            ..*own
        }
    }

    /// A vector of own values, of ones over the equations that this rank has, with zeros for ghosts.
    pub(super) fn of_own(&self, numbering: &Numbering, values: &[f64]) -> Vec<f64> {
        let mut own = numbering.own_of(values);
        own.resize(self.layout.equations(), 0.0);
        own
    }
}

/// The motions of bodies at own equations; collective.
fn motions(assembler: &Assembler, numbering: &Numbering, dofs: &DofTable, nodes: &Nodes) -> Vec<Vec<f64>> {
    let unknowns = assembler.equations().unknowns();
    let place = |&equation: &u32| -> Place {
        let dof = &dofs.dofs()[unknowns[equation as usize] as usize];
        (!dof.multiplier).then(|| (dof.variable, nodes.initial[dof.node as usize]))
    };
    let places: Vec<Place> = numbering.own.iter().map(place).collect();
    near_null_space_of_all(assembler.ranks(), &dofs.variables().collect::<Vec<_>>(), &places)
}
