//! Total Lagrangian: ∫ δE : S dV over the initial volume, F = ∂x/∂X from the moved mesh.

use super::formulation::Formulation;
use super::register_solids;

/// Green–Lagrange strain and second Piola–Kirchhoff stress on the initial configuration.
#[derive(Debug)]
pub struct TotalLagrangian;

impl Formulation for TotalLagrangian {
    const FINITE: bool = true;
    const PRESENT: bool = false;
}

register_solids! { "TotalLagrangianElement", TotalLagrangian, 3,
"Planar solid for finite deformations, integrated over the initial volume", "∫ δE : S dV, E = ½ (FᵀF − 1)";
2: "2D3N" 3, "2D4N" 4, "2D6N" 6, "2D8N" 8, "2D9N" 9 }

register_solids! { "TotalLagrangianElement", TotalLagrangian, 6,
"Solid for finite deformations, integrated over the initial volume", "∫ δE : S dV, E = ½ (FᵀF − 1)";
3: "3D4N" 4, "3D5N" 5, "3D6N" 6, "3D8N" 8, "3D10N" 10, "3D13N" 13, "3D15N" 15, "3D18N" 18, "3D20N" 20, "3D27N" 27 }
