//! Prescribed directions of displacement at the nodes of contact surfaces.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};
use zelus_core::model::{ModelPart, NodeUnknown};
use zelus_core::vector3::{add, cross, dot, norm, scale, sub};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::facets::Interface;
use crate::law::SupportAxes;

/// Mask of the axes of a node's supports.
pub type Fixed = [bool; 3];

/// Part of a unit vector that is round-off.
const NO_PART: f64 = 1e-6;

/// Prescribed directions of a node's displacement, directly or by constraints on prescribed unknowns.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct FixedDirections {
    /// Axes; the global ones unless a support acts along another direction.
    pub axes: SupportAxes,
    /// Mask of the axes along which the node is prescribed.
    pub fixed: Fixed,
}

impl FixedDirections {
    /// Of prescribed components, and of unit vectors along which supports act besides.
    fn new(fixed: Fixed, directions: &[[f64; 3]]) -> Self {
        let unit = |c: usize| std::array::from_fn(|d| f64::from(u8::from(c == d)));
        let mut axes: Vec<[f64; 3]> = (0..3).filter(|&c| fixed[c]).map(unit).collect();
        let count = axes.len();
        for direction in directions {
            let rest = without(*direction, &axes);
            if norm(rest) > NO_PART && axes.len() < 3 {
                axes.push(scale(rest, norm(rest).recip()));
            }
        }
        let is_global = |axis: &[f64; 3]| axis.iter().filter(|part| part.abs() > NO_PART).count() == 1;
        if axes[count..].iter().all(is_global) {
            let along = |c: usize| axes.iter().any(|axis| axis[c].abs() > NO_PART);
            return Self { axes: SupportAxes::default(), fixed: std::array::from_fn(along) };
        }
        let count = axes.len();
        match count {
            1 => {
                // In the plane the second axis lies in it, since the first has no part along z.
                let least = (0..3).rev().min_by(|&a, &b| axes[0][a].abs().total_cmp(&axes[0][b].abs())).unwrap_or(2);
                let second = cross(unit(least), axes[0]);
                let second = scale(second, norm(second).recip());
                axes.extend([second, cross(axes[0], second)]);
            }
            2 => axes.push(cross(axes[0], axes[1])),
            _ => {}
        }
        Self { axes: SupportAxes([axes[0], axes[1], axes[2]]), fixed: std::array::from_fn(|c| c < count) }
    }

    /// Whether the node is prescribed along a unit vector.
    pub fn holds(&self, direction: [f64; 3]) -> bool {
        norm(self.free_part(direction)) <= NO_PART
    }

    /// The part of a vector along which the node is free.
    pub fn free_part(&self, vector: [f64; 3]) -> [f64; 3] {
        let own = self.axes.components(vector);
        self.axes.vector(std::array::from_fn(|c| if self.fixed[c] { 0.0 } else { own[c] }))
    }
}

/// The part of a vector at right angles to orthonormal axes.
fn without(vector: [f64; 3], axes: &[[f64; 3]]) -> [f64; 3] {
    let along = axes.iter().fold([0.0; 3], |sum, axis| add(sum, scale(*axis, dot(*axis, vector))));
    sub(vector, along)
}

/// Prescribed directions at the nodes of interfaces; free nodes are left out.
pub fn fixed_directions(part: &ModelPart, interfaces: &[Interface]) -> BTreeMap<u32, FixedDirections> {
    let constraints = part.constraints.iter().filter(|c| c.active).map(|c| (c.slave, &c.masters[..])).collect();
    let mut along: FxHashMap<u32, Vec<[f64; 3]>> = FxHashMap::default();
    for constraint in part.constraints.iter().filter(|own| own.slave.1.column == DISPLACEMENT.name()) {
        if let Some(support) = constraint.support.filter(|support| support.acts) {
            along.entry(constraint.slave.0).or_default().push(support.direction);
        }
    }
    let dimension = part.info.domain_size;
    let of_node = |&node: &u32| -> (u32, FixedDirections) {
        let fixed = std::array::from_fn(|c| {
            c < dimension && is_fixed(part, &constraints, (node, DISPLACEMENT.component(c as u8)), 0)
        });
        (node, FixedDirections::new(fixed, along.get(&node).map_or(&[], Vec::as_slice)))
    };
    interfaces.iter().flat_map(|i| &i.nodes).map(of_node).filter(|(_, own)| own.fixed.contains(&true)).collect()
}

/// Constraints by the unknown that they eliminate.
type Constraints<'a> = BTreeMap<NodeUnknown, &'a [(NodeUnknown, f64)]>;

fn is_fixed(part: &ModelPart, constraints: &Constraints<'_>, unknown: NodeUnknown, depth: usize) -> bool {
    let (node, variable) = unknown;
    match constraints.get(&unknown) {
        Some(masters) if depth <= constraints.len() => {
            masters.iter().all(|&(master, _)| is_fixed(part, constraints, master, depth + 1))
        }
        _ => part.nodes.is_fixed(variable, node),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_beside_components_span_axes() {
        let slope = [0.6, 0.8, 0.0];
        let roller = FixedDirections::new([false; 3], &[slope]);
        assert_eq!((roller.axes.0[0], roller.fixed), (slope, [true, false, false]));
        assert!(roller.holds(slope) && roller.holds([-0.6, -0.8, 0.0]));
        assert!(!roller.holds([1.0, 0.0, 0.0]));
        let free = roller.free_part([1.0, 0.0, 2.0]);
        assert!(norm(sub(free, [0.64, -0.48, 2.0])) < 1e-15, "{free:?}");
        // A slope and a wall clamp the node in the plane, along the global axes.
        let clamp = FixedDirections::new([true, false, false], &[slope]);
        assert_eq!(clamp, FixedDirections::new([true, true, false], &[]));
        // Two slopes in space leave their line.
        let edge = FixedDirections::new([false; 3], &[slope, [0.0, 0.6, 0.8]]);
        let line = cross(slope, [0.0, 0.6, 0.8]);
        assert!(norm(sub(edge.free_part(line), line)) < 1e-15);
        assert!(edge.holds([0.0, 0.6, 0.8]) && edge.fixed == [true, true, false]);
    }
}
