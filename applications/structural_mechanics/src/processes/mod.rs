//! Processes of structural mechanics.

mod outward_faces;
mod assign_displacement_along_direction_process;
mod impose_rigid_movement_process;
mod sprism_process;
