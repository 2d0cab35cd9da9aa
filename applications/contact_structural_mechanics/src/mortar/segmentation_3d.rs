//! The polygon in which a slave facet and a master facet overlap, seen along the slave's normal.
//!
//! Both facets are flattened onto the plane with normal n_s and the convex polygons are intersected there. The kind of a vertex (a node
//! of either side, or a crossing of two edges) is decided on values with tolerances, which also makes coincident nodes and edges one
//! vertex; its position then follows in the scalar of the caller.

use super::geometry::PairGeometry;
use super::settings::SegmentationSettings;
use zelus_core::geometry::{FacetShape, Nodal, combine};
use zelus_core::scalar::Real;
use zelus_core::vector3::{cross, dot, normalised, sub, value};

/// Room for every node and every crossing of two quadrilaterals.
const CAPACITY: usize = 24;
/// Relative distance below which points coincide, and relative sine below which edges are parallel.
const TOLERANCE: f64 = 1e-12;
/// Sine of the angle between two edges below which their crossing moves with the slave's edge.
/// Its exact velocity grows like the inverse of the angle, while the shape of the overlap hardly depends on it.
const GRAZING: f64 = 1e-4;

/// Kind of a vertex of the overlap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Vertex {
    /// This master node, inside the slave.
    Master(usize),
    /// This slave node, inside the master.
    Slave(usize),
    /// The crossing of the edges that start at these nodes.
    Crossing { slave: usize, master: usize },
}

/// The vertices of an overlap, anticlockwise about the slave's normal.
pub(super) struct Polygon<T: Real> {
    slave_shape: &'static FacetShape,
    slave: Nodal<[T; 2]>,
    master: Nodal<[T; 2]>,
    vertices: [Vertex; CAPACITY],
    len: usize,
}

impl<T: Real> Polygon<T> {
    /// Intersects the flattened facets; `None` if they are too far apart or share no area.
    pub(super) fn new(pair: &PairGeometry<T>, settings: &SegmentationSettings) -> Option<Self> {
        let plane = Plane::new(pair);
        let corners = pair.master_shape.corners;
        if plane.is_beyond(pair.nodes_of_master(), settings.distance_threshold) {
            return None;
        }
        let slave = pair.slave.map(|x| plane.coordinates(x));
        // Without nodes beside its corners.
        let master = Nodal::new(corners, |n| plane.coordinates(pair.master[n]));

        let slave_shape = pair.slave_shape;
        let values = |nodes: &[[T; 2]], count: usize| Nodal::new(count, |n| nodes[n].map(T::value));
        let mut list = PointList::new(values(&slave, slave_shape.corners), values(&master, corners));
        list.tolerance = tolerance(&list.slave, settings.zero_tolerance_factor);
        list.collect();
        if list.len < 3 {
            return None;
        }
        list.sort();
        let mut polygon = Self { slave_shape, slave, master, vertices: list.vertices, len: list.len };
        if let Some(origin) = pair.choices.origin {
            polygon.begin_near(origin);
        }
        Some(polygon)
    }

    /// Turns the vertices so that the first is the one nearest to local coordinates of the slave.
    fn begin_near(&mut self, origin: [f64; 2]) {
        let distance = |&n: &usize| length(minus(self.local(self.vertices[n]).map(T::value), origin));
        let nearest = (0..self.len).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        self.vertices[..self.len].rotate_left(nearest.unwrap_or(0));
    }

    /// The vertices, the first of them the one all cells share.
    pub(super) fn vertices(&self) -> &[Vertex] {
        &self.vertices[..self.len]
    }

    /// Where on the slave's edge it crosses the master's, from 0 to 1.
    #[inline]
    fn crossing(&self, slave: usize, master: usize) -> T {
        crossing(&self.slave, &self.master, slave, master)
    }

    /// Mean of numbers at the slave nodes that a vertex lies on or between; zero at nodes of the master.
    pub(super) fn weigh(&self, vertex: Vertex, numbers: &[T]) -> T {
        match vertex {
            Vertex::Slave(n) => numbers[n],
            Vertex::Crossing { slave, master } => {
                let t = self.crossing(slave, master).value();
                numbers[slave] * (1.0 - t) + numbers[(slave + 1) % self.slave_shape.corners] * t
            }
            Vertex::Master(_) => T::zero(),
        }
    }

    /// Local coordinates of a vertex on the flattened slave.
    #[inline]
    pub(super) fn local(&self, vertex: Vertex) -> [T; 2] {
        match vertex {
            Vertex::Slave(n) => self.slave_shape.corner(n).map(T::constant),
            Vertex::Crossing { slave, master } => {
                let t = self.crossing(slave, master);
                let (start, end) =
                    (self.slave_shape.corner(slave), self.slave_shape.corner((slave + 1) % self.slave_shape.corners));
                std::array::from_fn(|c| t * (end[c] - start[c]) + start[c])
            }
            Vertex::Master(n) => {
                let lift = |p: [T; 2]| [p[0], p[1], T::zero()];
                self.slave_shape.closest_point(&self.slave.map(lift), lift(self.master[n]), self.slave_shape.centre)
            }
        }
    }
}

/// Where on the slave's edge, between its corners, the line of a master's edge crosses it, from 0 to 1.
#[inline]
fn crossing<T: Real>(slaves: &[[T; 2]], masters: &[[T; 2]], slave: usize, master: usize) -> T {
    let (a, b) = (slaves[slave], slaves[(slave + 1) % slaves.len()]);
    let (c, d) = (masters[master], masters[(master + 1) % masters.len()]);
    let (along, across) = (minus(b, a), minus(d, c));
    let denominator = cross2(along, across);
    let t = cross2(minus(c, a), across) / denominator;
    let grazing = denominator.value().abs() < GRAZING * length(along.map(T::value)) * length(across.map(T::value));
    if grazing { T::constant(t.value()) } else { t }
}

/// Where a vertex is in the plane, of polygons with these corners.
pub(super) fn place<T: Real>(vertex: Vertex, slaves: &[[T; 2]], masters: &[[T; 2]]) -> [T; 2] {
    match vertex {
        Vertex::Slave(n) => slaves[n],
        Vertex::Master(n) => masters[n],
        Vertex::Crossing { slave, master } => {
            let t = crossing(slaves, masters, slave, master);
            let (start, end) = (slaves[slave], slaves[(slave + 1) % slaves.len()]);
            std::array::from_fn(|c| start[c] + (end[c] - start[c]) * t)
        }
    }
}

/// The plane of the slave: its origin, in-plane axes (constant, any will do) and normal.
pub(super) struct Plane<T> {
    origin: [f64; 3],
    axes: [[f64; 3]; 2],
    normal: [T; 3],
    turn: [T; 2],
}

impl<T: Real> Plane<T> {
    pub(super) fn new(pair: &PairGeometry<T>) -> Self {
        let values = pair.values();
        let share = 1.0 / values.slave.len() as f64;
        let origin = combine(&values.slave.map(|_| share), &values.slave);
        let normal = normalised(values.slave_normal);
        // Project the longest of two edges, so that the axis is never degenerate.
        let in_plane = |a: [f64; 3]| std::array::from_fn(|c| a[c] - dot(a, normal) * normal[c]);
        let (a, b) = (in_plane(sub(values.slave[1], values.slave[0])), in_plane(sub(values.slave[2], values.slave[1])));
        let first = normalised(if dot(a, a) >= dot(b, b) { a } else { b });
        let axes = [first, cross(normal, first)];
        let turn = axes.map(|axis| {
            let mut sum = T::zero();
            (0..3).for_each(|c| sum.add_scaled(pair.slave_normal[c], axis[c]));
            sum
        });
        Self { origin, axes, normal: pair.slave_normal, turn }
    }

    /// Whether any of these points is in front of the plane by more than a distance.
    pub(super) fn is_beyond(&self, points: &[[T; 3]], distance: f64) -> bool {
        points.iter().any(|&x| dot(sub(value(x), self.origin), value(self.normal)) > distance)
    }

    /// In-plane coordinates of a point projected along the normal.
    #[inline]
    pub(super) fn coordinates(&self, x: [T; 3]) -> [T; 2] {
        let from_origin: [T; 3] = std::array::from_fn(|c| x[c] - self.origin[c]);
        let height = dot(from_origin, self.normal);
        std::array::from_fn(|a| {
            let mut along = T::zero();
            (0..3).for_each(|c| along.add_scaled(from_origin[c], self.axes[a][c]));
            along.add_product(-height, self.turn[a]);
            along
        })
    }
}

/// Vertices under construction, with their places in the plane. Edges between corners count as straight.
struct PointList {
    /// Corners of the slave.
    slave: Nodal<[f64; 2]>,
    /// Corners of the master.
    master: Nodal<[f64; 2]>,
    tolerance: f64,
    points: [[f64; 2]; CAPACITY],
    vertices: [Vertex; CAPACITY],
    len: usize,
}

impl PointList {
    fn new(slave: Nodal<[f64; 2]>, master: Nodal<[f64; 2]>) -> Self {
        Self {
            slave,
            master,
            tolerance: tolerance(&slave, 1.0),
            points: [[0.0; 2]; CAPACITY],
            vertices: [Vertex::Slave(0); CAPACITY],
            len: 0,
        }
    }

    /// Lists master nodes inside the slave, then slave nodes inside the master, then crossings of edges.
    fn collect(&mut self) {
        let (slave, master) = (self.slave, self.master);
        for n in 0..master.len() {
            if inside(master[n], &slave, self.tolerance) {
                self.push(master[n], Vertex::Master(n), self.tolerance);
            }
        }
        if self.len == master.len() {
            return;
        }
        for n in 0..slave.len() {
            if inside(slave[n], &master, self.tolerance) {
                self.push(slave[n], Vertex::Slave(n), self.tolerance);
            }
        }
        // Where nearly parallel edges cross is known badly along them: such crossings come last, and only where no other
        // point is.
        self.collect_crossings(false);
        self.collect_crossings(true);
    }

    /// Lists the crossings of edges, those of nearly parallel ones or the others.
    fn collect_crossings(&mut self, grazing: bool) {
        let (slave, master) = (self.slave, self.master);
        for i in 0..slave.len() {
            let (a, b) = (slave[i], slave[(i + 1) % slave.len()]);
            let along = minus(b, a);
            for j in 0..master.len() {
                let (c, d) = (master[j], master[(j + 1) % master.len()]);
                let across = minus(d, c);
                let denominator = cross2(along, across);
                let sine = denominator.abs() / (length(along) * length(across));
                if sine <= TOLERANCE || (sine < GRAZING) != grazing {
                    continue;
                }
                let t = cross2(minus(c, a), across) / denominator;
                let u = cross2(minus(c, a), along) / denominator;
                let range = -TOLERANCE..=1.0 + TOLERANCE;
                if range.contains(&t) && range.contains(&u) {
                    let point = [a[0] + t * along[0], a[1] + t * along[1]];
                    let distance = if grazing { self.tolerance / sine } else { self.tolerance };
                    self.push(point, Vertex::Crossing { slave: i, master: j }, distance);
                }
            }
        }
    }

    /// Adds a point that no other is within `distance` of.
    fn push(&mut self, point: [f64; 2], vertex: Vertex, distance: f64) {
        if self.points[..self.len].iter().all(|&p| length(minus(point, p)) > distance) {
            self.points[self.len] = point;
            self.vertices[self.len] = vertex;
            self.len += 1;
        }
    }

    /// Orders the points anticlockwise about their mean; the first of the list stays the first.
    fn sort(&mut self) {
        let count = self.len as f64;
        let sum = self.points[..self.len].iter().fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
        let mean = sum.map(|s| s / count);
        let angle = |p: [f64; 2]| (p[1] - mean[1]).atan2(p[0] - mean[0]);
        let start = angle(self.points[0]);
        let mut angles = [0.0; CAPACITY];
        for n in 1..self.len {
            let turn = angle(self.points[n]) - start;
            angles[n] = if turn < 0.0 { turn + std::f64::consts::TAU } else { turn };
        }
        for n in 2..self.len {
            let mut k = n;
            while k > 1 && angles[k] < angles[k - 1] {
                angles.swap(k, k - 1);
                self.vertices.swap(k, k - 1);
                k -= 1;
            }
        }
    }
}

/// Distance below which points of an overlap coincide; `factor` is that of the settings.
pub(super) fn tolerance(slave: &[[f64; 2]], factor: f64) -> f64 {
    TOLERANCE * area(slave).abs().sqrt() * (factor * f64::EPSILON / TOLERANCE).max(1.0)
}

#[inline]
pub(super) fn minus<T: Real>(a: [T; 2], b: [T; 2]) -> [T; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

#[inline]
pub(super) fn cross2<T: Real>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[1] - a[1] * b[0]
}

#[inline]
pub(super) fn length(a: [f64; 2]) -> f64 {
    (a[0] * a[0] + a[1] * a[1]).sqrt()
}

/// Signed area, positive if the nodes run anticlockwise.
pub(super) fn area(polygon: &[[f64; 2]]) -> f64 {
    let count = polygon.len();
    0.5 * (0..count).map(|n| cross2(polygon[n], polygon[(n + 1) % count])).sum::<f64>()
}

/// Whether a point lies in a convex polygon of either orientation, or within `tolerance` of it.
fn inside(point: [f64; 2], polygon: &[[f64; 2]], tolerance: f64) -> bool {
    let count = polygon.len();
    let sign = area(polygon).signum();
    (0..count).all(|n| {
        let edge = minus(polygon[(n + 1) % count], polygon[n]);
        sign * cross2(edge, minus(point, polygon[n])) >= -tolerance * length(edge)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertices(slave: [[f64; 2]; 4], master: [[f64; 2]; 4]) -> Vec<Vertex> {
        let mut list = PointList::new(slave.into(), master.into());
        list.collect();
        list.sort();
        list.vertices[..list.len].to_vec()
    }

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn moved(dx: f64, dy: f64) -> [[f64; 2]; 4] {
        [3, 2, 1, 0].map(|n| [SQUARE[n][0] + dx, SQUARE[n][1] + dy])
    }

    #[test]
    fn partial_overlap_mixes_all_kinds() {
        let found = vertices(SQUARE, moved(0.5, 0.25));
        let crossing = |slave, master| Vertex::Crossing { slave, master };
        assert_eq!(found, [Vertex::Master(3), crossing(1, 2), Vertex::Slave(2), crossing(2, 3)]);
    }

    #[test]
    fn coincident_squares_share_their_corners() {
        for noise in [0.0, 1e-15, -1e-15, 3e-13] {
            let found = vertices(SQUARE, moved(noise, -noise));
            assert_eq!(found, [Vertex::Master(0), Vertex::Master(3), Vertex::Master(2), Vertex::Master(1)]);
        }
    }

    #[test]
    fn edges_that_nearly_coincide_cross_at_no_new_corner() {
        // Diagonals on one line but for the twelve digits of a mesh file; the overlap is a triangle.
        let (low, high) = ([0.333333333333, 0.266666666667], [0.666666666667, 0.533333333333]);
        for n in 0..50 {
            let moved = |x: [f64; 2]| x.map(|x| x + 0.0137 * f64::from(n));
            let slave = [low, high, [low[0], high[1]]].map(moved);
            let master = [[0.0, 0.0], [0.0, 0.4], [0.5, 0.4]].map(moved);
            let mut list = PointList::new(slave.into(), master.into());
            list.collect();
            let corners = [low, [0.5, 0.4], [low[0], 0.4]].map(moved);
            for point in &list.points[..list.len] {
                assert!(corners.iter().any(|&c| length(minus(*point, c)) < 1e-11), "{n} {point:?}");
            }
        }
    }

    #[test]
    fn common_edge_makes_no_extra_vertex() {
        let found = vertices(SQUARE, moved(0.5, 0.0));
        assert_eq!(found.len(), 4, "{found:?}");
    }
}
