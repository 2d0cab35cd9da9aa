//! Friction of nodes that slide on constraints: a force t on the slave node and −w t on its masters.
//!
//! Its direction d is that of the trial force, which the slip s in the step turns against the motion: t = b d with
//! d = (t₀ − c s)/|t₀ − c s| in the tangent, t₀ being that of the last iterate. The part of the bound b that grows with the
//! pressure goes with the force of the constraint ([`node_relation`](super::node_relation)); here are, as blocks, the part
//! that does not, and the derivative of the direction, −∂t/∂s = κ (1 − d⊗d − n⊗n) with κ = b c/|t₀ − c s|.

use std::collections::BTreeMap;
use std::ops::Range;
use zelus_core::model::EntityKind;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, Request, StepView, Tangent};

use zelus_core::vector3::{norm, scale};
use zelus_structural_mechanics::variables::DISPLACEMENT;

/// A sliding node with its masters.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Slider {
    /// Slave node.
    pub node: u32,
    /// Masters with their weights.
    pub masters: Vec<(u32, f64)>,
    /// Unit direction d of the friction on it; zero where none is known.
    pub direction: [f64; 3],
    normal: [f64; 3],
    /// The part of the friction that does not go with the pressure.
    force: [f64; 3],
    /// κ, how fast the force turns with the slip (force by length).
    rotation: f64,
}

impl Slider {
    /// A node under the trial force t₀ − c s and the bound b, of which `constant` does not go with the pressure; `stiffness`
    /// is c. Without a trial force there is no friction.
    pub(crate) fn new(
        node: u32,
        masters: Vec<(u32, f64)>,
        normal: [f64; 3],
        trial: [f64; 3],
        [bound, constant]: [f64; 2],
        stiffness: f64,
    ) -> Self {
        let size = norm(trial);
        let [direction, rotation] = if size > 0.0 { [1.0 / size, bound * stiffness / size] } else { [0.0; 2] };
        let direction = scale(trial, direction);
        Self { node, masters, direction, normal, force: scale(direction, constant), rotation }
    }
}

/// All sliders with the same number of masters.
pub(crate) struct SliderForces {
    entry: &'static EntityKind,
    /// Masters, then the slave, of each slider.
    nodes: Vec<u32>,
    width: usize,
    dimension: usize,
    unknowns: Vec<LocalUnknown>,
    sliders: Vec<Slider>,
}

impl SliderForces {
    /// Blocks of `sliders`, by their number of masters.
    pub(crate) fn blocks(entry: &'static EntityKind, sliders: Vec<Slider>, dimension: usize) -> Vec<Self> {
        let mut by_width: BTreeMap<usize, Vec<Slider>> = BTreeMap::new();
        sliders.into_iter().for_each(|slider| by_width.entry(slider.masters.len() + 1).or_default().push(slider));
        by_width
            .into_iter()
            .map(|(width, sliders)| {
                let masters = |slider: &Slider| slider.masters.iter().map(|m| m.0).collect::<Vec<_>>();
                // The slave comes last: by it ranks know whose the slider is.
                let nodes = sliders.iter().flat_map(|slider| [masters(slider), vec![slider.node]].concat()).collect();
                let unknown = |at: usize| {
                    LocalUnknown::of_node((at / dimension) as u8, DISPLACEMENT.component((at % dimension) as u8))
                };
                let unknowns = (0..width * dimension).map(unknown).collect();
                Self { entry, nodes, width, dimension, unknowns, sliders }
            })
            .collect()
    }

    /// The slave nodes with the friction on them that does not go with the pressure (force).
    pub(crate) fn forces(&self) -> impl Iterator<Item = (u32, [f64; 3])> + '_ {
        self.sliders.iter().map(|slider| (slider.node, slider.force))
    }

    /// The nodes whose unknowns the blocks join.
    pub(crate) fn all_nodes(&self) -> &[u32] {
        &self.nodes
    }
}

impl EntityBlock for SliderForces {
    fn entry(&self) -> &'static EntityKind {
        self.entry
    }

    fn members(&self) -> &[u32] {
        &[]
    }

    fn len(&self) -> usize {
        self.sliders.len()
    }

    fn nodes(&self, at: usize) -> &[u32] {
        &self.nodes[at * self.width..(at + 1) * self.width]
    }

    fn unknowns(&self) -> &[LocalUnknown] {
        &self.unknowns
    }

    fn tangent(&self) -> Tangent {
        Tangent::Symmetric
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
        let dimension = self.dimension;
        for (slot, at) in range.enumerate() {
            let Slider { masters, force, normal, direction, rotation, .. } = &self.sliders[at];
            let share = |node: usize| masters.get(node).map_or(1.0, |m| -m.1);
            let (lhs, rhs) = out.entity(slot);
            for (row, r) in rhs.iter_mut().enumerate() {
                *r = share(row / dimension) * force[row % dimension];
            }
            let size = rhs.len();
            for (place, k) in lhs.iter_mut().enumerate() {
                let (row, column) = (place / size, place % size);
                let (i, j) = (row % dimension, column % dimension);
                let across = f64::from(u8::from(i == j)) - direction[i] * direction[j] - normal[i] * normal[j];
                *k = rotation * share(row / dimension) * share(column / dimension) * across;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::entities::require_kind;
    use zelus_core::model::EntityRole;
    use zelus_core::vector3::{add, dot, sub};

    const MASTERS: [(u32, f64); 2] = [(4, 0.7), (5, 0.3)];

    /// A slider whose node and masters have moved by `u`, masters first.
    fn slider(u: &[[f64; 3]; 3]) -> Slider {
        let normal = scale([1.0, 2.0, 2.0], 1.0 / 3.0);
        let slip = sub(u[2], add(scale(u[0], MASTERS[0].1), scale(u[1], MASTERS[1].1)));
        let slip = sub(slip, scale(normal, dot(slip, normal)));
        let trial = sub([2.0, -1.0, 0.0], scale(slip, 50.0));
        Slider::new(9, MASTERS.to_vec(), normal, trial, [3.0; 2], 50.0)
    }

    fn system(u: &[[f64; 3]; 3]) -> LocalSystems {
        let entry = require_kind(EntityRole::Condition, "MPCMortarContactCondition3D3N").expect("a registered name");
        let block = &SliderForces::blocks(entry, vec![slider(u)], 3)[0];
        assert_eq!((block.nodes(0), block.unknowns().len()), (&[4, 5, 9][..], 9));
        let mut out = LocalSystems::default();
        out.reset(1, 9, Request::Both);
        let part = zelus_core::model::ModelPart::new("Structure");
        block.local_systems(&part.view(), 0..1, Request::Both, &mut out).expect("a system");
        out
    }

    #[test]
    fn tangents_match_differences_and_forces_balance() {
        let u = [[0.01, 0.02, -0.01], [0.0, -0.02, 0.03], [0.03, -0.01, 0.02]];
        let at = system(&u);
        for column in 0..9 {
            let moved = |by: f64| {
                let mut u = u;
                u[column / 3][column % 3] += by;
                system(&u).rhs
            };
            let (up, down) = (moved(1e-6), moved(-1e-6));
            for row in 0..9 {
                let difference = (down[row] - up[row]) / 2e-6;
                assert!((difference - at.lhs[row * 9 + column]).abs() < 1e-7, "{row} {column}: {difference}");
            }
        }
        let sum = (0..3).map(|c| (0..3).map(|node| at.rhs[3 * node + c]).sum::<f64>().abs()).fold(0.0, f64::max);
        assert!(sum < 1e-14 && (norm(slider(&u).direction) - 1.0).abs() < 1e-14);
        let still = Slider::new(9, MASTERS.to_vec(), [0.0, 0.0, 1.0], [0.0; 3], [3.0; 2], 50.0);
        assert_eq!((still.force, still.direction), ([0.0; 3], [0.0; 3]));
    }
}
