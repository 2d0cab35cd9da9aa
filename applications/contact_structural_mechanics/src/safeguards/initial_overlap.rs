//! Slave nodes that begin inside or off their masters.

use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::{ModelPart, bodies_of_nodes};

use crate::interface::{Interface, notes_of_bodies};
use crate::results::{PartsOfPairs, name};
use crate::search::settle;
use crate::solver::ContactSolverSettings;

/// Before the first step: moves slave nodes onto their masters where the deck asks for it, or tells which lie inside them; and says
/// whether any does.
pub(crate) fn settle_all(
    part: &mut ModelPart,
    interfaces: &[Interface],
    parts: PartsOfPairs<'_>,
    solver: &ContactSolverSettings,
) -> (Vec<Diagnostic>, bool) {
    let (tolerance, refuses) = (solver.adjust_tolerance, solver.largest_penetration > 0.0);
    let mut out = notes_of_bodies(part, parts.0);
    let bodies = bodies_of_nodes(part);
    let mut overlaps = false;
    for of in interfaces {
        let settled = settle(part, of, &bodies, &name(&of.key, parts), tolerance, refuses);
        out.extend(settled.message);
        overlaps |= settled.overlaps;
    }
    (out, overlaps)
}
