//! The residual of explicit steps by kind of force, each entity evaluated once.

use std::time::Instant;

use super::Assembler;
use super::inertia::Inertia;
use crate::assembly::System;
use crate::assembly::bulk_matrix::add_residual;
use crate::diagnostics::Result;
use crate::entities::{Request, Tangent};
use crate::model::{EntityRole, ModelPart};

/// Forces of this rank's entities over all unknowns, by kind; their sum over kinds and ranks is the residual.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ForceKinds {
    /// External forces of conditions and elements.
    pub loads: Vec<f64>,
    /// Minus the internal forces of elements and of springs to the ground.
    pub elements: Vec<f64>,
    /// Forces of interactions; empty without any.
    pub interactions: Vec<f64>,
    /// Minus the damping forces; empty without damping.
    pub damping: Vec<f64>,
}

impl ForceKinds {
    /// Sum of the kinds.
    fn total(&self) -> Vec<f64> {
        let mut out = self.elements.clone();
        for kind in [&self.loads, &self.interactions, &self.damping] {
            out.iter_mut().zip(kind).for_each(|(sum, force)| *sum += force);
        }
        out
    }
}

impl Assembler {
    /// As [`Assembler::residual`], with the forces that it consists of. `damping` has no acceleration. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn residual_by_kind(
        &mut self,
        part: &ModelPart,
        system: &System,
        damping: Option<&Inertia>,
    ) -> Result<(Vec<f64>, ForceKinds)> {
        let start = Instant::now();
        let own = self.own_force_kinds(part, system, damping);
        let kinds = part.ranks.agree(own)?;
        let mut residual = kinds.total();
        self.parallel.sum(&mut residual);
        self.seconds.residual += start.elapsed().as_secs_f64();
        Ok((residual, kinds))
    }

    fn own_force_kinds(&mut self, part: &ModelPart, system: &System, damping: Option<&Inertia>) -> Result<ForceKinds> {
        self.ensure_constant(part, system)?;
        let view = part.view();
        let size = system.dofs.len();
        let (mut loads, mut elements) = (vec![0.0; size], vec![0.0; size]);
        if system.elements.iter().chain(&system.conditions).any(|block| block.tangent() == Tangent::Constant) {
            self.bulk.mul_subtract(self.bulk.constant(), &self.values(part, system), &mut elements);
        }
        for (block, numbers) in self.bulk.blocks(system) {
            let constant = block.tangent() == Tangent::Constant;
            if !constant && block.entry().role != EntityRole::Element {
                add_residual(block, numbers, &view, Request::Residual, &mut loads)?;
                continue;
            }
            if !constant {
                add_residual(block, numbers, &view, Request::Residual, &mut elements)?;
            }
            if !block.has_external(&view) {
                continue;
            }
            if constant {
                add_residual(block, numbers, &view, Request::External, &mut loads)?;
                continue;
            }
            let mut external = vec![0.0; size];
            add_residual(block, numbers, &view, Request::External, &mut external)?;
            for ((load, element), external) in loads.iter_mut().zip(&mut elements).zip(external) {
                *load += external;
                *element -= external;
            }
        }
        let mut interactions = Vec::new();
        if !system.interactions.is_empty() {
            interactions = vec![0.0; size];
            self.coupling.add_residual(system, &view, &mut interactions)?;
        }
        let damping = damping.map(|inertia| self.own_inertia_forces(part, system, inertia)).transpose()?;
        let damping = damping.map_or(Vec::new(), |forces| forces.into_iter().map(|force| -force).collect());
        Ok(ForceKinds { loads, elements, interactions, damping })
    }
}
