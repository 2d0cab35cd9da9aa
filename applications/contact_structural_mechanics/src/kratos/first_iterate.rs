//! The tangent of the first iterate of a step whose normals that iterate decides.
//!
//! Kratos keeps, for a whole step, the normals there are after its first iteration (`normal_variation`). What the tangent of that
//! iteration leaves out changes these normals and with them the answer, so the same is left out: in space D and M move as
//! [`operators_on_flat_master`] says; in the plane constant operators are nearest to Kratos'.

use std::marker::PhantomData;

use zelus_core::entities::{NORMALS_OF_FIRST_ITERATION, StepView};
use zelus_core::geometry::FacetShape;
use zelus_core::model::ModelPart;
use zelus_core::scalar::Dual;

use super::flat_master::operators_on_flat_master;
use crate::mortar::{Operators, Overlap, PairGeometry, SegmentationSettings, operators};

/// The operators on a flat master where both facets are of first order; a constant, so that nothing else is compiled.
struct FlatOfFirstOrder<const NU: usize, S, M>(PhantomData<(S, M)>);

impl<const NU: usize, S: FacetShape, M: FacetShape> FlatOfFirstOrder<NU, S, M> {
    /// Kratos has no others.
    const OPERATORS: fn(&PairGeometry<Dual<NU>, S, M>, &SegmentationSettings) -> Overlap<Operators<Dual<NU>, S, M>> =
        if S::CURVED || M::CURVED { operators } else { operators_on_flat_master };
}

/// What a tangent knows of the operators D and M.
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

    /// That of the present iteration in `dimension` dimensions.
    pub fn of(view: &StepView<'_>, dimension: usize) -> Self {
        match view.decides_normals() {
            false => Self::Exact,
            true if dimension == 2 => Self::Constant,
            true => Self::FlatMaster,
        }
    }

    /// D and M of a pair with the derivatives that the tangent knows; `None` without overlap.
    pub fn operators<S: FacetShape, M: FacetShape, const NU: usize>(
        self,
        pair: &PairGeometry<Dual<NU>, S, M>,
        settings: &SegmentationSettings,
    ) -> Option<Operators<Dual<NU>, S, M>> {
        match self {
            Self::Exact => operators(pair, settings).cells(),
            Self::FlatMaster => FlatOfFirstOrder::<NU, S, M>::OPERATORS(pair, settings).cells(),
            Self::Constant => operators(&pair.values(), settings).cells().map(|plain| plain.as_constants()),
        }
    }
}
