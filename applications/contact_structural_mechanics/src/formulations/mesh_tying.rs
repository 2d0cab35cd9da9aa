//! Tying of non-matching meshes by multipliers: b = −k [ −Mᵀλ ; Dᵀλ ; D u¹ − M u² ].
//!
//! D and M are those of the moment the pair was made, and u are total values, so initial gaps are kept. The residual is
//! linear and its tangent K = k [ 0 0 −Mᵀ ; 0 0 Dᵀ ; −M D 0 ] constant and symmetric.

use crate::mortar::Operators;
use zelus_core::geometry::FacetShape;

/// Mesh tying of a field with any number of components a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshTying {
    /// Scale factor k of the multipliers.
    pub scale_factor: f64,
}

impl MeshTying {
    /// Number of local unknowns of a field with `C` components.
    pub const fn size<S: FacetShape, M: FacetShape, const C: usize>() -> usize {
        C * (M::NODES + 2 * S::NODES)
    }

    /// Writes the right-hand side in the order master, slave, multipliers.
    ///
    /// # Panics
    /// If `rhs` does not have [`MeshTying::size`] entries.
    pub fn residual<S: FacetShape, M: FacetShape, const C: usize>(
        &self,
        operators: &Operators<f64, S, M>,
        master: &M::Nodal<[f64; C]>,
        slave: &S::Nodal<[f64; C]>,
        multipliers: &S::Nodal<[f64; C]>,
        rhs: &mut [f64],
    ) {
        assert_eq!(rhs.len(), Self::size::<S, M, C>(), "one entry per local unknown");
        rhs.fill(0.0);
        let k = self.scale_factor;
        for j in 0..S::NODES {
            for c in 0..C {
                let row = C * (M::NODES + S::NODES + j) + c;
                for l in 0..M::NODES {
                    rhs[C * l + c] += k * operators.m[j][l] * multipliers[j][c];
                    rhs[row] += k * operators.m[j][l] * master[l][c];
                }
                for i in 0..S::NODES {
                    rhs[C * (M::NODES + i) + c] -= k * operators.d[j][i] * multipliers[j][c];
                    rhs[row] -= k * operators.d[j][i] * slave[i][c];
                }
            }
        }
    }

    /// Writes the tangent row by row.
    ///
    /// # Panics
    /// If `lhs` does not have the square of [`MeshTying::size`] entries.
    pub fn tangent<S: FacetShape, M: FacetShape, const C: usize>(
        &self,
        operators: &Operators<f64, S, M>,
        lhs: &mut [f64],
    ) {
        let n = Self::size::<S, M, C>();
        assert_eq!(lhs.len(), n * n, "one entry per pair of local unknowns");
        lhs.fill(0.0);
        let k = self.scale_factor;
        for j in 0..S::NODES {
            for c in 0..C {
                let row = C * (M::NODES + S::NODES + j) + c;
                for i in 0..M::NODES + S::NODES {
                    let entry = if i < M::NODES { -k * operators.m[j][i] } else { k * operators.d[j][i - M::NODES] };
                    lhs[row * n + C * i + c] = entry;
                    lhs[(C * i + c) * n + row] = entry;
                }
            }
        }
    }
}
