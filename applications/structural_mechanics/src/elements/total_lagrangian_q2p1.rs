//! Total Lagrangian of second order with a pressure that is linear in the element, against volumetric locking (Q2P1).
//!
//! As [`super::TotalLagrangianQ1P0`] with p = Σ p_k φ_k, φ = 1 and the coordinates: p = −κ M⁻¹ b, M_kl = ∫ φ_k φ_l dV, b_k =
//! ∫ φ_k (J − 1) dV. Its change adds κ Σ (M⁻¹)_kl g_k g_lᵀ to the stiffness, g_k = ∫ φ_k J Bᵀ C⁻¹ dV. With the middle nodes of faces and
//! cells the pair is stable: pressures converge with second order and do not oscillate (Boffi, Brezzi and Fortin, § 8.6.3).

use super::formulation::Formulation;
use super::register_solids;

/// Green–Lagrange strain on the initial configuration, the volume by a linear pressure.
#[derive(Debug)]
pub struct TotalLagrangianQ2P1;

impl Formulation for TotalLagrangianQ2P1 {
    const FINITE: bool = true;
    const PRESENT: bool = false;
    const CONSTANT_PRESSURE: bool = true;
    const LINEAR_PRESSURE: bool = true;
}

register_solids! { "TotalLagrangianQ2P1MixedElement", TotalLagrangianQ2P1, 3,
"Planar solid for finite deformations that hardly change the volume: a linear pressure an element; plane strain",
"∫ δE : S(E, p) dV, p = −κ M⁻¹ ∫ φ (J − 1) dV";
2: "2D9N" 9 }

register_solids! { "AxisymTotalLagrangianQ2P1MixedElement", TotalLagrangianQ2P1, 4,
"Solid of revolution for finite deformations that hardly change the volume: a linear pressure an element",
"∫ δE : S(E, p) 2πR dA, p = −κ M⁻¹ ∫ φ (J − 1) dV";
2: "2D9N" 9 }

register_solids! { "TotalLagrangianQ2P1MixedElement", TotalLagrangianQ2P1, 6,
"Solid for finite deformations that hardly change the volume: a linear pressure an element",
"∫ δE : S(E, p) dV, p = −κ M⁻¹ ∫ φ (J − 1) dV";
3: "3D27N" 27 }
