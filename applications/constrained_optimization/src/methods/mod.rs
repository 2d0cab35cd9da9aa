//! The methods: one file each, with its functional, its process and its settings.

mod augmented_lagrangian;
mod double_lagrange_multiplier;
mod lagrange_multiplier;
mod master_slave_elimination;
mod penalty;
#[cfg(test)]
mod tests;
mod uzawa;

pub use augmented_lagrangian::AugmentedLagrangian;
pub use double_lagrange_multiplier::DoubleLagrangeMultiplier;
pub use lagrange_multiplier::LagrangeMultiplier;
pub use penalty::Penalty;
pub use uzawa::Uzawa;

use zelus_core::diagnostics::Result;
use zelus_core::entities::Interaction;
use zelus_core::model::Model;
use zelus_core::parameters::Settings;
use zelus_core::processes::{Process, ProcessRequest};

use crate::constraint_interaction::ConstraintInteraction;
use crate::constraints::{Constraint, IMPOSED};
use crate::method::Method;

/// The process of a method: puts its interaction into the model part.
struct MethodProcess<M> {
    path: String,
    method: Option<M>,
}

fn settings(request: &mut ProcessRequest<'_>) -> Result<Settings> {
    request.settings_with(|defaults| defaults.require(&["model_part_name"]))
}

/// The part whose constraints are meant; it exists.
fn part_path(settings: &Settings, request: &ProcessRequest<'_>) -> Result<String> {
    let path = settings.get_str("model_part_name")?;
    let found = request.model.root(path).and_then(|root| root.part(path));
    found.map(|_| path.to_owned()).map_err(|error| error.at(&settings.key_place("model_part_name")))
}

/// Reads the settings of a method into the struct that is the method, and makes its process.
fn process<M: Method + serde::de::DeserializeOwned>(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = settings(request)?;
    for key in ["penalty", "max_gap", "min_gap", "scale_factor", "coupling"] {
        positive(&settings, key)?;
    }
    Ok(Box::new(MethodProcess { path: part_path(&settings, request)?, method: Some(settings.parse::<M>()?) }))
}

fn positive(settings: &Settings, key: &str) -> Result<()> {
    match settings.node().get(key).map(|node| node.f64()).transpose()? {
        Some(value) if value <= 0.0 || !value.is_finite() => {
            let fact = format!("\"{key}\" is {value}");
            Err(settings.error(key, "invalid-value", fact).remedy("write a positive number").into())
        }
        _ => Ok(()),
    }
}

impl<M: Method> Process for MethodProcess<M> {
    fn interaction(&mut self, model: &mut Model) -> Result<Option<(String, Box<dyn Interaction>)>> {
        let Some(method) = self.method.take() else { return Ok(None) };
        let conditions = Constraint::imposed(model.root_mut(&self.path)?, &self.path)?;
        Ok(Some((self.path.clone(), Box::new(ConstraintInteraction::new(method, conditions)))))
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        model.root_mut(&self.path)?.info.marks.remove(IMPOSED);
        Ok(())
    }
}
