//! Marks of the step data by which the solvers of heat tell the elements how to compute.

use zelus_core::model::StepMark;

/// Bodies of revolution are about the y axis, x is the radius.
pub const ABOUT_Y: StepMark = StepMark::new("HEAT_ABOUT_Y");
/// Nothing is conducted after the temperature has been advected.
pub const PURE_CONVECTION: StepMark = StepMark::new("PURE_CONVECTION");
/// Elements with a flow through them take gradients at their centre for all points.
pub const AT_CENTRE: StepMark = StepMark::new("GRADIENTS_AT_CENTRE");
/// No heat is stored: steady state.
pub const AT_REST: StepMark = StepMark::new("HEAT_AT_REST");
/// The cross-wind diffusion is that of the iterate, a constant in the tangent.
pub const CROSS_WIND_OF_ITERATE: StepMark = StepMark::new("CROSS_WIND_OF_ITERATE");
/// The cross-wind diffusion is that at the start of the step.
pub const CROSS_WIND_OF_STEP_START: StepMark = StepMark::new("CROSS_WIND_OF_STEP_START");
/// Residuals are those of the strong form, to be projected onto the mesh.
pub const PROJECTING: StepMark = StepMark::new("PROJECTING_RESIDUALS");
