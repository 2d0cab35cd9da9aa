//! The integration points of the overlap of a pair: Gauss points on its cells, and where they go on the master.

use std::marker::PhantomData;

use super::curved;
use super::geometry::PairGeometry;
use super::segmentation_2d;
use super::segmentation_3d::{Polygon, Vertex};
use super::settings::SegmentationSettings;
use zelus_core::geometry::{FacetShape, Line2, ShapeTable, Triangle3};
use zelus_core::scalar::Real;
use zelus_core::vector3::{cross, dot, norm, sub, value};

/// Share of the slave's measure below which a cell is skipped, and of a master's extent below which it has no area: normals would
/// be rounding noise.
const LEAST_CELL: f64 = 1e-13;

/// A point of the slave that faces a point of the master.
#[derive(Debug, Clone, Copy)]
pub struct Point<T: Real, S: FacetShape, M: FacetShape> {
    /// Local coordinates on the slave.
    pub local: [T; 2],
    /// Shape functions of the slave.
    pub slave: S::Nodal<T>,
    /// Shape functions of the master.
    pub master: M::Nodal<T>,
    /// Length or area that it stands for; about an axis also 2π r by the thickness.
    pub weight: T,
}

/// Visits the points of the overlap; gives its length or area, without the turn about an axis.
pub fn for_each_point<T: Real, S: FacetShape, M: FacetShape>(
    pair: &PairGeometry<T, S, M>,
    settings: &SegmentationSettings,
    mut visit: impl FnMut(&Point<T, S, M>),
) -> f64 {
    ByOrder::<T, S, M>::VISIT(pair, settings, &mut visit)
}

/// The walk over points by the order of the shapes. A constant, so that only what a pair of shapes needs is compiled for it.
struct ByOrder<T: Real, S: FacetShape, M: FacetShape>(PhantomData<(T, S, M)>);

impl<T: Real, S: FacetShape, M: FacetShape> ByOrder<T, S, M> {
    const VISIT: fn(&PairGeometry<T, S, M>, &SegmentationSettings, &mut dyn FnMut(&Point<T, S, M>)) -> f64 =
        if S::CURVED || M::CURVED { Self::curved } else { Self::straight };

    fn straight(
        pair: &PairGeometry<T, S, M>,
        settings: &SegmentationSettings,
        visit: &mut dyn FnMut(&Point<T, S, M>),
    ) -> f64 {
        Points { pair, motion: &ExactMotion }.visit(settings, visit)
    }

    fn curved(
        pair: &PairGeometry<T, S, M>,
        settings: &SegmentationSettings,
        visit: &mut dyn FnMut(&Point<T, S, M>),
    ) -> f64 {
        curved::for_each_point(pair, settings, &mut |_, point| visit(point))
    }
}

/// How points of the slave move on the master: where they are is the same for all.
pub trait MasterMotion<T: Real, S: FacetShape> {
    /// Lengths at the slave nodes by which vertices on them are lifted, for motions that know of it.
    fn lift(&self) -> Option<&S::Nodal<T>>;

    /// Local coordinates on `master` of its point at `place`, which belongs to the slave's point `x` lifted by `lift`.
    fn local<M: FacetShape>(&self, master: &M::Nodal<[T; 3]>, place: [T; 3], x: [T; 3], lift: T) -> [T; 2];
}

/// Points that stay on the projection along the interpolated normal.
pub(super) struct ExactMotion;

impl<T: Real, S: FacetShape> MasterMotion<T, S> for ExactMotion {
    fn lift(&self) -> Option<&S::Nodal<T>> {
        None
    }

    #[inline]
    fn local<M: FacetShape>(&self, master: &M::Nodal<[T; 3]>, place: [T; 3], _: [T; 3], _: T) -> [T; 2] {
        M::closest_point(master, place, M::CENTRE)
    }
}

/// A pair whose overlap is walked.
pub(super) struct Points<'a, T: Real, P, S: FacetShape, M: FacetShape> {
    pub(super) pair: &'a PairGeometry<T, S, M>,
    pub(super) motion: &'a P,
}

impl<T: Real, P: MasterMotion<T, S>, S: FacetShape, M: FacetShape> Points<'_, T, P, S, M> {
    /// As [`for_each_point`].
    #[inline]
    pub(super) fn visit(&self, settings: &SegmentationSettings, visit: impl FnMut(&Point<T, S, M>)) -> f64 {
        if !self.master_has_area() {
            return 0.0;
        }
        if S::SPACE == 2 {
            segmentation_2d::interval(self.pair, settings).map_or(0.0, |ends| self.of_interval(ends, settings, visit))
        } else {
            Polygon::new(self.pair, settings).map_or(0.0, |polygon| self.of_polygon(&polygon, settings, visit))
        }
    }

    /// Whether local coordinates on the master mean anything: its length counts beside the slave's, its area beside its edges.
    fn master_has_area(&self) -> bool {
        let master = M::map(&self.pair.master, value);
        let measure = M::measure(&master);
        if M::SPACE == 2 {
            return measure > LEAST_CELL * S::measure(&S::map(&self.pair.slave, value));
        }
        let edge = |n: usize| sub(master[(n + 1) % M::CORNERS], master[n]);
        let longest = (0..M::CORNERS).map(|n| dot(edge(n), edge(n))).fold(0.0, f64::max);
        measure > LEAST_CELL * longest
    }

    /// Points of a segment of the slave line; gives its length.
    #[inline]
    fn of_interval(
        &self,
        ends: [T; 2],
        settings: &SegmentationSettings,
        mut visit: impl FnMut(&Point<T, S, M>),
    ) -> f64 {
        let share = (ends[1] - ends[0]) * 0.5;
        let det_j = norm(sub(self.pair.slave[1], self.pair.slave[0])) * share;
        let revolution = settings.revolution();
        let rule = ShapeTable::get(Line2::SHAPE, settings.integration_order.get());
        for (weights, point) in rule.n::<{ Line2::NODES }>().iter().zip(rule.points()) {
            let local = [ends[0] * weights[0] + ends[1] * weights[1], T::zero()];
            let slave = S::values(local);
            let x = S::interpolate(&slave, &self.pair.slave);
            let mut weight = det_j * (point.weight / Line2::SHAPE.cell().size());
            if let Some(per_radius) = revolution {
                weight *= x[0] * per_radius;
            }
            let master = self.on_master(&slave, x, T::zero());
            visit(&Point { local, slave, master, weight });
        }
        det_j.value()
    }

    /// Points of the fan of triangles of a polygon; gives their area.
    #[inline]
    fn of_polygon(
        &self,
        polygon: &Polygon<T, S, M>,
        settings: &SegmentationSettings,
        mut visit: impl FnMut(&Point<T, S, M>),
    ) -> f64 {
        let whole = S::measure(&S::map(&self.pair.slave, value));
        let place = |xi: [T; 2]| S::interpolate(&S::values(xi), &self.pair.slave);
        let rule = ShapeTable::get(Triangle3::SHAPE, settings.integration_order.get());
        let mut covered = 0.0;
        let vertices = polygon.vertices();
        let mut local = [polygon.local(vertices[0]), [T::zero(); 2], polygon.local(vertices[1])];
        let mut x = [place(local[0]), [T::zero(); 3], place(local[2])];
        let mut lifts = [self.lift(polygon, vertices[0]), T::zero(), self.lift(polygon, vertices[1])];
        for &vertex in &vertices[2..] {
            (lifts[1], lifts[2]) = (lifts[2], self.lift(polygon, vertex));
            let xi = polygon.local(vertex);
            (local[1], local[2]) = (local[2], xi);
            (x[1], x[2]) = (x[2], S::interpolate(&S::values(xi), &self.pair.slave));
            let normal = cross(sub(x[1], x[0]), sub(x[2], x[0]));
            if norm(value(normal)) <= 2.0 * LEAST_CELL * whole {
                continue;
            }
            let area = norm(normal) * 0.5;
            covered += area.value();
            for (barycentric, point) in rule.n::<{ Triangle3::NODES }>().iter().zip(rule.points()) {
                let mut x = Triangle3::combine(barycentric, &x);
                let mut xi = Triangle3::combine(barycentric, &local);
                let mut slave = S::values(xi);
                if !S::AFFINE {
                    // Cells are flat and straight in space, a warped quadrilateral and its local coordinates are not.
                    xi = S::closest_point(&self.pair.slave, x, xi.map(T::value));
                    slave = S::values(xi);
                    x = S::interpolate(&slave, &self.pair.slave);
                }
                let lift = (0..3).fold(T::zero(), |sum, n| sum + lifts[n] * barycentric[n]);
                let master = self.on_master(&slave, x, lift);
                visit(&Point {
                    local: xi,
                    slave,
                    master,
                    weight: area * (point.weight / Triangle3::SHAPE.cell().size()),
                });
            }
        }
        covered
    }

    fn lift(&self, polygon: &Polygon<T, S, M>, vertex: Vertex) -> T {
        self.motion.lift().map_or(T::zero(), |lift| polygon.weigh(vertex, lift))
    }

    /// Shape functions of the master where a point of the slave goes along the interpolated normal; `lift` is that of
    /// [`MasterMotion`].
    #[inline]
    fn on_master(&self, slave: &S::Nodal<T>, x: [T; 3], lift: T) -> M::Nodal<T> {
        self.along(S::interpolate(slave, &self.pair.nodal_normals), x, lift)
    }

    /// Shape functions of the master where a point `x` of the slave goes along `normal`.
    #[inline]
    pub(super) fn along(&self, normal: [T; 3], x: [T; 3], lift: T) -> M::Nodal<T> {
        let pair = self.pair;
        let distance = dot(sub(pair.master[0], x), pair.master_normal) / dot(normal, pair.master_normal);
        let mut projected = x;
        (0..3).for_each(|c| projected[c].add_product(normal[c], distance));
        M::values(self.motion.local::<M>(&pair.master, projected, x, lift))
    }
}
