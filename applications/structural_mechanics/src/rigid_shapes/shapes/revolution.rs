//! The surface that a profile of lines and arcs sweeps about the z axis.

use zelus_core::register;

use crate::rigid_shapes::profile_settings::profile;
use crate::rigid_shapes::rigid_shape::{RigidShapeEntry, ShapeOfRevolution};

register! { RigidShapeEntry "revolution",
    about: "a profile of lines and arcs turned about an axis",
    source: "lines and arcs (r, z)",
    defaults: include_str!("../../../../../configs/rigid_shapes/revolution.json"),
    build: |settings, _| Ok(Box::new(ShapeOfRevolution(profile(settings)?))),
}
