//! Thermal material of the elements of one block.

use zelus_core::entities::{BlockRequest, EntityView, StepView};
use zelus_core::model::Properties;

use crate::coefficient::{Coefficient, Local};
use crate::columns::Columns;

/// The coefficients of the balance of heat.
#[derive(Debug, Clone)]
pub struct Material {
    /// k (power per length and temperature).
    pub conductivity: Coefficient,
    /// ρ (mass per volume).
    pub density: Coefficient,
    /// c (heat per mass and temperature).
    pub specific_heat: Coefficient,
}

impl Material {
    /// Material of a block.
    pub fn of(request: &BlockRequest<'_>, columns: &Columns) -> Self {
        let properties = properties_of(request);
        let coefficient = |column, off| Coefficient::new(column, properties, columns.unknown.column, off);
        Self {
            conductivity: coefficient(columns.diffusion, 0.0),
            density: coefficient(columns.density, 1.0),
            specific_heat: coefficient(columns.specific_heat, 1.0),
        }
    }

    /// Whether any of it depends on the unknown.
    pub fn varies(&self) -> bool {
        [&self.conductivity, &self.density, &self.specific_heat].iter().any(|own| own.varies())
    }

    /// Conductivity, density and specific heat in an element where the unknown has these values.
    pub fn in_element<const NODES: usize>(
        &self,
        entity: &EntityView<'_, NODES>,
        view: &StepView<'_>,
        unknown: &[f64; NODES],
    ) -> [Local<'_, NODES>; 3] {
        [&self.conductivity, &self.density, &self.specific_heat].map(|own| own.in_element(entity, view.nodes, unknown))
    }

    /// # Errors
    /// A conductivity that neither the material nor a process gives.
    pub fn check_conductivity<const NODES: usize>(
        &self,
        entity: &EntityView<'_, NODES>,
        conductivity: &Local<'_, NODES>,
    ) -> Result<(), String> {
        given(entity, self.conductivity.unknown_in(conductivity), "")
    }

    /// # Errors
    /// A density or a specific heat that neither the material nor a process gives where a flow carries heat.
    pub fn check_capacity<const NODES: usize>(
        &self,
        entity: &EntityView<'_, NODES>,
        [density, specific_heat]: [&Local<'_, NODES>; 2],
    ) -> Result<(), String> {
        let missing = self.density.unknown_in(density).or_else(|| self.specific_heat.unknown_in(specific_heat));
        given(entity, missing, ": its velocity carries no heat without it")
    }
}

/// # Errors
/// A coefficient is missing.
fn given<const NODES: usize>(
    entity: &EntityView<'_, NODES>,
    missing: Option<&'static str>,
    why: &str,
) -> Result<(), String> {
    match missing {
        None => Ok(()),
        Some(name) => Err(format!(
            "its properties {} have no {name} (\"Variables\" of the materials), and no process sets it{why}",
            entity.properties.id
        )),
    }
}

/// The properties of a block.
pub fn properties_of<'a>(request: &BlockRequest<'a>) -> Option<&'a Properties> {
    let first = request.members.first().map(|&member| request.table.properties[member as usize]);
    first.and_then(|id| request.part.properties.get(&id))
}
