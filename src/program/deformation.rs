//! Displacements of a step, and the factor by which the page and pictures deform a model at first.

use zelus_core::io::results::Dataset;

/// Largest displacement by the size of the model from which on the true deformation is well seen.
pub(super) const SEEN: f64 = 0.02;
/// Largest displacement by the size of the model that a factor aims at.
pub(super) const AIM: f64 = 0.06;

/// The factor: 1 where the true deformation is seen, else 1, 2 or 5 times a power of ten.
pub(super) fn automatic(largest: f64, size: f64) -> f64 {
    if !(largest > 0.0 && largest < SEEN * size) {
        return 1.0;
    }
    let wanted = AIM * size / largest;
    let power = 10_f64.powf(wanted.log10().floor());
    [5.0, 2.0, 1.0].map(|digit| digit * power).into_iter().find(|own| *own <= wanted * 1.000_001).unwrap_or(power)
}

/// The displacement of each point of a step: from its positions, where they move, else the nodal one.
pub(super) fn displacements(data: &Dataset, first: &Dataset) -> Vec<[f64; 3]> {
    let given = data.point_data.iter().find(|column| column.name == "DISPLACEMENT" && column.components == 3);
    let moved = data.points.iter().zip(&first.points).any(|(x, y)| x != y);
    let of = |at: usize| match given {
        _ if moved => std::array::from_fn(|c| data.points[at][c] - first.points[at][c]),
        Some(column) => std::array::from_fn(|c| column.values.get(3 * at + c)),
        None => [0.0; 3],
    };
    (0..data.points.len().min(first.points.len())).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_round_and_small_deformations_are_enlarged() {
        for (largest, size, factor) in [(0.001, 10.0, 500.0), (0.006, 1.0, 10.0), (0.5, 1.0, 1.0), (0.0, 1.0, 1.0)] {
            assert_eq!(automatic(largest, size), factor, "{largest} of {size}");
        }
    }
}
