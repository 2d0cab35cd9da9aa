//! Aggregates of node blocks and the tentative prolongation that reproduces the near-null space.

use std::cmp::Reverse;

use rayon::prelude::*;

use super::block_matrix::BlockMatrix;

/// Aggregate of a block that has no strong neighbour.
pub(super) const NONE: u32 = u32::MAX;
/// Share of the geometric mean of two diagonal blocks above which their coupling is strong.
const STRONG: f64 = 0.02;
/// Share of a vector that must be left after orthogonalisation for it to be kept.
const INDEPENDENT: f64 = 1e-6;

/// The tentative coarse space: each block is interpolated from the one aggregate it belongs to.
pub(super) struct Tentative {
    /// Aggregate of each block, or [`NONE`].
    pub(super) aggregate: Vec<u32>,
    /// Number of aggregates.
    pub(super) aggregates: usize,
    /// Body of each aggregate.
    pub(super) bodies: Vec<u32>,
    /// Rows of the prolongation, `height × modes` entries a block by columns.
    pub(super) values: Vec<f32>,
    /// The modes on the aggregates, as `modes` vectors of `aggregates × modes` entries.
    pub(super) modes: Vec<Vec<f64>>,
}

/// Starts and lists of the strong couplings between blocks.
fn strong_graph(matrix: &BlockMatrix, bodies: &[u32]) -> (Vec<usize>, Vec<u32>) {
    let size = matrix.size();
    let square = |block: &[f32]| block.iter().map(|&v| f64::from(v).powi(2)).sum::<f64>();
    let diagonal: Vec<f64> = (0..matrix.rows)
        .into_par_iter()
        .with_min_len(256)
        .map(|i| {
            let (columns, values) = matrix.row(i);
            columns.binary_search(&(i as u32)).map_or(0.0, |at| square(&values[at * size..(at + 1) * size]))
        })
        .collect();
    let lists: Vec<Vec<u32>> = (0..matrix.rows)
        .into_par_iter()
        .with_min_len(256)
        .map(|i| {
            let (columns, values) = matrix.row(i);
            // Aggregates end where the blocks of others begin, and where another body does: what touches moves apart and slides.
            let is_neighbour =
                |j: u32| j as usize != i && (j as usize) < matrix.rows && bodies[j as usize] == bodies[i];
            let blocks = columns.iter().zip(values.chunks_exact(size)).filter(|(j, _)| is_neighbour(**j));
            let is_strong =
                |j: u32, block: &[f32]| square(block) > (STRONG * STRONG) * (diagonal[i] * diagonal[j as usize]).sqrt();
            blocks.filter(|(j, block)| is_strong(**j, block)).map(|(j, _)| *j).collect()
        })
        .collect();
    let mut starts = vec![0];
    lists.iter().for_each(|list| starts.push(starts[starts.len() - 1] + list.len()));
    (starts, lists.concat())
}

/// Aggregate of each block, and their number; blocks without strong neighbours have none.
fn aggregate(matrix: &BlockMatrix, bodies: &[u32]) -> (Vec<u32>, usize) {
    let (starts, list) = strong_graph(matrix, bodies);
    let neighbours = |g: usize| &list[starts[g]..starts[g + 1]];
    let mut of = vec![NONE; matrix.rows];
    let mut count = 0;
    for g in 0..matrix.rows {
        let near = neighbours(g);
        if of[g] == NONE && !near.is_empty() && near.iter().all(|&h| of[h as usize] == NONE) {
            of[g] = count;
            near.iter().for_each(|&h| of[h as usize] = count);
            count += 1;
        }
    }
    join(&mut of, count as usize, neighbours);
    for g in 0..matrix.rows {
        if of[g] == NONE && !neighbours(g).is_empty() {
            of[g] = count;
            for &h in neighbours(g) {
                if of[h as usize] == NONE {
                    of[h as usize] = count;
                }
            }
            count += 1;
        }
    }
    (of, count as usize)
}

/// Lets blocks that have no aggregate join the one with most of their strong neighbours, of those the smallest.
fn join<'a>(of: &mut [u32], aggregates: usize, neighbours: impl Fn(usize) -> &'a [u32]) {
    let first = of.to_vec();
    let mut sizes = vec![0_usize; aggregates];
    first.iter().filter(|&&a| a != NONE).for_each(|&a| sizes[a as usize] += 1);
    let mut near = Vec::new();
    for g in (0..first.len()).filter(|&g| first[g] == NONE) {
        near.clear();
        near.extend(neighbours(g).iter().map(|&h| first[h as usize]).filter(|&a| a != NONE));
        near.sort_unstable();
        let rank = |alike: &[u32]| (alike.len(), Reverse(sizes[alike[0] as usize]), Reverse(alike[0]));
        if let Some((_, _, Reverse(a))) = near.chunk_by(|a, b| a == b).map(rank).max() {
            of[g] = a;
            sizes[a as usize] += 1;
        }
    }
}

/// The tentative coarse space of the own rows of a matrix with these near-null vectors, and a body for each block.
pub(super) fn coarsen(matrix: &BlockMatrix, bodies: &[u32], near_null_space: &[Vec<f64>]) -> Tentative {
    let (aggregate, aggregates) = aggregate(matrix, bodies);
    let (height, modes) = (matrix.height, near_null_space.len());
    let mut members = vec![Vec::new(); aggregates];
    for (i, &a) in aggregate.iter().enumerate().filter(|(_, a)| **a != NONE) {
        members[a as usize].push(i);
    }
    let orthonormal: Vec<(Vec<f64>, Vec<f64>)> =
        members.par_iter().with_min_len(16).map(|list| orthonormalise(list, height, near_null_space)).collect();
    let mut values = vec![0.0; matrix.rows * height * modes];
    let mut coarse = vec![vec![0.0; aggregates * modes]; modes];
    for (a, (list, (basis, triangle))) in members.iter().zip(&orthonormal).enumerate() {
        let length = list.len() * height;
        for (at, &i) in list.iter().enumerate() {
            for h in 0..height {
                for m in 0..modes {
                    values[(i * modes + m) * height + h] = basis[m * length + at * height + h] as f32;
                }
            }
        }
        for (m, vector) in coarse.iter_mut().enumerate() {
            vector[a * modes..(a + 1) * modes].copy_from_slice(&triangle[m * modes..(m + 1) * modes]);
        }
    }
    let bodies = members.iter().map(|list| bodies[list[0]]).collect();
    Tentative { aggregate, aggregates, bodies, values, modes: coarse }
}

/// Orthonormal vectors on the blocks of `list` that span the near-null space there, one after the other, and each of its
/// vectors in their terms; a vector that depends on those before it is zero.
fn orthonormalise(list: &[usize], height: usize, near_null_space: &[Vec<f64>]) -> (Vec<f64>, Vec<f64>) {
    let (length, modes) = (list.len() * height, near_null_space.len());
    let mut basis = vec![0.0; length * modes];
    let mut triangle = vec![0.0; modes * modes];
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    for (m, vector) in near_null_space.iter().enumerate() {
        let (done, rest) = basis.split_at_mut(m * length);
        let local = &mut rest[..length];
        for (at, &i) in list.iter().enumerate() {
            local[at * height..(at + 1) * height].copy_from_slice(&vector[i * height..(i + 1) * height]);
        }
        let before = norm(local);
        for _ in 0..2 {
            for (q, known) in done.chunks_exact(length).enumerate() {
                let part: f64 = known.iter().zip(local.iter()).map(|(q, v)| q * v).sum();
                triangle[m * modes + q] += part;
                local.iter_mut().zip(known).for_each(|(v, q)| *v -= part * q);
            }
        }
        let after = norm(local);
        if after > INDEPENDENT * before {
            local.iter_mut().for_each(|v| *v /= after);
            triangle[m * modes + m] = after;
        } else {
            local.fill(0.0);
        }
    }
    (basis, triangle)
}
