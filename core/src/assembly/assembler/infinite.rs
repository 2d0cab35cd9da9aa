//! Who gives forces that are no numbers: asked once the residual holds one.

use super::Assembler;
use super::coupling_tangent::blocks_of;
use crate::assembly::local::{each_of_runs, own_runs};
use crate::assembly::system::System;
use crate::entities::{EntityBlock, Request};
use crate::model::{EntityTable, ModelPart};

impl Assembler {
    /// The first load, element or pair of this rank whose forces are not finite now, in words.
    pub fn first_infinite_entity(&self, part: &ModelPart, system: &System) -> Option<String> {
        let loads = system.conditions.iter().map(|block| (block.as_ref(), Some(&part.conditions)));
        let elements = system.elements.iter().map(|block| (block.as_ref(), Some(&part.elements)));
        let pairs = blocks_of(system).into_iter().map(|block| (block, None));
        loads.chain(elements).chain(pairs).find_map(|(block, table)| first_of(block, table, part))
    }
}

fn first_of(block: &dyn EntityBlock, table: Option<&EntityTable>, part: &ModelPart) -> Option<String> {
    let view = part.view();
    let runs = own_runs(block.len(), |at| block.is_active(at, &view));
    let mut first = None;
    let note = |at: usize, _: &[f64], forces: &[f64]| {
        if first.is_none() && forces.iter().any(|force| !force.is_finite()) {
            first = Some(at);
        }
    };
    // An entity that cannot be computed has said so already.
    each_of_runs(block, &view, &runs, Request::Residual, note).ok()?;
    let at = first?;
    let id = table.map(|table| format!(" {}", table.ids[block.members()[at] as usize])).unwrap_or_default();
    let nodes: Vec<String> = block.nodes(at).iter().map(|&node| part.nodes.ids[node as usize].to_string()).collect();
    Some(format!("{}{id} (nodes {})", block.entry().name, nodes.join(" ")))
}
