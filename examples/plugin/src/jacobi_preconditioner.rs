//! Jacobi's preconditioner: the inverse of the diagonal.

use zelus_core::register;
use zelus_core::strategies::PreconditionerEntry;
use zelus_linear_algebra::{Precondition, Preconditioner};

struct Jacobi(Vec<f64>);

impl Precondition for Jacobi {
    fn apply(&self, x: &mut [f64]) {
        x.iter_mut().zip(&self.0).for_each(|(x, inverse)| *x *= inverse);
    }
}

register! { PreconditionerEntry "jacobi",
    about: "the inverse of the diagonal; 1 where it is zero",
    build: Preconditioner::Other(|matrix, _layout| {
        let inverse = |d: f64| if d == 0.0 { 1.0 } else { d.recip() };
        Box::new(Jacobi(matrix.diagonal().into_iter().map(inverse).collect()))
    }),
}
