//! Nodes without mass: the system takes them on, and velocities and accelerations follow.

use super::{Assembler, bulk_pattern};
use crate::assembly::System;
use crate::assembly::bulk_matrix::add_residual;
use crate::assembly::redistribution::diagonal;
use crate::diagnostics::Result;
use crate::entities::{MasslessNodes, Want};
use crate::model::{ColumnOf, FIRST, ModelPart, SECOND};

/// Iterations after which the projection stops.
const MOST_ITERATIONS: usize = 500;
/// Share of what is projected that may be left.
const TOLERANCE: f64 = 1e-15;

impl Assembler {
    /// Step start: takes the mass off `nodes`, where others can carry it, and hands on what their velocities and
    /// accelerations have beyond those of the others, so that momentum stays and energy does not grow. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn redistribute(&mut self, part: &mut ModelPart, system: &System, nodes: &MasslessNodes) -> Result<()> {
        if self.redistribution.choose(part, nodes) {
            self.pattern = bulk_pattern(part, system, &self.redistribution.groups(part));
            (self.bulk, self.constant, self.damping) = (None, None, None);
            (self.mass, self.tangent_key) = (None, None);
            self.stamps.bulk_graph += 1;
        }
        let equations = &self.equations;
        if self.redistribution.choose_unknowns(&system.dofs, |number| equations.is_free(number)) {
            (self.mass, self.tangent_key) = (None, None);
        }
        if !self.redistribution.is_empty() {
            for column in [FIRST, SECOND] {
                for level in 1..part.nodes.history.levels() {
                    self.project(part, system, column, level)?;
                }
            }
        }
        Ok(())
    }

    /// Kinetic energy of the present velocities, and half the work of present internal forces on the displacements. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn energy(&mut self, part: &ModelPart, system: &System) -> Result<f64> {
        let own = self.own_energy(part, system);
        Ok(part.ranks.total(part.ranks.agree(own)?))
    }

    fn own_energy(&mut self, part: &ModelPart, system: &System) -> Result<f64> {
        let u = self.values(part, system);
        let mut forces = vec![0.0; u.len()];
        for (block, numbers) in system.elements.iter().zip(&self.element_numbers) {
            add_residual(block.as_ref(), numbers, &part.view(), Want::Residual, &mut forces)?;
        }
        Ok(0.5 * product(&forces, &u).abs() + self.own_kinetic_energy(part, system)?)
    }

    /// Kinetic energy of the present velocities; collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn kinetic_energy(&mut self, part: &ModelPart, system: &System) -> Result<f64> {
        let own = self.own_kinetic_energy(part, system);
        Ok(part.ranks.total(part.ranks.agree(own)?))
    }

    fn own_kinetic_energy(&mut self, part: &ModelPart, system: &System) -> Result<f64> {
        let v = system.dofs.column(part, FIRST, 0);
        let mut momentum = vec![0.0; v.len()];
        self.mass(part, system)?;
        self.mul_subtract(self.mass.as_ref().expect("just made"), &v, &mut momentum);
        Ok(0.5 * product(&momentum, &v).abs())
    }

    /// Makes present velocities and accelerations of massless unknowns those of the nodes below.
    pub fn extrapolate_rates(&self, part: &mut ModelPart, system: &System) {
        if self.redistribution.is_empty() {
            return;
        }
        for column in [FIRST, SECOND] {
            let mut values = system.dofs.column(part, column, 0);
            self.redistribution.extrapolate(&mut values);
            system.dofs.write_column(part, column, 0, &values);
        }
    }

    /// Forces on massless unknowns handed on to the nodes below, as their accelerations are.
    pub fn hand_on(&self, forces: &mut [f64]) {
        self.redistribution.hand_on(forces);
    }

    /// The nearest motion that the masses can have: P w with M_r (w − v) = Pᵀ M (v − P v), by conjugate gradients.
    fn project(&mut self, part: &mut ModelPart, system: &System, column: ColumnOf, level: usize) -> Result<()> {
        let mut values = system.dofs.column(part, column, level);
        self.mass(part, system)?;
        let mut residual = self.redistribution.excess(&values);
        if !part.ranks.any(residual.iter().any(|r| *r != 0.0)) {
            return Ok(());
        }
        self.add_up(&mut residual);
        let mass = self.mass.as_ref().expect("just made");
        let diagonal = {
            let mut diagonal = diagonal(&self.pattern.matrix, mass);
            self.add_up(&mut diagonal);
            diagonal
        };
        let moves = |number: usize| diagonal[number] > 0.0 && self.equations.is_free(number);
        let scaled = |residual: &[f64]| -> Vec<f64> {
            (0..residual.len()).map(|n| if moves(n) { residual[n] / diagonal[n] } else { 0.0 }).collect()
        };
        let mut z = scaled(&residual);
        let mut error = self.dot(&residual, &z);
        let of_all: Vec<f64> = values.iter().zip(&diagonal).map(|(v, m)| m * v).collect();
        let negligible = f64::EPSILON.powi(2) * self.dot(&values, &of_all);
        let enough = (TOLERANCE * TOLERANCE * error).max(negligible);
        let mut direction = z;
        for _ in 0..MOST_ITERATIONS {
            if error <= enough {
                break;
            }
            let minus: Vec<f64> = direction.iter().map(|d| -d).collect();
            let mut product = vec![0.0; minus.len()];
            self.mul_subtract(mass, &minus, &mut product);
            self.add_up(&mut product);
            let step = error / self.dot(&direction, &product);
            for n in 0..values.len() {
                values[n] += step * direction[n];
                residual[n] -= step * product[n];
            }
            z = scaled(&residual);
            let next = self.dot(&residual, &z);
            direction.iter_mut().zip(&z).for_each(|(d, z)| *d = z + next / error * *d);
            error = next;
        }
        self.redistribution.extrapolate(&mut values);
        system.dofs.write_column(part, column, level, &values);
        Ok(())
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
