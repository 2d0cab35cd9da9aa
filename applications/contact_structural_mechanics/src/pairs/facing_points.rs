//! The points at which two facets face each other, for interactions without multipliers.

use zelus_core::geometry::{FacetShape, interpolate};
use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, cross, dot, norm, scale, sub};

use crate::interface::Facet;
use crate::mortar::for_each_point;
use crate::mortar::{Choices, MOST_NODES, PairGeometry, SegmentationSettings};

/// A point of the slave and the one of the master before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacingPoint {
    /// Shape functions of the slave, as many as it has nodes.
    pub slave: [f64; MOST_NODES],
    /// Shape functions of the master; of a rigid shape those of its flat facet.
    pub master: [f64; MOST_NODES],
    /// The slave's point.
    pub position: [f64; 3],
    /// Length or area that it stands for.
    pub weight: f64,
    /// Way from the slave to the master along the slave's normal (length), negative inside the master.
    pub gap: f64,
    /// Area across the normals half way to the master and at the master, in that at the slave: 1 between planes, other than 1 where
    /// normals spread or close in, as in the gap between two cylinders.
    pub spread: [f64; 2],
}

/// The points of the overlap of two facets where they are now; none where they do not overlap or carry no contact.
/// `normal` gives the unit normal at a node of the slave.
pub fn facing_points(
    part: &ModelPart,
    slave: &Facet,
    master: &Facet,
    normal: &dyn Fn(u32) -> [f64; 3],
    settings: &SegmentationSettings,
) -> Vec<FacingPoint> {
    points_of(part, slave, master, normal, settings).unwrap_or_default()
}

fn points_of(
    part: &ModelPart,
    slave: &Facet,
    master: &Facet,
    normal: &dyn Fn(u32) -> [f64; 3],
    settings: &SegmentationSettings,
) -> Option<Vec<FacingPoint>> {
    let (slave_shape, master_shape) = (FacetShape::of(slave.shape)?, master.facet_shape()?);
    let of = |facet: &Facet| Some(facet.normal(part)).filter(|normal| *normal != [0.0; 3]);
    let position = |facet: &Facet, at: usize| part.nodes.current[facet.nodes[at] as usize];
    let geometry = PairGeometry {
        slave_shape,
        master_shape,
        slave: slave_shape.nodal(|j| position(slave, j)),
        master: master.positions_with_apex(part),
        nodal_normals: slave_shape.nodal(|j| normal(slave.nodes[j])),
        slave_normal: of(slave)?,
        master_normal: of(master)?,
        exact: master.exact_facet(),
        choices: Choices { slivers: settings.slivers, ..Choices::default() },
    };
    let mut out = Vec::new();
    for_each_point(&geometry, settings, &mut |point| {
        let x = interpolate(&point.slave, &geometry.slave);
        let y = interpolate(&point.master, &geometry.master);
        let at = point.local;
        let normal = interpolate(&point.slave, &geometry.nodal_normals);
        let size = norm(normal);
        let gap = if size > 0.0 { dot(sub(y, x), normal) / size } else { dot(sub(y, x), geometry.slave_normal) };
        let mut found = FacingPoint {
            slave: [0.0; MOST_NODES],
            master: [0.0; MOST_NODES],
            position: x,
            weight: point.weight,
            gap,
            spread: [0.5, 1.0].map(|way| spread(&geometry, at, normal, way * gap)),
        };
        found.slave[..slave_shape.nodes].copy_from_slice(&point.slave);
        // On the flat facet: its shape functions are those of the exact surface without the share of the apex.
        let flat: f64 = point.master.iter().take(master.nodes.len()).sum();
        let share = if master.exact.is_some() { flat } else { 1.0 };
        (0..master.nodes.len()).for_each(|l| found.master[l] = point.master[l] / share);
        out.push(found);
    });
    Some(out)
}

/// Area across the normals at a distance along them, in that of the slave's point `at`.
fn spread(geometry: &PairGeometry<f64>, at: [f64; 2], normal: [f64; 3], distance: f64) -> f64 {
    let shape = geometry.slave_shape;
    let tangents = shape.tangents(&geometry.slave, at);
    let turns = shape.tangents(&geometry.nodal_normals, at);
    let across = |far: f64| {
        let [t, s] = [0, 1].map(|a| add(tangents[a], scale(turns[a], far)));
        let area = if shape.space == 2 { [t[1], -t[0], 0.0] } else { cross(t, s) };
        dot(area, normal)
    };
    let (here, there) = (across(0.0), across(distance / norm(normal)));
    if here == 0.0 { 1.0 } else { there / here }
}
