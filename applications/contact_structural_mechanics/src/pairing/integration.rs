//! Overlaps, gaps, slips and areas of the slave nodes: sums over their pairs in the present configuration.

use zelus_core::model::ModelPart;
use zelus_core::vector3::add;

use super::edge_nodes::isolate_edge_nodes;
use super::edges::keep_one_of_a_normal;
use super::pairs_of_interfaces::Pairing;
use crate::active_set::tolerances;
use crate::law::constrained_multiplier::along_free_tangents;
use crate::pairs::Integral;
use crate::settings::Setup;
use crate::slave_nodes::{SlaveStates, SlaveSums, Summands};

/// Integrals of the pairs of a slave node, summed.
#[derive(Clone, Copy, Default)]
struct NodeIntegrals {
    /// Weighted gap (length times area).
    gap: f64,
    area: f64,
    /// Weighted gap of each pair times its area.
    gap_by_area: f64,
    /// Weighted slip (length times area).
    slip: [f64; 3],
    /// Weighted tangential opening of bonds (length times area).
    sliding: [f64; 3],
    /// Area times trial traction.
    trial: [f64; 3],
    /// Area times history traction.
    history_traction: [f64; 3],
}

impl NodeIntegrals {
    /// Adds the integral of a pair at one of the nodes of its slave facet.
    fn add(&mut self, integral: &Integral, local: usize) {
        let (gap, area) = (integral.gap[local], integral.area[local]);
        self.gap += gap;
        self.area += area;
        self.gap_by_area += gap * area;
        self.slip = add(self.slip, integral.slip[local]);
        self.sliding = add(self.sliding, integral.sliding[local]);
        self.trial = add(self.trial, integral.trial[local]);
        self.history_traction = add(self.history_traction, integral.history_traction[local]);
    }
}

impl Summands<15> for NodeIntegrals {
    fn numbers(&self) -> [f64; 15] {
        let [[a, b, c], [d, e, f], [g, h, i], [j, k, l]] = [self.slip, self.trial, self.history_traction, self.sliding];
        [self.gap, self.area, self.gap_by_area, a, b, c, d, e, f, g, h, i, j, k, l]
    }

    fn of([gap, area, gap_by_area, a, b, c, d, e, f, g, h, i, j, k, l]: [f64; 15]) -> Self {
        let [slip, trial, history_traction, sliding] = [[a, b, c], [d, e, f], [g, h, i], [j, k, l]];
        Self { gap, area, gap_by_area, slip, sliding, trial, history_traction }
    }
}

/// Integrates all pairs, and finds overlaps that are too small to decide on.
pub(crate) fn integrate(part: &ModelPart, pairing: &mut Pairing, states: &mut SlaveStates, setup: &mut Setup) {
    let (integrals, overlaps) = pairing.integrals(part, states);
    let mut sums = SlaveSums::<NodeIntegrals>::new(states);
    states.for_all(|state| {
        (
            state.kinematics.pairs,
            state.kinematics.area,
            state.kinematics.weighted_gap,
            state.kinematics.mean_weighted_gap,
        ) = (0, 0.0, 0.0, 0.0);
        state.kinematics.weighted_slip = [0.0; 3];
    });
    let mut overlaps = overlaps.into_iter();
    for (block, integrals) in pairing.blocks.iter_mut().zip(&integrals) {
        for (at, integral) in integrals.iter().enumerate() {
            let overlapping = overlaps.next().is_some_and(|overlap| overlap.overlapping);
            let pair = &mut block.pairs_mut()[at];
            (pair.overlapping, pair.area) = (overlapping, integral.area);
            // Of facets that nodes have left in this step the slip alone is not zero.
            for (local, &node) in block.slaves(at).iter().enumerate() {
                states[node].kinematics.pairs += u32::from(overlapping);
                sums[node].add(integral, local);
            }
        }
    }
    sums.over_ranks(part, states);

    let formulation = setup.settings.formulation;
    states.for_each(|node, state| {
        let NodeIntegrals { gap, area, gap_by_area, slip, trial, history_traction, .. } = sums[node];
        let by_area = |sum: [f64; 3]| if area > 0.0 { sum.map(|t| t / area) } else { [0.0; 3] };
        (state.kinematics.area, state.kinematics.weighted_gap, state.kinematics.isolated) =
            (area, gap, state.kinematics.pairs == 0);
        state.kinematics.mean_weighted_gap = if area > 0.0 { gap_by_area / area } else { 0.0 };
        if formulation.frictional() {
            let is_constrained = state.law.constraints.any_still();
            state.kinematics.weighted_slip = if is_constrained {
                along_free_tangents(slip, state.kinematics.normal, state.law.constraints)
            } else {
                slip
            };
            if formulation.multiplier.is_unknown() {
                state.law.multiplier_weight = state.equation_weight(&setup.parameters);
            }
        }
        state.law.trial = by_area(trial);
        if setup.by_points() {
            state.law.history_traction = by_area(history_traction);
        }
    });
    states.open_bonds(&|slave| {
        let NodeIntegrals { area, sliding, .. } = sums[slave];
        if area > 0.0 { sliding.map(|w| w / area) } else { [0.0; 3] }
    });
    let around = setup.parameters.segmentation.revolution();
    let weight = |n: u32| around.map_or(1.0, |per_radius| per_radius * part.nodes.current[n as usize][0]);
    isolate_edge_nodes(part, states, pairing, setup.settings.least_coverage, weight);
    keep_one_of_a_normal(states);
    setup.tolerances = tolerances(part, &pairing.nodes(), states, formulation, &setup.parameters);
}
