//! Moves a mesh as a whole before anything is computed on it.

use zelus_core::Result;
use zelus_core::diagnostics::Report;
use zelus_core::model::Model;
use zelus_core::modelers::{Modeler, ModelerEntry};
use zelus_core::register;

/// Defaults, with what each key means.
const DEFAULTS: &str = r#"// Moves a mesh.
{
    "model_part_name": "", // root part of the mesh
    "by": [0.0, 0.0, 0.0] // by how much (length)
}"#;

struct ShiftMesh {
    part: String,
    by: [f64; 3],
}

impl Modeler for ShiftMesh {
    fn setup_model_part(&mut self, model: &mut Model, _report: &mut Report) -> Result<()> {
        let nodes = &mut model.root_mut(&self.part)?.nodes;
        for position in nodes.initial.iter_mut().chain(&mut nodes.current) {
            position.iter_mut().zip(self.by).for_each(|(x, by)| *x += by);
        }
        Ok(())
    }
}

register! { ModelerEntry "ShiftMeshModeler",
    about: "moves all nodes of a root part by a vector",
    defaults: DEFAULTS,
    build: |settings, _folder| {
        let part = settings.get_str("model_part_name")?.to_owned();
        Ok(Box::new(ShiftMesh { part, by: settings.get("by")?.parse("by")? }))
    },
}
