//! Springs along the line between two nodes.
//!
//! With the initial and present length l_0, l and k AXIAL_STIFFNESS of the properties or of the element: f = k (l − l_0) t on the first
//! node along t = x_21/l, the opposite on the second. Tangent k t tᵀ + k (1 − l_0/l) (1 − t tᵀ). The linear spring has
//! f = k ((u_2 − u_1)·t_0) t_0 along its initial direction t_0.

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Result;
use zelus_core::entities::{
    BlockRequest, Build, ElementEntry, EntityView, Kernel, KernelBlock, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::Shape;
use zelus_core::register;
use zelus_core::vector3::{dot, norm, scale, sub};

use super::gradients::nodal_vectors;
use super::nodal_values::scalar;
use crate::variables::{AXIAL_STIFFNESS, DISPLACEMENT};

/// A spring along its line in `DIM` dimensions; `LINEAR` for small displacements.
pub struct AxialSpring<const DIM: usize, const LINEAR: bool>;

/// Stiffness and initial length of one spring.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AxialSpringConstants {
    stiffness: f64,
    length: f64,
}

impl<const DIM: usize, const LINEAR: bool, const SIZE: usize> Kernel<2, SIZE> for AxialSpring<DIM, LINEAR> {
    type State = AxialSpringConstants;

    fn unknowns() -> [LocalUnknown; SIZE] {
        std::array::from_fn(|row| LocalUnknown::of_node((row / DIM) as u8, DISPLACEMENT.component((row % DIM) as u8)))
    }

    fn new(_request: &BlockRequest<'_>) -> Result<Self> {
        Ok(Self)
    }

    fn state(&self, entity: &EntityView<'_, 2>, view: &StepView<'_>) -> Result<AxialSpringConstants, String> {
        let length = norm(sub(entity.initial[1], entity.initial[0]));
        if length > 0.0 {
            Ok(AxialSpringConstants { stiffness: scalar(entity, view, &AXIAL_STIFFNESS), length })
        } else {
            Err("both ends are at the same place: take SpringDamperElement".into())
        }
    }

    fn tangent(&self) -> Tangent {
        if LINEAR { Tangent::Constant } else { Tangent::Symmetric }
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, 2>,
        own: &AxialSpringConstants,
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        if request == Request::External {
            return Ok(());
        }
        let ends = if LINEAR { &entity.initial } else { &entity.current };
        let line = sub(ends[1], ends[0]);
        let length = norm(line);
        if length == 0.0 {
            return Err("both ends of the spring are at the same place".into());
        }
        let along = scale(line, 1.0 / length);
        let stretch = if LINEAR {
            let [first, second] = nodal_vectors(entity, view, &DISPLACEMENT);
            dot(sub(second, first), along)
        } else {
            length - own.length
        };
        for a in 0..DIM {
            let force = own.stiffness * stretch * along[a];
            rhs[a] += force;
            rhs[DIM + a] -= force;
        }
        if lhs.is_empty() {
            return Ok(());
        }
        let across = if LINEAR { 0.0 } else { own.stiffness * (1.0 - own.length / length) };
        for a in 0..DIM {
            for b in 0..DIM {
                let dyad = along[a] * along[b];
                let k = own.stiffness * dyad + across * (f64::from(u8::from(a == b)) - dyad);
                for (i, j, sign) in [(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)] {
                    lhs[(i * DIM + a) * SIZE + j * DIM + b] += sign * k;
                }
            }
        }
        Ok(())
    }
}

register! { ElementEntry "AxialSpringElement2D2N",
    about: "Spring along the line between two nodes of the plane, which turns with them: AXIAL_STIFFNESS",
    source: "f = k (l − l_0) t",
    cell: Shape::of(1, 2),
    space: 2,
    build: Build::Block(KernelBlock::<AxialSpring<2, false>, 2, 4>::boxed),
}

register! { ElementEntry "AxialSpringElement3D2N",
    about: "Spring along the line between two nodes in space, which turns with them: AXIAL_STIFFNESS",
    source: "f = k (l − l_0) t",
    cell: Shape::of(1, 2),
    space: 3,
    build: Build::Block(KernelBlock::<AxialSpring<3, false>, 2, 6>::boxed),
}

register! { ElementEntry "LinearAxialSpringElement2D2N",
    about: "Spring along the line between two nodes of the plane under small displacements: AXIAL_STIFFNESS",
    source: "f = k ((u_2 − u_1)·t_0) t_0",
    cell: Shape::of(1, 2),
    space: 2,
    build: Build::Block(KernelBlock::<AxialSpring<2, true>, 2, 4>::boxed),
}

register! { ElementEntry "LinearAxialSpringElement3D2N",
    about: "Spring along the line between two nodes in space under small displacements: AXIAL_STIFFNESS",
    source: "f = k ((u_2 − u_1)·t_0) t_0",
    cell: Shape::of(1, 2),
    space: 3,
    build: Build::Block(KernelBlock::<AxialSpring<3, true>, 2, 6>::boxed),
}
