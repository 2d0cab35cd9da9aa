//! Springs between a node and the ground: f_c = −k_c u_c along each axis, with k = GROUND_STIFFNESS.

use zelus_core::diagnostics::Result;
use zelus_core::entities::{BlockRequest, EntityView, Kernel, LocalUnknown, Request, StepView, Tangent};

use super::load::{displacements, register_conditions};
use crate::variables::{DISPLACEMENT, GROUND_STIFFNESS};

/// Springs at a node; its process makes one condition a node.
pub struct GroundSpring;

impl<const SIZE: usize> Kernel<1, SIZE> for GroundSpring {
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
        Tangent::Constant
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, 1>,
        _state: &(),
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        if request == Request::External {
            return Ok(());
        }
        let given = view.conditions.data.values(&GROUND_STIFFNESS, 0).get(3 * entity.index as usize..);
        let Some(stiffness) = given.filter(|values| values.len() > 2) else { return Ok(()) };
        let [u] = entity.vectors(view.nodes.history.values(&DISPLACEMENT, 0));
        for c in 0..SIZE {
            rhs[c] -= stiffness[c] * u[c];
            if !lhs.is_empty() {
                lhs[c * SIZE + c] += stiffness[c];
            }
        }
        Ok(())
    }
}

register_conditions! { "GroundSpringCondition", 0, "Springs between a node and the ground: GROUND_STIFFNESS along each axis",
"f = −GROUND_STIFFNESS u", &[];
"2D1N": GroundSpring, 1, 2;
"3D1N": GroundSpring, 1, 3 }
