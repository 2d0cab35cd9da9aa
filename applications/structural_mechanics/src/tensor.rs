//! Tensors of second order as 3×3 matrices, and their Voigt vectors.
//!
//! Voigt order: plane (xx, yy, xy), axisymmetric (rr, zz, tt, rz) with r, z, t the axes 0, 1, 2, and solid
//! (xx, yy, zz, xy, yz, xz). Shear strains are twice the tensor's components.

/// A tensor `t[row][column]`.
pub type Tensor = [[f64; 3]; 3];

/// The unit tensor.
pub const IDENTITY: Tensor = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Tensor indices of the `S` Voigt components: 3 plane, 4 axisymmetric, 6 solid.
pub const fn pairs<const S: usize>() -> [(usize, usize); S] {
    let all: &[(usize, usize)] = match S {
        3 => &[(0, 0), (1, 1), (0, 1)],
        4 => &[(0, 0), (1, 1), (2, 2), (0, 1)],
        6 => &[(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)],
        _ => panic!("Voigt vectors have 3, 4 or 6 components"),
    };
    let mut out = [(0, 0); S];
    let mut s = 0;
    while s < S {
        out[s] = all[s];
        s += 1;
    }
    out
}

/// The symmetric tensor of a strain vector; components it does not hold are 0.
pub fn strain_tensor<const S: usize>(strain: &[f64; S]) -> Tensor {
    let mut out = [[0.0; 3]; 3];
    for (&value, (p, q)) in strain.iter().zip(pairs::<S>()) {
        let value = if p == q { value } else { 0.5 * value };
        out[p][q] = value;
        out[q][p] = value;
    }
    out
}

/// The strain vector of a symmetric tensor.
pub fn strain_vector<const S: usize>(t: &Tensor) -> [f64; S] {
    pairs::<S>().map(|(p, q)| if p == q { t[p][p] } else { t[p][q] + t[q][p] })
}

/// The symmetric tensor of a stress vector; components it does not hold are 0.
pub fn stress_tensor<const S: usize>(stress: &[f64; S]) -> Tensor {
    let mut out = [[0.0; 3]; 3];
    for (&value, (p, q)) in stress.iter().zip(pairs::<S>()) {
        out[p][q] = value;
        out[q][p] = value;
    }
    out
}

/// The stress vector of a symmetric tensor.
pub fn stress_vector<const S: usize>(t: &Tensor) -> [f64; S] {
    pairs::<S>().map(|(p, q)| t[p][q])
}

/// `a b`.
pub fn product(a: &Tensor, b: &Tensor) -> Tensor {
    let mut out = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
    out
}

/// `aᵀ`.
pub fn transposed(a: &Tensor) -> Tensor {
    let mut out = *a;
    for i in 0..3 {
        for j in 0..3 {
            out[i][j] = a[j][i];
        }
    }
    out
}

/// Determinant.
pub fn determinant(a: &Tensor) -> f64 {
    a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
        + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0])
}

/// Inverse; not finite when the tensor is singular.
pub fn inverse(a: &Tensor) -> Tensor {
    let factor = 1.0 / determinant(a);
    let mut out = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            let (p, q, r, s) = ((j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3);
            out[i][j] = (a[p][r] * a[q][s] - a[p][s] * a[q][r]) * factor;
        }
    }
    out
}

/// `f a fᵀ`.
pub fn congruent(f: &Tensor, a: &Tensor) -> Tensor {
    product(&product(f, a), &transposed(f))
}

/// Spatial tangent c = F F F F : D / det F of a material tangent, both in Voigt form.
pub fn push_forward<const S: usize>(d: &[[f64; S]; S], f: &Tensor, det_f: f64) -> [[f64; S]; S] {
    let pairs = pairs::<S>();
    let mut map = [[0.0; S]; S];
    for (row, (a, b)) in map.iter_mut().zip(pairs) {
        for (entry, (i, j)) in row.iter_mut().zip(pairs) {
            *entry = if i == j { f[a][i] * f[b][i] } else { f[a][i] * f[b][j] + f[a][j] * f[b][i] };
        }
    }
    let mut half = [[0.0; S]; S];
    let mut out = [[0.0; S]; S];
    for s in 0..S {
        for t in 0..S {
            half[s][t] = (0..S).map(|k| map[s][k] * d[k][t]).sum();
        }
    }
    for s in 0..S {
        for t in s..S {
            out[s][t] = (0..S).map(|k| half[s][k] * map[t][k]).sum::<f64>() / det_f;
            out[t][s] = out[s][t];
        }
    }
    out
}

/// Sum of the diagonal.
pub fn trace(a: &Tensor) -> f64 {
    a[0][0] + a[1][1] + a[2][2]
}

/// The tensor without its mean diagonal.
pub fn deviator(a: &Tensor) -> Tensor {
    let mut out = *a;
    let mean = trace(a) / 3.0;
    (0..3).for_each(|i| out[i][i] -= mean);
    out
}

/// √(a : a).
pub fn norm(a: &Tensor) -> f64 {
    a.as_flattened().iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// The lower triangle L of a = L Lᵀ; not finite when the symmetric tensor is not positive definite.
pub fn cholesky(a: &Tensor) -> Tensor {
    let mut l = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..=i {
            let rest = a[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            l[i][j] = if i == j { rest.sqrt() } else { rest / l[j][j] };
        }
    }
    l
}

/// Eigenvalues of a symmetric tensor and, as rows, its unit eigenvectors, by Jacobi's rotations.
pub fn eigen(a: &Tensor) -> ([f64; 3], Tensor) {
    let (mut a, mut vectors) = (*a, IDENTITY);
    for _ in 0..32 {
        let off = a[0][1].abs() + a[0][2].abs() + a[1][2].abs();
        if off == 0.0 || off.is_nan() {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let half = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
            let t = if half.is_infinite() { 0.0 } else { half.signum() / (half.abs() + half.hypot(1.0)) };
            let c = 1.0 / t.hypot(1.0);
            let s = t * c;
            for k in 0..3 {
                (a[k][p], a[k][q]) = (c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]);
            }
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
            }
            for k in 0..3 {
                (vectors[p][k], vectors[q][k]) =
                    (c * vectors[p][k] - s * vectors[q][k], s * vectors[p][k] + c * vectors[q][k]);
            }
            (a[p][q], a[q][p]) = (0.0, 0.0);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], vectors)
}
