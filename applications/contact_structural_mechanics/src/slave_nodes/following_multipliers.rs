//! Multipliers of slave nodes whose displacement follows that of another, as on the sides of a cyclic sector.
//!
//! Where u_s = R u_m joins two slave nodes of a patch, their conditions are one in two parts: λ_s = R λ_m, and the constraint adds up their
//! rows. Two multipliers of their own would be redundant.

use std::collections::{BTreeMap, BTreeSet};

use zelus_core::model::{MasterSlaveConstraint, ModelPart, NodeUnknown, ScalarVariable};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use crate::interface::Patches;
use crate::law::Multiplier;

/// Name of these constraints in messages.
const ORIGIN: &str = "multipliers of nodes that follow others";

/// The constraints that join displacements of mesh nodes, by the unknown that they eliminate.
fn of_displacements(part: &ModelPart) -> BTreeMap<NodeUnknown, &MasterSlaveConstraint> {
    let joins = |own: &&MasterSlaveConstraint| own.active && own.set.is_none() && own.support.is_none();
    part.constraints.iter().filter(joins).map(|own| (own.slave, own)).collect()
}

/// The node that a node follows in all components, none but itself having to do with it.
fn leader<'c>(
    of: &BTreeMap<NodeUnknown, &'c MasterSlaveConstraint>,
    node: u32,
    space: usize,
) -> Option<(u32, Vec<&'c MasterSlaveConstraint>)> {
    let own: Vec<&MasterSlaveConstraint> =
        (0..space as u8).map(|c| of.get(&(node, DISPLACEMENT.component(c))).copied()).collect::<Option<_>>()?;
    let leader = own.first()?.masters.first()?.0.0;
    let follows =
        |&((master, variable), _): &(NodeUnknown, f64)| master == leader && variable.column == DISPLACEMENT.name();
    let alone = own.iter().all(|own| !own.masters.is_empty() && own.masters.iter().all(follows));
    (alone && leader != node).then_some((leader, own))
}

/// Constrains the multipliers of the slave nodes of patches, which form the sets of these names.
pub(super) fn constrain(part: &mut ModelPart, patches: &Patches, names: &[String], multiplier: Multiplier) {
    let space = part.info.domain_size;
    let mut new = Vec::new();
    {
        let of = of_displacements(part);
        for patch in
            (0..patches.count()).map(|patch| patch as u32).filter(|_| multiplier.is_unknown() && !of.is_empty())
        {
            let nodes = patches.nodes_of(patch);
            for &node in &nodes {
                let Some((leader, own)) = leader(&of, node, space) else { continue };
                if nodes.binary_search(&leader).is_err() {
                    continue;
                }
                let follows = |unknown: ScalarVariable, terms: Vec<(ScalarVariable, f64)>| MasterSlaveConstraint {
                    set: Some(names[patch as usize].clone()),
                    origin: ORIGIN.to_owned(),
                    ..MasterSlaveConstraint::new(
                        (node, unknown),
                        terms.into_iter().map(|(variable, weight)| ((leader, variable), weight)).collect(),
                    )
                };
                match multiplier {
                    Multiplier::Scalar(variable) => {
                        new.push(follows(variable.scalar(), vec![(variable.scalar(), 1.0)]));
                    }
                    Multiplier::Vector(variable) => new.extend(own.iter().enumerate().map(|(c, own)| {
                        let term =
                            |&((_, of), weight): &(NodeUnknown, f64)| (variable.component(of.offset() as u8), weight);
                        follows(variable.component(c as u8), own.masters.iter().map(term).collect())
                    })),
                    Multiplier::None | Multiplier::Body => {}
                }
            }
        }
    }
    let known: BTreeSet<(Option<String>, NodeUnknown)> =
        part.constraints.iter().filter(|own| own.set.is_some()).map(|own| (own.set.clone(), own.slave)).collect();
    new.retain(|own| !known.contains(&(own.set.clone(), own.slave)));
    if !new.is_empty() {
        part.add_constraints(new);
    }
}
