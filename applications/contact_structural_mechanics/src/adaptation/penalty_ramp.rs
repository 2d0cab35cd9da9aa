//! A soft beginning of steps that a stiff penalty could not solve at once.
//!
//! Geometry is not linear: an iterate is off by the square of its motion, and a penalty of ten thousand times the stiffness of
//! an element makes pressures of it that decide on contact wrongly. A step that is tried again begins with a share of the
//! penalty, and each converged state raises it, so that motions are small where the spring is stiff.

use serde::{Deserialize, Serialize};
use zelus_core::entities::OuterLoop;
use zelus_core::model::ProcessInfo;

use crate::slave_nodes::SlaveStates;
use crate::variables::INITIAL_PENALTY;

/// Share of the penalty with which a retried step begins.
const FIRST: f64 = 1e-3;
/// Factor by which each converged state raises the penalty.
const RISE: f64 = 10.0;

/// The share of the penalty that acts now.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct PenaltyRamp {
    share: f64,
    /// Whether the next step begins with less than all of it.
    retried: bool,
}

impl Default for PenaltyRamp {
    fn default() -> Self {
        Self { share: 1.0, retried: false }
    }
}

impl PenaltyRamp {
    /// The step is tried again.
    pub(crate) fn retry(&mut self) {
        self.retried = true;
    }

    /// Step start: all of the penalty, or of a retried step the first share.
    pub(crate) fn begin_step(&mut self, info: &ProcessInfo, states: &mut SlaveStates) {
        if self.retried || self.share < 1.0 {
            self.share = if self.retried { FIRST } else { 1.0 };
            self.set(info, states);
        }
        self.retried = false;
    }

    /// The iteration has converged with the present share.
    pub(crate) fn after_convergence(&mut self, info: &ProcessInfo, states: &mut SlaveStates) -> OuterLoop {
        if self.share >= 1.0 {
            return OuterLoop::Done;
        }
        self.share = (self.share * RISE).min(1.0);
        self.set(info, states);
        OuterLoop::Continue
    }

    fn set(self, info: &ProcessInfo, states: &mut SlaveStates) {
        let penalty = info.value_or(INITIAL_PENALTY.name(), 1.0);
        states.for_all(|state| state.parameters.penalty = self.share * penalty);
    }
}
