//! Gauss' elimination with row pivoting of the whole matrix: for small systems.

use zelus_core::register;
use zelus_core::strategies::LinearSolverEntry;
use zelus_linear_algebra::{LinearSolver, SolveError, SolveReport, System, vector};

struct Gauss {
    /// Largest size of a pivot that counts as none.
    least_pivot: f64,
}

impl LinearSolver for Gauss {
    fn name(&self) -> &'static str {
        "gauss"
    }

    fn solve(&mut self, system: &System<'_>, rhs: &[f64], x: &mut [f64]) -> Result<SolveReport, SolveError> {
        let (n, matrix) = (rhs.len(), system.merged());
        let row = |i: usize| (0..n).map(|j| matrix.get(i, j)).chain([rhs[i]]).collect();
        let mut rows: Vec<Vec<f64>> = (0..n).map(row).collect();
        for k in 0..n {
            let pivot = (k..n).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs())).unwrap_or(k);
            if rows[pivot][k].abs() <= self.least_pivot {
                return Err(SolveError::Singular { equations: vec![k], rank_deficiency: None });
            }
            rows.swap(k, pivot);
            let (done, rest) = rows.split_at_mut(k + 1);
            for row in rest {
                let factor = row[k] / done[k][k];
                (k..=n).for_each(|j| row[j] -= factor * done[k][j]);
            }
        }
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|j| rows[k][j] * x[j]).sum();
            x[k] = (rows[k][n] - known) / rows[k][k];
        }
        let mut left = vec![0.0; n];
        let relative_residual = system.residual(rhs, x, &mut left) / vector::norm(rhs).max(f64::MIN_POSITIVE);
        Ok(SolveReport { engine: "gauss", relative_residual, ..SolveReport::default() })
    }
}

register! { LinearSolverEntry "gauss",
    about: "Gauss' elimination of the whole matrix, for small systems",
    defaults: r#"{
    "least_pivot": 0.0 // a pivot of this size or less is none
}"#,
    build: |request| {
        let given = request.settings.node().get("least_pivot").map(|node| node.f64()).transpose()?;
        Ok(Box::new(Gauss { least_pivot: given.unwrap_or(0.0) }))
    },
}
