//! Diffusion in the plane, s ∂c/∂t = ∇·(D ∇c): an unknown of its own, its rates, an element and a solver.
//!
//! r_i = −∫ D ∇N_i·∇c − ∫ s N_i ∂c/∂t over a body of unit thickness, with c = CONCENTRATION, D = DIFFUSIVITY > 0 (length
//! squared per time, times what s has) and s = STORAGE. A prescribed node takes up CONCENTRATION_SUPPLY, what it gives to the
//! body (amount per time).

use serde::{Deserialize, Serialize};
use zelus_core::Result;
use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::entities::{
    BlockRequest, Build, ElementEntry, EntityView, Kernel, KernelBlock, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::{Shape, ShapeTable};
use zelus_core::{register, register_rates, register_variable};

register_variable! {
    pub CONCENTRATION: f64 = "Amount that diffuses, per volume.";
    pub CONCENTRATION_RATE: f64 = "Change of CONCENTRATION per time.";
    pub CONCENTRATION_SUPPLY: f64 = "Supply of a prescribed node to the body (amount per time).";
    kind DIFFUSIVITY: Scalar = "Flux per gradient of CONCENTRATION.";
    kind STORAGE: Scalar = "Amount per volume and CONCENTRATION that the body holds.";
}

register_rates! { "CONCENTRATION",
    first: "CONCENTRATION_RATE",
    reaction: Some("CONCENTRATION_SUPPLY"),
}

/// Columns of every node: name and number of components.
const VARIABLES: [(&str, usize); 3] = [("CONCENTRATION", 1), ("CONCENTRATION_RATE", 1), ("CONCENTRATION_SUPPLY", 1)];

const NODES: usize = 4;

/// A quadrilateral in which something diffuses.
struct Diffusion {
    rule: &'static ShapeTable,
}

/// DIFFUSIVITY and STORAGE.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Material {
    diffusivity: f64,
    storage: f64,
}

/// Gradients of the shape functions and the determinant of the Jacobian at a point.
fn gradients(x: &[[f64; 3]; NODES], local: &[[f64; 2]; NODES]) -> ([[f64; 2]; NODES], f64) {
    let mut j = [[0.0; 2]; 2];
    for (x, dn) in x.iter().zip(local) {
        for a in 0..2 {
            for b in 0..2 {
                j[a][b] += x[a] * dn[b];
            }
        }
    }
    let determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    let inverse = [[j[1][1], -j[0][1]], [-j[1][0], j[0][0]]];
    let global = |dn: &[f64; 2]| [0, 1].map(|a| (dn[0] * inverse[0][a] + dn[1] * inverse[1][a]) / determinant);
    (local.each_ref().map(global), determinant)
}

impl Kernel<NODES, NODES> for Diffusion {
    type State = Material;

    fn unknowns() -> [LocalUnknown; NODES] {
        LocalUnknown::of_nodes(CONCENTRATION.scalar())
    }

    fn new(_request: &BlockRequest<'_>) -> Result<Self> {
        Ok(Self { rule: ShapeTable::get(Shape::Quad4, 2) })
    }

    fn state(&self, entity: &EntityView<'_, NODES>, _view: &StepView<'_>) -> Result<Material, String> {
        let property = |name| entity.properties.require(name).map_err(|problem| problem.to_string());
        if self.rule.dn::<NODES, 2>().iter().any(|dn| gradients(&entity.initial, dn).1 <= 0.0) {
            return Err("it is inverted".to_owned());
        }
        Ok(Material { diffusivity: property("DIFFUSIVITY")?, storage: property("STORAGE")? })
    }

    fn tangent(&self) -> Tangent {
        Tangent::Constant
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, NODES>,
        material: &Material,
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; NODES],
    ) -> Result<(), String> {
        if request == Request::External {
            return Ok(());
        }
        let c = entity.scalars(view.nodes.history.values(&CONCENTRATION, 0));
        for (g, local) in self.rule.dn::<NODES, 2>().iter().enumerate() {
            let (dn, determinant) = gradients(&entity.initial, local);
            let weight = self.rule.weight(g) * determinant * material.diffusivity;
            for i in 0..NODES {
                for j in 0..NODES {
                    let k = weight * (dn[i][0] * dn[j][0] + dn[i][1] * dn[j][1]);
                    rhs[i] -= k * c[j];
                    if !lhs.is_empty() {
                        lhs[i * NODES + j] += k;
                    }
                }
            }
        }
        Ok(())
    }

    fn has_damping(&self) -> bool {
        true
    }

    fn damping(&self, entity: &EntityView<'_, NODES>, material: &Material, out: &mut [f64]) {
        for (g, n) in self.rule.n::<NODES>().iter().enumerate() {
            let (_, determinant) = gradients(&entity.initial, &self.rule.dn::<NODES, 2>()[g]);
            let weight = self.rule.weight(g) * determinant * material.storage;
            for i in 0..NODES {
                for j in 0..NODES {
                    out[i * NODES + j] += weight * n[i] * n[j];
                }
            }
        }
    }
}

register! { ElementEntry "DiffusionElement2D4N",
    about: "a quadrilateral of the plane in which CONCENTRATION diffuses: DIFFUSIVITY, STORAGE",
    source: "r_i = −∫ D ∇N_i·∇c − ∫ s N_i ∂c/∂t",
    cell: Some(Shape::Quad4),
    space: 0,
    nodal: &VARIABLES,
    build: Build::Block(KernelBlock::<Diffusion, NODES, NODES>::boxed),
}

/// Defaults of the solver; `zelus describe Diffusion` prints them.
const DEFAULTS: &str = r#"// Solver of a concentration in a body at rest.
{
    "solver_type": "Diffusion", // "Diffusion"
    "model_part_name": "", // root model part; must be given
    "domain_size": 2, // dimensions of the problem
    "buffer_size": 2, // time levels kept of fields with history
    "scheme_type": "static", // "static" is the steady state, "bdf1" to "bdf5" integrate in time
    "analysis_type": "linear", // the equations are linear: one solve a step
    "model_import_settings": {}, // input_type "mdpa" (input_filename without extension) or "use_input_model_part"
    "material_import_settings": { // properties may stand in the mesh as well
        "materials_filename": "" // JSON file relative to the deck; "" for none
    },
    "time_stepping": {}, // time_step, time_step_table or time_step_intervals
    "step_cutting": false, // whether a step that does not converge is retried with half its length
    "compute_reactions": true, // whether CONCENTRATION_SUPPLY is computed
    "reactions_of_constraints": true, // whether supplies of prescribed nodes hold what constraints hand on to them
    "move_mesh_flag": false, // the body is at rest
    "rayleigh_alpha": 0.0, // no mass
    "rayleigh_beta": 0.0, // no damping but storage
    "convergence_criterion": "residual_criterion", // of "analysis_type" "non_linear"
    "residual_relative_tolerance": 1.0e-10, // of the norm of the residual
    "residual_absolute_tolerance": 1.0e-12, // of the residual an unknown
    "condn_convergence_criterion": false, // true: print the condition number of the system of every iteration
    "max_iteration": 10, // iterations of "non_linear"
    "continue_if_converging": false, // true: a step that converges steadily at max_iteration may take as many again
    "linear_solver_settings": {} // solver_type and what it takes; empty for direct or multigrid, by size
}"#;

register! { SolverEntry "Diffusion",
    about: "a concentration in a body at rest, steady or in time",
    source: "s ∂c/∂t = ∇·(D ∇c)",
    defaults: DEFAULTS,
    build: SolverDefinition {
        variables: &VARIABLES,
        adapt: |defaults| defaults.require(&["model_part_name", "model_import_settings", "time_stepping"]),
        ..SolverDefinition::PLAIN
    },
}
