//! Matrices with known answers, each rank making the rows it owns.
#![allow(dead_code, reason = "each program takes what it needs")]

use std::collections::BTreeMap;

use zelus_linear_algebra::Symmetry;
use zelus_petsc::{DistributedMatrix, RigidModes};

/// Rows of a matrix with everything a [`DistributedMatrix`] borrows.
pub struct Rows {
    pub all: usize,
    pub first: usize,
    pub starts: Vec<usize>,
    pub columns: Vec<u64>,
    pub values: Vec<f64>,
    pub symmetry: Symmetry,
    pub has_multipliers: bool,
    pub modes: Option<RigidModes>,
}

impl Rows {
    /// The rows that `rank` of `size` owns of the matrix with these entries.
    pub fn new(entries: &[BTreeMap<usize, f64>], rank: usize, size: usize, symmetry: Symmetry) -> Self {
        let all = entries.len();
        let (first, end) = (all * rank / size, all * (rank + 1) / size);
        let mut rows = Self {
            all,
            first,
            starts: vec![0],
            columns: Vec::new(),
            values: Vec::new(),
            symmetry,
            has_multipliers: false,
            modes: None,
        };
        for row in &entries[first..end] {
            rows.columns.extend(row.keys().map(|&column| column as u64));
            rows.values.extend(row.values());
            rows.starts.push(rows.columns.len());
        }
        rows
    }

    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    pub fn matrix(&self, graph: u64, stamp: u64) -> DistributedMatrix<'_> {
        DistributedMatrix {
            first_row: self.first as u64,
            row_starts: &self.starts,
            columns: &self.columns,
            values: &self.values,
            symmetry: self.symmetry,
            has_multipliers: self.has_multipliers,
            modes: self.modes.as_ref(),
            graph,
            stamp,
        }
    }

    /// The owned part of `matrix x` for the answer [`expected`].
    pub fn rhs(&self) -> Vec<f64> {
        let row = |row: usize| {
            let entries = self.starts[row]..self.starts[row + 1];
            entries.map(|at| self.values[at] * expected(self.columns[at] as usize)).sum()
        };
        (0..self.len()).map(row).collect()
    }

    /// Largest difference of an owned entry from [`expected`].
    pub fn error(&self, x: &[f64]) -> f64 {
        x.iter().enumerate().map(|(at, x)| (x - expected(self.first + at)).abs()).fold(0.0, f64::max)
    }
}

/// The answer every right-hand side is made for, of size 1.
pub fn expected(equation: usize) -> f64 {
    (0.37 * equation as f64).sin()
}

/// Seven points in a cube of `n`³; without `held` the sum of the unknowns is free.
pub fn poisson(n: usize, held: bool) -> Vec<BTreeMap<usize, f64>> {
    let number = |x: [usize; 3]| (x[2] * n + x[1]) * n + x[0];
    let mut entries = vec![BTreeMap::new(); n * n * n];
    for at in 0..n * n * n {
        let x = [at % n, at / n % n, at / n / n];
        let mut diagonal = 0.0;
        for axis in 0..3 {
            for there in [x[axis].checked_sub(1), Some(x[axis] + 1).filter(|&k| k < n)] {
                diagonal += f64::from(held || there.is_some());
                if let Some(k) = there {
                    let mut other = x;
                    other[axis] = k;
                    entries[at].insert(number(other), -1.0);
                }
            }
        }
        entries[at].insert(at, diagonal);
    }
    entries
}

/// Coordinates and stiffness of a cube of `n`³ hexahedra, with the direction of each equation.
///
/// The bottom is held; with `guided` one side is held along its normal, so that nodes have 2 or 3 equations.
pub fn elasticity(n: usize, guided: bool) -> (Vec<BTreeMap<usize, f64>>, RigidModes) {
    let side = n + 1;
    let mut equation = vec![usize::MAX; 3 * side.pow(3)];
    let mut modes = RigidModes { dimension: 3, ..RigidModes::default() };
    for node in 0..side.pow(3) {
        let x = [node % side, node / side % side, node / side / side];
        for component in 0..3 {
            if x[2] > 0 && !(guided && component == 0 && x[0] == 0) {
                equation[3 * node + component] = modes.components.len();
                modes.components.push(component as u8);
                modes.coordinates.push(x.map(|k| k as f64 / n as f64));
            }
        }
    }
    let local = hexahedron(1.0 / n as f64);
    let mut entries = vec![BTreeMap::new(); modes.components.len()];
    for cell in 0..n * n * n {
        let corner = [cell % n, cell / n % n, cell / n / n];
        let node = |k: usize| {
            let x = [0, 1, 2].map(|axis| corner[axis] + (k >> axis & 1));
            (x[2] * side + x[1]) * side + x[0]
        };
        for a in 0..24 {
            let row = equation[3 * node(a / 3) + a % 3];
            for b in 0..24 {
                let column = equation[3 * node(b / 3) + b % 3];
                if row != usize::MAX && column != usize::MAX {
                    *entries[row].entry(column).or_insert(0.0) += local[a][b];
                }
            }
        }
    }
    (entries, modes)
}

/// Stiffness of a cube of edge `h`, E = 1, ν = 0.3; corner k stands at the bits of k.
fn hexahedron(h: f64) -> Vec<[f64; 24]> {
    let (lambda, mu) = (0.3 / 1.3 / 0.4, 0.5 / 1.3);
    let mut out = vec![[0.0; 24]; 24];
    let points = [0.5 - 0.5 / 3_f64.sqrt(), 0.5 + 0.5 / 3_f64.sqrt()];
    for point in 0..8 {
        let xi = [0, 1, 2].map(|axis| points[point >> axis & 1]);
        let gradient = |k: usize| {
            let value = |axis: usize| if k >> axis & 1 == 1 { xi[axis] } else { 1.0 - xi[axis] };
            let slope = |axis: usize| if k >> axis & 1 == 1 { 1.0 / h } else { -1.0 / h };
            [slope(0) * value(1) * value(2), value(0) * slope(1) * value(2), value(0) * value(1) * slope(2)]
        };
        for a in 0..24 {
            for b in 0..24 {
                let (ga, gb, i, j) = (gradient(a / 3), gradient(b / 3), a % 3, b % 3);
                let dot: f64 = (0..3).map(|k| ga[k] * gb[k]).sum();
                let same = if i == j { dot } else { 0.0 };
                out[a][b] += h.powi(3) / 8.0 * (lambda * ga[i] * gb[j] + mu * (ga[j] * gb[i] + same));
            }
        }
    }
    out
}

/// A Poisson problem whose first unknowns are tied in pairs by multipliers, which have no diagonal.
pub fn saddle(n: usize, asymmetry: f64) -> Vec<BTreeMap<usize, f64>> {
    let mut entries = poisson(n, true);
    let unknowns = entries.len();
    for pair in 0..n {
        let multiplier = unknowns + pair;
        entries.push(BTreeMap::from([(2 * pair, 1.0), (unknowns - 1 - pair, -1.0)]));
        entries[2 * pair].insert(multiplier, 1.0 + asymmetry);
        entries[unknowns - 1 - pair].insert(multiplier, -1.0);
    }
    entries
}
