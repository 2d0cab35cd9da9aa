//! Points of the overlap of facets of first order: Gauss points on its cells, and where they go on the master.

use super::geometry::PairGeometry;
use super::overlap_point::OverlapPoint;
use super::segmentation_2d;
use super::segmentation_3d::{Polygon, Vertex};
use super::settings::SegmentationSettings;
use zelus_core::geometry::{FacetShape, LINE_2, Nodal, ShapeTable, TRIANGLE_3, combine, interpolate};
use zelus_core::scalar::Real;
use zelus_core::vector3::{cross, dot, norm, sub, value};

/// Share of the slave's measure below which a cell is skipped, and of a master's extent below which it has no area: normals would
/// be rounding noise.
const LEAST_CELL: f64 = 1e-13;

/// The motion of points of the slave on the master: where they are is the same for all.
pub trait MasterMotion<T: Real> {
    /// Lengths at the slave nodes by which vertices on them are lifted, for motions that know of it.
    fn lift(&self) -> Option<&[T]>;

    /// Local coordinates on a master of this shape and with these nodes of its point at `place`, which belongs to the slave's
    /// point `x` lifted by `lift`.
    fn local(&self, shape: &FacetShape, master: &[[T; 3]], place: [T; 3], x: [T; 3], lift: T) -> [T; 2];
}

/// Points that stay on the projection along the interpolated normal.
pub struct ExactMotion;

/// The one there is.
pub const EXACT_MOTION: ExactMotion = ExactMotion;

impl<T: Real> MasterMotion<T> for ExactMotion {
    fn lift(&self) -> Option<&[T]> {
        None
    }

    fn local(&self, shape: &FacetShape, master: &[[T; 3]], place: [T; 3], _: [T; 3], _: T) -> [T; 2] {
        shape.closest_point(master, place, shape.centre)
    }
}

/// A pair whose overlap is walked.
pub(super) struct FirstOrderPoints<'a, T: Real> {
    pub(super) pair: &'a PairGeometry<T>,
    pub(super) motion: &'a dyn MasterMotion<T>,
}

impl<T: Real> FirstOrderPoints<'_, T> {
    /// Visits the points; gives the length or area of the overlap, without the turn about an axis.
    pub(super) fn visit(&self, settings: &SegmentationSettings, visit: &mut dyn FnMut(&OverlapPoint<T>)) -> f64 {
        if !self.master_has_area() {
            return 0.0;
        }
        if self.pair.space() == 2 {
            segmentation_2d::interval(self.pair, settings).map_or(0.0, |ends| self.of_interval(ends, settings, visit))
        } else {
            Polygon::new(self.pair, settings).map_or(0.0, |polygon| self.of_polygon(&polygon, settings, visit))
        }
    }

    /// Whether local coordinates on the master mean anything: its length counts beside the slave's, its area beside its edges.
    fn master_has_area(&self) -> bool {
        let pair = self.pair;
        let master = pair.master.map(value);
        let measure = pair.master_shape.measure(&master);
        if pair.space() == 2 {
            return measure > LEAST_CELL * pair.slave_shape.measure(&pair.slave.map(value));
        }
        let corners = pair.master_shape.corners;
        let edge = |n: usize| sub(master[(n + 1) % corners], master[n]);
        let longest = (0..corners).map(|n| dot(edge(n), edge(n))).fold(0.0, f64::max);
        measure > LEAST_CELL * longest
    }

    /// Points of a segment of the slave line; gives its length.
    fn of_interval(
        &self,
        ends: [T; 2],
        settings: &SegmentationSettings,
        visit: &mut dyn FnMut(&OverlapPoint<T>),
    ) -> f64 {
        let pair = self.pair;
        let share = (ends[1] - ends[0]) * 0.5;
        let det_j = norm(sub(pair.slave[1], pair.slave[0])) * share;
        let revolution = settings.revolution();
        let rule = ShapeTable::get(LINE_2.shape, settings.integration_order.get());
        let mut out = OverlapPoint::room();
        for (weights, point) in rule.n::<2>().iter().zip(rule.points()) {
            out.local = [ends[0] * weights[0] + ends[1] * weights[1], T::zero()];
            pair.slave_shape.write_values(out.local, &mut out.slave);
            let x = interpolate(&out.slave, &pair.slave);
            out.weight = det_j * (point.weight / LINE_2.cell_size);
            if let Some(per_radius) = revolution {
                out.weight *= x[0] * per_radius;
            }
            self.find_master(x, T::zero(), &mut out);
            visit(&out);
        }
        det_j.value()
    }

    /// Points of the fan of triangles of a polygon; gives their area.
    fn of_polygon(
        &self,
        polygon: &Polygon<T>,
        settings: &SegmentationSettings,
        visit: &mut dyn FnMut(&OverlapPoint<T>),
    ) -> f64 {
        let pair = self.pair;
        let shape = pair.slave_shape;
        let whole = shape.measure(&pair.slave.map(value));
        let place = |xi: [T; 2]| interpolate(&shape.values(xi), &pair.slave);
        let rule = ShapeTable::get(TRIANGLE_3.shape, settings.integration_order.get());
        let mut covered = 0.0;
        let mut out = OverlapPoint::room();
        let vertices = polygon.vertices();
        let mut local = [polygon.local(vertices[0]), [T::zero(); 2], polygon.local(vertices[1])];
        let mut x = [place(local[0]), [T::zero(); 3], place(local[2])];
        let mut lifts = [self.lift(polygon, vertices[0]), T::zero(), self.lift(polygon, vertices[1])];
        for &vertex in &vertices[2..] {
            (lifts[1], lifts[2]) = (lifts[2], self.lift(polygon, vertex));
            let xi = polygon.local(vertex);
            (local[1], local[2]) = (local[2], xi);
            (x[1], x[2]) = (x[2], place(xi));
            let normal = cross(sub(x[1], x[0]), sub(x[2], x[0]));
            if norm(value(normal)) <= 2.0 * LEAST_CELL * whole {
                continue;
            }
            let area = norm(normal) * 0.5;
            covered += area.value();
            for (barycentric, point) in rule.n::<3>().iter().zip(rule.points()) {
                let mut x = combine(barycentric, &x);
                out.local = combine(barycentric, &local);
                if !shape.affine {
                    // Cells are flat and straight in space, a warped quadrilateral and its local coordinates are not.
                    out.local = shape.closest_point(&pair.slave, x, out.local.map(T::value));
                }
                shape.write_values(out.local, &mut out.slave);
                if !shape.affine {
                    x = interpolate(&out.slave, &pair.slave);
                }
                let lift = (0..3).fold(T::zero(), |sum, n| sum + lifts[n] * barycentric[n]);
                self.find_master(x, lift, &mut out);
                out.weight = area * (point.weight / TRIANGLE_3.cell_size);
                visit(&out);
            }
        }
        covered
    }

    fn lift(&self, polygon: &Polygon<T>, vertex: Vertex) -> T {
        self.motion.lift().map_or(T::zero(), |lift| polygon.weigh(vertex, lift))
    }

    /// Writes the shape functions of the master where a point `x` of the slave goes along the interpolated normal; `lift` is that of
    /// [`MasterMotion`].
    fn find_master(&self, x: [T; 3], lift: T, point: &mut OverlapPoint<T>) {
        self.along(interpolate(&point.slave, &self.pair.nodal_normals), x, lift, &mut point.master);
    }

    /// Writes the shape functions of the master where a point `x` of the slave goes along `normal`.
    pub(super) fn along(&self, normal: [T; 3], x: [T; 3], lift: T, out: &mut Nodal<T>) {
        let pair = self.pair;
        if let Some(exact) = &pair.exact
            && exact.write_along(pair.master_shape, &pair.master, x, normal, out)
        {
            return;
        }
        let distance = dot(sub(pair.master[0], x), pair.master_normal) / dot(normal, pair.master_normal);
        let mut projected = x;
        (0..3).for_each(|c| projected[c].add_product(normal[c], distance));
        pair.master_shape.write_values(self.motion.local(pair.master_shape, &pair.master, projected, x, lift), out);
    }
}
