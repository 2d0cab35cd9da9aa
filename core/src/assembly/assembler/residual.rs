//! The residual of a step: external minus internal forces, with those of inertia and of interactions.

use std::time::Instant;

use super::Assembler;
use super::inertia::Inertia;
use crate::assembly::System;
use crate::assembly::bulk_matrix::add_residual;
use crate::diagnostics::Result;
use crate::entities::{Request, Tangent};
use crate::model::ModelPart;

impl Assembler {
    /// External minus internal forces over all unknowns; at supports, minus the reaction.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn residual(&mut self, part: &ModelPart, system: &System, inertia: Option<&Inertia>) -> Result<Vec<f64>> {
        let own = self.own_residual(part, system, inertia);
        let start = Instant::now();
        let mut rhs = part.ranks.agree(own)?;
        self.parallel.sum(&mut rhs);
        self.seconds.residual += start.elapsed().as_secs_f64();
        Ok(rhs)
    }

    /// The residual of elements and conditions alone, without inertia and interactions: summed over a body, its loads. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn bulk_residual(&mut self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let mut out = part.ranks.agree(self.own_bulk_residual(part, system))?;
        self.parallel.sum(&mut out);
        Ok(out)
    }

    /// As [`Assembler::residual`], where blocks of interactions may be others than those of the matrix, which stays. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn residual_beside(
        &mut self,
        part: &ModelPart,
        system: &System,
        inertia: Option<&Inertia>,
    ) -> Result<Vec<f64>> {
        if self.coupling.is_present(system) {
            return self.residual(part, system, inertia);
        }
        let kept = self.coupling.replace_pairs(part, system);
        let found = self.residual(part, system, inertia);
        self.coupling.put_back(kept);
        found
    }

    /// The share of this rank's entities in the residual.
    fn own_residual(&mut self, part: &ModelPart, system: &System, inertia: Option<&Inertia>) -> Result<Vec<f64>> {
        let start = Instant::now();
        let mut rhs = self.own_bulk_residual(part, system)?;
        if let Some(inertia) = inertia {
            let forces = self.own_inertia_forces(part, system, inertia)?;
            rhs.iter_mut().zip(forces).for_each(|(r, force)| *r -= force);
        }
        self.coupling.add_residual(system, &part.view(), &mut rhs)?;
        self.seconds.residual += start.elapsed().as_secs_f64();
        Ok(rhs)
    }

    fn own_bulk_residual(&mut self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        self.ensure_constant(part, system)?;
        let view = part.view();
        let mut rhs = vec![0.0; system.dofs.len()];
        let values = self.values(part, system);
        if system.elements.iter().chain(&system.conditions).any(|b| b.tangent() == Tangent::Constant) {
            self.bulk.mul_subtract(self.bulk.constant(), &values, &mut rhs);
        }
        for (block, numbers) in self.bulk.blocks(system) {
            match block.tangent() {
                Tangent::Constant if block.has_external(&view) => {
                    add_residual(block, numbers, &view, Request::External, &mut rhs)?;
                }
                Tangent::Constant => {}
                _ => add_residual(block, numbers, &view, Request::Residual, &mut rhs)?,
            }
        }
        Ok(rhs)
    }

    /// Forces of the conditions alone: the loads, over all unknowns.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn loads(&self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let mut out = part.ranks.agree(self.own_loads(part, system))?;
        self.parallel.sum(&mut out);
        Ok(out)
    }

    fn own_loads(&self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let view = part.view();
        let mut out = vec![0.0; system.dofs.len()];
        for (block, numbers) in self.bulk.conditions(system) {
            add_residual(block, numbers, &view, Request::Residual, &mut out)?;
        }
        Ok(out)
    }

    /// Subtracts (all tangents) · `increment` from `rhs`, both over all unknowns.
    pub fn subtract_product(&self, increment: &[f64], rhs: &mut [f64]) {
        let subtract = |rhs: &mut [f64]| {
            if let Some(bulk) = self.bulk.entries_in_use() {
                self.bulk.mul_subtract(bulk, increment, rhs);
            }
            self.loads.matrix().mul_vec_subtract(increment, rhs);
            self.coupling.matrix().mul_vec_subtract(increment, rhs);
        };
        if self.parallel.distribution().is_none() {
            return subtract(rhs);
        }
        let mut product = vec![0.0; rhs.len()];
        subtract(&mut product);
        self.parallel.sum(&mut product);
        rhs.iter_mut().zip(product).for_each(|(sum, value)| *sum += value);
    }

    /// Entries of the interactions' tangent in the row of an unknown, with the unknowns they belong to.
    pub fn coupling_row(&self, number: u32) -> impl Iterator<Item = (u32, f64)> + '_ {
        let (columns, values) = self.coupling.matrix().row(number as usize);
        columns.iter().copied().zip(values.iter().copied())
    }

    /// Forces of inertia and damping over all unknowns, M a + C v less the forces carried over; collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn inertia_forces(&mut self, part: &ModelPart, system: &System, inertia: &Inertia) -> Result<Vec<f64>> {
        let own = self.own_inertia_forces(part, system, inertia);
        let mut out = part.ranks.agree(own)?;
        self.parallel.sum(&mut out);
        Ok(out)
    }

    /// Inertia and damping of this rank's entities, over all unknowns.
    pub(super) fn own_inertia_forces(
        &mut self,
        part: &ModelPart,
        system: &System,
        inertia: &Inertia,
    ) -> Result<Vec<f64>> {
        self.ensure_constant(part, system)?;
        self.inertia.forces(&self.bulk, part, system, inertia, |number| self.parallel.counts(number))
    }
}
