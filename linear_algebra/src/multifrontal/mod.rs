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

/// The numbers of all fronts one after the other, in memory that serves again.
#[derive(Debug, Default)]
struct Store {
    /// Pivot columns of each front, `order × pivots`.
    panels: Vec<f64>,
    /// Pivot rows right of the pivots of each front, `pivots × rows`; empty for Cholesky.
    rights: Vec<f64>,
    pivots: Vec<Pivots>,
    /// Where the panel and the right part of each front start, and where the last ones end.
    starts: Vec<[usize; 2]>,
}

/// The numbers of one front.
struct Block<'a> {
    panel: &'a mut [f64],
    right: &'a mut [f64],
    pivots: &'a mut Pivots,
}

impl Store {
    /// Makes room, whose numbers are of any value.
    fn reserve(&mut self, symbolic: &Symbolic, kind: Kind) {
        self.starts = vec![[0, 0]];
        let [mut panel, mut right] = [0, 0];
        for front in &symbolic.fronts[..symbolic.eliminated_fronts()] {
            panel += front.order() * front.pivots();
            right += if kind == Kind::Cholesky { 0 } else { front.pivots() * front.rows.len() };
            self.starts.push([panel, right]);
        }
        for (values, len) in [(&mut self.panels, panel), (&mut self.rights, right)] {
            if values.len() != len {
                *values = Vec::new();
                *values = vec![0.0; len];
            }
        }
        self.pivots.resize_with(self.starts.len() - 1, Pivots::default);
    }

    fn blocks(&mut self) -> Vec<Block<'_>> {
        let (mut panels, mut rights) = (&mut self.panels[..], &mut self.rights[..]);
        let mut blocks = Vec::with_capacity(self.pivots.len());
        for (pivots, starts) in self.pivots.iter_mut().zip(self.starts.windows(2)) {
            let (panel, after) = panels.split_at_mut(starts[1][0] - starts[0][0]);
            let (right, after_right) = rights.split_at_mut(starts[1][1] - starts[0][1]);
            (panels, rights) = (after, after_right);
            blocks.push(Block { panel, right, pivots });
        }
        blocks
    }

    fn panel(&self, front: usize) -> &[f64] {
        &self.panels[self.starts[front][0]..self.starts[front + 1][0]]
    }

    fn right(&self, front: usize) -> &[f64] {
        &self.rights[self.starts[front][1]..self.starts[front + 1][1]]
    }
}

/// A factorised matrix; the equations kept last form the dense Schur complement `root`.
#[derive(Debug)]
pub(crate) struct Factor {
    symbolic: Arc<Symbolic>,
    kind: Kind,
    store: Store,
    pool: Pool,
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
        let (mut store, pool, memory) = reuse.map_or_else(Default::default, |old| (old.store, old.pool, old.root));
        store.reserve(symbolic, kind);
        let scaled = scaling.as_ref().map(|scaling| scaling.apply(matrix));
        let values = scaled.as_deref().unwrap_or(&matrix.values);
        let work = Elimination { symbolic, scatter, values, kind, pool };
        let (tops, root) = symbolic.tops();
        let updates = work.subtrees(&mut store.blocks(), 0, &tops)?;
        let root = root.map_or_else(Vec::new, |root| work.root(root, &tops, &updates, memory));
        let pool = work.pool;
        updates.into_iter().for_each(|update| pool.give(update));
        let mut factor =
            Self { symbolic: symbolic.clone(), kind, store, pool, scaling: None, root, suspicious: Vec::new() };
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
        for (at, pivots) in self.store.pivots.iter().enumerate() {
            let front = &self.symbolic.fronts[at];
            let start = front.columns.start;
            match self.kind {
                Kind::Lu { .. } => {
                    found.extend(pivots.replaced.iter().map(|&k| self.symbolic.equation[start + k as usize]));
                }
                Kind::Cholesky => {
                    let panel = self.store.panel(at);
                    for k in 0..front.pivots() {
                        let pivot = panel[k + front.order() * k];
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
