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
/// Each step is one linear solve.
pub const LINEAR: StepMark = StepMark::new("LINEAR_HEAT");
/// Residuals are those of the strong form, to be projected onto the mesh.
pub const PROJECTING: StepMark = StepMark::new("PROJECTING_RESIDUALS");
