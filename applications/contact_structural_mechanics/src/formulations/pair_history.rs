//! What a formulation remembers of a pair.

use zelus_core::geometry::FacetShape;

use crate::mortar::{Operators, PairGeometry};

/// What a formulation remembers of a pair from state to state; `()` where it remembers nothing.
pub trait PairHistory<S: FacetShape, M: FacetShape> {
    /// From the operators of the pair at the start of the step and its positions in the last accepted state.
    fn of(operators: Operators<f64, S, M>, last: &PairGeometry<f64, S, M>) -> Self;
}

impl<S: FacetShape, M: FacetShape> PairHistory<S, M> for () {
    fn of(_: Operators<f64, S, M>, _: &PairGeometry<f64, S, M>) -> Self {}
}
