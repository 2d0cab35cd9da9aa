//! The model: parts with nodes, entities, fields, properties and step data, all found by name.
//!
//! A [`ModelPart`] owns everything in flat arrays; a [`SubPart`] is a list of indices into them. Quantities are columns
//! ([`Field`]) found by the name of their [`Variable`]. Nodes are stored in ascending order of id, so loops over indices
//! run in the order in which the reference program loops over ids.

mod connected_bodies;
mod directional_support;
mod constraint;
mod entity_kind;
mod entity_table;
mod fields;
mod fixities;
pub mod flags;
mod geometries;
mod halo;
mod index;
mod interface_surface;
mod merged_part;
mod level;
mod model_part;
mod multiplier_request;
mod nodes;
mod owner;
mod process_info;
mod properties;
mod rates;
mod rigid_facet;
mod mesh_share;
mod slave_nodes;
mod solver_info;
mod part_checks;
mod step_mark;
mod sub_part;
mod table;
#[cfg(test)]
pub mod test_variables;
mod material_range;
mod mesh_box;
mod numbered_bodies;
mod usual_results;
mod variable;
mod variables;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use connected_bodies::bodies_of_nodes;
pub use constraint::{MasterSlaveConstraint, NodeUnknown};
pub use directional_support::{DirectionalSupport, SupportConflict, SupportedComponent, reduce_supports};
pub use entity_kind::{EntityKind, EntityRole, KindFinder};
pub use entity_table::EntityTable;
pub use fields::{Field, Fields};
pub use fixities::Fixities;
pub use flags::Flags;
pub use geometries::Geometries;
pub use halo::Halo;
pub use interface_surface::InterfaceSurface;
pub use level::Level;
pub use material_range::MaterialRange;
pub(crate) use mesh_box::mesh_box;
pub use mesh_share::{MeshShare, MeshSizes};
pub use model_part::{ModelPart, NodalState};
pub use multiplier_request::MultiplierRequest;
pub use nodes::Nodes;
pub use numbered_bodies::NumberedBodies;
pub use owner::{DofOwners, Owner};
pub use process_info::ProcessInfo;
pub use properties::{Properties, PropertyValue};
pub use rates::{ColumnOf, FIRST, Rates, SECOND, UNKNOWN};
pub use rigid_facet::RigidFacet;
pub use slave_nodes::SlaveNodes;
pub use solver_info::SolverInfo;
pub use step_mark::StepMark;
pub use sub_part::SubPart;
pub use table::Table;
pub use usual_results::UsualResults;
pub use variable::{ColumnType, Named, ScalarVariable, Variable, VariableEntry, VariableKind, named, variables};

use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Result};

/// All root model parts of a run by name; stages share it.
#[derive(Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// The ranks of the run.
    #[serde(skip)]
    pub ranks: Ranks,
    /// Root parts by name.
    pub parts: BTreeMap<String, ModelPart>,
}

impl Model {
    /// The same model, as read from a file, of these ranks.
    #[must_use]
    pub fn shared_by(mut self, ranks: &Ranks) -> Self {
        self.ranks = ranks.clone();
        for part in self.parts.values_mut() {
            part.ranks = ranks.clone();
            part.share.iter_mut().for_each(|share| share.halo.ranks = ranks.clone());
        }
        self
    }

    /// No parts yet; those that are added belong to `ranks`.
    pub fn new(ranks: Ranks) -> Self {
        Self { ranks, parts: BTreeMap::new() }
    }

    /// Adds a root part, in place of one of the same name.
    pub fn add(&mut self, mut part: ModelPart) {
        part.ranks = self.ranks.clone();
        self.parts.insert(part.name.clone(), part);
    }

    /// The root part that a dotted path begins with.
    ///
    /// # Errors
    /// Input error naming the known root parts.
    pub fn root(&self, path: &str) -> Result<&ModelPart> {
        let name = path.split('.').next().unwrap_or(path);
        self.parts.get(name).ok_or_else(|| self.no_root(path))
    }

    /// As [`Model::root`], to change.
    ///
    /// # Errors
    /// As [`Model::root`].
    pub fn root_mut(&mut self, path: &str) -> Result<&mut ModelPart> {
        let name = path.split('.').next().unwrap_or(path);
        let problem = self.no_root(path);
        self.parts.get_mut(name).ok_or(problem)
    }

    fn no_root(&self, path: &str) -> crate::diagnostics::Error {
        let known: Vec<&str> = self.parts.keys().map(String::as_str).collect();
        Diagnostic::error("unknown-model-part", format!("there is no model part {path:?}"))
            .remedy(format!("paths begin with the root part: {}", known.join(", ")))
            .into()
    }
}
