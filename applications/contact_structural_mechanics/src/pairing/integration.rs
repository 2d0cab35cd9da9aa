//! Overlaps, gaps, slips and areas of the slave nodes: sums over their pairs in the present configuration.

use zelus_core::model::ModelPart;

use super::coverage::isolate_beside;
use super::edges::keep_one_of_a_normal;
use super::pairs_of_interfaces::Pairing;
use crate::active_set::resolution;
use crate::law::constrained_multiplier::along_free_tangents;
use crate::settings::Setup;
use crate::slave_nodes::{SlaveStates, SlaveSums};

/// Integrates all pairs, and finds what is too small to decide on.
pub(crate) fn integrate(part: &ModelPart, pairing: &mut Pairing, states: &mut SlaveStates, setup: &mut Setup) {
    let (integrals, meetings) = pairing.integrals(part, states);
    // Gap, area, gap times area, slip, traction, carried traction.
    let mut sums = SlaveSums::<12>::new(states);
    states.for_all(|state| {
        (state.pairs, state.area, state.weighted_gap, state.mean_weighted_gap) = (0, 0.0, 0.0, 0.0);
        state.weighted_slip = [0.0; 3];
    });
    let mut meetings = meetings.into_iter();
    for (block, integrals) in pairing.blocks.iter_mut().zip(&integrals) {
        for (at, integral) in integrals.iter().enumerate() {
            let overlaps = meetings.next().is_some_and(|meeting| meeting.overlapping);
            let pair = &mut block.pairs_mut()[at];
            (pair.overlapping, pair.area) = (overlaps, integral.area);
            if !overlaps {
                continue;
            }
            for (local, &node) in block.slaves(at).iter().enumerate() {
                states[node].pairs += 1;
                let (gap, area) = (integral.gap[local], integral.area[local]);
                let vectors = [integral.slip[local], integral.trial[local], integral.carried[local]];
                let numbers = [gap, area, gap * area].into_iter().chain(vectors.into_iter().flatten());
                sums[node].iter_mut().zip(numbers).for_each(|(sum, number)| *sum += number);
            }
        }
    }
    sums.over_ranks(part, states);

    let formulation = setup.settings.formulation;
    states.for_each(|node, state| {
        let [gap, area, mean, rest @ ..] = sums[node];
        let vector = |first: usize| [rest[first], rest[first + 1], rest[first + 2]];
        let by_area = |sum: [f64; 3]| if area > 0.0 { sum.map(|t| t / area) } else { [0.0; 3] };
        (state.area, state.weighted_gap, state.isolated) = (area, gap, state.pairs == 0);
        state.mean_weighted_gap = if area > 0.0 { mean / area } else { 0.0 };
        if formulation.frictional() {
            let slip = vector(0);
            let is_held = state.held.iter().any(|held| held.is_still());
            state.weighted_slip = if is_held { along_free_tangents(slip, state.normal, state.held) } else { slip };
            if formulation.multiplier.is_unknown() {
                state.multiplier_weight = state.equation_weight(&setup.parameters);
            }
        }
        state.trial = by_area(vector(3));
        if setup.by_points() {
            state.carried = by_area(vector(6));
        }
    });
    let around = setup.parameters.segmentation.revolution();
    let weight = |n: u32| around.map_or(1.0, |per_radius| per_radius * part.nodes.current[n as usize][0]);
    isolate_beside(part, states, pairing, setup.settings.least_coverage, weight);
    keep_one_of_a_normal(states);
    setup.resolution = resolution(part, &pairing.nodes(), states, formulation, &setup.parameters);
}
