//! Facets that came through each other within a step although the search at its start left them out.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use zelus_core::Result;
use zelus_core::communication::world;
use zelus_core::model::flags::ACTIVE;
use zelus_core::model::{ModelPart, variables::DISPLACEMENT};
use zelus_core::vector3::{add, dot, norm, sub};

use super::contact_settings::ContactSettings;
use super::pairing::{Pairing, add_up_nodes, searching};
use super::step_parameters::StepParameters;
use crate::interface::{Facet, centre_normal};
use crate::pairs::Pair;
use crate::variables::{NODAL_AREA, WEIGHTED_GAP};

/// What a search in a converged state finds.
#[derive(Default)]
pub(super) struct Late {
    /// Nodes that are not in contact though, with the pairs found, they are in a master.
    pub nodes: Vec<u32>,
    /// Pairs of these nodes; all pairs found, where those were asked for.
    pub missed: Vec<Pair>,
    /// Number of other facets in each other.
    pub others: usize,
}

/// Facets that are in each other by more than `depth` now and are no pair.
///
/// They are those that a search would find now, within `limit`, and, however deep, those that crossed in the step. Weighted
/// gaps and areas of the nodes must be those of the present state.
///
/// # Errors
/// Those of making blocks.
pub(super) fn late_pairs(
    part: &ModelPart,
    pairing: &Pairing,
    settings: &ContactSettings,
    parameters: &Arc<StepParameters>,
    limit: f64,
    depth: f64,
    all: bool,
) -> Result<Late> {
    let known: BTreeSet<_> = pairing.keys().into_iter().collect();
    let near = pairing.candidates(part, settings).into_iter().filter(|(key, _)| !known.contains(key));
    let within_reach: BTreeMap<_, bool> = near.collect();
    let (crossed, rest): (Vec<Pair>, Vec<Pair>) = within_reach
        .keys()
        .map(|&key| pairing.pair(part, key))
        .partition(|pair| have_crossed(part, pairing.slave(pair.key), pairing.master(pair.key)));
    let mut blocks = pairing.blocks_of(crossed, settings, parameters)?;
    blocks.extend(pairing.blocks_of(rest, settings, &searching(parameters, limit))?);
    let own = |nodes: &[u32]| part.evaluates_pair(nodes);
    let (mut pairs, mut flags) = (Vec::new(), Vec::new());
    let mut gap = part.nodes.history.values(&WEIGHTED_GAP, 0).to_vec();
    let mut area = part.nodes.values.values(&NODAL_AREA, 0).to_vec();
    let (mut more_gap, mut more_area) = (vec![0.0; gap.len()], vec![0.0; gap.len()]);
    for block in &blocks {
        for (at, integral) in block.integrate(&part.view(), &own).iter().enumerate() {
            let pair = block.pairs()[at].clone();
            let reached = integral.overlapping && within_reach[&pair.key];
            let deep = integral.gap.iter().zip(&integral.area).any(|(gap, area)| *gap < -depth * area.abs());
            flags.extend([reached, integral.overlapping && deep]);
            if reached {
                for (local, &node) in block.slave_nodes(at).iter().enumerate() {
                    more_gap[node as usize] += integral.gap[local];
                    more_area[node as usize] += integral.area[local];
                }
            }
            pairs.push(pair);
        }
    }
    let slaves = pairing.slaves();
    if part.share.is_some() {
        world().any_of(&mut flags);
        add_up_nodes(part, &slaves, &mut [(1, &mut more_gap[..]), (1, &mut more_area[..])]);
    }
    gap.iter_mut().zip(&more_gap).for_each(|(sum, more)| *sum += more);
    area.iter_mut().zip(&more_area).for_each(|(sum, more)| *sum += more);
    let inside = |&n: &u32| {
        let at = n as usize;
        !part.nodes.flags.is(ACTIVE, at) && more_area[at] > 0.0 && gap[at] < -depth * area[at]
    };
    let nodes: BTreeSet<u32> = slaves.iter().copied().filter(inside).collect();
    let mut late = Late { nodes: nodes.iter().copied().collect(), ..Late::default() };
    for (pair, flags) in pairs.into_iter().zip(flags.chunks_exact(2)) {
        if flags[0] && (all || pairing.slave(pair.key).nodes.iter().any(|n| nodes.contains(n))) {
            late.missed.push(pair);
        } else if flags[1] {
            late.others += 1;
        }
    }
    Ok(late)
}

/// Whether the centre of the slave has gone from the front of the master's plane to its back in the step.
fn have_crossed(part: &ModelPart, slave: &Facet, master: &Facet) -> bool {
    let height = |position: &dyn Fn(u32) -> [f64; 3]| {
        let positions = |facet: &Facet| -> Vec<[f64; 3]> { facet.nodes.iter().map(|&n| position(n)).collect() };
        let centre = |x: &[[f64; 3]]| std::array::from_fn(|c| x.iter().map(|x| x[c]).sum::<f64>() / x.len() as f64);
        let (slave, master_at) = (positions(slave), positions(master));
        let normal = centre_normal(master.shape, &master_at).unwrap_or([0.0; 3]);
        dot(sub(centre(&slave), centre(&master_at)), normal)
    };
    height(&|n| step_start(part, n)) > 0.0 && height(&|n| part.nodes.current[n as usize]) < 0.0
}

/// Where a node was when the step began.
fn step_start(part: &ModelPart, node: u32) -> [f64; 3] {
    let initial = part.nodes.initial[node as usize];
    let Some(field) = part.nodes.history.get(DISPLACEMENT.name()) else { return initial };
    add(initial, field.vector(1.min(field.levels.len() - 1), node as usize))
}

/// How far the farthest of `nodes` has moved in the step (length).
pub(super) fn farthest_motion(part: &ModelPart, nodes: &[u32]) -> f64 {
    let motion = |&n: &u32| norm(sub(part.nodes.current[n as usize], step_start(part, n)));
    nodes.iter().map(motion).fold(0.0, f64::max)
}
