//! Back and forth error compensation and correction (BFECC) of semi-Lagrangian advection: a value is advected forward, then backward;
//! half the error of the round trip is subtracted before it is advected once more. Second order in time and space, stable for steps of
//! any length.
//!
//! Dupont and Liu, J. Comput. Phys. 190 (2003). A path goes through the velocities at both ends of the step, linear in time; it begins
//! with that of its node, and each further part of it takes the velocity of the place it has come to, at the time it has come to.

use zelus_core::model::ModelPart;
use zelus_core::parallel;
use zelus_core::vector3::{add, scale};

use super::locator::{Locator, Place};
use super::whole_mesh::WholeMesh;

/// Nodes of a task.
const NODES: usize = 64;

/// Velocities of all nodes and how paths are followed.
pub struct Paths<'a> {
    /// Positions of the nodes.
    pub positions: &'a [[f64; 3]],
    /// Velocities at the end and at the beginning of the step.
    pub velocities: [&'a [[f64; 3]]; 2],
    /// Length of the step.
    pub time: f64,
    /// Parts of a path.
    pub parts: usize,
}

/// Where a path leads.
struct End<'a> {
    /// The last place of it in the mesh; `None` where it leaves at once.
    place: Option<Place<'a>>,
    /// Whether it stays in the mesh.
    is_inside: bool,
}

impl Paths<'_> {
    /// The path of a node forth (1) or back (−1).
    fn follow<'m>(&self, locator: &Locator<'m>, node: usize, way: f64) -> End<'m> {
        let (first, last) = if way > 0.0 { (1, 0) } else { (0, 1) };
        let step = way * self.time / self.parts as f64;
        let mut x = add(self.positions[node], scale(self.velocities[first][node], step));
        let mut place = None;
        for part in 1..=self.parts {
            let Some(found) = locator.find(x) else { return End { place, is_inside: false } };
            let share = part as f64 / self.parts as f64;
            let [begin, end] = [first, last].map(|level| found.vector(self.velocities[level]));
            x = add(x, scale(add(scale(begin, 1.0 - share), scale(end, share)), step));
            place = Some(found);
        }
        End { place, is_inside: true }
    }
}

/// Values after a step of the nodes that this rank owns, from those of all nodes before it. A node whose path back leaves the mesh has the
/// value where it left; one that begins outside keeps its own. Collective.
pub fn advected(
    part: &ModelPart,
    whole: &WholeMesh,
    locator: &Locator<'_>,
    paths: &Paths<'_>,
    values: &[[f64; 1]],
) -> Vec<[f64; 1]> {
    let own: Vec<usize> = whole.own.iter().map(|&node| WholeMesh::place(part, node)).collect();
    let back: Vec<(usize, End<'_>)> =
        parallel::map(own.len(), NODES, |at| (own[at], paths.follow(locator, own[at], -1.0)));
    let there: Vec<[f64; 1]> =
        back.iter().map(|(node, end)| end.place.map_or(values[*node], |place| [place.value(values)])).collect();
    let all_there = whole.field(part, &there);
    let corrected: Vec<[f64; 1]> = parallel::map(own.len(), NODES, |at| match paths.follow(locator, own[at], 1.0) {
        End { place: Some(place), is_inside: true } => [1.5 * values[own[at]][0] - 0.5 * place.value(&all_there)],
        _ => values[own[at]],
    });
    let all_corrected = whole.field(part, &corrected);
    let better = |((_, end), there): (&(usize, End<'_>), &[f64; 1])| match end.place {
        Some(place) if end.is_inside => [place.value(&all_corrected)],
        _ => *there,
    };
    back.iter().zip(&there).map(better).collect()
}
