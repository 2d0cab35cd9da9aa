//! The stage that adapts penalties and the dynamic factor node by node, after the active set of an iteration.

use zelus_core::model::{ModelPart, Nodes};

use super::penalty_adaptation::{Growth, PenaltyRule, dynamic_factor};
use crate::interface::SlaveIndex;
use crate::slave_nodes::{SlaveState, SlaveStates};
use crate::variables::NODAL_H;

/// Least share of a penalty that stays: a gap of round-off would otherwise take all of it away.
const LEAST_SHARE: f64 = 1e-3;

/// Settings of the adaptation.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AdaptationSettings {
    /// Rule that penalties follow (`adapt_penalty`); they stay when `None`.
    pub rule: Option<PenaltyRule>,
    /// Least gap, in mesh sizes, with which the adapted penalty method is content.
    pub min_gap_factor: f64,
    /// Largest gap, in mesh sizes, with which the rule is content.
    pub max_gap_factor: f64,
    /// Whether forces of nodes whose gap has just closed are scaled (`compute_dynamic_factor`).
    pub dynamic_factor: bool,
}

/// How explicit steps stiffen the penalty (`advance_explicit_parameters`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExplicitPenalty {
    /// Share by which it grows at most.
    pub most: f64,
    /// How fast it grows.
    pub exponent: f64,
    /// The gap that counts as large (length); the mean mesh size when `None`.
    pub gap: Option<f64>,
}

impl ExplicitPenalty {
    /// The growth on the mesh of a part.
    pub(crate) fn growth(self, part: &ModelPart) -> Growth {
        let mean_size = || {
            let sizes = part.nodes.values.values(&NODAL_H, 0);
            sizes.iter().sum::<f64>() / sizes.len().max(1) as f64
        };
        Growth { most: self.most, exponent: self.exponent, gap: self.gap.unwrap_or_else(mean_size) }
    }
}

impl AdaptationSettings {
    /// Whether anything is to be done.
    pub(crate) fn acts(self) -> bool {
        self.rule.is_some() || self.dynamic_factor
    }

    /// Weighted gaps of the slave nodes before the next integration, when they will be needed: those of the last iterate,
    /// in explicit steps those of the last step.
    pub(crate) fn gaps(self, states: &SlaveStates, explicit: bool) -> Vec<f64> {
        let gap = |(_, state): (SlaveIndex, &SlaveState)| {
            if explicit { state.last.weighted_gap } else { state.kinematics.weighted_gap }
        };
        if self.acts() || explicit { states.iter().map(gap).collect() } else { Vec::new() }
    }

    /// Adapts penalties and dynamic factors of the active slave nodes.
    ///
    /// `penalty` is the penalty of the run, `previous` the weighted gaps of the last iterate, and `growth` how explicit steps
    /// stiffen the penalty.
    pub(crate) fn adapt(
        self,
        nodes: &Nodes,
        states: &mut SlaveStates,
        penalty: f64,
        previous: &[f64],
        growth: Option<Growth>,
    ) {
        if !self.acts() && growth.is_none() {
            return;
        }
        let sizes = nodes.values.values(&NODAL_H, 0);
        let mut previous = previous.iter();
        let mesh_nodes: Vec<u32> = states.all().map(|slave| states.mesh_node(slave)).collect();
        states.for_each(|slave, state| {
            let before = previous.next().expect("a gap of every slave node");
            // The gap of an open node says nothing about its penalty.
            let Some(gap) = state.gap().filter(|_| state.law.active) else { return };
            let before = before / state.kinematics.area;
            let mut adapted = state.parameters.penalty;
            if self.rule.is_none() {
                adapted = growth.map_or(penalty, |growth| growth.stiffened(penalty, gap));
            }
            if self.dynamic_factor {
                state.parameters.dynamic_factor = dynamic_factor(gap, before);
            }
            if let Some(rule) = self.rule {
                let size = sizes[mesh_nodes[slave.place()] as usize];
                let next = rule.adapt(adapted, gap, before, [self.min_gap_factor * size, self.max_gap_factor * size]);
                if next.is_finite() {
                    adapted = next.max(LEAST_SHARE * rule.floor_refers_to(penalty, adapted));
                }
            }
            state.parameters.penalty = adapted;
        });
    }
}
