//! Scalars of the stresses of a picture, for the page of a run.

use std::borrow::Cow;

use zelus_core::io::results::{Column, Dataset};
use zelus_structural_mechanics::stress_invariant::StressInvariant;

/// The stress at nodes from which the scalars follow.
pub(super) const SOURCE: &str = "CAUCHY_STRESS_VECTOR";

/// The columns of the points that a page shows, and the scalars of their stress that the run has not written.
pub(super) fn with_invariants(data: &Dataset) -> Vec<Cow<'_, Column>> {
    let shown = data.point_data.iter().filter(|column| !column.name.starts_with("KRATOS_"));
    let mut out: Vec<Cow<'_, Column>> = shown.map(Cow::Borrowed).collect();
    let Some(stress) = data.point_data.iter().find(|column| column.name == SOURCE) else { return out };
    let width = stress.components.max(1);
    let rows = stress.values.len() / width;
    for invariant in StressInvariant::ALL {
        if data.point_data.iter().any(|column| column.name == invariant.name()) {
            continue;
        }
        let of_row = |row: usize| {
            let vector: Vec<f64> = (row * width..(row + 1) * width).map(|at| stress.values.get(at)).collect();
            invariant.of_vector(&vector)
        };
        let values: Option<Vec<f64>> = (0..rows).map(of_row).collect();
        out.extend(values.map(|values| Cow::Owned(Column::real(invariant.name(), 1, values))));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scalars_follow_from_stresses_where_the_run_has_none() {
        let stress = Column::real(SOURCE, 3, vec![3.0, 0.0, 0.0, 0.0, 0.0, 2.0]);
        let given = Column::real("VON_MISES_STRESS", 1, vec![8.0, 9.0]);
        let data = Dataset { point_data: vec![stress, given], ..Dataset::default() };
        let all = with_invariants(&data);
        let of = |name: &str| {
            let column = all.iter().find(|column| column.name == name).expect("a column");
            [column.values.get(0), column.values.get(1)]
        };
        assert_eq!((all.len(), of("VON_MISES_STRESS"), of("TRESCA_STRESS")), (6, [8.0, 9.0], [3.0, 4.0]));
        assert!(with_invariants(&Dataset::default()).is_empty());
    }
}
