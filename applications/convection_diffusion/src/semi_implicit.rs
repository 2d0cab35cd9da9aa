//! Semi-implicit steps of heat: semi-Lagrangian advection of temperatures, then conduction.

use zelus_core::assembly::DofTable;
use zelus_core::diagnostics::Result;
use zelus_core::model::ModelPart;
use zelus_core::register;
use zelus_core::strategies::{Scheme, SchemeEntry, SchemeFactory};

use crate::columns::Columns;
use crate::transport::{Locator, Paths, WholeMesh, advected};
use crate::variables::PROJECTED_SCALAR1;

/// Name of the scheme.
pub const SEMI_IMPLICIT: &str = "semi_implicit_convection_diffusion";
/// Elements of the step after advection.
pub const DIFFUSION: &str = "EulerianDiffusion";

struct AdvectionThenConduction {
    /// Parts of a path in a step.
    parts: usize,
    /// The mesh, once it has been brought together.
    whole: Option<WholeMesh>,
}

impl Scheme for AdvectionThenConduction {
    fn prepare(&self, part: &mut ModelPart) {
        part.nodes.history.add(&PROJECTED_SCALAR1);
    }

    fn is_static(&self) -> bool {
        true
    }

    fn begins_at_prescribed(&self) -> bool {
        true
    }

    fn predict(&mut self, part: &mut ModelPart, _dofs: &DofTable) -> Result<()> {
        let columns = Columns::of(part);
        let whole = self.whole.get_or_insert_with(|| WholeMesh::of(part));
        let values = part.nodes.history.level(columns.unknown.column, 0);
        let own: Vec<[f64; 1]> = whole.own.iter().map(|&node| [values[node as usize]]).collect();
        let values = whole.field(part, &own);
        let velocities = [0, 1].map(|level| {
            let velocity = columns.relative_velocity(&part.nodes.history, level);
            whole.field(part, &whole.own.iter().map(|&node| velocity(node)).collect::<Vec<_>>())
        });
        let mesh = whole.mesh(part);
        let paths = Paths {
            positions: &mesh.positions,
            velocities: velocities.each_ref().map(Vec::as_slice),
            time: part.info.delta_time,
            parts: self.parts,
        };
        let advected = whole.field(part, &advected(part, whole, &Locator::new(&mesh), &paths, &values));
        let here: Vec<f64> =
            (0..part.nodes.len() as u32).map(|node| advected[WholeMesh::place(part, node)][0]).collect();
        part.nodes.history.values_mut(&PROJECTED_SCALAR1, 0).copy_from_slice(&here);
        Ok(())
    }
}

register! { SchemeEntry SEMI_IMPLICIT,
    about: "semi-Lagrangian advection of heat with back and forth error compensation (BFECC), then implicit conduction",
    source: "T* = T(x − ∫ v dt); ρc (T − T*)/Δt = ∇·(k ∇(T + T*)/2) + Q",
    build: SchemeFactory::Implicit(|request| {
        let settings = request.settings;
        let parts = settings.get_usize("bfecc_substepping")?;
        if parts == 0 {
            let problem = settings.error("bfecc_substepping", "invalid-value", "\"bfecc_substepping\" is 0");
            return Err(problem.remedy("write the number of parts of a path, from 1").into());
        }
        Ok(Box::new(AdvectionThenConduction { parts, whole: None }))
    }),
}
