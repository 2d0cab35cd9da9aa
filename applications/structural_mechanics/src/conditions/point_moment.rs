//! Moment on a node with rotations: f = POINT_MOMENT, the moment that works along ROTATION.

use zelus_core::entities::{Build, ConditionEntry, KernelBlock};
use zelus_core::geometry::Shape;
use zelus_core::model::Variable;
use zelus_core::register;

use super::load::{LoadAtNode, Nodal};
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

register! { ConditionEntry "PointMomentCondition2D1N",
    about: "Moment on the reference node of a coupling: POINT_MOMENT",
    source: "m = POINT_MOMENT",
    loads: &["POINT_MOMENT"],
    turns: true,
    cell: Shape::of(0, 1),
    space: 2,
    build: Build::Block(KernelBlock::<Nodal<PointMoment>, 1, 1>::boxed),
}

register! { ConditionEntry "PointMomentCondition3D1N",
    about: "Moment on the reference node of a coupling: POINT_MOMENT",
    source: "m = POINT_MOMENT",
    loads: &["POINT_MOMENT"],
    turns: true,
    cell: Shape::of(0, 1),
    space: 3,
    build: Build::Block(KernelBlock::<Nodal<PointMoment>, 1, 3>::boxed),
}
