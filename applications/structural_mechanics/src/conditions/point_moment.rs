//! Moment on a node with rotations: f = POINT_MOMENT, the moment that works along ROTATION.

use zelus_core::diagnostics::Result;
use zelus_core::entities::{BlockRequest, EntityView, Kernel, LocalUnknown, Request, StepView, Tangent};

use super::load::{register_conditions, vector_load};
use crate::variables::{POINT_MOMENT, ROTATION};

/// Moment on a reference node; in the plane about z alone.
pub struct PointMoment;

impl<const SIZE: usize> Kernel<1, SIZE> for PointMoment {
    type State = ();

    fn unknowns() -> [LocalUnknown; SIZE] {
        std::array::from_fn(|row| LocalUnknown::of_node(0, ROTATION.component((3 - SIZE + row) as u8)))
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
        let [load] = vector_load(entity, view, &POINT_MOMENT);
        rhs.iter_mut().zip(&load[3 - SIZE..]).for_each(|(r, m)| *r += m);
        Ok(())
    }
}

register_conditions! { "PointMomentCondition", 0, "Moment on the reference node of a coupling: POINT_MOMENT", "m = POINT_MOMENT",
&["POINT_MOMENT"];
"2D1N": PointMoment, 1, 1;
"3D1N": PointMoment, 1, 3 }
