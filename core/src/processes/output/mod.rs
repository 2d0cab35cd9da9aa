//! Processes that write results or compare them with those of a file.
//!
//! Each `*_process.rs` gathers plain data of a model part ([`picture`], [`gauss`]) and hands it to a writer of
//! [`crate::io::results`]; only
//! `integration_values_extrapolation_to_nodes_process` changes the model: it writes into fields of the nodes.

mod compare_two_files_check_process;
mod control;
mod csv_points_output_process;
mod extremes;
mod format;
mod from_json_check_result_process;
mod gauss;
mod gid_output_process;
mod integration_values_extrapolation_to_nodes_process;
mod json_output_process;
mod line_output_process;
mod lists;
mod multiple_points_output_process;
mod output_columns;
mod part_path;
mod point_output_process;
mod points;
mod quantity;
mod save_restart_process;
mod surfaces;
#[cfg(test)]
mod tests;
mod usual;
mod vtk_output_process;

pub use extremes::{Extreme, Extremes};
pub use format::{OutputFormat, OutputFormatEntry, OutputFormatFactory, OutputFrame, SurfaceFrame};
pub use output_columns::usual_results;
