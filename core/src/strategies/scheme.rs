//! Time schemes: what inertia adds to the system, and how rates follow displacements.

use crate::assembly::Inertia;
use crate::diagnostics::Result;
use crate::model::ModelPart;
use crate::parameters::Settings;
use crate::register;
use crate::registry::Build;

/// Integration in time of the equations of motion.
pub trait Scheme: Send {
    /// Variables with history it needs on the nodes, beside the unknowns.
    fn prepare(&self, _part: &mut ModelPart) {}

    /// Whether it uses the lumped mass.
    fn lumped_mass(&self) -> bool {
        false
    }

    /// Step start: first guess of the unknowns that are free.
    ///
    /// # Errors
    /// A step the scheme cannot take.
    fn predict(&mut self, _part: &mut ModelPart) -> Result<()> {
        Ok(())
    }

    /// Rates from the present displacements.
    fn update(&self, _part: &mut ModelPart) {}

    /// What inertia and damping add in the present state; `None` when the problem is static.
    fn inertia(&self, _part: &ModelPart) -> Option<Inertia> {
        None
    }
}

/// No inertia: time only orders the loads.
#[derive(Debug, Clone, Copy, Default)]
pub struct StaticScheme;

impl Scheme for StaticScheme {}

/// What a scheme is made from.
pub struct SchemeRequest<'a> {
    /// The solver settings, defaults filled in.
    pub settings: &'a Settings,
}

/// Makes a scheme; registered as `Build::Factory(&(make as SchemeFactory))`.
pub type SchemeFactory = fn(&SchemeRequest<'_>) -> Result<Box<dyn Scheme>>;

register! { Scheme "static",
    about: "no inertia: time only orders the loads",
    build: Build::Factory(&((|_| Ok(Box::new(StaticScheme))) as SchemeFactory)),
}
