//! Inertia and damping of a step: the factors and fields that a time scheme gives, and the factors of materials.

use crate::assembly::{Dof, System};
use crate::model::{ModelPart, Rates};

/// Factors of the mass and damping matrices in the tangent, and the fields that they act on.
///
/// Damping is Rayleigh's, C = alpha M + beta K; factors of an element's properties ([`Rates::rayleigh`]) go before. It acts on
/// first derivatives; unknowns without an entry of [`Rates`] have none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Inertia {
    /// Factor of M in the tangent, 1/time².
    pub mass_factor: f64,
    /// Factor of C in the tangent, 1/time.
    pub damping_factor: f64,
    /// Rayleigh's alpha, 1/time.
    pub alpha: f64,
    /// Rayleigh's beta, time.
    pub beta: f64,
    /// Acceleration that M acts on, a number an unknown.
    pub acceleration: Vec<f64>,
    /// Velocity that C acts on, a number an unknown.
    pub velocity: Vec<f64>,
    /// Forces of the step before that still act, a number an unknown; empty for none.
    pub carried: Vec<f64>,
}

/// Whether the properties of an element give Rayleigh's factors, which then go before those of the solver, or some elements
/// are dampers.
pub fn damped_by_properties(part: &ModelPart, system: &System) -> bool {
    part.properties
        .values()
        .any(|p| Rates::all().filter_map(|r| r.rayleigh).flatten().any(|name| p.number(name).is_some()))
        || system.elements.iter().any(|block| block.has_damping())
}

/// Mask of unknowns that have no rate for damping to act on; empty when elements have none of them.
pub(super) fn without_rates(system: &System) -> Vec<bool> {
    let rateless = |dof: &Dof| dof.rates().is_none();
    let dofs = system.dofs.dofs();
    if dofs.iter().any(|dof| !dof.multiplier && rateless(dof)) {
        dofs.iter().map(rateless).collect()
    } else {
        Vec::new()
    }
}

/// The largest of Rayleigh's factors, those of the solver and of all properties.
pub fn strongest_damping(part: &ModelPart, [alpha, beta]: [f64; 2]) -> [f64; 2] {
    let names = Rates::all().filter_map(|rates| rates.rayleigh);
    let all = names.flat_map(|names| part.properties.values().map(move |properties| (names, properties)));
    all.fold([alpha, beta], |[alpha, beta], ([of_mass, of_stiffness], properties)| {
        let own = |name: &str, other: f64| properties.number(name).map_or(other, |own| own.max(other));
        [own(of_mass, alpha), own(of_stiffness, beta)]
    })
}
