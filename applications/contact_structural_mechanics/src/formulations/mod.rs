//! The contact functionals: what a pair adds to the residual, stated once per family, and its exact tangent.
//!
//! Every family is a first variation of an augmented functional, e.g. of
//! ∫ k λ g + ε/2 g² − 1/(2ε) ⟨k λ + ε g⟩² (eq. 4.9) evaluated node by node on the weighted gap g̃ of one pair. A slave
//! node j contributes a nodal force vector p_j; then b_slave += Dᵀp, b_master −= Mᵀp, and the multiplier rows state the
//! contact conditions. `b` is the right-hand side of K Δ = b, so K = −∂b/∂(unknowns).
//!
//! Order of local unknowns: displacements of master nodes, displacements of slave nodes, multipliers of slave nodes;
//! node by node, each with its components.
//!
//! The functional is that of the pair; where forces are augmented by node ([`Augmentation`]), the term of the gap is left to
//! the decision of the active set, which knows the gap of the whole node.
//!
//! Notation in the files of the families: k scale factor, ε nodal penalty (ε̂ is ε where pairs augment, 0 where nodes do),
//! A area that the pair has of the node, c stiffness by length, f dynamic factor, n nodal normal,
//! P = I − n⊗n, g̃ weighted gap of this pair, s weighted slip, κ tangent factor, b bound of the tangential traction, τ
//! unit tangent. All but D, M, g̃, s (and normals given with derivatives) are constant in the tangent.

pub mod held;
pub mod last_state;
pub mod mesh_tying;
pub mod multiplier;
pub mod nitsche;
pub mod pair;
pub mod pair_history;
pub(crate) mod step_parameters;
pub mod system;

pub use crate::node_state::{Held, NodeState, Turning};
pub use last_state::LastState;
pub use mesh_tying::MeshTying;
pub use multiplier::Multiplier;
pub use nitsche::{Nitsche, NitscheVariant, NodeOfPoints, PointForces, SlaveFace};
pub use pair::{Kinematics, PairResidual, SlaveNode};
pub use pair_history::PairHistory;
pub use step_parameters::{NormalVariation, StepParameters};
pub use system::{by_normals, local_size, residual, tangent};

use zelus_core::geometry::FacetShape;
use zelus_core::scalar::Real;

/// Where a gap augments the force of an augmented Lagrangian.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Augmentation {
    /// In the decision of the active set only, with the gap of the whole node. In contact that gap is zero, so it adds
    /// nothing to the force: penalties have no part in the converged state.
    #[default]
    Node,
    /// In the force too, pair by pair as in the reference program. The gaps of the pairs of a node add up to zero, but each
    /// acts through operators of its own: a little of the penalty stays in the converged state.
    Pair,
}

impl Augmentation {
    /// The penalty with which the gap of a pair enters the force of a node.
    #[inline]
    pub fn penalty(self, node: &SlaveNode) -> f64 {
        match self {
            Self::Node => 0.0,
            Self::Pair => node.penalty,
        }
    }

    /// A/c with which multipliers are driven to zero; the reference program's 1/ε where pairs augment.
    #[inline]
    pub fn softness(self, node: &SlaveNode) -> f64 {
        match self {
            Self::Node => node.area / node.stiffness,
            Self::Pair => node.penalty.recip(),
        }
    }
}

/// The forces of a family of contact, stated by the residual of a pair.
///
/// A family is one file: its formulation, its [`Family`](crate::pairs::Family) and
/// [`register_contact_family!`](crate::register_contact_family).
pub trait Formulation: Copy + Send + Sync + 'static {
    /// Its multipliers.
    const MULTIPLIER: Multiplier;

    /// What it remembers of a pair from the start of the step.
    type History<S: FacetShape, M: FacetShape>: PairHistory<S, M>;

    /// The formulation with the numbers of the step.
    fn new(parameters: &StepParameters) -> Self;

    /// Right-hand side of one pair; must be affine in the multipliers for given states.
    fn residual<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<T, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        history: &Self::History<S, M>,
    ) -> PairResidual<T, S, M>;

    /// Weighted slip vectors of a pair; zero without friction.
    fn weighted_slip<S: FacetShape, M: FacetShape>(
        &self,
        _pair: &Kinematics<f64, S, M>,
        _history: &Self::History<S, M>,
    ) -> S::Nodal<[f64; 3]> {
        S::nodal(|_| [0.0; 3])
    }

    /// Areas times trial tractions of a pair, for families that carry tractions from state to state.
    fn weighted_trial<S: FacetShape, M: FacetShape>(
        &self,
        _pair: &Kinematics<f64, S, M>,
        _nodes: &S::Nodal<SlaveNode>,
        _history: &Self::History<S, M>,
    ) -> Option<S::Nodal<[f64; 3]>> {
        None
    }
}

#[cfg(test)]
mod tests;
