//! Elastic start: a step with contact and yielding elements that has failed is repeated with elastic elements until contact has settled.
//!
//! Iterates press on too few nodes while contact states still change. Elements yield there as they do not in the converged state, and have no
//! stiffness left. So elements first keep their history ([`ELASTIC`]); from the converged state of that problem on they may yield. The result is
//! that of the step: only the first iterates differ.

use super::NewtonRaphson;
use crate::assembly::System;
use crate::entities::ELASTIC;
use crate::model::ModelPart;

impl NewtonRaphson {
    /// A step begins: marks its iterations where elements are elastic at first.
    pub(super) fn begin_elastic(&self, part: &mut ModelPart) {
        if self.begins_elastic {
            part.info.set(ELASTIC, true);
        }
    }

    /// Whether a step that has failed might begin with elastic elements. Collective.
    pub(super) fn may_begin_elastic(&self, part: &ModelPart, system: &System) -> bool {
        self.settings.elastic_start_after_failure
            && self.scheme.is_static()
            && !self.settings.linear
            && !system.interactions.is_empty()
            && part.ranks.any(has_history(system))
    }

    /// Lets elements yield from now on; whether they were elastic.
    pub(super) fn end_elastic(&self, part: &mut ModelPart) -> bool {
        let was_elastic = part.info.has(ELASTIC);
        if was_elastic {
            part.info.set(ELASTIC, false);
        }
        was_elastic
    }
}

/// Whether an element has a history.
fn has_history(system: &System) -> bool {
    system.elements.iter().any(|block| (0..block.len()).any(|at| block.has_history(at)))
}
