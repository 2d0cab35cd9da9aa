//! When a mesh has lost too much, and when a step wears too much to be one.

use zelus_contact_structural_mechanics::interface::Interface;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::geometry::Shape;
use zelus_core::geometry::mapping::{domain_size, is_inverted, shortest_node_distance};
use zelus_core::model::ModelPart;
use zelus_core::{Error, Result};
use zelus_structural_mechanics::laws::representative_young;

use crate::removal::NodalWear;
use crate::sliding::SlidingPoint;

/// Ratio of wear to the approach that its pressure makes above which pressures may swing: 4/π of the shortest wave on a mesh.
const STEADY: f64 = 1.0;

/// The elements at the surfaces that wear, each with its size when the stage began.
pub struct Limits {
    elements: Vec<(u32, Shape, f64)>,
    share: f64,
}

impl Limits {
    /// Elements may lose this `share` of their size.
    pub fn new(part: &ModelPart, interfaces: &[Interface], share: f64) -> Self {
        let mut wears = vec![false; part.nodes.len()];
        interfaces.iter().flat_map(|own| &own.nodes).for_each(|&node| wears[node as usize] = true);
        let near = |&at: &u32| part.elements.nodes(at).iter().any(|&node| wears[node as usize]);
        let sized = |at: u32| {
            let shape = part.elements.kinds[at as usize].cell?;
            Some((at, shape, domain_size(shape, &places(part, at))))
        };
        Self { elements: (0..part.elements.len() as u32).filter(near).filter_map(sized).collect(), share }
    }

    /// Whether the elements of this rank bear that nodes wear so, before they do.
    ///
    /// # Errors
    /// One that would lose too much or turn inside out.
    pub fn check(&self, part: &ModelPart, worn: &[NodalWear]) -> Result<()> {
        let mut ways = vec![[0.0; 3]; part.nodes.len()];
        for own in worn {
            (0..3).for_each(|c| ways[own.node as usize][c] += own.way[c]);
        }
        for &(at, shape, whole) in &self.elements {
            let mut x = places(part, at);
            for (x, &node) in x.iter_mut().zip(part.elements.nodes(at)) {
                (0..3).for_each(|c| x[c] += ways[node as usize][c]);
            }
            let lost = 1.0 - domain_size(shape, &x) / whole;
            let inverted = is_inverted(shape, part.info.domain_size, &x);
            if lost > self.share || inverted {
                let node = part.elements.nodes(at)[0] as usize;
                let [x, y, z] = part.nodes.current[node];
                let fact = match inverted {
                    true => "would turn inside out".to_owned(),
                    false => format!(
                        "would have lost {:.0} % of its volume, more than \"largest_share\" {}",
                        100.0 * lost,
                        self.share
                    ),
                };
                return Err(Error::NotConverged(format!(
                    "step {} to time {}: by wear element {} at ({x:.4e}, {y:.4e}, {z:.4e}) {fact}\n    only nodes of the \
                     surface move with it: mesh the surface with elements that are higher than what wears off, or end the run \
                     before and mesh the worn bodies anew",
                    part.info.step, part.info.time, part.elements.ids[at as usize]
                )));
            }
        }
        Ok(())
    }
}

/// The warning that this step wears so much that pressures may swing from step to step, where it does.
///
/// Wear in a step lowers the pressure by as much as an approach of that depth would raise it; beyond twice the present pressure,
/// explicit steps overshoot. Depth by pressure times E/h, with the distance h of nodes, is that ratio for the shortest wave on the
/// mesh.
pub fn warn_of_oscillation<'a>(
    part: &ModelPart,
    points: impl Iterator<Item = (&'a SlidingPoint<'a>, f64)>,
) -> Option<Diagnostic> {
    let young = |of: usize| part.properties.get(&of).and_then(representative_young);
    let ratio = |(point, depth): (&SlidingPoint<'a>, f64)| {
        let [slave, master] = point.facets.map(|facet| young(facet.properties).map_or(0.0, f64::recip));
        let softness = slave + master;
        if softness > 0.0 {
            2.0 * depth / (point.sliding.pressure * softness * shortest_node_distance(&point.facets[0].positions(part)))
        } else {
            0.0
        }
    };
    let most = points.map(ratio).fold(0.0, f64::max);
    let fact = format!(
        "step {}: wear is up to {most:.2} times the approach that makes its pressure: pressures may swing from step to step",
        part.info.step
    );
    let remedy = format!("take a \"time_step\" {:.0} times shorter", (most / STEADY).ceil());
    (most > STEADY).then(|| Diagnostic::warning("wear-step", fact).remedy(remedy))
}

fn places(part: &ModelPart, at: u32) -> Vec<[f64; 3]> {
    part.elements.nodes(at).iter().map(|&node| part.nodes.initial[node as usize]).collect()
}
