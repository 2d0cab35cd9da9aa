//! Spreads a force, and a moment, over a part so that their totals are exact: [`super::resultant`].
//!
//! Nodal forces are those of the initial geometry. Dead loads keep their directions; follower loads follow the mean rotation of the
//! part at the start of each step. Each node of the part gets a
//! `ResultantLoadCondition`, so that the mesh needs no load conditions. On a body of revolution the force is that on the whole turn, along
//! the axis.

use std::ops::Range;

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::model::{Model, ModelPart};
use zelus_core::parameters::{Settings, SpaceTime};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, ScalarValue, Target, check_unknowns};
use zelus_core::register;
use zelus_core::vector3::dot;

use super::nodal_conditions::add_conditions;
use super::resultant::{Resultant, is_of_revolution};
use crate::variables::{DISPLACEMENT, RESULTANT_LOAD};

struct DistributeLoad {
    target: Target,
    force: [ScalarValue; 3],
    moment: [ScalarValue; 3],
    /// Point of the force; `None`: the centre.
    point: Option<[f64; 3]>,
    resultant: Resultant,
    /// Whether the load follows the mean rotation of the part.
    follower: bool,
    /// Its conditions, one a node.
    made: Range<usize>,
}

/// Three numbers, functions or tables.
fn vector(settings: &Settings, key: &str) -> Result<[ScalarValue; 3]> {
    let node = settings.get(key)?;
    if node.is_null() {
        return Ok([const { ScalarValue::Number(0.0) }; 3]);
    }
    let Some([x, y, z]) = node.as_array() else {
        let fact = format!("{key:?} must be three numbers, functions or tables, found {node}");
        return Err(settings.error(key, "wrong-type", fact).remedy("write e.g. [0.0, \"-100.0*t\", 0.0]").into());
    };
    Ok([ScalarValue::from_node(x)?, ScalarValue::from_node(y)?, ScalarValue::from_node(z)?])
}

fn build_force(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name", "load"]))?;
    let force = vector(&settings, "load")?;
    made(request, &settings, force, [const { ScalarValue::Number(0.0) }; 3], None, false)
}

fn build_resultant(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name"]))?;
    let (force, moment) = (vector(&settings, "force")?, vector(&settings, "moment")?);
    let point = settings.get("point")?;
    let point = (!point.is_null()).then(|| point.parse("point")).transpose()?;
    let follower = settings.get_bool("follower")?;
    made(request, &settings, force, moment, point, follower)
}

fn made(
    request: &mut ProcessRequest<'_>,
    settings: &Settings,
    force: [ScalarValue; 3],
    moment: [ScalarValue; 3],
    point: Option<[f64; 3]>,
    follower: bool,
) -> Result<Box<dyn Process>> {
    let target = Target::new(settings, request.model)?;
    let part = request.model.root(&target.path)?;
    let problem = |code, fact: String, remedy: &str| {
        Diagnostic::error(code, fact).at(target.place.clone()).remedy(remedy.to_owned())
    };
    let of_revolution = is_of_revolution(part);
    if of_revolution {
        let is_off_axis = point.is_some_and(|point: [f64; 3]| point[0] != 0.0);
        let refused = [
            (!(force[0].is_zero() && force[2].is_zero()), "a force along the radius cancels over the whole turn"),
            (!moment.iter().all(ScalarValue::is_zero), "the body has no rotation on which a moment could act"),
            (is_off_axis, "the force on the whole turn acts on the axis, and \"point\" lies beside it"),
            (follower, "the force on the whole turn keeps its direction, that of the axis"),
        ];
        if let Some((_, why)) = refused.into_iter().find(|(is_refused, _)| *is_refused) {
            let fact = format!("{} is of a body of revolution: {why}", target.path);
            let remedy = "give the force along y alone, that on the whole turn; for loads along the radius use PRESSURE, or \
                          LINE_LOAD (force per area)";
            return Err(problem("axisymmetric-resultant", fact, remedy).into());
        }
    }
    // A force on the whole turn is one at the centre of the section.
    let point = point.filter(|_| !of_revolution);
    if part.info.domain_size == 2 {
        let lost = !(force[2].is_zero() && moment[0].is_zero() && moment[1].is_zero());
        if lost {
            let fact = format!("the load on {} has a part out of the plane", target.path);
            return Err(problem("out-of-plane", fact, "give x and y of the force, and z of the moment").into());
        }
    }
    let resultant = Resultant::of(part, target.selection(&part.tree)?);
    if resultant.nodes().len() == 0 {
        let fact = format!("{} has no nodes to which a load could be given", target.path);
        return Err(problem("empty-part", fact, "name a part with the conditions or nodes of the surface").into());
    }
    if !(resultant.area > 0.0 && resultant.area.is_finite()) {
        let fact = format!("the area of {} is {}", target.path, resultant.area);
        return Err(problem("zero-area", fact, "check the nodes of its conditions").into());
    }
    if follower && resultant.rotation(part).is_none() {
        let fact = format!("the nodes of {} lie on a line, whose rotation about itself is unknown", target.path);
        return Err(problem("moment-without-arm", fact, "name a surface, or set \"follower\": false").into());
    }
    Ok(Box::new(DistributeLoad { target, force, moment, point, resultant, follower, made: 0..0 }))
}

impl DistributeLoad {
    /// The forces at the nodes at a time.
    fn forces(&self, time: f64) -> Result<Vec<[f64; 3]>> {
        let point = self.point.unwrap_or(self.resultant.centre);
        let here = SpaceTime { current: point, initial: point, time };
        let [force, moment] =
            [&self.force, &self.moment].map(|values| values.each_ref().map(|value| value.value(&here)));
        if let Some(wrong) = force.iter().chain(&moment).find(|value| !value.is_finite()) {
            let variable = RESULTANT_LOAD.component(0);
            return Err(self.target.not_finite(variable, *wrong, time, "the point of the load").into());
        }
        self.resultant.forces(force, moment, point).ok_or_else(|| {
            let fact =
                format!("the nodes of {} lie on a line or at a point and cannot take the moment", self.target.path);
            Diagnostic::error("moment-without-arm", fact)
                .at(self.target.place.clone())
                .remedy("name a part whose nodes lie around the axis of the moment, or leave the moment out")
                .into()
        })
    }

    fn give(&self, part: &mut ModelPart, forces: &[[f64; 3]]) {
        part.conditions.data.add(&RESULTANT_LOAD);
        let column = part.conditions.data.values_mut(&RESULTANT_LOAD, 0);
        let own = column[3 * self.made.start..3 * self.made.end].as_chunks_mut::<3>().0;
        own.iter_mut().zip(forces).for_each(|(own, force)| *own = *force);
    }
}

impl Process for DistributeLoad {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let nodes: Vec<u32> = self.resultant.nodes().collect();
        self.made = add_conditions(part, "ResultantLoadCondition", &nodes)?;
        Ok(())
    }

    fn check(&self, model: &Model, system: &System, warnings: &mut Report) -> Result<()> {
        let part = model.root(&self.target.path)?;
        let unknowns = self.resultant.nodes().map(|node| (node, DISPLACEMENT.component(0)));
        check_unknowns(part, system, unknowns, &self.target.place)?;
        if !self.resultant.by_area {
            let count = self.resultant.nodes().len();
            let fact = format!("{} has no lines or surfaces: its {count} nodes take equal shares", self.target.path);
            let note = Diagnostic::note("equal-shares", fact).at(self.target.place.clone());
            warnings.push(note.remedy("name a part with conditions to spread the load by area"));
        }
        self.forces(self.target.interval.begin.max(1.0).min(self.target.interval.end)).map(drop)
    }

    fn drives(&self, part: &ModelPart, _system: &System) -> bool {
        self.target.is_of(part) && !self.force.iter().chain(&self.moment).all(ScalarValue::is_zero)
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let time = part.info.time;
        let mut forces = match self.target.interval.contains(time) {
            true => self.forces(time)?,
            false => vec![[0.0; 3]; self.made.len()],
        };
        if let Some(rotation) = self.resultant.rotation(part).filter(|_| self.follower) {
            forces.iter_mut().for_each(|force| *force = rotation.map(|row| dot(row, *force)));
        }
        self.give(part, &forces);
        Ok(())
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        let none = vec![[0.0; 3]; self.made.len()];
        self.give(model.root_mut(&self.target.path)?, &none);
        Ok(())
    }

    fn suspend(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }
}

register! { ProcessEntry "distribute_load_on_surface_process",
    aliases: &["DistributeLoadOnSurfaceProcess"],
    about: "spreads a force over the area of a part",
    source: "f_i = F ∫ N_i dA / A",
    common: &["model_part_name"],
    defaults: include_str!("../../../../configs/processes/distribute_load_on_surface_process.json"),
    build: build_force,
}

register! { ProcessEntry "distribute_resultant_on_part_process",
    aliases: &["DistributeResultantOnPartProcess"],
    about: "spreads a force at a point and a moment over a surface, an edge or points: a remote load",
    source: "f_i = ∫ N_i (F/A + θ × r) dA with J θ = M",
    common: &["model_part_name"],
    defaults: include_str!("../../../../configs/processes/distribute_resultant_on_part_process.json"),
    build: build_resultant,
}
