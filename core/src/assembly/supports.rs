//! Inertial nodes for a node at the surface, and their weights: linear fields are extrapolated exactly.
//!
//! The nearest nodes of the elements around it, and of the elements around those, are taken until they span the space. With ω_i =
//! 1/|x_i − x_c|⁴, mean m and covariance C of x_i − x_c, the weights are w_i = ω_i/Σω (1 − (x_i − x_c − m)·C⁻¹ m): of all that are
//! exact, the smallest in the norm Σ w²/ω.

use rustc_hash::FxHashMap;

use crate::geometry::Shape;
use crate::model::ModelPart;
use crate::vector3::{dot, norm, sub};

/// Largest Σ |w|: beyond it the nodes lie too flat to extrapolate from.
const LARGEST: f64 = 12.0;
/// Distances that differ by less are the same, as a share.
const SAME: f64 = 1e-6;
/// Distance of the node over the extent of those below it, in a direction, beyond which they have no extent.
const FLAT: f64 = 20.0;
/// Share of the largest variance that is round-off.
const ROUND_OFF: f64 = 1e-10;

/// The nodes below each of `nodes` with their weights, where there are enough of them; none are `massless` (ascending).
///
/// Without nodes on two levels, as in a plate of one element, they are taken as they are across it, unless all must be
/// `exact`: the weights are then so along it only.
pub(super) fn supports(part: &ModelPart, nodes: &[u32], massless: &[u32], exact: bool) -> Vec<(u32, Vec<(u32, f64)>)> {
    if nodes.is_empty() {
        return Vec::new();
    }
    let around = NearbyElements::of(part, nodes);
    let is_massless = |node: u32| massless.binary_search(&node).is_ok();
    let mut out = Vec::new();
    for &node in nodes {
        let Some(first) = around.neighbours(part, &[node]) else { continue };
        let Some(all) = around.neighbours(part, &first) else { continue };
        let mut candidates: Vec<u32> = all.into_iter().filter(|&other| !is_massless(other)).collect();
        let from = part.nodes.initial[node as usize];
        let way = |other: u32| sub(part.nodes.initial[other as usize], from);
        candidates.sort_by(|&a, &b| norm(way(a)).total_cmp(&norm(way(b))).then(a.cmp(&b)));
        let ways: Vec<[f64; 3]> = candidates.iter().map(|&other| way(other)).collect();
        if let Some(weights) = weights(&ways, part.info.domain_size, exact) {
            let mut list: Vec<(u32, f64)> = candidates.into_iter().zip(weights).collect();
            list.sort_by_key(|(other, _)| *other);
            out.push((node, list));
        }
    }
    out
}

/// Weights of the first of `ways`, which ascend in length, that are exact; of all of them where they are so along a plate.
fn weights(ways: &[[f64; 3]], dimension: usize, exact: bool) -> Option<Vec<f64>> {
    let lengths: Vec<f64> = ways.iter().map(|way| norm(*way)).collect();
    let is_last = |at: usize| lengths.get(at + 1).is_none_or(|next| *next > (1.0 + SAME) * lengths[at]);
    let groups = (dimension..ways.len()).filter(|&at| is_last(at));
    let whole =
        groups.into_iter().find_map(|at| fitted(&ways[..=at], dimension).filter(|(_, rank)| *rank == dimension));
    let along = || fitted(ways, dimension).filter(|(_, rank)| !exact && *rank + 1 == dimension);
    whole.or_else(along).map(|(weights, _)| weights)
}

/// The weights over these nodes, and in how many directions they are exact.
fn fitted(ways: &[[f64; 3]], dimension: usize) -> Option<(Vec<f64>, usize)> {
    let nearest = ways.iter().map(|way| norm(*way)).fold(f64::INFINITY, f64::min);
    if !(nearest > 0.0 && nearest.is_finite()) {
        return None;
    }
    let share = |way: &[f64; 3]| (nearest / norm(*way)).powi(4);
    let total: f64 = ways.iter().map(share).sum();
    let mean: [f64; 3] = std::array::from_fn(|c| ways.iter().map(|way| share(way) * way[c]).sum::<f64>() / total);
    let mut covariance = [[0.0; 3]; 3];
    for way in ways {
        let off = sub(*way, mean);
        let share = share(way) / total;
        (0..3).for_each(|i| (0..3).for_each(|j| covariance[i][j] += share * off[i] * off[j]));
    }
    let (values, vectors) = eigen(covariance);
    let largest = values.iter().copied().fold(0.0, f64::max);
    let mut slope = [0.0; 3];
    let mut rank = 0;
    for (value, vector) in values.into_iter().zip(vectors) {
        let off = dot(vector, mean);
        if value > ROUND_OFF * largest && off * off <= FLAT * FLAT * value {
            rank += 1;
            (0..3).for_each(|c| slope[c] += off / value * vector[c]);
        }
    }
    let weights: Vec<f64> = ways.iter().map(|way| share(way) / total * (1.0 - dot(sub(*way, mean), slope))).collect();
    let size: f64 = weights.iter().map(|weight| weight.abs()).sum();
    (rank <= dimension && size < LARGEST).then_some((weights, rank))
}

/// Eigenvalues and eigenvectors of a symmetric matrix, by Jacobi's rotations.
fn eigen(mut a: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..20 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q].abs() <= f64::EPSILON * (a[p][p].abs() + a[q][q].abs()) {
                continue;
            }
            let theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let (c, s) = (t.hypot(1.0).recip(), t / t.hypot(1.0));
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
                (v[p][k], v[q][k]) = (c * v[p][k] - s * v[q][k], s * v[p][k] + c * v[q][k]);
            }
        }
    }
    ([a[0][0], a[1][1], a[2][2]], v)
}

/// The elements at the nodes near those without mass.
struct NearbyElements {
    elements: FxHashMap<u32, Vec<u32>>,
}

impl NearbyElements {
    fn of(part: &ModelPart, nodes: &[u32]) -> Self {
        let mut near = vec![false; part.nodes.len()];
        nodes.iter().for_each(|&node| near[node as usize] = true);
        for at in 0..part.elements.len() as u32 {
            let members = part.elements.nodes(at);
            if members.iter().any(|node| nodes.binary_search(node).is_ok()) {
                members.iter().for_each(|&node| near[node as usize] = true);
            }
        }
        let mut elements: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
        for at in 0..part.elements.len() as u32 {
            for &node in part.elements.nodes(at).iter().filter(|&&node| near[node as usize]) {
                elements.entry(node).or_default().push(at);
            }
        }
        Self { elements }
    }

    /// Nodes of the elements at `nodes`, ascending; `None` where the first of them carries anything but solid elements.
    fn neighbours(&self, part: &ModelPart, nodes: &[u32]) -> Option<Vec<u32>> {
        let mut out = Vec::new();
        for node in nodes {
            for &at in self.elements.get(node)? {
                let dimension = part.elements.kinds[at as usize].cell.map(Shape::cell).map_or(0, |cell| cell.dim);
                if dimension == part.info.domain_size {
                    out.extend_from_slice(part.elements.nodes(at));
                } else if nodes.len() == 1 {
                    return None;
                }
            }
        }
        out.sort_unstable();
        out.dedup();
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_exact(ways: &[[f64; 3]], weights: &[f64]) {
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        for c in 0..3 {
            let moment: f64 = ways.iter().zip(weights).map(|(way, weight)| weight * way[c]).sum();
            assert!(moment.abs() < 1e-12, "component {c}: {moment}");
        }
    }

    #[test]
    fn weights_extrapolate_linear_fields() {
        let mut ways = vec![[0.1, 0.0, -1.0], [1.0, 0.2, -1.1], [-0.9, 0.1, -1.0], [0.0, 1.1, -0.9], [0.0, -1.0, -1.0]];
        ways.push([0.0, 0.1, -2.1]);
        let weights = weights(&ways, 3, true).expect("weights");
        assert_eq!(weights.len(), 6);
        assert_exact(&ways, &weights);
    }

    #[test]
    fn a_corner_follows_the_four_nearest() {
        let ways = [[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.0, 1.0, 2.0], [2.0, 2.0, 2.0]];
        let weights = weights(&ways, 3, true).expect("weights");
        assert_eq!(weights.len(), 4);
        assert_exact(&ways, &weights);
        assert!((weights[0] - 4.0).abs() < 1e-12, "{weights:?}");
    }

    #[test]
    fn across_a_plate_of_one_element_values_are_taken_as_they_are() {
        let ways = [[0.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, -1.0, 0.0]];
        let weights = weights(&ways, 2, false).expect("weights");
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!(super::weights(&ways, 2, true).is_none());
        let along: f64 = ways.iter().zip(&weights).map(|(way, weight)| weight * way[0]).sum();
        assert!(along.abs() < 1e-12);
    }

    #[test]
    fn one_node_is_not_enough() {
        assert!(weights(&[[0.0, -1.0, 0.0]], 2, false).is_none());
        assert!(weights(&[[0.0, -1.0, 0.0], [1.0, -1.0, 0.0]], 3, false).is_none());
    }

    #[test]
    fn eigenvalues_of_a_symmetric_matrix() {
        let a = [[2.0, 1.0, 0.0], [1.0, 2.0, 0.5], [0.0, 0.5, 1.0]];
        let (values, vectors) = eigen(a);
        for (value, vector) in values.into_iter().zip(vectors) {
            let image: [f64; 3] = std::array::from_fn(|i| dot(a[i], vector));
            (0..3).for_each(|c| assert!((image[c] - value * vector[c]).abs() < 1e-13));
        }
    }
}
