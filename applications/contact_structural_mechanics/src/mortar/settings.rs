//! Settings of a deck for the integration of a pair.

use std::f64::consts::PI;

/// How the overlap of a pair is found and integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SegmentationSettings {
    /// Signed projection distance beyond which a pair is taken as apart; a length.
    /// Surfaces: distance of a master node in front of the slave. Lines: distance of the master behind a slave node.
    pub distance_threshold: f64,
    /// Multiple of the built-in geometric tolerance; 1 unless a deck says otherwise.
    pub zero_tolerance_factor: f64,
    /// Whether slivers count where the nodes of their slave have other overlaps.
    pub slivers: bool,
    /// Gauss rule on each cell of the overlap.
    pub integration_order: IntegrationOrder,
    /// Thickness of the pair in a model rotated about the y axis; `None` for planar and solid models.
    pub axisymmetric: Option<f64>,
}

impl Default for SegmentationSettings {
    fn default() -> Self {
        Self {
            distance_threshold: 1e24,
            zero_tolerance_factor: 1.0,
            slivers: true,
            integration_order: IntegrationOrder::default(),
            axisymmetric: None,
        }
    }
}

impl SegmentationSettings {
    /// Number of the Gauss rule on cells of facets of second order: exact for functions of the fourth degree at least, as those
    /// of quadrilaterals with nine nodes are.
    #[inline]
    pub(crate) fn rule_of_second_order(&self) -> usize {
        self.integration_order.get().max(4)
    }

    /// Factor on the weight of a point at `radius` per unit of radius: 2π/thickness, or `None` if not axisymmetric.
    #[inline]
    pub(crate) fn revolution(&self) -> Option<f64> {
        self.axisymmetric.map(|thickness| 2.0 * PI / thickness)
    }
}

/// Gauss rule of a cell, by its number 1 to 5.
/// A line gets that many points; a triangle 1, 3, 4, 6 or 12.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct IntegrationOrder(u8);

impl IntegrationOrder {
    /// The rule of a number, or `None` outside 1 to 5.
    pub fn new(order: usize) -> Option<Self> {
        (1..=5).contains(&order).then_some(Self(order as u8))
    }

    /// The number, 1 to 5.
    #[inline]
    pub fn get(self) -> usize {
        usize::from(self.0)
    }
}

impl Default for IntegrationOrder {
    /// Order 2: exact for the mortar integrals of flat triangles and straight lines.
    fn default() -> Self {
        Self(2)
    }
}
