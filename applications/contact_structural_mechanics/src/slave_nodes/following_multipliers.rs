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
    if !multiplier.is_unknown() {
        return;
    }
    let space = part.info.domain_size;
    let of = of_displacements(part);
    let mut new = Vec::new();
    for (patch, name) in names.iter().enumerate().filter(|_| !of.is_empty()) {
        let nodes = patches.nodes_of(patch as u32);
        for &node in &nodes {
            let Some((leader, own)) = leader(&of, node, space) else { continue };
            if nodes.binary_search(&leader).is_ok() {
                let joined = MultipliersAtNode { set: name, node, leader };
                new.extend(joined.follow(multiplier, &own));
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

/// A slave node of a set and the one that it follows.
struct MultipliersAtNode<'s> {
    set: &'s str,
    node: u32,
    leader: u32,
}

impl MultipliersAtNode<'_> {
    fn constraint(&self, unknown: ScalarVariable, terms: &[(ScalarVariable, f64)]) -> MasterSlaveConstraint {
        let masters = terms.iter().map(|&(variable, weight)| ((self.leader, variable), weight)).collect();
        MasterSlaveConstraint {
            set: Some(self.set.to_owned()),
            origin: ORIGIN.to_owned(),
            ..MasterSlaveConstraint::new((self.node, unknown), masters)
        }
    }

    /// The constraints of its multiplier, of which those of its displacement components are given.
    fn follow(&self, multiplier: Multiplier, own: &[&MasterSlaveConstraint]) -> Vec<MasterSlaveConstraint> {
        match multiplier {
            Multiplier::Scalar(variable) => vec![self.constraint(variable.scalar(), &[(variable.scalar(), 1.0)])],
            Multiplier::Vector(variable) => {
                let of_component = |(c, own): (usize, &&MasterSlaveConstraint)| {
                    let term =
                        |&((_, of), weight): &(NodeUnknown, f64)| (variable.component(of.offset() as u8), weight);
                    let terms: Vec<(ScalarVariable, f64)> = own.masters.iter().map(term).collect();
                    self.constraint(variable.component(c as u8), &terms)
                };
                own.iter().enumerate().map(of_component).collect()
            }
            Multiplier::None | Multiplier::Body => Vec::new(),
        }
    }
}
