//! Reference node of a coupling: DISPLACEMENT and ROTATION, POINT_LOAD and POINT_MOMENT, and their reactions.
//!
//! It is the node of a part of the mesh, or is made at a point. A `PointLoadCondition` and a `PointMomentCondition` there give it its
//! unknowns and take its loads.

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::model::{Model, ModelPart, ScalarVariable, SubPart};
use zelus_core::names::{Name, lasting};
use zelus_core::parameters::{Defaults, Settings};
use zelus_core::processes::{ProcessRequest, Target, check_unknowns};
use zelus_core::vector3::{norm, sub};

use super::nodal_conditions::add_conditions_to_mesh;
use crate::variables::{
    ANGULAR_ACCELERATION, ANGULAR_VELOCITY, DISPLACEMENT, POINT_LOAD, POINT_MOMENT, REACTION, REACTION_MOMENT,
    ROTATION, VELOCITY, WHOLE_TURNS,
};

/// Keys of its settings.
pub(super) const PART: &str = "reference_model_part_name";
pub(super) const POINT: &str = "reference_point";
/// Distance from the given point, as a share of its distance from the origin and of 1, that is round-off.
const AT_POINT: f64 = 1e-9;
/// Rotation beyond which a coupling for small rotations is off by its square (radian).
const LARGE: f64 = 0.1;

/// Keys without a default.
pub(super) fn required(defaults: Defaults) -> Defaults {
    defaults.require(&["model_part_name", PART])
}

/// The reference node of a coupling.
#[derive(Debug, Clone)]
pub(super) struct ReferenceNode {
    /// Its index.
    pub node: u32,
    /// Where the deck names its part.
    place: Place,
    /// Numbers of the report: their names and variables.
    numbers: Vec<(Name, ScalarVariable)>,
    values: Vec<f64>,
    /// Largest rotation so far, with its time.
    largest: [f64; 2],
}

/// Components of a vector that displacements, and of one that rotations have.
pub(super) fn components(space: usize) -> [&'static [u8]; 2] {
    if space == 2 { [&[0, 1], &[2]] } else { [&[0, 1, 2], &[0, 1, 2]] }
}

/// Makes the reference node, its part and its conditions where they are missing.
pub(super) fn prepare(request: &mut ProcessRequest<'_>) -> Result<()> {
    // Faults of the settings are told when the process is made.
    let Ok(settings) = request.settings_with(required) else { return Ok(()) };
    let coupled = settings.get_str("model_part_name")?;
    if request.model.root(coupled).and_then(|root| root.part(coupled)).is_err() {
        return Ok(());
    }
    let point = settings.get(POINT)?;
    let point: Option<[f64; 3]> = if point.is_null() { None } else { Some(point.parse(POINT)?) };
    prepare_at(request.model, &settings, point)
}

/// As [`prepare`]; a part that is missing is made with a node at a point, if there is one.
pub(super) fn prepare_at(model: &mut Model, settings: &Settings, point: Option<[f64; 3]>) -> Result<()> {
    let (path, place) = (settings.get_str(PART)?.to_owned(), settings.key_place(PART));
    let Ok(part) = model.root_mut(&path) else { return Ok(()) };
    if part.part(&path).is_err() {
        let Some(point) = point else { return Ok(()) };
        not_shared(part, &path, &place)?;
        let (above, name) = path.rsplit_once('.').unwrap_or(("", &path));
        part.part(above).map_err(|error| error.at(&place))?;
        let node = part.add_node(point);
        part.along(above, |own| own.nodes.push(node));
        let new = SubPart { nodes: vec![node], ..SubPart::new(name) };
        part.part_mut(above)?.children.insert(name.to_owned(), new);
        part.tree.normalise();
    }
    let [node] = part.part(&path)?.nodes[..] else { return Ok(()) };
    for variable in [&ROTATION, &WHOLE_TURNS, &POINT_LOAD, &POINT_MOMENT, &REACTION_MOMENT] {
        part.nodes.history.add(variable);
    }
    if part.nodes.history.has(VELOCITY.name()) {
        part.nodes.history.add(&ANGULAR_VELOCITY);
        part.nodes.history.add(&ANGULAR_ACCELERATION);
    }
    for name in ["PointLoadCondition", "PointMomentCondition"] {
        let is_there =
            |at: u32| part.conditions.kinds[at as usize].name.starts_with(name) && part.conditions.nodes(at) == [node];
        if !(0..part.conditions.len() as u32).any(is_there) {
            not_shared(part, &path, &place)?;
            let made = add_conditions_to_mesh(part, name, &[node])?;
            part.along(&path, |own| own.conditions.extend(made.clone().map(|at| at as u32)));
            part.tree.normalise();
        }
    }
    Ok(())
}

/// Refuses a coupling of bodies of revolution.
///
/// # Errors
/// A model with elements of revolution.
pub(super) fn refuse_revolution(part: &ModelPart, coupled: &Target) -> Result<()> {
    let Some(kind) = part.elements.kinds.iter().find(|kind| kind.name.contains("Axisym")) else { return Ok(()) };
    let fact = format!("{} are of a body of revolution, which cannot rotate as a whole", kind.name);
    let problem = Diagnostic::error("axisymmetric-coupling", fact).at(coupled.place.clone());
    Err(problem.remedy("model the body in space").into())
}

/// Refuses a coupling in explicit steps, whose masses are those of nodes and not of a rigid body.
///
/// # Errors
/// A model of explicit steps.
pub(super) fn refuse_explicit(part: &ModelPart, coupled: &Target) -> Result<()> {
    if !part.info.solver.explicit {
        return Ok(());
    }
    let fact = "explicit steps have no inertia for rotations of a reference node";
    let problem = Diagnostic::error("explicit-coupling", fact).at(coupled.place.clone());
    Err(problem.remedy("use an implicit or a static solver").into())
}

pub(super) fn not_shared(part: &ModelPart, path: &str, place: &Place) -> Result<()> {
    if part.share.is_none() {
        return Ok(());
    }
    let fact = format!("ranks share the mesh already, and {path} is a reference node in this stage only");
    let problem = Diagnostic::error("shared-mesh", fact).at(place.clone());
    Err(problem.remedy("list the process in the first stage, too, or run on one rank").into())
}

impl ReferenceNode {
    /// The reference node that the settings name.
    ///
    /// # Errors
    /// A part of no node or of several, a node elsewhere than at the point given.
    pub fn new(settings: &Settings, part: &ModelPart, coupled: &Target) -> Result<Self> {
        let (path, place) = (settings.get_str(PART)?, settings.key_place(PART));
        let nodes = &part.part(path).map_err(|error| error.at(&place))?.nodes;
        let [node] = nodes[..] else {
            let fact = format!("{path} has {} nodes, and a coupling one reference node", nodes.len());
            let problem = settings.error(PART, "reference-node", fact);
            return Err(problem.remedy("name a part with one node, or a new one with \"reference_point\"").into());
        };
        let point = settings.get(POINT)?;
        if !point.is_null() {
            let point: [f64; 3] = point.parse(POINT)?;
            let off = norm(sub(part.nodes.initial[node as usize], point));
            if off > AT_POINT * norm(point).max(1.0) {
                let fact = format!("node {} of {path} does not stand at \"{POINT}\"", part.nodes.ids[node as usize]);
                let problem = settings.error(POINT, "reference-node", fact);
                return Err(problem.remedy("leave the point out, or name a part that is not there yet").into());
            }
        }
        let problem = |code, fact: String, remedy: &str| {
            Diagnostic::error(code, fact).at(coupled.place.clone()).remedy(remedy.to_owned())
        };
        let others = &coupled.selection(&part.tree)?.nodes;
        if others.is_empty() {
            let fact = format!("{} has no nodes: nothing is coupled to the reference node", coupled.path);
            return Err(problem("empty-part", fact, "name a part with the nodes of a surface").into());
        }
        if others.contains(&node) {
            let fact = format!("the reference node {} belongs to {}", part.nodes.ids[node as usize], coupled.path);
            return Err(problem("reference-node", fact, "take it out of that part").into());
        }
        let [u, theta] = components(part.info.domain_size);
        let wanted = [(&DISPLACEMENT, u), (&ROTATION, theta), (&REACTION, u), (&REACTION_MOMENT, theta)];
        let name = |variable: ScalarVariable| (lasting(&format!("{variable} of {path}")), variable);
        let numbers = wanted.into_iter().flat_map(|(of, own)| own.iter().map(move |&c| name(of.component(c))));
        Ok(Self { node, place, numbers: numbers.collect(), values: Vec::new(), largest: [0.0; 2] })
    }

    /// Its unknowns: displacements and rotations.
    pub fn unknowns(&self, space: usize) -> impl Iterator<Item = (u32, ScalarVariable)> {
        let [u, theta] = components(space);
        let node = self.node;
        let displacements = u.iter().map(move |&c| (node, DISPLACEMENT.component(c)));
        displacements.chain(theta.iter().map(move |&c| (node, ROTATION.component(c))))
    }

    /// # Errors
    /// A node without displacements or rotations.
    pub fn check(&self, part: &ModelPart, system: &System) -> Result<()> {
        check_unknowns(part, system, self.unknowns(part.info.domain_size), &self.place)
    }

    /// Takes the numbers of an accepted step; collective.
    pub fn see(&mut self, part: &ModelPart) {
        let is_own = part.owns_node(self.node as usize);
        let value = |variable| part.nodes.history.value(variable, self.node as usize, 0).filter(|_| is_own);
        self.values = self.numbers.iter().map(|&(_, variable)| value(variable).unwrap_or(0.0)).collect();
        if part.share.is_some() {
            part.ranks.sum(&mut self.values);
        }
        let rotations = self.numbers.iter().zip(&self.values).filter(|((_, of), _)| of.column == ROTATION.name());
        let size = rotations.map(|(_, value)| value * value).sum::<f64>().sqrt();
        if size > self.largest[0] {
            self.largest = [size, part.info.time];
        }
    }

    /// Numbers for the report.
    pub fn summary(&self) -> Vec<(&'static str, f64)> {
        self.numbers.iter().map(|(name, _)| *name).zip(self.values.iter().copied()).collect()
    }

    /// The warning that a coupling for small rotations has rotated far.
    pub fn large_rotation(&self, part: &ModelPart) -> Option<Diagnostic> {
        let [size, time] = self.largest;
        let fact = format!(
            "reference node {} rotates by {size:.3e} rad at time {time}, and its coupling holds for small rotations: arms grow by half \
             the square of that",
            part.nodes.ids[self.node as usize]
        );
        let problem = Diagnostic::warning("large-rotation", fact).at(self.place.clone());
        let remedy = "set \"large_rotations\": true and use elements of large displacements";
        (size > LARGE).then(|| problem.remedy(remedy))
    }
}
