//! The engines, when each is taken, and the options that make PETSc use it.

use zelus_linear_algebra::Symmetry;

/// Up to this number of equations a factorisation by MUMPS is taken where multigrid could serve too.
///
/// Below it a factorisation costs seconds and is reused while the matrix stays; above, its memory grows faster than the
/// matrix. `petsc/examples/engines.rs` measures it.
pub const SMALL: u64 = 20_000;

/// How a distributed system is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PetscEngine {
    /// MUMPS' LU, for any system.
    MumpsLu,
    /// MUMPS' LDLᵀ with pivoting, for symmetric systems, saddle points included.
    MumpsLdlt,
    /// Conjugate gradients with GAMG, for symmetric positive definite systems.
    CgGamg,
    /// GMRES with GAMG, for systems without multipliers.
    GmresGamg,
}

impl PetscEngine {
    /// All of them, in the order of the list.
    pub const ALL: [Self; 4] = [Self::MumpsLu, Self::MumpsLdlt, Self::CgGamg, Self::GmresGamg];

    /// The rule: systems with multipliers, and small ones, are factorised; others go to multigrid.
    ///
    /// `equations` counts those of all ranks.
    pub fn choose(equations: u64, symmetry: Symmetry, has_multipliers: bool) -> Self {
        let factorise = has_multipliers || equations <= SMALL;
        match (factorise, symmetry) {
            (true, Symmetry::General) => Self::MumpsLu,
            (true, _) => Self::MumpsLdlt,
            (false, Symmetry::PositiveDefinite) => Self::CgGamg,
            (false, _) => Self::GmresGamg,
        }
    }

    /// The engine of a setting, by the name that [`PetscEngine::name`] gives.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|engine| engine.name() == name)
    }

    /// Its name in settings and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::MumpsLu => "mumps_lu",
            Self::MumpsLdlt => "mumps_ldlt",
            Self::CgGamg => "cg_gamg",
            Self::GmresGamg => "gmres_gamg",
        }
    }

    /// Whether it factorises.
    pub fn is_direct(self) -> bool {
        matches!(self, Self::MumpsLu | Self::MumpsLdlt)
    }

    /// PETSc's options for it; those of the user come after them and win.
    pub(crate) fn options(self, tolerance: f64, iterations: usize) -> String {
        // 24: look for pivots that are zero, instead of dividing by their rounding errors
        let mumps = "-ksp_type preonly -pc_factor_mat_solver_type mumps -mat_mumps_icntl_24 1";
        // a strong connection is one to a node, not to a direction, so no entry is dropped
        let gamg = format!(
            "-ksp_rtol {tolerance:e} -ksp_atol 1e-300 -ksp_max_it {iterations} -ksp_norm_type unpreconditioned -pc_type \
             gamg -pc_gamg_type agg -mg_levels_ksp_max_it 2"
        );
        match self {
            Self::MumpsLu => format!("{mumps} -pc_type lu"),
            Self::MumpsLdlt => format!("{mumps} -pc_type cholesky"),
            Self::CgGamg => format!("-ksp_type cg {gamg}"),
            Self::GmresGamg => format!("-ksp_type gmres -ksp_gmres_restart 100 -ksp_pc_side right {gamg}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_takes_factorisations_for_multipliers_and_small_systems() {
        let choose = PetscEngine::choose;
        assert_eq!(choose(10, Symmetry::PositiveDefinite, false), PetscEngine::MumpsLdlt);
        assert_eq!(choose(10, Symmetry::General, true), PetscEngine::MumpsLu);
        assert_eq!(choose(1 << 40, Symmetry::Symmetric, true), PetscEngine::MumpsLdlt);
        assert_eq!(choose(1 << 40, Symmetry::PositiveDefinite, false), PetscEngine::CgGamg);
        assert_eq!(choose(1 << 40, Symmetry::General, false), PetscEngine::GmresGamg);
        assert!(PetscEngine::ALL.into_iter().all(|engine| PetscEngine::find(engine.name()) == Some(engine)));
    }
}
