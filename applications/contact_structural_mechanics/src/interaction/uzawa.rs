//! Uzawa's outer loop: multipliers follow the penalty's forces until they carry the pressure alone (eq. D.10).

use zelus_core::entities::Outer;
use zelus_core::model::flags::ACTIVE;
use zelus_core::model::{ModelPart, Variable};

use crate::variables::{INITIAL_PENALTY, NODAL_AREA, WEIGHTED_GAP};

/// How far the outer loop goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UzawaSettings {
    /// Change of the multipliers, relative to them, at which it ends.
    pub tolerance: f64,
    /// Updates of a step at most.
    pub max_updates: usize,
}

/// The updates of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Uzawa {
    /// Updates made in this step.
    pub(super) updates: usize,
    /// Size of the last change and of the multipliers.
    last: f64,
    /// Ratio of the last two changes: the rate of linear convergence.
    pub(super) rate: f64,
}

impl Uzawa {
    /// k λ ← k λ + ε ḡ at the active slave nodes, with the mean gap ḡ of a node.
    pub(super) fn update(
        &mut self,
        part: &mut ModelPart,
        slaves: &[u32],
        variable: &Variable<f64>,
        scale_factor: f64,
        settings: UzawaSettings,
    ) -> Outer {
        let penalty = part.nodes.values.values(&INITIAL_PENALTY, 0);
        let gaps = part.nodes.history.values(&WEIGHTED_GAP, 0);
        let areas = part.nodes.values.values(&NODAL_AREA, 0);
        let multipliers = part.nodes.history.values(variable, 0);
        let active: Vec<usize> =
            slaves.iter().map(|&n| n as usize).filter(|&n| part.nodes.flags.is(ACTIVE, n) && areas[n] > 0.0).collect();
        let changes: Vec<f64> = active.iter().map(|&n| penalty[n] * gaps[n] / (areas[n] * scale_factor)).collect();
        let change = changes.iter().map(|c| c * c).sum::<f64>().sqrt();
        let total = active.iter().zip(&changes).map(|(&n, c)| (multipliers[n] + c).powi(2)).sum::<f64>().sqrt();
        if self.updates > 0 && self.last > 0.0 {
            self.rate = change / self.last;
        }
        self.last = change;
        if change <= settings.tolerance * total {
            return Outer::Done;
        }
        if self.updates == settings.max_updates {
            let relative = change / total;
            return Outer::Failed(format!(
                "multipliers still change by {relative:.1e} of their size after {} updates, at the rate {:.3}: raise \
                 \"stiffness_factor\" or \"max_multiplier_updates\"",
                self.updates, self.rate
            ));
        }
        self.updates += 1;
        let column = part.nodes.history.values_mut(variable, 0);
        active.iter().zip(&changes).for_each(|(&n, c)| column[n] += c);
        Outer::Again
    }
}
