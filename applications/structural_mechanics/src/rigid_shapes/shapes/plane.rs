//! A rectangle about the origin whose normal is z; in the plane a line whose normal is y, about an axis a disc.

use zelus_core::diagnostics::Result;
use zelus_core::register;

use crate::rigid_shapes::profile::{Profile, ProfileFault, Segment};
use crate::rigid_shapes::rigid_shape::{RigidShape, RigidShapeEntry, ShapeRequest, ShapeSpace};
use crate::rigid_shapes::shape_facets::ShapeFacets;

struct Plane {
    /// Lengths along x and y.
    size: [f64; 2],
}

impl RigidShape for Plane {
    fn facets(&self, request: &ShapeRequest) -> Result<ShapeFacets, ProfileFault> {
        let [a, b] = self.size.map(|size| 0.5 * size);
        let line = |to: f64| Profile::new(vec![Segment::Line { ends: [[a, 0.0], [to, 0.0]] }]);
        match request.space {
            ShapeSpace::Plane => Ok(line(-a)?.lines(request.angle, request.length)),
            ShapeSpace::Revolution => Ok(line(0.0)?.lines(request.angle, request.length)),
            ShapeSpace::Solid => {
                let ends = [[b, 0.0], [-b, 0.0]];
                // Extruded along z it has the normal y, which takes the place of z.
                let strip =
                    Profile::new(vec![Segment::Line { ends }])?.extruded(2.0 * a, request.angle, request.length);
                Ok(strip.moved(&|[y, _, x]| [x, y, 0.0]))
            }
        }
    }
}

register! { RigidShapeEntry "plane",
    about: "a rectangle; in the plane a line, about an axis a disc",
    source: "z = 0",
    defaults: include_str!("../../../../../configs/rigid_shapes/plane.json"),
    build: |settings, _| {
        let size: [f64; 2] = settings.get("size")?.parse("size")?;
        if !size.iter().all(|size| *size > 0.0 && size.is_finite()) {
            let problem = settings.error("size", "out-of-range", "\"size\" has a length that is not above 0");
            return Err(problem.remedy("write both lengths, e.g. [100.0, 50.0]").into());
        }
        Ok(Box::new(Plane { size }))
    },
}
