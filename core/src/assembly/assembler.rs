//! Assembles the system of a step: residual and matrices over all unknowns, and the equations that are solved.
//!
//! Three tangents, because they live differently: that of the *bulk*, elements and conditions, has one pattern for the whole
//! run and its constant part is assembled once; that of the *coupling* by interactions (contact) is rebuilt when pairs
//! change; that of follower *loads* is small and not symmetric. Each is a part with its own invariants, and so are the
//! matrices of inertia, the equations of the step, the matrices on these equations, and the layout over ranks.

mod assembly_seconds;
mod bulk_tangent;
mod bulk_traits;
mod dof_owners;
mod force_kinds;
mod element_scaling;
mod coupling_tangent;
mod inertia;
mod inertia_matrices;
mod infinite;
mod load_tangent;
mod massless;
mod parallel_layout;
mod rank_sums;
mod reduced_matrix;
mod residual;
mod round_off;
mod assembler_state;
mod shares;
mod stamps;
mod step_equations;
mod tangents;
mod whole_system;

use std::time::Instant;

use zelus_linear_algebra::{Csr, Layout, Symmetry};

pub use assembler_state::AssemblerState;
pub use assembly_seconds::AssemblySeconds;
pub use element_scaling::ScaledMass;
pub use force_kinds::ForceKinds;
pub use inertia::{Inertia, damped_by_properties, strongest_damping};
pub use shares::PairForce;
pub use whole_system::WholeSystem;

use self::bulk_tangent::BulkTangent;
use self::coupling_tangent::{CouplingTangent, couplings};
use self::dof_owners::dof_owners_of_blocks;
use self::inertia_matrices::InertiaMatrices;
use self::load_tangent::LoadTangent;
use self::parallel_layout::ParallelLayout;
use self::reduced_matrix::ReducedMatrix;
use self::stamps::{Stamps, WHOLE};
use self::step_equations::StepEquations;
use super::equations::Equations;
use super::system::System;
use crate::diagnostics::Result;
use crate::model::{DofOwners, ModelPart};

/// The system of one model part.
#[derive(Default)]
pub struct Assembler {
    /// Tangent of elements and conditions.
    bulk: BulkTangent,
    /// Tangent of follower loads.
    loads: LoadTangent,
    /// Tangent of interactions.
    coupling: CouplingTangent,
    /// Mass and damping.
    inertia: InertiaMatrices,
    /// The equations left by fixities and constraints.
    equations: StepEquations,
    /// The bulk's tangent on the equations.
    reduced_bulk: ReducedMatrix,
    /// The interactions' tangent on the equations.
    reduced_coupling: ReducedMatrix,
    /// Counts of the changes of graphs and values.
    stamps: Stamps,
    /// Unknowns and equations over the ranks.
    parallel: ParallelLayout,
    /// Seconds spent so far.
    pub seconds: AssemblySeconds,
}

impl Assembler {
    /// Numbers the unknowns of the part and lays out the patterns that last.
    pub fn new(part: &ModelPart, system: &mut System, lumped_mass: bool) -> Self {
        let carriers = dof_owners_of_blocks(part, system);
        let multipliers: Vec<Vec<DofOwners>> = couplings(system).map(|coupling| coupling.unknowns(part)).collect();
        system.dofs.number(part, &carriers, &multipliers.concat());
        Self {
            bulk: BulkTangent::new(part, system),
            loads: LoadTangent::new(system),
            coupling: CouplingTangent::new(system, &multipliers),
            inertia: InertiaMatrices::new(lumped_mass),
            parallel: ParallelLayout::new(part, system),
            ..Self::default()
        }
    }

    /// Whether elements of any rank have a tangent that depends on the state.
    pub fn has_variable_elements(&self) -> bool {
        self.bulk.traits().variable_elements
    }

    /// Entries of the elements' matrix over all unknowns.
    pub fn entries(&self) -> usize {
        self.bulk.entries()
    }

    /// The map between unknowns and equations.
    pub fn equations(&self) -> &Equations {
        self.equations.map()
    }

    /// Step start, and whenever constraints change: the equations left by fixities and constraints, and the pattern of
    /// the interactions. Collective.
    ///
    /// # Errors
    /// Constraints that contradict each other.
    pub fn begin_step(&mut self, part: &ModelPart, system: &System) -> Result<()> {
        if self.bulk.follow_shape(part.nodes.reshaped) {
            self.inertia.forget();
        }
        let equations = part.ranks.agree(Equations::new(&system.dofs, part))?;
        let changed = self.stamps.bulk_graph == 0 || !equations.same_as(self.equations.map());
        let changed = part.ranks.any(changed);
        if changed || self.equations.take_roles_only() {
            self.equations.set(equations, part, system, self.parallel.distribution().is_some());
            self.parallel.number(self.equations.map());
            self.stamps.bulk_graph += u64::from(changed);
            self.stamps.bulk_values += u64::from(changed);
            self.coupling.forget_graph();
        } else {
            self.equations.update_fixed_masters(equations);
        }
        self.stamps.coupling_graph += u64::from(self.coupling.lay_out(part, system));
        Ok(())
    }

    /// Present values of all unknowns.
    pub fn values(&self, part: &ModelPart, system: &System) -> Vec<f64> {
        system.dofs.gather(part, 0)
    }

    /// Brings the matrices of the equations up to date with the tangents.
    pub fn reduce(&mut self) {
        let start = Instant::now();
        let equations = self.equations.map();
        self.reduced_bulk.update(equations, self.bulk.matrix(), self.bulk.values(), self.stamps.of_bulk());
        let coupling = self.coupling.matrix();
        self.reduced_coupling.update(equations, coupling, Some(&coupling.values), self.stamps.of_coupling());
        self.equations.complete_layout();
        self.seconds.bulk += start.elapsed().as_secs_f64();
    }

    /// The equations to solve, without the follower loads; [`Assembler::reduce`] comes first.
    pub fn system(&self) -> zelus_linear_algebra::System<'_> {
        let layout = &self.equations.map().layout;
        self.system_of(layout, self.reduced_bulk.matrix(), self.reduced_coupling.matrix())
    }

    /// Whether the unknowns may be taken for equations, some of them inactive: none follows others.
    pub fn has_whole(&self) -> bool {
        match self.parallel.distribution() {
            None => !self.equations.map().has_slaves(),
            Some(_) => self.parallel.whole_numbering().is_some(),
        }
    }

    /// Lets `solve` have the same system as [`WholeSystem`], without a second copy of the matrix.
    pub fn with_whole<T>(&mut self, solve: impl FnOnce(&Self, WholeSystem<'_>) -> T) -> T {
        self.bulk.lend_values();
        let mut system = self.system_of(self.equations.whole(), self.bulk.matrix(), self.coupling.matrix());
        // Solvers may change from one form to the other: what they keep of the one is not that of the other.
        system.bulk_graph += WHOLE;
        system.coupling_graph += WHOLE;
        let solved = solve(self, WholeSystem { system, loads: self.loads.nonzero() });
        self.bulk.return_values();
        solved
    }

    fn system_of<'a>(&self, layout: &'a Layout, bulk: &'a Csr, coupling: &'a Csr) -> zelus_linear_algebra::System<'a> {
        zelus_linear_algebra::System {
            layout,
            bulk,
            bulk_symmetry: if self.bulk.is_general() || !self.equations.map().keep_symmetry() {
                Symmetry::General
            } else {
                Symmetry::PositiveDefinite
            },
            bulk_graph: self.stamps.bulk_graph,
            bulk_values: self.stamps.bulk_values,
            coupling: (coupling.entries() > 0).then_some(coupling),
            coupling_graph: self.stamps.coupling_graph,
            coupling_values: self.stamps.coupling_values,
            coupling_symmetric: false,
            shared: None,
        }
    }

    /// Sums the constant tangents, once a run.
    fn ensure_constant(&mut self, part: &ModelPart, system: &System) -> Result<()> {
        self.seconds.bulk += self.bulk.ensure_constant(part, system)?;
        Ok(())
    }
}
