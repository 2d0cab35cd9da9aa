//! Uzawa's outer loop: the Uzawa pressure follows the multipliers until no elastic gap is left (eq. D.10).

use serde::{Deserialize, Serialize};
use zelus_core::entities::OuterLoop;
use zelus_core::model::SlaveNodes;

use crate::interface::SlaveIndex;
use crate::slave_nodes::{SlaveState, SlaveStates};
use crate::variables::LAGRANGE_MULTIPLIER_CONTACT_PRESSURE;

/// How far the outer loop goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UzawaSettings {
    /// Change of the multipliers, relative to them, at which it ends.
    pub tolerance: f64,
    /// Updates of a step at most.
    pub max_updates: usize,
}

/// The updates of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Uzawa {
    /// Updates made in this step.
    pub(crate) updates: usize,
    /// Size of the last change.
    last: f64,
    /// Ratio of the last two changes: the rate of linear convergence.
    pub(crate) rate: f64,
}

impl Uzawa {
    /// p° ← k λ at the slave nodes in contact, none that pulls; zero at all others.
    pub(crate) fn update(
        &mut self,
        slave_nodes: &SlaveNodes,
        states: &mut SlaveStates,
        scale_factor: f64,
        settings: UzawaSettings,
    ) -> OuterLoop {
        let multipliers = slave_nodes.history.values(&LAGRANGE_MULTIPLIER_CONTACT_PRESSURE, 0);
        let pressure = |(slave, state): (SlaveIndex, &SlaveState)| {
            if state.law.active { (scale_factor * multipliers[states.owner(slave) as usize]).min(0.0) } else { 0.0 }
        };
        let pressures: Vec<f64> = states.iter().map(pressure).collect();
        let size = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
        let change = size(&mut states.iter().zip(&pressures).map(|((_, state), p)| p - state.law.uzawa_pressure));
        let total = size(&mut pressures.iter().copied());
        if self.updates > 0 && self.last > 0.0 {
            self.rate = change / self.last;
        }
        self.last = change;
        if change <= settings.tolerance * total {
            return OuterLoop::Done;
        }
        if self.updates == settings.max_updates {
            let relative = change / total;
            return OuterLoop::Failed(format!(
                "multipliers still change by {relative:.1e} of their size after {} updates, at the rate {:.3}: raise \
                 \"stiffness_factor\" or \"max_multiplier_updates\"",
                self.updates, self.rate
            ));
        }
        self.updates += 1;
        let mut pressures = pressures.into_iter();
        states.for_each(|_, state| state.law.uzawa_pressure = pressures.next().unwrap_or(0.0));
        OuterLoop::Continue
    }
}
