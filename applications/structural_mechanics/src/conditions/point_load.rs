//! Force on a node: f = POINT_LOAD; with axial symmetry times 2πr/THICKNESS.

use std::f64::consts::PI;

use zelus_core::entities::EntityView;
use zelus_core::model::Variable;

use super::load::{LoadAtNode, Nodal, register_conditions, thickness};
use crate::variables::{DISPLACEMENT, POINT_LOAD};

/// Dead force on a node; `AXISYMMETRIC` means force per length of circumference.
pub struct PointLoad<const AXISYMMETRIC: bool>;

impl<const AXISYMMETRIC: bool> LoadAtNode for PointLoad<AXISYMMETRIC> {
    const LOAD: &'static Variable<[f64; 3]> = &POINT_LOAD;
    const ALONG: &'static Variable<[f64; 3]> = &DISPLACEMENT;

    fn factor(entity: &EntityView<'_, 1>) -> f64 {
        if AXISYMMETRIC { 2.0 * PI * entity.current[0][0] / thickness(entity) } else { 1.0 }
    }
}

register_conditions! { "PointLoadCondition", 0, "Force on a node: POINT_LOAD", "f = POINT_LOAD", &["POINT_LOAD"];
"2D1N": Nodal<PointLoad<false>>, 1, 2;
"3D1N": Nodal<PointLoad<false>>, 1, 3 }

register_conditions! { "AxisymPointLoadCondition", 0, "Force on a circle: POINT_LOAD per length",
"f = POINT_LOAD 2πr/THICKNESS", &["POINT_LOAD"];
"2D1N": Nodal<PointLoad<true>>, 1, 2 }
