//! Boundaries without load: they name a piece of the boundary for searches and output, and bring no unknowns.

use zelus_core::diagnostics::Result;
use zelus_core::entities::{BlockRequest, EntityView, Kernel, LocalUnknown, Request, StepView, Tangent};

use super::load::register_conditions;

/// A piece of boundary that contributes nothing.
pub struct GeometryOnly;

impl<const NODES: usize> Kernel<NODES, 0> for GeometryOnly {
    type State = ();

    fn unknowns() -> [LocalUnknown; 0] {
        []
    }

    fn new(_request: &BlockRequest<'_>) -> Result<Self> {
        Ok(Self)
    }

    fn state(&self, _entity: &EntityView<'_, NODES>, _view: &StepView<'_>) -> Result<(), String> {
        Ok(())
    }

    fn tangent(&self) -> Tangent {
        Tangent::Zero
    }

    fn local_system(
        &self,
        _entity: &EntityView<'_, NODES>,
        _state: &(),
        _view: &StepView<'_>,
        _request: Request,
        _lhs: &mut [f64],
        _rhs: &mut [f64; 0],
    ) -> Result<(), String> {
        Ok(())
    }
}

register_conditions! { "PointCondition", 0, "A point of the boundary without load", "geometry only", &[];
"2D1N": GeometryOnly, 1, 0;
"3D1N": GeometryOnly, 1, 0 }

register_conditions! { "LineCondition", 1, "A line of the boundary without load", "geometry only", &[];
"2D2N": GeometryOnly, 2, 0;
"2D3N": GeometryOnly, 3, 0;
"3D2N": GeometryOnly, 2, 0;
"3D3N": GeometryOnly, 3, 0 }

register_conditions! { "SurfaceCondition", 2, "A surface of the boundary without load", "geometry only", &[];
"3D3N": GeometryOnly, 3, 0;
"3D4N": GeometryOnly, 4, 0;
"3D6N": GeometryOnly, 6, 0;
"3D8N": GeometryOnly, 8, 0;
"3D9N": GeometryOnly, 9, 0 }

register_conditions! { "Condition", 1, "A line of the boundary without load, as decks of earlier versions name it", "geometry only", &[];
"2D": GeometryOnly, 2, 0;
"2D2N": GeometryOnly, 2, 0;
"2D3N": GeometryOnly, 3, 0 }

register_conditions! { "Condition", 2, "A surface of the boundary without load, as decks of earlier versions name it",
"geometry only", &[];
"3D": GeometryOnly, 3, 0;
"3D3N": GeometryOnly, 3, 0;
"3D4N": GeometryOnly, 4, 0 }
