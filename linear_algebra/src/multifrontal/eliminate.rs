//! Elimination over the tree: every front adds up the updates of its children in their order.

use rayon::prelude::*;

use super::pool::Pool;
use super::scatter::Scatter;
use super::{Block, Kind, NotPositiveDefinite};
use crate::dense::{self, PARALLEL_WORK, view, view_mut};
use crate::dense_lu::{self, Pivots};
use crate::symbolic::{Front, Symbolic};

/// Operations of a subtree below which one task does all of it.
const TASK_WORK: f64 = 2e7;

/// What every front needs to know.
pub(super) struct Elimination<'a> {
    pub(super) symbolic: &'a Symbolic,
    pub(super) scatter: &'a Scatter,
    pub(super) values: &'a [f64],
    pub(super) kind: Kind,
    pub(super) pool: Pool,
}

impl Elimination<'_> {
    /// Updates of the consecutive subtrees `tops`, whose blocks start with front `begin`.
    pub(super) fn subtrees(
        &self,
        blocks: &mut [Block<'_>],
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
    fn eliminate(&self, blocks: &mut [Block<'_>], top: usize) -> Result<Vec<f64>, NotPositiveDefinite> {
        let front = &self.symbolic.fronts[top];
        let (own, inner) = blocks.split_last_mut().expect("a subtree has a top");
        let updates = self.subtrees(inner, front.first, &front.children)?;
        let (pivots, order, rows) = (front.pivots(), front.order(), front.rows.len());
        let Block { panel, right, pivots: exchanges } = own;
        // Above the diagonal a Cholesky factor is neither written nor read.
        for (k, column) in panel.chunks_mut(order).enumerate() {
            column[if self.kind == Kind::Cholesky { k } else { 0 }..].fill(0.0);
        }
        right.fill(0.0);
        self.scatter_entries(top, panel, right);
        let symmetric = self.kind == Kind::Cholesky;
        for (&child, update) in front.children.iter().zip(&updates) {
            let child = &self.symbolic.fronts[child];
            extend_panel(child, update, symmetric, panel, order, pivots);
            if !symmetric {
                extend_right(child, update, right, pivots);
            }
        }
        let mut update = self.pool.take(rows * rows);
        match self.kind {
            Kind::Cholesky => {
                dense::cholesky_panel(panel, order, pivots).map_err(|_| NotPositiveDefinite)?;
                dense::symmetric_update(&mut update, panel, order, pivots);
            }
            Kind::Lu { limit } => {
                **exchanges = factorise_front(panel, right, order, pivots, limit);
                let below = view(panel, order, pivots).subrows(pivots, rows);
                dense::general_update(view_mut(&mut update, rows, rows), below, view(right, pivots, rows));
            }
        }
        for (&child, child_update) in front.children.iter().zip(&updates) {
            extend_update(&self.symbolic.fronts[child], child_update, symmetric, &mut update, rows, pivots);
        }
        updates.into_iter().for_each(|update| self.pool.give(update));
        Ok(update)
    }

    /// The Schur complement on the equations kept last, full; `values` is memory to use again.
    pub(super) fn root(&self, root: usize, tops: &[usize], updates: &[Vec<f64>], mut values: Vec<f64>) -> Vec<f64> {
        let order = self.symbolic.fronts[root].order();
        values.clear();
        values.resize(order * order, 0.0);
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
