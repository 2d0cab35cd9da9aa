//! The variables of heat.

use zelus_core::{register_material_range, register_rates, register_variable};
pub use zelus_structural_mechanics::variables::TEMPERATURE;

register_variable! {
    pub TEMPERATURE_RATE: f64 = "Change of TEMPERATURE by time.";
    pub REACTION_FLUX: f64 = "Heat that a prescribed node feeds into the body: minus the residual (power).";
    pub HEAT_FLUX: f64 = "Source of heat (power per volume).";
    pub FACE_HEAT_FLUX: f64 = "Heat that enters through a face (power per area).";
    pub PROJECTED_SCALAR1: f64 = "Temperature of the last step, advected with the velocity.";
    pub CONVECTION_VELOCITY: [f64; 3] = "Without effect: VELOCITY less MESH_VELOCITY carries heat.";
    pub TEMPERATURE_GRADIENT: [f64; 3] = "Without effect: no element has gradients as unknowns.";
    pub MESH_VELOCITY: [f64; 3] = "Velocity of the nodes, which VELOCITY is relative to (length per time).";
    pub TRANSFER_COEFFICIENT: f64 = "Without effect: faces have CONVECTION_COEFFICIENT.";
    kind CONDUCTIVITY: Scalar = "Heat conductivity (power per length and temperature).";
    kind SPECIFIC_HEAT: Scalar = "Heat that a mass takes up (energy per mass and temperature).";
    kind AMBIENT_TEMPERATURE: Scalar = "Temperature of the surroundings of a face.";
    kind CONVECTION_COEFFICIENT: Scalar = "Heat through a face by difference to AMBIENT_TEMPERATURE (power per area and temperature).";
    kind EMISSIVITY: Scalar = "Share of black radiation that a face gives off and takes up.";
    kind TAYLOR_QUINNEY_COEFFICIENT: Scalar = "Share of plastic work that heats the body, times the factor from the unit of work to that of heat.";
    kind STEFAN_BOLTZMANN_CONSTANT: Scalar = "Black radiation over the fourth power of temperature, in the units of the deck; 5.67e-8 W/(m² K⁴) where it is not given.";
}

register_material_range! { "[0, inf)": ["CONDUCTIVITY", "SPECIFIC_HEAT", "CONVECTION_COEFFICIENT"] }
register_material_range! { "(0, inf)": ["STEFAN_BOLTZMANN_CONSTANT"] }
register_material_range! { "[0, 1]": ["EMISSIVITY"] }

register_rates! { "TEMPERATURE",
    first: "TEMPERATURE_RATE",
    reaction: Some("REACTION_FLUX"),
}
