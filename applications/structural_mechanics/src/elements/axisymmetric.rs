//! Solids of revolution: x is the radius, y the axis; volumes are those of the full circle, THICKNESS plays no part.
//!
//! The small-displacement element has the initial radius R in its hoop strain u_r/R and in its volume 2πR dA, so that it
//! is linear. The total Lagrangian element has the initial radius in its volume and F_tt = r/R, the updated one the
//! present radius.

use super::register_solids;
use super::small_displacement::SmallDisplacement;
use super::total_lagrangian::TotalLagrangian;
use super::updated_lagrangian::UpdatedLagrangian;

register_solids! { "AxisymSmallDisplacementElement", SmallDisplacement, 4,
"Solid of revolution for small displacements", "∫ δε : σ 2πR dA, ε_tt = u_r/R";
2: "2D3N" 3, "2D4N" 4, "2D6N" 6, "2D8N" 8, "2D9N" 9 }

register_solids! { "AxisymTotalLagrangianElement", TotalLagrangian, 4,
"Solid of revolution for finite deformations, integrated over the initial volume", "∫ δE : S 2πR dA, F_tt = r/R";
2: "2D3N" 3, "2D4N" 4, "2D6N" 6, "2D8N" 8, "2D9N" 9 }

register_solids! { "AxisymUpdatedLagrangianElement", UpdatedLagrangian, 4,
"Solid of revolution for finite deformations, integrated over the present volume", "∫ δe : σ 2πr da, F_tt = r/R";
2: "2D3N" 3, "2D4N" 4, "2D6N" 6, "2D8N" 8, "2D9N" 9 }
