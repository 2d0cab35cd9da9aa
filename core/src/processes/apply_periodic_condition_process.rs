//! Periodic and cyclic symmetry: nodes of a part follow their images on another, u₂ = R u₁.
//!
//! A congruence x ↦ R (x − c) + c + d carries the first part onto the second. Vectors turn with it, scalars do not; as it is a motion of
//! the whole body, the relation holds for large displacements, too. A node of the second part whose image is a node of the first follows
//! that node; others follow the facet of the first on which they lie, by its shape functions. Where meshes are unlike the part with more
//! nodes follows. Nodes of both parts lie on the axis and move along it alone.
//!
//! The constraints are made before ranks share the mesh. A node that two of these processes make follow, as the corner of a cell that is
//! periodic in two directions, follows by the first; the second must ask for the same.

use std::collections::BTreeMap;

use super::congruence::Congruence;
use super::congruent_points::{CongruentPoints, NoImage};
use super::process::{Process, ProcessEntry, ProcessRequest};
use super::target::check_unknowns;
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Place, Report, Result};
use crate::model::{
    MasterSlaveConstraint, Model, ModelPart, Named, NodeUnknown, ScalarVariable, SubPart, VariableKind,
    bodies_of_nodes, named,
};
use crate::parameters::{Interval, Settings};
use crate::register;
use crate::vector3::{norm, scale};

const FIRST: &str = "first_model_part_name";
const SECOND: &str = "second_model_part_name";
const VARIABLES: &str = "variable_names";
const ANGLE: &str = "transformation_settings.rotation_settings.angle_degree";
const AXIS: &str = "transformation_settings.rotation_settings.axis_of_rotation";
const MAGNITUDE: &str = "transformation_settings.translation_settings.magnitude";
/// Difference from a whole number of sectors that is round-off of the angle.
const WHOLE: f64 = 1e-6;
/// Difference of weights that is round-off.
const SAME_WEIGHT: f64 = 1e-9;

/// A variable of the nodes: its components, which turn, or a number, which does not.
#[derive(Clone)]
enum Periodic {
    Vector(Vec<ScalarVariable>),
    Number(ScalarVariable),
}

/// Settings of the process.
struct Wanted {
    root: String,
    first: String,
    second: String,
    /// Where the deck names the second part.
    place: Place,
    congruence: Congruence,
    variables: Vec<Periodic>,
    tolerance: f64,
    /// Name of its constraints in messages.
    origin: String,
}

struct PeriodicCondition {
    wanted: Wanted,
    interval: Interval,
    /// Its constraints, by their place in the model part.
    made: Vec<usize>,
}

impl Wanted {
    fn new(request: &mut ProcessRequest<'_>) -> Result<(Self, Settings)> {
        let settings =
            request.settings_with(|defaults| defaults.require(&["model_part_name", FIRST, SECOND, VARIABLES]))?;
        let root = settings.get_str("model_part_name")?.split('.').next().unwrap_or_default().to_owned();
        let part = request.model.root(&root).map_err(|error| error.at(&settings.key_place("model_part_name")))?;
        let [first, second] = [FIRST, SECOND].map(|key| settings.get_str(key).map(str::to_owned));
        let (first, second) = (first?, second?);
        for (key, name) in [(FIRST, &first), (SECOND, &second)] {
            let found = part.part(name).map_err(|error| error.at(&settings.key_place(key)))?;
            if found.nodes.is_empty() && part.share.is_none() {
                let problem = settings.error(key, "empty-part", format!("{name} has no nodes"));
                return Err(problem.remedy("name a part with the nodes of a face").into());
            }
        }
        let congruence = congruence(&settings, part.info.domain_size)?;
        let names = settings.get_strings(VARIABLES)?;
        let variables = variables(&settings, &names, part.info.domain_size, congruence.turns())?;
        let origin = format!("{} of {} from {first} to {second}", settings.name(), names.join(", "));
        let place = settings.key_place(SECOND);
        let tolerance = settings.get_f64("search_settings.tolerance")?;
        Ok((Self { root, first, second, place, congruence, variables, tolerance, origin }, settings))
    }

    /// Places of its constraints in the model part.
    fn made(&self, part: &ModelPart) -> Vec<usize> {
        (0..part.constraints.len()).filter(|&at| part.constraints[at].origin == self.origin).collect()
    }
}

/// The motion that carries the first part onto the second.
fn congruence(settings: &Settings, space: usize) -> Result<Congruence> {
    let vector = |key: &str| -> Result<[f64; 3]> { settings.get(key)?.parse(key) };
    let (angle, magnitude) = (settings.get_f64(ANGLE)?, settings.get_f64(MAGNITUDE)?);
    let direction = "transformation_settings.translation_settings.dir_of_translation";
    let shift = scale(vector(direction)?, magnitude);
    if magnitude != 0.0 && norm(shift) == 0.0 {
        let problem = settings.error(direction, "invalid-direction", "\"dir_of_translation\" has no length");
        return Err(problem
            .remedy("write the direction from the first part to the second, e.g. [1.0, 0.0, 0.0]")
            .into());
    }
    if angle == 0.0 && magnitude == 0.0 {
        let fact = "neither \"angle_degree\" nor \"magnitude\" carries the first part onto the second";
        let problem = settings.error("transformation_settings", "no-transformation", fact);
        return Err(problem.remedy("write the angle of a sector, or the length of a period").into());
    }
    let mut axis = vector(AXIS)?;
    if space == 2 && norm(axis) == 0.0 {
        axis = [0.0, 0.0, 1.0];
    }
    if angle != 0.0 {
        let sectors = (360.0 / angle).abs();
        if (sectors - sectors.round()).abs() > WHOLE * sectors || sectors < 1.5 {
            let [fewer, more] = [sectors.floor().max(2.0), sectors.floor().max(2.0) + 1.0];
            let fact =
                format!("a full turn is {sectors:.6} times \"angle_degree\" {angle}, no whole number of sectors");
            let remedy =
                format!("{fewer} sectors have {:.12} degrees, {more} sectors {:.12}", 360.0 / fewer, 360.0 / more);
            return Err(settings.error(ANGLE, "cyclic-angle", fact).remedy(remedy).into());
        }
        if norm(axis) == 0.0 {
            let problem = settings.error(AXIS, "invalid-direction", "\"axis_of_rotation\" has no length");
            return Err(problem.remedy("write the axis of the sectors, e.g. [0.0, 0.0, 1.0]").into());
        }
        if space == 2 && (axis[0] != 0.0 || axis[1] != 0.0) {
            let problem = settings.error(AXIS, "invalid-direction", "the axis of a planar model is its normal");
            return Err(problem
                .remedy("write [0.0, 0.0, 1.0], and turn the angle where the axis points the other way")
                .into());
        }
    }
    let centre = vector("transformation_settings.rotation_settings.center")?;
    Ok(Congruence::new(centre, axis, angle.to_radians(), shift))
}

fn variables(settings: &Settings, names: &[String], space: usize, turns: bool) -> Result<Vec<Periodic>> {
    if names.is_empty() {
        let problem = settings.error(VARIABLES, "missing-key", "no variable is named");
        return Err(problem.remedy("name the unknowns of the nodes, a vector or a scalar").into());
    }
    let of_name = |name: &String| match named(name) {
        Some(Named::Whole(column, VariableKind::Vector3)) => {
            let component = |c: u8| ScalarVariable { column, component: Some(c) };
            Ok(Periodic::Vector((0..space as u8).map(component).collect()))
        }
        Some(Named::Whole(column, VariableKind::Scalar)) => {
            Ok(Periodic::Number(ScalarVariable { column, component: None }))
        }
        Some(Named::Component(variable)) if !turns => Ok(Periodic::Number(variable)),
        Some(Named::Component(variable)) => {
            let fact = format!("{name} alone does not turn with the sector");
            let remedy = format!("name the whole vector {}", variable.column);
            Err(settings.error(VARIABLES, "invalid-value", fact).remedy(remedy).into())
        }
        _ => {
            let fact = format!("{name:?} is no variable of nodes");
            Err(settings.error(VARIABLES, "unknown-variable", fact).remedy("name a scalar or a vector").into())
        }
    };
    names.iter().map(of_name).collect()
}

/// Makes the constraints, once.
fn prepare(request: &mut ProcessRequest<'_>) -> Result<()> {
    // Faults of the settings are told when the process is made.
    let Ok((wanted, _)) = Wanted::new(request) else { return Ok(()) };
    let part = request.model.root_mut(&wanted.root)?;
    if !wanted.made(part).is_empty() {
        return Ok(());
    }
    if part.share.is_some() {
        let fact = format!("ranks share the mesh already, and {} is joined in this stage only", wanted.second);
        let problem = Diagnostic::error("shared-mesh", fact).at(wanted.place);
        return Err(problem.remedy("list the process in the first stage, too, or run on one rank").into());
    }
    // The mesh is whole, and only the rank that reads it is here.
    let ranks = std::mem::take(&mut part.ranks);
    let follow = wanted.follow(part);
    part.ranks = ranks;
    let follow = follow?;
    let eliminated: BTreeMap<NodeUnknown, bool> =
        part.constraints.iter().map(|own| (own.slave, is_periodic(own))).collect();
    let (twice, new): (Vec<_>, Vec<_>) =
        follow.into_iter().partition(|own| eliminated.get(&own.slave).is_some_and(|periodic| *periodic));
    part.add_constraints(new);
    wanted.check_twice(part, &twice)
}

fn is_periodic(constraint: &MasterSlaveConstraint) -> bool {
    constraint.origin.starts_with("apply_periodic_condition_process")
}

/// An unknown by those that no constraint eliminates.
fn resolve(
    terms: &[(NodeUnknown, f64)],
    of_slave: &BTreeMap<NodeUnknown, &MasterSlaveConstraint>,
    depth: usize,
) -> BTreeMap<NodeUnknown, f64> {
    let mut sum = BTreeMap::new();
    for &(unknown, weight) in terms {
        let through = match of_slave.get(&unknown).filter(|_| depth < of_slave.len()) {
            Some(constraint) => resolve(&constraint.masters, of_slave, depth + 1),
            None => BTreeMap::from([(unknown, 1.0)]),
        };
        through.into_iter().for_each(|(master, share)| *sum.entry(master).or_insert(0.0) += weight * share);
    }
    sum
}

impl Wanted {
    /// The constraints that it asks for.
    fn follow(&self, part: &ModelPart) -> Result<Vec<MasterSlaveConstraint>> {
        let (first, second) = (part.part(&self.first)?, part.part(&self.second)?);
        let bodies = &bodies_of_nodes(part);
        let leading = CongruentPoints::new(part, first, bodies);
        let tolerance = self.tolerance * leading.size;
        let kept = leading.kept_by(&self.congruence, second, tolerance).map_err(|node| {
            let id = part.nodes.ids[node as usize];
            let fact =
                format!("node {id} belongs to {} and to {}, and the transformation moves it", self.first, self.second);
            let remedy = "nodes of both parts lie on the axis of rotation: take the others out of one part";
            Diagnostic::error("listed-twice", fact).at(self.place.clone()).remedy(remedy)
        })?;
        let forward = self.images(part, bodies, [first, second], &self.congruence.inverse(), &kept, tolerance);
        let backward = (!forward.as_ref().is_ok_and(Images::meet) && first.nodes.len() > second.nodes.len())
            .then(|| self.images(part, bodies, [second, first], &self.congruence, &kept, tolerance));
        let (images, rotation) = match backward {
            Some(Ok(images)) => (images, self.congruence.inverse().rotation),
            _ => (forward?, self.congruence.rotation),
        };
        let joined = images.slaves.iter().zip(&images.masters);
        let mut out: Vec<MasterSlaveConstraint> =
            joined.flat_map(|(&slave, masters)| self.constraints(slave, masters, &rotation)).collect();
        if self.congruence.turns() {
            out.extend(kept.iter().flat_map(|&node| self.on_axis(node)));
        }
        Ok(out)
    }

    /// The nodes of the second of two parts with those of the first that they follow; `back` carries the second onto the first.
    fn images(
        &self,
        part: &ModelPart,
        bodies: &[Option<usize>],
        [leading, following]: [&SubPart; 2],
        back: &Congruence,
        kept: &[u32],
        tolerance: f64,
    ) -> Result<Images> {
        let slaves: Vec<u32> =
            following.nodes.iter().copied().filter(|node| kept.binary_search(node).is_err()).collect();
        let points: Vec<(u32, [f64; 3])> =
            slaves.iter().map(|&node| (node, back.image(part.nodes.initial[node as usize]))).collect();
        let on = CongruentPoints::new(part, leading, bodies);
        let found = on.interpolated(&points, tolerance);
        let (mut masters, mut missed) = (Vec::with_capacity(slaves.len()), Vec::new());
        for (found, &node) in found.into_iter().zip(&slaves) {
            match found {
                Ok(found) => masters.push(found),
                Err(NoImage::Far(distance)) => missed.push((distance, node)),
                Err(NoImage::Several(nodes)) => return Err(self.ambiguous(part, node, &nodes).into()),
            }
        }
        if let Some(&(distance, node)) = missed.iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
            return Err(self.no_image(part, node, distance, missed.len() - 1, on.has_facets()).into());
        }
        Ok(Images { slaves, masters })
    }

    fn ambiguous(&self, part: &ModelPart, node: u32, nodes: &[u32]) -> Diagnostic {
        let ids: Vec<String> = nodes.iter().map(|&node| part.nodes.ids[node as usize].to_string()).collect();
        let fact = format!(
            "node {} of {} or {}, carried onto the other part, meets nodes {} there, and bodies do not tell which it follows",
            part.nodes.ids[node as usize],
            self.first,
            self.second,
            ids.join(", ")
        );
        let remedy = "list the process once for each body, with parts of its nodes alone";
        Diagnostic::error("ambiguous-image", fact).at(self.place.clone()).remedy(remedy)
    }

    fn no_image(&self, part: &ModelPart, node: u32, distance: f64, others: usize, has_facets: bool) -> Diagnostic {
        let id = part.nodes.ids[node as usize];
        let more = if others > 0 { format!(", and so {others} more") } else { String::new() };
        let (first, second) = (&self.first, &self.second);
        let fact = format!(
            "node {id} of {first} and {second}, carried onto the other part, is {distance:.3e} from its nearest node{more}"
        );
        let remedy = if has_facets {
            "check angle (its sign, too), axis, centre and shift: they carry the first part onto the second"
        } else {
            "check angle (its sign, too), axis, centre and shift; unlike meshes need conditions on the faces of both parts"
        };
        Diagnostic::error("no-image", fact).at(self.place.clone()).remedy(remedy)
    }

    /// The constraints of a node that follows others.
    fn constraints(&self, slave: u32, masters: &[(u32, f64)], rotation: &[[f64; 3]; 3]) -> Vec<MasterSlaveConstraint> {
        let one = |variable: ScalarVariable, terms: Vec<(NodeUnknown, f64)>| MasterSlaveConstraint {
            origin: self.origin.clone(),
            ..MasterSlaveConstraint::new((slave, variable), terms)
        };
        let of_variable = |variable: &Periodic| match variable {
            Periodic::Number(variable) => {
                vec![one(*variable, masters.iter().map(|&(node, weight)| ((node, *variable), weight)).collect())]
            }
            Periodic::Vector(components) => {
                let of_component = |(row, &own): (&[f64; 3], &ScalarVariable)| {
                    let of_master = |&(node, weight): &(u32, f64)| {
                        let terms = components.iter().zip(row).filter(|(_, entry)| **entry != 0.0);
                        terms.map(|(&other, entry)| ((node, other), weight * entry)).collect::<Vec<_>>()
                    };
                    one(own, masters.iter().flat_map(of_master).collect())
                };
                rotation.iter().zip(components).map(of_component).collect()
            }
        };
        self.variables.iter().flat_map(of_variable).collect()
    }

    /// The constraints of a node on the axis: vectors are along it.
    fn on_axis(&self, node: u32) -> Vec<MasterSlaveConstraint> {
        let axis = self.congruence.axis;
        let lead = (0..3).max_by(|&a, &b| axis[a].abs().total_cmp(&axis[b].abs())).unwrap_or(0);
        let of_variable = |variable: &Periodic| match variable {
            Periodic::Number(_) => Vec::new(),
            Periodic::Vector(components) => {
                let others = (0..components.len()).filter(|&c| c != lead);
                let of_component = |c: usize| {
                    let share = axis[c] / axis[lead];
                    let led = (lead < components.len() && share.abs() > SAME_WEIGHT)
                        .then(|| ((node, components[lead]), share));
                    MasterSlaveConstraint {
                        origin: self.origin.clone(),
                        ..MasterSlaveConstraint::new((node, components[c]), led.into_iter().collect())
                    }
                };
                others.map(of_component).collect()
            }
        };
        self.variables.iter().flat_map(of_variable).collect()
    }

    /// An error where a constraint for an unknown that an earlier process has eliminated asks for something else.
    fn check_twice(&self, part: &ModelPart, twice: &[MasterSlaveConstraint]) -> Result<()> {
        let of_slave: BTreeMap<NodeUnknown, &MasterSlaveConstraint> =
            part.constraints.iter().filter(|own| own.active).map(|own| (own.slave, own)).collect();
        let differs = |own: &&MasterSlaveConstraint| {
            let mut difference = resolve(&own.masters, &of_slave, 0);
            for (master, weight) in resolve(&[(own.slave, 1.0)], &of_slave, 0) {
                *difference.entry(master).or_insert(0.0) -= weight;
            }
            difference.values().any(|weight| weight.abs() > SAME_WEIGHT)
        };
        let Some(own) = twice.iter().find(differs) else { return Ok(()) };
        let id = part.nodes.ids[own.slave.0 as usize];
        let other = of_slave.get(&own.slave).map_or_else(String::new, |first| first.in_words());
        let fact = format!("{} of node {id} follows by {other} and otherwise by {}", own.slave.1, self.origin);
        let remedy = "give the edges of all periodic parts like meshes, or take the node out of one part";
        Err(Diagnostic::error("constraint-twice", fact).at(self.place.clone()).remedy(remedy).into())
    }
}

/// Nodes that follow, and those that they follow.
struct Images {
    slaves: Vec<u32>,
    masters: Vec<Vec<(u32, f64)>>,
}

impl Images {
    /// Whether each node follows one other.
    fn meet(&self) -> bool {
        self.masters.iter().all(|masters| masters.len() == 1)
    }
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let (wanted, settings) = Wanted::new(request)?;
    let interval = Interval::from_node(settings.get("interval")?)?;
    let made = wanted.made(request.model.root(&wanted.root)?);
    Ok(Box::new(PeriodicCondition { wanted, interval, made }))
}

impl PeriodicCondition {
    fn set_active(&self, model: &mut Model, active: bool) -> Result<()> {
        let part = model.root_mut(&self.wanted.root)?;
        self.made.iter().for_each(|&at| part.constraints[at].active = active);
        Ok(())
    }
}

impl Process for PeriodicCondition {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        self.set_active(model, true)
    }

    fn check(&self, model: &Model, system: &System, warnings: &mut Report) -> Result<()> {
        let part = model.root(&self.wanted.root)?;
        let own = || self.made.iter().map(|&at| &part.constraints[at]);
        check_unknowns(part, system, own().map(|constraint| constraint.slave), &self.wanted.place)?;
        let follows_several = |constraint: &&MasterSlaveConstraint| {
            constraint.masters.iter().any(|master| master.0.0 != constraint.masters[0].0.0)
        };
        let mut unlike: Vec<u32> = own().filter(follows_several).map(|constraint| constraint.slave.0).collect();
        unlike.dedup();
        if !unlike.is_empty() {
            let (first, second) = (&self.wanted.first, &self.wanted.second);
            let fact = format!(
                "the meshes of {first} and {second} are unlike: {} nodes follow facets by interpolation",
                unlike.len()
            );
            let note = Diagnostic::note("unlike-meshes", fact).at(self.wanted.place.clone());
            warnings.push(note.remedy("stresses near them are exact with like meshes alone"));
        }
        Ok(())
    }

    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        let time = model.root(&self.wanted.root)?.info.time;
        self.set_active(model, self.interval.contains(time))
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        self.set_active(model, false)
    }

    fn suspend(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }
}

register! { ProcessEntry "apply_periodic_condition_process",
    aliases: &["ApplyPeriodicConditionProcess"],
    about: "periodic and cyclic symmetry: nodes of a part follow their images on another",
    source: "u₂ = R u₁",
    common: &[FIRST, SECOND],
    prepares: prepare,
    defaults: include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../configs/processes/apply_periodic_condition_process.json"
    )),
    build: build,
}
