//! How far the unknowns of a step may go and still say something about the model.

use super::dof_table::DofTable;
use super::equations::Equations;
use crate::model::ModelPart;
use crate::vector3::norm;

/// Sizes of the model, prescribed motion included, that no body goes within a step while something holds it.
const FAR: f64 = 1e3;

/// Farthest motion of a held body within a step: a thousand times the diagonal of the box around all nodes and the largest
/// prescribed value (length); infinite for models without extent, which are no bodies. Collective.
pub fn runaway_bound(part: &ModelPart, dofs: &DofTable, equations: &Equations) -> f64 {
    let prescribed = dofs.dofs().iter().enumerate().filter(|(n, _)| dofs.moves_mesh(*n) && equations.is_fixed(*n));
    let prescribed = prescribed.filter_map(|(_, dof)| dof.value(part, 0));
    let prescribed = prescribed.fold(0.0, |most: f64, u| most.max(u.abs()));
    let side = |c: usize| {
        let of = part.nodes.initial.iter().map(|x| x[c]);
        of.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| (least.min(x), most.max(x)))
    };
    let sides = [0, 1, 2].map(side);
    let own = [sides[0].0, sides[1].0, sides[2].0, -sides[0].1, -sides[1].1, -sides[2].1, -prescribed];
    let all = part.ranks.gather_numbers(&own);
    let least = |at: usize| all.iter().map(|of_rank| of_rank[at]).fold(own[at], f64::min);
    let diagonal = norm([0, 1, 2].map(|c| -least(c + 3) - least(c)));
    if diagonal.is_finite() && diagonal > 0.0 { FAR * (diagonal - least(6)) } else { f64::INFINITY }
}
