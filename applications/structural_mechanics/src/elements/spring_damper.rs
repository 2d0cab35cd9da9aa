//! Springs and dampers between two nodes, one in each global direction.
//!
//! Force on the first node k (u_2 − u_1) + c (v_2 − v_1), on the second the opposite; k NODAL_DISPLACEMENT_STIFFNESS, c
//! NODAL_DAMPING_RATIO (force per velocity) of the properties or of the element. Its springs on rotations are not there.

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Result;
use zelus_core::entities::{
    BlockRequest, Build, ElementEntry, EntityView, Kernel, KernelBlock, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::Shape;
use zelus_core::register;

use super::gradients::nodal_vectors;
use super::nodal_values::{refuse_rotations, vector};
use crate::variables::{DISPLACEMENT, NODAL_DAMPING_RATIO, NODAL_DISPLACEMENT_STIFFNESS};

/// Springs and dampers between two nodes in `DIM` dimensions.
pub struct SpringDamper<const DIM: usize>;

/// Constants of one pair of nodes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpringDamperConstants {
    stiffness: [f64; 3],
    damping: [f64; 3],
}

/// Adds [[k, −k], [−k, k]] for each direction.
fn add_between(dim: usize, values: &[f64; 3], out: &mut [f64]) {
    for (a, value) in values[..dim].iter().enumerate() {
        for (i, j, sign) in [(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)] {
            out[(i * dim + a) * 2 * dim + j * dim + a] += sign * value;
        }
    }
}

impl<const DIM: usize, const SIZE: usize> Kernel<2, SIZE> for SpringDamper<DIM> {
    type State = SpringDamperConstants;

    fn unknowns() -> [LocalUnknown; SIZE] {
        std::array::from_fn(|row| LocalUnknown::of_node((row / DIM) as u8, DISPLACEMENT.component((row % DIM) as u8)))
    }

    fn new(_request: &BlockRequest<'_>) -> Result<Self> {
        Ok(Self)
    }

    fn state(&self, entity: &EntityView<'_, 2>, view: &StepView<'_>) -> Result<SpringDamperConstants, String> {
        refuse_rotations(entity, view)?;
        Ok(SpringDamperConstants {
            stiffness: vector(entity, view, &NODAL_DISPLACEMENT_STIFFNESS),
            damping: vector(entity, view, &NODAL_DAMPING_RATIO),
        })
    }

    fn tangent(&self) -> Tangent {
        Tangent::Constant
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, 2>,
        own: &SpringDamperConstants,
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        if request == Request::External {
            return Ok(());
        }
        let [first, second] = nodal_vectors(entity, view, &DISPLACEMENT);
        for a in 0..DIM {
            let force = own.stiffness[a] * (second[a] - first[a]);
            rhs[a] += force;
            rhs[DIM + a] -= force;
        }
        if !lhs.is_empty() {
            add_between(DIM, &own.stiffness, lhs);
        }
        Ok(())
    }

    fn has_damping(&self) -> bool {
        true
    }

    fn damping(&self, _entity: &EntityView<'_, 2>, own: &SpringDamperConstants, out: &mut [f64]) {
        add_between(DIM, &own.damping, out);
    }
}

register! { ElementEntry "SpringDamperElement2D2N",
    aliases: &["SpringDamperElement2D"],
    about: "Springs and dampers between two nodes of the plane: NODAL_DISPLACEMENT_STIFFNESS, NODAL_DAMPING_RATIO",
    source: "f = k (u_2 − u_1) + c (v_2 − v_1)",
    cell: Shape::of(1, 2),
    space: 2,
    build: Build::Block(KernelBlock::<SpringDamper<2>, 2, 4>::boxed),
}

register! { ElementEntry "SpringDamperElement3D2N",
    aliases: &["SpringDamperElement3D"],
    about: "Springs and dampers between two nodes in space: NODAL_DISPLACEMENT_STIFFNESS, NODAL_DAMPING_RATIO",
    source: "f = k (u_2 − u_1) + c (v_2 − v_1)",
    cell: Shape::of(1, 2),
    space: 3,
    build: Build::Block(KernelBlock::<SpringDamper<3>, 2, 6>::boxed),
}
