//! Checks the values of nodes against numbers or functions at the end of steps; a difference ends the run.

use super::assign_scalar_variable_process::optional_value;
use super::assign_vector_variable_process::component_values;
use super::comparison::told;
use super::local_axes::LocalAxes;
use super::process::{Process, ProcessRequest};
use super::scalar_value::ScalarValue;
use super::target::{Target, scalar_variable, vector_variable};
use crate::assembly::System;
use crate::diagnostics::{Error, Result};
use crate::model::{Model, ModelPart, ScalarVariable};
use crate::parameters::{Settings, SpaceTime};
use crate::processes::ProcessEntry;
use crate::register;

/// Differences told in full; more are counted.
const TOLD: usize = 5;

/// Values that nodes of a part must have at the end of each step of an interval.
struct CheckNodes {
    target: Target,
    expected: Vec<(ScalarVariable, ScalarValue)>,
    axes: Option<LocalAxes>,
    /// Whether x, y, z are the initial position, too.
    initial: bool,
    /// A difference below this is none.
    tolerance: f64,
}

fn settings(request: &mut ProcessRequest<'_>, also: &'static [&'static str]) -> Result<Settings> {
    request.settings_with(|defaults| defaults.require(&["model_part_name", "variable_name"]).require(also))
}

fn checks(
    settings: &Settings,
    request: &ProcessRequest<'_>,
    expected: Vec<(ScalarVariable, ScalarValue)>,
) -> Result<Box<dyn Process>> {
    Ok(Box::new(CheckNodes {
        target: Target::new(settings, request.model)?,
        expected,
        axes: LocalAxes::from_settings(settings)?,
        initial: settings.get_bool("reference_conf")?,
        tolerance: 0.5 * 10f64.powi(-(settings.get_i64("tolerance_rank")?.clamp(-300, 300) as i32)),
    }))
}

fn build_scalar(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = settings(request, &[])?;
    let expected = vec![(scalar_variable(&settings)?, optional_value(&settings)?)];
    checks(&settings, request, expected)
}

fn build_vector(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = settings(request, &["value"])?;
    let pairs = vector_variable(&settings)?.into_iter().zip(component_values(&settings)?);
    let expected = pairs.filter_map(|(variable, value)| Some((variable, value?))).collect();
    checks(&settings, request, expected)
}

impl Process for CheckNodes {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root(&self.target.path)?;
        for (variable, _) in &self.expected {
            part.nodes.history.field(variable.column).map_err(|e| e.at(&self.target.place))?;
        }
        Ok(())
    }

    fn end_step(&mut self, model: &mut Model, _system: &System) -> Result<()> {
        let part = model.root(&self.target.path)?;
        let time = part.info.time;
        if !self.target.interval.contains(time) {
            return Ok(());
        }
        let mut found = Vec::new();
        for (variable, expected) in &self.expected {
            let field = part.nodes.history.field(variable.column).map_err(|e| e.at(&self.target.place))?;
            let own = self.target.selection(&part.tree)?.nodes.iter().filter(|&&node| part.owns_node(node as usize));
            for &node in own {
                let at = node as usize;
                let initial = part.nodes.initial[at];
                let current = if self.initial { initial } else { part.nodes.current[at] };
                let here = SpaceTime { current, initial, time };
                let wanted = expected.value(&self.axes.as_ref().map_or(here, |axes| axes.map(&here)));
                let value = field.levels[0][at * field.components + variable.offset()];
                let is_near = value == wanted || (value - wanted).abs() <= self.tolerance;
                if !is_near {
                    found.push(format!("node {}: {variable} is {value:e}, expected {wanted:e}", part.nodes.ids[at]));
                }
            }
        }
        let found = part.ranks.lines_of_all(found);
        if found.is_empty() {
            return Ok(());
        }
        let Target { place, process, .. } = &self.target;
        Err(Error::System(format!(
            "{place}: {process} at time {time} finds {} values that differ by more than {:e}:\n    {}",
            found.len(),
            self.tolerance,
            told(&found, TOLD)
        )))
    }
}

register! { ProcessEntry "check_scalar_to_nodes_process",
    aliases: &["CheckScalarToNodesProcess"],
    about: "compares a scalar variable or a component of nodes with a function; a difference ends the run",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/check_scalar_to_nodes_process.json")),
    build: build_scalar,
}

register! { ProcessEntry "check_vector_components_to_nodes_process",
    aliases: &["CheckVectorComponentsToNodesProcess"],
    about: "compares components of a vector variable of nodes with functions; a difference ends the run",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/check_vector_components_to_nodes_process.json")),
    build: build_vector,
}
