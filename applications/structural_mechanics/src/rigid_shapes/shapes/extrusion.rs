//! The surface that a profile of lines and arcs sweeps along the z axis.

use zelus_core::register;

use crate::rigid_shapes::profile_settings::profile;
use crate::rigid_shapes::rigid_shape::{ExtrudedShape, RigidShapeEntry};

register! { RigidShapeEntry "extrusion",
    about: "a profile of lines and arcs, extruded; in the plane as it is",
    source: "lines and arcs (x, y)",
    defaults: include_str!("../../../../../configs/rigid_shapes/extrusion.json"),
    build: |settings, _| {
        let depth = settings.get_positive("length")?;
        Ok(Box::new(ExtrudedShape { profile: profile(settings)?, depth, meridian: None }))
    },
}
