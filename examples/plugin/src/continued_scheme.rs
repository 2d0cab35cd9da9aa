//! A static scheme whose steps begin where the last one would have led, and a solver that takes it.

use serde::{Deserialize, Serialize};
use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::assembly::DofTable;
use zelus_core::model::ModelPart;
use zelus_core::strategies::{Scheme, SchemeEntry, SchemeFactory};
use zelus_core::{Result, State, StateMapper, register};

#[derive(Clone, Serialize, Deserialize)]
struct Continued {
    /// Unknowns at the start of the last step.
    before: Vec<f64>,
}

#[typetag::serde(name = "continued")]
impl State for Continued {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        mapper.by_unknown(&mut self.before);
    }
}

impl Scheme for Continued {
    fn is_static(&self) -> bool {
        true
    }

    fn predict(&mut self, part: &mut ModelPart, dofs: &DofTable) -> Result<()> {
        let now = dofs.gather(part, 0);
        let guess = |at: usize| if self.before.len() == now.len() { now[at] - self.before[at] } else { 0.0 };
        let free = |at: usize| !part.nodes.is_fixed(dofs.dofs()[at].variable, dofs.dofs()[at].node);
        let more: Vec<f64> = (0..now.len()).map(|at| if free(at) { guess(at) } else { 0.0 }).collect();
        dofs.scatter_add(&more, part);
        self.before = now;
        Ok(())
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(self.clone()))
    }

    fn resume(&mut self, state: Box<dyn State>) -> Result<()> {
        *self = state.take()?;
        Ok(())
    }
}

register! { SchemeEntry "continued",
    about: "no inertia; a step begins with the increment of the last one",
    build: SchemeFactory::Implicit(|_| Ok(Box::new(Continued { before: Vec::new() }))),
}
register! { SolverEntry "Continued",
    about: "equilibrium at each time, by the scheme \"continued\"",
    defaults: zelus::structural_mechanics::solvers::STATIC_DEFAULTS,
    build: SolverDefinition {
        variables: &zelus::structural_mechanics::solvers::VARIABLES,
        scheme: |_| Ok("continued".to_owned()),
        adapt: zelus::structural_mechanics::solvers::adapt,
        ..SolverDefinition::PLAIN
    },
}
