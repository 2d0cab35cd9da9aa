//! Energies of hyperelastic materials by the invariants of C, and the one conversion of their derivatives to stress and tangent.
//!
//! With I₁ = tr C, I₂ = ½ (I₁² − tr C²), J² = det C, K = C⁻¹ the energy is W(Ī₁, Ī₂, J), Ī₁ = J^(−2/3) I₁, Ī₂ = J^(−4/3) I₂. Then
//!
//! S = Σ W_i a_i, a₁ = 2 J^(−2/3) (1 − I₁/3 K), a₂ = 2 J^(−4/3) (I₁ 1 − C − 2/3 I₂ K), a₃ = J K;
//! dS/dE = Σ W_ij a_i ⊗ a_j + W₁ A₁ + W₂ A₂ + W₃ A₃ with, 𝕂_ijkl = K_ik K_jl + K_il K_jk, 𝕀_ijkl = ½ (δ_ik δ_jl + δ_il δ_jk),
//! A₁ = 2 J^(−2/3) (2/9 I₁ K ⊗ K − 2/3 (1 ⊗ K + K ⊗ 1) + I₁/3 𝕂),
//! A₂ = 2 J^(−4/3) (2 1 ⊗ 1 − 2 𝕀 − 4/3 (b ⊗ K + K ⊗ b) + 8/9 I₂ K ⊗ K + 2/3 I₂ 𝕂), b = I₁ 1 − C, A₃ = J (K ⊗ K − 𝕂).
//!
//! All terms are products of 1, C and K: coefficients are found once, entries afterwards.

use crate::laws::law::Matrix;
use crate::tensor::{IDENTITY, Tensor, inverse, pairs, stress_vector};

/// An energy and its derivatives by Ī₁, Ī₂ and J.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergyDerivatives {
    /// W, 0 without strain.
    pub value: f64,
    /// W_i.
    pub first: [f64; 3],
    /// W_ij.
    pub second: [[f64; 3]; 3],
}

/// An energy by invariants.
pub trait InvariantEnergy: Send + Sync {
    /// Energy and derivatives at Ī₁, Ī₂ and J; not finite where the energy is not defined.
    fn derivatives(&self, invariants: [f64; 3]) -> EnergyDerivatives;
}

/// The right Cauchy–Green tensor with the quantities that every energy needs.
#[derive(Debug, Clone, Copy)]
pub struct RightCauchyGreen {
    /// C.
    pub(super) c: Tensor,
    /// K = C⁻¹.
    pub(super) inverse: Tensor,
    /// J.
    pub(super) j: f64,
}

impl RightCauchyGreen {
    /// From C.
    pub fn new(c: Tensor) -> Self {
        Self { c, inverse: inverse(&c), j: c.determinant().sqrt() }
    }
}

/// Stress S = 2 ∂W/∂C of an energy, its energy, and dS/dE with components xx yy zz xy yz xz.
#[derive(Debug, Clone, Copy)]
pub struct ElasticResponse {
    /// W.
    pub(super) energy: f64,
    /// S.
    pub(super) stress: Tensor,
    /// S before the projection that takes the pressure out of it: S = J^(−2/3) (S̄ − ⅓ (S̄ : C) K) where W does not depend on J.
    pub(super) unprojected: Tensor,
    /// dS/dE, 0 where it is not asked for.
    pub(super) tangent: Matrix<6>,
}

/// A tensor of fourth order of products of symmetric tensors: Σ m_ab T_a ⊗ T_b + k 𝕂 + l 𝕀.
pub(super) struct Products<'a, const N: usize> {
    /// T_a.
    pub(super) tensors: [&'a Tensor; N],
    /// m_ab, symmetric.
    pub(super) weights: [[f64; N]; N],
    /// K.
    pub(super) inverse: &'a Tensor,
    /// k.
    pub(super) crossed: f64,
    /// l.
    pub(super) unit: f64,
}

impl<const N: usize> Products<'_, N> {
    /// Adds the tensor to a Voigt matrix.
    pub(super) fn add_to(&self, out: &mut Matrix<6>) {
        let vectors = self.tensors.map(stress_vector::<6>);
        let pairs = pairs::<6>();
        let k = self.inverse;
        for s in 0..6 {
            let (i, j) = pairs[s];
            let mut weighted = [0.0; N];
            for (sum, row) in weighted.iter_mut().zip(&self.weights) {
                *sum = row.iter().zip(&vectors).map(|(m, t)| m * t[s]).sum();
            }
            for t in s..6 {
                let (p, q) = pairs[t];
                let products: f64 = weighted.iter().zip(&vectors).map(|(w, own)| w * own[t]).sum();
                let crossed = k[(i, p)] * k[(j, q)] + k[(i, q)] * k[(j, p)];
                let symmetric = 0.5 * (IDENTITY[(i, p)] * IDENTITY[(j, q)] + IDENTITY[(i, q)] * IDENTITY[(j, p)]);
                let entry = products + self.crossed * crossed + self.unit * symmetric;
                out[s][t] += entry;
                if s != t {
                    out[t][s] += entry;
                }
            }
        }
    }
}

/// Stress and, where wanted, tangent of an energy by invariants.
pub fn respond(energy: &dyn InvariantEnergy, point: &RightCauchyGreen, wants_tangent: bool) -> ElasticResponse {
    let RightCauchyGreen { c, inverse, j } = point;
    let (one, two) = (c.trace(), 0.5 * (c.trace() * c.trace() - c.norm_squared()));
    let (shrink, square) = (j.powf(-2.0 / 3.0), j.powf(-4.0 / 3.0));
    let EnergyDerivatives { value, first, second } = energy.derivatives([shrink * one, square * two, *j]);
    // a_i by their coefficients of 1, C and K
    let a = [
        [2.0 * shrink, 0.0, -2.0 / 3.0 * shrink * one],
        [2.0 * square * one, -2.0 * square, -4.0 / 3.0 * square * two],
        [0.0, 0.0, *j],
    ];
    let sum = |at: usize| (0..3).map(|i| first[i] * a[i][at]).sum::<f64>();
    let stress = sum(0) * IDENTITY + sum(1) * c + sum(2) * inverse;
    let unprojected = (2.0 * first[0] + 2.0 * first[1] * shrink * one) * IDENTITY - 2.0 * first[1] * shrink * c;
    let mut tangent = [[0.0; 6]; 6];
    if wants_tangent {
        let (of_one, of_two) = (2.0 * shrink * first[0], 2.0 * square * first[1]);
        let mut weights = [[0.0; 3]; 3];
        for s in 0..3 {
            for t in 0..3 {
                weights[s][t] = (0..3).map(|i| (0..3).map(|k| second[i][k] * a[i][s] * a[k][t]).sum::<f64>()).sum();
            }
        }
        let with_k = -2.0 / 3.0 * of_one - 4.0 / 3.0 * of_two * one;
        weights[0][0] += 2.0 * of_two;
        weights[0][2] += with_k;
        weights[2][0] += with_k;
        weights[1][2] += 4.0 / 3.0 * of_two;
        weights[2][1] += 4.0 / 3.0 * of_two;
        weights[2][2] += 2.0 / 9.0 * of_one * one + 8.0 / 9.0 * of_two * two + first[2] * j;
        let crossed = of_one * one / 3.0 + 2.0 / 3.0 * of_two * two - first[2] * j;
        Products { tensors: [&IDENTITY, c, inverse], weights, inverse, crossed, unit: -2.0 * of_two }
            .add_to(&mut tangent);
    }
    ElasticResponse { energy: value, stress, unprojected, tangent }
}
