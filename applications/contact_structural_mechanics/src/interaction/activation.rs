//! Which slave nodes are in contact: at step start by their gap, in every iteration by the augmented pressure.

use zelus_core::entities::SetChange;
use zelus_core::model::flags::{ACTIVE, ISOLATED, SLIP};
use zelus_core::model::{ModelPart, variables::NORMAL};

use super::step_parameters::StepParameters;
use crate::pairs::{Family, Multiplier};
use crate::variables::{
    AUGMENTED_NORMAL_CONTACT_PRESSURE, FRICTION_COEFFICIENT, INITIAL_PENALTY, NODAL_AREA, NODAL_H, NORMAL_GAP,
    WEIGHTED_GAP,
};

/// Gap, in mesh sizes, of the simple activation.
const SIMPLE_REACH: f64 = 2e-3;
/// Gap of a node that nothing faces.
const FAR: f64 = 1e12;

/// Sets the multipliers of inactive nodes to zero.
pub(super) fn clear_inactive_multipliers(part: &mut ModelPart, multiplier: Multiplier, slaves: &[u32]) {
    let inactive: Vec<u32> = slaves.iter().copied().filter(|&n| !part.nodes.flags.is(ACTIVE, n as usize)).collect();
    let history = &mut part.nodes.history;
    match multiplier {
        Multiplier::None => {}
        Multiplier::Scalar(variable) => {
            let column = history.values_mut(variable, 0);
            inactive.iter().for_each(|&n| column[n as usize] = 0.0);
        }
        Multiplier::Vector(variable) => {
            let column = history.values_mut(variable, 0);
            inactive.iter().for_each(|&n| column[3 * n as usize..3 * n as usize + 3].fill(0.0));
        }
    }
}

/// Step start: a node is active when its gap is below `reach`, or below a share of its mesh size when that is `None`.
///
/// Gaps are weighted gaps over areas, so they are those of the mortar mapping.
pub(super) fn start(part: &mut ModelPart, slaves: &[u32], reach: Option<f64>, family: &Family) {
    let gaps: Vec<f64> = {
        let weighted = part.nodes.history.values(&WEIGHTED_GAP, 0);
        let areas = part.nodes.values.values(&NODAL_AREA, 0);
        slaves.iter().map(|&n| n as usize).map(|n| if areas[n] > 0.0 { weighted[n] / areas[n] } else { FAR }).collect()
    };
    let reaches: Vec<f64> = {
        let sizes = part.nodes.values.values(&NODAL_H, 0);
        slaves.iter().map(|&n| reach.unwrap_or(SIMPLE_REACH * sizes[n as usize])).collect()
    };
    let frictionless: Vec<bool> = {
        let friction = part.nodes.values.values(&FRICTION_COEFFICIENT, 0);
        slaves.iter().map(|&n| friction.get(n as usize).is_none_or(|mu| *mu < f64::EPSILON)).collect()
    };
    for (at, &node) in slaves.iter().enumerate() {
        let node = node as usize;
        let active = gaps[at] < reaches[at] && !part.nodes.flags.is(ISOLATED, node);
        part.nodes.flags.set(ACTIVE, node, active);
        if active && (!family.frictional || frictionless[at]) {
            part.nodes.flags.set(SLIP, node, true);
        } else if active && part.nodes.flags.get(SLIP, node).is_none() {
            part.nodes.flags.set(SLIP, node, false);
        }
    }
    let column = part.nodes.values.values_mut(&NORMAL_GAP, 0);
    for (at, &node) in slaves.iter().enumerate() {
        column[node as usize] = if gaps[at] < reaches[at] { gaps[at] } else { 0.0 };
    }
}

/// The active set of the iteration: a node is active when k λ·n + ε g̃ is negative.
///
/// A node that becomes active starts from its augmented pressure; one that becomes inactive keeps its multiplier, which the
/// next solve drives to zero.
pub(super) fn update(part: &mut ModelPart, slaves: &[u32], family: &Family, parameters: &StepParameters) -> SetChange {
    let k = parameters.scale_factor;
    let mut change = SetChange::default();
    let mut pressures = Vec::with_capacity(slaves.len());
    for &node in slaves {
        let at = node as usize;
        let history = &part.nodes.history;
        let normal = history.get(NORMAL.name()).map_or([0.0; 3], |field| field.vector(0, at));
        let lambda = match family.multiplier {
            Multiplier::None => 0.0,
            Multiplier::Scalar(variable) => history.values(variable, 0)[at],
            Multiplier::Vector(variable) => {
                let values = history.values(variable, 0);
                (0..3).map(|c| values[3 * at + c] * normal[c]).sum()
            }
        };
        let penalty = part.nodes.values.values(&INITIAL_PENALTY, 0)[at];
        let pressure = k * lambda + penalty * history.values(&WEIGHTED_GAP, 0)[at];
        pressures.push(pressure);
        if part.nodes.flags.is(ISOLATED, at) {
            if part.nodes.flags.is(ACTIVE, at) {
                part.nodes.flags.set(ACTIVE, at, false);
                change.deactivated.push(part.nodes.ids[at]);
            }
            continue;
        }
        let (was, now) = (part.nodes.flags.is(ACTIVE, at), pressure < 0.0);
        if now == was {
            continue;
        }
        part.nodes.flags.set(ACTIVE, at, now);
        if !now {
            change.deactivated.push(part.nodes.ids[at]);
            continue;
        }
        change.activated.push(part.nodes.ids[at]);
        if !family.frictional {
            part.nodes.flags.set(SLIP, at, true);
        }
        match family.multiplier {
            Multiplier::None => {}
            Multiplier::Scalar(variable) => part.nodes.history.values_mut(variable, 0)[at] = pressure / k,
            Multiplier::Vector(variable) => {
                let values = part.nodes.history.values_mut(variable, 0);
                (0..3).for_each(|c| values[3 * at + c] = normal[c] * pressure / k);
            }
        }
    }
    let column = part.nodes.values.values_mut(&AUGMENTED_NORMAL_CONTACT_PRESSURE, 0);
    slaves.iter().zip(pressures).for_each(|(&n, pressure)| column[n as usize] = pressure);
    change
}
