//! Prescribed components of displacement at the nodes of contact surfaces.

use std::collections::BTreeMap;

use zelus_core::model::{ModelPart, NodeUnknown};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::facets::Interface;

/// Mask of prescribed components of a node's displacement, directly or by constraints on prescribed unknowns.
pub type Fixed = [bool; 3];

/// Prescribed components at the nodes of interfaces; free nodes are left out.
pub fn fixed_components(part: &ModelPart, interfaces: &[Interface]) -> BTreeMap<u32, Fixed> {
    let constraints = part.constraints.iter().filter(|c| c.active).map(|c| (c.slave, &c.masters[..])).collect();
    let dimension = part.info.domain_size;
    let fixed = |&node: &u32| -> (u32, Fixed) {
        (
            node,
            std::array::from_fn(|c| {
                c < dimension && is_fixed(part, &constraints, (node, DISPLACEMENT.component(c as u8)), 0)
            }),
        )
    };
    interfaces.iter().flat_map(|i| &i.nodes).map(fixed).filter(|(_, fixed)| fixed.contains(&true)).collect()
}

/// Constraints by the unknown that they eliminate.
type Constraints<'a> = BTreeMap<NodeUnknown, &'a [(NodeUnknown, f64)]>;

fn is_fixed(part: &ModelPart, constraints: &Constraints<'_>, unknown: NodeUnknown, depth: usize) -> bool {
    let (node, variable) = unknown;
    match constraints.get(&unknown) {
        Some(masters) if depth <= constraints.len() => {
            masters.iter().all(|&(master, _)| is_fixed(part, constraints, master, depth + 1))
        }
        _ => part.nodes.is_fixed(variable, node),
    }
}
