//! Total Lagrangian with one pressure an element, against volumetric locking at large strains (Q1P0).
//!
//! ∫ δE : S(E, p) dV with p = −κ (J̄ − 1), J̄ = ∫ J dV/V: the pressure that makes ∫ δp (J − 1 + p/κ) dV vanish. Its
//! change adds κ/V g gᵀ to the stiffness, g = ∫ J Bᵀ C⁻¹ dV. V is the initial volume, of laws that expand the one at which
//! they are free, ∫ θ³ dV. (The reference program keeps p from iteration to
//! iteration; it has the same value once converged.)

use super::formulation::Formulation;
use super::register_solids;

/// Green–Lagrange strain on the initial configuration, the volume averaged over the element.
#[derive(Debug)]
pub struct TotalLagrangianQ1P0;

impl Formulation for TotalLagrangianQ1P0 {
    const FINITE: bool = true;
    const PRESENT: bool = false;
    const CONSTANT_PRESSURE: bool = true;
}

register_solids! { "TotalLagrangianQ1P0MixedElement", TotalLagrangianQ1P0, 3,
"Planar solid for finite deformations that hardly change the volume: one pressure an element; plane strain",
"∫ δE : S(E, p) dV, p = −κ (J̄ − 1)";
2: "2D4N" 4, "2D6N" 6, "2D8N" 8, "2D9N" 9 }

register_solids! { "AxisymTotalLagrangianQ1P0MixedElement", TotalLagrangianQ1P0, 4,
"Solid of revolution for finite deformations that hardly change the volume: one pressure an element",
"∫ δE : S(E, p) 2πR dA, p = −κ (J̄ − 1)";
2: "2D4N" 4, "2D6N" 6, "2D8N" 8, "2D9N" 9 }

register_solids! { "TotalLagrangianQ1P0MixedElement", TotalLagrangianQ1P0, 6,
"Solid for finite deformations that hardly change the volume: one pressure an element, with an isochoric law",
"∫ δE : S(E, p) dV, p = −κ (J̄ − 1)";
3: "3D4N" 4, "3D8N" 8, "3D10N" 10, "3D20N" 20 }
