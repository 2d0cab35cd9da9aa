//! Additions to zelus, one file each: every file ends in the registration that makes its name known to decks.

mod adhesive_law;
mod axial_spring_element;
mod continued_scheme;
mod csv_format;
mod diffusion_element;
mod doubling_adaptation;
mod elastic_foundation_condition;
mod energy_criterion;
mod gauss_solver;
mod hardening_contact;
mod jacobi_preconditioner;
mod mean_constraint;
mod patient_strategy;
mod refining_builder;
mod scale_load_process;
mod shift_mesh_modeler;
mod soft_layer_formulation;
mod uncoupled_law;
