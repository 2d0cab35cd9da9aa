//! The tangent of the first iterate of a step whose normals that iterate decides.
//!
//! Kratos keeps, for a whole step, the normals there are after its first iteration (`normal_variation`). Terms that the tangent of that
//! iteration leaves out change these normals and with them the answer, so the same are left out: in space D and M move as
//! [`FlatMaster`] says; in the plane constant operators are nearest to Kratos'.

use zelus_core::entities::{NORMALS_OF_FIRST_ITERATION, StepView};
use zelus_core::model::ModelPart;

use super::flat_master::FlatMaster;
use crate::mortar::{
    Active, EXACT_MOTION, Operators, Overlap, PairGeometry, PairPoints, SegmentationSettings, find_operators, operators,
};

/// The knowledge that a tangent has of the motion of the operators D and M.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstIterateTangent {
    /// Their exact derivative: in every iteration but the first, and in that one unless it decides the normals.
    Exact,
    /// The derivative on a flat master, of facets of first order.
    FlatMaster,
    /// Nothing: D and M count as constant.
    Constant,
}

impl FirstIterateTangent {
    /// Says to elements, loads and contact of a model part that first iterates decide the normals of their steps.
    pub fn announce(part: &mut ModelPart) {
        part.info.marks.insert(NORMALS_OF_FIRST_ITERATION, true);
    }

    /// Choice for the present iteration in `dimension` dimensions.
    pub fn of(view: &StepView<'_>, dimension: usize) -> Self {
        match view.decides_normals() {
            false => Self::Exact,
            true if dimension == 2 => Self::Constant,
            true => Self::FlatMaster,
        }
    }

    /// Writes D and M of a pair to `out`, whose entries are zero, with the derivatives that the tangent knows.
    pub fn find_operators(
        self,
        pair: &PairGeometry<Active>,
        settings: &SegmentationSettings,
        points: &PairPoints,
        out: &mut Operators<Active>,
    ) -> Overlap<()> {
        match self {
            // Kratos has no facets of second order.
            Self::FlatMaster if !pair.is_curved() => {
                find_operators(pair, settings, points, &FlatMaster::new(pair), out)
            }
            Self::Exact | Self::FlatMaster => find_operators(pair, settings, points, &EXACT_MOTION, out),
            Self::Constant => operators(&pair.values(), settings).map(|plain| *out = plain.as_constants()),
        }
    }
}
