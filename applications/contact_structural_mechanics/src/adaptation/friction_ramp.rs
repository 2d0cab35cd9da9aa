//! Friction that joins contact once it is found, in steps that could not be solved with both at once.
//!
//! Pressures bound friction, and friction decides where bodies press: far from the answer the iteration may run through states
//! of both that lead nowhere, however short the step, as where bodies are meshed into each other. Contact without friction is
//! far easier. A step that is tried again solves it first; from there friction takes over, against the slip that it left.
//! The step that converges in the end is that of the deck.

use serde::{Deserialize, Serialize};
use zelus_core::entities::OuterLoop;
use zelus_core::model::{ModelPart, Variable};
use zelus_core::vector3::{norm, scale};

use crate::law::{FrictionEllipse, FrictionLaw};
use crate::mortar::tangent;
use crate::slave_nodes::SlaveStates;
use crate::tolerances::Tolerances;

/// Shares of friction that act one after the other, each from where the one before has converged.
const SHARES: [f64; 5] = [0.0, 0.1, 0.3, 0.6, 1.0];

/// How much of friction acts.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct FrictionRamp {
    /// Attempts of this step that have failed one after the other.
    failed: usize,
    /// Whether the present one is solved.
    solved: bool,
    /// Where in [`SHARES`] the step is, and the strengths of the law at the nodes, while not all of it acts; between steps
    /// nothing waits.
    #[serde(skip)]
    waiting: Option<(usize, Vec<Vec<f64>>)>,
}

impl FrictionRamp {
    /// The step is tried again; one that was solved, and is to be shorter, has not failed.
    pub(crate) fn retry(&mut self) {
        self.failed = if self.solved { 0 } else { self.failed + 1 };
    }

    /// The step is solved.
    pub(crate) fn solve(&mut self) {
        self.solved = true;
    }

    /// The step is accepted.
    pub(crate) fn accept(&mut self) {
        self.failed = 0;
    }

    /// Whether the next attempt of a step that fails once more begins without friction.
    pub(crate) fn comes_next(&self) -> bool {
        !self.solved && self.failed % 2 == 1
    }

    /// Step start: every other attempt of a step that failed, from the third on, begins without friction, which may be all that
    /// holds a body.
    pub(crate) fn begin_step(&mut self, part: &mut ModelPart, law: &FrictionLaw) {
        self.solved = false;
        if self.failed > 0 && self.failed.is_multiple_of(2) {
            let take = |variable: &&Variable<f64>| {
                let column = part.nodes.values.values_mut(*variable, 0);
                let numbers = column.to_vec();
                column.fill(0.0);
                numbers
            };
            self.waiting = Some((0, law.strengths.iter().map(take).collect()));
        } else {
            self.waiting = None;
        }
    }

    /// The iteration has converged: more of friction acts from now on, at first against the slip at each node; nodes without
    /// slip stick.
    pub(crate) fn after_convergence(
        &mut self,
        part: &mut ModelPart,
        states: &mut SlaveStates,
        (law, ellipse): (&FrictionLaw, FrictionEllipse),
        tolerances: Tolerances,
    ) -> OuterLoop {
        let Some((stage, numbers)) = self.waiting.take() else { return OuterLoop::Done };
        let share = SHARES[stage + 1];
        for (variable, numbers) in law.strengths.iter().zip(&numbers) {
            let column = part.nodes.values.values_mut(*variable, 0);
            column.iter_mut().zip(numbers).for_each(|(now, number)| *now = share * number);
        }
        if stage + 2 < SHARES.len() {
            self.waiting = Some((stage + 1, numbers));
        }
        states.read_friction(&part.nodes, law);
        if stage > 0 {
            return OuterLoop::Continue;
        }
        let dimension = part.info.domain_size;
        states.for_each(|_, state| {
            if state.law.active {
                let area = state.kinematics.area;
                let slip = if area > 0.0 { scale(state.kinematics.weighted_slip, area.recip()) } else { [0.0; 3] };
                let slides = norm(tolerances.vector_of(slip)) > 0.0 || state.parameters.friction.is_smooth();
                let normal = state.kinematics.normal;
                state.law.tangent = tangent(ellipse.root(slip, normal), normal, dimension);
                state.law.slides = Some(slides);
            }
        });
        OuterLoop::Continue
    }
}
