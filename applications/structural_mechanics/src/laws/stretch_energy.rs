//! Energies of hyperelastic materials by the principal stretches, and the conversion of their derivatives to stress and tangent.
//!
//! W = Σ_a w(λ̄_a) with λ̄_a = J^(−1/3) λ_a (Valanis and Landel, 1967), c_a = λ_a² and n_a the eigenvalues and eigenvectors of C. With
//! γ_a = λ̄_a w′(λ̄_a), h_a = λ̄_a dγ_a/dλ̄_a and means γ̄ and h̄ over the three,
//!
//! S = Σ s_a n_a ⊗ n_a, s_a = (γ_a − γ̄)/c_a;
//! 2 ∂s_a/∂c_b = (δ_ab h_a − (h_a + h_b − h̄)/3)/(c_a c_b) − 2 δ_ab s_a/c_a,
//! (s_a − s_b)/(c_a − c_b) = [γ/c; c_a, c_b] + γ̄/(c_a c_b),
//!
//! where [γ/c; c_a, c_b] is the divided difference of γ/c, which the energy gives without a difference of close numbers.

use super::law::Matrix;
use super::strain_energy::{ElasticResponse, RightCauchyGreen};
use crate::tensor::{Tensor, eigen, pairs};

/// An energy by principal stretches.
pub trait StretchEnergy: Send + Sync {
    /// w, γ and h at a stretch λ̄.
    fn derivatives(&self, stretch: f64) -> [f64; 3];

    /// Divided difference of γ(√c)/c between two squares c of stretches, its limit where they are equal.
    fn divided_difference(&self, first: f64, second: f64) -> f64;
}

/// (a^q − b^q)/(a − b) for positive a and b, to round-off however close they are.
pub fn divided_power(q: f64, a: f64, b: f64) -> f64 {
    let log = ((a - b) / b).ln_1p();
    let ratio = if log == 0.0 { q } else { (q * log).exp_m1() / log.exp_m1() };
    b.powf(q - 1.0) * ratio
}

/// Stress and, where wanted, tangent of an energy by stretches.
pub fn respond(energy: &dyn StretchEnergy, point: &RightCauchyGreen, wants_tangent: bool) -> ElasticResponse {
    let (c, n) = eigen(&point.c);
    let shrink = point.j.powf(-2.0 / 3.0);
    let own: [[f64; 3]; 3] = std::array::from_fn(|a| energy.derivatives((shrink * c[a]).sqrt()));
    let mean = |at: usize| own.iter().map(|own| own[at]).sum::<f64>() / 3.0;
    let (gamma, h) = (mean(1), mean(2));
    let s: [f64; 3] = std::array::from_fn(|a| (own[a][1] - gamma) / c[a]);
    let along = |values: [f64; 3]| n * Tensor::from_diagonal(&values.into()) * n.transpose();
    let stress = along(s);
    let unprojected = along(std::array::from_fn(|a| own[a][1] / (shrink * c[a])));
    let mut tangent = [[0.0; 6]; 6];
    if wants_tangent {
        let mut normal = [[0.0; 3]; 3];
        let mut shear = [[0.0; 3]; 3];
        for a in 0..3 {
            for b in 0..3 {
                normal[a][b] = -(own[a][2] + own[b][2] - h) / (3.0 * c[a] * c[b]);
                if a == b {
                    normal[a][a] += (own[a][2] / c[a] - 2.0 * s[a]) / c[a];
                } else {
                    // γ/c of the stretches without volume is J^(2/3) times that of the isochoric squares
                    let difference = energy.divided_difference(shrink * c[a], shrink * c[b]);
                    shear[a][b] = shrink * shrink * difference + gamma / (c[a] * c[b]);
                }
            }
        }
        add_in_frame(&n, &normal, &shear, &mut tangent);
    }
    ElasticResponse { energy: own.iter().map(|own| own[0]).sum(), stress, unprojected, tangent }
}

/// Adds Σ normal_ab n_a n_a n_b n_b + Σ_{a<b} shear_ab m_ab ⊗ m_ab with m_ab = n_a n_b + n_b n_a.
fn add_in_frame(n: &Tensor, normal: &[[f64; 3]; 3], shear: &[[f64; 3]; 3], out: &mut Matrix<6>) {
    let pairs = pairs::<6>();
    let square: [[f64; 6]; 3] = std::array::from_fn(|a| pairs.map(|(i, j)| n[(i, a)] * n[(j, a)]));
    let mixed = |a: usize, b: usize| pairs.map(|(i, j)| n[(i, a)] * n[(j, b)] + n[(i, b)] * n[(j, a)]);
    let sides = [(0, 1, mixed(0, 1)), (1, 2, mixed(1, 2)), (0, 2, mixed(0, 2))];
    for s in 0..6 {
        for t in s..6 {
            let mut entry = 0.0;
            for a in 0..3 {
                entry += square[a][s] * (0..3).map(|b| normal[a][b] * square[b][t]).sum::<f64>();
            }
            // the mean of both orders, so that round-off does not break the symmetry
            entry += sides.iter().map(|(a, b, m)| 0.5 * (shear[*a][*b] + shear[*b][*a]) * m[s] * m[t]).sum::<f64>();
            out[s][t] += entry;
            if s != t {
                out[t][s] += entry;
            }
        }
    }
}
