//! The equations of all ranks, each row complete on the rank that owns it, and PETSc that solves them.
//!
//! Equations are counted anew: those of rank 0 come first, then those of rank 1 and so on.

use zelus_linear_algebra::{CondensationSettings, Csr, NotCondensable, SolveError, SolveReport, Symmetry, System};
use zelus_petsc::{DistributedMatrix, DistributedSolver, PetscSettings, RigidModes};

use super::owned_condensation::OwnedCondensation;
use crate::assembly::{Assembler, DofTable};
use crate::communication::{petsc, world};
use crate::diagnostics::Result;
use crate::model::{Nodes, variables::DISPLACEMENT};

/// The rows of this rank and the solver over all of them.
pub(super) struct OwnedRows {
    settings: PetscSettings,
    solver: Option<DistributedSolver>,
    /// Stamps of what the pattern and the values were made of.
    made_of: Option<[u64; 4]>,
    graph: u64,
    stamp: u64,
    /// Equations of each rank, ascending.
    equations: Vec<Vec<u32>>,
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
    /// What is condensed now, with the stamp of the rows it was made of, or why it is not.
    condensed: Option<(Result<OwnedCondensation, NotCondensable>, u64)>,
}

impl OwnedRows {
    /// Nothing yet; multigrid gets the system without multipliers as `condensing` says.
    pub(super) fn new(settings: PetscSettings, condensing: Option<CondensationSettings>) -> Self {
        let is_multigrid = settings.engine.is_some_and(|engine| !engine.is_direct());
        Self {
            condensing: condensing.filter(|_| is_multigrid),
            condensed: None,
            settings,
            solver: None,
            made_of: None,
            graph: 0,
            stamp: 0,
            equations: Vec::new(),
            row_starts: Vec::new(),
            columns: Vec::new(),
            values: Vec::new(),
            sent: Vec::new(),
            places: Vec::new(),
            modes: RigidModes::default(),
        }
    }

    /// Solves `(bulk + coupling + loads) x = rhs` of all ranks, where `rhs` and the answer are whole; collective.
    ///
    /// # Errors
    /// Those of [`DistributedSolver::solve`], with equations counted as in `rhs`; [`crate::Error::System`] when PETSc
    /// cannot start.
    pub(super) fn solve(
        &mut self,
        assembler: &Assembler,
        loads: Option<&Csr>,
        dofs: &DofTable,
        nodes: &Nodes,
        rhs: &[f64],
    ) -> Result<std::result::Result<(Vec<f64>, SolveReport), SolveError>> {
        let system = assembler.system();
        self.update(assembler, &system, loads, dofs, nodes);
        self.condense(&system);
        let left = match &self.condensed {
            Some((Ok(left), _)) => Some(left),
            Some((Err(refused), _)) if self.condensing.is_some_and(|settings| !settings.fallback) => {
                return Ok(Err(SolveError::NotCondensable(*refused)));
            }
            _ => None,
        };
        let has_coupling = world().any(system.coupling.is_some() || loads.is_some());
        let modes =
            left.map(|left| modes(assembler.equations().unknowns(), &left.equations[world().rank()], dofs, nodes));
        let equations = left.map_or(&self.equations, |left| &left.equations);
        let matrix = DistributedMatrix {
            first_row: first_row(equations, world().rank()),
            row_starts: left.map_or(&self.row_starts, |left| &left.row_starts),
            columns: left.map_or(&self.columns, |left| &left.columns),
            values: left.map_or(&self.values, |left| &left.values),
            symmetry: if has_coupling { Symmetry::General } else { system.bulk_symmetry },
            has_multipliers: left.is_none() && system.layout.multiplier.contains(&true),
            modes: Some(modes.as_ref().unwrap_or(&self.modes)),
            // The pattern of a condensed system changes with what is active.
            graph: if left.is_some() { u64::MAX - self.stamp } else { self.graph },
            stamp: self.stamp,
        };
        let own = &equations[world().rank()];
        let rhs_owned = match left {
            Some(left) => left.reduce(rhs),
            None => own.iter().map(|&e| rhs[e as usize]).collect(),
        };
        let mut x_owned = vec![0.0; own.len()];
        let solver = match &mut self.solver {
            Some(solver) => solver,
            none => none.insert(DistributedSolver::new(petsc()?, self.settings.clone())),
        };
        let report = match solver.solve(&matrix, &rhs_owned, &mut x_owned) {
            Ok(report) => report,
            Err(SolveError::Singular { equations: suspicious, rank_deficiency }) => {
                let all: Vec<u32> = equations.concat();
                let equations = suspicious.into_iter().filter_map(|e| all.get(e).map(|&e| e as usize)).collect();
                return Ok(Err(SolveError::Singular { equations, rank_deficiency }));
            }
            Err(error) => return Ok(Err(error)),
        };
        let counts: Vec<usize> = equations.iter().map(Vec::len).collect();
        let mut x = vec![0.0; rhs.len()];
        let all = world().gather_counted(&x_owned, &counts);
        equations.iter().flatten().zip(all).for_each(|(&equation, value)| x[equation as usize] = value);
        if let Some(left) = left {
            left.recover(rhs, &mut x);
        }
        Ok(Ok((x, report)))
    }

    /// Why the multipliers of the last solve were not condensed.
    pub(super) fn not_condensed(&self) -> Option<NotCondensable> {
        self.condensed.as_ref().and_then(|(condensed, _)| condensed.as_ref().err().copied())
    }

    /// Brings the condensed rows up to date; collective.
    fn condense(&mut self, system: &System<'_>) {
        let Some(settings) = self.condensing.filter(|_| system.layout.multiplier.contains(&true)) else { return };
        if self.condensed.as_ref().is_some_and(|(_, stamp)| *stamp == self.stamp) {
            return;
        }
        let all: Vec<u32> = self.equations.concat();
        let row = |(at, &equation): (usize, &u32)| {
            let range = self.row_starts[at]..self.row_starts[at + 1];
            let columns = self.columns[range.clone()].iter().map(|&column| all[column as usize]).collect();
            (equation, columns, &self.values[range])
        };
        let rows = self.equations[world().rank()].iter().enumerate().map(row);
        let made = OwnedCondensation::new(rows, &self.equations, system.layout, &settings);
        self.condensed = Some((made, self.stamp));
    }

    fn update(
        &mut self,
        assembler: &Assembler,
        system: &System<'_>,
        loads: Option<&Csr>,
        dofs: &DofTable,
        nodes: &Nodes,
    ) {
        let has_loads = world().any(loads.is_some());
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
            self.lay_out(assembler, &sum, dofs, nodes);
        }
        let sent: Vec<Vec<f64>> =
            self.sent.iter().map(|list| list.iter().map(|&at| sum.values[at as usize]).collect()).collect();
        self.values.fill(0.0);
        for (places, values) in self.places.iter().zip(world().exchange_numbers(&sent)) {
            places.iter().zip(values).for_each(|(&place, value)| self.values[place as usize] += value);
        }
        self.stamp += 1;
        self.made_of = (!has_loads).then_some(stamps);
    }

    /// Finds the owners of the rows of `sum`, and the pattern of the rows of this rank.
    fn lay_out(&mut self, assembler: &Assembler, sum: &Csr, dofs: &DofTable, nodes: &Nodes) {
        let world = world();
        let unknowns = assembler.equations().unknowns();
        let owner = |e: usize| assembler.distribution().map_or(0, |d| d.owner(unknowns[e] as usize)) as usize;
        self.equations = vec![Vec::new(); world.size()];
        (0..unknowns.len()).for_each(|e| self.equations[owner(e)].push(e as u32));
        let mut number = vec![0_u32; unknowns.len()];
        self.equations.iter().flatten().enumerate().for_each(|(new, &e)| number[e as usize] = new as u32);
        self.sent = vec![Vec::new(); world.size()];
        let (mut rows, mut columns) = (vec![Vec::new(); world.size()], vec![Vec::new(); world.size()]);
        for e in 0..sum.rows {
            let rank = owner(e);
            for at in sum.row_starts[e]..sum.row_starts[e + 1] {
                self.sent[rank].push(at as u32);
                rows[rank].push(number[e]);
                columns[rank].push(number[sum.columns[at] as usize]);
            }
        }
        let (rows, columns) = (world.exchange_indices(&rows), world.exchange_indices(&columns));
        let first = first_row(&self.equations, world.rank()) as u32;
        let own = self.equations[world.rank()].len();
        let mut lists: Vec<Vec<u32>> = vec![Vec::new(); own];
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
        self.modes = modes(unknowns, &self.equations[world.rank()], dofs, nodes);
        self.graph += 1;
    }
}

/// Number of the first row of a rank, whose equations are counted after those of the ranks before.
fn first_row(equations: &[Vec<u32>], rank: usize) -> u64 {
    equations[..rank].iter().map(|list| list.len() as u64).sum()
}

/// Positions and directions of equations, for rigid motions; collective.
fn modes(unknowns: &[u32], equations: &[u32], dofs: &DofTable, nodes: &Nodes) -> RigidModes {
    let of = |e: &u32| &dofs.dofs()[unknowns[*e as usize] as usize];
    let component = |e: &u32| {
        let variable = of(e).variable;
        if variable.column == DISPLACEMENT.name() { variable.component.unwrap_or(u8::MAX) } else { u8::MAX }
    };
    let components: Vec<u8> = equations.iter().map(component).collect();
    let dimension = if world().any(components.contains(&2)) { 3 } else { 2 };
    let coordinates = equations.iter().map(|e| nodes.initial[of(e).node as usize]).collect();
    RigidModes { dimension, coordinates, components }
}
