//! The form of a contact law: a function of one slave node, from its active inputs to its force and its multiplier rows.
//!
//! Every formulation is a first variation of an augmented functional, e.g. of
//! ∫ k λ g + ε/2 g² − 1/(2ε) ⟨k λ + ε g⟩² (eq. 4.9) evaluated node by node on the weighted gap g̃ of one pair. A slave
//! node j contributes a nodal force vector p_j; then b_slave += Dᵀp, b_master −= Mᵀp, and the multiplier rows state the
//! contact conditions. `b` is the right-hand side of K Δ = b, so K = −∂b/∂(unknowns).
//!
//! The functional is that of the pair; where forces are augmented by node ([`Augmentation`]), the term of the gap is left to
//! the decision of the active set, which knows the gap of the whole node.
//!
//! Notation in the files of the laws: k scale factor, ε nodal penalty (ε̂ is ε where pairs augment, 0 where nodes do),
//! A area that the pair has of the node, c stiffness by length, f dynamic factor, n nodal normal,
//! P = I − n⊗n, g̃ weighted gap of this pair, s weighted slip, κ tangent factor, b bound of the tangential traction, τ
//! unit tangent. All but D, M, g̃, s (and normals given with derivatives) are constant in the tangent.

mod augmentation;
pub mod bond;
mod cohesive_law;
pub mod constrained_multiplier;
mod contact_law;
mod friction_ellipse;
mod friction_law;
pub mod mesh_tying;
mod multiplier;
pub mod nitsche;
mod node_state;
mod overclosure_law;
pub mod rubbing;
pub mod rules;
mod slave_node;
mod step_parameters;

pub use augmentation::Augmentation;
pub use bond::{Bond, BondOpening, BondState, BondTangent, SurfaceLaw, SurfaceNumbers};
pub use cohesive_law::{CohesiveLaw, CohesiveLawEntry, MakeCohesiveLaw};
pub use contact_law::{ContactLaw, NodeForces, NodeInputs, NodeLaw, SlipMeasure};
pub use friction_ellipse::FrictionEllipse;
pub use friction_law::{Bound, FrictionLaw, FrictionLawEntry, Sliding, find_friction_law};
pub use mesh_tying::MeshTying;
pub use multiplier::Multiplier;
pub use nitsche::{Nitsche, NitscheVariant, NodeOfPoints, PointForces, SlaveFace};
pub use node_state::{DirectionRotation, MultiplierConstraint, MultiplierConstraints, NodeState, SupportAxes};
pub use overclosure_law::{MakeOverclosureLaw, Overclosure, OverclosureLaw, OverclosureLawEntry, SoftTangent};
pub use rubbing::Rubbing;
pub(crate) use rules::TURNED;
pub use rules::{BondNumbers, Decision, Margin, SlaveNumbers, SlipRule};
pub use slave_node::SlaveNode;
pub use step_parameters::{NormalVariation, StepParameters};
