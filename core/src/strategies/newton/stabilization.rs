//! Contact stabilisation: Newton's iteration of bodies that only contact restrains, before it does.
//!
//! Where the tangent K of a static step is singular and no further contact can be activated, the iteration goes on with K + A (a
//! Levenberg–Marquardt method), A being diagonal over the displacements u of each body b:
//!
//! A_n = min(Σ_b |r|, F_b) / (N_b d) + min(ε |K_nn|, 0.05 F_b / (N_b d)),
//!
//! with the residual r, the load F_b of the body (its resultant, or the sum of |f| over the forces f of its conditions where that is
//! more), the number N_b of these unknowns, a length d and ε = 1e-8. A body that nothing restrains so moves
//! by about d an iteration in the direction of its load until contact meets it, and by more once it has met nothing for some. Only the tangent is changed: the converged state obeys
//! the equations of the step, and A does no work. As A vanishes with r, the iteration converges superlinearly once contact holds.
//! Where the responses of the interface can be computed, its states are decided on together in each iteration
//! ([`super::joint_decision`]): K + A is regular, so that the complementarity problem has one solution.

use super::NewtonRaphson;
use crate::assembly::{System, runaway_bound};
use crate::diagnostics::Result;
use crate::model::{ModelPart, NumberedBodies, StepMark};
use crate::strategies::dof_name::DofName;
use crate::strategies::linear_solve::{Failed, Solved};
use crate::strategies::records::IterationRecord;
use crate::vector3::norm;

/// Mark of the step data: bodies are there that supports leave free, and contact restrains them all.
pub(crate) const ONLY_CONTACT_RESTRAINS: StepMark = StepMark::new("ONLY_CONTACT_RESTRAINS");

/// Share of the diagonal entries that is added to them in any case: motions without load stay where they are.
const LEAST: f64 = 1e-8;
/// Share of the first amount that this exceeds only where the amount is round-off: small loads move stiff bodies, too.
const SLOWING: f64 = 0.05;
/// Share of the diagonal entries that is round-off.
const ROUND_OFF: f64 = 1e-13;

/// Iterations in which a body moves on freely before nothing is taken to stop it, and relative change of the residual meanwhile.
const FREE: usize = 20;
const STEADY: f64 = 0.01;
/// Iterations of free motion after which the length doubles in each, and its largest factor.
const SLOW: usize = 5;
const FASTEST: f64 = 8.0;

/// Contact stabilisation of a step.
pub(super) struct Stabilization {
    /// Length that a body moves by in an iteration.
    length: f64,
    /// Load of each body; none before the first solve.
    loads: Vec<f64>,
    /// Amount for the diagonal entry of each unknown, and that under the whole load; `None` where it is no displacement of a body.
    amounts: Vec<Option<[f64; 2]>>,
}

impl NewtonRaphson {
    /// Why a solve shows that a body is not restrained; collective.
    pub(super) fn unrestrained(
        &self,
        solved: &std::result::Result<Solved, Failed>,
        part: &ModelPart,
        system: &System,
    ) -> Option<String> {
        match solved {
            Err(Failed::Singular(why, free)) => part.ranks.any(!free.is_empty()).then(|| why.clone()),
            Err(_) => None,
            Ok(solved) => {
                let bound = runaway_bound(part, &system.dofs, self.assembler.equations());
                let increment = self.assembler.equations().expand(&solved.increment);
                let gone = (0..increment.len()).find(|&n| system.dofs.moves_mesh(n) && increment[n].abs() > bound);
                let said = gone.map(|n| {
                    let unknown = DofName::of(&system.dofs, &part.nodes, n as u32);
                    format!(
                        "the system of equations is nearly singular: {unknown} would change by {:.1e}",
                        increment[n]
                    )
                });
                part.ranks.first_to_say(said)
            }
        }
    }

    /// The least length of contact stabilisation that an interaction states; `None` where inertia restrains bodies, or contact does
    /// not. Collective.
    pub(super) fn find_stabilization_length(&self, part: &ModelPart, system: &mut System) -> Option<f64> {
        if !part.info.has(ONLY_CONTACT_RESTRAINS)
            || !self.settings.contact_stabilization
            || !self.scheme.is_static()
            || self.settings.linear
        {
            return None;
        }
        let sets = system.interactions.iter_mut().filter_map(|interaction| interaction.active_set());
        sets.filter_map(|set| set.stabilization_length(part)).reduce(f64::min).filter(|length| *length > 0.0)
    }

    /// Contact stabilisation of the step, where it may be stabilised.
    pub(super) fn stabilization(&self) -> Option<Stabilization> {
        self.stabilization_length.map(|length| Stabilization { length, loads: Vec::new(), amounts: Vec::new() })
    }

    /// Adds A to the tangent; `residual` over all unknowns, `records` of the step's iterations so far. Collective.
    ///
    /// # Errors
    /// A load that cannot be computed.
    pub(super) fn stabilize(
        &mut self,
        own: &mut Stabilization,
        part: &ModelPart,
        system: &System,
        residual: &[f64],
        records: &[IterationRecord],
    ) -> Result<()> {
        let length = own.length * 2.0_f64.powi(free_iterations(records).saturating_sub(SLOW) as i32).min(FASTEST);
        let bodies = self.bodies.get_or_insert_with(|| NumberedBodies::of(part));
        let dofs = system.dofs.dofs();
        let body_of = |n: usize| {
            let own = system.dofs.moves_mesh(n) && self.assembler.counts(n);
            bodies.of_node[dofs[n].node as usize].filter(|_| own)
        };
        let body_of: Vec<Option<usize>> = (0..dofs.len()).map(body_of).collect();
        let of_bodies = || body_of.iter().enumerate().filter_map(|(n, body)| Some((n, (*body)?)));
        if own.loads.is_empty() {
            let (loads, bulk) = (self.assembler.loads(part, system)?, self.assembler.bulk_residual(part, system)?);
            let mut sums = vec![[0.0; 4]; bodies.first.len()];
            for (n, body) in of_bodies() {
                sums[body][dofs[n].variable.offset()] += bulk[n];
                sums[body][3] += loads[n].abs();
            }
            part.ranks.sum(sums.as_flattened_mut());
            own.loads = sums.into_iter().map(|[x, y, z, sizes]| norm([x, y, z]).max(sizes)).collect();
        }
        let equations = self.assembler.equations();
        let balanced = equations.balanced(residual);
        let mut sums = vec![[0.0; 2]; bodies.first.len()];
        for (n, body) in of_bodies().filter(|(n, _)| equations.is_free(*n)) {
            sums[body] = [sums[body][0] + balanced[n].abs(), sums[body][1] + 1.0];
        }
        part.ranks.sum(sums.as_flattened_mut());
        let amount = |body: usize| {
            let ([residual, count], load) = (sums[body], own.loads[body]);
            [load.min(residual), load].map(|force| force / (count.max(1.0) * length))
        };
        own.amounts =
            body_of.iter().enumerate().map(|(n, body)| body.filter(|_| equations.is_free(n)).map(amount)).collect();
        self.add(own);
        Ok(())
    }

    /// Adds the amounts found last to the tangent.
    pub(super) fn add(&mut self, own: &Stabilization) {
        let added = |[amount, whole]: [f64; 2], entry: f64| {
            let most = if whole > 0.0 { (SLOWING * whole).max(ROUND_OFF * entry) } else { f64::INFINITY };
            amount + most.min(LEAST * entry)
        };
        self.assembler.add_to_diagonal(&|n, entry| own.amounts[n].map_or(0.0, |amounts| added(amounts, entry)));
    }
}

/// Whether a body moved on freely at the end of a stabilised step.
pub(super) fn moves_freely(records: &[IterationRecord]) -> bool {
    free_iterations(records) >= FREE
}

/// The last iterations in which a body moved on freely: no state changed, and neither did the residual.
fn free_iterations(records: &[IterationRecord]) -> usize {
    let Some(last) = records.last().and_then(|last| last.checks.first()).filter(|last| !last.converged) else {
        return 0;
    };
    let alike = |own: &&IterationRecord| {
        let same = own.checks.first().is_some_and(|check| (check.ratio - last.ratio).abs() <= STEADY * last.ratio);
        own.active_set_changes == 0 && same
    };
    records.iter().rev().take_while(alike).count()
}
