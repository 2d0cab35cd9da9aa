//! A torus about the z axis.

use std::f64::consts::TAU;

use zelus_core::register;

use crate::rigid_shapes::profile::Segment;
use crate::rigid_shapes::rigid_shape::{RigidShapeEntry, ShapeOfRevolution, profile_of};

register! { RigidShapeEntry "torus",
    about: "a ring with a round section; in the plane two circles",
    source: "(√(x² + y²) − R)² + z² = ρ²",
    defaults: include_str!("../../../../../configs/rigid_shapes/torus.json"),
    build: |settings, _| {
        let (ring, radius) = (settings.get_positive("radius")?, settings.get_positive("tube_radius")?);
        if radius > ring {
            let fact = format!("\"tube_radius\" is {radius}, more than \"radius\", {ring}: the torus crosses itself");
            return Err(settings.error("tube_radius", "rigid-shape", fact).remedy("write a smaller one, or a \"sphere\"").into());
        }
        let circle = Segment::Arc { centre: [ring, 0.0], radius, from: 0.0, sweep: TAU };
        Ok(Box::new(ShapeOfRevolution(profile_of(settings, "radius", vec![circle])?)))
    },
}
