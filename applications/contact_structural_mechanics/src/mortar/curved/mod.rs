//! Pairs in which a facet is of second order: the slave is cut along its linear sub-facets, and points are those of the true surfaces.
//!
//! In space each sub-facet of the slave meets the outline of the master, in the plane of the slave's normal; in the plane each chord of the
//! slave meets those of the master as lines of first order do. Cells have straight edges there. From there points go back to
//! the slave along that normal, `x = Σ N¹ x_k` with the weight of the true surface, and on along the interpolated nodal normal to
//! the true master. Points of surfaces are found on values once ([`PairPoints`]); each pass of derivatives moves them by one step.
//!
//! Multipliers live on the sub-facets, too (Popp, Wohlmuth, Gee and Wall 2012, "pwlin"): the dual functions of each sub-facet are those
//! of its linear functions L, Φ = De Me⁻¹ L with Me = ∫ L⊗L and De = ∫ diag L over the overlap of the sub-facet with the master. The areas
//! of all nodes are positive, whatever the overlap covers, which those of quadratic functions are not. With the quadratic N¹
//! of the facet D = ∫ Φ⊗N¹ is not diagonal: entries beside the diagonal are a few times smaller.

mod linear_functions;
mod lines;
mod outline;
mod overlap;
mod sub_facet_integrals;
mod surface_motion;
mod surface_points;

use super::geometry::{Active, PairGeometry};
use super::operators::Operators;
use super::overlap_point::OverlapPoint;
use super::settings::SegmentationSettings;
use lines::CurvedLines;
use sub_facet_integrals::SubFacetIntegrals;
use surface_motion::SurfaceMotion;
use zelus_core::scalar::Real;

pub use linear_functions::nodal_shares;
pub use overlap::PairPoints;

/// A visitor of points, each with the number of the slave's sub-facet that it lies on.
type Visitor<'v, T> = &'v mut dyn FnMut(usize, &OverlapPoint<T>);

/// Visits the points of the overlap; gives its length or area, without the factor of a revolution.
pub(super) fn for_each_point<T: Real>(
    pair: &PairGeometry<T>,
    settings: &SegmentationSettings,
    found: &PairPoints,
    visit: Visitor<'_, T>,
) -> f64 {
    let sub_facets = 0..pair.slave_shape.sub_facets.len();
    let Some(points) = found.of_surfaces() else {
        let (lines, mut covered) = (CurvedLines { pair, settings }, 0.0);
        sub_facets
            .for_each(|sub_facet| lines.of_sub_facet(sub_facet, &mut covered, &mut |point| visit(sub_facet, point)));
        return covered;
    };
    if T::DIFFERENTIATES {
        let motion = SurfaceMotion::new(pair, points);
        sub_facets.for_each(|sub_facet| motion.of_sub_facet(sub_facet, &mut |point| visit(sub_facet, point)));
    } else {
        sub_facets
            .for_each(|sub_facet| points.of_sub_facet(sub_facet).for_each(|point| visit(sub_facet, &point.constant())));
    }
    points.covered
}

/// Adds D and M of a pair to `out`; gives the length or area that is covered.
pub(super) fn find_operators<T: Real>(
    pair: &PairGeometry<T>,
    settings: &SegmentationSettings,
    found: &PairPoints,
    out: &mut Operators<T>,
) -> f64 {
    let zero = |sub_facet| SubFacetIntegrals::zero(pair.slave_shape, pair.master_shape, sub_facet);
    let (mut at, mut sums) = (0, zero(0));
    let covered = for_each_point(pair, settings, found, &mut |sub_facet, point| {
        if sub_facet != at {
            sums.add_to(pair.choices.is_plain(at), out);
            (at, sums) = (sub_facet, zero(sub_facet));
        }
        sums.add(point);
    });
    sums.add_to(pair.choices.is_plain(at), out);
    covered
}

/// As [`find_operators`] in space, with derivatives by components of the nodal normals, [`LANES`](super::geometry::LANES) of them from
/// the one numbered `first` on.
///
/// Normals of nodes say where points meet the master and nothing else, each point by the one interpolated there.
pub(super) fn find_operators_by_normals(
    pair: &PairGeometry<f64>,
    found: &PairPoints,
    first: usize,
    out: &mut Operators<Active>,
) -> f64 {
    let Some(points) = found.of_surfaces() else { return 0.0 };
    for sub_facet in 0..pair.slave_shape.sub_facets.len() {
        let mut sums = SubFacetIntegrals::zero(pair.slave_shape, pair.master_shape, sub_facet);
        for point in points.of_sub_facet(sub_facet) {
            sums.add_by_normals(&point.constant(), &point.master_by_normal(), first);
        }
        sums.add_to(pair.choices.is_plain(sub_facet), out);
    }
    points.covered
}

/// The sub-facets of the slave, as bits, on which standard functions stand in for dual ones.
pub(super) fn standard_pieces(pair: &PairGeometry<f64>, settings: &SegmentationSettings) -> u8 {
    let count = pair.slave_shape.sub_facets.len();
    let mut sums: Vec<SubFacetIntegrals<f64>> =
        (0..count).map(|sub_facet| SubFacetIntegrals::zero(pair.slave_shape, pair.master_shape, sub_facet)).collect();
    let found = PairPoints::new(pair, settings);
    for_each_point(pair, settings, &found, &mut |sub_facet, point| sums[sub_facet].add(point));
    let standard =
        |sub_facet: usize| u8::from(sums[sub_facet].is_covered() && sums[sub_facet].inverse().is_none()) << sub_facet;
    (0..count).map(standard).fold(pair.choices.plain, |all, own| all | own)
}
