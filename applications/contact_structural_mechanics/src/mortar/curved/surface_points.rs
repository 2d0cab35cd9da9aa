//! Points of the overlap of surfaces, of which one at least is of second order, found on values once for all passes of derivatives.

use std::ops::Range;

use super::super::geometry::PairGeometry;
use super::super::overlap_point::OverlapPoint;
use super::super::segmentation_3d::{Plane, Vertex, area, cross2, minus, place, tolerance};
use super::super::settings::SegmentationSettings;
use super::outline::{ClosedLine, rim};
use zelus_core::geometry::{Crossing, ExactFacet, ExactFunctions, FacetShape, Nodal, ShapeTable, TRIANGLE_3, combine};
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::{cross, dot, norm};

/// Share of the area of a part of the slave below which a cell is skipped.
const LEAST_CELL: f64 = 1e-13;
/// Newton steps of the search for a point of the slave.
const MAX_STEPS: usize = 25;
/// Its step in local coordinates after which nothing is left but round-off.
const SETTLED: f64 = 1e-9;

/// A convex part of the slave: a sub-facet, or a triangle of one that is not convex.
struct SlavePart {
    /// Local coordinates of its corners.
    corners: Nodal<[f64; 2]>,
}

/// A triangle of the overlap in the plane of the slave.
pub(super) struct Cell {
    part: usize,
    vertices: [Vertex; 3],
    /// Its points.
    pub(super) points: Range<usize>,
}

/// A point of a cell.
pub(super) struct SurfacePoint {
    /// Its shares of the corners of the cell.
    pub(super) barycentric: [f64; 3],
    /// Its share of the area of the cell.
    pub(super) share: f64,
    /// Area that it stands for.
    pub(super) weight: f64,
    /// The slave there.
    pub(super) slave: FacetPoint,
    /// ∂ξ/∂x of the slave in the plane (one by length).
    pub(super) inverse: [[f64; 2]; 2],
    /// Area of the true surface by that in the plane.
    pub(super) stretch: f64,
    /// The master there.
    pub(super) master: FacetPoint,
    /// The way to the master along the interpolated normal; `None` where the master is not met and its closest point stands in.
    pub(super) way: Option<Crossing>,
}

/// Shape functions of a facet at one of its points, and their derivatives.
pub(super) struct FacetPoint {
    /// Local coordinates.
    pub(super) local: [f64; 2],
    /// Values.
    pub(super) values: Nodal<f64>,
    /// By ξ and by η.
    pub(super) gradients: [Nodal<f64>; 2],
}

impl SurfacePoint {
    /// The point without derivatives.
    pub(super) fn constant<T: Real>(&self) -> OverlapPoint<T> {
        OverlapPoint {
            local: self.slave.local.map(T::constant),
            slave: self.slave.values.map(T::constant),
            master: self.master.values.map(T::constant),
            weight: T::constant(self.weight),
        }
    }

    /// Local coordinates on the master near the point before local coordinates of the slave, to first order.
    fn master_near(&self, pair: &PairGeometry<f64>, slave: [f64; 2]) -> Option<[f64; 2]> {
        let way = self.way?;
        let (tangents, turns) = (self.slave.derivatives(&pair.slave), self.slave.derivatives(&pair.nodal_normals));
        let moved = minus(slave, self.slave.local);
        let along: [f64; 3] =
            std::array::from_fn(|c| (0..2).map(|a| (tangents[a][c] + way.distance * turns[a][c]) * moved[a]).sum());
        Some(std::array::from_fn(|b| self.master.local[b] + dot(way.rows[b], along)))
    }

    /// Derivatives of the shape functions of the master by the components of the interpolated normal.
    pub(super) fn master_by_normal(&self) -> Nodal<[f64; 3]> {
        let [by_xi, by_eta] = &self.master.gradients;
        let (distance, rows) = self.way.map_or((0.0, [[0.0; 3]; 2]), |way| (way.distance, way.rows));
        Nodal::new(by_xi.len(), |l| {
            std::array::from_fn(|c| distance * (by_xi[l] * rows[0][c] + by_eta[l] * rows[1][c]))
        })
    }
}

impl FacetPoint {
    fn new(shape: &FacetShape, local: [f64; 2]) -> Self {
        let at = shape.values([Dual::<2>::variable(local[0], 0), Dual::variable(local[1], 1)]);
        Self { local, values: at.map(|n| n.value), gradients: [0, 1].map(|a| at.map(|n| n.gradient[a])) }
    }

    fn exact(facet: &ExactFacet, shape: &FacetShape, local: [f64; 2]) -> Self {
        let ExactFunctions { values, gradients } = facet.functions(shape, local);
        Self { local, values, gradients }
    }

    /// ∂v/∂ξ and ∂v/∂η of an interpolated vector.
    pub(super) fn derivatives<const C: usize>(&self, nodal: &[[f64; C]]) -> [[f64; C]; 2] {
        [0, 1].map(|a| combine(&self.gradients[a], nodal))
    }
}

/// The overlap of a pair of surfaces.
#[derive(Default)]
pub(super) struct SurfacePoints {
    parts: Vec<SlavePart>,
    cells: Vec<Cell>,
    points: Vec<SurfacePoint>,
    /// Cells of each sub-facet of the slave.
    sub_facets: Vec<Range<usize>>,
    /// Area of the overlap.
    pub(super) covered: f64,
}

/// Area of a triangle in the plane.
pub(super) fn area_of_cell<T: Real>([a, b, c]: &[[T; 2]; 3]) -> T {
    cross2(minus(*b, *a), minus(*c, *a)) * 0.5
}

impl SurfacePoints {
    /// Points of a pair.
    pub(super) fn new(pair: &PairGeometry<f64>, settings: &SegmentationSettings) -> Self {
        let mut out = Self::default();
        let plane = Plane::new(pair);
        let is_apart = plane.is_beyond(pair.nodes_of_master(), settings.distance_threshold);
        let flat = pair.slave.map(|x| plane.coordinates(x));
        let outline = outline(pair, &plane);
        let rule = settings.rule_of_second_order();
        for sub_facet in pair.slave_shape.sub_facets {
            let first = out.cells.len();
            if !is_apart {
                for part in convex_parts(pair.slave_shape, sub_facet, &flat) {
                    let corners = part.corners_in_plane(pair.slave_shape, &flat);
                    let smallest = LEAST_CELL * area(&corners).abs();
                    let overlap =
                        ClosedLine::overlap(&corners, &outline, tolerance(&corners, settings.zero_tolerance_factor));
                    let own = out.parts.len();
                    let mut vertices = overlap.vertices_from(corners[0]);
                    if let (Some(first), Some(mut second)) = (vertices.next(), vertices.next()) {
                        for third in vertices {
                            let cell = [first, second, third];
                            let places = cell.map(|vertex| place(vertex, &corners, &outline));
                            second = third;
                            if area_of_cell(&places).abs() > smallest {
                                out.add_cell(pair, &flat, (own, &part, &corners), (cell, &places), rule);
                            }
                        }
                    }
                    out.parts.push(part);
                }
            }
            out.sub_facets.push(first..out.cells.len());
        }
        out
    }

    /// Points of a sub-facet of the slave.
    pub(super) fn of_sub_facet(&self, sub_facet: usize) -> impl Iterator<Item = &SurfacePoint> {
        self.cells(sub_facet).iter().flat_map(|cell| self.points(cell))
    }

    /// Cells of a sub-facet of the slave.
    pub(super) fn cells(&self, sub_facet: usize) -> &[Cell] {
        &self.cells[self.sub_facets[sub_facet].clone()]
    }

    /// Points of a cell.
    pub(super) fn points(&self, cell: &Cell) -> &[SurfacePoint] {
        &self.points[cell.points.clone()]
    }

    /// Corners of a cell in the plane, where the nodes of the slave and the outline of the master are there.
    pub(super) fn corners_of<T: Real>(
        &self,
        cell: &Cell,
        slave: &FacetShape,
        flat: &[[T; 2]],
        outline: &[[T; 2]],
    ) -> [[T; 2]; 3] {
        let corners = self.parts[cell.part].corners_in_plane(slave, flat);
        cell.vertices.map(|vertex| place(vertex, &corners, outline))
    }

    fn add_cell(
        &mut self,
        pair: &PairGeometry<f64>,
        flat: &[[f64; 2]],
        (part, own, part_corners): (usize, &SlavePart, &[[f64; 2]]),
        (vertices, corners): ([Vertex; 3], &[[f64; 2]; 3]),
        rule: usize,
    ) {
        let first = self.points.len();
        let area = area_of_cell(corners);
        let rule = ShapeTable::get(TRIANGLE_3.shape, rule);
        for (barycentric, point) in rule.n::<3>().iter().zip(rule.points()) {
            let place = combine(barycentric, corners);
            let (slave, inverse) = point_of_slave(pair.slave_shape, flat, place, own.near(place, part_corners));
            let [t, s] = slave.derivatives(&pair.slave);
            let normal = cross(t, s);
            let stretch = norm(normal) / dot(normal, pair.slave_normal).abs();
            let share = point.weight / TRIANGLE_3.cell_size;
            let weight = area * (share * stretch);
            let x = combine(&slave.values, &pair.slave);
            let direction = combine(&slave.values, &pair.nodal_normals);
            let shape = pair.master_shape;
            let guess = self.points.last().and_then(|last| last.master_near(pair, slave.local));
            let crossing = |guess: [f64; 2]| shape.crossing(&pair.master, x, direction, guess);
            let exact = pair.exact.and_then(|exact| Some((exact, exact.crossing(shape, &pair.master, x, direction)?)));
            let flat = || guess.and_then(crossing).or_else(|| crossing(shape.centre));
            let way = exact.map(|(_, way)| way).or_else(flat);
            let local = way.map_or_else(|| shape.closest_point(&pair.master, x, shape.centre), |way| way.local);
            let master = exact
                .map_or_else(|| FacetPoint::new(shape, local), |(exact, _)| FacetPoint::exact(&exact, shape, local));
            self.covered += weight;
            let barycentric = *barycentric;
            self.points.push(SurfacePoint { barycentric, share, weight, slave, inverse, stretch, master, way });
        }
        self.cells.push(Cell { part, vertices, points: first..self.points.len() });
    }
}

/// The outline of the master in the plane of the slave.
pub(super) fn outline<T: Real>(pair: &PairGeometry<T>, plane: &Plane<T>) -> Nodal<[T; 2]> {
    rim(pair.master_shape).map(|n| plane.coordinates(pair.master[n]))
}

impl SlavePart {
    /// Local coordinates near a place in the plane: those there if the facet is flat and its edges are straight.
    fn near(&self, place: [f64; 2], corners: &[[f64; 2]]) -> [f64; 2] {
        let sides = |of: &[[f64; 2]]| [minus(of[1], of[0]), minus(of[2], of[0])];
        let from = minus(place, corners[0]);
        let shares = inverse_of(sides(corners)).map(|row| row[0] * from[0] + row[1] * from[1]);
        let [a, b] = sides(&self.corners);
        std::array::from_fn(|c| self.corners[0][c] + shares[0] * a[c] + shares[1] * b[c])
    }

    fn corners_in_plane<T: Real>(&self, shape: &FacetShape, flat: &[[T; 2]]) -> Nodal<[T; 2]> {
        self.corners.map(|local| {
            let mut at = [T::zero(); 2];
            for (weight, own) in shape.values(local).iter().zip(flat) {
                // All but one are zero at a node.
                if *weight != 0.0 {
                    (0..2).for_each(|c| at[c].add_scaled(own[c], *weight));
                }
            }
            at
        })
    }
}

/// The convex parts of a sub-facet: itself, or the triangles around its centre.
fn convex_parts(shape: &FacetShape, sub_facet: &[usize], flat: &[[f64; 2]]) -> impl Iterator<Item = SlavePart> + use<> {
    let count = sub_facet.len();
    let own = Nodal::new(count, |n| shape.corner(sub_facet[n]));
    let at = Nodal::new(count, |n| flat[sub_facet[n]]);
    let turn = |n: usize| cross2(minus(at[(n + 1) % count], at[n]), minus(at[(n + 2) % count], at[(n + 1) % count]));
    let is_convex = (0..count).all(|n| turn(n) > 0.0) || (0..count).all(|n| turn(n) < 0.0);
    let centre = combine(&own.map(|_| 1.0 / count as f64), &own);
    let parts = if count == 3 || is_convex { 1 } else { count };
    (0..parts).map(move |n| SlavePart {
        corners: if parts == 1 { own } else { [own[n], own[(n + 1) % count], centre].into() },
    })
}

/// The point of the slave that lies at `place` in the plane, and ∂ξ/∂x there.
fn point_of_slave(
    shape: &FacetShape,
    flat: &[[f64; 2]],
    place: [f64; 2],
    start: [f64; 2],
) -> (FacetPoint, [[f64; 2]; 2]) {
    let mut found = FacetPoint::new(shape, start);
    let mut inverse = [[0.0; 2]; 2];
    for _ in 0..MAX_STEPS {
        let apart = minus(place, combine(&found.values, flat));
        inverse = inverse_of(found.derivatives(flat));
        let moved = inverse.map(|row| row[0] * apart[0] + row[1] * apart[1]);
        found = FacetPoint::new(shape, [0, 1].map(|a| found.local[a] + moved[a]));
        if moved[0].abs().max(moved[1].abs()) < SETTLED {
            break;
        }
    }
    (found, inverse)
}

/// The inverse of the matrix with these columns.
fn inverse_of([a, b]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let whole = 1.0 / cross2(a, b);
    [[b[1] * whole, -b[0] * whole], [-a[1] * whole, a[0] * whole]]
}
