//! Responses of conditions of an interaction, by the tangent of a converged state.
//!
//! With K the tangent with the conditions that act, and K̂ that with all of them acting, a condition j that acts is given a unit force
//! e_j on its row, and one that does not a unit multiplier, which pushes by −K̂ e_j:
//!
//! K x_j = e_j, or K x_j = −K̂ e_j (its own row aside) and then x_j ← x_j + e_j.
//!
//! Multiplier i changes by λ_i(x_j), and the residual of its row, were it to act, by −K̂_i x_j. This is the Schur complement of the
//! interface, with the acting conditions exchanged in it.

use super::NewtonRaphson;
use super::stabilization::Stabilization;
use crate::assembly::System;
use crate::diagnostics::Result;
use crate::entities::{Complementary, ComplementaryCondition, OuterLoop, Responses, SetChange};
use crate::model::ModelPart;
use crate::strategies::linear_solve::Failed;

/// Conditions that are decided together at most: each takes a solve, and their table the square of their number.
const MOST: usize = 600;

/// Unknowns with numbers of theirs: shares of a direction, entries of a row.
type SparseVector = Vec<(u32, f64)>;

impl NewtonRaphson {
    /// Lets an interaction, by its place, decide on its conditions together in a converged state; with a line for the log.
    ///
    /// Iterative solvers would take as long for each condition as for an iteration, and on several ranks rows are elsewhere: there
    /// conditions are decided one by one.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub(super) fn decide_together(
        &mut self,
        at: usize,
        stabilization: Option<&Stabilization>,
        part: &mut ModelPart,
        system: &mut System,
    ) -> Result<(OuterLoop, Option<String>)> {
        let Some(conditions) = complementary(system, at).map(|conditions| conditions.conditions(part)) else {
            return Ok((OuterLoop::Done, None));
        };
        let acts: Vec<bool> = conditions.iter().map(|condition| condition.acts).collect();
        let numbers = numbers(system, &conditions);
        let responses = match numbers {
            Some(numbers) if self.keeps_factors(part) && numbers.len() <= MOST => {
                self.responses(at, (&numbers, &acts), stabilization, part, system)?
            }
            _ => None,
        };
        let conditions = complementary(system, at).expect("it has just told its conditions");
        conditions.decide_together(part, responses.as_ref())
    }

    /// In a step with contact stabilisation: decides on the conditions of each interaction together, where their responses can be
    /// computed, by the stabilised tangent.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub(super) fn decide_stabilized(
        &mut self,
        stabilization: &Stabilization,
        part: &mut ModelPart,
        system: &mut System,
    ) -> Result<SetChange> {
        let mut change = SetChange::default();
        for at in 0..system.interactions.len() {
            let Some(conditions) = complementary(system, at).map(|conditions| conditions.conditions(part)) else {
                continue;
            };
            let acts: Vec<bool> = conditions.iter().map(|condition| condition.acts).collect();
            let numbers = numbers(system, &conditions).filter(|own| self.keeps_factors(part) && own.len() <= MOST);
            let responses = match numbers {
                Some(numbers) => self.responses(at, (&numbers, &acts), Some(stabilization), part, system)?,
                None => None,
            };
            let conditions = complementary(system, at).expect("it has just told its conditions");
            conditions.hold(responses.is_some());
            if let Some(responses) = responses {
                change.extend(conditions.decide_states(part, &responses));
            }
        }
        Ok(change)
    }

    /// Whether solves with the last tangent only substitute into its factors, on this rank.
    fn keeps_factors(&self, part: &ModelPart) -> bool {
        let (equations, entries) = (self.assembler.equations().len(), self.assembler.entries());
        part.share.is_none() && self.solver.keeps_factors(equations, entries)
    }

    /// The responses of conditions; `None` where the solver has no answer.
    fn responses(
        &mut self,
        at: usize,
        (numbers, acts): (&[SparseVector], &[bool]),
        stabilization: Option<&Stabilization>,
        part: &mut ModelPart,
        system: &mut System,
    ) -> Result<Option<Responses>> {
        let inertia = self.scheme.inertia(part, &system.dofs);
        complementary(system, at).into_iter().for_each(|conditions| conditions.activate_all());
        let acting = self.residual(part, system).and_then(|residual| {
            self.assembler.tangents(part, system, inertia.as_ref())?;
            Ok(residual)
        });
        complementary(system, at).into_iter().for_each(|conditions| conditions.restore_decisions());
        let residual = acting?;
        let along =
            |numbers: &SparseVector, full: &[f64]| numbers.iter().map(|&(n, share)| share * full[n as usize]).sum();
        let row = |numbers: &SparseVector| -> SparseVector {
            let entries = |&(number, share): &(u32, f64)| {
                self.assembler.coupling_row(number).map(move |(column, value)| (column, share * value))
            };
            numbers.iter().flat_map(entries).collect()
        };
        let rows: Vec<SparseVector> = numbers.iter().map(row).collect();
        let mut force = vec![0.0; system.dofs.len()];
        let given: Vec<SparseVector> =
            numbers.iter().zip(acts).map(|(own, &acts)| self.given(own, acts, &mut force)).collect();
        let n = numbers.len();
        let mut out = Responses {
            rows: numbers.iter().map(|own| along(own, &residual)).collect(),
            of_multipliers: vec![0.0; n * n],
            of_rows: vec![0.0; n * n],
        };
        self.assembler.tangents(part, system, inertia.as_ref())?;
        if let Some(stabilization) = stabilization {
            self.add(stabilization);
        }
        self.solver.set_forcing_term(0.0);
        for (j, (own, given)) in numbers.iter().zip(&given).enumerate() {
            given.iter().for_each(|&(number, value)| force[number as usize] = value);
            let rhs = self.assembler.equations().reduce(&force);
            given.iter().for_each(|&(number, _)| force[number as usize] = 0.0);
            let solved = match self.solve(part, system, &rhs) {
                Ok(solved) => solved,
                Err(Failed::Other(error)) => return Err(error),
                _ => return Ok(None),
            };
            let mut change = self.assembler.equations().expand(&solved.increment);
            if !acts[j] {
                own.iter().for_each(|&(number, share)| change[number as usize] += share);
            }
            for (i, (own, row)) in numbers.iter().zip(&rows).enumerate() {
                out.of_multipliers[i * n + j] = along(own, &change);
                out.of_rows[i * n + j] =
                    -row.iter().map(|&(column, value)| value * change[column as usize]).sum::<f64>();
            }
        }
        Ok(Some(out))
    }

    /// Forces by what is given of a condition, over the unknowns that have one; `zeros` over all unknowns are scratch space.
    fn given(&self, own: &SparseVector, acts: bool, zeros: &mut [f64]) -> SparseVector {
        if acts {
            return own.clone();
        }
        let mut force = vec![0.0; zeros.len()];
        own.iter().for_each(|&(number, share)| zeros[number as usize] = share);
        self.assembler.subtract_product(zeros, &mut force);
        own.iter().for_each(|&(number, _)| (zeros[number as usize], force[number as usize]) = (0.0, 0.0));
        (0..).zip(force).filter(|(_, value)| *value != 0.0).collect()
    }
}

/// The conditions of an interaction, by its place, that are decided together.
fn complementary(system: &mut System, at: usize) -> Option<&mut dyn Complementary> {
    system.interactions[at].active_set()?.complementary()
}

/// The unknowns of conditions; `None` where one of them has no unknown.
fn numbers(system: &System, conditions: &[ComplementaryCondition]) -> Option<Vec<SparseVector>> {
    let of = |condition: &ComplementaryCondition| {
        let number = |&(variable, share)| Some((system.dofs.number_of(variable, condition.owner)?, share));
        condition.direction.iter().map(number).collect::<Option<SparseVector>>()
    };
    conditions.iter().map(of).collect()
}
