//! Back and forth error compensation and correction: a value is carried along paths, back again, and what that misses is halved and
//! taken off before it is carried once more. Second order in time and space, stable for steps of any length.
//!
//! Dupont and Liu, J. Comput. Phys. 190 (2003). A path goes through the velocities at both ends of the step, linear in time; it begins
//! with that of its node, and each further part of it takes the velocity of the place it has come to, at the time it has come to.

use rayon::prelude::*;
use zelus_core::vector3::{add, scale};

use super::locator::{Locator, Place};

/// Velocities of the nodes and how paths are followed.
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

/// Values of the nodes after a step. A node whose path back leaves the mesh has the value where it left; one that begins outside keeps
/// its own.
pub fn carried(locator: &Locator<'_>, paths: &Paths<'_>, values: &[f64]) -> Vec<f64> {
    let nodes = 0..values.len();
    let back: Vec<End<'_>> = nodes.clone().into_par_iter().map(|node| paths.follow(locator, node, -1.0)).collect();
    let there: Vec<f64> =
        back.iter().zip(values).map(|(end, own)| end.place.map_or(*own, |place| place.value(values))).collect();
    let corrected = nodes.into_par_iter().map(|node| match paths.follow(locator, node, 1.0) {
        End { place: Some(place), is_inside: true } => 1.5 * values[node] - 0.5 * place.value(&there),
        _ => values[node],
    });
    let corrected: Vec<f64> = corrected.collect();
    let better = |(end, there): (&End<'_>, &f64)| match end.place {
        Some(place) if end.is_inside => place.value(&corrected),
        _ => *there,
    };
    back.iter().zip(&there).map(better).collect()
}
