//! Tying of non-matching meshes by multipliers: b = −k [ −Mᵀλ ; Dᵀλ ; D u¹ − M u² ] (eqs. D.5c, D.7).
//!
//! D and M are those of the moment the pair was made, and u are total values, so initial gaps are kept. The residual is
//! linear and its tangent K = k [ 0 0 −Mᵀ ; 0 0 Dᵀ ; −M D 0 ] constant and symmetric (eq. D.6b).

use crate::mortar::Operators;

/// Mesh tying of a field with any number of components a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshTying {
    /// Scale factor k of the multipliers.
    pub scale_factor: f64,
    /// Number of components of the field.
    pub components: usize,
}

impl MeshTying {
    /// Number of local unknowns of a pair with so many slave and master nodes.
    pub const fn size(&self, slaves: usize, masters: usize) -> usize {
        self.components * (masters + 2 * slaves)
    }

    /// Writes the right-hand side in the order master, slave, multipliers, node by node; `values` are the unknowns in that order.
    ///
    /// # Panics
    /// If `rhs` and `values` do not have [`MeshTying::size`] entries.
    pub fn residual(&self, operators: &Operators<f64>, values: &[f64], rhs: &mut [f64]) {
        let (slaves, masters, components) = (operators.d.len(), operators.m[0].len(), self.components);
        let size = self.size(slaves, masters);
        assert!(rhs.len() == size && values.len() == size, "one entry per local unknown");
        rhs.fill(0.0);
        let k = self.scale_factor;
        for j in 0..slaves {
            for c in 0..components {
                let row = components * (masters + slaves + j) + c;
                for l in 0..masters {
                    let at = components * l + c;
                    rhs[at] += k * operators.m[j][l] * values[row];
                    rhs[row] += k * operators.m[j][l] * values[at];
                }
                for i in 0..slaves {
                    let at = components * (masters + i) + c;
                    rhs[at] -= k * operators.d[j][i] * values[row];
                    rhs[row] -= k * operators.d[j][i] * values[at];
                }
            }
        }
    }

    /// Writes the tangent row by row.
    ///
    /// # Panics
    /// If `lhs` does not have the square of [`MeshTying::size`] entries.
    pub fn tangent(&self, operators: &Operators<f64>, lhs: &mut [f64]) {
        let (slaves, masters, components) = (operators.d.len(), operators.m[0].len(), self.components);
        let n = self.size(slaves, masters);
        assert_eq!(lhs.len(), n * n, "one entry per pair of local unknowns");
        lhs.fill(0.0);
        let k = self.scale_factor;
        for j in 0..slaves {
            for c in 0..components {
                let row = components * (masters + slaves + j) + c;
                for i in 0..masters + slaves {
                    let entry = if i < masters { -k * operators.m[j][i] } else { k * operators.d[j][i - masters] };
                    lhs[row * n + components * i + c] = entry;
                    lhs[(components * i + c) * n + row] = entry;
                }
            }
        }
    }
}
