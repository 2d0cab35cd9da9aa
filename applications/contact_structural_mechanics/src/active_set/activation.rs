//! Decides by their gap which slave nodes begin a step in contact; open nodes keep nothing.

use std::collections::BTreeSet;

use zelus_core::model::{ModelPart, Nodes, SlaveNodes};

use crate::interface::SlaveIndex;
use crate::law::SlipRule;
use crate::pairs::Multiplier;
use crate::slave_nodes::SlaveStates;
use crate::variables::NODAL_H;

/// Gap, in mesh sizes, of the simple activation.
const SIMPLE_REACH: f64 = 2e-3;
/// Motion of a body without restraint in an iteration of contact stabilisation, in mesh sizes.
const STABILIZATION: f64 = 0.25;
/// Gap, in mesh sizes, of a node that touches its master.
const TOUCHING: f64 = 1e-6;
/// Power of the distance from the edge of contact with which gaps grow.
const GROWTH_OF_GAP: f64 = 1.5;
/// Gap of a node that nothing faces.
const FAR: f64 = 1e12;

/// Sets the multipliers of inactive nodes among `of` to zero, and the tractions and pressures that are kept of them.
pub(crate) fn clear_inactive(
    slave_nodes: &mut SlaveNodes,
    states: &mut SlaveStates,
    multiplier: Multiplier,
    of: impl Iterator<Item = SlaveIndex>,
) {
    for slave in of {
        let owner = if multiplier.is_unknown() { states.owner(slave) } else { 0 };
        let state = &mut states[slave];
        if state.law.active {
            continue;
        }
        match multiplier {
            Multiplier::Body => {}
            Multiplier::None => state.law.history_traction = [0.0; 3],
            Multiplier::Scalar(_) => {
                multiplier.set(slave_nodes, owner, [0.0; 3]);
                state.law.uzawa_pressure = 0.0;
            }
            Multiplier::Vector(_) => multiplier.set(slave_nodes, owner, [0.0; 3]),
        }
    }
}

/// Criterion of contact at step start.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ActivationCriterion<'a> {
    /// A gap below this length.
    GapBelow(f64),
    /// Nodes in contact already, and nodes that the edge of contact will reach in a step of `ratio` times the length of the last one.
    /// Where `in_contact`, by place, does not hold for the bodies of a node, a gap below `range`. Gaps up to `least` are zero.
    Kept { range: f64, in_contact: &'a [bool], ratio: f64, least: f64 },
    /// A gap below a small share of the mesh size of the node.
    ShareOfMeshSize,
    /// These nodes, and those that are in contact already.
    Touching(&'a BTreeSet<SlaveIndex>),
}

/// Step start: which nodes are active. Gaps are weighted gaps over areas, so they are those of the mortar mapping.
pub(crate) fn start(nodes: &Nodes, states: &mut SlaveStates, start: ActivationCriterion<'_>, rule: SlipRule) {
    let sizes = nodes.values.values(&NODAL_H, 0);
    let mesh_nodes: Vec<u32> = states.all().map(|slave| states.mesh_node(slave)).collect();
    let bonded: Vec<bool> = states.all().map(|slave| states.holds(slave)).collect();
    states.for_each(|slave, state| {
        let gap = state.gap().unwrap_or(FAR);
        let near = bonded[slave.place()];
        let near = near
            || match start {
                ActivationCriterion::GapBelow(range) => gap < range,
                ActivationCriterion::Kept { in_contact, ratio, least, .. } if in_contact[slave.place()] => {
                    let before = state.kinematics.gap_at_start;
                    gap < FAR && (state.law.active || (before > least && is_reached(gap, before, ratio)))
                }
                ActivationCriterion::Kept { range, .. } => gap < range,
                ActivationCriterion::ShareOfMeshSize => gap < SIMPLE_REACH * sizes[mesh_nodes[slave.place()] as usize],
                ActivationCriterion::Touching(nodes) => nodes.contains(&slave) || state.law.active,
            };
        state.law.active = near && !state.kinematics.isolated;
        state.kinematics.gap_at_start = state.gap().unwrap_or_default();
        state.kinematics.start_gap = if near { gap } else { 0.0 };
        let size = sizes[mesh_nodes[slave.place()] as usize];
        state.law.joined |= state.law.active && gap <= TOUCHING * size;
        if state.law.active {
            let slides = rule == SlipRule::Pure || state.parameters.friction.is_smooth();
            state.law.slides = Some(slides || state.law.slides == Some(true));
        }
    });
}

/// Whether the edge of contact will reach a node in a step of `ratio` times the length of the last one, in which its gap went from `before`
/// to `gap`: the edge goes on as fast, and between smooth bodies the gap grows with its distance to the power of 3/2
/// (K. L. Johnson, Contact Mechanics, 1985, section 5.1).
fn is_reached(gap: f64, before: f64, ratio: f64) -> bool {
    gap < before * (ratio / (1.0 + ratio)).powf(GROWTH_OF_GAP)
}

/// The slave nodes, of these of each interface, of interfaces without contact that are at most `range` mesh sizes farther from a master than the nearest
/// of their interface, where those are not in contact yet. `open` keeps the interfaces that had none when it was empty.
pub(crate) fn nearest(
    nodes: &Nodes,
    states: &SlaveStates,
    slaves: &[Vec<SlaveIndex>],
    range: f64,
    open: &mut BTreeSet<usize>,
) -> BTreeSet<SlaveIndex> {
    let sizes = nodes.values.values(&NODAL_H, 0);
    if open.is_empty() {
        open.extend((0..slaves.len()).filter(|&at| !slaves[at].iter().any(|&n| states[n].law.active)));
    }
    let mut found = BTreeSet::new();
    for own in open.iter().map(|&at| &slaves[at]) {
        let facing = || own.iter().filter(|&&n| !states[n].kinematics.isolated);
        let gap = |n: SlaveIndex| states[n].kinematics.weighted_gap / states[n].kinematics.area;
        let least = facing().map(|&n| gap(n)).fold(f64::INFINITY, f64::min);
        found.extend(
            facing()
                .filter(|&&n| gap(n) - least <= range * sizes[states.mesh_node(n) as usize] && !states[n].law.active),
        );
    }
    found
}

/// Length of contact stabilisation: a quarter of the mean of NODAL_H over the slave nodes of all interfaces, zero without slave nodes;
/// collective.
pub(crate) fn stabilization_length(part: &ModelPart, states: &SlaveStates, slaves: &[Vec<SlaveIndex>]) -> f64 {
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let mut sums = [0.0; 2];
    let own =
        slaves.iter().flatten().map(|&slave| states.mesh_node(slave) as usize).filter(|&node| part.owns_node(node));
    own.for_each(|node| sums = [sums[0] + sizes[node], sums[1] + 1.0]);
    part.ranks.sum(&mut sums);
    if sums[1] > 0.0 { STABILIZATION * sums[0] / sums[1] } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::is_reached;

    /// ANALYTIC: gaps d^(3/2) beside an edge that moved from x = 0 to 1 in the last step, at x = 1 + d; exact but for rounding.
    #[test]
    fn nodes_that_a_steady_edge_reaches_begin_in_contact() {
        let gap = |d: f64| d.powf(1.5);
        for (d, ratio, reached) in [(0.99, 1.0, true), (1.01, 1.0, false), (0.49, 0.5, true), (0.51, 0.5, false)] {
            assert_eq!(is_reached(gap(d), gap(1.0 + d), ratio), reached, "{d} in {ratio} steps");
        }
        assert!(!is_reached(1.0, 0.0, 1.0), "a node that opens");
    }
}
