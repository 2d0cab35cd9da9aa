//! Constraints that a process adds and ends.

use std::ops::Range;

use zelus_core::model::{MasterSlaveConstraint, ModelPart};
use zelus_core::processes::Target;

/// Adds the constraints of a process, whose messages name it and its part; gives their places.
pub(super) fn couple(part: &mut ModelPart, target: &Target, new: Vec<MasterSlaveConstraint>) -> Range<usize> {
    let origin = format!("{} on {}", target.process, target.path);
    part.add_constraints(new.into_iter().map(|own| MasterSlaveConstraint { origin: origin.clone(), ..own }))
}

/// Ends a coupling: later stages have couplings of their own.
pub(super) fn uncouple(part: &mut ModelPart, made: &Range<usize>) {
    part.constraints[made.clone()].iter_mut().for_each(|constraint| constraint.active = false);
}
