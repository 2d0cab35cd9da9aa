//! A sphere about the origin; in the plane a circle.

use std::f64::consts::PI;

use zelus_core::register;

use crate::rigid_shapes::profile::Segment;
use crate::rigid_shapes::rigid_shape::{RigidShapeEntry, ShapeOfRevolution, profile_of};

register! { RigidShapeEntry "sphere",
    about: "a ball, or the hollow of one; in the plane a circle",
    source: "x² + y² + z² = R²",
    defaults: include_str!("../../../../../configs/rigid_shapes/sphere.json"),
    build: |settings, _| {
        let (radius, hollow) = (settings.get_positive("radius")?, settings.get_bool("hollow")?);
        let turn = if hollow { -1.0 } else { 1.0 };
        let arc = Segment::Arc { centre: [0.0; 2], radius, from: -turn * 0.5 * PI, sweep: turn * PI };
        Ok(Box::new(ShapeOfRevolution(profile_of(settings, "radius", vec![arc])?)))
    },
}
