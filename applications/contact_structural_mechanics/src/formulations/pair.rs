//! What a formulation sees of a pair, and what it returns.

use crate::friction_law::Bound;
use crate::mortar::{Operators, PairGeometry, weighted_gap};
use crate::node_state::{Held, NodeState, Turning};
use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::Real;
use zelus_core::vector3::constant;

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
pub struct Kinematics<T: Real, S: FacetShape, M: FacetShape> {
    /// D and M.
    pub operators: Operators<T, S, M>,
    /// Current positions of the slave nodes.
    pub slave: S::Nodal<[T; 3]>,
    /// Current positions of the master nodes.
    pub master: M::Nodal<[T; 3]>,
    /// Unit normals at the slave nodes, out of the slave body.
    pub normals: S::Nodal<[T; 3]>,
    /// Multipliers of the slave nodes, compression negative; a scalar one in the first component.
    pub multipliers: S::Nodal<[T; 3]>,
}

impl<T: Real, S: FacetShape, M: FacetShape> Kinematics<T, S, M> {
    /// Of a pair that stands like this, with these operators; multipliers are constants.
    pub fn new(
        geometry: &PairGeometry<T, S, M>,
        operators: Operators<T, S, M>,
        multipliers: &S::Nodal<[f64; 3]>,
    ) -> Self {
        let PairGeometry { slave, master, nodal_normals: normals, .. } = *geometry;
        Self { operators, slave, master, normals, multipliers: S::map(multipliers, constant) }
    }

    /// Weighted gaps g̃ of this pair alone.
    #[inline]
    pub fn gap(&self) -> S::Nodal<T> {
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
pub struct PairResidual<T: Real, S: FacetShape, M: FacetShape> {
    /// Forces on master nodes.
    pub master: M::Nodal<[T; 3]>,
    /// Forces on slave nodes.
    pub slave: S::Nodal<[T; 3]>,
    /// Multiplier rows; a scalar one in the first component.
    pub multipliers: S::Nodal<[T; 3]>,
}

impl<T: Real, S: FacetShape, M: FacetShape> PairResidual<T, S, M> {
    /// Nothing yet.
    #[inline]
    pub fn zero() -> Self {
        let zero = [T::zero(); 3];
        Self { master: M::nodal(|_| zero), slave: S::nodal(|_| zero), multipliers: S::nodal(|_| zero) }
    }

    /// Spreads the force vector p of slave node `j` over both sides: b_slave += D_jk p, b_master −= M_jl p.
    #[inline]
    pub fn add_nodal_force(&mut self, operators: &Operators<T, S, M>, j: usize, p: [T; 3]) {
        for k in 0..S::NODES {
            // Off the diagonal a zero is exact: dual functions.
            if k == j || operators.d[j][k].value() != 0.0 {
                (0..3).for_each(|c| self.slave[k][c].add_product(operators.d[j][k], p[c]));
            }
        }
        for l in 0..M::NODES {
            (0..3).for_each(|c| self.master[l][c].add_product(-operators.m[j][l], p[c]));
        }
    }
}
