//! Constants of springs and masses: from the properties, or from the element's own data where those have none.

use zelus_core::entities::{EntityView, StepView};
use zelus_core::model::Variable;

use crate::variables::{NODAL_INERTIA, NODAL_ROTATIONAL_DAMPING_RATIO, NODAL_ROTATIONAL_STIFFNESS};

/// One number.
pub(super) fn scalar<const NODES: usize>(
    entity: &EntityView<'_, NODES>,
    view: &StepView<'_>,
    variable: &Variable<f64>,
) -> f64 {
    let own = || view.elements.data.values(variable, 0).get(entity.index as usize).copied();
    entity.properties.number(variable.name()).or_else(own).unwrap_or(0.0)
}

/// Three numbers.
pub(super) fn vector<const NODES: usize>(
    entity: &EntityView<'_, NODES>,
    view: &StepView<'_>,
    variable: &Variable<[f64; 3]>,
) -> [f64; 3] {
    let own = || {
        let values = view.elements.data.values(variable, 0).get(3 * entity.index as usize..)?;
        values.get(..3)?.try_into().ok()
    };
    entity.properties.vector3(variable.name()).or_else(own).unwrap_or_default()
}

/// Nodes have no rotations: constants that resist them cannot be honoured.
///
/// # Errors
/// A rotational constant other than zero, in the properties or in the element's own data.
pub(super) fn refuse_rotations<const NODES: usize>(
    entity: &EntityView<'_, NODES>,
    view: &StepView<'_>,
) -> Result<(), String> {
    for variable in [&NODAL_ROTATIONAL_STIFFNESS, &NODAL_INERTIA, &NODAL_ROTATIONAL_DAMPING_RATIO] {
        if vector(entity, view, variable) != [0.0; 3] {
            return Err(format!(
                "{} has no effect, nodes have no rotations: take it out; a rigid body has \"inertia\" of kinematic_coupling_process",
                variable.name()
            ));
        }
    }
    Ok(())
}
