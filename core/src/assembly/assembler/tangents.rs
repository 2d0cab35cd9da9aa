//! Brings the three tangents of a step up to date, and changes them between then and the solve.

use std::time::Instant;

use zelus_linear_algebra::Csr;

use super::Assembler;
use super::inertia::Inertia;
use crate::assembly::{DofTable, System};
use crate::diagnostics::Result;
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
        self.bulk.agree_on_symmetry(&part.ranks);
        self.coupling.set_inactive_diagonals(part, system, &self.parallel);
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
        let stale = self.bulk.is_stale(self.stamps.bulk_graph, key);
        if stale || !self.bulk.has_tangent() {
            let is_constant = inertia.is_none() && !self.bulk.traits().variable_bulk;
            let memory = self.bulk.take_memory();
            let mut values = if is_constant { Vec::new() } else { self.bulk.stiffness(part, system, memory)? };
            let damped = match inertia {
                Some(_) => self.inertia.add_to_tangent(&self.bulk, part, system, key, &mut values)?,
                None => false,
            };
            let general = self.bulk.traits().general_elements || damped;
            self.bulk.set_tangent((!is_constant).then_some(values), general, self.stamps.bulk_graph, key);
            self.stamps.bulk_values += u64::from(stale);
        }
        self.loads.assemble(system, &view)?;
        self.seconds.bulk += start.elapsed().as_secs_f64();
        let start = Instant::now();
        self.coupling.assemble(system, &view)?;
        self.seconds.coupling += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Multiplies the tangents of follower loads, until they are assembled again.
    pub fn scale_load_tangents(&mut self, factor: f64) {
        self.loads.scale(factor);
    }

    /// Adds `amount` to the diagonals of the multipliers' tangents, until these are computed anew.
    pub fn relax_multipliers(&mut self, dofs: &DofTable, amount: f64) {
        self.coupling.relax(dofs, amount, &self.parallel);
        self.stamps.coupling_values += 1;
    }

    /// Adds `amount(n, |k|)` to the diagonal entry k of each unknown n in the bulk's tangent, until the tangents are computed anew.
    pub fn add_to_diagonal(&mut self, amount: &dyn Fn(usize, f64) -> f64) {
        self.bulk.add_to_diagonal(amount);
        self.stamps.bulk_values += 1;
    }

    /// Tangents of follower loads on the equations; `None` when there are none.
    pub fn load_tangents(&mut self) -> Option<&Csr> {
        self.loads.reduce(self.equations.map())
    }

    /// Stamp of the values of the bulk with the load tangents merged into it.
    ///
    /// No bulk without them has the same, and the values count as new after each call of [`Assembler::tangents`].
    pub fn merged_values(&self) -> u64 {
        u64::MAX - self.stamps.tangents
    }
}
