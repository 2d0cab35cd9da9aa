//! Facets that have come to face each other within a step although the search at its start left them out.

use std::collections::BTreeSet;
use std::sync::Arc;

use zelus_core::Result;
use zelus_core::model::ModelPart;
use zelus_core::parallel;

use crate::interface::SlaveIndex;
use crate::pairing::{Pairing, integrals, searching, without_tangent};
use crate::pairs::{PAIRS, Pair, PairKey};
use crate::search::have_crossed;
use crate::settings::Setup;
use crate::slave_nodes::{SlaveStates, SlaveSums, Summands};
use crate::tolerances::Tolerances;
use crate::variables::NODAL_H;

/// Share of a node's area that a pair must integrate to be missed, and of a mesh size (its square in space, its way about the
/// axis of revolution) that it must face to be in a master. Less than that is a sliver at the edge of a surface.
const LEAST_SHARE: f64 = 0.01;

/// Thresholds of a search within a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SearchThresholds {
    /// Depth beyond which a node without contact is in a master (length).
    pub depth: f64,
    /// Share of its mesh size that such a node must face.
    pub facing: f64,
    /// Share of its area that a pair must integrate to be missed at a node in contact.
    pub share: f64,
}

impl SearchThresholds {
    /// Every pair that changes the contact of a node.
    pub(crate) fn facing(tolerances: Tolerances) -> Self {
        Self { depth: tolerances.length, facing: LEAST_SHARE, share: LEAST_SHARE }
    }

    /// Pairs of nodes that have come through a master by more than `depth`; all pairs once some have been found.
    pub(crate) fn lost(depth: f64, all: bool) -> Self {
        Self { depth, facing: 0.0, share: if all { 0.0 } else { f64::INFINITY } }
    }
}

/// Result of a search within a step.
#[derive(Default)]
pub(crate) struct FoundPairs {
    /// Nodes that are not in contact though, with the pairs found, they are in a master.
    pub nodes: Vec<u32>,
    /// Pairs of these nodes, and pairs of nodes in contact that integrate a part of their area.
    pub missed: Vec<Pair>,
}

/// Weighted gap and area that pairs found within the step add to a slave node.
#[derive(Clone, Copy, Default)]
struct FoundOverlap {
    gap: f64,
    area: f64,
}

impl Summands<2> for FoundOverlap {
    fn numbers(&self) -> [f64; 2] {
        [self.gap, self.area]
    }

    fn of([gap, area]: [f64; 2]) -> Self {
        Self { gap, area }
    }
}

/// Facets that face each other now without being a pair, where that matters: at nodes in contact, and at nodes that they show to
/// be in a master.
///
/// They are those that a search would find now and, however deep, those that crossed in the step. The states
/// must be integrated in the present configuration.
///
/// # Errors
/// Errors of making blocks.
pub(crate) fn missed_pairs(
    part: &ModelPart,
    (pairing, states): (&Pairing, &SlaveStates),
    setup: &Setup,
    wanted: SearchThresholds,
) -> Result<FoundPairs> {
    let Setup { settings, parameters, .. } = setup;
    let known: BTreeSet<_> = pairing.keys().into_iter().collect();
    let near = pairing.candidates(part, settings).into_iter();
    let near = near.filter_map(|(key, within_reach)| (within_reach && !known.contains(&key)).then_some(key));
    let near: Vec<PairKey> = near.collect();
    let pairs_of = |keys: &[PairKey]| -> (Vec<Pair>, Vec<Pair>) {
        let found = parallel::map(keys.len(), PAIRS, |at| {
            let key = keys[at];
            (pairing.pair(part, key), have_crossed(part, pairing.slave(key), pairing.master(key)))
        });
        let (crossed, rest): (Vec<_>, Vec<_>) = found.into_iter().partition(|(_, has_crossed)| *has_crossed);
        [crossed, rest].map(|pairs| pairs.into_iter().map(|(pair, _)| pair).collect()).into()
    };
    // All ranks know the near facets; each makes the pairs that it evaluates.
    let is_own = |key: &PairKey| part.evaluates_pair(&pairing.slave(*key).nodes);
    let (crossed, rest) = pairs_of(&near.iter().copied().filter(is_own).collect::<Vec<_>>());
    let mut blocks = pairing.blocks_of(crossed, settings, &Arc::new(without_tangent(parameters)))?;
    blocks.extend(pairing.blocks_of(rest, settings, &searching(parameters, setup.limit()))?);
    let mut more = SlaveSums::<FoundOverlap>::new(states);
    let integrals = integrals(&mut blocks, part, states);
    for (block, integrals) in blocks.iter().zip(&integrals) {
        for (at, integral) in integrals.iter().enumerate().filter(|(_, integral)| integral.overlapping) {
            for (local, &node) in block.slaves(at).iter().enumerate() {
                more[node].gap += integral.gap[local];
                more[node].area += integral.area[local];
            }
        }
    }
    more.over_ranks(part, states);
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let area = |slave: SlaveIndex| states[slave].kinematics.area + more[slave].area;
    let inside = |&n: &SlaveIndex| {
        let at = states.mesh_node(n) as usize;
        let around =
            parameters.segmentation.revolution().map_or(1.0, |per_radius| per_radius * part.nodes.current[at][0]);
        let whole = around * sizes[at].powi(part.info.domain_size as i32 - 1);
        let gap = states[n].kinematics.weighted_gap + more[n].gap;
        !states[n].law.active && more[n].area > wanted.facing * whole && gap < -wanted.depth * area(n)
    };
    let nodes: BTreeSet<SlaveIndex> = states.slaves().iter().copied().filter(inside).collect();
    let mut found = BTreeSet::new();
    for (block, integrals) in blocks.iter().zip(&integrals) {
        for (at, integral) in integrals.iter().enumerate() {
            let matters = |(local, &node): (usize, &SlaveIndex)| {
                nodes.contains(&node)
                    || states[node].law.active && integral.area[local].abs() > wanted.share * area(node).abs()
            };
            if integral.overlapping && block.slaves(at).iter().enumerate().any(matters) {
                found.insert(block.pairs()[at].key);
            }
        }
    }
    let mut missed: Vec<bool> = near.iter().map(|key| found.contains(key)).collect();
    if part.share.is_some() {
        part.ranks.any_of(&mut missed);
    }
    let missed = near.into_iter().zip(missed).filter(|(_, missed)| *missed).map(|(key, _)| key);
    let (crossed, rest) = pairs_of(&missed.collect::<Vec<_>>());
    Ok(FoundPairs {
        missed: [crossed, rest].concat(),
        nodes: nodes.into_iter().map(|slave| states.mesh_node(slave)).collect(),
    })
}
