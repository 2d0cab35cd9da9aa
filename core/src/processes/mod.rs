//! Actions at fixed points of the stage loop: the [`Process`] trait and the framework's own processes.
//!
//! Each file named `*_process.rs` is one registered process, found by its own name; its settings and their defaults are
//! the file of that name in `configs/processes/`. They share two workers: [`AssignToNodes`] for values and fixities of
//! unknowns, [`AssignToEntities`] for data of conditions and elements.

mod output;
mod prescription;
mod process;
mod time_table;
mod scalar_value;
mod local_axes;
mod target;
mod direction;
mod assign_to_nodes;
mod assign_to_entities;
mod assign_scalar_input_to_entities_process;
mod assign_scalar_variable_process;
mod assign_vector_variable_process;
mod assign_vector_by_direction_process;
mod directional_supports;
mod face_direction;
mod fix_variable_process;
mod assign_scalar_variable_to_entities_process;
mod assign_vector_variable_to_entities_process;
mod assign_vector_by_direction_to_entity_process;
mod assign_flag_process;
mod point_grid;
mod assign_master_slave_constraints_to_neighbours_process;
mod congruence;
mod congruent_points;
mod apply_periodic_condition_process;
mod check_nodes_process;
mod comparison;
#[cfg(test)]
mod tests;

pub use assign_to_entities::{AssignToEntities, Container, EntityComponent};
pub use assign_to_nodes::{AssignToNodes, NodalComponent};
pub use directional_supports::DirectionalSupports;
pub(crate) use directional_supports::conflict;
pub use local_axes::LocalAxes;
pub use output::{
    Extreme, Extremes, OutputFormat, OutputFormatEntry, OutputFormatFactory, OutputFrame, SurfaceFrame, usual_results,
};
pub(crate) use prescription::is_body_load;
pub use prescription::{DirectionalPrescription, Load, LoadCarrier, Prescription};
pub use process::{NamedSurface, Process, ProcessEntry, ProcessFactory, ProcessRequest};
pub use scalar_value::ScalarValue;
pub(crate) use scalar_value::{tables_of, time_tables_of};
pub use target::{Target, check_unknowns, other_problems, scalars_of};
pub use time_table::TimeTable;
