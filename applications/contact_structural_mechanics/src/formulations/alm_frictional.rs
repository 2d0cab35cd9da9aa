//! Friction by the augmented Lagrangian with a vector multiplier.
//!
//! - inactive: p = 0, b_λ = −k² (A/c) [(λ·n) n + P λ/κ];
//! - slip: p = f (k λ + ε g̃ n), b_λ = k g̃ n − k² (A/c) (P λ − P q/k) with q = b(k λ·n + ε g̃) τ, b the bound of the law
//!   of friction;
//! - stick: p = f (k λ + ε g̃ n + κ ε s), b_λ = k g̃ n + k s.
//!
//! In space the direction τ of sliding turns with the trial traction, which the tangent knows.
//! The slip s is the objective one when both operators changed by more than a threshold since the start of the step,
//! otherwise −P [D δ¹ − M δ²] with δ = x − x_reference.

use super::{Formulation, Kinematics, Multipliers, NodeState, PairResidual, SlaveNode, Turning};
use crate::mortar::{Operators, incremental_slip, is_objective, objective_slip, tangential};
use zelus_core::scalar::Real;
use zelus_core::vector3::dot;

/// Augmented Lagrangian with friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlmFrictional {
    /// Scale factor k of the multipliers: traction = k λ.
    pub scale_factor: f64,
    /// Ratio κ of tangential to normal penalty.
    pub tangent_factor: f64,
    /// Change of D and of M (Frobenius norm) beyond which the slip is taken as objective.
    pub operator_threshold: f64,
}

/// A pair as it was when slip began to be counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipHistory<const NS: usize, const NM: usize> {
    /// D° and M°, at the start of the step.
    pub previous: Operators<f64, NS, NM>,
    /// Slave positions from which increments count.
    pub reference_slave: [[f64; 3]; NS],
    /// Master positions from which increments count.
    pub reference_master: [[f64; 3]; NM],
}

impl AlmFrictional {
    /// Weighted slip vectors s of a pair.
    pub fn slip<T: Real, const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<T, NS, NM>,
        history: &SlipHistory<NS, NM>,
    ) -> [[T; 3]; NS] {
        if is_objective(&pair.operators, &history.previous, self.operator_threshold) {
            return objective_slip(&pair.operators, &history.previous, &pair.slave, &pair.master, &pair.normals);
        }
        let increment = |x: [T; 3], from: [f64; 3]| std::array::from_fn(|c| x[c] - from[c]);
        let delta_slave = std::array::from_fn(|j| increment(pair.slave[j], history.reference_slave[j]));
        let delta_master = std::array::from_fn(|l| increment(pair.master[l], history.reference_master[l]));
        incremental_slip(&pair.operators, &delta_slave, &delta_master, &pair.normals)
    }
}

/// What the turning of the direction of sliding adds to the traction of a pair: nothing but a derivative, for the direction
/// itself is that of the present state.
fn turned<T: Real>(node: &SlaveNode, lambda_t: [T; 3], slip: [T; 3], bound: f64) -> [T; 3] {
    let Turning { by_slip, by_multiplier } = node.turning;
    if by_slip == 0.0 {
        return [T::zero(); 3];
    }
    let change: [T; 3] = std::array::from_fn(|c| {
        (slip[c] - slip[c].value()) * by_slip + (lambda_t[c] - lambda_t[c].value()) * (by_multiplier * bound)
    });
    let along = change[0] * node.tangent[0] + change[1] * node.tangent[1] + change[2] * node.tangent[2];
    std::array::from_fn(|c| change[c] - along * node.tangent[c])
}

impl Formulation for AlmFrictional {
    const MULTIPLIERS: Multipliers = Multipliers::Vector;
    type History<const NS: usize, const NM: usize> = SlipHistory<NS, NM>;

    fn residual<T: Real, const NS: usize, const NM: usize>(
        &self,
        pair: &Kinematics<T, NS, NM>,
        nodes: &[SlaveNode; NS],
        history: &SlipHistory<NS, NM>,
    ) -> PairResidual<T, NS, NM> {
        let k = self.scale_factor;
        let gap = pair.gap();
        let slip = self.slip(pair, history);
        let mut out = PairResidual::zero();
        for (j, node) in nodes.iter().enumerate() {
            let (lambda, n, penalty) = (pair.multipliers[j], pair.normals[j], node.penalty);
            let lambda_n = dot(lambda, n);
            let lambda_t = tangential(lambda, n);
            let augmentation = gap[j] * penalty;
            let held = match node.state {
                NodeState::Inactive => {
                    let normal = -k * k * node.softness;
                    let tangent = normal / self.tangent_factor;
                    out.multipliers[j] = std::array::from_fn(|c| n[c] * lambda_n * normal + lambda_t[c] * tangent);
                    continue;
                }
                NodeState::Slip => {
                    let bound = node.friction.at(lambda_n * k + augmentation);
                    let turning = turned(node, lambda_t, slip[j], bound.value());
                    let q = tangential(std::array::from_fn(|c| bound * node.tangent[c] + turning[c]), n);
                    out.multipliers[j] =
                        std::array::from_fn(|c| n[c] * gap[j] * k - (lambda_t[c] * k - q[c]) * (k * node.softness));
                    0.0
                }
                NodeState::Stick => {
                    out.multipliers[j] = std::array::from_fn(|c| (n[c] * gap[j] + slip[j][c]) * k);
                    self.tangent_factor * penalty
                }
            };
            let force = std::array::from_fn(|c| {
                (lambda[c] * k + n[c] * augmentation + slip[j][c] * held) * node.dynamic_factor
            });
            out.add_nodal_force(&pair.operators, j, force);
        }
        out
    }
}
