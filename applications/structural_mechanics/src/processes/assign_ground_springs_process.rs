//! Connects the nodes of a part to the ground by springs: weak ones hold a body that nothing else holds.

use std::ops::Range;

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::model::{Model, ModelPart};
use zelus_core::parameters::Interval;
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, Target, check_unknowns};
use zelus_core::register;

use super::nodal_conditions::add_conditions;
use crate::variables::{DISPLACEMENT, GROUND_STIFFNESS};

struct GroundSprings {
    target: Target,
    stiffness: [f64; 3],
    nodes: Vec<u32>,
    /// Its conditions, one a node.
    made: Range<usize>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name", "stiffness"]))?;
    let (path, place) = (settings.get_str("model_part_name")?.to_owned(), settings.key_place("model_part_name"));
    request.model.root(&path).and_then(|root| root.part(&path)).map_err(|error| error.at(&place))?;
    // Springs are a constant part of the stiffness.
    let target = Target { path, interval: Interval::ALWAYS, place, process: settings.name().to_owned() };
    let part = request.model.root(&target.path)?;
    let nodes = target.selection(&part.tree)?.nodes.clone();
    if nodes.is_empty() {
        let problem = Diagnostic::error("empty-part", format!("{} has no nodes", target.path));
        return Err(problem.at(target.place.clone()).remedy("name a part with the nodes of the springs").into());
    }
    let stiffness: [f64; 3] = settings.get("stiffness")?.parse("stiffness")?;
    let is_sound = |k: &f64| *k >= 0.0 && k.is_finite();
    if !stiffness.iter().all(is_sound) || stiffness == [0.0; 3] {
        let fact = format!("the stiffness of springs is {stiffness:?}");
        let problem = settings.error("stiffness", "out-of-range", fact);
        return Err(problem.remedy("write three numbers, none below zero and one above").into());
    }
    Ok(Box::new(GroundSprings { target, stiffness, nodes, made: 0..0 }))
}

impl GroundSprings {
    fn give(&self, part: &mut ModelPart, stiffness: [f64; 3]) {
        part.conditions.data.add(&GROUND_STIFFNESS);
        let column = part.conditions.data.values_mut(&GROUND_STIFFNESS, 0);
        let own = column[3 * self.made.start..3 * self.made.end].as_chunks_mut::<3>().0;
        own.iter_mut().for_each(|own| *own = stiffness);
    }
}

impl Process for GroundSprings {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        self.made = add_conditions(part, "GroundSpringCondition", &self.nodes)?;
        self.give(part, self.stiffness);
        Ok(())
    }

    fn check(&self, model: &Model, system: &System, _warnings: &mut Report) -> Result<()> {
        let unknowns = self.nodes.iter().map(|&node| (node, DISPLACEMENT.component(0)));
        check_unknowns(model.root(&self.target.path)?, system, unknowns, &self.target.place)
    }

    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        // Later stages have springs of their own.
        self.give(model.root_mut(&self.target.path)?, [0.0; 3]);
        Ok(())
    }

    fn suspend(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }
}

register! { ProcessEntry "assign_ground_springs_process",
    aliases: &["AssignGroundSpringsProcess"],
    about: "connects the nodes of a part to the ground by springs along the axes",
    source: "f = −k u at each node",
    common: &["model_part_name"],
    defaults: include_str!("../../../../configs/processes/assign_ground_springs_process.json"),
    build: build,
}
