//! Multifrontal factorisation: Cholesky, or LU with pivoting inside the fronts, in parallel over the elimination tree.
//!
//! Every front adds up the updates of its children in their order, so the result does not depend on the threads.

mod eliminate;
mod pool;
mod scatter;
mod store;
mod substitute;

use std::sync::Arc;

use crate::csr::Csr;
use crate::square::Square;
use crate::symbolic::Symbolic;
use eliminate::Elimination;
use pool::BufferPool;
pub(crate) use scatter::Scatter;
pub(crate) use store::Precision;
use store::Store;

/// Kind of factorisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Factorization {
    /// `L Lᵀ` of a symmetric positive definite matrix.
    Cholesky,
    /// `L U`, rows exchanged within fronts; pivots below `limit` are replaced by it.
    Lu {
        /// Smallest pivot allowed, in the scaled matrix.
        limit: f64,
    },
}

/// Scale factors: the matrix factorised is `diag(row) A diag(column)`.
#[derive(Debug, Clone)]
pub(crate) struct Scaling {
    pub(crate) row: Vec<f64>,
    pub(crate) column: Vec<f64>,
}

impl Scaling {
    /// The values of the scaled matrix.
    pub(crate) fn apply(&self, matrix: &Csr) -> Vec<f64> {
        let mut values = matrix.values.clone();
        for i in 0..matrix.rows {
            let row = &mut values[matrix.row_starts[i]..matrix.row_starts[i + 1]];
            for (value, &j) in row.iter_mut().zip(matrix.columns_of(i)) {
                *value *= self.row[i] * self.column[j as usize];
            }
        }
        values
    }
}

/// A factorised matrix; the equations kept last form the dense Schur complement `root`.
#[derive(Debug)]
pub(crate) struct Factor {
    symbolic: Arc<Symbolic>,
    kind: Factorization,
    store: Store,
    scaling: Scaling,
    /// Schur complement on the equations kept last; not scaled.
    pub(crate) root: Square,
    /// Equations whose pivot was replaced, or is tiny against the diagonal of the matrix.
    pub(crate) suspicious: Vec<usize>,
}

/// Why there is no factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NotPositiveDefinite;

/// A Cholesky pivot that lost all digits against the diagonal of the matrix says the matrix is singular.
const LOST_PIVOT: f64 = 1e-13;

impl Factor {
    /// Factorises `matrix`, whose entries go where `scatter` says; `reuse` gives its memory.
    ///
    /// # Errors
    /// When `kind` is Cholesky and the matrix is not positive definite.
    pub(crate) fn new(
        symbolic: &Arc<Symbolic>,
        scatter: &Scatter,
        matrix: &Csr,
        kind: Factorization,
        precision: Precision,
        scaling: Scaling,
        reuse: Option<Factor>,
    ) -> Result<Self, NotPositiveDefinite> {
        let (mut store, memory) = reuse.map_or_else(Default::default, |old| (old.store, old.root.into_values()));
        store.reserve(symbolic, kind == Factorization::Cholesky, precision);
        let work = Elimination {
            symbolic,
            scatter,
            values: &matrix.values,
            scaling: &scaling,
            kind,
            pool: BufferPool::default(),
        };
        let (tops, root) = symbolic.tops();
        let updates = work.subtrees(&mut store.blocks(), 0, &tops)?;
        work.pool.clear();
        let root = root.map_or_else(Square::default, |root| work.root(root, &tops, &updates, memory));
        drop(updates);
        let mut factor = Self { symbolic: symbolic.clone(), kind, store, scaling, root, suspicious: Vec::new() };
        factor.suspicious = factor.find_suspicious(matrix);
        factor.unscale_root();
        Ok(factor)
    }

    /// Whether the factors are kept in single precision.
    pub(crate) fn is_single(&self) -> bool {
        self.store.precision() == Precision::Single
    }

    fn unscale_root(&mut self) {
        let kept = &self.symbolic.equation[self.symbolic.interior..];
        let scaling = &self.scaling;
        self.root.each_tile(4, |tile| {
            let rows = &kept[tile.row..];
            for (column, &j) in tile.values.chunks_mut(rows.len()).zip(&kept[tile.column..tile.column + tile.width]) {
                for (value, &i) in column.iter_mut().zip(rows) {
                    *value /= scaling.row[i as usize] * scaling.column[j as usize];
                }
            }
        });
    }

    fn find_suspicious(&self, matrix: &Csr) -> Vec<usize> {
        let mut found = Vec::new();
        for (at, pivots) in self.store.pivots.iter().enumerate() {
            let equations = &self.symbolic.equation[self.symbolic.fronts[at].columns.clone()];
            match self.kind {
                Factorization::Lu { .. } => {
                    found.extend(pivots.replaced.iter().map(|&k| equations[k as usize] as usize))
                }
                Factorization::Cholesky => {
                    for (pivot, &i) in self.store.diagonal(at).into_iter().zip(equations) {
                        let i = i as usize;
                        let diagonal = matrix.get(i, i) * self.scaling.row[i] * self.scaling.column[i];
                        if pivot * pivot <= LOST_PIVOT * diagonal {
                            found.push(i);
                        }
                    }
                }
            }
        }
        found
    }
}
