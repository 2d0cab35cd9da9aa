//! Ties the nodes of a part to one of them: u = relation · u_master + constant.
//!
//! One constraint a node and component; the constraints hold in steps whose TIME is in the interval.

use std::ops::Range;

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Place, Report, Result};
use zelus_core::model::{MasterSlaveConstraint, Model, ModelPart, ScalarVariable, SubPart};
use zelus_core::parameters::{Interval, Settings};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, check_unknowns, scalars_of};
use zelus_core::register;

struct ImposeRigidMovement {
    root: String,
    interval: Interval,
    place: Place,
    /// Slave and master of each component.
    variables: Vec<(ScalarVariable, ScalarVariable)>,
    master: u32,
    slaves: Vec<u32>,
    holder: String,
    relation: f64,
    constant: f64,
    /// The constraints it made, by their place in the model part.
    made: Range<usize>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings()?;
    let root = settings.get_str("main_model_part_name")?.to_owned();
    let place = settings.key_place("model_part_name");
    let part = request.model.root_mut(&root).map_err(|e| e.at(&settings.key_place("main_model_part_name")))?;
    let name = settings.get_str("model_part_name")?;
    let nodes = part.part(name).map_err(|e| e.at(&place))?.nodes.clone();
    let id = settings.get_usize("master_node_id")?;
    let master = if id == 0 { nodes.first().copied() } else { part.nodes.find(id) };
    let master = master.ok_or_else(|| match id {
        0 => Diagnostic::error("empty-part", format!("the model part {name:?} has no nodes")).at(place.clone()),
        _ => settings.error("master_node_id", "unknown-node", format!("there is no node {id}")),
    })?;
    let masters = components(&settings, "master_variable_name", part.info.domain_size)?;
    let slaves = match settings.get_str("slave_variable_name")? {
        "" => masters.clone(),
        _ => components(&settings, "slave_variable_name", part.info.domain_size)?,
    };
    if slaves.len() != masters.len() {
        let fact = "\"slave_variable_name\" and \"master_variable_name\" differ in their number of components";
        return Err(settings.error("slave_variable_name", "wrong-type", fact).into());
    }
    let holder = match settings.get_str("new_model_part_name")? {
        "" => name,
        new => new,
    };
    Ok(Box::new(ImposeRigidMovement {
        root,
        interval: Interval::from_node(settings.get("interval")?)?,
        place,
        variables: slaves.into_iter().zip(masters).collect(),
        master,
        slaves: nodes.into_iter().filter(|&n| n != master).collect(),
        holder: holder.to_owned(),
        relation: settings.get_f64("relation")?,
        constant: settings.get_f64("constant")?,
        made: 0..0,
    }))
}

/// The numbers that a variable of these settings stands for.
fn components(settings: &Settings, key: &str, domain_size: usize) -> Result<Vec<ScalarVariable>> {
    let name = settings.get_str(key)?;
    scalars_of(name, domain_size).ok_or_else(|| {
        let fact = format!("{name:?} is no variable of nodes");
        let remedy = "name a scalar, a vector or a component, e.g. \"DISPLACEMENT\"";
        settings.error(key, "unknown-variable", fact).remedy(remedy).into()
    })
}

impl Process for ImposeRigidMovement {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        self.constant != 0.0
    }

    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.root)?;
        let pairs = self.slaves.iter().flat_map(|&node| self.variables.iter().map(move |&pair| (node, pair)));
        let active = self.interval.contains(part.info.time);
        let follows = |(node, (slave, master))| MasterSlaveConstraint {
            constant: self.constant,
            active,
            ..MasterSlaveConstraint::new((node, slave), vec![((self.master, master), self.relation)])
        };
        let new: Vec<_> = pairs.map(follows).collect();
        self.made = part.add_constraints(new);
        if part.part(&self.holder).is_err() {
            let nodes = self.slaves.iter().copied().chain([self.master]).collect();
            let mut new = SubPart { nodes, ..SubPart::new(self.holder.clone()) };
            new.normalise();
            part.tree.children.insert(self.holder.clone(), new);
        }
        part.part_mut(&self.holder)?.constraints.extend(self.made.start as u32..self.made.end as u32);
        part.tree.normalise();
        Ok(())
    }

    fn check(&self, model: &Model, system: &System, _warnings: &mut Report) -> Result<()> {
        let unknowns = self.variables.iter().flat_map(|&(slave, master)| {
            self.slaves.iter().map(move |&node| (node, slave)).chain([(self.master, master)])
        });
        check_unknowns(model.root(&self.root)?, system, unknowns, &self.place)
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.root)?;
        let active = self.interval.contains(part.info.time);
        part.constraints[self.made.clone()].iter_mut().for_each(|constraint| constraint.active = active);
        Ok(())
    }
}

register! { ProcessEntry "impose_rigid_movement_process",
    aliases: &["ImposeRigidMovementProcess"],
    about: "ties the nodes of a part to one of them by linear constraints",
    source: "eqs. D.12a–e",
    common: &["model_part_name", "master_node_id"],
    defaults: include_str!("../../../../configs/processes/impose_rigid_movement_process.json"),
    build: build,
}
