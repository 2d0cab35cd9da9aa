//! A cylinder about the z axis without its ends; in the plane a circle, in a model about an axis a line along it.

use std::f64::consts::TAU;

use zelus_core::register;

use crate::rigid_shapes::profile::Segment;
use crate::rigid_shapes::rigid_shape::{ExtrudedShape, RigidShapeEntry, profile_of};

register! { RigidShapeEntry "cylinder",
    about: "the side of a cylinder, or a hole; in the plane a circle, about an axis a line along it",
    source: "x² + y² = R²",
    defaults: include_str!("../../../../../configs/rigid_shapes/cylinder.json"),
    build: |settings, _| {
        let (radius, depth) = (settings.get_positive("radius")?, settings.get_positive("length")?);
        let turn = if settings.get_bool("hollow")? { -1.0 } else { 1.0 };
        let circle = Segment::Arc { centre: [0.0; 2], radius, from: 0.0, sweep: turn * TAU };
        let half = 0.5 * turn * depth;
        let line = Segment::Line { ends: [[radius, -half], [radius, half]] };
        let [profile, meridian] = [circle, line].map(|own| profile_of(settings, "radius", vec![own]));
        Ok(Box::new(ExtrudedShape { profile: profile?, depth, meridian: Some(meridian?) }))
    },
}
