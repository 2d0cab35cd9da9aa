//! A rigid shape for contact: facets that move as a rigid body with a reference node, by [`super::kinematic_coupling`].
//!
//! In a model about an axis the shape moves along the axis alone.

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::entities::Interaction;
use zelus_core::model::{Model, ModelPart};
use zelus_core::parameters::{Defaults, Interval, Settings};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, Target};
use zelus_core::register;
use zelus_core::registry::named;
use zelus_core::vector3::{add, cross, dot, norm, scale, sub};

use super::explicit_inertia::ExplicitInertia;
use super::kinematic_coupling_process::{KinematicCouplingProcess, prepare_masses};
use super::reference_node::{PART, POINT, ReferenceNode, not_shared, prepare_at};
use super::rigid_shape_facets::{add_to_mesh, tell};
use crate::rigid_shapes::rigid_shape::{ShapeSpace, profile_error};
use crate::rigid_shapes::{RigidShapeEntry, ShapeFacets, ShapeRequest};
use crate::variables::{DISPLACEMENT, ROTATION};

/// Sine of the angle between two directions below which they are one.
const PARALLEL: f64 = 1e-9;

struct RigidShapeProcess {
    coupling: KinematicCouplingProcess,
    path: String,
    facets: ShapeFacets,
    /// Reference node of a model about an axis, which moves along the axis alone.
    on_axis: Option<u32>,
    inertia: ExplicitInertia,
}

fn required(defaults: Defaults) -> Defaults {
    defaults.require(&["model_part_name", PART, "shape"])
}

/// Axes of a shape in the model, and its origin.
struct Frame {
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
}

impl Frame {
    /// Where a point of the shape is in the model.
    fn place(&self, x: [f64; 3]) -> [f64; 3] {
        (0..3).fold(self.origin, |sum, c| add(sum, scale(self.axes[c], x[c])))
    }
}

/// The kind of a model.
fn space_of(part: &ModelPart) -> ShapeSpace {
    match part.info.domain_size {
        3 => ShapeSpace::Solid,
        _ if part.elements.kinds.iter().any(|kind| kind.of_revolution) => ShapeSpace::Revolution,
        _ => ShapeSpace::Plane,
    }
}

fn direction(settings: &Settings, key: &str, default: [f64; 3]) -> Result<[f64; 3]> {
    let node = settings.get(key)?;
    let given: [f64; 3] = if node.is_null() { default } else { node.parse(key)? };
    let size = norm(given);
    if !(size > 0.0 && size.is_finite()) {
        let problem = settings.error(key, "invalid-direction", format!("\"{key}\" has no length"));
        return Err(problem.remedy("write a direction, e.g. [0.0, 0.0, 1.0]").into());
    }
    Ok(scale(given, size.recip()))
}

fn frame(settings: &Settings, space: ShapeSpace) -> Result<Frame> {
    let mut origin: [f64; 3] = settings.get("position")?.parse("position")?;
    if space == ShapeSpace::Solid {
        let axis = direction(settings, "axis", [0.0, 0.0, 1.0])?;
        let across = if axis[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let given = direction(settings, "first_axis", across)?;
        let first = sub(given, scale(axis, dot(given, axis)));
        let size = norm(first);
        if size < PARALLEL {
            let problem = settings.error("first_axis", "invalid-direction", "\"first_axis\" is the axis of the shape");
            return Err(problem.remedy("write a direction across \"axis\", or leave it out").into());
        }
        let first = scale(first, size.recip());
        return Ok(Frame { origin, axes: [first, cross(axis, first), axis] });
    }
    let axis = direction(settings, "axis", [0.0, 1.0, 0.0])?;
    if axis[2] != 0.0 {
        let problem = settings.error("axis", "invalid-direction", "\"axis\" is not in the plane of the model");
        return Err(problem.remedy("write the direction of the shape's y axis, e.g. [0.0, 1.0, 0.0]").into());
    }
    let mut first = [axis[1], -axis[0], 0.0];
    if space == ShapeSpace::Revolution {
        if axis[0] != 0.0 || origin[0] != 0.0 {
            let key = if axis[0] != 0.0 { "axis" } else { "position" };
            let problem = settings.error(key, "rigid-shape", "the shape does not stand on the axis of the model");
            return Err(problem.remedy("write a \"position\" with x = 0 and an \"axis\" along y").into());
        }
        // Radii stay radii when the axis is turned round.
        first = [1.0, 0.0, 0.0];
    }
    origin[2] = 0.0;
    Ok(Frame { origin, axes: [first, axis, [0.0, 0.0, 1.0]] })
}

/// Facets of the shape in its own axes, and the frame.
fn shape(request: &ProcessRequest<'_>, settings: &Settings, space: ShapeSpace) -> Result<(ShapeFacets, Frame)> {
    let (entry, own) = named::<RigidShapeEntry>(settings.get("shape")?, "name")?;
    let shape = (entry.build)(&own, request.folder)?;
    let length = match settings.get("facet_size")? {
        node if node.is_null() => f64::INFINITY,
        _ => settings.get_positive("facet_size")?,
    };
    let angle = settings.get_f64("facet_angle")?.to_radians();
    let facets = shape.facets(&ShapeRequest { space, angle, length });
    let mut facets = facets.map_err(|fault| profile_error(settings, "shape", fault))?;
    let frame = frame(settings, space)?;
    let [first, second, third] = frame.axes;
    if dot(cross(first, second), third) < 0.0 {
        // Mirrored axes of a model about an axis.
        facets.facets.iter_mut().for_each(|facet| {
            let [a, b, _] = facet.points;
            facet.points = [b, a, a];
        });
    }
    Ok((facets, frame))
}

/// Makes the facets, the reference node and the masses of the body where they are missing.
fn prepare(request: &mut ProcessRequest<'_>) -> Result<()> {
    // Faults of the settings are told when the process is made.
    let Ok(settings) = request.settings_with(required) else { return Ok(()) };
    let path = settings.get_str("model_part_name")?.to_owned();
    let Ok(part) = request.model.root(&path) else { return Ok(()) };
    let (is_there, space) = (part.part(&path).is_ok(), space_of(part));
    let (facets, frame) = shape(request, &settings, space)?;
    let part = request.model.root_mut(&path)?;
    if !is_there {
        let place = settings.key_place("model_part_name");
        not_shared(part, &path, &place)?;
        let above = path.rsplit_once('.').map_or("", |(above, _)| above);
        part.part(above).map_err(|error| error.at(&place))?;
        add_to_mesh(part, &path, &facets.clone().moved(&|x| frame.place(x)))?;
    }
    tell(part, &path, &facets);
    let point = settings.get(POINT)?;
    let point = if point.is_null() { frame.origin } else { point.parse(POINT)? };
    prepare_at(request.model, &settings, Some(point))?;
    prepare_masses(request.model, &settings)
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(required)?;
    let (path, place) = (settings.get_str("model_part_name")?.to_owned(), settings.key_place("model_part_name"));
    let part = request.model.root(&path).map_err(|error| error.at(&place))?;
    part.part(&path).map_err(|error| error.at(&place))?;
    let space = space_of(part);
    let (facets, _) = shape(request, &settings, space)?;
    let part = request.model.root_mut(&path)?;
    tell(part, &path, &facets);
    if part.part(&path)?.conditions.iter().any(|at| !part.rigid_facets.contains_key(at)) {
        let fact = format!("{path} is a part of the mesh already");
        let problem = Diagnostic::error("rigid-shape", fact).at(place);
        return Err(problem.remedy("name a new part: the process makes the facets of the shape").into());
    }
    let target = Target { path: path.clone(), interval: Interval::ALWAYS, place, process: settings.name().to_owned() };
    let reference = ReferenceNode::new(&settings, part, &target)?;
    let on_axis = (space == ShapeSpace::Revolution).then_some(reference.node);
    let inertia = ExplicitInertia::of(&settings, part, &reference)?;
    let components = (0..part.info.domain_size as u8).collect();
    let large = settings.get_bool("large_rotations")?;
    let coupling = KinematicCouplingProcess::new(&settings, part, target, reference, (components, large))?;
    Ok(Box::new(RigidShapeProcess { coupling, path, facets, on_axis, inertia }))
}

impl Process for RigidShapeProcess {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.path)?;
        tell(part, &self.path, &self.facets);
        if let Some(node) = self.on_axis {
            for variable in [DISPLACEMENT.component(0), ROTATION.component(2)] {
                part.nodes.set_fixed(variable, &[node], true);
            }
        }
        self.coupling.initialize(model)
    }

    fn interaction(&mut self, model: &mut Model) -> Result<Option<(String, Box<dyn Interaction>)>> {
        self.coupling.interaction(model)
    }

    fn before_loop(&mut self, model: &mut Model) -> Result<()> {
        self.coupling.before_loop(model)
    }

    fn constrain(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root(&self.path)?;
        if part.info.solver.explicit {
            self.inertia.check(part)?;
        }
        self.coupling.constrain(model)
    }

    fn check(&self, model: &Model, system: &System, warnings: &mut Report) -> Result<()> {
        self.coupling.check(model, system, warnings)
    }

    fn drives(&self, part: &ModelPart, system: &System) -> bool {
        self.coupling.drives(part, system)
    }

    fn end_step(&mut self, model: &mut Model, system: &System) -> Result<()> {
        self.coupling.end_step(model, system)
    }

    fn summary(&self) -> Vec<(&'static str, f64)> {
        self.coupling.summary()
    }

    fn last_messages(&self, model: &Model) -> Vec<Diagnostic> {
        self.coupling.last_messages(model)
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        self.coupling.finalize(model)
    }

    fn suspend(&mut self, model: &mut Model) -> Result<()> {
        self.coupling.suspend(model)
    }
}

register! { ProcessEntry "rigid_shape_process",
    about: "a rigid shape that touches deformable bodies: plane, sphere, cylinder, cone, torus, profile or STL surface",
    source: "u_i = u_R + (exp [θ]× − I) r_i",
    common: &["model_part_name", "reference_model_part_name", "shape"],
    prepares: prepare,
    defaults: include_str!("../../../../configs/processes/rigid_shape_process.json"),
    build: build,
}
