//! Multifrontal factorisation: Cholesky, or LU with pivoting inside the fronts, in parallel over the elimination tree.
//!
//! Every front adds up the updates of its children in their order, so the result does not depend on the threads.

use std::sync::Arc;

use rayon::prelude::*;

use crate::csr::Csr;
use crate::dense::{self, PARALLEL_WORK, Triangle, view, view_mut};
use crate::dense_lu::{self, Pivots};
use crate::pool::Pool;
use crate::scatter::Scatter;
use crate::symbolic::{Front, Run, Symbolic};

/// Operations of a subtree below which one task does all of it.
const TASK_WORK: f64 = 2e7;
/// Entries of the pivot columns of a subtree below which one task solves with all of it.
const TASK_ENTRIES: f64 = 2e5;

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

struct Elimination<'a> {
    symbolic: &'a Symbolic,
    scatter: &'a Scatter,
    values: &'a [f64],
    kind: Kind,
    pool: Pool,
}

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

    /// Solves with all that is eliminated; `between` gets the part of the equations kept last and must solve for it.
    ///
    /// `x` is in the order of the equations; `between` in that of [`Symbolic::equation`] after its interior.
    pub(crate) fn solve(&self, x: &mut [f64], between: impl FnOnce(&mut [f64])) {
        let symbolic = &*self.symbolic;
        let mut y: Vec<f64> = match &self.scaling {
            Some(scaling) => symbolic.equation.iter().map(|&i| x[i as usize] * scaling.row[i as usize]).collect(),
            None => symbolic.equation.iter().map(|&i| x[i as usize]).collect(),
        };
        let (tops, root) = symbolic.tops();
        let (inside, kept) = y.split_at_mut(symbolic.interior);
        let updates = self.forward_subtrees(inside, 0, &tops);
        if root.is_some() {
            for (&top, update) in tops.iter().zip(&updates) {
                add_runs(&symbolic.fronts[top].runs, update, kept);
            }
            if let Some(scaling) = &self.scaling {
                kept.iter_mut()
                    .zip(&symbolic.equation[symbolic.interior..])
                    .for_each(|(value, &i)| *value /= scaling.row[i as usize]);
            }
            between(kept);
            if let Some(scaling) = &self.scaling {
                kept.iter_mut()
                    .zip(&symbolic.equation[symbolic.interior..])
                    .for_each(|(value, &i)| *value /= scaling.column[i as usize]);
            }
        }
        let known: Vec<Vec<f64>> = tops.iter().map(|&top| gather_runs(&symbolic.fronts[top], kept)).collect();
        self.backward_subtrees(inside, 0, &tops, known);
        for (&i, value) in symbolic.equation.iter().zip(&y) {
            let scale = self.scaling.as_ref().map_or(1.0, |scaling| scaling.column[i as usize]);
            x[i as usize] = value * scale;
        }
    }

    /// Pieces of `values`, one for each of the consecutive subtrees `tops`, the first of which starts at `begin`.
    fn pieces<'v>(&self, values: &'v mut [f64], begin: usize, tops: &[usize]) -> Vec<&'v mut [f64]> {
        let mut rest = values;
        let mut at = begin;
        tops.iter()
            .map(|&top| {
                let end = self.symbolic.fronts[top].columns.end;
                let (piece, tail) = std::mem::take(&mut rest).split_at_mut(end - at);
                (rest, at) = (tail, end);
                piece
            })
            .collect()
    }

    fn is_small(&self, front: usize) -> bool {
        let front = &self.symbolic.fronts[front];
        front.subtree_work < TASK_ENTRIES * 100.0
    }

    fn forward_subtrees(&self, y: &mut [f64], begin: usize, tops: &[usize]) -> Vec<Vec<f64>> {
        let pieces = self.pieces(y, begin, tops);
        if tops.len() > 1 && tops.iter().any(|&top| !self.is_small(top)) {
            pieces.into_par_iter().zip(tops).with_max_len(1).map(|(piece, &top)| self.forward(piece, top)).collect()
        } else {
            pieces.into_iter().zip(tops).map(|(piece, &top)| self.forward(piece, top)).collect()
        }
    }

    /// Forward substitution in a subtree; gives what its rows lose.
    fn forward(&self, y: &mut [f64], top: usize) -> Vec<f64> {
        let fronts = &self.symbolic.fronts;
        let front = &fronts[top];
        let (inner, own) = y.split_at_mut(y.len() - front.pivots());
        let begin = front.columns.start - inner.len();
        let updates = self.forward_subtrees(inner, begin, &front.children);
        let mut local = vec![0.0; front.order()];
        local[..front.pivots()].copy_from_slice(own);
        for (&child, update) in front.children.iter().zip(&updates) {
            add_runs(&fronts[child].runs, update, &mut local);
        }
        let block = &self.blocks[top];
        let panel = view(&block.panel, front.order(), front.pivots());
        let triangle = match self.kind {
            Kind::Cholesky => Triangle::Lower,
            Kind::Lu { .. } => {
                block.pivots.permute(&mut local);
                Triangle::UnitLower
            }
        };
        dense::forward(panel, triangle, &mut local);
        own.copy_from_slice(&local[..front.pivots()]);
        local.drain(..front.pivots());
        local
    }

    fn backward_subtrees(&self, y: &mut [f64], begin: usize, tops: &[usize], known: Vec<Vec<f64>>) {
        let pieces = self.pieces(y, begin, tops);
        let parallel = tops.len() > 1 && tops.iter().any(|&top| !self.is_small(top));
        let items = pieces.into_iter().zip(known).zip(tops).collect();
        dense::for_each(parallel, items, |((piece, known), &top)| self.backward(piece, top, known));
    }

    /// Backward substitution in a subtree whose rows are `known`.
    fn backward(&self, y: &mut [f64], top: usize, known: Vec<f64>) {
        let front = &self.symbolic.fronts[top];
        let (inner, own) = y.split_at_mut(y.len() - front.pivots());
        let mut local = Vec::with_capacity(front.order());
        local.extend_from_slice(own);
        local.extend_from_slice(&known);
        let block = &self.blocks[top];
        let panel = view(&block.panel, front.order(), front.pivots());
        match self.kind {
            Kind::Cholesky => dense::backward_transposed(panel, &mut local),
            Kind::Lu { .. } => {
                let square = panel.subrows(0, front.pivots());
                dense::backward_upper(square, view(&block.right, front.pivots(), front.rows.len()), &mut local);
            }
        }
        own.copy_from_slice(&local[..front.pivots()]);
        let begin = front.columns.start - inner.len();
        let known = front.children.iter().map(|&c| gather_runs(&self.symbolic.fronts[c], &local)).collect();
        self.backward_subtrees(inner, begin, &front.children, known);
    }
}

fn add_runs(runs: &[Run], update: &[f64], target: &mut [f64]) {
    for run in runs {
        let target = &mut target[run.parent..run.parent + run.len];
        target.iter_mut().zip(&update[run.child..run.child + run.len]).for_each(|(t, u)| *t += u);
    }
}

fn gather_runs(front: &Front, parent: &[f64]) -> Vec<f64> {
    let mut values = Vec::with_capacity(front.rows.len());
    for run in &front.runs {
        values.extend_from_slice(&parent[run.parent..run.parent + run.len]);
    }
    values
}

impl Elimination<'_> {
    /// Updates of the consecutive subtrees `tops`, whose blocks start with front `begin`.
    fn subtrees(
        &self,
        blocks: &mut [Block],
        begin: usize,
        tops: &[usize],
    ) -> Result<Vec<Vec<f64>>, NotPositiveDefinite> {
        let mut rest = blocks;
        let mut at = begin;
        let mut pieces = Vec::with_capacity(tops.len());
        for &top in tops {
            let (piece, tail) = std::mem::take(&mut rest).split_at_mut(top + 1 - at);
            pieces.push((piece, top));
            (rest, at) = (tail, top + 1);
        }
        let large = |top: usize| self.symbolic.fronts[top].subtree_work > TASK_WORK;
        if tops.len() > 1 && tops.iter().any(|&top| large(top)) {
            pieces.into_par_iter().with_max_len(1).map(|(piece, top)| self.eliminate(piece, top)).collect()
        } else {
            pieces.into_iter().map(|(piece, top)| self.eliminate(piece, top)).collect()
        }
    }

    /// Eliminates a subtree and gives its update of the rows of its top, in a buffer that may be longer.
    fn eliminate(&self, blocks: &mut [Block], top: usize) -> Result<Vec<f64>, NotPositiveDefinite> {
        let front = &self.symbolic.fronts[top];
        let (own, inner) = blocks.split_last_mut().expect("a subtree has a top");
        let updates = self.subtrees(inner, front.first, &front.children)?;
        let (pivots, order, rows) = (front.pivots(), front.order(), front.rows.len());
        clear(&mut own.panel, order * pivots);
        if self.kind != Kind::Cholesky {
            clear(&mut own.right, pivots * rows);
        }
        self.scatter_entries(top, &mut own.panel, &mut own.right);
        let symmetric = self.kind == Kind::Cholesky;
        for (&child, update) in front.children.iter().zip(&updates) {
            let child = &self.symbolic.fronts[child];
            extend_panel(child, update, symmetric, &mut own.panel, order, pivots);
            if !symmetric {
                extend_right(child, update, &mut own.right, pivots);
            }
        }
        let mut update = self.pool.take(rows * rows);
        match self.kind {
            Kind::Cholesky => {
                dense::cholesky_panel(&mut own.panel, order, pivots).map_err(|_| NotPositiveDefinite)?;
                dense::symmetric_update(&mut update, &own.panel, order, pivots);
            }
            Kind::Lu { limit } => {
                own.pivots = factorise_front(&mut own.panel, &mut own.right, order, pivots, limit);
                let below = view(&own.panel, order, pivots).subrows(pivots, rows);
                dense::general_update(view_mut(&mut update, rows, rows), below, view(&own.right, pivots, rows));
            }
        }
        for (&child, child_update) in front.children.iter().zip(&updates) {
            extend_update(&self.symbolic.fronts[child], child_update, symmetric, &mut update, rows, pivots);
        }
        updates.into_iter().for_each(|update| self.pool.give(update));
        Ok(update)
    }

    /// The Schur complement on the equations kept last, full.
    fn root(&self, root: usize, tops: &[usize], updates: &[Vec<f64>]) -> Vec<f64> {
        let order = self.symbolic.fronts[root].order();
        let mut values = vec![0.0; order * order];
        self.scatter_entries(root, &mut values, &mut []);
        let symmetric = self.kind == Kind::Cholesky;
        for (&top, update) in tops.iter().zip(updates) {
            let front = &self.symbolic.fronts[top];
            extend_panel(front, update, symmetric, &mut values, order, order);
        }
        if symmetric {
            mirror_lower(&mut values, order);
        }
        values
    }

    fn scatter_entries(&self, front: usize, panel: &mut [f64], right: &mut [f64]) {
        for entry in self.scatter.of(front, self.kind == Kind::Cholesky) {
            let value = self.values[entry.source as usize];
            match (entry.target as usize).checked_sub(panel.len()) {
                None => panel[entry.target as usize] += value,
                Some(at) => right[at] += value,
            }
        }
    }
}

fn clear(values: &mut Vec<f64>, len: usize) {
    if values.len() == len {
        values.fill(0.0);
    } else {
        *values = vec![0.0; len];
    }
}

/// LU of a front, with pivots sought among the rows of the pivots.
fn factorise_front(panel: &mut [f64], right: &mut [f64], order: usize, pivots: usize, limit: f64) -> Pivots {
    let rows = order - pivots;
    let mut square = vec![0.0; pivots * pivots];
    for (column, from) in square.chunks_mut(pivots).zip(panel.chunks(order)) {
        column.copy_from_slice(&from[..pivots]);
    }
    let exchanges = dense_lu::factorise(&mut square, pivots, limit);
    for (column, to) in square.chunks(pivots).zip(panel.chunks_mut(order)) {
        to[..pivots].copy_from_slice(column);
    }
    let factor = view(&square, pivots, pivots);
    dense::solve_upper_from_right(view_mut(panel, order, pivots).subrows_mut(pivots, rows), factor);
    let mut right = view_mut(right, pivots, rows);
    exchanges.permute_rows(right.as_mut());
    dense::solve_unit_lower(right, factor);
    exchanges
}

/// Adds the columns of a child's update that are pivots of the parent, except their part right of the pivots.
fn extend_panel(child: &Front, update: &[f64], symmetric: bool, panel: &mut [f64], order: usize, pivots: usize) {
    let rows = child.rows.len();
    for run in child.runs.iter().filter(|run| run.parent < pivots) {
        let columns = &mut panel[run.parent * order..(run.parent + run.len) * order];
        each_column(columns, order, |k, column| {
            let from = &update[(run.child + k) * rows..(run.child + k + 1) * rows];
            add_below(child, from, if symmetric { run.child + k } else { 0 }, 0, column);
        });
    }
}

/// Adds the rows of a child's update that are pivots of the parent, in columns that are not.
fn extend_right(child: &Front, update: &[f64], right: &mut [f64], pivots: usize) {
    let rows = child.rows.len();
    let own = child.runs.iter().filter(|run| run.parent < pivots);
    for columns in child.runs.iter().filter(|run| run.parent >= pivots) {
        for k in 0..columns.len {
            let from = &update[(columns.child + k) * rows..(columns.child + k + 1) * rows];
            let to = &mut right[(columns.parent + k - pivots) * pivots..(columns.parent + k + 1 - pivots) * pivots];
            for run in own.clone() {
                let to = &mut to[run.parent..run.parent + run.len];
                to.iter_mut().zip(&from[run.child..run.child + run.len]).for_each(|(t, f)| *t += f);
            }
        }
    }
}

/// Adds the part of a child's update that stays in the update of the parent.
fn extend_update(child: &Front, from: &[f64], symmetric: bool, update: &mut [f64], order: usize, pivots: usize) {
    let rows = child.rows.len();
    let first = child.runs.iter().find(|run| run.parent >= pivots).map_or(rows, |run| run.child);
    for run in child.runs.iter().filter(|run| run.parent >= pivots) {
        let begin = run.parent - pivots;
        each_column(&mut update[begin * order..(begin + run.len) * order], order, |k, column| {
            let from = &from[(run.child + k) * rows..(run.child + k + 1) * rows];
            add_below(child, from, if symmetric { run.child + k } else { first }, pivots, column);
        });
    }
}

/// Adds rows `first..` of a column of a child's update to a column whose first row is `offset` in the parent.
fn add_below(child: &Front, from: &[f64], first: usize, offset: usize, column: &mut [f64]) {
    let skip = child.runs.partition_point(|run| run.child + run.len <= first);
    for run in &child.runs[skip..] {
        let begin = first.max(run.child);
        let len = run.child + run.len - begin;
        let at = run.parent + (begin - run.child) - offset;
        column[at..at + len].iter_mut().zip(&from[begin..begin + len]).for_each(|(c, f)| *c += f);
    }
}

fn each_column(columns: &mut [f64], order: usize, work: impl Fn(usize, &mut [f64]) + Sync + Send) {
    if columns.len() > PARALLEL_WORK / 16 {
        columns.par_chunks_mut(order).enumerate().with_min_len(4).for_each(|(k, column)| work(k, column));
    } else {
        columns.chunks_mut(order).enumerate().for_each(|(k, column)| work(k, column));
    }
}

/// Copies the lower triangle to the upper one, tile by tile.
fn mirror_lower(values: &mut [f64], order: usize) {
    const TILE: usize = 64;
    for block in (0..order).step_by(TILE) {
        let (left, right) = values.split_at_mut(((block + TILE).min(order)) * order);
        let block_end = (block + TILE).min(order);
        for j in block..block_end {
            for i in block..j {
                left[i + j * order] = left[j + i * order];
            }
        }
        let source = &left[block * order..];
        each_column(right, order, |k, column| {
            let j = block_end + k;
            for i in block..block_end {
                column[i] = source[j + (i - block) * order];
            }
        });
    }
}
