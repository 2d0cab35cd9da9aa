//! Clearance or interference of two surfaces by number: slave nodes are moved to a distance from the master before the run.
//!
//! Initial positions move, so that nothing is strained. Contact then has that clearance, or presses by the interference from the first step.
//! The mesh is whole when this is done; ranks share it afterwards. Nodes carry their clearance, which checks of the start take into account.

use std::collections::BTreeMap;

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::model::{ModelPart, PropertyValue};
use zelus_core::parameters::{Defaults, Settings};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::{Result, register};

use crate::interface::interfaces;
use crate::search::set_clearance;

const MASTER: &str = "master_model_part_name";
/// Data of the part of the slaves: the clearance that its nodes have got.
const SET: &str = "INITIAL_CLEARANCE";

/// Nodes that have been moved by a clearance.
struct InitialClearance(f64);

fn required(defaults: Defaults) -> Defaults {
    defaults.require(&["model_part_name", MASTER, "clearance"])
}

/// Part and settings of the process.
fn wanted(request: &mut ProcessRequest<'_>) -> Result<(Settings, String, String)> {
    let settings = request.settings_with(required)?;
    let paths = ["model_part_name", MASTER].map(|key| -> Result<String> {
        let (path, place) = (settings.get_str(key)?, settings.key_place(key));
        request.model.root(path).and_then(|root| root.part(path)).map_err(|error| error.at(&place))?;
        Ok(path.to_owned())
    });
    let [slave, master] = paths;
    let (slave, master) = (slave?, master?);
    if slave.split('.').next() != master.split('.').next() {
        let fact = format!("{slave} and {master} belong to different root parts");
        return Err(settings.error(MASTER, "unknown-model-part", fact).remedy("name two parts of one model").into());
    }
    if !settings.get_f64("clearance")?.is_finite() {
        return Err(settings.error("clearance", "invalid-value", "\"clearance\" is not finite").into());
    }
    Ok((settings, slave, master))
}

/// Moves the nodes, once.
fn prepare(request: &mut ProcessRequest<'_>) -> Result<()> {
    // Faults of the settings are told when the process is made.
    let Ok((settings, slave, master)) = wanted(request) else { return Ok(()) };
    let (clearance, tolerance) = (settings.get_f64("clearance")?, settings.get_f64("adjust_tolerance")?);
    let part = request.model.root_mut(&slave)?;
    if part.part(&slave)?.data.contains_key(SET) || part.info.step > 0 {
        return Ok(());
    }
    let place = settings.key_place("model_part_name");
    if part.share.is_some() {
        let fact = format!("ranks share the mesh already, and nodes of {slave} are moved in this stage only");
        let problem = Diagnostic::error("shared-mesh", fact).at(place);
        return Err(problem.remedy("list the process in the first stage, too, or run on one rank").into());
    }
    // Only the rank that reads the mesh is here.
    let ranks = std::mem::take(&mut part.ranks);
    let moved = move_nodes(part, [&slave, &master], clearance, tolerance, place);
    part.ranks = ranks;
    request.report.push(moved?);
    part.part_mut(&slave)?.data.insert(SET.to_owned(), PropertyValue::Number(clearance));
    Ok(())
}

/// Moves the nodes of the first part; says how.
fn move_nodes(
    part: &mut ModelPart,
    [slave, master]: [&str; 2],
    clearance: f64,
    tolerance: f64,
    place: Place,
) -> Result<Diagnostic> {
    let key = "0".to_owned();
    let parts = BTreeMap::from([(key.clone(), vec![slave.to_owned(), master.to_owned()])]);
    let slaves = BTreeMap::from([(key, vec![slave.to_owned()])]);
    // Contact marks the same nodes.
    let flags = part.nodes.flags.clone();
    let found = interfaces(part, &parts, &slaves);
    part.nodes.flags = flags;
    let found = found.map_err(|error| error.at(&place))?;
    let moved = found.iter().find_map(|interface| set_clearance(part, interface, clearance, tolerance));
    moved.ok_or_else(|| {
        let fact = format!("no node of {slave} has {master} before it within {tolerance} mesh sizes");
        let problem = Diagnostic::error("nothing-to-adjust", fact).at(place);
        problem.remedy("check the two surfaces, or raise \"adjust_tolerance\"").into()
    })
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let (settings, slave, _) = wanted(request)?;
    let clearance = settings.get_f64("clearance")?;
    let own = request.model.root(&slave)?.part(&slave)?;
    if own.data.get(SET).is_some_and(|set| *set != PropertyValue::Number(clearance)) {
        let fact = format!("the nodes of {slave} have been given another clearance");
        let problem = settings.error("clearance", "listed-twice", fact);
        return Err(problem.remedy("name each slave part once, with one clearance for all stages").into());
    }
    Ok(Box::new(InitialClearance(clearance)))
}

impl Process for InitialClearance {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        self.0 < 0.0
    }
}

register! { ProcessEntry "initial_clearance_process",
    aliases: &["InitialClearanceProcess"],
    about: "clearance or interference of two surfaces by number: slave nodes are moved before the run, without strain",
    source: "x ← x + (d − c) n",
    common: &["model_part_name", MASTER],
    prepares: prepare,
    defaults: include_str!("../../../../configs/processes/initial_clearance_process.json"),
    build: build,
}
