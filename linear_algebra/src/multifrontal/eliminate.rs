//! Elimination over the tree: every front adds up the updates of its children in their order.

use super::pool::BufferPool;
use super::scatter::Scatter;
use super::store::FactorBlock;
use super::{Factorization, NotPositiveDefinite, Scaling};
use crate::dense::{self, PARALLEL_WORK, view, view_mut};
use crate::dense_lu::{self, Pivots};
use crate::parallel;
use crate::square::{Square, Tile};
use crate::symbolic::{Front, Symbolic};

/// Operations of a subtree below which one task does all of it.
const TASK_WORK: f64 = 2e7;

/// Data that every front needs.
pub(super) struct Elimination<'a> {
    pub(super) symbolic: &'a Symbolic,
    pub(super) scatter: &'a Scatter,
    pub(super) values: &'a [f64],
    pub(super) scaling: &'a Scaling,
    pub(super) kind: Factorization,
    pub(super) pool: BufferPool,
}

impl Elimination<'_> {
    /// Updates of the consecutive subtrees `tops`, whose blocks start with front `begin`.
    pub(super) fn subtrees(
        &self,
        blocks: &mut [FactorBlock<'_>],
        begin: usize,
        tops: &[usize],
    ) -> Result<Vec<Square>, NotPositiveDefinite> {
        let mut rest = blocks;
        let mut at = begin;
        let mut pieces = Vec::with_capacity(tops.len());
        for &top in tops {
            let (piece, tail) = std::mem::take(&mut rest).split_at_mut(top + 1 - at);
            pieces.push((piece, top, Ok(Square::default())));
            (rest, at) = (tail, top + 1);
        }
        let large = |top: usize| self.symbolic.fronts[top].subtree_work > TASK_WORK;
        if tops.len() > 1 && tops.iter().any(|&top| large(top)) {
            parallel::each_mut(&mut pieces, 1, |_, (piece, top, update)| *update = self.eliminate(piece, *top));
        } else {
            pieces.iter_mut().for_each(|(piece, top, update)| *update = self.eliminate(piece, *top));
        }
        pieces.into_iter().map(|(_, _, update)| update).collect()
    }

    /// Eliminates a subtree and gives its update of the rows of its top.
    fn eliminate(&self, blocks: &mut [FactorBlock<'_>], top: usize) -> Result<Square, NotPositiveDefinite> {
        let front = &self.symbolic.fronts[top];
        let (own, inner) = blocks.split_last_mut().expect("a subtree has a top");
        let mut updates = self.subtrees(inner, front.first, &front.children)?;
        let (pivots, order, rows) = (front.pivots(), front.order(), front.rows.len());
        let symmetric = self.kind == Factorization::Cholesky;
        let (mut panel_memory, mut right_memory) =
            (self.pool.take(order * pivots), self.pool.take(if symmetric { 0 } else { pivots * rows }));
        let panel = &mut panel_memory[..order * pivots];
        let right = if symmetric { &mut [][..] } else { &mut right_memory[..pivots * rows] };
        // Above the diagonal a Cholesky factor is neither written nor read.
        for (k, column) in panel.chunks_mut(order).enumerate() {
            column[if symmetric { k } else { 0 }..].fill(0.0);
        }
        right.fill(0.0);
        self.each_entry(top, |row, column, value| match column.checked_sub(pivots) {
            None => panel[row + column * order] += value,
            Some(column) => right[row + column * pivots] += value,
        });
        for (&child, update) in front.children.iter().zip(&updates) {
            let child = &self.symbolic.fronts[child];
            extend_panel(child, update, panel, order, pivots);
            if !symmetric {
                extend_right(child, update, right, pivots);
            }
        }
        for (&child, update) in front.children.iter().zip(&mut updates) {
            let below = self.symbolic.fronts[child].runs.iter().find(|run| run.parent >= pivots);
            update.forget_before(below.map_or(update.order(), |run| run.child));
        }
        match self.kind {
            Factorization::Cholesky => {
                dense::cholesky_panel(panel, order, pivots).map_err(|_| NotPositiveDefinite)?;
            }
            Factorization::Lu { limit } => {
                *own.pivots = factorise_front(panel, right, order, pivots, limit);
                own.upper.keep_rows(order, pivots, |k| match k.checked_sub(pivots) {
                    None => &panel[k * order..k * order + pivots],
                    Some(k) => &right[k * pivots..(k + 1) * pivots],
                });
                (0..pivots).for_each(|k| panel[k * (order + 1)] = 1.0);
            }
        }
        let (panel, right) = (&*panel, &*right);
        own.lower.keep_columns(order, pivots, |k| &panel[k * order..(k + 1) * order]);
        let below = view(panel, order, pivots).subrows(pivots, rows);
        let memory = self.pool.take(Square::size(rows, symmetric));
        let mut update = Square::over(memory, rows, symmetric);
        update.each_tile(pivots, |tile| {
            let Tile { row, column, width, ref mut values } = *tile;
            if symmetric {
                dense::symmetric_update(values, below.subrows(row, rows - row), width);
            } else {
                let right = view(right, pivots, rows).subcols(column, width);
                dense::general_update(view_mut(values, rows, width), below, right);
            }
            for (&child, update) in front.children.iter().zip(&updates) {
                extend_tile(&self.symbolic.fronts[child], update, tile, rows, pivots);
            }
        });
        for memory in [panel_memory, right_memory] {
            self.pool.give(memory);
        }
        updates.into_iter().for_each(|update| self.pool.give(update.into_values()));
        Ok(update)
    }

    /// The Schur complement on the equations kept last; `values` is memory to use again.
    pub(super) fn root(&self, root: usize, tops: &[usize], updates: &[Square], mut values: Vec<f64>) -> Square {
        let order = self.symbolic.fronts[root].order();
        let symmetric = self.kind == Factorization::Cholesky;
        values.clear();
        values.resize(Square::size(order, symmetric), 0.0);
        let mut schur = Square::over(values, order, symmetric);
        self.each_entry(root, |row, column, value| *schur.entry_mut(row, column) += value);
        schur.each_tile(4, |tile| {
            for (&top, update) in tops.iter().zip(updates) {
                extend_tile(&self.symbolic.fronts[top], update, tile, order, 0);
            }
        });
        schur
    }

    /// Gives `take` row, column and scaled value of every entry of the matrix in a front.
    fn each_entry(&self, front: usize, mut take: impl FnMut(usize, usize, f64)) {
        let at = front;
        let front = &self.symbolic.fronts[at];
        let (order, pivots) = (front.order(), front.pivots());
        let positions = front.columns.clone().chain(front.rows.iter().map(|&row| row as usize));
        let equations: Vec<usize> = positions.map(|position| self.symbolic.equation[position] as usize).collect();
        let [rows, columns] = [&self.scaling.row, &self.scaling.column]
            .map(|factors| equations.iter().map(|&i| factors[i]).collect::<Vec<f64>>());
        for entry in self.scatter.of(at, self.kind == Factorization::Cholesky) {
            let target = entry.target as usize;
            let (row, column) = match target.checked_sub(order * pivots) {
                None => (target % order, target / order),
                Some(right) => (right % pivots, pivots + right / pivots),
            };
            take(row, column, self.values[entry.source as usize] * rows[row] * columns[column]);
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
fn extend_panel(child: &Front, update: &Square, panel: &mut [f64], order: usize, pivots: usize) {
    for run in child.runs.iter().filter(|run| run.parent < pivots) {
        let columns = &mut panel[run.parent * order..(run.parent + run.len) * order];
        each_column(columns, order, |k, column| {
            let k = run.child + k;
            add_below(child, update, k, if update.is_symmetric() { k } else { 0 }, 0, column);
        });
    }
}

/// Adds the rows of a child's update that are pivots of the parent, in columns that are not.
fn extend_right(child: &Front, update: &Square, right: &mut [f64], pivots: usize) {
    let own = child.runs.iter().filter(|run| run.parent < pivots);
    for columns in child.runs.iter().filter(|run| run.parent >= pivots) {
        for k in 0..columns.len {
            let from = update.below(columns.child + k, 0);
            let to = &mut right[(columns.parent + k - pivots) * pivots..(columns.parent + k + 1 - pivots) * pivots];
            for run in own.clone() {
                let to = &mut to[run.parent..run.parent + run.len];
                to.iter_mut().zip(&from[run.child..run.child + run.len]).for_each(|(t, f)| *t += f);
            }
        }
    }
}

/// Adds the part of a child's update that falls into a tile of a matrix of `order`, which begins with row `offset` of the parent.
fn extend_tile(child: &Front, update: &Square, tile: &mut Tile<'_>, order: usize, offset: usize) {
    let stride = order - tile.row;
    let (begin, end) = (tile.column + offset, tile.column + offset + tile.width);
    let first = child.runs.iter().find(|run| run.parent >= offset).map_or(0, |run| run.child);
    let skip = child.runs.partition_point(|run| run.parent + run.len <= begin);
    for run in child.runs[skip..].iter().take_while(|run| run.parent < end) {
        for parent in run.parent.max(begin)..(run.parent + run.len).min(end) {
            let k = run.child + parent - run.parent;
            let column = &mut tile.values[(parent - begin) * stride..(parent - begin + 1) * stride];
            let from = if update.is_symmetric() { k } else { first };
            add_below(child, update, k, from, offset + tile.row, column);
        }
    }
}

/// Adds rows `first..` of column `k` of a child's update to a column whose first row is `offset` in the parent.
fn add_below(child: &Front, update: &Square, k: usize, first: usize, offset: usize, column: &mut [f64]) {
    let from = update.below(k, first);
    let skip = child.runs.partition_point(|run| run.child + run.len <= first);
    for run in &child.runs[skip..] {
        let begin = first.max(run.child);
        let len = run.child + run.len - begin;
        let at = run.parent + (begin - run.child) - offset;
        let from = &from[begin - first..begin - first + len];
        column[at..at + len].iter_mut().zip(from).for_each(|(c, f)| *c += f);
    }
}

fn each_column(columns: &mut [f64], order: usize, work: impl Fn(usize, &mut [f64]) + Sync + Send) {
    if columns.len() > PARALLEL_WORK / 16 {
        parallel::groups_mut(columns, order, 4, work);
    } else {
        columns.chunks_mut(order).enumerate().for_each(|(k, column)| work(k, column));
    }
}
