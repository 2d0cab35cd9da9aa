//! The ways to an inverse that the direct engine can take.

use std::sync::Arc;

use crate::csr::Csr;
use crate::equilibrate;
use crate::interface::{DenseFactor, Interface};
use crate::lu::SparseLu;
use crate::multifrontal::{Factor, Factorization, NotPositiveDefinite, Precision, Scatter};
use crate::solver::SolveError;
use crate::symbolic::Symbolic;
use crate::system::System;

/// Pivots of the equilibrated matrix below this are replaced; Krylov iteration makes up for it.
const PIVOT_LIMIT: f64 = 1e-9;

/// The sparse part of a path: structure and numbers, each kept while its stamp is unchanged.
pub(crate) struct Sparse {
    pub(crate) symbolic: Arc<Symbolic>,
    scatter: Option<(Scatter, bool)>,
    pub(crate) factor: Option<Factor>,
}

impl Sparse {
    /// Orders `pattern`, keeping the equations of `last` for a dense root.
    pub(crate) fn new(pattern: &Csr, system: &System<'_>, last: &[bool]) -> Result<Self, SolveError> {
        let symbolic = Symbolic::new(pattern, system.layout, last)?;
        if let Some(front) = symbolic.fronts.iter().find(|front| front.order().pow(2) > u32::MAX as usize) {
            return Err(SolveError::Failed(format!(
                "the factor needs a dense block of {} equations: use an iterative engine",
                front.order()
            )));
        }
        Ok(Self { symbolic: Arc::new(symbolic), scatter: None, factor: None })
    }

    /// Factorises `matrix`, which has the pattern given to [`Sparse::new`].
    pub(crate) fn factorise(
        &mut self,
        matrix: &Csr,
        cholesky: bool,
        precision: Precision,
    ) -> Result<(), NotPositiveDefinite> {
        if self.scatter.as_ref().is_none_or(|(_, symmetric)| *symmetric && !cholesky) {
            self.scatter = Some((Scatter::new(&self.symbolic, matrix, cholesky), cholesky));
        }
        let (scatter, _) = self.scatter.as_ref().expect("made above");
        let (kind, scaling) = if cholesky {
            (Factorization::Cholesky, equilibrate::of_diagonal(matrix))
        } else {
            (Factorization::Lu { limit: PIVOT_LIMIT }, equilibrate::factors(matrix))
        };
        let old = self.factor.take();
        self.factor = Some(Factor::new(&self.symbolic, scatter, matrix, kind, precision, scaling, old)?);
        Ok(())
    }
}

/// A factorised system.
pub(crate) enum FactorizedSystem {
    /// One dense LU of everything.
    Dense(DenseFactor),
    /// Multifrontal factorisation of the whole matrix.
    Whole(Sparse),
    /// Multifrontal factorisation of the bulk, dense LU of the interface.
    Interface(Sparse, Interface),
    /// LU with column ordering.
    SparseLu(SparseLu),
}

impl FactorizedSystem {
    /// Replaces `x` by an approximation of `A⁻¹ x`, exact but for rounding and replaced pivots.
    pub(crate) fn apply(&self, x: &mut [f64]) {
        match self {
            Self::Dense(factor) => factor.solve(x),
            Self::Whole(sparse) => sparse.factor.as_ref().expect("factorised").solve(x, |_| {}),
            Self::Interface(sparse, interface) => {
                let factor = sparse.factor.as_ref().expect("factorised");
                factor.solve(x, |kept| interface.solve(&factor.root, kept));
            }
            Self::SparseLu(factor) => factor.solve_in_place(x),
        }
    }

    /// Whether factors kept from an earlier coupling turned out to be of no use.
    pub(crate) fn is_lost(&self) -> bool {
        matches!(self, Self::Interface(_, interface) if interface.is_lost())
    }

    /// Whether factors are kept in single precision.
    pub(crate) fn is_single(&self) -> bool {
        match self {
            Self::Whole(sparse) | Self::Interface(sparse, _) => sparse.factor.as_ref().is_some_and(Factor::is_single),
            Self::Dense(_) | Self::SparseLu(_) => false,
        }
    }

    /// Number of pivots that hint at a singular matrix.
    pub(crate) fn suspicious(&self) -> usize {
        let of = |sparse: &Sparse| sparse.factor.as_ref().map_or(0, |factor| factor.suspicious.len());
        match self {
            Self::Dense(factor) => usize::from(factor.is_suspicious()),
            Self::Whole(sparse) => of(sparse),
            Self::Interface(sparse, interface) => of(sparse) + usize::from(interface.is_suspicious()),
            Self::SparseLu(_) => 0,
        }
    }
}

/// One dense LU of the whole system.
pub(crate) fn dense(system: &System<'_>) -> FactorizedSystem {
    let n = system.equations();
    let matrix = system.merged();
    let scaling = equilibrate::factors(&matrix);
    let mut values = vec![0.0; n * n];
    for i in 0..n {
        let (columns, entries) = matrix.row(i);
        for (&j, value) in columns.iter().zip(entries) {
            values[i + n * j as usize] = value * scaling.row[i] * scaling.column[j as usize];
        }
    }
    FactorizedSystem::Dense(DenseFactor::new(values, scaling))
}

/// Equations that must stay in the dense interface: those of the coupling and those the bulk knows nothing of.
pub(crate) fn interface_equations(system: &System<'_>) -> Vec<bool> {
    let layout = system.layout;
    let mut kept: Vec<bool> =
        (0..system.equations()).map(|i| layout.multiplier[i] || system.bulk.row(i).0.is_empty()).collect();
    if let Some(coupling) = system.active_coupling() {
        for i in (0..coupling.rows).filter(|&i| !layout.is_inactive(i)) {
            let columns = coupling.row(i).0;
            if !columns.is_empty() {
                kept[i] = true;
                columns.iter().for_each(|&j| kept[j as usize] = true);
            }
        }
    }
    kept.iter_mut().zip(&layout.inactive).for_each(|(kept, is_inactive)| *kept &= !is_inactive);
    kept
}

/// The coupling among the `equations` of an interface; `local` gives the place of each among them, of inactive ones none.
pub(crate) fn local_coupling(system: &System<'_>, equations: &[u32], local: impl Fn(u32) -> Option<usize>) -> Csr {
    let mut triplets = Vec::new();
    if let Some(coupling) = system.active_coupling() {
        for (at, &i) in equations.iter().enumerate() {
            let (columns, values) = coupling.row(i as usize);
            triplets.extend(columns.iter().zip(values).filter_map(|(&j, &value)| Some((at, local(j)?, value))));
        }
    }
    Csr::from_triplets(equations.len(), &triplets)
}
