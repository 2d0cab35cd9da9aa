//! Increments that count with the unknowns of a [`Follower`].
//!
//! With K the tangent of the strategy, r its forces, and T the follower's unknowns, T₀ their own out-of-balance increment,
//!
//! K δu = r + F δT, δT = T₀ + G δu, F = ∂r/∂T, G = ∂T/∂u
//!
//! is (I − G K⁻¹ F) δT = T₀ + G K⁻¹ r: a system for the follower's unknowns alone, of one unit, solved by generalised conjugate residuals
//! (Eisenstat, Elman and Schultz, 1983). F and G are products by differences.

use std::time::Instant;

use zelus_linear_algebra::vector::add_scaled;

use super::NewtonRaphson;
use crate::assembly::System;
use crate::diagnostics::Result;
use crate::entities::{Follower, Interaction};
use crate::model::{ModelPart, NodalState};
use crate::strategies::linear_solve::{Failed, Solved};

/// Step of finite differences, relative to the increment that moves the unknowns by their own size.
const NEARBY: f64 = 1e-6;
/// Share of the right-hand side at which the increment of the follower is accurate enough: the next iteration corrects the rest.
const ACCURACY: f64 = 1e-3;
/// Directions that are tried for it.
const MOST: usize = 30;

/// Seconds that following takes.
const FOLLOWER: &str = "follower";

/// The follower of a system, taken out of it.
struct Taken {
    at: usize,
    interaction: Box<dyn Interaction>,
}

impl Taken {
    fn from(system: &mut System) -> Option<Self> {
        let at = system.interactions.iter_mut().position(|interaction| interaction.follower().is_some())?;
        Some(Self { at, interaction: system.interactions.remove(at) })
    }

    fn follower(&mut self) -> &mut dyn Follower {
        self.interaction.follower().expect("it was one when it was taken")
    }

    fn put_back(self, system: &mut System) {
        system.interactions.insert(self.at, self.interaction);
    }
}

impl NewtonRaphson {
    /// Lets the follower, if there is one, follow to the present state, in which forces have just been computed, and computes them anew;
    /// why it cannot.
    ///
    /// # Errors
    /// Errors of the follower.
    pub(super) fn follow(
        &mut self,
        part: &mut ModelPart,
        system: &mut System,
        residual: &mut Vec<f64>,
    ) -> Result<Option<String>> {
        let Some(mut taken) = Taken::from(system) else { return Ok(None) };
        let start = Instant::now();
        show(part, system);
        let failure = taken.follower().follow(part, &system.elements);
        taken.put_back(system);
        self.phases.since(FOLLOWER, start);
        *residual = self.residual(part, system)?;
        failure
    }

    /// `solved` with the contribution of the follower, if there is one; `prescribed` is the increment of unknowns that are not free.
    ///
    /// # Errors
    /// A singular system, entities that cannot be computed nearby.
    pub(super) fn with_follower(
        &mut self,
        solved: Solved,
        prescribed: &[f64],
        part: &mut ModelPart,
        system: &mut System,
    ) -> Result<Solved, Failed> {
        let Some(mut taken) = Taken::from(system) else { return Ok(solved) };
        let state = part.nodal_state();
        let found = self.solve_together(solved, prescribed, &state, taken.follower(), part, system);
        part.restore(state);
        taken.put_back(system);
        found
    }

    fn solve_together(
        &mut self,
        mut solved: Solved,
        prescribed: &[f64],
        state: &NodalState,
        follower: &mut dyn Follower,
        part: &mut ModelPart,
        system: &mut System,
    ) -> Result<Solved, Failed> {
        let before = self.residual(part, system)?;
        let start = Instant::now();
        show(part, system);
        let mut left = follower.refer(part, &system.elements)?;
        self.phases.since(FOLLOWER, start);
        part.restore(state.clone());
        let mut first = self.assembler.equations().expand(&solved.increment);
        first.iter_mut().zip(prescribed).for_each(|(sum, d)| *sum += d);
        add_scaled(1.0, &self.response(&first, state, follower, part, system)?, &mut left);
        let asked = follower.dot(&left, &left).sqrt();
        let mut past: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
        while past.len() < MOST && follower.dot(&left, &left).sqrt() > ACCURACY * asked {
            let forces = self.forces(&left, &before, state, follower, part, system)?;
            let rhs = self.assembler.equations().reduce(&forces);
            let answer = self.solve(part, system, &rhs)?;
            solved.iterations += answer.iterations;
            let mut direction = answer.increment;
            let whole = self.assembler.equations().expand(&direction);
            let response = self.response(&whole, state, follower, part, system)?;
            let mut change = left.clone();
            add_scaled(-1.0, &response, &mut change);
            for (of_past, change_of_past) in &past {
                let along = follower.dot(change_of_past, &change);
                add_scaled(-along, change_of_past, &mut change);
                add_scaled(-along, of_past, &mut direction);
            }
            let size = follower.dot(&change, &change).sqrt();
            if !(size.is_finite() && size > 0.0) {
                break;
            }
            change.iter_mut().chain(&mut direction).for_each(|value| *value /= size);
            let along = follower.dot(&change, &left);
            add_scaled(-along, &change, &mut left);
            add_scaled(along, &direction, &mut solved.increment);
            past.push((direction, change));
        }
        Ok(solved)
    }

    /// G δu: the response of the follower to a change of the unknowns.
    fn response(
        &mut self,
        increment: &[f64],
        state: &NodalState,
        follower: &mut dyn Follower,
        part: &mut ModelPart,
        system: &mut System,
    ) -> Result<Vec<f64>, Failed> {
        let share = NEARBY * self.own_size(increment, part, system);
        let nearby: Vec<f64> = increment.iter().map(|d| share * d).collect();
        self.move_by(part, system, &nearby);
        if follower.reads_elements() {
            self.residual(part, system)?;
        }
        let start = Instant::now();
        show(part, system);
        let mut response = follower.respond(part, &system.elements)?;
        self.phases.since(FOLLOWER, start);
        part.restore(state.clone());
        response.iter_mut().for_each(|value| *value /= share);
        Ok(response)
    }

    /// F δT: the forces by which the unknowns of the follower push where they change by this.
    fn forces(
        &mut self,
        increment: &[f64],
        before: &[f64],
        state: &NodalState,
        follower: &dyn Follower,
        part: &mut ModelPart,
        system: &System,
    ) -> Result<Vec<f64>, Failed> {
        let share = follower.nudge(part, increment);
        let after = self.residual(part, system);
        part.restore(state.clone());
        let difference = |(after, before): (f64, &f64)| if share > 0.0 { (after - before) / share } else { 0.0 };
        Ok(after?.into_iter().zip(before).map(difference).collect())
    }

    /// How often an increment goes into the unknowns that it changes: of each variable the largest value over the largest change, and
    /// of all variables the least, at most 1 where values are smaller than changes. Collective.
    fn own_size(&self, increment: &[f64], part: &ModelPart, system: &System) -> f64 {
        let values = self.assembler.values(part, system);
        let variables: Vec<_> = system.dofs.variables().collect();
        let mut sizes = vec![0.0_f64; 2 * variables.len()];
        for (number, dof) in system.dofs.dofs().iter().enumerate() {
            let Some(at) = variables.iter().position(|variable| *variable == dof.variable) else { continue };
            let (value, change) = (values[number].abs(), increment[number].abs());
            sizes[2 * at] = sizes[2 * at].max(value);
            sizes[2 * at + 1] = sizes[2 * at + 1].max(change);
        }
        let all = part.ranks.gather_numbers(&sizes);
        let largest = |at: usize| all.iter().map(|of_rank| of_rank[at]).fold(0.0, f64::max);
        let of_variable = |at: usize| (largest(2 * at), largest(2 * at + 1));
        let shares = (0..variables.len()).map(of_variable).filter(|(_, change)| *change > 0.0);
        let least = shares.map(|(value, change)| if value > 0.0 { value / change } else { 1.0 }).reduce(f64::min);
        least.unwrap_or(1.0)
    }
}

/// Lets the interactions write their results in the present state into the fields, for others to read.
fn show(part: &mut ModelPart, system: &mut System) {
    system.interactions.iter_mut().filter_map(|interaction| interaction.active_set()).for_each(|set| set.show(part));
}
