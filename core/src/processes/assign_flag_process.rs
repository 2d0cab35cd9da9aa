//! Sets or unsets a flag of the nodes, conditions or elements of a part.
//!
//! Acts before the first step and at the beginning of each step whose TIME is in the interval; nothing is undone.

use super::assign_to_entities::Container;
use super::process::{Process, ProcessRequest};
use super::target::Target;
use crate::assembly::System;
use crate::diagnostics::Result;
use crate::model::{Model, ModelPart, flags};
use crate::processes::ProcessEntry;
use crate::register;

struct AssignFlag {
    target: Target,
    flag: &'static str,
    value: bool,
    containers: Vec<Container>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let required = ["model_part_name", "flag_name", "entities"];
    let settings = &request.settings_with(|defaults| defaults.require(&required))?;
    let name = settings.get_str("flag_name")?;
    Ok(Box::new(AssignFlag {
        target: Target::new(settings, request.model)?,
        flag: flags::flag(name).map_err(|problem| problem.at(settings.key_place("flag_name")))?,
        value: settings.get_bool("value")?,
        containers: Container::list(settings)?,
    }))
}

impl AssignFlag {
    fn apply(&self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        if !self.target.interval.contains(part.info.time) {
            return Ok(());
        }
        let selection = self.target.selection(&part.tree)?;
        for container in &self.containers {
            let (flags, selected) = match container {
                Container::Nodes => (&mut part.nodes.flags, &selection.nodes),
                Container::Conditions => (&mut part.conditions.flags, &selection.conditions),
                Container::Elements => (&mut part.elements.flags, &selection.elements),
            };
            selected.iter().for_each(|&index| flags.set(self.flag, index as usize, self.value));
        }
        Ok(())
    }
}

impl Process for AssignFlag {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn before_loop(&mut self, model: &mut Model) -> Result<()> {
        self.apply(model)
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        self.apply(model)
    }
}

register! { ProcessEntry "assign_flag_process",
    aliases: &["AssignFlagProcess"],
    about: "sets or unsets a flag of nodes, conditions or elements of a part",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/assign_flag_process.json")),
    build: build,
}
