//! Moment on a node with rotations: f = POINT_MOMENT, the moment that works along ROTATION.

use zelus_core::model::Variable;

use super::load::{LoadAtNode, Nodal, register_conditions};
use crate::variables::{POINT_MOMENT, ROTATION};

/// Moment on a reference node; in the plane about z alone.
pub struct PointMoment;

impl LoadAtNode for PointMoment {
    const LOAD: &'static Variable<[f64; 3]> = &POINT_MOMENT;
    const ALONG: &'static Variable<[f64; 3]> = &ROTATION;

    fn first(components: usize) -> usize {
        3 - components
    }
}

register_conditions! { "PointMomentCondition", 0, "Moment on the reference node of a coupling: POINT_MOMENT", "m = POINT_MOMENT",
&["POINT_MOMENT"];
"2D1N": Nodal<PointMoment>, 1, 1;
"3D1N": Nodal<PointMoment>, 1, 3 }
