//! Winkler's foundation: springs all along a line, in every direction.
//!
//! f_i = −∫ N_i c u dξ with u = Σ N_j u_j, over the initial line; so K_ij = ∫ N_i c N_j dξ, constant and symmetric.
//! c = FOUNDATION_STIFFNESS > 0 is a force per area and displacement, for a body of unit thickness.

use zelus::structural_mechanics::variables::DISPLACEMENT;
use zelus_core::Result;
use zelus_core::entities::{
    BlockRequest, Build, ConditionEntry, EntityView, Kernel, KernelBlock, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::{Shape, ShapeTable};
use zelus_core::vector3::{norm, sub};
use zelus_core::{register, register_variable};

register_variable! {
    kind FOUNDATION_STIFFNESS: Scalar = "Traction of an elastic foundation per displacement (force per length cubed).";
}

const NODES: usize = 2;
const SIZE: usize = 4;

/// Springs along a straight line of two nodes.
struct ElasticFoundation {
    rule: &'static ShapeTable,
}

impl Kernel<NODES, SIZE> for ElasticFoundation {
    /// The stiffness c.
    type State = f64;

    fn unknowns() -> [LocalUnknown; SIZE] {
        std::array::from_fn(|row| LocalUnknown::of_node((row / 2) as u8, DISPLACEMENT.component((row % 2) as u8)))
    }

    fn new(_request: &BlockRequest<'_>) -> Result<Self> {
        Ok(Self { rule: ShapeTable::get(Shape::Line2, 2) })
    }

    fn state(&self, entity: &EntityView<'_, NODES>, _view: &StepView<'_>) -> Result<f64, String> {
        entity.properties.require("FOUNDATION_STIFFNESS").map_err(|problem| problem.to_string())
    }

    fn tangent(&self) -> Tangent {
        Tangent::Constant
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, NODES>,
        stiffness: &f64,
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        if request == Request::External {
            return Ok(());
        }
        let u = entity.vectors(view.nodes.history.values(&DISPLACEMENT, 0));
        let jacobian = 0.5 * norm(sub(entity.initial[1], entity.initial[0]));
        for (g, n) in self.rule.n::<NODES>().iter().enumerate() {
            let weight = self.rule.weight(g) * jacobian * stiffness;
            for i in 0..NODES {
                for j in 0..NODES {
                    for a in 0..2 {
                        let k = weight * n[i] * n[j];
                        rhs[2 * i + a] -= k * u[j][a];
                        if !lhs.is_empty() {
                            lhs[(2 * i + a) * SIZE + 2 * j + a] += k;
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

register! { ConditionEntry "ElasticFoundationCondition2D2N",
    about: "springs along a line: traction FOUNDATION_STIFFNESS times displacement, against it",
    source: "Winkler's foundation, f_i = −∫ N_i c u dξ",
    cell: Some(Shape::Line2),
    space: 2,
    build: Build::Block(KernelBlock::<ElasticFoundation, NODES, SIZE>::boxed),
}
