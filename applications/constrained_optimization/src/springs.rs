//! Springs on one unknown: f(x) = k/p · (x − x₀)ᵖ with p = 2 (eq. D.13) or p = 4 (eq. D.16).
//!
//! Residual −f′ = −k (x − x₀)ᵖ⁻¹, tangent f″ = (p − 1) k (x − x₀)ᵖ⁻².

use zelus_core::diagnostics::Result;
use zelus_core::entities::{
    BlockRequest, Build, ElementEntry, EntityView, Kernel, KernelBlock, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::Shape;
use zelus_core::register;

use crate::variables::POSITION;

/// A spring whose energy is a power `POWER` of its elongation.
pub struct Spring<const POWER: i32> {
    stiffness: f64,
    rest: f64,
}

impl<const POWER: i32> Kernel<1, 1> for Spring<POWER> {
    type State = ();

    fn unknowns() -> [LocalUnknown; 1] {
        [LocalUnknown::of_node(0, POSITION.scalar())]
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        let id = request.table.properties[request.members[0] as usize];
        let properties = &request.part.properties[&id];
        Ok(Self { stiffness: properties.require("SPRING_STIFFNESS")?, rest: properties.require("REST_POSITION")? })
    }

    fn state(&self, _entity: &EntityView<'_, 1>, _view: &StepView<'_>) -> Result<(), String> {
        Ok(())
    }

    fn tangent(&self) -> Tangent {
        Tangent::Symmetric
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, 1>,
        _state: &(),
        view: &StepView<'_>,
        _request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; 1],
    ) -> Result<(), String> {
        let [x] = entity.scalars(view.nodes.history.values(&POSITION, 0));
        let elongation = x - self.rest;
        rhs[0] -= self.stiffness * elongation.powi(POWER - 1);
        if let [tangent] = lhs {
            *tangent += f64::from(POWER - 1) * self.stiffness * elongation.powi(POWER - 2);
        }
        Ok(())
    }
}

register! { ElementEntry "LinearSpringElement1N",
    about: "spring on one unknown with energy k/2 (x − x₀)²",
    source: "eqs. D.13, D.26",
    cell: Shape::of(0, 1),
    build: Build::Block(KernelBlock::<Spring<2>, 1, 1>::boxed),
}
register! { ElementEntry "QuarticSpringElement1N",
    about: "spring on one unknown with energy k/4 (x − x₀)⁴",
    source: "eq. D.16",
    cell: Shape::of(0, 1),
    build: Build::Block(KernelBlock::<Spring<4>, 1, 1>::boxed),
}
