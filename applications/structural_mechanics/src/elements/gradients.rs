//! Gradients of shape functions, and columns of the nodes of an entity, as elements read them.

use zelus_core::entities::{EntityView, LocalUnknown, StepView};
use zelus_core::model::Variable;

use crate::tensor::{IDENTITY, Tensor, inverse, pairs};
use crate::variables::DISPLACEMENT;

/// Σ x_i ⊗ ∂N_i: Jacobian of a map with values `x` at the nodes.
pub(super) fn gradient<const NODES: usize, const DIM: usize>(
    x: &[[f64; 3]; NODES],
    dn: &[[f64; DIM]; NODES],
) -> [[f64; DIM]; DIM] {
    let mut out = [[0.0; DIM]; DIM];
    for (x, dn) in x.iter().zip(dn) {
        for a in 0..DIM {
            for b in 0..DIM {
                out[a][b] += x[a] * dn[b];
            }
        }
    }
    out
}

/// A square matrix in the upper left of the unit tensor.
pub(super) fn padded<const DIM: usize>(a: &[[f64; DIM]; DIM]) -> Tensor {
    let mut out = IDENTITY;
    for i in 0..DIM {
        (0..DIM).for_each(|j| out[(i, j)] = a[i][j]);
    }
    out
}

/// Determinant of the map from the reference cell to the positions `x`.
pub(super) fn determinant<const NODES: usize, const DIM: usize>(
    x: &[[f64; 3]; NODES],
    local: &[[f64; DIM]; NODES],
) -> f64 {
    padded(&gradient(x, local)).determinant()
}

/// Gradients with respect to the positions `x`, and the determinant of the map from the reference cell.
pub fn physical_gradients<const NODES: usize, const DIM: usize>(
    x: &[[f64; 3]; NODES],
    local: &[[f64; DIM]; NODES],
) -> ([[f64; DIM]; NODES], f64) {
    let jacobian = padded(&gradient(x, local));
    let inverse = inverse(&jacobian);
    let mut dn = [[0.0; DIM]; NODES];
    for (dn, local) in dn.iter_mut().zip(local) {
        for (a, out) in dn.iter_mut().enumerate() {
            *out = (0..DIM).map(|k| local[k] * inverse[(k, a)]).sum();
        }
    }
    (dn, jacobian.determinant())
}

/// The rows of B of one node: derivatives of Green's and Lagrange's strain under F with respect to its displacements, of the
/// small strain where F is the unit tensor.
pub(super) fn strain_rows<const DIM: usize, const S: usize>(f: &Tensor, dn: &[f64; DIM]) -> [[f64; DIM]; S] {
    pairs::<S>().map(|(p, q)| {
        std::array::from_fn(|a| if p == q { f[(a, p)] * dn[p] } else { f[(a, p)] * dn[q] + f[(a, q)] * dn[p] })
    })
}

/// Three numbers a node of a column, zeros when nothing has added it.
pub(super) fn nodal_vectors<const NODES: usize>(
    entity: &EntityView<'_, NODES>,
    view: &StepView<'_>,
    variable: &Variable<[f64; 3]>,
) -> [[f64; 3]; NODES] {
    match view.nodes.history.values(variable, 0) {
        [] => [[0.0; 3]; NODES],
        column => entity.vectors(column),
    }
}

/// Displacements of all nodes in `dim` directions, node by node.
pub(super) fn displacements<const SIZE: usize>(dim: usize) -> [LocalUnknown; SIZE] {
    std::array::from_fn(|row| LocalUnknown::of_node((row / dim) as u8, DISPLACEMENT.component((row % dim) as u8)))
}
