//! Mortar integration of one contact pair: from two facets to the operators D, M and the weighted gap.
//!
//! The pipeline, in the order of the modules:
//! 1. [`geometry`]: nodes and normals of the pair, as plain numbers or as dual numbers seeded with its displacements;
//! 2. [`settings`]: distance threshold, tolerance, Gauss rule, axisymmetry;
//! 3. `segmentation_2d`, `segmentation_3d`: the exact overlap. In the plane an interval of the slave; in space the
//!    intersection of both facets flattened along the slave's normal, cut into a fan of triangles and put back on the
//!    true slave surface;
//! 4. `first_order`: Gauss points on each cell; each goes to the master along the interpolated nodal normal
//!    n = Σ N¹_j n_j, x² = x¹ + n ((x²₀ − x¹)·n_m)/(n·n_m), and gets its local coordinates there;
//! 5. [`operators`](mod@operators): dual shape functions Φ = De Me⁻¹ N¹ of this pair alone, D = ∫ Φ⊗N¹ (diagonal), M = ∫ Φ⊗N²;
//! 6. [`gap`]: g̃_j = −n_j·(D x¹ − M x²)_j, negative in penetration;
//! 7. [`slip`]: the tangential counterpart, from the change of the operators or from displacement increments;
//! 8. [`rotation`]: the rotation of a facet since the last accepted state.
//!
//! Facets of second order have points of their own: `curved`. [`for_each_point`] and [`find_operators()`] serve all shapes.
//!
//! All of it is continuous in the positions but for a few choices, which a pair can keep: [mod@choices].
//!
//! With normals that belong to the present geometry, D, M and g̃ agree with the reference program to 1e-10 (its inverse
//! maps stop there). Four deliberate differences: slivers may count; a lagging slave normal tilts the direction of projection but does
//! not shrink the facet; a quadrilateral master inside a triangular slave is cut into (0,1,2), (0,2,3), which covers it
//! once; local coordinates on a warped slave are always those of the flattened one.
//!
//! Slave (upper index 1) is the side that carries multipliers, master (2) the other. Decisions (which vertices the
//! overlap has, where iterations end) are made on values; derivatives then come from one corrected evaluation at the
//! solution, so that dual numbers cost a small multiple of the plain kernel and are exact.

pub mod choices;
pub mod geometry;
pub mod settings;
mod overlap_point;
mod segmentation_2d;
mod segmentation_3d;
mod first_order;
pub mod operators;
mod curved;
mod each_point;
mod find_operators;
pub mod gap;
mod inner;
pub(crate) mod shapes;
pub mod rotation;
pub mod slip;

pub use choices::Choices;
pub use curved::{PairPoints, nodal_shares};
pub use each_point::for_each_point;
pub use find_operators::{choices_of, find_operators, find_operators_by_normals, operators};
pub use first_order::{EXACT_MOTION, MasterMotion};
pub use gap::{weighted_gap, weighted_jump};
pub use geometry::{Active, LANES, PairGeometry, variables_from};
pub use inner::{inner_point, inner_values};
pub use operators::{Operators, Overlap};
pub use overlap_point::OverlapPoint;
pub use rotation::FacetRotation;
pub use settings::{IntegrationOrder, SegmentationSettings};
pub use shapes::{MOST_NODES, carries_contact, condition_name};
pub use slip::{OperatorThreshold, incremental_slip, is_objective, objective_slip, rotated_slip, tangent, tangential};

#[cfg(test)]
mod degenerate;
#[cfg(test)]
pub(crate) mod tests;
