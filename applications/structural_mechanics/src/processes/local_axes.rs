//! Axes of the material of the elements of a part: LOCAL_AXIS_1, and in space LOCAL_AXIS_2.

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::model::{Model, ModelPart};
use zelus_core::parameters::{Interval, Settings};
use zelus_core::processes::{Process, Target};

use crate::laws::has_axes;
use crate::variables::{LOCAL_AXIS_1, LOCAL_AXIS_2};

/// Axes 1 and 2 of the material at a place; why there are none.
pub(super) type AxesAt = Box<dyn Fn([f64; 3]) -> Result<[[f64; 3]; 2], &'static str> + Send>;

/// Gives the elements of a part the axes at their centres.
pub(super) struct LocalAxes {
    target: Target,
    /// Whether the centres follow the motion from step to step.
    update: bool,
    axes: AxesAt,
}

impl LocalAxes {
    /// Reads `"model_part_name"` and `"update_at_each_step"`, and checks the axes at the centres of the elements.
    ///
    /// # Errors
    /// A part that does not exist or has no elements.
    pub(super) fn boxed(settings: &Settings, model: &Model, axes: AxesAt) -> Result<Box<dyn Process>> {
        let (path, place) = (settings.get_str("model_part_name")?.to_owned(), settings.key_place("model_part_name"));
        model.root(&path).and_then(|root| root.part(&path)).map_err(|error| error.at(&place))?;
        let target = Target { path, interval: Interval::ALWAYS, place, process: settings.name().to_owned() };
        let part = model.root(&target.path)?;
        if target.selection(&part.tree)?.elements.is_empty() && part.share.is_none() {
            let problem = Diagnostic::error("empty-part", format!("{} has no elements", target.path));
            return Err(problem.at(target.place.clone()).remedy("name a part with the elements to give axes").into());
        }
        Ok(Box::new(Self { target, update: settings.get_bool("update_at_each_step")?, axes }))
    }

    fn give(&self, part: &mut ModelPart) -> Result<()> {
        let in_space = part.info.domain_size == 3;
        let selection = self.target.selection(&part.tree)?;
        let positions = if self.update { &part.nodes.current } else { &part.nodes.initial };
        let mut axes = Vec::with_capacity(selection.elements.len());
        for &element in &selection.elements {
            let nodes = part.elements.nodes(element);
            let centre = std::array::from_fn(|c| {
                nodes.iter().map(|&node| positions[node as usize][c]).sum::<f64>() / nodes.len() as f64
            });
            axes.push((self.axes)(centre).map_err(|fact| {
                let fact = format!(
                    "element {} of {} has no axes: {fact}",
                    part.elements.ids[element as usize], self.target.path
                );
                Diagnostic::error("material-axes", fact).at(self.target.place.clone()).remedy(
                    "move the axis or the point off the centres of the elements, or name a part without these elements",
                )
            })?);
        }
        let data = &mut part.elements.data;
        let mut write = |variable, which: usize| {
            data.add(variable);
            let column = data.values_mut(variable, 0);
            for (&element, axes) in selection.elements.iter().zip(&axes) {
                column[3 * element as usize..][..3].copy_from_slice(&axes[which]);
            }
        };
        write(&LOCAL_AXIS_1, 0);
        if in_space {
            write(&LOCAL_AXIS_2, 1);
        }
        Ok(())
    }
}

impl Process for LocalAxes {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        self.give(model.root_mut(&self.target.path)?)
    }

    fn check(&self, model: &Model, _system: &System, warnings: &mut Report) -> Result<()> {
        let part = model.root(&self.target.path)?;
        let elements = &self.target.selection(&part.tree)?.elements;
        let properties = |&element: &u32| part.properties.get(&part.elements.properties[element as usize]);
        if !elements.is_empty() && !elements.iter().filter_map(properties).any(has_axes) {
            let fact = format!("{} gives axes to {}, whose laws are isotropic", self.target.process, self.target.path);
            let problem = Diagnostic::warning("acts-on-nothing", fact).at(self.target.place.clone());
            warnings.push(problem.remedy("remove it, or name a law with axes, such as LinearElasticOrthotropic3DLaw"));
        }
        Ok(())
    }

    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        if self.update { self.give(model.root_mut(&self.target.path)?) } else { Ok(()) }
    }
}

/// A direction of the settings as a unit vector.
///
/// # Errors
/// Not three numbers, or no direction.
pub(super) fn direction(settings: &Settings, key: &str) -> Result<nalgebra::Vector3<f64>> {
    let given = point(settings, key)?;
    given.try_normalize(0.0).ok_or_else(|| {
        let problem = settings.error(key, "invalid-value", format!("\"{key}\" has no length"));
        problem.remedy("write a direction, e.g. [0.0, 0.0, 1.0]").into()
    })
}

/// Three numbers of the settings.
///
/// # Errors
/// Other than three finite numbers.
pub(super) fn point(settings: &Settings, key: &str) -> Result<nalgebra::Vector3<f64>> {
    let given: [f64; 3] = settings.get(key)?.parse(key)?;
    if given.iter().all(|number| number.is_finite()) {
        return Ok(given.into());
    }
    Err(settings.error(key, "invalid-value", format!("\"{key}\" is {given:?}")).remedy("write three numbers").into())
}
