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
//! Notation in the files of the families: k scale factor, ε nodal penalty, A area of the node, c
//! stiffness by length, f dynamic factor, n nodal normal,
//! P = I − n⊗n, g̃ weighted gap of this pair, s weighted slip, κ tangent factor, b bound of the tangential traction, τ
//! unit tangent. All but D, M, g̃, s (and normals given with derivatives) are constant in the tangent.

pub mod alm_frictional;
pub mod alm_frictionless;
pub mod alm_frictionless_components;
pub mod mesh_tying;
pub mod pair;
pub mod penalty_frictional;
pub mod penalty_frictionless;
pub mod perturbed_lagrangian_frictionless;
pub mod system;
pub mod uzawa_frictionless;

pub use alm_frictional::{AlmFrictional, SlipHistory};
pub use alm_frictionless::AlmFrictionless;
pub use alm_frictionless_components::AlmFrictionlessComponents;
pub use mesh_tying::MeshTying;
pub use pair::{Kinematics, NodeState, PairResidual, SlaveNode, Turning};
pub use penalty_frictional::PenaltyFrictional;
pub use penalty_frictionless::PenaltyFrictionless;
pub use perturbed_lagrangian_frictionless::PerturbedLagrangianFrictionless;
pub use system::{OperatorTangent, local_size, residual, tangent};
pub use uzawa_frictionless::UzawaFrictionless;

use zelus_core::scalar::Real;

/// Multiplier unknowns of a slave node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Multipliers {
    /// None: a penalty method.
    None,
    /// One, along the nodal normal; the first component of a nodal multiplier.
    Normal,
    /// One a space dimension.
    Vector,
}

impl Multipliers {
    /// Number a node in `dim` dimensions.
    pub const fn count(self, dim: usize) -> usize {
        match self {
            Self::None => 0,
            Self::Normal => 1,
            Self::Vector => dim,
        }
    }
}

/// A family of contact conditions, stated by its residual.
pub trait Formulation {
    /// Its multiplier unknowns.
    const MULTIPLIERS: Multipliers;

    /// What it remembers of a pair from the start of the step.
    type History<const NS: usize, const NM: usize>;

    /// Right-hand side of one pair; must be affine in the multipliers for given states.
    fn residual<T: Real, const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<T, NS, NM>,
        nodes: &[SlaveNode; NS],
        history: &Self::History<NS, NM>,
    ) -> PairResidual<T, NS, NM>;
}

#[cfg(test)]
mod tests;
