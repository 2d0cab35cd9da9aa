//! Multifrontal factorisation: Cholesky, or LU with pivoting inside the fronts, in parallel over the elimination tree.
//!
//! Every front adds up the updates of its children in their order, so the result does not depend on the threads.

mod eliminate;
mod pool;
mod scatter;
mod substitute;

use std::sync::Arc;

use crate::csr::Csr;
use crate::dense_lu::Pivots;
use crate::symbolic::Symbolic;
use eliminate::Elimination;
use pool::Pool;
pub(crate) use scatter::Scatter;

/// Which factorisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
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
            for at in matrix.row_starts[i]..matrix.row_starts[i + 1] {
                values[at] *= self.row[i] * self.column[matrix.columns[at] as usize];
            }
        }
        values
    }
}

/// The numbers of one front: the pivot columns, and for LU also the pivot rows.
#[derive(Debug, Default)]
struct Block {
    /// Pivot columns, `order × pivots`.
    panel: Vec<f64>,
    /// Pivot rows right of the pivots, `pivots × rows`; empty for Cholesky.
    right: Vec<f64>,
    pivots: Pivots,
}

/// A factorised matrix; the equations kept last form the dense Schur complement `root`.
#[derive(Debug)]
pub(crate) struct Factor {
    symbolic: Arc<Symbolic>,
    kind: Kind,
    blocks: Vec<Block>,
    scaling: Option<Scaling>,
    /// Schur complement on the equations kept last, column-major and full; not scaled.
    pub(crate) root: Vec<f64>,
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
        kind: Kind,
        scaling: Option<Scaling>,
        reuse: Option<Factor>,
    ) -> Result<Self, NotPositiveDefinite> {
        let eliminated = symbolic.eliminated_fronts();
        let mut blocks = reuse.map_or_else(Vec::new, |old| old.blocks);
        blocks.resize_with(eliminated, Block::default);
        let scaled = scaling.as_ref().map(|scaling| scaling.apply(matrix));
        let values = scaled.as_deref().unwrap_or(&matrix.values);
        let work = Elimination { symbolic, scatter, values, kind, pool: Pool::default() };
        let (tops, root) = symbolic.tops();
        let updates = work.subtrees(&mut blocks, 0, &tops)?;
        let mut factor =
            Self { symbolic: symbolic.clone(), kind, blocks, scaling: None, root: Vec::new(), suspicious: Vec::new() };
        if let Some(root) = root {
            factor.root = work.root(root, &tops, &updates);
        }
        factor.suspicious = factor.find_suspicious(matrix);
        factor.scaling = scaling;
        factor.unscale_root();
        Ok(factor)
    }

    fn unscale_root(&mut self) {
        let Some(scaling) = &self.scaling else { return };
        let kept = &self.symbolic.equation[self.symbolic.interior..];
        for (column, &j) in self.root.chunks_mut(kept.len().max(1)).zip(kept) {
            for (value, &i) in column.iter_mut().zip(kept) {
                *value /= scaling.row[i as usize] * scaling.column[j as usize];
            }
        }
    }

    fn find_suspicious(&self, matrix: &Csr) -> Vec<usize> {
        let mut found = Vec::new();
        for (front, block) in self.symbolic.fronts.iter().zip(&self.blocks) {
            let start = front.columns.start;
            match self.kind {
                Kind::Lu { .. } => {
                    found.extend(block.pivots.replaced.iter().map(|&k| self.symbolic.equation[start + k as usize]));
                }
                Kind::Cholesky => {
                    for k in 0..front.pivots() {
                        let pivot = block.panel[k + front.order() * k];
                        let i = self.symbolic.equation[start + k];
                        if pivot * pivot <= LOST_PIVOT * matrix.get(i as usize, i as usize) {
                            found.push(i);
                        }
                    }
                }
            }
        }
        found.into_iter().map(|i| i as usize).collect()
    }
}
