//! Processes of structural mechanics.

mod impose_rigid_movement_process;
mod sprism_process;
