//! Homogeneous deformations of incompressible hyperelastic materials, and the stretches at which these are no longer stable.
//!
//! With no stress along axis 3 and λ₁ λ₂ λ₃ = 1 the Cauchy stresses are σ_a = λ_a ∂W/∂λ_a − λ₃ ∂W/∂λ₃, a = 1, 2. The material is
//! stable (Drucker) where Σ dσ_a dε_a > 0 for all increments dε_a = dλ_a/λ_a: the matrix ∂σ_a/∂ε_b is positive definite.

use super::rubber::Energy;
use super::strain_energy::RightCauchyGreen;
use crate::tensor::Tensor;

/// Least and largest stretch that [`first_instability`] tries.
const RANGE: [f64; 2] = [0.5, 2.0];
/// Parts of the range on either side of no stretch.
const PARTS: i32 = 60;

/// A test with a homogeneous deformation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HomogeneousTest {
    /// λ₁ = λ, λ₂ = λ₃.
    Uniaxial,
    /// λ₁ = λ₂ = λ.
    Equibiaxial,
    /// λ₁ = λ, λ₂ = 1 (pure shear).
    Planar,
}

impl HomogeneousTest {
    /// The three tests.
    pub const ALL: [Self; 3] = [Self::Uniaxial, Self::Equibiaxial, Self::Planar];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniaxial => "uniaxial",
            Self::Equibiaxial => "equibiaxial",
            Self::Planar => "planar",
        }
    }

    /// λ₁ and λ₂.
    pub(super) fn stretches(self, stretch: f64) -> [f64; 2] {
        match self {
            Self::Uniaxial => [stretch, stretch.sqrt().recip()],
            Self::Equibiaxial => [stretch, stretch],
            Self::Planar => [stretch, 1.0],
        }
    }

    /// Nominal stress along axis 1, force per initial area.
    pub fn nominal_stress(self, energy: &Energy, stretch: f64) -> f64 {
        let [first, second] = self.stretches(stretch);
        BiaxialResponse::of(energy, [first, second]).stress[0] / stretch
    }
}

/// Cauchy stresses and their derivatives by logarithmic strains under plane stress.
#[derive(Debug, Clone, Copy)]
pub struct BiaxialResponse {
    /// σ₁ and σ₂.
    pub stress: [f64; 2],
    /// ∂σ_a/∂ε_b.
    pub stiffness: [[f64; 2]; 2],
}

impl BiaxialResponse {
    /// The response to stretches λ₁ and λ₂.
    pub fn of(energy: &Energy, [first, second]: [f64; 2]) -> Self {
        let stretches = [first, second, 1.0 / (first * second)];
        let c = stretches.map(|l| l * l);
        let out = energy.respond(&RightCauchyGreen::new(Tensor::from_diagonal(&c.into())), true);
        let pull: [f64; 3] = std::array::from_fn(|a| out.stress[(a, a)] * c[a]);
        let slope = |a: usize, b: usize| c[a] * out.tangent[a][b] * c[b] + if a == b { 2.0 * pull[a] } else { 0.0 };
        // ε₃ = −ε₁ − ε₂
        let by = |a: usize, b: usize| slope(a, b) - slope(a, 2);
        Self {
            stress: [pull[0] - pull[2], pull[1] - pull[2]],
            stiffness: std::array::from_fn(|a| std::array::from_fn(|b| by(a, b) - by(2, b))),
        }
    }

    pub(super) fn is_stable(&self) -> bool {
        let [[a, b], [c, d]] = self.stiffness;
        a + d > 0.0 && a * d > 0.25 * (b + c) * (b + c)
    }
}

/// The deformation and the stretch nearest to 1, on either side of it within 0.5 and 2, at which an energy is no longer stable.
pub fn first_instability(energy: &Energy) -> Option<(HomogeneousTest, f64)> {
    let mut found: Option<(HomogeneousTest, f64)> = None;
    for (test, limit) in HomogeneousTest::ALL.into_iter().flat_map(|test| RANGE.map(|limit: f64| (test, limit))) {
        let stretch = |part: i32| limit.powf(f64::from(part) / f64::from(PARTS));
        let is_lost = |part: &i32| !BiaxialResponse::of(energy, test.stretches(stretch(*part))).is_stable();
        let Some(part) = (1..=PARTS).find(is_lost) else { continue };
        let nearer = found.is_none_or(|(_, known)| stretch(part).ln().abs() < known.ln().abs());
        if nearer {
            found = Some((test, stretch(part)));
        }
    }
    found
}
