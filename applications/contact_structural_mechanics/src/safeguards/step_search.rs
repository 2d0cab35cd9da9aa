//! When contact searches within a step: in its first iterations, where bodies move on, and in converged states.

use serde::{Deserialize, Serialize};
use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::OuterLoop;
use zelus_core::model::ModelPart;
use zelus_core::vector3::{norm, sub};

use super::missed_pairs::{FoundPairs, SearchThresholds, missed_pairs};
use crate::pairing::Pairing;
use crate::pairs::Pair;
use crate::search::{WithinStep, farthest_motion, warn_of_missed_pairs};
use crate::settings::Setup;
use crate::slave_nodes::SlaveStates;

/// Searches in converged states of a step after which it counts as not converged.
const MOST_SEARCHES: usize = 5;

/// The searches of a step.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct StepSearch {
    /// In converged states of this step.
    searches: usize,
    warned: bool,
    /// Places of the nodes of the interfaces at the last look on the way.
    #[serde(skip)]
    places: Vec<[f64; 3]>,
}

impl StepSearch {
    /// A step begins.
    pub(crate) fn begin_step(&mut self) {
        self.searches = 0;
        self.places.clear();
    }

    /// Whether `nodes` have moved by `length` since this was true last; at first it is. Collective.
    pub(crate) fn has_moved(&mut self, part: &ModelPart, nodes: &[u32], length: f64) -> bool {
        let places = || nodes.iter().map(|&node| part.nodes.current[node as usize]);
        let far = |(now, before): ([f64; 3], &[f64; 3])| norm(sub(now, *before)) >= length;
        let moved = self.places.len() != nodes.len() || places().zip(&self.places).any(far);
        let moved = part.ranks.any(moved);
        if moved {
            self.places = places().collect();
        }
        moved
    }

    /// Facets that should be pairs now and are not; `searched` says whether the step began with a search.
    ///
    /// # Errors
    /// Errors of making blocks.
    fn missed_pairs(
        &self,
        part: &ModelPart,
        (pairing, states): (&Pairing, &SlaveStates),
        setup: &Setup,
        searched: bool,
    ) -> Result<FoundPairs> {
        let still = searched && farthest_motion(part, &pairing.nodes()) <= setup.tolerances.length;
        if still || !setup.threshold.is_finite() {
            return Ok(FoundPairs::default());
        }
        let wanted = match setup.settings.search.within_step {
            WithinStep::Facing => SearchThresholds::facing(setup.tolerances),
            WithinStep::Lost => SearchThresholds::lost(setup.near(), self.searches > 0),
        };
        missed_pairs(part, (pairing, states), setup, wanted)
    }

    /// In the first iterations, and where bodies move on: pairs that the motion has made, so that the iteration need not be repeated for them at its end.
    ///
    /// # Errors
    /// Errors of making blocks.
    pub(crate) fn on_the_way(
        &self,
        part: &ModelPart,
        contact: (&Pairing, &SlaveStates),
        setup: &Setup,
        searched: bool,
    ) -> Result<Vec<Pair>> {
        let looks = setup.settings.search.within_step == WithinStep::Facing && setup.settings.explicit.is_none();
        if looks { Ok(self.missed_pairs(part, contact, setup, searched)?.missed) } else { Ok(Vec::new()) }
    }

    /// In a converged state: pairs from the present positions, and the consequence for the step.
    ///
    /// # Errors
    /// Errors of making blocks.
    pub(crate) fn in_converged_state(
        &mut self,
        part: &ModelPart,
        contact: (&Pairing, &SlaveStates),
        setup: &Setup,
        searched: bool,
        messages: &mut Vec<Diagnostic>,
    ) -> Result<(Vec<Pair>, OuterLoop)> {
        let late = self.missed_pairs(part, contact, setup, searched)?;
        if late.missed.is_empty() {
            return Ok((late.missed, OuterLoop::Done));
        }
        let why = match late.nodes.iter().take(6).map(|&n| part.nodes.ids[n as usize].to_string()).collect::<Vec<_>>() {
            ids if ids.is_empty() => {
                format!("{} more facet pairs are found at the present positions", late.missed.len())
            }
            ids => format!("nodes {} have penetrated facets that were not paired with theirs", ids.join(" ")),
        };
        if self.searches < MOST_SEARCHES {
            self.searches += 1;
            return Ok((late.missed, OuterLoop::PairsAdded(why)));
        }
        if !late.nodes.is_empty() {
            let why = format!("{why}, after {MOST_SEARCHES} searches within the step");
            return Ok((Vec::new(), OuterLoop::Failed(why)));
        }
        if !std::mem::replace(&mut self.warned, true) {
            messages.push(warn_of_missed_pairs(late.missed.len(), MOST_SEARCHES));
        }
        Ok((Vec::new(), OuterLoop::Done))
    }
}
