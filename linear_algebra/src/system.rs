//! Input of a solver: the equations and their matrix in two parts.

use serde::{Deserialize, Serialize};

use crate::csr::{Csr, Runs};
use crate::ghosts::Ghosts;
use crate::parallel;
use crate::vector::{self, CHUNK};

/// Symmetry of a matrix, known before it is factorised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Symmetry {
    /// Symmetric and expected positive definite, at least once the interface is held.
    PositiveDefinite,
    /// Symmetric with eigenvalues of either sign.
    Symmetric,
    /// Not symmetric.
    General,
}

/// Meaning of the equations, which decides their ordering.
///
/// `node` and `multiplier` have one entry an equation. Equations of one node are ordered together, so equations that
/// share a node should share their columns too.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Layout {
    /// Node of each equation, from 0; a multiplier carries the node of its slave, which may have those of several interfaces.
    pub node: Vec<u32>,
    /// Whether the equation is that of a multiplier.
    pub multiplier: Vec<bool>,
    /// Vectors the bulk nearly maps to zero (rigid-body modes), for multigrid; may be empty.
    pub near_null_space: Vec<Vec<f64>>,
    /// Linear interpolation of the unknowns from those at corners of elements, for multigrid: rows of nodes between corners have the
    /// shares of these, those of all others one in their own column. Without nodes between corners it has no rows.
    pub corner_interpolation: Csr,
    /// Inactive rows (Dirichlet): solvers skip their rows, columns and right-hand sides, and return zero there. Empty where there are
    /// none. For solvers that say so ([`LinearSolver::takes_inactive_rows`](crate::LinearSolver::takes_inactive_rows)).
    pub inactive: Vec<bool>,
}

impl Layout {
    /// Every equation a node of its own and none a multiplier.
    pub fn scalar(equations: usize) -> Self {
        Self { node: (0..equations as u32).collect(), multiplier: vec![false; equations], ..Self::default() }
    }

    /// `per_node` equations a node, numbered node by node, none a multiplier.
    pub fn blocked(nodes: usize, per_node: usize) -> Self {
        let equations = nodes * per_node;
        Self {
            node: (0..equations).map(|i| (i / per_node) as u32).collect(),
            multiplier: vec![false; equations],
            ..Self::default()
        }
    }

    /// Number of equations, inactive ones included.
    pub fn equations(&self) -> usize {
        self.node.len()
    }

    /// Whether an equation is none.
    pub fn is_inactive(&self, equation: usize) -> bool {
        self.inactive.get(equation).is_some_and(|is_inactive| *is_inactive)
    }
}

/// The equations `(bulk + coupling) x = b`, with stamps that tell changes since the last solve.
///
/// `coupling` touches few equations (the contact interface: slave and master displacements and multipliers); rows of
/// multipliers are empty in `bulk`. A stamp that equals the one of the previous solve with the same solver promises
/// that the thing it stamps is unchanged, so work done on it is reused. A changed layout changes `bulk_graph`.
#[derive(Debug, Clone, Copy)]
pub struct System<'a> {
    /// Meaning of the equations.
    pub layout: &'a Layout,
    /// The part that does not come from contact.
    pub bulk: &'a Csr,
    /// Symmetry of `bulk`.
    pub bulk_symmetry: Symmetry,
    /// Stamp of the layout and of the pattern of `bulk`.
    pub bulk_graph: u64,
    /// Stamp of the values of `bulk`.
    pub bulk_values: u64,
    /// The part that comes from contact.
    pub coupling: Option<&'a Csr>,
    /// Stamp of the pattern of `coupling`.
    pub coupling_graph: u64,
    /// Stamp of the values of `coupling`.
    pub coupling_values: u64,
    /// Whether `coupling` is symmetric.
    pub coupling_symmetric: bool,
    /// Equations of other ranks, where several share the system: own rows are complete, those of ghosts only where multipliers act on
    /// their node. The bulk then has rows for the first equations alone, and the coupling the rest of them. `None` where all equations
    /// are here.
    pub shared: Option<&'a Ghosts>,
}

impl<'a> System<'a> {
    /// A system without coupling; all stamps are zero, set them when the solver is used again.
    pub fn bulk(layout: &'a Layout, bulk: &'a Csr, bulk_symmetry: Symmetry) -> Self {
        Self {
            layout,
            bulk,
            bulk_symmetry,
            bulk_graph: 0,
            bulk_values: 0,
            coupling: None,
            coupling_graph: 0,
            coupling_values: 0,
            coupling_symmetric: true,
            shared: None,
        }
    }

    /// Number of equations, inactive ones included.
    pub fn equations(&self) -> usize {
        self.shared.map_or(self.bulk.rows, Ghosts::all)
    }

    /// The coupling when it has entries.
    pub fn active_coupling(&self) -> Option<&'a Csr> {
        self.coupling.filter(|coupling| coupling.entries() > 0)
    }

    /// Number of active equations.
    pub fn free(&self) -> usize {
        self.equations() - self.layout.inactive.iter().filter(|is_inactive| **is_inactive).count()
    }

    /// Sets the entries of inactive rows to zero.
    pub fn clear_inactive(&self, values: &mut [f64]) {
        let inactive = &self.layout.inactive;
        let known = values.len().min(inactive.len());
        parallel::parts_mut(&mut values[..known], CHUNK, &|first, values| {
            let both = values.iter_mut().zip(&inactive[first..]);
            both.filter(|(_, is_inactive)| **is_inactive).for_each(|(value, _)| *value = 0.0);
        });
    }

    /// Entries of a row of both parts that are not zero: columns with values, those of the bulk first.
    pub(crate) fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + use<'a> {
        let layout = self.layout;
        let of = move |matrix: &'a Csr| matrix.row(i).0.iter().zip(matrix.row(i).1);
        let parts = match layout.is_inactive(i) {
            true => [None, None],
            false => [Some(self.bulk).filter(|bulk| i < bulk.rows), self.active_coupling()],
        };
        let all = parts.into_iter().flatten().flat_map(of).map(|(&j, &value)| (j as usize, value));
        all.filter(move |(j, value)| *value != 0.0 && !layout.is_inactive(*j))
    }

    /// The product of a row of both parts with `x`, which is zero at inactive equations.
    pub(crate) fn row_product(&self, i: usize, x: &[f64]) -> f64 {
        let of = |matrix: &Csr| {
            let (columns, values) = matrix.row(i);
            columns.iter().zip(values).map(|(&j, value)| value * x[j as usize]).sum::<f64>()
        };
        let bulk = if i < self.bulk.rows { of(self.bulk) } else { 0.0 };
        bulk + self.active_coupling().map_or(0.0, of)
    }

    /// `y = (bulk + coupling) x`, zero at inactive equations, as `x` is.
    ///
    /// # Panics
    /// When a length is not the number of equations.
    pub fn mul_vec(&self, x: &[f64], y: &mut [f64]) {
        self.bulk.mul_vec(x, y);
        self.add_coupling_product(x, y);
        self.clear_inactive(y);
    }

    /// As [`System::mul_vec`], to the bit, at active equations, with the runs of the bulk's rows.
    pub(crate) fn mul_vec_by_runs(&self, runs: &Runs, x: &[f64], y: &mut [f64]) {
        self.bulk_product(runs, x, y);
        self.add_coupling_product(x, y);
    }

    /// `y = bulk x`.
    pub(crate) fn bulk_product(&self, runs: &Runs, x: &[f64], y: &mut [f64]) {
        let (own, others) = y.split_at_mut(self.bulk.rows);
        self.bulk.mul_vec_by_runs(runs, &x[..self.bulk.rows], own);
        others.fill(0.0);
    }

    /// `y += coupling x`.
    pub(crate) fn add_coupling_product(&self, x: &[f64], y: &mut [f64]) {
        if let Some(coupling) = self.active_coupling() {
            coupling.mul_vec_add(x, y);
        }
    }

    /// `r = b - (bulk + coupling) x`; gives the Euclidean norm of `r`.
    ///
    /// # Panics
    /// When a length is not the number of equations.
    pub fn residual(&self, b: &[f64], x: &[f64], r: &mut [f64]) -> f64 {
        r.copy_from_slice(b);
        self.bulk.mul_vec_subtract(&x[..self.bulk.rows], &mut r[..self.bulk.rows]);
        if let Some(coupling) = self.active_coupling() {
            coupling.mul_vec_subtract(x, r);
        }
        self.clear_inactive(r);
        vector::norm(r)
    }

    /// `bulk + coupling` as one matrix.
    pub fn merged(&self) -> Csr {
        match self.active_coupling() {
            Some(coupling) => self.bulk.plus(coupling),
            None => self.bulk.clone(),
        }
    }

    /// Own equations and those of other ranks.
    pub(crate) fn ghosts(&self) -> Ghosts {
        self.shared.cloned().unwrap_or_else(|| Ghosts::none(self.equations()))
    }

    /// Whether the sum of both parts is symmetric as far as the caller knows.
    pub fn is_symmetric(&self) -> bool {
        self.bulk_symmetry != Symmetry::General && (self.active_coupling().is_none() || self.coupling_symmetric)
    }
}

/// The stamps of a system, to compare with those of the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Stamps {
    pub(crate) bulk_graph: u64,
    pub(crate) bulk_values: u64,
    pub(crate) is_coupled: bool,
    pub(crate) coupling_graph: u64,
    pub(crate) coupling_values: u64,
}

impl Stamps {
    pub(crate) fn of(system: &System<'_>) -> Self {
        Self {
            bulk_graph: system.bulk_graph,
            bulk_values: system.bulk_values,
            is_coupled: system.active_coupling().is_some(),
            coupling_graph: system.coupling_graph,
            coupling_values: system.coupling_values,
        }
    }
}
