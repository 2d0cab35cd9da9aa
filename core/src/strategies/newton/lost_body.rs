//! Check of static states: a body without restraint moves out of all proportion to the model.

use super::NewtonRaphson;
use crate::assembly::{System, runaway_bound};
use crate::model::ModelPart;
use crate::strategies::location::location;

impl NewtonRaphson {
    /// Why a static state is no answer, `begin` being the unknowns at the start of the step: the node that has gone farthest
    /// beyond [`runaway_bound`] and its part. Collective.
    ///
    /// Where a tangent is singular but for round-off, it lets a body go as far as round-off resists.
    pub(super) fn lost_body(&self, part: &ModelPart, system: &System, begin: &[f64]) -> Option<String> {
        if !self.scheme.is_static() {
            return None;
        }
        let runaway_bound = runaway_bound(part, &system.dofs, self.assembler.equations());
        let now = self.assembler.values(part, system);
        let gone = system.dofs.dofs().iter().enumerate().filter(|(n, _)| system.dofs.moves_mesh(*n));
        let gone =
            gone.map(|(n, dof)| ((now[n] - begin[n]).abs(), dof.node)).filter(|(motion, _)| *motion > runaway_bound);
        let farthest = gone.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let said = farthest.map(|(motion, node)| {
            let (id, at) = (part.nodes.ids[node as usize], location(part, node));
            format!(
                "node {id}{at} has moved by {motion:.1e}, beyond the bound {runaway_bound:.1e}: its body is not restrained; support it, or \
                 check that contact restrains it from the first step"
            )
        });
        part.ranks.first_to_say(said)
    }
}
