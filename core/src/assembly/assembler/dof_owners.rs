//! The nodes that carry the unknowns of elements and conditions.

use crate::assembly::System;
use crate::model::{DofOwners, Halo, ModelPart, Named, ScalarVariable, named};

/// The nodes that carry each unknown of the blocks of any rank, in the order of the variables; collective.
pub(super) fn dof_owners_of_blocks(part: &ModelPart, system: &System) -> Vec<DofOwners> {
    let mut carriers: Vec<DofOwners> = Vec::new();
    for block in system.elements.iter().chain(&system.conditions) {
        for unknown in block.unknowns() {
            let nodes = (0..block.len()).map(|at| block.nodes(at)[unknown.node as usize]);
            match carriers.iter_mut().find(|known| known.variable == unknown.variable) {
                Some(known) => known.nodes.extend(nodes),
                None => carriers.push(DofOwners::of_nodes(unknown.variable, nodes.collect())),
            }
        }
    }
    if let Some(share) = &part.share {
        carriers = dof_owners_of_all(carriers, part.nodes.len(), &share.halo);
    }
    carriers.sort_by_key(|own| own.variable);
    carriers
}

/// The nodes that carry each unknown on any rank; collective.
fn dof_owners_of_all(own: Vec<DofOwners>, nodes: usize, halo: &Halo) -> Vec<DofOwners> {
    let names: Vec<String> = own.iter().map(|own| own.variable.to_string()).collect();
    let mut all: Vec<String> = halo
        .ranks
        .gather_bytes(names.join("\n").as_bytes())
        .iter()
        .flat_map(|text| String::from_utf8_lossy(text).lines().map(str::to_owned).collect::<Vec<_>>())
        .collect();
    all.sort_unstable();
    all.dedup();
    let scalar = |name: &String| match named(name).expect("unknowns are registered variables") {
        Named::Component(scalar) => scalar,
        Named::Whole(column, _) => ScalarVariable { column, component: None },
    };
    all.iter()
        .map(scalar)
        .map(|variable| {
            let mut carries = vec![0.0; nodes];
            let mine = own.iter().filter(|known| known.variable == variable).flat_map(|known| &known.nodes);
            mine.for_each(|&node| carries[node as usize] = 1.0);
            halo.sum(&mut carries);
            let list = (0..nodes as u32).filter(|&node| carries[node as usize] > 0.0).collect();
            DofOwners::of_nodes(variable, list)
        })
        .collect()
}
