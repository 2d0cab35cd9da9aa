//! Contact pairs as blocks: the pairs of the search, in the form the assembly takes.

mod contact_block;
mod facet_operators;
mod facing_points;
mod formulation;
mod grouping;
mod kinematics;
mod known_operators;
mod local_system;
mod nitsche_block;
mod pair;
mod pair_block;
mod pair_request;
mod pairs_of_shapes;

pub use crate::law::Multiplier;
pub use crate::mortar::condition_name;
pub use contact_block::{ContactBlock, IntegrationState};
pub use facet_operators::{FacetOperators, FacetPair, facet_operators, nodal_normals, overlapping_pairs};
pub use facing_points::{FacingPoint, facing_points};
pub use formulation::{
    ByNode, Formulation, FormulationEntry, Friction, TyingFormulation, TyingFormulationEntry, find_formulation,
    find_tying_formulation, variables_of,
};
pub use grouping::{Groups, PAIRS, group_by_shapes, group_by_surroundings};
pub use kinematics::{PairHistory, PairKinematics};
pub use local_system::PairSystem;
pub use nitsche_block::nitsche_block;
pub use pair::{Integral, Pair, PairKey, Previous, check_pairs};
pub use pair_request::PairRequest;

#[cfg(test)]
mod tests;
