//! Small displacements: ∫ δε : σ dV over the initial volume, ε = sym ∇u of the variable DISPLACEMENT.

use super::formulation::Formulation;
use super::register_solids;

/// Small strain on the initial configuration.
#[derive(Debug)]
pub struct SmallDisplacement;

impl Formulation for SmallDisplacement {
    const FINITE: bool = false;
    const PRESENT: bool = false;
}

register_solids! { "SmallDisplacementElement", SmallDisplacement, 3,
"Planar solid for small displacements", "∫ δε : σ dV, ε = sym ∇u";
2: "2D3N" 3, "2D4N" 4, "2D6N" 6, "2D8N" 8, "2D9N" 9 }

register_solids! { "SmallDisplacementElement", SmallDisplacement, 6,
"Solid for small displacements", "∫ δε : σ dV, ε = sym ∇u";
3: "3D4N" 4, "3D5N" 5, "3D6N" 6, "3D8N" 8, "3D10N" 10, "3D13N" 13, "3D15N" 15, "3D18N" 18, "3D20N" 20, "3D27N" 27 }
