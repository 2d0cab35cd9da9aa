//! Mass, spring to the ground and damper at one node.
//!
//! m a + c v + k (u − u_0) = m g in each direction, with m NODAL_MASS, k NODAL_DISPLACEMENT_STIFFNESS, c
//! NODAL_DAMPING_RATIO (force per velocity), u_0 NODAL_INITIAL_DISPLACEMENT of the element and g VOLUME_ACCELERATION of
//! the node. Constants of the properties go before those of the element.

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Result;
use zelus_core::entities::{
    BlockRequest, Build, ElementEntry, EntityView, Kernel, KernelBlock, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::Shape;
use zelus_core::register;

use super::gradients::nodal_vectors;
use super::nodal_values::{refuse_rotations, scalar, vector};
use crate::variables::{
    DISPLACEMENT, NODAL_DAMPING_RATIO, NODAL_DISPLACEMENT_STIFFNESS, NODAL_INITIAL_DISPLACEMENT, NODAL_MASS,
    VOLUME_ACCELERATION,
};

/// Mass, spring and damper at a node.
pub struct NodalConcentrated;

/// Constants of one node.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ConcentratedConstants {
    mass: f64,
    stiffness: [f64; 3],
    damping: [f64; 3],
    rest: [f64; 3],
}

impl<const DIM: usize> Kernel<1, DIM> for NodalConcentrated {
    type State = ConcentratedConstants;

    fn unknowns() -> [LocalUnknown; DIM] {
        std::array::from_fn(|a| LocalUnknown::of_node(0, DISPLACEMENT.component(a as u8)))
    }

    fn new(_request: &BlockRequest<'_>) -> Result<Self> {
        Ok(Self)
    }

    fn state(&self, entity: &EntityView<'_, 1>, view: &StepView<'_>) -> Result<ConcentratedConstants, String> {
        refuse_rotations(entity, view)?;
        let mass = scalar(entity, view, &NODAL_MASS);
        if !(mass >= 0.0 && mass.is_finite()) {
            return Err(format!("NODAL_MASS is {mass}, it must not be negative"));
        }
        Ok(ConcentratedConstants {
            mass,
            stiffness: vector(entity, view, &NODAL_DISPLACEMENT_STIFFNESS),
            damping: vector(entity, view, &NODAL_DAMPING_RATIO),
            rest: vector(entity, view, &NODAL_INITIAL_DISPLACEMENT),
        })
    }

    fn tangent(&self) -> Tangent {
        Tangent::Constant
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, 1>,
        own: &ConcentratedConstants,
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; DIM],
    ) -> Result<(), String> {
        let [gravity] = nodal_vectors(entity, view, &VOLUME_ACCELERATION);
        let [u] = nodal_vectors(entity, view, &DISPLACEMENT);
        for a in 0..DIM {
            let stretch = if request == Request::External { -own.rest[a] } else { u[a] - own.rest[a] };
            rhs[a] += own.mass * gravity[a] - own.stiffness[a] * stretch;
            if !lhs.is_empty() {
                lhs[a * DIM + a] += own.stiffness[a];
            }
        }
        Ok(())
    }

    fn has_external(&self, _view: &StepView<'_>) -> bool {
        true
    }

    fn mass(
        &self,
        _entity: &EntityView<'_, 1>,
        own: &ConcentratedConstants,
        _view: &StepView<'_>,
        _lumped: bool,
        out: &mut [f64],
    ) -> bool {
        (0..DIM).for_each(|a| out[a * DIM + a] += own.mass);
        true
    }

    fn has_damping(&self) -> bool {
        true
    }

    fn damping(&self, _entity: &EntityView<'_, 1>, own: &ConcentratedConstants, out: &mut [f64]) {
        (0..DIM).for_each(|a| out[a * DIM + a] += own.damping[a]);
    }
}

register! { ElementEntry "NodalConcentratedElement2D1N",
    aliases: &["NodalConcentratedDampedElement2D1N"],
    about: "Mass, spring to the ground and damper at a node of the plane: NODAL_MASS, NODAL_DISPLACEMENT_STIFFNESS, NODAL_DAMPING_RATIO",
    source: "m a + c v + k (u − u_0) = m g",
    cell: Shape::of(0, 1),
    space: 2,
    build: Build::Block(KernelBlock::<NodalConcentrated, 1, 2>::boxed),
}

register! { ElementEntry "NodalConcentratedElement3D1N",
    aliases: &["NodalConcentratedDampedElement3D1N"],
    about: "Mass, spring to the ground and damper at a node in space: NODAL_MASS, NODAL_DISPLACEMENT_STIFFNESS, NODAL_DAMPING_RATIO",
    source: "m a + c v + k (u − u_0) = m g",
    cell: Shape::of(0, 1),
    space: 3,
    build: Build::Block(KernelBlock::<NodalConcentrated, 1, 3>::boxed),
}
