//! Master–slave elimination: g = 0 gives one position as a function of the others, x = T x̄ + g (eqs. D.12a–e).
//!
//! A constraint acts once it is violated and until its force pulls: λ = −f′/(∂g/∂x) of the eliminated position. That
//! force is only the constraint's own as long as no two that act share a position, and no position can be eliminated
//! twice: the price of having no further unknowns.

use zelus_core::assembly::System;
use zelus_core::diagnostics::Result;
use zelus_core::entities::{ActiveSet, Interaction, LocalSystems, Request, Retry, SetChange, StepView};
use zelus_core::model::{MasterSlaveConstraint, Model, ModelPart};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::register;

use crate::constraints::{Constraint, IMPOSED, INTERACTION};
use crate::variables::{CONSTRAINT_MULTIPLIER, CONSTRAINT_VIOLATION, POSITION};

/// A constraint and the position that it eliminates.
struct Elimination {
    constraint: Constraint,
    /// The eliminated position: node and coefficient.
    slave: (u32, f64),
    /// Its place among the constraints of the model part.
    at: usize,
}

/// The constraints of a part, imposed by elimination while they act.
#[derive(Default)]
struct EliminationInteraction {
    conditions: Vec<u32>,
    eliminations: Vec<Elimination>,
    version: u64,
    /// Blocks over the elements, asked for their forces.
    springs: System,
}

/// −f′ at a node: the force of the elements on its position; collective.
fn force(springs: &System, part: &ModelPart, node: u32) -> Result<f64> {
    let own = part.ranks.agree(own_force(springs, &part.view(), node))?;
    Ok(if part.share.is_some() { part.ranks.total(own) } else { own })
}

/// Force of the elements of this rank on the node.
fn own_force(springs: &System, view: &StepView<'_>, node: u32) -> Result<f64> {
    let mut sum = 0.0;
    let mut local = LocalSystems::default();
    for block in &springs.elements {
        for at in (0..block.len()).filter(|&at| block.nodes(at).contains(&node)) {
            local.reset(1, block.unknowns().len(), Request::Residual);
            block.local_systems(view, at..at + 1, Request::Residual, &mut local)?;
            let rows = block.unknowns().iter().zip(&local.rhs);
            sum += rows.filter(|(row, _)| block.nodes(at)[row.node as usize] == node).map(|(_, r)| r).sum::<f64>();
        }
    }
    Ok(sum)
}

impl Interaction for EliminationInteraction {
    fn name(&self) -> &str {
        INTERACTION
    }

    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        part.nodes.history.add(&CONSTRAINT_MULTIPLIER);
        self.springs.make_blocks(part)?;
        for &at in &self.conditions {
            let constraint = Constraint::new(part, at as usize)?;
            let largest = constraint.terms.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            let &slave = largest.expect("a constraint has a position");
            let others = constraint.terms.iter().filter(|term| term.0 != slave.0);
            part.constraints.push(MasterSlaveConstraint {
                id: constraint.id,
                constant: -constraint.constant / slave.1,
                active: false,
                ..MasterSlaveConstraint::new(
                    (slave.0, POSITION.scalar()),
                    others.map(|&(node, a)| ((node, POSITION.scalar()), -a / slave.1)).collect(),
                )
            });
            self.eliminations.push(Elimination { constraint, slave, at: part.constraints.len() - 1 });
        }
        Ok(())
    }

    fn constraints_version(&self) -> u64 {
        self.version
    }

    fn summary(&self, part: &ModelPart) -> Vec<(&'static str, f64)> {
        let active = self.eliminations.iter().filter(|e| part.constraints[e.at].active).count();
        vec![("active constraints", active as f64)]
    }

    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }

    fn retry(&mut self) -> Option<&mut dyn Retry> {
        Some(self)
    }
}

impl ActiveSet for EliminationInteraction {
    fn after_update(&mut self, part: &mut ModelPart, _iteration: usize) -> Result<SetChange> {
        let mut change = SetChange::default();
        for Elimination { constraint, slave, at } in &self.eliminations {
            let node = constraint.node as usize;
            let (gap, round_off) = constraint.gap(&part.nodes);
            let was_active = part.constraints[*at].active;
            let multiplier = if was_active { force(&self.springs, part, slave.0)? / slave.1 } else { 0.0 };
            let is_active = if was_active { multiplier <= 0.0 } else { gap < -round_off };
            match (was_active, is_active) {
                (false, true) => change.activated.push(part.nodes.ids[node]),
                (true, false) => change.deactivated.push(part.nodes.ids[node]),
                _ => {}
            }
            part.constraints[*at].active = is_active;
            part.nodes.history.values_mut(&CONSTRAINT_MULTIPLIER, 0)[node] = constraint.sign * multiplier.min(0.0);
            part.nodes.values.values_mut(&CONSTRAINT_VIOLATION, 0)[node] = (-gap).max(0.0);
        }
        if change.count() > 0 {
            self.version += 1;
        }
        Ok(change)
    }
}

impl Retry for EliminationInteraction {
    fn restore(&mut self) {
        self.version += 1;
    }
}

struct EliminationProcess {
    path: String,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    Ok(Box::new(EliminationProcess { path: super::part_path(&super::settings(request)?, request)? }))
}

impl Process for EliminationProcess {
    fn interaction(&mut self, model: &mut Model) -> Result<Option<(String, Box<dyn Interaction>)>> {
        let conditions = Constraint::imposed(model.root_mut(&self.path)?, &self.path)?;
        let interaction = EliminationInteraction { conditions, ..EliminationInteraction::default() };
        Ok(Some((self.path.clone(), Box::new(interaction))))
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        model.root_mut(&self.path)?.info.marks.remove(IMPOSED);
        Ok(())
    }
}

register! { ProcessEntry "master_slave_elimination_process",
    about: "constraints by elimination of a position each, while they are violated or press",
    source: "eqs. D.12a–e",
    defaults: include_str!("../../../../configs/processes/master_slave_elimination_process.json"),
    build: build,
}
