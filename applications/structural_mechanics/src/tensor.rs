//! Tensors of second order as 3×3 matrices, and their Voigt vectors.
//!
//! Voigt order: plane (xx, yy, xy), axisymmetric (rr, zz, tt, rz) with r, z, t the axes 0, 1, 2, and solid
//! (xx, yy, zz, xy, yz, xz). Shear strains are twice the tensor's components.

use nalgebra::{Matrix3, Vector3};

/// A tensor `t[(row, column)]`.
pub type Tensor = Matrix3<f64>;

/// The unit tensor.
pub const IDENTITY: Tensor = Tensor::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);

/// Steps of the eigenvalue iteration that are allowed; without a bound it does not end where a number is not finite.
const SWEEPS: usize = 100;
/// Share of its diagonal by which a tangent that is symmetric differs from its transpose.
const ROUND_OFF: f64 = 1e-12;

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
    let mut out = Tensor::zeros();
    for (&value, (p, q)) in strain.iter().zip(pairs::<S>()) {
        let value = if p == q { value } else { 0.5 * value };
        out[(p, q)] = value;
        out[(q, p)] = value;
    }
    out
}

/// The strain vector of a symmetric tensor.
pub fn strain_vector<const S: usize>(t: &Tensor) -> [f64; S] {
    pairs::<S>().map(|(p, q)| if p == q { t[(p, p)] } else { t[(p, q)] + t[(q, p)] })
}

/// The symmetric tensor of a stress vector; components it does not hold are 0.
pub fn stress_tensor<const S: usize>(stress: &[f64; S]) -> Tensor {
    let mut out = Tensor::zeros();
    for (&value, (p, q)) in stress.iter().zip(pairs::<S>()) {
        out[(p, q)] = value;
        out[(q, p)] = value;
    }
    out
}

/// The stress vector of a symmetric tensor.
pub fn stress_vector<const S: usize>(t: &Tensor) -> [f64; S] {
    pairs::<S>().map(|(p, q)| t[(p, q)])
}

/// Inverse; not finite when the tensor is singular.
pub fn inverse(a: &Tensor) -> Tensor {
    a.try_inverse().unwrap_or(Tensor::repeat(f64::NAN))
}

/// `f a fᵀ`.
pub fn congruent(f: &Tensor, a: &Tensor) -> Tensor {
    f * a * f.transpose()
}

/// Spatial tangent c = F F F F : D / det F of a material tangent, both in Voigt form; symmetric to the bit where D is so to round-off.
pub fn push_forward<const S: usize>(d: &[[f64; S]; S], f: &Tensor, det_f: f64) -> [[f64; S]; S] {
    let pairs = pairs::<S>();
    let mut map = [[0.0; S]; S];
    for (row, (a, b)) in map.iter_mut().zip(pairs) {
        for (entry, (i, j)) in row.iter_mut().zip(pairs) {
            *entry = if i == j { f[(a, i)] * f[(b, i)] } else { f[(a, i)] * f[(b, j)] + f[(a, j)] * f[(b, i)] };
        }
    }
    let mut half = [[0.0; S]; S];
    let mut out = [[0.0; S]; S];
    for s in 0..S {
        for t in 0..S {
            half[s][t] = (0..S).map(|k| map[s][k] * d[k][t]).sum();
        }
    }
    let is_round_off = |s: usize, t: usize| (d[s][t] - d[t][s]).abs() <= ROUND_OFF * (d[s][s].abs() + d[t][t].abs());
    let symmetric = (0..S).all(|s| (0..s).all(|t| is_round_off(s, t)));
    for s in 0..S {
        for t in if symmetric { s } else { 0 }..S {
            out[s][t] = (0..S).map(|k| half[s][k] * map[t][k]).sum::<f64>() / det_f;
            if symmetric {
                out[t][s] = out[s][t];
            }
        }
    }
    out
}

/// The tensor without its mean diagonal.
pub fn deviator(a: &Tensor) -> Tensor {
    a - Tensor::from_diagonal_element(a.trace() / 3.0)
}

/// The lower triangle L of a = L Lᵀ; not finite when the symmetric tensor is not positive definite.
pub fn cholesky(a: &Tensor) -> Tensor {
    a.cholesky().map_or(Tensor::repeat(f64::NAN), |factors| factors.unpack())
}

/// Eigenvalues of a symmetric tensor and, as columns, its unit eigenvectors; not finite where the tensor is not.
pub fn eigen(a: &Tensor) -> (Vector3<f64>, Tensor) {
    match a.try_symmetric_eigen(f64::EPSILON, SWEEPS) {
        Some(found) => (found.eigenvalues, found.eigenvectors),
        None => (Vector3::repeat(f64::NAN), Tensor::repeat(f64::NAN)),
    }
}
