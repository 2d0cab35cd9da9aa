//! The variables of the framework itself, those of time; applications register their own in their own files.

use crate::register_variable;

register_variable! {
    kind TIME: Scalar = "Time of the step.";
    kind DELTA_TIME: Scalar = "Length of the step in time.";
    kind STEP: Integer = "Number of the step, from 1.";
    kind DOMAIN_SIZE: Integer = "Dimensions of the problem, 2 or 3.";
    kind NL_ITERATION_NUMBER: Integer = "Newton iterations of the step: the number of linear solves.";
}
