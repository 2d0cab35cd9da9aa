//! Small displacements with mean dilatation: ∫ δε̄ : σ dV, ε̄ = dev ε + θ̄/3 1, θ̄ the mean of div u over the element.
//!
//! Against volumetric locking: near-incompressible elasticity and plastic flow. In the plane the strain has its component
//! across, (θ̄ − θ)/3, so that laws of plane strain are asked for four components.

use super::formulation::Formulation;
use super::register_solids;

/// Small strain on the initial configuration, dilatation averaged over the element.
#[derive(Debug)]
pub struct SmallDisplacementBbar;

impl Formulation for SmallDisplacementBbar {
    const FINITE: bool = false;
    const PRESENT: bool = false;
    const MEAN_DILATATION: bool = true;
}

register_solids! { "SmallDisplacementBbarElement", SmallDisplacementBbar, 4,
"Planar solid for small displacements with mean dilatation (B-bar), in plane strain", "∫ δε̄ : σ dV, ε̄ = dev ε + θ̄/3 1";
2: "2D4N" 4 }

register_solids! { "SmallDisplacementBbarElement", SmallDisplacementBbar, 6,
"Solid for small displacements with mean dilatation (B-bar)", "∫ δε̄ : σ dV, ε̄ = dev ε + θ̄/3 1";
3: "3D8N" 8 }
