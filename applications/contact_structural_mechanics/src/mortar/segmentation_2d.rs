//! The part of a slave line that faces a master line.
//!
//! A slave node i is projected against its normal nᵢ onto the master: x = xᵢ − d nᵢ with
//! d = (x²₀ − xᵢ)·n_m / (−nᵢ·n_m). A master node is projected onto the slave along the interpolated normal: the ξ with
//! ∂x/∂ξ · (x_m − d n(ξ) − x(ξ)) = 0, found by a bounded Newton iteration.

use super::geometry::PairGeometry;
use super::settings::SegmentationSettings;
use zelus_core::geometry::{combine, interpolate};
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::{cross, dot, scale, sub};

/// Newton steps allowed for the projection of a master node.
const MAX_STEPS: usize = 20;
/// Distance from the master line, relative to its length, within which a point counts as on it.
const ON_LINE: f64 = 1e-7;

/// The overlap as an interval of the slave's ξ, increasing; `None` if there is none.
pub(super) fn interval<T: Real>(pair: &PairGeometry<T>, settings: &SegmentationSettings) -> Option<[T; 2]> {
    let tolerance = 1e3 * settings.zero_tolerance_factor * f64::EPSILON;
    let values = pair.values();
    let mut covered = [false; 2];
    for i in 0..2 {
        let (distance, xi, on_master) = project_slave_node(&values, i);
        if distance > settings.distance_threshold {
            return None;
        }
        covered[i] = on_master && xi.abs() <= 1.0 + tolerance;
    }
    let whole = [T::constant(-1.0), T::constant(1.0)];
    if covered[0] && covered[1] {
        return Some(whole);
    }

    let mut hits = [None; 2];
    for j in 0..2 {
        let Some((xi, slope)) = project_master_node(&values, j) else { continue };
        hits[j] = Some(if xi > 1.0 - tolerance {
            covered[1] = true;
            whole[1]
        } else if xi < -1.0 + tolerance {
            covered[0] = true;
            whole[0]
        } else {
            let xi = T::constant(xi);
            xi - mismatch(pair, pair.master[j], xi) / slope
        });
    }
    let segment = match hits {
        [Some(a), Some(b)] => {
            let (low, high) = (a.min(b), a.max(b));
            [if covered[0] { whole[0] } else { low }, if covered[1] && !covered[0] { whole[1] } else { high }]
        }
        [Some(hit), None] | [None, Some(hit)] => match covered {
            [true, false] => [whole[0], hit],
            [false, true] => [hit, whole[1]],
            [true, true] => whole,
            [false, false] => return None,
        },
        [None, None] => return None,
    };
    (segment[1].value() - segment[0].value() > f64::EPSILON).then_some(segment)
}

/// Distance of the master line behind slave node `i` along its normal, ξ of the projection on the master, and whether
/// that point is on the master itself: with a lagging master normal it is only near.
/// A master line parallel to the normal is never met.
fn project_slave_node(pair: &PairGeometry<f64>, i: usize) -> (f64, f64, bool) {
    let normal = pair.nodal_normals[i];
    let slope = -dot(normal, pair.master_normal);
    if slope.abs() < f64::EPSILON {
        return (0.0, f64::INFINITY, false);
    }
    let distance = dot(sub(pair.master[0], pair.slave[i]), pair.master_normal) / slope;
    let point = sub(pair.slave[i], scale(normal, distance));
    let [xi, _] = pair.master_shape.closest_point(&pair.master, point, [0.0; 2]);
    let along = sub(pair.master[1], pair.master[0]);
    let across = cross(along, sub(point, pair.master[0]))[2];
    (distance, xi, across.abs() < ON_LINE * dot(along, along))
}

/// ξ ∈ [−1, 1] of the projection of master node `j` on the slave, and the slope of [`mismatch`] there.
fn project_master_node(pair: &PairGeometry<f64>, j: usize) -> Option<(f64, f64)> {
    let constant = pair.as_constants();
    let mut xi: f64 = if j == 0 { -1.0 } else { 1.0 };
    for _ in 0..MAX_STEPS {
        let Dual { value, gradient: [slope] } = mismatch(&constant, constant.master[j], Dual::<1>::variable(xi, 0));
        // Far from the solution the slope may lose its sign; −1 is its value for constant normals.
        let slope = if slope < -0.1 { slope } else { -1.0 };
        let next = (xi - value / slope).clamp(-1.0, 1.0);
        if !next.is_finite() {
            return None;
        }
        let step = next - xi;
        xi = next;
        if step.abs() < 1e-13 {
            return Some((xi, slope));
        }
    }
    None
}

/// Distance in ξ between x(ξ) and the projection of a master point on the slave line along n(ξ).
fn mismatch<T: Real>(pair: &PairGeometry<T>, point: [T; 3], xi: T) -> T {
    let facet = pair.slave_shape;
    let normal = interpolate(&facet.values([xi, T::zero()]), &pair.nodal_normals);
    let centre = combine(&facet.values(facet.centre), &pair.slave);
    let half = scale(sub(pair.slave[1], pair.slave[0]), T::constant(0.5));
    let along = dot(sub(centre, point), pair.slave_normal) / dot(normal, pair.slave_normal);
    let from_centre = sub(sub(point, centre), scale(normal, -along));
    dot(half, from_centre) / dot(half, half) - xi
}
