//! The elimination of the multipliers of one node from its own equations.
//!
//! For the `s = d + m` equations of a node, `G` (s × m) holds the coefficients of its multipliers, `H` (s × d) those of its other
//! unknowns. With `G = [Q₁ Q₂] [R; 0]` the multipliers are `R⁻¹ Q₁ᵀ` times the equations, and `Q₂ᵀ` times the equations knows nothing
//! of them: d equations that replace the node's own. They are scaled to `α I` on the node's own unknowns, `W = α (Q₂ᵀ H)⁻¹ Q₂ᵀ`, so
//! that conditions and forces weigh alike whatever their units.

use crate::dense_lu;

/// Pivots of the scaled `Q₂ᵀ H` below which the equations are left as they are, but for their size.
const REGULAR: f64 = 1e-6;

/// Elimination of the equations of a node, and the recovery of its unknowns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NodeElimination {
    /// `R⁻¹ Q₁ᵀ` by rows, m × s: multipliers out of the equations.
    pub(super) recovery: Vec<f64>,
    /// `W` by rows, d × s: equations without multipliers.
    pub(super) equations: Vec<f64>,
}

/// Eliminates the multipliers, or says which of them the equations do not determine and its share that they see.
///
/// `g` (s × m) and `h` (s × d) lie by rows, the node's own equations first; `size` is the largest entry of each
/// multiplier's column in the whole matrix, `alpha` the size wanted of the equations, `least` the smallest share of `size`
/// that determines a multiplier.
pub(super) fn eliminate(
    g: &[f64],
    h: &[f64],
    [d, m]: [usize; 2],
    size: &[f64],
    alpha: f64,
    least: f64,
) -> Result<NodeElimination, (usize, f64)> {
    let s = d + m;
    // Columns are brought to one size, so that units of multipliers do not matter.
    let mut a = vec![0.0; s * (m + s)];
    let width = m + s;
    for i in 0..s {
        for c in 0..m {
            a[i * width + c] = if size[c] > 0.0 { g[i * m + c] / size[c] } else { 0.0 };
        }
        a[i * width + m + i] = 1.0;
    }
    for c in 0..m {
        reflect(&mut a, width, s, c);
        let pivot = a[c * width + c].abs();
        if pivot <= least {
            return Err((c, pivot));
        }
    }
    let mut recovery = vec![0.0; m * s];
    for c in (0..m).rev() {
        for p in 0..s {
            let known: f64 = (c + 1..m).map(|e| a[c * width + e] * size[e] * recovery[e * s + p]).sum();
            recovery[c * s + p] = (a[c * width + m + p] - known) / (a[c * width + c] * size[c]);
        }
    }
    let q: Vec<f64> = (0..d).flat_map(|i| a[(m + i) * width + m..(m + i + 1) * width].to_vec()).collect();
    let product = |i: usize, j: usize| (0..s).map(|p| q[i * s + p] * h[p * d + j]).sum::<f64>();
    let mut block: Vec<f64> = (0..d * d).map(|at| product(at % d, at / d)).collect();
    let rows: Vec<f64> = (0..d).map(|i| (0..d).fold(0.0_f64, |most, j| most.max(block[i + d * j].abs()))).collect();
    let scale = |i: usize| if rows[i] > 0.0 { alpha / rows[i] } else { 1.0 };
    let mut equations: Vec<f64> = (0..d * s).map(|at| q[at] * scale(at / s)).collect();
    (0..d * d).for_each(|at| block[at] *= scale(at % d) / alpha);
    let pivots = dense_lu::factorise(&mut block, d, REGULAR);
    if pivots.replaced.is_empty() {
        let mut column = vec![0.0; d];
        for p in 0..s {
            (0..d).for_each(|i| column[i] = equations[i * s + p]);
            dense_lu::solve(&block, d, &pivots, &mut column);
            (0..d).for_each(|i| equations[i * s + p] = column[i]);
        }
    }
    Ok(NodeElimination { recovery, equations })
}

/// A Householder reflection of rows `c..` that leaves column `c` nothing below its diagonal.
fn reflect(a: &mut [f64], width: usize, rows: usize, c: usize) {
    let length = (c..rows).map(|i| a[i * width + c].powi(2)).sum::<f64>().sqrt();
    if length == 0.0 {
        return;
    }
    let mut v: Vec<f64> = (c..rows).map(|i| a[i * width + c]).collect();
    v[0] += length.copysign(v[0]);
    let square: f64 = v.iter().map(|x| x * x).sum();
    for j in 0..width {
        let sum: f64 = v.iter().enumerate().map(|(i, v)| v * a[(c + i) * width + j]).sum();
        v.iter().enumerate().for_each(|(i, v)| a[(c + i) * width + j] -= 2.0 / square * sum * v);
    }
}
