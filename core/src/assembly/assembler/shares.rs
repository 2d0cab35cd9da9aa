//! Parts of a residual: the forces of loads, and the forces that interactions exchange.

use super::Assembler;
use super::coupling_tangent::blocks_of;
use crate::assembly::System;
use crate::assembly::bulk_matrix::add_residual;
use crate::diagnostics::Result;
use crate::entities::{Request, Tangent};
use crate::model::ModelPart;

/// Force of an entity between two bodies on one unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairForce {
    /// Place of the interaction.
    pub interaction: usize,
    /// Place of the pair among its pairs.
    pub pair: usize,
    /// Whether the node is on the second side.
    pub second: bool,
    /// Number of the unknown.
    pub number: u32,
    /// The force.
    pub force: f64,
}

impl Assembler {
    /// External forces of elements and conditions, over all unknowns; collective.
    ///
    /// Loads that depend on the state count as they are; of conditions with a constant tangent, as springs, only the loads that they
    /// state apart.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn external_forces(&self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let mut out = part.ranks.agree(self.own_external_forces(part, system))?;
        self.parallel.sum(&mut out);
        Ok(out)
    }

    fn own_external_forces(&self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let view = part.view();
        let mut out = vec![0.0; system.dofs.len()];
        for (block, numbers) in self.bulk.elements(system).filter(|of| of.0.has_external(&view)) {
            add_residual(block, numbers, &view, Request::External, &mut out)?;
        }
        for (block, numbers) in self.bulk.conditions(system) {
            match block.tangent() {
                Tangent::Constant if block.has_external(&view) => {
                    add_residual(block, numbers, &view, Request::External, &mut out)?;
                }
                Tangent::Constant => {}
                _ => add_residual(block, numbers, &view, Request::Residual, &mut out)?,
            }
        }
        Ok(out)
    }

    /// Minus the storage of elements by their own equations, over all unknowns; collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn storage(&self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let mut out = vec![0.0; system.dofs.len()];
        let view = part.view();
        let mut stores = self.bulk.elements(system).filter(|(block, _)| block.has_storage());
        let own =
            stores.try_for_each(|(block, numbers)| add_residual(block, numbers, &view, Request::Storage, &mut out));
        part.ranks.agree(own.map_err(Into::into))?;
        self.parallel.sum(&mut out);
        Ok(out)
    }

    /// Forces of interactions over all unknowns; `push` is called with those between pairs of bodies, those of this rank. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn exchanged(&self, part: &ModelPart, system: &System, push: impl FnMut(PairForce)) -> Result<Vec<f64>> {
        let mut out = part.ranks.agree(self.own_exchanged(part, system, push))?;
        self.parallel.sum(&mut out);
        Ok(out)
    }

    fn own_exchanged(&self, part: &ModelPart, system: &System, mut push: impl FnMut(PairForce)) -> Result<Vec<f64>> {
        let mut out = vec![0.0; system.dofs.len()];
        // Of each block: the interaction it is of, and its place there.
        let owners = system.interactions.iter().enumerate().filter_map(|(at, own)| Some((at, own.coupling()?)));
        let places = owners.flat_map(|(at, own)| (0..own.blocks().len()).map(move |block| (at, own, block)));
        let places: Vec<_> = places.collect();
        let blocks = blocks_of(system);
        self.coupling.each_residual(&blocks, &part.view(), |block, at, numbers, local| {
            let (interaction, own, place) = places[block];
            let pair = own.pair_of(place, at);
            let unknowns = blocks[block].unknowns();
            for ((&number, &force), unknown) in numbers.iter().zip(local).zip(unknowns) {
                out[number as usize] += force;
                if let Some((pair, nodes)) = &pair {
                    let second = nodes.contains(&usize::from(unknown.node));
                    push(PairForce { interaction, pair: *pair, second, number, force });
                }
            }
        })?;
        Ok(out)
    }
}
