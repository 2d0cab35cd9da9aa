//! The multipliers of one node: which of its motions they prescribe, and how they follow from its equations.
//!
//! Let `A` (d × m) be the coefficients of the multipliers in the equations of their node, `C` (m × d) those of the node's unknowns in
//! the conditions, and `E` (m × m) those of the multipliers in the conditions, all brought to one size. Combinations of the conditions
//! without multipliers, `N₀ E = 0`, prescribe motions: with `N₀ C = Y`, `Y Y⁺ = I` and `Y Z = 0` the unknowns are `Z t + Y⁺ (…)`. The
//! rest of the conditions, `N₁`, and the node's equations give the multipliers, `R [A; N₁ E] = I`, and the equations without
//! multipliers, `L [A; N₁ E] = 0`: one equation for each `t`, scaled to `L Z = I` on the node's own.

use crate::dense_lu;

/// Size of a multiplier in a condition, relative to that of motions, below which the condition prescribes a motion: so do
/// compliances, those of stiff penalties, that are small beside that of the node.
const PRESCRIBES: f64 = 0.03;
/// Share of a column that must be left for it to be independent of those before it.
const INDEPENDENT: f64 = 1e-8;

/// Action of the multipliers of a node, by rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GroupElimination {
    /// Prescribed motions, a.
    pub(super) prescribed: usize,
    /// `N₀` and `N₁` one below the other, m × m.
    pub(super) conditions: Vec<f64>,
    /// `Y⁺`, d × a.
    pub(super) prescribed_motions: Vec<f64>,
    /// `Z`, d × (d − a).
    pub(super) free: Vec<f64>,
    /// `R`, m × (d + m − a).
    pub(super) recovery: Vec<f64>,
    /// `L`, (d − a) × (d + m − a).
    pub(super) left: Vec<f64>,
}

/// Eliminates the multipliers of a node; `None` where its unknowns do not determine them.
///
/// `a` is d × m, `c` m × d and `e` m × m, all by rows.
pub(super) fn eliminate([d, m]: [usize; 2], a: &[f64], c: &[f64], e: &[f64]) -> Option<GroupElimination> {
    let (sizes, mut conditions) = symmetric_eigen(m, &gram(m, m, e));
    let prescribed = sizes.iter().filter(|size| **size < PRESCRIBES * PRESCRIBES).count();
    if prescribed > d {
        return None;
    }
    // Each combination at one size, whatever its conditions are.
    for row in conditions.chunks_exact_mut(m) {
        let size = (0..d).map(|j| (0..m).map(|p| row[p] * c[p * d + j]).sum::<f64>().powi(2)).sum::<f64>()
            + (0..m).map(|j| (0..m).map(|p| row[p] * e[p * m + j]).sum::<f64>().powi(2)).sum::<f64>();
        if size == 0.0 {
            return None;
        }
        row.iter_mut().for_each(|v| *v /= size.sqrt());
    }
    let combined = |row: usize, of: &[f64], width: usize, j: usize| {
        (0..m).map(|p| conditions[row * m + p] * of[p * width + j]).sum::<f64>()
    };
    // Y turned, d × a, and the two halves of its orthogonal basis.
    let turned: Vec<f64> = (0..d * prescribed).map(|at| combined(at % prescribed, c, d, at / prescribed)).collect();
    let (q, upper) = orthogonal(d, prescribed, &turned)?;
    let prescribed_motions = right_inverse(d, prescribed, &q, &upper);
    let tangential = d - prescribed;
    let free: Vec<f64> =
        (0..d * tangential).map(|at| q[(at / tangential) * d + prescribed + at % tangential]).collect();
    // [A; N₁ E], (d + m − a) × m.
    let s = d + m - prescribed;
    if prescribed == 0
        && let Some(inverse) = inverse(m, |row, j| combined(row, e, m, j))
    {
        let (recovery, left) = by_compliance([d, m], a, &inverse);
        return Some(GroupElimination {
            prescribed,
            conditions,
            prescribed_motions,
            free: identity(d),
            recovery,
            left,
        });
    }
    let mut stack = a.to_vec();
    for row in prescribed..m {
        stack.extend((0..m).map(|j| combined(row, e, m, j)));
    }
    let (q, upper) = orthogonal(s, m, &stack)?;
    let mut recovery = vec![0.0; m * s];
    for p in 0..s {
        for i in (0..m).rev() {
            let known: f64 = (i + 1..m).map(|j| upper[i * m + j] * recovery[j * s + p]).sum();
            recovery[i * s + p] = (q[p * s + i] - known) / upper[i * m + i];
        }
    }
    let mut left: Vec<f64> = (0..tangential * s).map(|at| q[(at % s) * s + m + at / s]).collect();
    scale(d, tangential, s, &mut left, &free)?;
    Some(GroupElimination { prescribed, conditions, prescribed_motions, free, recovery, left })
}

/// `R` and `L` where the conditions alone give the multipliers, `λ = (N₁ E)⁻¹ …`: the reduced system has the node's stiffness with that
/// of its penalty, symmetric where both are.
fn by_compliance([d, m]: [usize; 2], a: &[f64], inverse: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let s = d + m;
    let (mut recovery, mut left) = (vec![0.0; m * s], vec![0.0; d * s]);
    for k in 0..m {
        (0..m).for_each(|i| recovery[i * s + d + k] = inverse[i * m + k]);
        (0..d).for_each(|i| left[i * s + d + k] = -(0..m).map(|p| a[i * m + p] * inverse[p * m + k]).sum::<f64>());
    }
    (0..d).for_each(|i| left[i * s + i] = 1.0);
    (recovery, left)
}

fn identity(n: usize) -> Vec<f64> {
    (0..n * n).map(|at| f64::from(u8::from(at / n == at % n))).collect()
}

/// The inverse of a matrix by rows; `None` where it is nearly singular.
fn inverse(n: usize, entry: impl Fn(usize, usize) -> f64) -> Option<Vec<f64>> {
    let mut lu: Vec<f64> = (0..n * n).map(|at| entry(at % n, at / n)).collect();
    let pivots = dense_lu::factorise(&mut lu, n, INDEPENDENT);
    if !pivots.replaced.is_empty() {
        return None;
    }
    let mut out = vec![0.0; n * n];
    for column in 0..n {
        let mut x: Vec<f64> = (0..n).map(|row| f64::from(u8::from(row == column))).collect();
        dense_lu::solve(&lu, n, &pivots, &mut x);
        x.iter().enumerate().for_each(|(row, x)| out[row * n + column] = *x);
    }
    Some(out)
}

/// `L ← (L_d Z)⁻¹ L` with the first d columns `L_d`.
fn scale(d: usize, rows: usize, s: usize, left: &mut [f64], free: &[f64]) -> Option<()> {
    let product = |i: usize, j: usize| (0..d).map(|k| left[i * s + k] * free[k * rows + j]).sum::<f64>();
    let mut block: Vec<f64> = (0..rows * rows).map(|at| product(at % rows, at / rows)).collect();
    let pivots = dense_lu::factorise(&mut block, rows, INDEPENDENT);
    if !pivots.replaced.is_empty() {
        return None;
    }
    let mut column = vec![0.0; rows];
    for p in 0..s {
        (0..rows).for_each(|i| column[i] = left[i * s + p]);
        dense_lu::solve(&block, rows, &pivots, &mut column);
        (0..rows).for_each(|i| left[i * s + p] = column[i]);
    }
    Some(())
}

/// `Q₁ R⁻ᵀ` of `Yᵀ = Q₁ R`, d × a, which is `Y⁺`.
fn right_inverse(d: usize, a: usize, q: &[f64], upper: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; d * a];
    for i in 0..d {
        for j in (0..a).rev() {
            let known: f64 = (j + 1..a).map(|k| out[i * a + k] * upper[j * a + k]).sum();
            out[i * a + j] = (q[i * d + j] - known) / upper[j * a + j];
        }
    }
    out
}

/// `M Mᵀ` of a matrix with `rows` rows.
fn gram(rows: usize, width: usize, m: &[f64]) -> Vec<f64> {
    let dot = |i: usize, j: usize| (0..width).map(|k| m[i * width + k] * m[j * width + k]).sum();
    (0..rows * rows).map(|at| dot(at / rows, at % rows)).collect()
}

/// Eigenvalues, ascending, and eigenvectors, by rows, of a symmetric matrix: Jacobi's rotations.
fn symmetric_eigen(n: usize, matrix: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let mut a = matrix.to_vec();
    let mut v: Vec<f64> = (0..n * n).map(|at| f64::from(u8::from(at / n == at % n))).collect();
    for _ in 0..30 {
        for p in 0..n {
            for q in p + 1..n {
                if a[p * n + q].abs() <= f64::EPSILON * f64::EPSILON * (a[p * n + p] + a[q * n + q]).abs() {
                    continue;
                }
                let theta = (a[q * n + q] - a[p * n + p]) / (2.0 * a[p * n + q]);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let cosine = 1.0 / t.hypot(1.0);
                let sine = t * cosine;
                for k in 0..n {
                    let (x, y) = (a[k * n + p], a[k * n + q]);
                    (a[k * n + p], a[k * n + q]) = (cosine * x - sine * y, sine * x + cosine * y);
                }
                for k in 0..n {
                    let (x, y) = (a[p * n + k], a[q * n + k]);
                    (a[p * n + k], a[q * n + k]) = (cosine * x - sine * y, sine * x + cosine * y);
                    let (x, y) = (v[p * n + k], v[q * n + k]);
                    (v[p * n + k], v[q * n + k]) = (cosine * x - sine * y, sine * x + cosine * y);
                }
            }
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| a[i * n + i].total_cmp(&a[j * n + j]));
    let vectors = order.iter().flat_map(|&i| v[i * n..(i + 1) * n].to_vec()).collect();
    (order.iter().map(|&i| a[i * n + i].max(0.0)).collect(), vectors)
}

/// `Q` (rows × rows) and `R` (width × width), by rows, of a matrix by Householder's reflections; `None` where its columns
/// depend on each other.
///
/// Each reflection is towards the axis of the column's largest entry, so that `Q` follows small changes of the matrix.
fn orthogonal(rows: usize, width: usize, matrix: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    if width > rows {
        return None;
    }
    let mut r = matrix.to_vec();
    let mut q: Vec<f64> = (0..rows * rows).map(|at| f64::from(u8::from(at / rows == at % rows))).collect();
    let largest = r.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    for c in 0..width {
        let length = (c..rows).map(|i| r[i * width + c].powi(2)).sum::<f64>().sqrt();
        if length <= INDEPENDENT * largest {
            return None;
        }
        let largest_at = (c..rows).fold(c, |best, i| {
            // Entries that round-off alone tells apart are equal.
            if r[i * width + c].abs() > (1.0 + 1e-6) * r[best * width + c].abs() { i } else { best }
        });
        if largest_at != c {
            (0..width).for_each(|j| r.swap(c * width + j, largest_at * width + j));
            (0..rows).for_each(|i| q.swap(i * rows + c, i * rows + largest_at));
        }
        let mut v: Vec<f64> = (c..rows).map(|i| r[i * width + c]).collect();
        v[0] += length.copysign(v[0]);
        let square: f64 = v.iter().map(|x| x * x).sum();
        for j in 0..width {
            let sum: f64 = v.iter().enumerate().map(|(i, v)| v * r[(c + i) * width + j]).sum();
            v.iter().enumerate().for_each(|(i, v)| r[(c + i) * width + j] -= 2.0 / square * sum * v);
        }
        for i in 0..rows {
            let sum: f64 = v.iter().enumerate().map(|(j, v)| v * q[i * rows + c + j]).sum();
            v.iter().enumerate().for_each(|(j, v)| q[i * rows + c + j] -= 2.0 / square * sum * v);
        }
    }
    r.truncate(width * width);
    Some((q, r))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(left: &[f64], right: &[f64], [rows, inner, width]: [usize; 3]) -> Vec<f64> {
        let entry = |i: usize, j: usize| (0..inner).map(|k| left[i * inner + k] * right[k * width + j]).sum();
        (0..rows * width).map(|at| entry(at / width, at % width)).collect()
    }

    fn is_close(a: &[f64], b: &[f64]) -> bool {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn one_condition_leaves_the_tangential_motions() {
        let normal = [0.6, 0.0, -0.8];
        let found = eliminate([3, 1], &normal, &normal, &[0.0]).expect("determined");
        assert_eq!(found.prescribed, 1);
        assert!(is_close(&product(&normal, &found.free, [1, 3, 2]), &[0.0; 2]));
        assert!(is_close(&product(&found.recovery, &normal, [1, 3, 1]), &[1.0]));
        let turned: Vec<f64> = (0..6).map(|at| found.free[(at % 3) * 2 + at / 3]).collect();
        assert!(is_close(&found.left, &turned), "symmetric where the condition is what the multiplier does");
    }

    #[test]
    fn conditions_on_multipliers_leave_their_motions_free() {
        // Sliding along x under friction: no gap along z, tangential multipliers follow the normal one.
        let a = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let c = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let e = [1.0, 0.0, -0.3, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
        let found = eliminate([3, 3], &a, &c, &e).expect("determined");
        assert_eq!(found.prescribed, 1);
        assert!(is_close(&found.prescribed_motions.iter().map(|v| v.abs()).collect::<Vec<_>>(), &[0.0, 0.0, 1.0]));
        let mixed = product(&found.conditions[3..], &e, [2, 3, 3]);
        let stack = [&a[..], &mixed[..]].concat();
        assert!(is_close(&product(&found.left, &stack, [2, 5, 3]), &[0.0; 6]));
        let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        assert!(is_close(&product(&found.recovery, &stack, [3, 5, 3]), &identity));
    }

    #[test]
    fn motions_prescribed_by_two_conditions_follow_them() {
        let c = [1.0, 0.5, 0.0, 0.0, 0.2, 1.0];
        let a = [1.0, 0.0, 0.5, 0.2, 0.0, 1.0];
        let found = eliminate([3, 2], &a, &c, &[0.0; 4]).expect("determined");
        let y = product(&found.conditions, &c, [2, 2, 3]);
        assert!(is_close(&product(&y, &found.prescribed_motions, [2, 3, 2]), &[1.0, 0.0, 0.0, 1.0]));
        assert!(is_close(&product(&y, &found.free, [2, 3, 1]), &[0.0; 2]));
    }

    #[test]
    fn a_multiplier_that_does_nothing_is_refused() {
        assert_eq!(eliminate([2, 2], &[1.0, 0.0, 0.0, 0.0], &[1.0, 0.0, 0.0, 0.0], &[0.0; 4]), None);
    }
}
