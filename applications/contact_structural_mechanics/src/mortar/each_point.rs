//! The integration points of the overlap of a pair, whatever its shapes.

use super::curved::{self, PairPoints};
use super::first_order::{EXACT_MOTION, FirstOrderPoints};
use super::geometry::PairGeometry;
use super::overlap_point::OverlapPoint;
use super::settings::SegmentationSettings;
use zelus_core::scalar::Real;

/// Visits the points of the overlap; gives its length or area, without the turn about an axis.
pub fn for_each_point<T: Real>(
    pair: &PairGeometry<T>,
    settings: &SegmentationSettings,
    visit: &mut dyn FnMut(&OverlapPoint<T>),
) -> f64 {
    if pair.is_curved() {
        let found = PairPoints::new(&pair.values(), settings);
        curved::for_each_point(pair, settings, &found, &mut |_, point| visit(point))
    } else {
        FirstOrderPoints { pair, motion: &EXACT_MOTION }.visit(settings, visit)
    }
}
