//! The constraints in the Newton loop: their active set, and the changes of a method between iterates.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::unfit;
use zelus_core::entities::{ActiveSet, Coupling, EntityBlock, Interaction, Retry, SetChange, find_kind};
use zelus_core::model::{DofOwners, EntityRole, ModelPart};
use zelus_core::{Result, State, StateMapper};

use crate::constraint_block::ConstraintBlock;
use crate::constraints::{Constraint, INTERACTION};
use crate::method::{ConstraintState, MULTIPLIERS, Method};
use crate::variables::{CONSTRAINT_MULTIPLIER, CONSTRAINT_PENALTY, CONSTRAINT_VIOLATION};

/// All constraints of one model part under one method.
pub struct ConstraintInteraction<M: Method> {
    conditions: Vec<u32>,
    method: Arc<M>,
    blocks: Vec<ConstraintBlock<M>>,
    saved: Vec<Vec<ConstraintState>>,
}

/// State of the constraints between steps, as it stands in a saved run: by block.
#[derive(Serialize, Deserialize)]
struct SavedConstraints(Vec<Vec<ConstraintState>>);

#[typetag::serde(name = "constraints")]
impl State for SavedConstraints {
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
}

impl<M: Method> ConstraintInteraction<M> {
    /// The interaction of these conditions, which are constraints.
    pub fn new(method: M, conditions: Vec<u32>) -> Self {
        Self { conditions, method: Arc::new(method), blocks: Vec::new(), saved: Vec::new() }
    }

    /// Brings gaps and multipliers of the states up to date and lets `change` act on each; writes the values that criteria and output
    /// read.
    fn update(&mut self, part: &mut ModelPart, mut change: impl FnMut(&M, &Constraint, &mut ConstraintState)) {
        for block in &mut self.blocks {
            let mut states = std::mem::take(&mut block.states);
            for (constraint, state) in block.constraints().iter().zip(&mut states) {
                let node = constraint.node as usize;
                (state.gap, state.round_off) = constraint.gap(&part.nodes);
                if M::MULTIPLIERS > 0 {
                    let value = |variable| part.nodes.history.values(variable, 0)[node];
                    state.multiplier =
                        constraint.sign * MULTIPLIERS[..M::MULTIPLIERS].iter().map(|v| value(v)).sum::<f64>();
                }
                change(&self.method, constraint, state);
                if M::MULTIPLIERS == 0 {
                    part.nodes.history.values_mut(&CONSTRAINT_MULTIPLIER, 0)[node] = constraint.sign * state.multiplier;
                }
                let tension = if state.active { state.multiplier } else { 0.0 };
                let values = &mut part.nodes.values;
                values.values_mut(&CONSTRAINT_VIOLATION, 0)[node] = (-state.gap).max(tension).max(0.0);
                values.values_mut(&CONSTRAINT_PENALTY, 0)[node] = state.penalty;
            }
            block.states = states;
        }
    }
}

impl<M: Method> Interaction for ConstraintInteraction<M> {
    fn name(&self) -> &str {
        INTERACTION
    }

    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        let mut groups: BTreeMap<&'static str, Vec<Constraint>> = BTreeMap::new();
        for &at in &self.conditions {
            let kind = part.conditions.kinds[at as usize].name;
            groups.entry(kind).or_default().push(Constraint::new(part, at as usize)?);
        }
        MULTIPLIERS.iter().take(M::MULTIPLIERS.max(1)).for_each(|variable| part.nodes.history.add(variable));
        self.blocks = groups
            .into_iter()
            .map(|(kind, constraints)| {
                let entry = find_kind(EntityRole::Condition, kind).expect("the name of a registered kind");
                ConstraintBlock::new(entry, constraints, Arc::clone(&self.method))
            })
            .collect();
        Ok(())
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.update(part, |method, _, state| {
            state.previous_gap = state.gap;
            state.penalty = method.penalty();
            state.active = method.may_start_active() && method.is_active(state);
        });
        Ok(())
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(SavedConstraints(self.blocks.iter().map(|block| block.states.clone()).collect())))
    }

    fn resume(&mut self, _part: &mut ModelPart, state: Box<dyn State>) -> Result<()> {
        let SavedConstraints(states) = state.take()?;
        let counts = |block: &ConstraintBlock<M>| block.states.len();
        if !self.blocks.iter().map(counts).eq(states.iter().map(Vec::len)) {
            return Err(unfit("the constraints whose states it remembers are others"));
        }
        self.blocks.iter_mut().zip(states).for_each(|(block, states)| block.states = states);
        Ok(())
    }

    fn summary(&self, _part: &ModelPart) -> Vec<(&'static str, f64)> {
        let active = self.blocks.iter().flat_map(|block| &block.states).filter(|state| state.active).count();
        vec![("active constraints", active as f64)]
    }

    fn coupling(&self) -> Option<&dyn Coupling> {
        Some(self)
    }

    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }

    fn retry(&mut self) -> Option<&mut dyn Retry> {
        Some(self)
    }
}

impl<M: Method> Coupling for ConstraintInteraction<M> {
    fn unknowns(&self, _part: &ModelPart) -> Vec<DofOwners> {
        let nodes: Vec<u32> = self.blocks.iter().flat_map(|b| b.constraints().iter().map(|c| c.node)).collect();
        MULTIPLIERS[..M::MULTIPLIERS]
            .iter()
            .map(|variable| DofOwners::of_nodes(variable.scalar(), nodes.clone()))
            .collect()
    }

    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.blocks.iter().map(|block| block as &dyn EntityBlock).collect()
    }

    fn graph_version(&self) -> u64 {
        0
    }

    fn inactive_diagonal(&self) -> f64 {
        self.method.inactive_diagonal()
    }
}

impl<M: Method> ActiveSet for ConstraintInteraction<M> {
    fn after_update(&mut self, part: &mut ModelPart, _iteration: usize) -> Result<SetChange> {
        let (mut activated, mut deactivated) = (Vec::new(), Vec::new());
        self.update(part, |method, constraint, state| {
            let before = state.active;
            method.update(state);
            state.previous_gap = state.gap;
            state.active = method.is_active(state);
            match (before, state.active) {
                (false, true) => activated.push(constraint.node),
                (true, false) => deactivated.push(constraint.node),
                _ => {}
            }
        });
        let ids = |nodes: Vec<u32>| nodes.into_iter().map(|node| part.nodes.ids[node as usize]).collect();
        Ok(SetChange { activated: ids(activated), deactivated: ids(deactivated), ..SetChange::default() })
    }
}

impl<M: Method> Retry for ConstraintInteraction<M> {
    fn save(&mut self) {
        self.saved = self.blocks.iter().map(|block| block.states.clone()).collect();
    }

    fn restore(&mut self) {
        for (block, states) in self.blocks.iter_mut().zip(&self.saved) {
            block.states.clone_from(states);
        }
    }
}
