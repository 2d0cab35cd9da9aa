//! The variables of the framework itself; applications register their own in their own files.

use crate::register_variable;

register_variable! {
    pub DISPLACEMENT: [f64; 3] = "Displacement from the initial position (length).";
    pub VELOCITY: [f64; 3] = "Velocity (length per time).";
    pub ACCELERATION: [f64; 3] = "Acceleration (length per time squared).";
    pub REACTION: [f64; 3] = "Force of the supports on the node, of constraints where it is free: minus the residual (force).";
    pub NORMAL: [f64; 3] = "Outward unit normal of the surface at the node.";
    pub MIDDLE_VELOCITY: [f64; 3] = "Velocity half a step after VELOCITY, in explicit integration (length per time).";
    pub FORCE_RESIDUAL: [f64; 3] = "External minus internal forces that explicit integration accelerates (force).";
    pub NODAL_MASS: f64 = "Lumped mass of the node in explicit integration (mass).";
    kind TIME: Scalar = "Time of the step.";
    kind DELTA_TIME: Scalar = "Length of the step in time.";
    kind STEP: Integer = "Number of the step, from 1.";
    kind DOMAIN_SIZE: Integer = "Dimensions of the problem, 2 or 3.";
    kind NL_ITERATION_NUMBER: Integer = "Newton iterations of the step: the number of linear solves.";
}
