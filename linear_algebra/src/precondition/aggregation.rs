//! Aggregates of nodes and the tentative prolongation that reproduces the near-null space.

use super::rectangular::{Rectangular, from_rows};
use crate::csr::Csr;

const NONE: u32 = u32::MAX;
/// Share of the geometric mean of two diagonal blocks above which their coupling is strong.
const STRONG: f64 = 0.02;
/// Share of a vector that must be left after orthogonalisation for it to be kept.
const INDEPENDENT: f64 = 1e-6;

/// The graph of strong couplings between groups of equations, as lists of neighbours.
fn strong_graph(matrix: &Csr, group: &[u32], groups: usize) -> Vec<Vec<u32>> {
    let mut members = vec![Vec::new(); groups];
    group.iter().enumerate().for_each(|(i, &g)| members[g as usize].push(i));
    let mut size = vec![0.0_f64; groups];
    for i in 0..matrix.rows {
        let (columns, values) = matrix.row(i);
        for (&j, value) in columns.iter().zip(values) {
            if group[j as usize] == group[i] {
                size[group[i] as usize] += value * value;
            }
        }
    }
    let mut place = vec![usize::MAX; groups];
    let mut graph = Vec::with_capacity(groups);
    for (g, list) in members.iter().enumerate() {
        let mut blocks: Vec<(u32, f64)> = Vec::new();
        for &i in list {
            let (columns, values) = matrix.row(i);
            for (&j, value) in columns.iter().zip(values) {
                let h = group[j as usize];
                if h as usize == g {
                    continue;
                }
                let at = &mut place[h as usize];
                if *at == usize::MAX {
                    *at = blocks.len();
                    blocks.push((h, 0.0));
                }
                blocks[*at].1 += value * value;
            }
        }
        blocks.iter().for_each(|&(h, _)| place[h as usize] = usize::MAX);
        let strong = |&&(h, square): &&(u32, f64)| square > (STRONG * STRONG) * (size[g] * size[h as usize]).sqrt();
        graph.push(blocks.iter().filter(strong).map(|&(h, _)| h).collect());
    }
    graph
}

/// Aggregate of each group, and their number; groups without strong neighbours have none.
fn aggregate(graph: &[Vec<u32>]) -> (Vec<u32>, usize) {
    let mut of = vec![NONE; graph.len()];
    let mut count = 0;
    for (g, neighbours) in graph.iter().enumerate() {
        if of[g] == NONE && !neighbours.is_empty() && neighbours.iter().all(|&h| of[h as usize] == NONE) {
            of[g] = count;
            neighbours.iter().for_each(|&h| of[h as usize] = count);
            count += 1;
        }
    }
    let first = of.clone();
    for (g, neighbours) in graph.iter().enumerate() {
        if of[g] == NONE
            && let Some(&h) = neighbours.iter().find(|&&h| first[h as usize] != NONE)
        {
            of[g] = first[h as usize];
        }
    }
    for (g, neighbours) in graph.iter().enumerate() {
        if of[g] == NONE && !neighbours.is_empty() {
            of[g] = count;
            for &h in neighbours {
                if of[h as usize] == NONE {
                    of[h as usize] = count;
                }
            }
            count += 1;
        }
    }
    (of, count as usize)
}

/// A coarse space: prolongation, aggregate of each of its equations, and its near-null space.
pub(super) struct Coarse {
    pub(super) prolongation: Rectangular,
    pub(super) group: Vec<u32>,
    pub(super) near_null_space: Vec<Vec<f64>>,
}

/// The tentative coarse space of `matrix`, whose equations belong to groups; `None` when nothing aggregates.
pub(super) fn coarsen(matrix: &Csr, group: &[u32], near_null_space: &[Vec<f64>]) -> Option<Coarse> {
    let groups = group.iter().max().map_or(0, |&g| g as usize + 1);
    let (aggregate_of, aggregates) = aggregate(&strong_graph(matrix, group, groups));
    let mut members = vec![Vec::new(); aggregates];
    for (i, &g) in group.iter().enumerate() {
        if aggregate_of[g as usize] != NONE {
            members[aggregate_of[g as usize] as usize].push(i);
        }
    }
    let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); matrix.rows];
    let mut coarse_group = Vec::new();
    let mut coarse_space: Vec<Vec<f64>> = vec![Vec::new(); near_null_space.len()];
    for (a, list) in members.iter().enumerate() {
        let mut kept: Vec<Vec<f64>> = Vec::new();
        let first = coarse_group.len() as u32;
        let mut coefficients: Vec<Vec<f64>> = Vec::new();
        for vector in near_null_space {
            let mut local: Vec<f64> = list.iter().map(|&i| vector[i]).collect();
            let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            let before = length(&local);
            let mut row = vec![0.0; kept.len()];
            for _ in 0..2 {
                for (q, total) in kept.iter().zip(&mut row) {
                    let part: f64 = q.iter().zip(&local).map(|(q, v)| q * v).sum();
                    *total += part;
                    local.iter_mut().zip(q).for_each(|(v, q)| *v -= part * q);
                }
            }
            let after = length(&local);
            if after > INDEPENDENT * before {
                local.iter_mut().for_each(|v| *v /= after);
                row.push(after);
                kept.push(local);
            }
            coefficients.push(row);
        }
        for (q, vector) in kept.iter().enumerate() {
            coarse_group.push(a as u32);
            for (&i, &value) in list.iter().zip(vector) {
                if value != 0.0 {
                    rows[i].push((first + q as u32, value));
                }
            }
        }
        for (vector, row) in coarse_space.iter_mut().zip(&coefficients) {
            vector.extend((0..kept.len()).map(|q| row.get(q).copied().unwrap_or(0.0)));
        }
    }
    let columns = coarse_group.len();
    (columns > 0).then(|| Coarse {
        prolongation: from_rows(columns, rows),
        group: coarse_group,
        near_null_space: coarse_space,
    })
}
