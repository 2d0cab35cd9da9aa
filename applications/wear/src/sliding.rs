//! Pressure and direction of sliding at the points at which two facets face each other.

use std::f64::consts::TAU;

use zelus_contact_structural_mechanics::interface::Facet;
use zelus_contact_structural_mechanics::pairs::FacingPoint;
use zelus_contact_structural_mechanics::variables::CONTACT_PRESSURE;
use zelus_contact_structural_mechanics::{FacingPair, FacingSurfaces};
use zelus_core::model::ModelPart;
use zelus_core::parameters::SpaceTime;
use zelus_core::processes::ScalarValue;
use zelus_core::vector3::{add, dot, norm, scale, sub};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use crate::law::SlidingStep;

/// Gap in sizes of the slave facet beyond which a pressure is none of this pair.
const NEAR: f64 = 1.0;

/// How pairs are found, and how they slide.
pub struct SlidingSettings {
    /// Between which surfaces.
    pub surfaces: FacingSurfaces,
    /// Speed of sliding across the motion of the model (length per time).
    pub speed: Option<ScalarValue>,
    /// Whether bodies are of revolution about the y axis.
    pub around: bool,
}

/// A point of a slave facet that rubs on a master facet.
pub struct SlidingPoint<'a> {
    /// The facets, slave and master.
    pub facets: [&'a Facet; 2],
    /// Where on them, and the gap.
    pub point: FacingPoint,
    /// Area (length in the plane) that it stands for.
    pub area: f64,
    /// How they rub there.
    pub sliding: SlidingStep,
}

impl SlidingSettings {
    /// All points of an interface that press on each other, in an order that depends on nothing but the mesh.
    pub fn points(&self, part: &ModelPart, interface: usize) -> Vec<SlidingPoint<'_>> {
        self.surfaces.of_pairs(part, interface, |pair| self.of_pair(part, &pair))
    }

    fn of_pair<'a>(&self, part: &ModelPart, pair: &FacingPair<'a, '_>) -> Vec<SlidingPoint<'a>> {
        let facets = pair.facets;
        let [slave, master] = facets;
        let pressures = part.nodes.values.values(&CONTACT_PRESSURE, 0);
        let presses = |node: &u32| pressures.get(*node as usize).is_some_and(|pressure| *pressure > 0.0);
        if !slave.nodes.iter().any(presses) {
            return Vec::new();
        }
        let (normal, reach) = (slave.normal(part), NEAR * slave.extent(part));
        let sliding_point = |point: FacingPoint| {
            let pressure: f64 =
                slave.nodes.iter().zip(&point.slave).map(|(&node, n)| n * pressures[node as usize]).sum();
            let along = sub(motion(part, slave, &point.slave), motion(part, master, &point.master));
            let own = norm(sub(along, scale(normal, dot(along, normal))));
            let here = SpaceTime { current: point.position, initial: point.position, time: part.info.time };
            let across = self.speed.as_ref().map_or(0.0, |speed| speed.value(&here) * part.info.delta_time);
            let area = if self.around { TAU * point.position[0] * point.weight } else { point.weight };
            let sliding = SlidingStep { pressure, slip: own.hypot(across) };
            (pressure > 0.0 && point.gap.abs() <= reach).then_some(SlidingPoint { facets, point, area, sliding })
        };
        pair.points().into_iter().filter_map(sliding_point).collect()
    }
}

/// How far a point of a facet has moved in the step (length).
fn motion(part: &ModelPart, facet: &Facet, n: &[f64]) -> [f64; 3] {
    let field = part.nodes.history.get(DISPLACEMENT.name()).expect("checked before the run");
    let of_node = |&node: &u32| sub(field.vector(0, node as usize), field.vector(1, node as usize));
    facet.nodes.iter().map(of_node).zip(n).fold([0.0; 3], |sum, (way, n)| add(sum, scale(way, *n)))
}
