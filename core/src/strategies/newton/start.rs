//! Start of a step of Newton's iteration: the positions of prescribed unknowns, and the use of the first iterate.

use super::NewtonRaphson;
use crate::assembly::{System, impose_constraints};
use crate::diagnostics::Result;
use crate::entities::{EntityBlock, MasslessNodes};
use crate::model::{MasterSlaveConstraint, ModelPart};
use crate::strategies::strategy::after_prediction;

impl NewtonRaphson {
    /// Takes the mass off the nodes that interactions name.
    ///
    /// Not where elements yield: without mass a node follows in balance, and at the limit of its material there is none.
    pub(super) fn redistribute_mass(&mut self, part: &mut ModelPart, system: &mut System) -> Result<()> {
        let mut nodes = MasslessNodes::default();
        for massless in system.interactions.iter_mut().filter_map(|interaction| interaction.massless()) {
            massless.begin_dynamic_step(part);
            let own = massless.massless_nodes();
            nodes.surface.extend(own.surface);
            nodes.near.extend(own.near);
        }
        let yielding = if nodes.surface.is_empty() { Vec::new() } else { yielding(system) };
        for list in [&mut nodes.surface, &mut nodes.near] {
            list.sort_unstable();
            list.dedup();
            list.retain(|node| yielding.binary_search(node).is_err());
        }
        self.assembler.redistribute(part, system, &nodes)?;
        if let Some(forces) = self.scheme.kept() {
            self.assembler.redistribute_forces(forces);
        }
        Ok(())
    }

    /// Moves free unknowns to the prediction and gives the increments of prescribed and constrained ones, which are
    /// left at their old values: the first solve takes them on through the tangent.
    ///
    /// With nodes that move first they stay at their new values instead, ahead of the mesh, which follows at those nodes only.
    pub(in crate::strategies) fn start(
        &mut self,
        part: &mut ModelPart,
        system: &System,
        moved_first: Option<&[u32]>,
    ) -> Result<Vec<f64>> {
        let targets = self.assembler.values(part, system);
        if let Some(nodes) = moved_first {
            nodes.iter().for_each(|&node| part.nodes.follow(node as usize));
            return Ok(vec![0.0; targets.len()]);
        }
        if self.scheme.begins_at_prescribed() {
            self.scheme.predict(part, &system.dofs)?;
            impose_constraints(part);
            self.scheme.update(part);
            return Ok(vec![0.0; targets.len()]);
        }
        for (number, dof) in system.dofs.dofs().iter().enumerate() {
            if self.assembler.equations().is_fixed(number) {
                dof.step_back(part);
            }
        }
        self.scheme.predict(part, &system.dofs)?;
        let start = self.assembler.values(part, system);
        let increment: Vec<f64> = targets.iter().zip(&start).map(|(target, value)| target - value).collect();
        let increment = self.followed(part, system, &increment);
        self.scheme.update(part);
        if self.settings.move_mesh {
            part.nodes.move_all();
        }
        Ok(increment)
    }

    /// Moves free unknowns back to where the step began: the prediction led to no state that can be computed.
    pub(super) fn stay(&self, part: &mut ModelPart, system: &System) {
        let (now, old) = (self.assembler.values(part, system), system.dofs.gather(part, 1));
        let equations = self.assembler.equations();
        let back: Vec<f64> = (0..now.len()).map(|n| if equations.is_free(n) { old[n] - now[n] } else { 0.0 }).collect();
        system.dofs.scatter_add(&back, part);
        self.scheme.update(part);
        if self.settings.move_mesh {
            part.nodes.move_all();
        }
    }

    /// The nodes at which the mesh follows prescribed values at once, because the first iterate of the step decides on the
    /// answer; `None` where the step begins as others do.
    ///
    /// Not so after a failed attempt, since elements may turn inside out that way.
    pub(super) fn moved_first(&self, part: &ModelPart, system: &mut System) -> Option<Vec<u32>> {
        let free = !self.failed
            && self.settings.move_mesh
            && !part.constraints.iter().any(|c| c.active && !self.is_multiplier(part, system, c));
        if !free || !self.scheme.is_static() {
            return None;
        }
        system.interactions.iter_mut().filter_map(|i| i.first_iterate()).find_map(|first| first.moved_first())
    }

    fn is_multiplier(&self, part: &ModelPart, system: &System, constraint: &MasterSlaveConstraint) -> bool {
        let (node, variable) = constraint.slave;
        let owner = part.slave_nodes.owner(constraint.set.as_deref(), node);
        let number = owner.and_then(|owner| system.dofs.number_of(variable, owner));
        number.is_some_and(|number| system.dofs.dofs()[number as usize].multiplier)
    }

    /// Whether forces are farther out of balance after the first iteration than before it, in a step that prescribes motion.
    pub(super) fn overshoots(&mut self, part: &ModelPart, system: &System, before: &[f64]) -> Result<bool> {
        let (now, old) = (self.assembler.values(part, system), system.dofs.gather(part, 1));
        let moves = (0..now.len()).any(|n| self.assembler.equations().is_fixed(n) && now[n] != old[n]);
        if !part.ranks.any(moves) || self.settings.linear {
            return Ok(false);
        }
        let after = self.assembler.residual(part, system, None)?;
        let after = self.assembler.equations().balanced(&after);
        let [after, before] = [&after[..], before].map(|forces| self.sizes_of_forces(system, forces));
        // Variables in which nothing is out of balance before measure nothing, unless there is no other.
        let is_still = before.iter().all(|size| *size == 0.0);
        Ok(after.iter().zip(&before).any(|(after, before)| (*before > 0.0 || is_still) && after > before))
    }

    /// Goes back to the step's start, `begin` but for prescribed unknowns, and gives the increments of those.
    pub(super) fn begin_again(&mut self, part: &mut ModelPart, system: &mut System, begin: &[f64]) -> Result<Vec<f64>> {
        let now = self.assembler.values(part, system);
        let fixed = |n: usize| self.assembler.equations().is_fixed(n);
        let back: Vec<f64> = (0..now.len()).map(|n| if fixed(n) { 0.0 } else { begin[n] - now[n] }).collect();
        system.dofs.scatter_add(&back, part);
        let prescribed = self.start(part, system, None)?;
        after_prediction(part, &mut system.interactions)?;
        Ok(prescribed)
    }

    /// The increments of prescribed unknowns, and those of constrained ones that follow.
    pub(super) fn followed(&self, part: &mut ModelPart, system: &System, prescribed: &[f64]) -> Vec<f64> {
        let fixed = |(n, d): (usize, &f64)| if self.assembler.equations().is_fixed(n) { *d } else { 0.0 };
        let mut increment: Vec<f64> = prescribed.iter().enumerate().map(fixed).collect();
        if part.constraints.iter().any(|c| c.active) {
            system.dofs.scatter_add(&increment, part);
            let lack = self.constraint_increment(part, system);
            let back: Vec<f64> = increment.iter().map(|d| -d).collect();
            system.dofs.scatter_add(&back, part);
            increment.iter_mut().zip(lack).for_each(|(sum, d)| *sum += d);
        }
        increment
    }

    /// Increment with which constrained unknowns obey their constraints at the present values of the others.
    pub(super) fn constraint_increment(&self, part: &mut ModelPart, system: &System) -> Vec<f64> {
        let before = self.assembler.values(part, system);
        impose_constraints(part);
        let lack: Vec<f64> =
            self.assembler.values(part, system).iter().zip(&before).map(|(after, b)| after - b).collect();
        let back: Vec<f64> = lack.iter().map(|d| -d).collect();
        system.dofs.scatter_add(&back, part);
        lack
    }
}

/// Nodes of elements with a history, ascending.
fn yielding(system: &System) -> Vec<u32> {
    let of_block = |block: &dyn EntityBlock| {
        let own = (0..block.len()).filter(|&at| block.has_history(at));
        own.flat_map(|at| block.nodes(at).to_vec()).collect::<Vec<u32>>()
    };
    let mut nodes: Vec<u32> = system.elements.iter().flat_map(|block| of_block(block.as_ref())).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}
