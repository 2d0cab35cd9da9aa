//! Force on a node: f = POINT_LOAD; with axial symmetry times 2πr/THICKNESS.

use std::f64::consts::PI;

use zelus_core::diagnostics::Result;
use zelus_core::entities::{BlockRequest, EntityView, Kernel, LocalUnknown, Request, StepView, Tangent};

use super::load::{displacements, register_conditions, thickness, vector_load};
use crate::variables::POINT_LOAD;

/// Dead force on a node; `AXISYMMETRIC` means force per length of circumference.
pub struct PointLoad<const AXISYMMETRIC: bool>;

impl<const AXISYMMETRIC: bool, const SIZE: usize> Kernel<1, SIZE> for PointLoad<AXISYMMETRIC> {
    type State = ();

    fn unknowns() -> [LocalUnknown; SIZE] {
        displacements(SIZE)
    }

    fn new(_request: &BlockRequest<'_>) -> Result<Self> {
        Ok(Self)
    }

    fn state(&self, _entity: &EntityView<'_, 1>, _view: &StepView<'_>) -> Result<(), String> {
        Ok(())
    }

    fn tangent(&self) -> Tangent {
        Tangent::Zero
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, 1>,
        _state: &(),
        view: &StepView<'_>,
        _request: Request,
        _lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        let [load] = vector_load(entity, view, &POINT_LOAD);
        let factor = if AXISYMMETRIC { 2.0 * PI * entity.current[0][0] / thickness(entity) } else { 1.0 };
        rhs.iter_mut().zip(load).for_each(|(r, f)| *r += factor * f);
        Ok(())
    }
}

register_conditions! { "PointLoadCondition", 0, "Force on a node: POINT_LOAD", "f = POINT_LOAD", &["POINT_LOAD"];
"2D1N": PointLoad<false>, 1, 2;
"3D1N": PointLoad<false>, 1, 3 }

register_conditions! { "AxisymPointLoadCondition", 0, "Force on a circle: POINT_LOAD per length",
"f = POINT_LOAD 2πr/THICKNESS", &["POINT_LOAD"];
"2D1N": PointLoad<true>, 1, 2 }
