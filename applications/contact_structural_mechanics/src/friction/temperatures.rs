//! Temperature of contact at slave nodes, for laws of friction that depend on it.
//!
//! T_j = ½ (T_j¹ + T_j²), T_j² = Σ_l M_jl T_l / Σ_l M_jl: the mean of the slave node and of the master opposite, so that it does not
//! matter which side is the slave. Dual functions are negative in places: T_j² stays within the temperatures of the facets opposite.

use zelus_core::model::ModelPart;
use zelus_structural_mechanics::variables::TEMPERATURE;

use crate::pairs::{ContactBlock, IntegrationState};
use crate::slave_nodes::{SlaveStates, SlaveSums, Summands};

/// Sums of one slave node over the pairs.
#[derive(Clone, Copy, Default)]
struct Opposite {
    /// Σ_l M_jl (area).
    area: f64,
    /// Σ_l M_jl T_l (area times temperature).
    weighted: f64,
}

impl Summands<2> for Opposite {
    fn numbers(&self) -> [f64; 2] {
        [self.area, self.weighted]
    }

    fn of([area, weighted]: [f64; 2]) -> Self {
        Self { area, weighted }
    }
}

/// Least temperature opposite a slave node, and the largest with the other sign.
#[derive(Clone, Copy)]
struct Range([f64; 2]);

impl Default for Range {
    fn default() -> Self {
        Self([f64::INFINITY; 2])
    }
}

impl Summands<2> for Range {
    fn numbers(&self) -> [f64; 2] {
        self.0
    }

    fn of(numbers: [f64; 2]) -> Self {
        Self(numbers)
    }
}

/// Finds the temperatures of contact in the present state, of nodes that face nothing their own; collective.
pub(crate) fn find_temperatures(part: &ModelPart, states: &mut SlaveStates, blocks: &[Box<dyn ContactBlock>]) {
    let temperature = part.nodes.history.values(&TEMPERATURE, 0);
    let mut sums = SlaveSums::<Opposite>::new(states);
    let mut ranges = SlaveSums::<Range>::new(states);
    let own = |nodes: &[u32]| part.evaluates_pair(nodes);
    let present = IntegrationState { view: &part.view(), states, own: &own };
    for block in blocks {
        for (at, weights) in block.master_weights(present).into_iter().enumerate() {
            let Some(weights) = weights.filter(|_| block.pairs()[at].overlapping) else { continue };
            for (&slave, row) in block.slaves(at).iter().zip(weights.iter()) {
                for (&master, &weight) in block.masters(at).iter().zip(row.iter()) {
                    let own = temperature[master as usize];
                    sums[slave].area += weight;
                    sums[slave].weighted += weight * own;
                    let Range([least, most]) = ranges[slave];
                    ranges[slave] = Range([least.min(own), most.min(-own)]);
                }
            }
        }
    }
    sums.over_ranks(part, states);
    ranges.least_over_ranks(part, states);
    for slave in states.all() {
        let own = temperature[states.mesh_node(slave) as usize];
        let (Opposite { area, weighted }, Range([least, most])) = (sums[slave], ranges[slave]);
        let opposite = if area > 0.0 { (weighted / area).max(least).min(-most) } else { own };
        states[slave].parameters.temperature = 0.5 * (own + opposite);
    }
}
