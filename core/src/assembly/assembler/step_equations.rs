//! The equations of a step, and the layouts by which solvers know them.

use zelus_linear_algebra::{Layout, parallel};

use crate::assembly::corner_interpolation::corner_interpolation;
use crate::assembly::near_null_space::near_null_space;
use crate::assembly::rows::ROWS;
use crate::assembly::{Dof, Equations, System};
use crate::model::ModelPart;

/// The map from unknowns to equations, and the layout of all unknowns where they are taken for equations.
#[derive(Default)]
pub(super) struct StepEquations {
    map: Equations,
    /// All unknowns as equations, those that are not free as inactive.
    whole: Layout,
    /// Whether the map is that of a saved run, which holds the roles of the unknowns alone.
    roles_only: bool,
}

impl StepEquations {
    /// The map between unknowns and equations.
    pub fn map(&self) -> &Equations {
        &self.map
    }

    /// All unknowns as equations, those that are not free as inactive.
    pub fn whole(&self) -> &Layout {
        &self.whole
    }

    /// Takes up the roles that a saved run holds.
    pub fn resume(&mut self, map: Equations) {
        (self.map, self.roles_only) = (map, true);
    }

    /// Whether the map holds the roles alone; asked for once.
    pub fn take_roles_only(&mut self) -> bool {
        std::mem::take(&mut self.roles_only)
    }

    /// Takes up the equations of other fixities and constraints; `shared` says that several ranks share the unknowns.
    pub fn set(&mut self, map: Equations, part: &ModelPart, system: &System, shared: bool) {
        self.map = map;
        let dofs = system.dofs.dofs();
        let place = |dof: &Dof| (!dof.multiplier).then(|| (dof.variable, part.nodes.initial[dof.node as usize]));
        self.whole = Layout {
            node: parallel::map(dofs.len(), ROWS, |at| dofs[at].node),
            multiplier: parallel::map(dofs.len(), ROWS, |at| dofs[at].multiplier),
            // Motions of bodies that several ranks share are found by all of them.
            near_null_space: match shared {
                false => near_null_space(&parallel::map(dofs.len(), ROWS, |at| place(&dofs[at]))),
                true => Vec::new(),
            },
            corner_interpolation: corner_interpolation(part, &system.dofs),
            inactive: parallel::map(dofs.len(), ROWS, |number| !self.map.is_free(number)),
        };
    }

    /// Takes up the same equations, whose slaves may pass forces on to fixed unknowns in another way.
    pub fn update_fixed_masters(&mut self, map: Equations) {
        self.map.take_forces(map);
    }

    /// Gives the layout of the equations the near null space and the interpolation of all unknowns, where it lacks them.
    pub fn complete_layout(&mut self) {
        if self.map.layout.corner_interpolation.rows == 0 {
            self.map.layout.corner_interpolation = self.map.motions(&self.whole.corner_interpolation);
        }
        if self.map.layout.near_null_space.len() != self.whole.near_null_space.len() {
            let of = |vector: &Vec<f64>| self.map.unknowns().iter().map(|&n| vector[n as usize]).collect();
            self.map.layout.near_null_space = self.whole.near_null_space.iter().map(of).collect();
        }
    }
}
