//! Brings the three matrices of a step up to date, and what is done to them between then and the solve.

use std::time::Instant;

use zelus_linear_algebra::Csr;

use super::{Assembler, blocks_of, couplings, load_blocks};
use crate::assembly::assembler::inertia::{Inertia, damped_by_properties, without_rates};
use crate::assembly::rows::fill_rows;
use crate::assembly::{DofTable, System};
use crate::diagnostics::Result;
use crate::entities::Coupling;
use crate::model::ModelPart;

impl Assembler {
    /// Brings the tangents up to date with the state.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn tangents(&mut self, part: &ModelPart, system: &System, inertia: Option<&Inertia>) -> Result<()> {
        let own = self.own_tangents(part, system, inertia);
        part.ranks.agree(own)?;
        let start = Instant::now();
        // Damped unknowns without rates may be on other ranks only.
        self.bulk_general = part.ranks.any(self.bulk_general);
        let idle = |own: &dyn Coupling| if own.blocks().is_empty() { 1.0 } else { own.idle_diagonal() };
        let idle: Vec<f64> = couplings(system).map(idle).collect();
        let mut in_use = self.coupling.lonely_rows_in_use();
        part.ranks.any_of(&mut in_use);
        let distribution = self.distribution.as_ref();
        let diagonals = self.coupling_of.iter().map(|&coupling| idle[coupling]);
        self.coupling.set_idle_diagonal(&in_use, diagonals, |n| distribution.is_none_or(|d| d.is_own(n)));
        self.stamps.coupling_values += 1;
        self.seconds.coupling += start.elapsed().as_secs_f64();
        Ok(())
    }

    fn own_tangents(&mut self, part: &ModelPart, system: &System, inertia: Option<&Inertia>) -> Result<()> {
        self.ensure_constant(part, system)?;
        self.stamps.tangents += 1;
        let start = Instant::now();
        let view = part.view();
        let key = inertia.map_or([0.0; 4], |i| [i.mass_factor, i.damping_factor, i.alpha, i.beta]);
        let single = !damped_by_properties(part, system);
        let stale =
            self.traits.variable_bulk || self.reduced_graph != self.stamps.bulk_graph || self.tangent_key != Some(key);
        if stale || !self.has_tangent {
            let is_constant = inertia.is_none() && !self.traits.variable_bulk;
            let memory = self.bulk.take().unwrap_or_default();
            let mut values = if is_constant { Vec::new() } else { self.stiffness(part, system, memory)? };
            // Damping acts on rates only, which takes the symmetry from unknowns without them.
            let mut damped = false;
            if inertia.is_some() {
                let [mass_factor, damping_factor, alpha, beta] = key;
                let [mass_factor, stiffness_factor] = if single {
                    [mass_factor + alpha * damping_factor, 1.0 + beta * damping_factor]
                } else {
                    [mass_factor, 1.0]
                };
                let still = without_rates(system);
                let moves = |column: u32| !still.get(column as usize).copied().unwrap_or(false);
                damped = !still.is_empty() && (!single || stiffness_factor != 1.0);
                self.mass(part, system)?;
                let mass = self.mass.as_ref().expect("just made");
                let pattern = &self.pattern.matrix;
                fill_rows(&pattern.row_starts, &mut values, |row, values| {
                    let entries = values.iter_mut().zip(&mass[pattern.row_starts[row]..]).zip(pattern.columns_of(row));
                    for ((value, m), &column) in entries {
                        let factor = if moves(column) { stiffness_factor } else { 1.0 };
                        *value = factor * *value + mass_factor * m;
                    }
                });
                if !single {
                    let damping = self.damping(part, system, [alpha, beta])?;
                    let pattern = &self.pattern.matrix;
                    fill_rows(&pattern.row_starts, &mut values, |row, values| {
                        let damping = &damping[pattern.row_starts[row]..];
                        let entries = values.iter_mut().zip(damping).zip(pattern.columns_of(row));
                        let moving = entries.filter(|(_, column)| moves(**column));
                        moving.for_each(|((value, c), _)| *value += damping_factor * c);
                    });
                }
            }
            self.bulk = (!is_constant).then_some(values);
            self.bulk_general = self.traits.general_elements || damped;
            self.has_tangent = true;
            self.stamps.bulk_values += u64::from(stale);
            self.reduced_graph = self.stamps.bulk_graph;
            self.tangent_key = Some(key);
        }
        self.loads.assemble(&load_blocks(system), &view)?;
        self.seconds.bulk += start.elapsed().as_secs_f64();
        let start = Instant::now();
        self.coupling.assemble(&blocks_of(system), &view)?;
        self.seconds.coupling += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Multiplies the tangents of follower loads, until they are assembled again.
    pub fn scale_load_tangents(&mut self, factor: f64) {
        self.loads.matrix.values.iter_mut().for_each(|v| *v *= factor);
    }

    /// Adds `amount` to the diagonals of the multipliers' tangents, until these are computed anew.
    pub fn relax_multipliers(&mut self, dofs: &DofTable, amount: f64) {
        for (number, _) in dofs.dofs().iter().enumerate().filter(|(_, dof)| dof.multiplier) {
            if self.counts(number) {
                self.coupling.matrix.add(number, number, amount);
            }
        }
        self.stamps.coupling_values += 1;
    }

    /// Tangents of follower loads on the equations; `None` when there are none.
    pub fn load_tangents(&mut self) -> Option<&Csr> {
        let loads = self.loads.nonzero()?;
        self.equations.reduce_matrix(loads, &loads.values, &mut self.reduced_loads, false);
        Some(&self.reduced_loads)
    }

    /// Stamps of graph and values of the bulk with the load tangents merged into it.
    ///
    /// No bulk without them has the same, and the values count as new after each call of [`Assembler::tangents`].
    pub fn merged_stamps(&self) -> [u64; 2] {
        [u64::MAX - self.stamps.bulk_graph, u64::MAX - self.stamps.tangents]
    }
}
