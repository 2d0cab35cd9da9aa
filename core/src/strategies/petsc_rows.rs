//! The equations of all ranks, each row complete on the rank that owns it, and PETSc that solves them.
//!
//! Equations are counted over all ranks, see [`Numbering`].

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;
use zelus_linear_algebra::{CondensationSettings, Csr, NotCondensable, SolveError, SolveReport, Symmetry, System};
use zelus_petsc::{Communicator, DistributedMatrix, DistributedSolver, PetscSettings, RigidModes};

use super::dof_name::DofName;
use super::petsc_condensation::{PetscCondensation, RowOwners};
use crate::assembly::{Assembler, DofTable, Numbering};
use crate::communication::Ranks;
use crate::diagnostics::Result;
use crate::model::Nodes;

/// The rows of this rank and the solver over all of them.
pub(super) struct PetscRows {
    solver: DistributedSolver,
    /// Stamps of the sources of the pattern and the values.
    made_of: Option<[u64; 4]>,
    graph: u64,
    stamp: u64,
    row_starts: Vec<usize>,
    columns: Vec<u64>,
    values: Vec<f64>,
    /// Entries of this rank's sum that go to each rank.
    sent: Vec<Vec<u32>>,
    /// Where the entries from each rank go.
    places: Vec<Vec<u32>>,
    modes: RigidModes,
    /// How multipliers are condensed, where they are to be.
    condensing: Option<CondensationSettings>,
    /// The node of each equation in the rows of this rank, and whether it is a multiplier; only where these are condensed.
    row_owners: RowOwners,
    /// Condensed system, with the stamp of the rows it was made of, or the reason why it is not condensed.
    condensed: Option<(Result<PetscCondensation, NotCondensable>, u64)>,
    /// Names of the equations that are to blame for something.
    dof_names: BTreeMap<usize, DofName>,
    /// PETSc runs as long as they do, and the solver needs it to the end.
    _ranks: Ranks,
}

/// The equations of this rank and their names.
#[derive(Clone, Copy)]
struct RankEquations<'a> {
    assembler: &'a Assembler,
    numbering: &'a Numbering,
    system: &'a System<'a>,
    unknowns: &'a [u32],
    dofs: &'a DofTable,
    nodes: &'a Nodes,
}

impl<'a> RankEquations<'a> {
    fn ranks(&self) -> &'a Ranks {
        self.assembler.ranks()
    }

    /// Node of an equation in the whole mesh and whether it is a multiplier, in one word.
    fn word(&self, equation: u32) -> u32 {
        let number = self.unknowns[equation as usize] as usize;
        let place = self.assembler.distribution().map_or(0, |distribution| distribution.place(number));
        2 * place + u32::from(self.system.layout.multiplier[equation as usize])
    }

    /// The meanings of a few equations of all ranks, by their numbers over all ranks; collective.
    fn dof_names(&self, wanted: &[usize]) -> BTreeMap<usize, DofName> {
        let first = self.numbering.starts[self.ranks().rank()];
        let own = |number: usize| number.checked_sub(first).and_then(|at| self.numbering.own.get(at));
        let packed = |&number: &usize| match own(number) {
            Some(&equation) => DofName::of(self.dofs, self.nodes, self.unknowns[equation as usize]).pack(self.dofs),
            None => [0.0; 4],
        };
        let mut packed: Vec<f64> = wanted.iter().flat_map(packed).collect();
        self.ranks().sum(&mut packed);
        let dof_name = |(&number, packed)| Some((number, DofName::unpack(packed, self.dofs)?));
        wanted.iter().zip(packed.chunks_exact(4)).filter_map(dof_name).collect()
    }

    /// Positions and directions of equations, for rigid-body modes; collective.
    fn modes(&self, equations: &[u32]) -> RigidModes {
        let of = |e: &u32| &self.dofs.dofs()[self.unknowns[*e as usize] as usize];
        let component = |e: &u32| of(e).variable.component.filter(|_| of(e).moves_mesh()).unwrap_or(u8::MAX);
        let components: Vec<u8> = equations.iter().map(component).collect();
        let dimension = if self.ranks().any(components.contains(&2)) { 3 } else { 2 };
        let coordinates = equations.iter().map(|e| self.nodes.initial[of(e).node as usize]).collect();
        RigidModes { dimension, coordinates, components }
    }
}

impl PetscRows {
    /// Nothing yet, for `ranks` that PETSc knows by `communicator`; multigrid gets the system without multipliers as `condensing` says.
    pub(super) fn new(
        ranks: &Ranks,
        communicator: Communicator,
        settings: PetscSettings,
        condensing: Option<CondensationSettings>,
    ) -> Self {
        let is_multigrid = settings.engine.is_some_and(|engine| !engine.is_direct());
        Self {
            condensing: condensing.filter(|_| is_multigrid),
            row_owners: FxHashMap::default(),
            condensed: None,
            dof_names: BTreeMap::new(),
            solver: DistributedSolver::new(communicator, settings),
            made_of: None,
            graph: 0,
            stamp: 0,
            row_starts: Vec::new(),
            columns: Vec::new(),
            values: Vec::new(),
            sent: Vec::new(),
            places: Vec::new(),
            modes: RigidModes::default(),
            _ranks: ranks.clone(),
        }
    }

    /// Solves `(bulk + coupling + loads) x = rhs` of all ranks, where `rhs` and the answer are over the equations this rank
    /// has; collective.
    ///
    /// # Errors
    /// Errors of [`DistributedSolver::solve`], with equations that [`PetscRows::dof_name`] knows; [`crate::Error::System`] when PETSc
    /// cannot start.
    pub(super) fn solve(
        &mut self,
        assembler: &Assembler,
        numbering: &Numbering,
        loads: Option<&Csr>,
        dofs: &DofTable,
        nodes: &Nodes,
        rhs: &[f64],
    ) -> Result<std::result::Result<(Vec<f64>, SolveReport), SolveError>> {
        let system = assembler.system();
        let unknowns = assembler.equations().unknowns();
        let own = RankEquations { assembler, numbering, system: &system, unknowns, dofs, nodes };
        self.update(own, loads);
        self.condense(own);
        let left = match &self.condensed {
            Some((Ok(left), _)) => Some(left),
            Some((Err(refused), _)) if self.condensing.is_some_and(|settings| !settings.fallback) => {
                return Ok(Err(SolveError::NotCondensable(*refused)));
            }
            _ => None,
        };
        let has_coupling = assembler.ranks().any(system.coupling.is_some() || loads.is_some());
        let modes = left.map(|left| own.modes(&left.own));
        let matrix = DistributedMatrix {
            first_row: left.map_or(numbering.starts[assembler.ranks().rank()], |left| left.first) as u64,
            row_starts: left.map_or(&self.row_starts, |left| &left.row_starts),
            columns: left.map_or(&self.columns, |left| &left.columns),
            values: left.map_or(&self.values, |left| &left.values),
            symmetry: if has_coupling { Symmetry::General } else { system.bulk_symmetry },
            has_multipliers: left.is_none() && system.layout.multiplier.contains(&true),
            modes: Some(modes.as_ref().unwrap_or(&self.modes)),
            // The pattern of a condensed system changes with the active set.
            graph: if left.is_some() { u64::MAX - self.stamp } else { self.graph },
            stamp: self.stamp,
        };
        let rhs_owned = left.map_or_else(|| numbering.own_of(rhs), |left| left.reduce(rhs));
        let mut x_owned = vec![0.0; rhs_owned.len()];
        let report = match self.solver.solve(&matrix, &rhs_owned, &mut x_owned) {
            Ok(report) => report,
            Err(SolveError::Singular { mut equations, rank_deficiency }) => {
                if let Some(left) = left {
                    equations.iter_mut().for_each(|equation| *equation = left.number_before(*equation));
                }
                self.dof_names = own.dof_names(&equations);
                return Ok(Err(SolveError::Singular { equations, rank_deficiency }));
            }
            Err(error) => return Ok(Err(error)),
        };
        let Some(left) = left else { return Ok(Ok((assembler.complete(&x_owned), report))) };
        let mut own = vec![0.0; rhs.len()];
        left.own.iter().zip(x_owned).for_each(|(&equation, value)| own[equation as usize] = value);
        let mut x = assembler.complete(&numbering.own_of(&own));
        left.recover(rhs, &mut x);
        Ok(Ok((x, report)))
    }

    /// Why the multipliers of the last solve were not condensed.
    pub(super) fn not_condensed(&self) -> Option<NotCondensable> {
        self.condensed.as_ref().and_then(|(condensed, _)| condensed.as_ref().err().copied())
    }

    /// Name of an equation that an error or [`PetscRows::not_condensed`] names.
    pub(super) fn dof_name(&self, equation: usize) -> Option<DofName> {
        self.dof_names.get(&equation).copied()
    }

    /// Brings the condensed rows up to date; collective.
    fn condense(&mut self, own: RankEquations<'_>) {
        let multiplier = &own.system.layout.multiplier;
        let Some(settings) = self.condensing.filter(|_| multiplier.contains(&true)) else { return };
        if self.condensed.as_ref().is_some_and(|(_, stamp)| *stamp == self.stamp) {
            return;
        }
        let first = own.numbering.starts[own.ranks().rank()];
        let row = |at: usize| {
            let range = self.row_starts[at]..self.row_starts[at + 1];
            ((first + at) as u32, &self.columns[range.clone()], &self.values[range])
        };
        let rows = (0..own.numbering.own.len()).map(row);
        let made = PetscCondensation::new(own.ranks(), rows, &self.row_owners, own.numbering, multiplier, &settings);
        if let Err(refused) = &made {
            self.dof_names = own.dof_names(&match *refused {
                NotCondensable::OffNode { multiplier, equation, .. } => vec![multiplier, equation],
                NotCondensable::Undetermined { multiplier, .. } => vec![multiplier],
            });
        }
        self.condensed = Some((made, self.stamp));
    }

    fn update(&mut self, own: RankEquations<'_>, loads: Option<&Csr>) {
        let has_loads = own.ranks().any(loads.is_some());
        let system = own.system;
        let stamps = [system.bulk_graph, system.coupling_graph, system.bulk_values, system.coupling_values];
        if !has_loads && self.made_of == Some(stamps) {
            return;
        }
        let mut sum = system.merged();
        if let Some(loads) = loads {
            sum = sum.plus(loads);
        }
        // Which follower loads act may change at any time.
        if has_loads || self.made_of.is_none_or(|made_of| made_of[..2] != stamps[..2]) {
            self.lay_out(own, &sum);
        }
        let sent: Vec<Vec<f64>> =
            self.sent.iter().map(|list| list.iter().map(|&at| sum.values[at as usize]).collect()).collect();
        self.values.fill(0.0);
        for (places, values) in self.places.iter().zip(own.ranks().exchange_numbers(&sent)) {
            places.iter().zip(values).for_each(|(&place, value)| self.values[place as usize] += value);
        }
        self.stamp += 1;
        self.made_of = (!has_loads).then_some(stamps);
    }

    /// Finds the owners of the rows of `sum`, and the pattern of the rows of this rank.
    fn lay_out(&mut self, own: RankEquations<'_>, sum: &Csr) {
        let (ranks, numbering) = (own.ranks(), own.numbering);
        self.sent = vec![Vec::new(); ranks.size()];
        let (mut rows, mut columns) = (vec![Vec::new(); ranks.size()], vec![Vec::new(); ranks.size()]);
        for e in 0..sum.rows {
            let rank = numbering.owner(numbering.numbers[e]);
            for at in sum.row_starts[e]..sum.row_starts[e + 1] {
                self.sent[rank].push(at as u32);
                rows[rank].push(numbering.numbers[e]);
                columns[rank].push(numbering.numbers[sum.columns[at] as usize]);
            }
        }
        let words = |list: &Vec<u32>| list.iter().map(|&at| own.word(sum.columns[at as usize])).collect();
        let words: Vec<Vec<u32>> = match self.condensing {
            Some(_) => ranks.exchange_indices(&self.sent.iter().map(words).collect::<Vec<_>>()),
            None => Vec::new(),
        };
        let (rows, columns) = (ranks.exchange_indices(&rows), ranks.exchange_indices(&columns));
        if self.condensing.is_some() {
            let of_rows = columns.iter().flatten().copied().zip(words.into_iter().flatten());
            let of_here = (0..own.unknowns.len() as u32).map(|e| (numbering.numbers[e as usize], own.word(e)));
            self.row_owners =
                of_rows.chain(of_here).map(|(number, word)| (number, (word / 2, word % 2 == 1))).collect();
        }
        let first = numbering.starts[ranks.rank()] as u32;
        let mut lists: Vec<Vec<u32>> = vec![Vec::new(); numbering.own.len()];
        for (&row, &column) in rows.iter().flatten().zip(columns.iter().flatten()) {
            lists[(row - first) as usize].push(column);
        }
        self.row_starts = vec![0];
        for list in &mut lists {
            list.sort_unstable();
            list.dedup();
            self.row_starts.push(self.row_starts[self.row_starts.len() - 1] + list.len());
        }
        let place = |(&row, column): (&u32, &u32)| {
            let row = (row - first) as usize;
            (self.row_starts[row] + lists[row].partition_point(|c| c < column)) as u32
        };
        self.places = rows.iter().zip(&columns).map(|(r, c)| r.iter().zip(c).map(place).collect()).collect();
        self.columns = lists.iter().flatten().map(|&column| u64::from(column)).collect();
        self.values = vec![0.0; self.columns.len()];
        self.modes = own.modes(&numbering.own);
        self.graph += 1;
    }
}
