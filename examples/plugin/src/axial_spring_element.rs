//! A spring along the line of its two nodes, for small displacements.
//!
//! N = c (u₂ − u₁)·t with the initial direction t; c = AXIAL_STIFFNESS > 0 (force per length).

use zelus::structural_mechanics::variables::DISPLACEMENT;
use zelus_core::Result;
use zelus_core::entities::{
    BlockRequest, Build, ElementEntry, EntityView, Kernel, KernelBlock, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::Shape;
use zelus_core::vector3::{dot, normalised, scale, sub};
use zelus_core::{register, register_variable};

register_variable! {
    kind AXIAL_STIFFNESS: Scalar = "Force of a spring per lengthening.";
}

struct AxialSpring;

impl Kernel<2, 4> for AxialSpring {
    /// The stiffness c.
    type State = f64;

    fn unknowns() -> [LocalUnknown; 4] {
        std::array::from_fn(|row| LocalUnknown::of_node((row / 2) as u8, DISPLACEMENT.component((row % 2) as u8)))
    }

    fn new(_request: &BlockRequest<'_>) -> Result<Self> {
        Ok(Self)
    }

    fn state(&self, entity: &EntityView<'_, 2>, _view: &StepView<'_>) -> Result<f64, String> {
        entity.properties.require("AXIAL_STIFFNESS").map_err(|problem| problem.to_string())
    }

    fn tangent(&self) -> Tangent {
        Tangent::Constant
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, 2>,
        stiffness: &f64,
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; 4],
    ) -> Result<(), String> {
        if request == Request::External {
            return Ok(());
        }
        let along = normalised(sub(entity.initial[1], entity.initial[0]));
        let [first, second] = entity.vectors(view.nodes.history.values(&DISPLACEMENT, 0));
        let force = scale(along, stiffness * dot(sub(second, first), along));
        let sides = [-1.0, -1.0, 1.0, 1.0];
        for (i, side) in sides.into_iter().enumerate() {
            rhs[i] -= side * force[i % 2];
            if !lhs.is_empty() {
                for (j, other) in sides.into_iter().enumerate() {
                    lhs[4 * i + j] += side * other * stiffness * along[i % 2] * along[j % 2];
                }
            }
        }
        Ok(())
    }
}

register! { ElementEntry "SmallDisplacementAxialSpringElement2D2N",
    about: "a spring along the line of its nodes: AXIAL_STIFFNESS times lengthening",
    source: "N = c (u₂ − u₁)·t",
    cell: Some(Shape::Line2),
    space: 2,
    build: Build::Block(KernelBlock::<AxialSpring, 2, 4>::boxed),
}
