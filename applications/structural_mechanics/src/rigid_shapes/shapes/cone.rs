//! A cone about the z axis with its tip at the origin, open at its base; in the plane a wedge.
//!
//! A rounded tip is part of a sphere that touches the cone: with the half angle α and the radius ρ the centre is at z = ρ, and the arc
//! ends at r = ρ cos α.

use std::f64::consts::PI;

use zelus_core::register;

use crate::rigid_shapes::profile::Segment;
use crate::rigid_shapes::rigid_shape::{RigidShapeEntry, ShapeOfRevolution, profile_of};

register! { RigidShapeEntry "cone",
    about: "a cone with a sharp or a rounded tip; in the plane a wedge",
    source: "r = z tan α",
    defaults: include_str!("../../../../../configs/rigid_shapes/cone.json"),
    build: |settings, _| {
        let (height, tip) = (settings.get_positive("height")?, settings.get_f64("tip_radius")?);
        let (sin, cos) = settings.get_f64("half_angle")?.to_radians().sin_cos();
        let start = [tip * cos, tip - tip * sin];
        let end = [start[0] + (height - start[1]) * sin / cos, height];
        let line = Segment::Line { ends: [start, end] };
        let arc = Segment::Arc { centre: [0.0, tip], radius: tip, from: -0.5 * PI, sweep: cos.atan2(sin) };
        let segments = if tip > 0.0 { vec![arc, line] } else { vec![line] };
        if height <= start[1] {
            let problem = settings.error("height", "rigid-shape", format!("the cone ends at {height}, within its rounded tip"));
            return Err(problem.remedy(format!("write a \"height\" above {}", start[1])).into());
        }
        Ok(Box::new(ShapeOfRevolution(profile_of(settings, "height", segments)?)))
    },
}
