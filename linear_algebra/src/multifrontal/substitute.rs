//! Forward and backward substitution over the tree, in parallel over its subtrees.

use super::{Factor, Factorization};
use crate::dense;
use crate::parallel;
use crate::symbolic::{Front, RowRun};

/// Operations of the elimination of a subtree below which one task substitutes in all of it.
const TASK_WORK: f64 = 2e7;

impl Factor {
    /// Solves with all that is eliminated; `between` gets the part of the equations kept last and must solve for it.
    ///
    /// `x` is in the order of the equations; `between` in that of `Symbolic::equation` after its interior.
    pub(crate) fn solve(&self, x: &mut [f64], between: impl FnOnce(&mut [f64])) {
        let symbolic = &*self.symbolic;
        let scaling = &self.scaling;
        let mut y: Vec<f64> = symbolic.equation.iter().map(|&i| x[i as usize] * scaling.row[i as usize]).collect();
        let (tops, root) = symbolic.tops();
        let (inside, kept) = y.split_at_mut(symbolic.interior);
        let updates = self.forward_subtrees(inside, 0, &tops);
        if root.is_some() {
            for (&top, update) in tops.iter().zip(&updates) {
                add_runs(&symbolic.fronts[top].runs, update, kept);
            }
            let equations = &symbolic.equation[symbolic.interior..];
            kept.iter_mut().zip(equations).for_each(|(value, &i)| *value /= scaling.row[i as usize]);
            between(kept);
            kept.iter_mut().zip(equations).for_each(|(value, &i)| *value /= scaling.column[i as usize]);
        }
        let known: Vec<Vec<f64>> = tops.iter().map(|&top| gather_runs(&symbolic.fronts[top], kept)).collect();
        self.backward_subtrees(inside, 0, &tops, known);
        for (&i, value) in symbolic.equation.iter().zip(&y) {
            x[i as usize] = value * scaling.column[i as usize];
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
        front.subtree_work < TASK_WORK
    }

    fn forward_subtrees(&self, y: &mut [f64], begin: usize, tops: &[usize]) -> Vec<Vec<f64>> {
        let pieces = self.pieces(y, begin, tops);
        if tops.len() > 1 && tops.iter().any(|&top| !self.is_small(top)) {
            let mut pieces: Vec<(&mut [f64], Vec<f64>)> = pieces.into_iter().map(|piece| (piece, Vec::new())).collect();
            parallel::each_mut(&mut pieces, 1, |at, (piece, update)| *update = self.forward(piece, tops[at]));
            pieces.into_iter().map(|(_, update)| update).collect()
        } else {
            pieces.into_iter().zip(tops).map(|(piece, &top)| self.forward(piece, top)).collect()
        }
    }

    /// Forward substitution in a subtree; returns the updates of the rows above.
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
        self.store.pivots[top].permute(&mut local);
        self.store.forward(top, &mut local);
        own.copy_from_slice(&local[..front.pivots()]);
        local.drain(..front.pivots());
        local
    }

    fn backward_subtrees(&self, y: &mut [f64], begin: usize, tops: &[usize], known: Vec<Vec<f64>>) {
        let pieces = self.pieces(y, begin, tops);
        let parallel = tops.len() > 1 && tops.iter().any(|&top| !self.is_small(top));
        let items = pieces.into_iter().zip(known).zip(tops).collect();
        dense::for_each(parallel, items, |((piece, known), top)| self.backward(piece, **top, known));
    }

    /// Backward substitution in a subtree whose rows are `known`.
    fn backward(&self, y: &mut [f64], top: usize, known: &[f64]) {
        let front = &self.symbolic.fronts[top];
        let (inner, own) = y.split_at_mut(y.len() - front.pivots());
        let mut local = Vec::with_capacity(front.order());
        local.extend_from_slice(own);
        local.extend_from_slice(known);
        self.store.backward(top, self.kind == Factorization::Cholesky, &mut local);
        own.copy_from_slice(&local[..front.pivots()]);
        let begin = front.columns.start - inner.len();
        let known = front.children.iter().map(|&c| gather_runs(&self.symbolic.fronts[c], &local)).collect();
        self.backward_subtrees(inner, begin, &front.children, known);
    }
}

fn add_runs(runs: &[RowRun], update: &[f64], target: &mut [f64]) {
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
