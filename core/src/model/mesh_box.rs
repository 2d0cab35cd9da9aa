//! The box around a mesh.

use super::model_part::ModelPart;

/// Lowest and highest coordinates of the initial mesh of all ranks; infinite without nodes. Collective.
pub(crate) fn mesh_box(part: &ModelPart) -> [[f64; 3]; 2] {
    let mut ends = [f64::INFINITY; 6];
    for x in &part.nodes.initial {
        (0..3).for_each(|c| (ends[c], ends[c + 3]) = (ends[c].min(x[c]), ends[c + 3].min(-x[c])));
    }
    let all = part.ranks.gather_numbers(&ends);
    let least = |at: usize| all.iter().map(|of_rank| of_rank[at]).fold(f64::INFINITY, f64::min);
    [std::array::from_fn(least), std::array::from_fn(|c| -least(c + 3))]
}
