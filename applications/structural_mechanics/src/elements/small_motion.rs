//! Strain and rotation that elements for small displacements take to be small: parts of the displacement gradient at the centre.

use zelus_core::entities::{AssumedSmall, EntityView, StepView};
use zelus_core::geometry::{Shape, ShapeTable};

use super::gradients::{gradient, nodal_vectors, physical_gradients};
use crate::variables::DISPLACEMENT;

/// Strain from which on results are wrong.
const STRAIN: f64 = 0.5;
/// Sine of the rotation from which on results are wrong.
const ROTATION: f64 = 0.5;

const REMEDY: &str =
    "check the units of YOUNG_MODULUS, loads and lengths; where such motion is meant, use TotalLagrangianElement";

/// The one of strain |sym ∇u| and rotation |skew ∇u| that is larger beside its limit.
pub(super) fn small_motion<const NODES: usize, const DIM: usize>(
    shape: Shape,
    entity: &EntityView<'_, NODES>,
    view: &StepView<'_>,
) -> AssumedSmall {
    let centre = ShapeTable::get(shape, 1);
    let (dn, _) = physical_gradients(&entity.initial, &centre.dn::<NODES, DIM>()[0]);
    let h = gradient(&nodal_vectors(entity, view, &DISPLACEMENT), &dn);
    let (mut strain, mut rotation) = (0.0, 0.0);
    for a in 0..DIM {
        for b in 0..DIM {
            strain += (0.5 * (h[a][b] + h[b][a])).powi(2);
            rotation += 0.5 * (0.5 * (h[a][b] - h[b][a])).powi(2);
        }
    }
    let strain = AssumedSmall { name: "strain", value: strain.sqrt(), limit: STRAIN, remedy: REMEDY };
    let rotation = AssumedSmall { name: "rotation", value: rotation.sqrt(), limit: ROTATION, remedy: REMEDY };
    if strain.ratio() >= rotation.ratio() { strain } else { rotation }
}
