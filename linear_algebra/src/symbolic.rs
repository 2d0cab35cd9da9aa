//! Symbolic factorisation: elimination tree, fronts and where each entry of the matrix goes.

use std::ops::Range;

use crate::csr::Csr;
use crate::ordering::{Graph, Vertices, nested_dissection};
use crate::solver::SolveError;
use crate::system::Layout;

const NONE: usize = usize::MAX;
/// The position of an inactive equation.
const INACTIVE: u32 = u32::MAX;

/// A stretch of consecutive rows of a front and where it lies in the front of the parent.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowRun {
    /// First of the rows below the pivots, from 0.
    pub(crate) child: usize,
    /// First local index in the parent, from 0 and pivots first.
    pub(crate) parent: usize,
    pub(crate) len: usize,
}

/// One dense block of the elimination: pivot columns, and the rows below them.
#[derive(Debug)]
pub(crate) struct Front {
    /// Positions eliminated here.
    pub(crate) columns: Range<usize>,
    /// Positions of the other rows, ascending and all after `columns`.
    pub(crate) rows: Vec<u32>,
    pub(crate) children: Vec<usize>,
    /// First front of the subtree, which is `first..=self`.
    pub(crate) first: usize,
    /// `rows` in the front of the parent; no run crosses its pivots' end.
    pub(crate) runs: Vec<RowRun>,
    /// Floating-point operations of a Cholesky factorisation of the whole subtree.
    pub(crate) subtree_work: f64,
}

impl Front {
    pub(crate) fn pivots(&self) -> usize {
        self.columns.len()
    }

    /// Pivots and other rows.
    pub(crate) fn order(&self) -> usize {
        self.columns.len() + self.rows.len()
    }

    fn work(&self) -> f64 {
        let (pivots, rows) = (self.pivots() as f64, self.rows.len() as f64);
        pivots * pivots * pivots / 3.0 + pivots * pivots * rows + pivots * rows * rows
    }
}

/// Order and structure of a factorisation; fronts are in postorder.
///
/// When equations were kept last, the last front holds them as its columns; it is the root and is not eliminated.
#[derive(Debug)]
pub(crate) struct Symbolic {
    /// Equation at each position; inactive ones have none.
    pub(crate) equation: Vec<u32>,
    /// Position of each equation, [`INACTIVE`] of those that have none.
    position: Vec<u32>,
    pub(crate) fronts: Vec<Front>,
    /// Roots of the forest, ascending.
    pub(crate) roots: Vec<usize>,
    /// Number of equations that are eliminated; those kept last follow.
    pub(crate) interior: usize,
}

impl Symbolic {
    /// Orders and analyses `pattern + patternᵀ` with the equations of `last` kept for a dense root.
    ///
    /// # Errors
    /// [`SolveError::Failed`] when the ordering fails.
    pub(crate) fn new(pattern: &Csr, layout: &Layout, last: &[bool]) -> Result<Self, SolveError> {
        let vertices = Vertices::new(pattern, layout, last);
        let dissection = nested_dissection(&vertices)?;
        let weights: Vec<usize> = vertices.equations.iter().map(Vec::len).collect();

        let (graph, order) = relabel(&vertices.graph, &dissection);
        let parent = elimination_tree(&graph, vertices.interior);
        let post = postorder(&parent, vertices.interior);
        let (graph, order_again) = relabel(&graph, &post);
        let order: Vec<usize> = order_again.iter().map(|&v| order[v]).collect();
        let label: Vec<usize> = inverse(&post);
        let mut relabelled = vec![NONE; vertices.interior];
        for (v, &p) in parent.iter().enumerate() {
            relabelled[label[v]] = if p < vertices.interior { label[p] } else { p };
        }
        let weight: Vec<usize> = order.iter().map(|&v| weights[v]).collect();
        let counts = column_counts(&graph, &relabelled, &weight);
        let groups = amalgamate(&relabelled, &counts, &weight[..vertices.interior]);

        let merged: Vec<u32> = groups.iter().flatten().map(|&v| v as u32).collect();
        let (graph, order_again) = relabel(&graph, &merged);
        let order: Vec<usize> = order_again.iter().map(|&v| order[v]).collect();
        let mut group_ends: Vec<usize> = groups
            .iter()
            .scan(0, |end, group| {
                *end += group.len();
                Some(*end)
            })
            .collect();
        if vertices.interior < order.len() {
            group_ends.push(order.len());
        }
        Ok(Self::from_groups(&graph, &order, &group_ends, &vertices, pattern.rows))
    }

    /// Builds the fronts of consecutive groups of vertices; `equations` are those of the matrix.
    fn from_groups(
        graph: &Graph,
        order: &[usize],
        group_ends: &[usize],
        vertices: &Vertices,
        equations: usize,
    ) -> Self {
        let mut start = vec![0_usize; order.len() + 1];
        let mut equation = Vec::with_capacity(start.len());
        for (at, &v) in order.iter().enumerate() {
            equation.extend_from_slice(&vertices.equations[v]);
            start[at + 1] = equation.len();
        }
        let mut group_of = vec![0_usize; order.len()];
        let mut begin = 0;
        for (g, &end) in group_ends.iter().enumerate() {
            group_of[begin..end].fill(g);
            begin = end;
        }
        let mut seen = vec![NONE; order.len()];
        let mut structure: Vec<Vec<u32>> = Vec::with_capacity(group_ends.len());
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); group_ends.len()];
        let mut roots = Vec::new();
        let mut begin = 0;
        for (g, &end) in group_ends.iter().enumerate() {
            let mut rows = Vec::new();
            let mut visit = |w: u32| {
                if w as usize >= end && seen[w as usize] != g {
                    seen[w as usize] = g;
                    rows.push(w);
                }
            };
            (begin..end).flat_map(|v| graph.neighbours(v)).for_each(|&w| visit(w));
            children[g].iter().flat_map(|&c| &structure[c]).for_each(|&w| visit(w));
            rows.sort_unstable();
            match rows.first() {
                Some(&w) => children[group_of[w as usize]].push(g),
                None => roots.push(g),
            }
            structure.push(rows);
            begin = end;
        }
        let mut fronts: Vec<Front> = Vec::with_capacity(group_ends.len());
        let mut begin = 0;
        for (g, &end) in group_ends.iter().enumerate() {
            let children = std::mem::take(&mut children[g]);
            let front = Front {
                columns: start[begin]..start[end],
                rows: structure[g]
                    .iter()
                    .flat_map(|&w| start[w as usize] as u32..start[w as usize + 1] as u32)
                    .collect(),
                first: children.first().map_or(g, |&c| fronts[c].first),
                subtree_work: children.iter().map(|&c| fronts[c].subtree_work).sum(),
                children,
                runs: Vec::new(),
            };
            fronts.push(front);
            let work = fronts[g].work();
            fronts[g].subtree_work += work;
            for at in 0..fronts[g].children.len() {
                let child = fronts[g].children[at];
                fronts[child].runs = runs(&fronts[child].rows, &fronts[g]);
            }
            begin = end;
        }
        let mut position = vec![INACTIVE; equations];
        for (at, &i) in equation.iter().enumerate() {
            position[i as usize] = at as u32;
        }
        let interior = start[vertices.interior];
        Self { equation, position, fronts, roots, interior }
    }

    /// Tops of the eliminated subtrees, ascending, and the front of the equations kept last.
    pub(crate) fn tops(&self) -> (Vec<usize>, Option<usize>) {
        let root = (self.interior < self.equation.len()).then(|| self.fronts.len() - 1);
        let mut tops: Vec<usize> = self.roots.iter().copied().filter(|&front| Some(front) != root).collect();
        if let Some(root) = root {
            tops.extend_from_slice(&self.fronts[root].children);
            tops.sort_unstable();
        }
        (tops, root)
    }

    /// Number of equations, inactive ones included.
    pub(crate) fn equations(&self) -> usize {
        self.position.len()
    }

    /// Position of an equation; `None` of an inactive one.
    pub(crate) fn position_of(&self, equation: u32) -> Option<usize> {
        Some(self.position[equation as usize])
            .filter(|&position| position != INACTIVE)
            .map(|position| position as usize)
    }

    /// Number of fronts that are eliminated.
    pub(crate) fn eliminated_fronts(&self) -> usize {
        self.fronts.len() - usize::from(self.interior < self.equation.len())
    }

    /// Numbers of a symmetric factor, about, without those of the equations kept last.
    pub(crate) fn factor_size(&self) -> usize {
        let of_front = |front: &Front| front.pivots() * (front.order() - front.pivots() / 2);
        self.fronts[..self.eliminated_fronts()].iter().map(of_front).sum()
    }

    /// Floating-point operations of a Cholesky factorisation, without the equations kept last.
    pub(crate) fn work(&self) -> f64 {
        self.fronts[..self.eliminated_fronts()].iter().map(Front::work).sum()
    }
}

/// The graph with vertex `order[i]` of the head renamed `i`, and the old name of every new one.
fn relabel(graph: &Graph, order: &[u32]) -> (Graph, Vec<usize>) {
    let vertices = graph.vertices();
    let old: Vec<usize> = order.iter().map(|&v| v as usize).chain(order.len()..vertices).collect();
    let mut new = vec![0_u32; vertices];
    for (at, &v) in old.iter().enumerate() {
        new[v] = at as u32;
    }
    let mut renamed = Graph { starts: vec![0], targets: Vec::with_capacity(graph.targets.len()) };
    for &v in &old {
        renamed.targets.extend(graph.neighbours(v).iter().map(|&w| new[w as usize]));
        renamed.starts.push(renamed.targets.len());
    }
    (renamed, old)
}

fn inverse(order: &[u32]) -> Vec<usize> {
    let mut label = vec![0; order.len()];
    for (at, &v) in order.iter().enumerate() {
        label[v as usize] = at;
    }
    label
}

/// Parent of each interior vertex; `interior` stands for the equations kept last, `NONE` for none.
fn elimination_tree(graph: &Graph, interior: usize) -> Vec<usize> {
    let mut parent = vec![NONE; interior];
    let mut ancestor = vec![NONE; interior];
    for i in 0..graph.vertices() {
        let name = i.min(interior);
        for &k in graph.neighbours(i) {
            let mut k = k as usize;
            if k >= name {
                continue;
            }
            loop {
                let next = ancestor[k];
                if next == name {
                    break;
                }
                ancestor[k] = name;
                if next == NONE {
                    parent[k] = name;
                    break;
                }
                k = next;
            }
        }
    }
    parent
}

/// Vertices such that every subtree is consecutive and children precede parents.
fn postorder(parent: &[usize], interior: usize) -> Vec<u32> {
    let mut first_child = vec![NONE; interior + 1];
    let mut sibling = vec![NONE; interior];
    for v in (0..interior).rev() {
        let p = parent[v].min(interior);
        sibling[v] = first_child[p];
        first_child[p] = v;
    }
    let mut order = Vec::with_capacity(interior);
    let mut stack = vec![interior];
    while let Some(&v) = stack.last() {
        let child = first_child[v];
        if child != NONE {
            first_child[v] = sibling[child];
            stack.push(child);
        } else {
            stack.pop();
            if v < interior {
                order.push(v as u32);
            }
        }
    }
    order
}

/// Weight of the structure of each interior column of the factor, diagonal included.
fn column_counts(graph: &Graph, parent: &[usize], weight: &[usize]) -> Vec<usize> {
    let interior = parent.len();
    let mut counts = weight[..interior].to_vec();
    let mut mark = vec![NONE; interior];
    for i in 0..graph.vertices() {
        for &k in graph.neighbours(i) {
            let mut k = k as usize;
            while k < i.min(interior) && mark[k] != i {
                counts[k] += weight[i];
                mark[k] = i;
                k = parent[k];
            }
        }
    }
    counts
}

/// A group of columns that may become a front.
struct ColumnGroup {
    pivots: usize,
    order: usize,
    zeros: f64,
    members: Vec<usize>,
    children: Vec<usize>,
}

/// Whether a front of `pivots` columns may hold that share of explicit zeros.
fn tolerable(pivots: usize, share: f64) -> bool {
    pivots <= 12 || (pivots <= 32 && share < 0.5) || (pivots <= 96 && share < 0.15) || share < 0.05
}

/// Groups of columns with (nearly) equal structure, in postorder; a few zeros buy larger dense blocks.
fn amalgamate(parent: &[usize], counts: &[usize], weight: &[usize]) -> Vec<Vec<usize>> {
    let columns = parent.len();
    let mut groups: Vec<ColumnGroup> = Vec::new();
    let mut group_of = vec![0_usize; columns];
    for v in 0..columns {
        let continues = v > 0 && parent[v - 1] == v && counts[v - 1] == counts[v] + weight[v - 1];
        if continues {
            let group = groups.last_mut().expect("a column before this one");
            group.pivots += weight[v];
            group.members.push(v);
        } else {
            groups.push(ColumnGroup {
                pivots: weight[v],
                order: counts[v],
                zeros: 0.0,
                members: vec![v],
                children: Vec::new(),
            });
        }
        group_of[v] = groups.len() - 1;
    }
    let mut roots = Vec::new();
    for g in 0..groups.len() {
        let mut candidates = std::mem::take(&mut groups[g].children);
        candidates.sort_by_key(|&c| (std::cmp::Reverse(groups[c].order), c));
        let mut kept = Vec::new();
        for c in candidates {
            let (child, this) = (&groups[c], &groups[g]);
            let pivots = child.pivots + this.pivots;
            let order = child.pivots + this.order;
            let zeros = child.zeros + this.zeros + (child.pivots * (order - child.order)) as f64;
            if tolerable(pivots, zeros / (pivots as f64 * (order as f64 - 0.5 * pivots as f64))) {
                let members = std::mem::take(&mut groups[c].members);
                kept.append(&mut groups[c].children);
                let this = &mut groups[g];
                (this.pivots, this.order, this.zeros) = (pivots, order, zeros);
                this.members.splice(0..0, members);
            } else {
                kept.push(c);
            }
        }
        kept.sort_unstable();
        groups[g].children = kept;
        let last = *groups[g].members.last().expect("a group has columns");
        match parent[last] {
            p if p < columns => groups[group_of[p]].children.push(g),
            _ => roots.push(g),
        }
    }
    let mut ordered = Vec::with_capacity(groups.len());
    let mut stack: Vec<(usize, usize)> = roots.iter().rev().map(|&g| (g, 0)).collect();
    while let Some((g, next)) = stack.pop() {
        if let Some(&child) = groups[g].children.get(next) {
            stack.push((g, next + 1));
            stack.push((child, 0));
        } else {
            ordered.push(std::mem::take(&mut groups[g].members));
        }
    }
    ordered
}

/// Where the rows of a child lie in its parent, as stretches.
fn runs(rows: &[u32], parent: &Front) -> Vec<RowRun> {
    let pivots = parent.pivots();
    let mut runs: Vec<RowRun> = Vec::new();
    let mut at = 0;
    for (child, &row) in rows.iter().enumerate() {
        let row = row as usize;
        let local = if row < parent.columns.end {
            row - parent.columns.start
        } else {
            while parent.rows[at] as usize != row {
                at += 1;
            }
            pivots + at
        };
        match runs.last_mut() {
            Some(run) if run.parent + run.len == local && local != pivots => run.len += 1,
            _ => runs.push(RowRun { child, parent: local, len: 1 }),
        }
    }
    runs
}
