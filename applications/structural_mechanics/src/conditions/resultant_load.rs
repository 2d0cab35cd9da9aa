//! Share of a node in a load that is given by its resultant: f = RESULTANT_LOAD.

use zelus_core::diagnostics::Result;
use zelus_core::entities::{BlockRequest, EntityView, Kernel, LocalUnknown, Request, StepView, Tangent};

use super::load::{displacements, register_conditions, vector_load};
use crate::variables::RESULTANT_LOAD;

/// Dead force on a node; its process makes one condition a node.
pub struct ResultantLoad;

impl<const SIZE: usize> Kernel<1, SIZE> for ResultantLoad {
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
        let [load] = vector_load(entity, view, &RESULTANT_LOAD);
        rhs.iter_mut().zip(load).for_each(|(r, f)| *r += f);
        Ok(())
    }
}

register_conditions! { "ResultantLoadCondition", 0, "Share of a node in a resultant: RESULTANT_LOAD", "f = RESULTANT_LOAD",
&["RESULTANT_LOAD"];
"2D1N": ResultantLoad, 1, 2;
"3D1N": ResultantLoad, 1, 3 }
