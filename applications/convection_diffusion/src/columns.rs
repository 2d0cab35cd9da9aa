//! Columns of the nodes that the balance of heat reads: `convection_diffusion_variables`.

use zelus_core::diagnostics::Result;
use zelus_core::entities::{EntityView, StepView};
use zelus_core::model::{Fields, ModelPart, Named, PropertyValue, ScalarVariable, VariableKind, named};
use zelus_core::parameters::Settings;
use zelus_core::vector3::{add, scale, sub};

/// The object of the solver settings that names them.
const SETTINGS: &str = "convection_diffusion_variables";

/// Keys, the variables they name unless told otherwise, and whether these are vectors.
const USUAL: [(&str, &str, bool); 8] = [
    ("unknown_variable", "TEMPERATURE", false),
    ("density_variable", "DENSITY", false),
    ("diffusion_variable", "CONDUCTIVITY", false),
    ("specific_heat_variable", "SPECIFIC_HEAT", false),
    ("volume_source_variable", "HEAT_FLUX", false),
    ("surface_source_variable", "FACE_HEAT_FLUX", false),
    ("velocity_variable", "VELOCITY", true),
    ("mesh_velocity_variable", "MESH_VELOCITY", true),
];

/// Names of the columns; `None` where the deck switches one off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Columns {
    /// Unknown.
    pub unknown: ScalarVariable,
    /// Mass per volume; 1 where switched off.
    pub density: Option<&'static str>,
    /// Flux per gradient; 0 where switched off.
    pub diffusion: Option<&'static str>,
    /// Heat per mass; 1 where switched off.
    pub specific_heat: Option<&'static str>,
    /// Source per volume.
    pub volume_source: Option<&'static str>,
    /// Source per area.
    pub surface_source: Option<&'static str>,
    /// Velocity that carries heat.
    pub velocity: Option<&'static str>,
    /// Velocity of the mesh, which that one is relative to.
    pub mesh_velocity: Option<&'static str>,
}

impl Columns {
    /// Columns of a part; the default ones where no solver has named others.
    pub fn of(part: &ModelPart) -> Self {
        let [unknown, density, diffusion, specific_heat, volume_source, surface_source, velocity, mesh_velocity] =
            USUAL.map(|(key, usual, _)| {
                let name = match part.data.get(&stored(key)) {
                    Some(PropertyValue::Text(name)) => name,
                    _ => usual,
                };
                named(name).map(|variable| variable.column().0)
            });
        let column = unknown.expect("checked when it was stored");
        Self {
            unknown: ScalarVariable { column, component: None },
            density,
            diffusion,
            specific_heat,
            volume_source,
            surface_source,
            velocity,
            mesh_velocity,
        }
    }

    /// Velocities of nodes less those of the mesh there, at a time level; zero where there are no such columns.
    pub fn relative_velocity<'a>(&self, history: &'a Fields, level: usize) -> impl Fn(u32) -> [f64; 3] + use<'a> {
        let [flow, mesh] = [self.velocity, self.mesh_velocity]
            .map(|column| column.map_or(&[][..], |column| history.level(column, level).as_chunks().0));
        let at = |of: &[[f64; 3]], node: u32| of.get(node as usize).copied().unwrap_or_default();
        move |node| sub(at(flow, node), at(mesh, node))
    }

    /// Takes the names that the settings of a solver give, and adds their columns to the nodes.
    ///
    /// # Errors
    /// Names of no variables, or of vectors for numbers and the reverse.
    pub fn store(settings: &Settings, part: &mut ModelPart) -> Result<()> {
        for (key, usual, is_vector) in USUAL {
            let path = format!("{SETTINGS}.{key}");
            let name = settings.get_str(&path)?;
            let fits = match named(name) {
                Some(Named::Whole(_, VariableKind::Scalar)) => !is_vector,
                Some(Named::Whole(_, VariableKind::Vector3)) => is_vector,
                _ => false,
            };
            let is_off = name.is_empty() && key != "unknown_variable";
            if !fits && !is_off {
                let wanted = if is_vector { "a vector of three" } else { "one number" };
                let problem =
                    settings.error(&path, "unknown-variable", format!("{name:?} is no variable that is {wanted}"));
                return Err(problem.remedy(format!("write \"{usual}\"")).into());
            }
            part.data.insert(stored(key), PropertyValue::Text(name.to_owned()));
            if let Some(variable) = named(name) {
                part.nodes.history.add_named(variable.column().0, if is_vector { 3 } else { 1 });
            }
        }
        Ok(())
    }
}

/// Numbers of a column at the nodes of an entity, at a time level; zero where there is no such column.
pub fn nodal<const NODES: usize>(
    entity: &EntityView<'_, NODES>,
    view: &StepView<'_>,
    column: Option<&str>,
    level: usize,
) -> [f64; NODES] {
    match column.map_or(&[][..], |column| view.nodes.history.level(column, level)) {
        [] => [0.0; NODES],
        values => entity.scalars(values),
    }
}

/// Velocities at the nodes of an entity relative to the mesh, `share` of the way from the beginning of the step to its end.
pub fn velocities<const NODES: usize>(
    entity: &EntityView<'_, NODES>,
    view: &StepView<'_>,
    columns: &Columns,
    share: f64,
) -> [[f64; 3]; NODES] {
    let history = &view.nodes.history;
    let mut out = [[0.0; 3]; NODES];
    for (level, share) in [(0, share), (1, 1.0 - share)] {
        let velocity = columns.relative_velocity(history, level);
        for (out, &node) in out.iter_mut().zip(entity.nodes) {
            *out = add(*out, scale(velocity(node), share));
        }
    }
    out
}

/// The name of a choice among the data of the part.
fn stored(key: &str) -> String {
    format!("{SETTINGS}.{key}")
}
