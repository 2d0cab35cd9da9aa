//! Updated Lagrangian: ∫ δe : σ dv over the present volume, F = ∂x/∂X from the moved mesh.
//!
//! F is the total deformation gradient, so results at Gauss points are totals at any time; Kratos reports after a step
//! those of the last increment only. With a LinearElastic law, which does not push its stress forward, the tangent is
//! the law's matrix and Newton's method converges linearly, as in Kratos.

use super::formulation::Formulation;
use super::register_solids;

/// Cauchy stress on the present configuration.
#[derive(Debug)]
pub struct UpdatedLagrangian;

impl Formulation for UpdatedLagrangian {
    const FINITE: bool = true;
    const PRESENT: bool = true;
}

register_solids! { "UpdatedLagrangianElement", UpdatedLagrangian, 3,
"Planar solid for finite deformations, integrated over the present volume", "∫ δe : σ dv, e = sym ∇δu";
2: "2D3N" 3, "2D4N" 4, "2D6N" 6, "2D8N" 8, "2D9N" 9 }

register_solids! { "UpdatedLagrangianElement", UpdatedLagrangian, 6,
"Solid for finite deformations, integrated over the present volume", "∫ δe : σ dv, e = sym ∇δu";
3: "3D4N" 4, "3D5N" 5, "3D6N" 6, "3D8N" 8, "3D10N" 10, "3D13N" 13, "3D15N" 15, "3D18N" 18, "3D20N" 20, "3D27N" 27 }
