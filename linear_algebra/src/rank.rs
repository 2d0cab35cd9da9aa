//! Rank of a small system, for messages.

use crate::equilibrate;
use crate::reduced::Reduced;
use crate::system::System;

/// Largest system whose rank is worth its cubic cost.
const MOST_EQUATIONS: usize = 500;
/// Pivot of the equilibrated matrix, relative to the largest one, below which it counts as zero.
const ZERO: f64 = 1e-12;

/// Rank of `bulk + coupling` by elimination with complete pivoting; `None` for a system that is too large for it.
pub fn rank(system: &System<'_>) -> Option<usize> {
    let n = system.free();
    if n > MOST_EQUATIONS {
        return None;
    }
    let matrix = match system.layout.inactive.is_empty() {
        true => system.merged(),
        false => Reduced::new(system).system(system).merged(),
    };
    let scaling = equilibrate::factors(&matrix);
    let mut rows = vec![vec![0.0; n]; n];
    for (i, row) in rows.iter_mut().enumerate() {
        let (columns, values) = matrix.row(i);
        for (&j, value) in columns.iter().zip(values) {
            row[j as usize] = value * scaling.row[i] * scaling.column[j as usize];
        }
    }
    let mut first = 0.0;
    for step in 0..n {
        let remaining = (step..n).flat_map(|i| (step..n).map(move |j| (i, j)));
        let (i, j) = remaining.max_by(|&(a, b), &(c, d)| rows[a][b].abs().total_cmp(&rows[c][d].abs()))?;
        let pivot = rows[i][j];
        if step == 0 {
            first = pivot.abs();
        }
        if pivot.abs() <= ZERO * first {
            return Some(step);
        }
        rows.swap(step, i);
        rows.iter_mut().for_each(|row| row.swap(step, j));
        let (done, rest) = rows.split_at_mut(step + 1);
        let pivot_row = &done[step];
        for row in rest {
            let factor = row[step] / pivot;
            row.iter_mut().zip(pivot_row).skip(step).for_each(|(a, b)| *a -= factor * b);
        }
    }
    Some(n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::csr::Csr;
    use crate::system::{Layout, Symmetry};

    #[test]
    fn dependent_and_empty_rows_do_not_count() {
        let of = |triplets: &[(usize, usize, f64)]| {
            let (matrix, layout) = (Csr::from_triplets(3, triplets), Layout::scalar(3));
            rank(&System::bulk(&layout, &matrix, Symmetry::General))
        };
        assert_eq!(of(&[(0, 0, 2.0), (1, 1, 1e6)]), Some(2));
        assert_eq!(of(&[(0, 0, 1.0), (0, 1, 2.0), (1, 0, 2.0), (1, 1, 4.0), (2, 2, 1e-9)]), Some(2));
        assert_eq!(of(&[(0, 1, 1.0), (1, 0, 1.0), (2, 2, 3.0)]), Some(3));
        assert_eq!(of(&[]), Some(0));
    }
}
