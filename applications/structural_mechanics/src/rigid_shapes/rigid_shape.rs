//! A rigid shape by name.

use std::path::Path;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::parameters::Settings;
use zelus_core::registered_kind;

use super::profile::{Profile, ProfileFault, Segment};
use super::shape_facets::ShapeFacets;

/// The kind of model in which a shape stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShapeSpace {
    /// In space.
    Solid,
    /// In the plane: the section of the shape.
    Plane,
    /// In a model about an axis: the meridian of the shape.
    Revolution,
}

/// Facets that are wanted of a shape.
#[derive(Debug, Clone, Copy)]
pub struct ShapeRequest {
    /// Where the shape stands.
    pub space: ShapeSpace,
    /// Largest angle that a facet of an arc spans (radian).
    pub angle: f64,
    /// Largest length of a facet.
    pub length: f64,
}

/// A rigid shape in axes of its own.
///
/// In space those are x, y and z, and shapes of revolution turn about z. In a model about an axis they are r and z, in the plane x and y;
/// there y is the axis z of shapes of revolution.
pub trait RigidShape: Send + Sync {
    /// Its facets.
    ///
    /// # Errors
    /// A shape that is none, or has none in such a model.
    fn facets(&self, request: &ShapeRequest) -> Result<ShapeFacets, ProfileFault>;
}

/// Makes a shape from its settings, defaults filled in; paths are relative to the folder of the deck.
pub type MakeShape = fn(&Settings, &Path) -> Result<Box<dyn RigidShape>>;

registered_kind! {
    /// A rigid shape that decks name.
    pub struct RigidShapeEntry("rigid_shape", "unknown-name") {
        build: MakeShape;
    }
}

/// The shape that a profile sweeps about z.
pub struct ShapeOfRevolution(pub Profile);

impl RigidShape for ShapeOfRevolution {
    fn facets(&self, request: &ShapeRequest) -> Result<ShapeFacets, ProfileFault> {
        let Self(profile) = self;
        match request.space {
            ShapeSpace::Solid => profile.turned(request.angle, request.length),
            ShapeSpace::Revolution => Ok(profile.lines(request.angle, request.length)),
            ShapeSpace::Plane => {
                // Both sides of the axis.
                let mut out = profile.lines(request.angle, request.length);
                let other = profile.mirrored().lines(request.angle, request.length);
                let (points, apexes) = (out.points.len() as u32, out.apexes.len() as u32);
                out.points.extend(other.points);
                out.apexes.extend(other.apexes);
                out.facets.extend(other.facets.into_iter().map(|mut facet| {
                    facet.points = facet.points.map(|at| at + points);
                    facet.exact = facet.exact.map(|(surface, at)| (surface, at + apexes));
                    facet
                }));
                Ok(out)
            }
        }
    }
}

/// The shape that a profile sweeps along z.
pub struct ExtrudedShape {
    /// The profile.
    pub profile: Profile,
    /// Length along z.
    pub depth: f64,
    /// The meridian that takes its place in a model about an axis; `None` where there is none.
    pub meridian: Option<Profile>,
}

impl RigidShape for ExtrudedShape {
    fn facets(&self, request: &ShapeRequest) -> Result<ShapeFacets, ProfileFault> {
        let &ShapeRequest { space, angle, length } = request;
        match (space, &self.meridian) {
            (ShapeSpace::Solid, _) => Ok(self.profile.extruded(self.depth, angle, length)),
            (ShapeSpace::Plane, _) => Ok(self.profile.lines(angle, length)),
            (ShapeSpace::Revolution, Some(meridian)) => Ok(meridian.lines(angle, length)),
            (ShapeSpace::Revolution, None) => Err(ProfileFault {
                fact: "an extruded shape has no axis of revolution",
                remedy: "name \"revolution\" and give its meridian",
            }),
        }
    }
}

/// The error of settings that make no profile.
pub fn profile_error(settings: &Settings, key: &str, fault: ProfileFault) -> Diagnostic {
    settings.error(key, "rigid-shape", fault.fact).remedy(fault.remedy)
}

/// A profile of segments that settings give.
///
/// # Errors
/// One of [`Profile::new`], at `key`.
pub fn profile_of(settings: &Settings, key: &str, segments: Vec<Segment>) -> Result<Profile> {
    Profile::new(segments).map_err(|fault| profile_error(settings, key, fault).into())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use zelus_core::geometry::{ExactFacet, LINE_2_APEX, TRIANGLE_3_APEX, combine};
    use zelus_core::parameters::Defaults;
    use zelus_core::registry::all;

    use super::*;

    /// Each registered shape by its example: corners of curved facets and the points between them lie on the exact surface, to round-off.
    #[test]
    fn facets_of_every_shape_lie_on_its_surface() {
        let mut curved = 0;
        for entry in all::<RigidShapeEntry>().into_iter().filter(|entry| entry.name != "stl") {
            let defaults = Defaults::parse(entry.name, entry.defaults).expect("defaults");
            let example = defaults.example().expect("an example");
            let (settings, _) = Settings::check(example, &defaults).expect("settings");
            let shape = (entry.build)(&settings, Path::new(".")).expect("a shape");
            for space in [ShapeSpace::Solid, ShapeSpace::Plane, ShapeSpace::Revolution] {
                let facets = match shape.facets(&ShapeRequest { space, angle: PI / 36.0, length: f64::INFINITY }) {
                    Ok(facets) => facets,
                    Err(fault) => {
                        assert!(entry.name == "extrusion" && space == ShapeSpace::Revolution, "{fault:?}");
                        continue;
                    }
                };
                assert!(!facets.facets.is_empty(), "{} {space:?}", entry.name);
                let size = facets.size();
                for own in &facets.facets {
                    let Some((surface, apex)) = own.exact else { continue };
                    curved += 1;
                    let (corners, apex) =
                        (own.points.map(|at| facets.points[at as usize]), facets.apexes[apex as usize]);
                    let exact = ExactFacet { surface, corners, apex };
                    let inner = if space == ShapeSpace::Solid {
                        let [a, b, c] = corners;
                        combine(&exact.functions(&TRIANGLE_3_APEX, [0.2, 0.5]).values, &[a, b, c, apex])
                    } else {
                        let [a, b, _] = corners;
                        combine(&exact.functions(&LINE_2_APEX, [0.4, 0.0]).values, &[a, b, apex])
                    };
                    for x in corners.into_iter().chain([inner]) {
                        let off = (surface.level)(&surface.numbers, x).0;
                        assert!(off.abs() < 1e-12 * size, "{} {space:?} {surface:?}: {off:e}", entry.name);
                    }
                }
            }
        }
        assert!(curved > 1000, "{curved}");
    }
}
