//! A matrix on the equations, kept while the one over all unknowns stays as it is.

use zelus_linear_algebra::Csr;

use crate::assembly::Equations;

/// TᵀA T of a matrix A over all unknowns (eq. D.12e), with the stamps of graph and values of A that it is of.
#[derive(Default)]
pub(super) struct ReducedMatrix {
    matrix: Csr,
    /// `None` before the first reduction.
    stamps: Option<[u64; 2]>,
}

impl ReducedMatrix {
    /// The matrix on the equations.
    pub fn matrix(&self) -> &Csr {
        &self.matrix
    }

    /// Reduces a matrix with these values and stamps, where the last reduction was of others; its pattern stays while the graph
    /// does. Without values the matrix stays as it is.
    pub fn update(&mut self, equations: &Equations, pattern: &Csr, values: Option<&[f64]>, stamps: [u64; 2]) {
        if self.stamps == Some(stamps) {
            return;
        }
        if let Some(values) = values {
            let same_graph = self.stamps.is_some_and(|[graph, _]| graph == stamps[0]);
            equations.reduce_matrix(pattern, values, &mut self.matrix, same_graph);
        }
        self.stamps = Some(stamps);
    }
}
