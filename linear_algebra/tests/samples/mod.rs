//! Matrices to try solvers on.
#![allow(dead_code, unreachable_pub, missing_docs, reason = "every user of this module takes what it needs")]

use zelus_linear_algebra::{Csr, Layout};

/// Stiffness of a box of eight nodes with edges of these lengths (Young's modulus 1, Poisson's ratio 0.3), 24 × 24.
fn hexahedron(edges: [f64; 3]) -> [[f64; 24]; 24] {
    let corner = |a: usize| [(a & 1) as f64, ((a >> 1) & 1) as f64, ((a >> 2) & 1) as f64];
    let (nu, mut stiffness) = (0.3, [[0.0; 24]; 24]);
    let (lambda, mu) = (nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu));
    let offset = 0.5 / 3.0_f64.sqrt();
    let volume: f64 = edges.iter().product();
    for point in 0..8 {
        let at = corner(point).map(|c| 0.5 + (2.0 * c - 1.0) * offset);
        let gradient: Vec<[f64; 3]> = (0..8)
            .map(|a| {
                let c = corner(a);
                let value = |d: usize| if c[d] > 0.5 { at[d] } else { 1.0 - at[d] };
                let sign = |d: usize| if c[d] > 0.5 { 1.0 } else { -1.0 };
                let slope = |d: usize| sign(d) / edges[d];
                [slope(0) * value(1) * value(2), value(0) * slope(1) * value(2), value(0) * value(1) * slope(2)]
            })
            .collect();
        for a in 0..8 {
            for b in 0..8 {
                let (ga, gb) = (gradient[a], gradient[b]);
                let product: f64 = (0..3).map(|d| ga[d] * gb[d]).sum();
                for i in 0..3 {
                    for j in 0..3 {
                        let same = if i == j { mu * product } else { 0.0 };
                        stiffness[3 * a + i][3 * b + j] +=
                            (lambda * ga[i] * gb[j] + mu * ga[j] * gb[i] + same) * volume / 8.0;
                    }
                }
            }
        }
    }
    stiffness
}

/// A box of cells between these places in each direction.
pub struct Brick {
    pub stations: [Vec<f64>; 3],
}

impl Brick {
    /// Of unit cubes.
    pub fn of_cubes(cells: [usize; 3]) -> Self {
        Self::of_cells(cells, [1.0; 3])
    }

    /// Of so many cells with edges of these lengths.
    pub fn of_cells(cells: [usize; 3], edges: [f64; 3]) -> Self {
        Self { stations: std::array::from_fn(|d| (0..=cells[d]).map(|at| at as f64 * edges[d]).collect()) }
    }

    /// Number of nodes in each direction.
    pub fn counts(&self) -> [usize; 3] {
        std::array::from_fn(|d| self.stations[d].len())
    }

    pub fn nodes(&self) -> usize {
        self.counts().iter().product()
    }

    pub fn node(&self, i: usize, j: usize, k: usize) -> usize {
        i + self.counts()[0] * (j + self.counts()[1] * k)
    }

    /// The six rigid-body modes, with equation `3 node + direction`.
    pub fn rigid_motions(&self) -> Vec<Vec<f64>> {
        let mut motions = vec![vec![0.0; 3 * self.nodes()]; 6];
        let [x, y, z] = &self.stations;
        for k in 0..z.len() {
            for j in 0..y.len() {
                for i in 0..x.len() {
                    let (node, at) = (self.node(i, j, k), [x[i], y[j], z[k]]);
                    for d in 0..3 {
                        let (e, f) = ((d + 1) % 3, (d + 2) % 3);
                        motions[d][3 * node + d] = 1.0;
                        motions[3 + d][3 * node + e] = -at[f];
                        motions[3 + d][3 * node + f] = at[e];
                    }
                }
            }
        }
        motions
    }

    /// Nodes of the layer `k` of the third direction.
    pub fn layer(&self, k: usize) -> Vec<usize> {
        let mut nodes = Vec::new();
        let [x, y, _] = self.counts();
        for j in 0..y {
            nodes.extend((0..x).map(|i| self.node(i, j, k)));
        }
        nodes
    }

    /// Adds the stiffness, with equation `3 (first + node) + direction`, to a list of triplets.
    pub fn stiffness(&self, first: usize, scale: f64, triplets: &mut Vec<(usize, usize, f64)>) {
        let edge = |d: usize, at: usize| self.stations[d][at + 1] - self.stations[d][at];
        let [x, y, z] = self.counts();
        for k in 0..z - 1 {
            for j in 0..y - 1 {
                for i in 0..x - 1 {
                    let element = hexahedron([edge(0, i), edge(1, j), edge(2, k)]);
                    let node = |a: usize| first + self.node(i + (a & 1), j + ((a >> 1) & 1), k + ((a >> 2) & 1));
                    for (row, values) in element.iter().enumerate() {
                        for (column, value) in values.iter().enumerate() {
                            let place = |local: usize| 3 * node(local / 3) + local % 3;
                            triplets.push((place(row), place(column), scale * value));
                        }
                    }
                }
            }
        }
    }
}

/// Replaces the equations of `nodes` by `x = b`, symmetrically.
pub fn fix(triplets: &mut Vec<(usize, usize, f64)>, equations: impl IntoIterator<Item = usize>, scale: f64) {
    let fixed: std::collections::BTreeSet<usize> = equations.into_iter().collect();
    triplets.retain(|(i, j, _)| !fixed.contains(i) && !fixed.contains(j));
    triplets.extend(fixed.into_iter().map(|i| (i, i, scale)));
}

/// A box of `cells` unit cubes in each direction that is held at its bottom, with its rigid-body modes.
pub fn clamped_box(cells: usize) -> (Csr, Layout) {
    let brick = Brick::of_cubes([cells; 3]);
    held(&brick, brick.layer(0))
}

/// A box that is held at these nodes, with its rigid-body modes.
pub fn held(brick: &Brick, nodes: Vec<usize>) -> (Csr, Layout) {
    let mut triplets = Vec::new();
    brick.stiffness(0, 1.0, &mut triplets);
    fix(&mut triplets, nodes.into_iter().flat_map(|node| 3 * node..3 * node + 3), 1.0);
    let mut layout = Layout::blocked(brick.nodes(), 3);
    layout.near_null_space = brick.rigid_motions();
    (Csr::from_triplets(3 * brick.nodes(), &triplets), layout)
}

/// Two boxes, one on the other, the upper one held by multipliers only.
pub struct Contact {
    pub layout: Layout,
    pub bulk: Csr,
    pub coupling: Csr,
}

/// Tied boxes of `n × n × n` cells; `skew` makes the coupling unsymmetric, `active` says which nodes touch.
pub fn contact(n: usize, skew: f64, active: impl Fn(usize) -> bool) -> Contact {
    let (lower, upper) = (Brick::of_cubes([n, n, n]), Brick::of_cubes([n, n, n]));
    let young = 1e5;
    let mut triplets = Vec::new();
    lower.stiffness(0, young, &mut triplets);
    upper.stiffness(lower.nodes(), young, &mut triplets);
    fix(&mut triplets, lower.layer(0).into_iter().flat_map(|node| 3 * node..3 * node + 3), young);
    let displacements = 3 * (lower.nodes() + upper.nodes());
    let slaves = upper.layer(0);
    let masters = lower.layer(n);
    let equations = displacements + 3 * slaves.len();
    let bulk = Csr::from_triplets(equations, &triplets);
    let mut coupling = Vec::new();
    let mut layout = Layout::blocked(lower.nodes() + upper.nodes(), 3);
    for (at, (&slave, &master)) in slaves.iter().zip(&masters).enumerate() {
        let neighbour = masters[(at + 1) % masters.len()];
        for d in 0..3 {
            let multiplier = displacements + 3 * at + d;
            layout.node.push((lower.nodes() + slave) as u32);
            layout.multiplier.push(true);
            let slave = 3 * (lower.nodes() + slave) + d;
            if !active(at) {
                coupling.push((multiplier, multiplier, -0.01));
                continue;
            }
            for (equation, weight) in [(slave, 1.0), (3 * master + d, -0.8), (3 * neighbour + d, -0.2)] {
                coupling.push((multiplier, equation, weight));
                coupling.push((equation, multiplier, weight * (1.0 + skew * d as f64)));
            }
            coupling.push((slave, 3 * master + d, skew * young * 0.01));
        }
    }
    Contact { layout, bulk, coupling: Csr::from_triplets(equations, &coupling) }
}
