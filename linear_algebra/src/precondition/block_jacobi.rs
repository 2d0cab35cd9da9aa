//! Inverses of the diagonal blocks of the nodes.

use super::Precondition;
use crate::csr::Csr;
use crate::dense_lu;
use crate::parallel;

/// Inverse diagonal blocks, one a group of equations.
pub(crate) struct BlockJacobi {
    /// Equations of each block.
    blocks: Vec<Vec<u32>>,
    /// Block and place in it of each equation.
    place: Vec<(u32, u32)>,
    /// Inverse of each block, by rows.
    inverses: Vec<Vec<f64>>,
}

impl BlockJacobi {
    /// Inverts the blocks of equations with equal `group`.
    pub(crate) fn new(matrix: &Csr, group: &[u32]) -> Self {
        let groups = group.iter().max().map_or(0, |&g| g as usize + 1);
        let mut blocks = vec![Vec::new(); groups];
        let place: Vec<(u32, u32)> = group
            .iter()
            .enumerate()
            .map(|(i, &g)| {
                blocks[g as usize].push(i as u32);
                (g, blocks[g as usize].len() as u32 - 1)
            })
            .collect();
        let inverses = parallel::map(blocks.len(), 256, |at| inverse(matrix, &blocks[at]));
        Self { blocks, place, inverses }
    }
}

/// Inverse of a diagonal block, by rows; tiny pivots are lifted, so that it always exists.
fn inverse(matrix: &Csr, block: &[u32]) -> Vec<f64> {
    let n = block.len();
    let mut values = vec![0.0; n * n];
    let mut largest = 0.0_f64;
    for (a, &i) in block.iter().enumerate() {
        for (b, &j) in block.iter().enumerate() {
            values[a + n * b] = matrix.get(i as usize, j as usize);
            largest = largest.max(values[a + n * b].abs());
        }
    }
    let limit = if largest > 0.0 { 1e-12 * largest } else { 1.0 };
    let pivots = dense_lu::factorise(&mut values, n, limit);
    let mut inverse = vec![0.0; n * n];
    let mut column = vec![0.0; n];
    for b in 0..n {
        column.fill(0.0);
        column[b] = 1.0;
        dense_lu::solve(&values, n, &pivots, &mut column);
        for a in 0..n {
            inverse[a * n + b] = column[a];
        }
    }
    inverse
}

impl Precondition for BlockJacobi {
    fn apply(&self, x: &mut [f64]) {
        let old = x.to_vec();
        parallel::each_mut(x, 4096, |equation, value| {
            let (block, at) = self.place[equation];
            let block = block as usize;
            let n = self.blocks[block].len();
            let row = &self.inverses[block][at as usize * n..(at as usize + 1) * n];
            *value = row.iter().zip(&self.blocks[block]).map(|(a, &j)| a * old[j as usize]).sum();
        });
    }
}
