//! What a formulation remembers of a pair.

use crate::mortar::{Operators, PairGeometry};

/// What a formulation remembers of a pair from state to state; `()` where it remembers nothing.
pub trait PairHistory<const NS: usize, const NM: usize> {
    /// From the operators of the pair at the start of the step and its positions in the last accepted state.
    fn of(operators: Operators<f64, NS, NM>, last: &PairGeometry<f64, NS, NM>) -> Self;
}

impl<const NS: usize, const NM: usize> PairHistory<NS, NM> for () {
    fn of(_: Operators<f64, NS, NM>, _: &PairGeometry<f64, NS, NM>) -> Self {}
}
