//! Pairs of facets that are near each other and do not face the same way.

use rayon::prelude::*;
use zelus_core::model::ModelPart;
use zelus_core::vector3::{norm, sub};

use super::tree::{Bounds, Tree};
use crate::interface::{Interface, Roles, centre_normal, positions};

/// What decides whether a pair is a candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSettings {
    /// Reach of the search in radii of the slave facet.
    pub factor: f64,
    /// Least difference of the unit normals: facets that face the same way are not a pair.
    pub normal_orientation_threshold: f64,
}

/// Candidates (slave facet, master facet) of an interface in the present configuration, ascending.
pub fn candidates(part: &ModelPart, interface: &Interface, settings: &SearchSettings) -> Vec<(u32, u32)> {
    let of_role = |role: Roles| -> Vec<u32> {
        (0..interface.facets.len() as u32).filter(|&f| interface.facets[f as usize].role == role).collect()
    };
    let (slaves, masters) = (of_role(Roles::Slave), of_role(Roles::Master));
    let normal = |f: u32| {
        let facet = &interface.facets[f as usize];
        centre_normal(facet.shape, positions(facet, part, &mut [[0.0; 3]; 4])).unwrap_or([0.0; 3])
    };
    let bounds = |f: u32| Bounds::of(positions(&interface.facets[f as usize], part, &mut [[0.0; 3]; 4]));
    let tree = Tree::new(masters.iter().map(|&m| bounds(m)).collect());
    let normals: Vec<[f64; 3]> = masters.iter().map(|&m| normal(m)).collect();
    slaves
        .par_iter()
        .with_min_len(64)
        .flat_map_iter(|&slave| {
            let mut buffer = [[0.0; 3]; 4];
            let points = positions(&interface.facets[slave as usize], part, &mut buffer);
            let centre: [f64; 3] =
                std::array::from_fn(|c| points.iter().map(|p| p[c]).sum::<f64>() / points.len() as f64);
            let radius = points.iter().map(|p| norm(sub(*p, centre))).fold(0.0, f64::max);
            let near = tree.meeting(&Bounds::of(points).grown((settings.factor - 1.0).max(0.0) * radius));
            let own = normal(slave);
            let found: Vec<(u32, u32)> = near
                .into_iter()
                .filter(|&m| norm(sub(own, normals[m as usize])) >= settings.normal_orientation_threshold)
                .map(|m| (slave, masters[m as usize]))
                .collect();
            found
        })
        .collect()
}
