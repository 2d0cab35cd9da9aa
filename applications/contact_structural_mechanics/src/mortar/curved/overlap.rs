//! The points of a pair's overlap that are found once for all passes of derivatives.

use super::super::geometry::PairGeometry;
use super::super::settings::SegmentationSettings;
use super::surface_points::SurfacePoints;

/// Points of the overlap of surfaces of second order, which are found on values; other pairs find theirs in each pass.
pub struct PairPoints(Option<SurfacePoints>);

impl PairPoints {
    /// Overlap of a pair.
    pub fn new(pair: &PairGeometry<f64>, settings: &SegmentationSettings) -> Self {
        Self((pair.is_curved() && pair.space() == 3).then(|| SurfacePoints::new(pair, settings)))
    }

    /// Points of surfaces.
    pub(super) fn of_surfaces(&self) -> Option<&SurfacePoints> {
        self.0.as_ref()
    }
}
