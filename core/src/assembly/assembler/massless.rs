//! Mass of the system: nodes without it, whose velocities and accelerations follow others, and the energies of motion.

use super::Assembler;
use crate::assembly::System;
use crate::assembly::bulk_matrix::add_residual;
use crate::assembly::redistribution::diagonal;
use crate::diagnostics::Result;
use crate::entities::{MasslessNodes, Request};
use crate::model::{ColumnOf, FIRST, ModelPart, SECOND};

/// Iterations after which the projection stops.
const MOST_ITERATIONS: usize = 500;
/// Largest remainder of a projection, relative to the projected vector.
const TOLERANCE: f64 = 1e-15;

impl Assembler {
    /// The mass matrix on the bulk pattern, that of the initial positions, without the mass that [`Assembler::redistribute`]
    /// took off.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn mass(&mut self, part: &ModelPart, system: &System) -> Result<&[f64]> {
        self.inertia.mass(&self.bulk, part, system)
    }

    /// Row sums of the mass matrix, a number an unknown.
    ///
    /// # Errors
    /// As [`Assembler::mass`].
    pub fn lumped_mass(&mut self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let own = self.inertia.mass(&self.bulk, part, system).map(<[f64]>::to_vec);
        let values = part.ranks.agree(own)?;
        let mut out = vec![0.0; system.dofs.len()];
        self.bulk.mul_subtract(&values, &vec![-1.0; system.dofs.len()], &mut out);
        self.parallel.sum(&mut out);
        Ok(out)
    }

    /// Step start: takes the mass off `nodes`, where others can carry it, and hands on the excess of their velocities and accelerations
    /// over those of the others, so that momentum stays and energy does not grow. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn redistribute(&mut self, part: &mut ModelPart, system: &System, nodes: &MasslessNodes) -> Result<()> {
        if self.inertia.redistribution.choose(part, nodes) {
            self.bulk.lay_out(part, system, &self.inertia.redistribution.groups(part));
            self.bulk.forget();
            self.inertia.forget();
            self.stamps.bulk_graph += 1;
        }
        let equations = self.equations.map();
        if self.inertia.redistribution.choose_unknowns(&system.dofs, |number| !equations.is_fixed(number)) {
            self.inertia.forget_mass();
            self.bulk.forget_key();
        }
        if !self.inertia.redistribution.is_empty() {
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
        for (block, numbers) in self.bulk.elements(system) {
            add_residual(block, numbers, &part.view(), Request::Residual, &mut forces)?;
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
        let mass = self.inertia.mass(&self.bulk, part, system)?;
        self.bulk.mul_subtract(mass, &v, &mut momentum);
        Ok(0.5 * product(&momentum, &v).abs())
    }

    /// Makes present velocities and accelerations of massless unknowns those of the nodes below.
    pub fn extrapolate_rates(&self, part: &mut ModelPart, system: &System) {
        if self.inertia.redistribution.is_empty() {
            return;
        }
        for column in [FIRST, SECOND] {
            let mut values = system.dofs.column(part, column, 0);
            self.inertia.redistribution.extrapolate(&mut values);
            system.dofs.write_column(part, column, 0, &values);
        }
    }

    /// Forces on massless unknowns handed on to the nodes below, as their accelerations are.
    pub fn redistribute_forces(&self, forces: &mut [f64]) {
        self.inertia.redistribution.redistribute_forces(forces);
    }

    /// The nearest motion that the masses can have: P w with M_r (w − v) = Pᵀ M (v − P v), by conjugate gradients.
    fn project(&mut self, part: &mut ModelPart, system: &System, column: ColumnOf, level: usize) -> Result<()> {
        let mut values = system.dofs.column(part, column, level);
        self.inertia.mass(&self.bulk, part, system)?;
        let mut residual = self.inertia.redistribution.excess(&values);
        if !part.ranks.any(residual.iter().any(|r| *r != 0.0)) {
            return Ok(());
        }
        self.parallel.sum(&mut residual);
        let mass = self.inertia.present_mass();
        let diagonal = {
            let mut diagonal = diagonal(self.bulk.matrix(), mass);
            self.parallel.sum(&mut diagonal);
            diagonal
        };
        let moves = |number: usize| diagonal[number] > 0.0 && self.equations.map().is_free(number);
        let scaled = |residual: &[f64]| -> Vec<f64> {
            (0..residual.len()).map(|n| if moves(n) { residual[n] / diagonal[n] } else { 0.0 }).collect()
        };
        let mut z = scaled(&residual);
        let mut error = self.parallel.dot(&residual, &z);
        let of_all: Vec<f64> = values.iter().zip(&diagonal).map(|(v, m)| m * v).collect();
        let negligible = f64::EPSILON.powi(2) * self.parallel.dot(&values, &of_all);
        let enough = (TOLERANCE * TOLERANCE * error).max(negligible);
        let mut direction = z;
        for _ in 0..MOST_ITERATIONS {
            if error <= enough {
                break;
            }
            let minus: Vec<f64> = direction.iter().map(|d| -d).collect();
            let mut product = vec![0.0; minus.len()];
            self.bulk.mul_subtract(mass, &minus, &mut product);
            self.parallel.sum(&mut product);
            let step = error / self.parallel.dot(&direction, &product);
            for n in 0..values.len() {
                values[n] += step * direction[n];
                residual[n] -= step * product[n];
            }
            z = scaled(&residual);
            let next = self.parallel.dot(&residual, &z);
            direction.iter_mut().zip(&z).for_each(|(d, z)| *d = z + next / error * *d);
            error = next;
        }
        self.inertia.redistribution.extrapolate(&mut values);
        system.dofs.write_column(part, column, level, &values);
        Ok(())
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
