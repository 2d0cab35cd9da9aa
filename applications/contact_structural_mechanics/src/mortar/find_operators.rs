//! D and M of a pair, whatever its shapes, in plain numbers and with derivatives.

use super::choices::Choices;
use super::curved::{self, PairPoints};
use super::first_order::{EXACT_MOTION, FirstOrderPoints, MasterMotion};
use super::geometry::{Active, PairGeometry};
use super::operators::{Operators, Overlap, overlap_of};
use super::segmentation_3d::Polygon;
use super::settings::SegmentationSettings;
use zelus_core::geometry::{Nodal, interpolate};
use zelus_core::scalar::{Dual, Real};

/// Computes D and M of a pair: lines in the plane, triangles and quadrilaterals in space; those of second order as `curved` says.
///
/// With dual numbers the gradients are exact derivatives of the values, through cells, points and dual functions, as
/// long as the kinds of the overlap's vertices do not change.
pub fn operators<T: Real>(pair: &PairGeometry<T>, settings: &SegmentationSettings) -> Overlap<Operators<T>> {
    let mut out = Operators::zero(pair.slave_shape, pair.master_shape);
    let points = PairPoints::new(&pair.values(), settings);
    find_operators(pair, settings, &points, &EXACT_MOTION, &mut out).map(|()| out)
}

/// Writes D and M of a pair to `out`, whose entries are zero; `points` are those of the pair's values, `motion` is that of points on the
/// master.
///
/// Large numbers with derivatives are not moved about: the caller gives the memory.
pub fn find_operators<T: Real>(
    pair: &PairGeometry<T>,
    settings: &SegmentationSettings,
    points: &PairPoints,
    motion: &dyn MasterMotion<T>,
    out: &mut Operators<T>,
) -> Overlap<()> {
    if pair.is_curved() {
        let covered = curved::find_operators(pair, settings, points, out);
        return if out.is_finite() { overlap_of(covered, pair) } else { Overlap::None };
    }
    let covered = FirstOrderPoints { pair, motion }.visit(settings, &mut |point| out.add_point(point));
    out.finish(covered, pair)
}

/// Writes D and M to `out`, whose entries are zero, with derivatives by components of the nodal normals, [`LANES`](super::LANES) of them from the
/// one numbered `first` on, node by node.
///
/// In space the overlap of facets of first order is cut along the slave's normal: those of nodes say where points meet the master and
/// nothing else, each point by the one interpolated there. It has three components, whatever the number of nodes.
pub fn find_operators_by_normals(
    pair: &PairGeometry<f64>,
    settings: &SegmentationSettings,
    points: &PairPoints,
    first: usize,
    out: &mut Operators<Active>,
) -> Overlap<()> {
    if pair.space() == 2 {
        return find_operators(&pair.seeded_by_normals(first), settings, points, &EXACT_MOTION, out);
    }
    if pair.is_curved() {
        let covered = curved::find_operators_by_normals(pair, points, first, out);
        return if out.is_finite() { overlap_of(covered, pair) } else { Overlap::None };
    }
    let still: PairGeometry<Dual<3>> = pair.as_constants();
    let still = FirstOrderPoints { pair: &still, motion: &EXACT_MOTION };
    let mut master = Nodal::empty();
    let covered = FirstOrderPoints { pair, motion: &EXACT_MOTION }.visit(settings, &mut |point| {
        let normal = interpolate(&point.slave, &pair.nodal_normals);
        let normal = std::array::from_fn(|c| Dual::variable(normal[c], c));
        let x = interpolate(&point.slave, &pair.slave).map(Dual::constant);
        still.along(normal, x, Dual::zero(), &mut master);
        out.add_point_by_normals(point, &master, first);
    });
    out.finish(covered, pair)
}

/// The choices that gave the operators `found` of a pair.
pub fn choices_of(pair: &PairGeometry<f64>, settings: &SegmentationSettings, found: &Operators<f64>) -> Choices {
    if pair.is_curved() {
        let plain = curved::standard_pieces(pair, settings);
        return Choices { plain, slivers: true, ..pair.choices };
    }
    let origin = || {
        // Intervals of the plane have no such choice.
        let polygon = if pair.space() == 2 { None } else { Polygon::new(pair, settings) }?;
        Some(polygon.local(polygon.vertices()[0]))
    };
    Choices {
        origin: pair.choices.origin.or_else(origin),
        plain: pair.choices.plain | u8::from(!found.is_diagonal()),
        slivers: true,
    }
}
