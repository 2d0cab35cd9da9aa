//! The estimate of penalty and scale factor from the stiffness of the bodies (eq. 4.11).
//!
//! ε = k = factor · E_mean / h_mean on each side, the means weighted by the area of the facets; the smaller side counts.

use zelus_core::geometry::mapping::domain_size;
use zelus_core::model::ModelPart;

use super::facets::{Interface, Roles};
use super::normals::positions;
use crate::variables::NODAL_H;

/// Penalty and scale factor of an interface, force per length cubed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlmParameters {
    /// INITIAL_PENALTY, ε.
    pub penalty: f64,
    /// SCALE_FACTOR, k.
    pub scale_factor: f64,
}

/// The estimate of eq. 4.11 for all interfaces together.
///
/// `stiffness_factor` is the factor of E/h, `penalty_scale_factor` the ratio of scale factor and penalty.
pub fn alm_parameters(
    part: &ModelPart,
    interfaces: &[Interface],
    stiffness_factor: f64,
    penalty_scale_factor: f64,
) -> AlmParameters {
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let mut buffer = [[0.0; 3]; 4];
    let mut side = |role: Roles| {
        let (mut area, mut stiffness, mut length) = (0.0, 0.0, 0.0);
        for facet in interfaces.iter().flat_map(|i| &i.facets).filter(|f| f.role == role || f.role == Roles::Open) {
            let size = domain_size(facet.shape, positions(facet, part, &mut buffer));
            let young = part.properties.get(&facet.properties).and_then(|p| p.number("YOUNG_MODULUS")).unwrap_or(0.0);
            area += size;
            stiffness += young * size;
            length += size / facet.nodes.len() as f64 * facet.nodes.iter().map(|&n| sizes[n as usize]).sum::<f64>();
        }
        if area > 0.0 && length > 0.0 { (stiffness / area, stiffness_factor * stiffness / length) } else { (0.0, 0.0) }
    };
    let ((young, slave), (_, master)) = (side(Roles::Slave), side(Roles::Master));
    let slave = if young <= 0.0 { master } else { slave };
    let penalty = slave.min(master);
    AlmParameters { penalty, scale_factor: penalty_scale_factor * penalty }
}
