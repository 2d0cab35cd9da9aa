//! What a formulation sees of a pair, and what it returns.

use crate::friction_law::Bound;
use crate::mortar::{Operators, weighted_gap};
use crate::node_state::{Held, NodeState, Turning};
use zelus_core::scalar::Real;

/// Constants of a slave node during an assembly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlaveNode {
    /// Decided by the active-set stage, never here.
    pub state: NodeState,
    /// Penalty ε > 0.
    pub penalty: f64,
    /// 1/ε of families whose surfaces give way, penetration by pressure; 0 of all others.
    pub compliance: f64,
    /// Pressure p° under which surfaces that give way do not: that which an outer loop keeps, compression negative; 0 without one.
    pub kept: f64,
    /// c > 0: stiffness by length, for rows that state tractions beside others that state gaps and slips.
    pub stiffness: f64,
    /// A > 0: the area that this pair has of the node, or all pairs where they augment; constant in the tangent.
    pub area: f64,
    /// Factor f on nodal forces, 1 unless the dynamic factor is in use.
    pub dynamic_factor: f64,
    /// Limit of the tangential traction.
    pub friction: Bound,
    /// Unit tangent τ: the direction of sliding.
    pub tangent: [f64; 3],
    /// How that direction turns with the unknowns.
    pub turning: Turning,
    /// What becomes of each component of its multiplier; of a scalar one the first.
    pub held: [Held; 3],
    /// k² A/c: what the equations of held components are measured with.
    pub held_weight: f64,
    /// Tangential traction t° of the last accepted state, where a family carries it (force per area).
    pub carried: [f64; 3],
    /// Traction of all pairs of the node, where a family has it before its pairs are looked at (force per area).
    pub traction: [f64; 3],
}

/// Operators, positions, normals and multipliers of a pair in one scalar.
#[derive(Debug, Clone, Copy)]
pub struct Kinematics<T, const NS: usize, const NM: usize> {
    /// D and M.
    pub operators: Operators<T, NS, NM>,
    /// Current positions of the slave nodes.
    pub slave: [[T; 3]; NS],
    /// Current positions of the master nodes.
    pub master: [[T; 3]; NM],
    /// Unit normals at the slave nodes, out of the slave body.
    pub normals: [[T; 3]; NS],
    /// Multipliers of the slave nodes, compression negative; a scalar one in the first component.
    pub multipliers: [[T; 3]; NS],
}

impl<T: Real, const NS: usize, const NM: usize> Kinematics<T, NS, NM> {
    /// Weighted gaps g̃ of this pair alone.
    #[inline]
    pub fn gap(&self) -> [T; NS] {
        weighted_gap(&self.operators, &self.slave, &self.master, &self.normals)
    }

    /// The area that this pair has of slave node `j`.
    #[inline]
    pub fn area(&self, j: usize) -> T {
        self.operators.d[j].iter().fold(T::zero(), |sum, d| sum + *d)
    }
}

/// Right-hand side of a pair, by node.
#[derive(Debug, Clone, Copy)]
pub struct PairResidual<T, const NS: usize, const NM: usize> {
    /// Forces on master nodes.
    pub master: [[T; 3]; NM],
    /// Forces on slave nodes.
    pub slave: [[T; 3]; NS],
    /// Multiplier rows; a scalar one in the first component.
    pub multipliers: [[T; 3]; NS],
}

impl<T: Real, const NS: usize, const NM: usize> PairResidual<T, NS, NM> {
    /// Nothing yet.
    #[inline]
    pub fn zero() -> Self {
        let zero = [T::zero(); 3];
        Self { master: [zero; NM], slave: [zero; NS], multipliers: [zero; NS] }
    }

    /// Spreads the force vector p of slave node `j` over both sides: b_slave += D_jk p, b_master −= M_jl p.
    #[inline]
    pub fn add_nodal_force(&mut self, operators: &Operators<T, NS, NM>, j: usize, p: [T; 3]) {
        for k in 0..NS {
            // Off the diagonal a zero is exact: dual functions.
            if k == j || operators.d[j][k].value() != 0.0 {
                (0..3).for_each(|c| self.slave[k][c].add_product(operators.d[j][k], p[c]));
            }
        }
        for l in 0..NM {
            (0..3).for_each(|c| self.master[l][c].add_product(-operators.m[j][l], p[c]));
        }
    }
}
