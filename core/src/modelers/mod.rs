//! Modelers: operations on the model of a stage before its solver reads it, found by name.

mod create_entities_from_geometries_modeler;
mod delete_model_parts_modeler;
mod import_mdpa_modeler;
mod modeler;

pub use modeler::{Modeler, ModelerEntry, ModelerFactory, run_modelers};
