//! Tangent of a coupling whose forces rotate: minus the change of Tᵀ r with T, δω'ᵀ L δω.
//!
//! δω = Σ b_j δu_j is the rotation by the unknowns, and δω' = Σ a_i δu_i that of their equations. Forces f_i on arms ρ_i that rotate have
//! the moment Σ ρ_i × f_i, which changes by Σ (δω × ρ_i) × f_i: L = ± Σ (ρ_i·f_i) I − ρ_i f_iᵀ.

use std::ops::Range;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, Request, StepView, Tangent};
use zelus_core::model::EntityKind;
use zelus_core::vector3::dot;

/// A square matrix in space, row by row.
pub(super) type Matrix = [[f64; 3]; 3];

/// (ρ·f) I − ρ fᵀ.
pub(super) fn of_arm(arm: [f64; 3], force: [f64; 3]) -> Matrix {
    let along = dot(arm, force);
    std::array::from_fn(|r| std::array::from_fn(|c| if r == c { along } else { 0.0 } - arm[r] * force[c]))
}

/// A plus `factor` times B.
pub(super) fn add_scaled(a: Matrix, b: Matrix, factor: f64) -> Matrix {
    std::array::from_fn(|r| std::array::from_fn(|c| a[r][c] + factor * b[r][c]))
}

/// L with the rotations of equations and unknowns.
#[derive(Default)]
pub(super) struct RotationTangent {
    pub l: Matrix,
    /// a_i and b_i, one an unknown.
    pub ways: Vec<[[f64; 3]; 2]>,
}

/// Its block: one entity without forces.
pub(super) struct RotationStiffness {
    entry: &'static EntityKind,
    nodes: Vec<u32>,
    unknowns: Vec<LocalUnknown>,
    pub tangent: RotationTangent,
}

impl RotationStiffness {
    /// The block of these unknowns of some nodes, zero at first.
    pub fn new(entry: &'static EntityKind, nodes: Vec<u32>, unknowns: Vec<LocalUnknown>) -> Self {
        Self { entry, nodes, unknowns, tangent: RotationTangent::default() }
    }
}

impl EntityBlock for RotationStiffness {
    fn entry(&self) -> &'static EntityKind {
        self.entry
    }

    fn members(&self) -> &[u32] {
        &[]
    }

    fn len(&self) -> usize {
        1
    }

    fn nodes(&self, _at: usize) -> &[u32] {
        &self.nodes
    }

    fn unknowns(&self) -> &[LocalUnknown] {
        &self.unknowns
    }

    fn tangent(&self) -> Tangent {
        Tangent::Unsymmetric
    }

    fn is_active(&self, _at: usize, _view: &StepView<'_>) -> bool {
        true
    }

    fn local_systems(
        &self,
        _view: &StepView<'_>,
        range: Range<usize>,
        _request: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        let RotationTangent { l, ways } = &self.tangent;
        for slot in 0..range.len() {
            let (lhs, _) = out.entity(slot);
            let entries = ways.iter().flat_map(|[row, _]| {
                let row: [f64; 3] = std::array::from_fn(|c| (0..3).map(|r| row[r] * l[r][c]).sum());
                ways.iter().map(move |[_, column]| dot(row, *column))
            });
            lhs.iter_mut().zip(entries).for_each(|(to, entry)| *to = entry);
        }
        Ok(())
    }
}
