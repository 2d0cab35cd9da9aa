//! Constraints that a process adds and ends.

use std::ops::Range;

use zelus_core::model::{MasterSlaveConstraint, ModelPart, NodeUnknown};
use zelus_core::processes::Target;

/// A constraint with the weight of each master, and the share of the slave's force that the master takes.
pub(super) fn passing_on(
    slave: NodeUnknown,
    terms: Vec<(NodeUnknown, [f64; 2])>,
    constant: f64,
) -> MasterSlaveConstraint {
    let differ = terms.iter().any(|(_, [weight, force])| weight != force);
    let forces = differ.then(|| terms.iter().map(|(_, [_, force])| *force).collect());
    let masters = terms.into_iter().map(|(master, [weight, _])| (master, weight)).collect();
    MasterSlaveConstraint { forces, constant, ..MasterSlaveConstraint::new(slave, masters) }
}

/// Adds the constraints of a process, whose messages name it and its part; gives their places.
pub(super) fn couple(part: &mut ModelPart, target: &Target, new: Vec<MasterSlaveConstraint>) -> Range<usize> {
    let origin = format!("{} on {}", target.process, target.path);
    part.add_constraints(new.into_iter().map(|own| MasterSlaveConstraint { origin: origin.clone(), ..own }))
}

/// Ends a coupling: later stages have couplings of their own.
pub(super) fn uncouple(part: &mut ModelPart, made: &Range<usize>) {
    part.constraints[made.clone()].iter_mut().for_each(|constraint| constraint.active = false);
}
