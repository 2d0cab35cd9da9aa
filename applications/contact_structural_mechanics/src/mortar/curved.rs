//! Pairs in which a facet is of second order: both are cut along their linear pieces, and points are those of the true surfaces.
//!
//! Each piece of the slave meets each piece of the master as facets of first order do, which gives cells with straight edges:
//! in space in the plane of the slave's normal and by triangles, in the plane on the chord of the slave's piece. From there points go back to
//! the slave along that normal, `x = Σ N¹ x_k` with the weight of the true surface, and on along the interpolated nodal normal to
//! the true master.
//!
//! Multipliers live on the pieces, too (Popp, Wohlmuth, Gee and Wall 2012, "pwlin"): the dual functions of each piece are those
//! of its linear functions L, Φ = De Me⁻¹ L with Me = ∫ L⊗L and De = ∫ diag L over the overlap of the piece with the master. The areas
//! of all nodes are positive, whatever the overlap covers, which those of quadratic functions are not. With the quadratic N¹
//! of the facet D = ∫ Φ⊗N¹ is not diagonal: entries beside the diagonal are a few times smaller.

use super::choices::Choices;
use super::geometry::{Active, LANES, PairGeometry};
use super::operators::{Operators, inverse};
use super::points::Point;
use super::segmentation_2d;
use super::segmentation_3d::Polygon;
use super::settings::SegmentationSettings;
use zelus_core::geometry::{FacetShape, LINE_2, Nodal, ShapeTable, TRIANGLE_3, combine, interpolate};
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::{cross, dot, norm, normalised, value};

/// Gauss rule of cells: exact for functions of the fourth degree, as those of quadrilaterals with nine nodes are.
const RULE: usize = 4;
/// Nodes of the largest sub-facet.
const PIECE: usize = 4;
/// Share of a triangle's area below which a cell is skipped.
const LEAST_CELL: f64 = 1e-13;
/// Triangles that the largest facet is cut into.
const MOST_TRIANGLES: usize = 16;
/// Share of its size by which a triangle may be beside another that it is cut with all the same.
const NEAR: f64 = 1e-6;

/// A visitor of points, each with the number of the slave's sub-facet that it lies on.
type Visitor<'v, T> = &'v mut dyn FnMut(usize, &Point<T>);

/// Visits the points of the overlap; gives its length or area, without the factor of a revolution.
pub(super) fn for_each_point<T: Real>(
    pair: &PairGeometry<T>,
    settings: &SegmentationSettings,
    visit: Visitor<'_, T>,
) -> f64 {
    let (curved, mut covered) = (Curved { pair, settings }, 0.0);
    for piece in 0..pair.slave_shape.pieces.len() {
        curved.of_piece(piece, &mut covered, &mut |point| visit(piece, point));
    }
    covered
}

/// A pair that is walked.
struct Curved<'a, T: Real> {
    pair: &'a PairGeometry<T>,
    settings: &'a SegmentationSettings,
}

/// The triangles that a sub-facet is cut by: local coordinates of their corners.
///
/// Of a sub-facet with four nodes they are those around its centre, so that nothing depends on where its nodes begin.
fn triangles(shape: &'static FacetShape, piece: &'static [usize]) -> impl Iterator<Item = [[f64; 2]; 3]> {
    let corner = move |n: usize| shape.corner(piece[n % piece.len()]);
    let centre: [f64; 2] = std::array::from_fn(|c| piece.iter().map(|&n| 0.25 * shape.corner(n)[c]).sum());
    let count = if piece.len() == 3 { 1 } else { 4 };
    (0..count).map(move |n| [corner(n), corner(n + 1), if count == 1 { corner(2) } else { centre }])
}

/// A triangle of a facet and the box around it in a plane.
#[derive(Clone, Copy, Default)]
struct Triangle {
    local: [[f64; 2]; 3],
    low: [f64; 2],
    high: [f64; 2],
}

impl Triangle {
    /// The one with these local coordinates on a facet, seen along two axes.
    fn new(shape: &FacetShape, nodes: &[[f64; 3]], local: [[f64; 2]; 3], axes: &[[f64; 3]; 2]) -> Self {
        let corners = local.map(|xi| combine(&shape.values(xi), nodes));
        let bound = |start: f64, of: fn(f64, f64) -> f64| {
            axes.map(|axis| corners.iter().map(|x| dot(*x, axis)).fold(start, of))
        };
        Self { local, low: bound(f64::INFINITY, f64::min), high: bound(f64::NEG_INFINITY, f64::max) }
    }

    /// Whether the boxes meet, or nearly.
    fn may_meet(&self, other: &Self) -> bool {
        (0..2).all(|c| {
            let slack = NEAR * (self.high[c] - self.low[c]);
            self.low[c] <= other.high[c] + slack && other.low[c] <= self.high[c] + slack
        })
    }
}

/// Two unit vectors across a normal.
fn axes_across(normal: [f64; 3]) -> [[f64; 3]; 2] {
    let smallest = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0);
    let first = normalised(cross(normal, std::array::from_fn(|c| f64::from(u8::from(c == smallest)))));
    [first, cross(normalised(normal), first)]
}

impl<T: Real> Curved<'_, T> {
    /// Points of a sub-facet of the slave; adds their length or area.
    fn of_piece(&self, piece: usize, covered: &mut f64, visit: &mut dyn FnMut(&Point<T>)) {
        if self.pair.space() == 2 {
            self.along_line(piece, covered, visit);
        } else {
            self.over_surface(piece, covered, visit);
        }
    }

    /// Points of a chord of the slave before those of the master.
    fn along_line(&self, piece: usize, covered: &mut f64, visit: &mut dyn FnMut(&Point<T>)) {
        let pair = self.pair;
        let own = pair.slave_shape.pieces[piece];
        for other in pair.master_shape.pieces {
            let slave = LINE_2.nodal(|n| pair.slave[own[n]]);
            let master = LINE_2.nodal(|n| pair.master[other[n]]);
            let chords = PairGeometry {
                slave_shape: &LINE_2,
                master_shape: &LINE_2,
                slave,
                master,
                nodal_normals: LINE_2.nodal(|n| pair.nodal_normals[own[n]]),
                slave_normal: LINE_2.unit_normal(&slave, LINE_2.centre),
                master_normal: LINE_2.unit_normal(&master, LINE_2.centre),
                choices: Choices::default(),
            };
            if let Some(ends) = segmentation_2d::interval(&chords, self.settings) {
                let [a, b] = [0, 1].map(|n| pair.slave_shape.corner(own[n])[0]);
                let ends = ends.map(|xi| (xi + 1.0) * (0.5 * (b - a)) + a);
                *covered += self.of_interval(ends, visit);
            }
        }
    }

    /// Points between two local coordinates of the slave; gives the length.
    fn of_interval(&self, ends: [T; 2], visit: &mut dyn FnMut(&Point<T>)) -> f64 {
        let share = (ends[1] - ends[0]) * (1.0 / LINE_2.cell_size);
        let mut covered = 0.0;
        let rule = ShapeTable::get(LINE_2.shape, self.settings.integration_order.get().max(RULE));
        for (weights, point) in rule.n::<2>().iter().zip(rule.points()) {
            let local = [ends[0] * weights[0] + ends[1] * weights[1], T::zero()];
            let normal = self.pair.slave_shape.area_normal_at(&self.pair.slave, local);
            let length = norm(normal) * share * point.weight;
            covered += length.value();
            self.visit(local, length, visit);
        }
        covered
    }

    /// Points of a sub-facet of the slave before those of the master.
    ///
    /// Pieces that cannot overlap are found on values, before anything is computed with derivatives.
    fn over_surface(&self, piece: usize, covered: &mut f64, visit: &mut dyn FnMut(&Point<T>)) {
        let pair = self.pair;
        let (slave_shape, master_shape) = (pair.slave_shape, pair.master_shape);
        let (slave, master) = (pair.slave.map(value), pair.master.map(value));
        let axes = axes_across(value(pair.slave_normal));
        let others = master_shape.pieces.iter().flat_map(|piece| triangles(master_shape, piece));
        let mut masters = [Triangle::default(); MOST_TRIANGLES];
        let count =
            masters.iter_mut().zip(others).map(|(t, xi)| *t = Triangle::new(master_shape, &master, xi, &axes)).count();
        for own in triangles(slave_shape, slave_shape.pieces[piece]) {
            let triangle = Triangle::new(slave_shape, &slave, own, &axes);
            let corners = Nodal::from(own.map(|xi| combine(&slave_shape.values(xi), &pair.slave)));
            let centre = combine(&[1.0 / 3.0; 3], &own);
            let whole = TRIANGLE_3.measure(&corners.map(value));
            for other in masters[..count].iter().filter(|other| triangle.may_meet(other)) {
                let at = |n: usize| combine(&master_shape.values(other.local[n]), &pair.master);
                let linear = PairGeometry {
                    slave_shape: &TRIANGLE_3,
                    master_shape: &TRIANGLE_3,
                    slave: corners,
                    master: TRIANGLE_3.nodal(at),
                    nodal_normals: TRIANGLE_3.nodal(|_| pair.slave_normal),
                    slave_normal: pair.slave_normal,
                    master_normal: pair.master_normal,
                    choices: Choices { origin: Some(TRIANGLE_3.corner(0)), ..Choices::default() },
                };
                if let Some(polygon) = Polygon::new(&linear, self.settings) {
                    *covered += self.of_polygon(&polygon, centre, whole, visit);
                }
            }
        }
    }

    /// Points of a polygon, whose local coordinates on the slave are near `centre`; gives the area. `whole` is that of the
    /// triangle that has been cut.
    fn of_polygon(&self, polygon: &Polygon<T>, centre: [f64; 2], whole: f64, visit: &mut dyn FnMut(&Point<T>)) -> f64 {
        let (shape, slave) = (self.pair.slave_shape, &self.pair.slave);
        let flat = slave.map(|x| polygon.flattened(x));
        let vertices = polygon.vertices();
        let rule = ShapeTable::get(TRIANGLE_3.shape, self.settings.integration_order.get().max(RULE));
        let mut covered = 0.0;
        for ends in vertices[1..].windows(2) {
            let [a, b, c] = [vertices[0], ends[0], ends[1]].map(|vertex| polygon.place(vertex));
            let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) * 0.5;
            if area.value() <= LEAST_CELL * whole {
                continue;
            }
            let area = area * (1.0 / TRIANGLE_3.cell_size);
            for (barycentric, point) in rule.n::<3>().iter().zip(rule.points()) {
                let place = combine(barycentric, &[a, b, c]);
                let local = shape.closest_point(&flat, [place[0], place[1], T::zero()], centre);
                let normal = normalised(shape.area_normal_at(slave, local));
                let own = area * point.weight / dot(normal, self.pair.slave_normal).abs();
                covered += own.value();
                self.visit(local, own, visit);
            }
        }
        covered
    }

    /// The point at local coordinates of the slave that stands for `measure`.
    fn visit(&self, local: [T; 2], measure: T, visit: &mut dyn FnMut(&Point<T>)) {
        let (pair, master) = (self.pair, self.pair.master_shape);
        let slave = pair.slave_shape.values(local);
        let x = interpolate(&slave, &pair.slave);
        let weight = self.settings.revolution().map_or(measure, |per_radius| measure * x[0] * per_radius);
        let direction = interpolate(&slave, &pair.nodal_normals);
        let master = on_master(master, &pair.master, x, direction);
        visit(&Point { local, slave, master, weight });
    }
}

/// Shape functions of a master where a point `x` of the slave goes along a direction.
fn on_master<T: Real>(shape: &FacetShape, nodes: &[[T; 3]], x: [T; 3], direction: [T; 3]) -> Nodal<T> {
    let along = shape.point_along(nodes, x, direction, shape.centre);
    shape.values(along.unwrap_or_else(|| shape.closest_point(nodes, x, shape.centre)))
}

/// Integrals over the overlap of a sub-facet of the slave: Me, ∫ L⊗N¹ and ∫ L⊗N².
struct Sums<T: Real> {
    nodes: &'static [usize],
    me: [[T; PIECE]; PIECE],
    slave: [Nodal<T>; PIECE],
    master: [Nodal<T>; PIECE],
}

impl<T: Real> Sums<T> {
    fn zero(slave: &FacetShape, master: &FacetShape, piece: usize) -> Self {
        let zero = T::zero();
        Self {
            nodes: slave.pieces[piece],
            me: [[zero; PIECE]; PIECE],
            slave: [slave.nodal(|_| zero); PIECE],
            master: [master.nodal(|_| zero); PIECE],
        }
    }

    /// Integrals over a sub-facet of the slave, whose length or area is added to `covered`.
    fn of(pair: &PairGeometry<T>, settings: &SegmentationSettings, piece: usize, covered: &mut f64) -> Self {
        let mut sums = Self::zero(pair.slave_shape, pair.master_shape, piece);
        let count = sums.nodes.len();
        Curved { pair, settings }.of_piece(piece, covered, &mut |point| {
            let linear = linear_functions(pair.slave_shape, sums.nodes, point.local);
            for i in 0..count {
                let weighted = linear[i] * point.weight;
                (0..count).for_each(|j| sums.me[i][j].add_product(weighted, linear[j]));
                let own = sums.slave[i].iter_mut().zip(point.slave.iter());
                // Of a slave of first order these are Me.
                if pair.slave_shape.curved {
                    own.for_each(|(sum, shape)| sum.add_product(weighted, *shape));
                }
                let others = sums.master[i].iter_mut().zip(point.master.iter());
                others.for_each(|(sum, shape)| sum.add_product(weighted, *shape));
            }
        });
        sums
    }
}

impl Sums<Active> {
    /// As [`Sums::of`] in space, with derivatives by components of the nodal normals, [`LANES`] of them from the one numbered `first` on.
    ///
    /// Normals of nodes say where points meet the master and nothing else, each point by the one interpolated there.
    fn by_normals(
        pair: &PairGeometry<f64>,
        settings: &SegmentationSettings,
        [piece, first]: [usize; 2],
        covered: &mut f64,
    ) -> Self {
        let mut sums = Self::zero(pair.slave_shape, pair.master_shape, piece);
        let count = sums.nodes.len();
        let still = pair.master.map(|x| x.map(Dual::<3>::constant));
        Curved { pair, settings }.of_piece(piece, covered, &mut |point| {
            let normal = interpolate(&point.slave, &pair.nodal_normals);
            let normal = std::array::from_fn(|c| Dual::variable(normal[c], c));
            let x = interpolate(&point.slave, &pair.slave).map(Dual::constant);
            let master = on_master(pair.master_shape, &still, x, normal);
            let moved = master.map(|shape| by_nodal_normals(shape, &point.slave, first));
            let linear = linear_functions(pair.slave_shape, sums.nodes, point.local);
            for i in 0..count {
                let weighted = linear[i] * point.weight;
                (0..count).for_each(|j| sums.me[i][j].value += weighted * linear[j]);
                let own = sums.slave[i].iter_mut().zip(point.slave.iter());
                own.for_each(|(sum, shape)| sum.value += weighted * shape);
                let others = sums.master[i].iter_mut().zip(moved.iter());
                others.for_each(|(sum, shape)| sum.add_scaled(*shape, weighted));
            }
        });
        sums
    }
}

/// A number with derivatives by the normal interpolated at a point of the slave, as one with those by the normals of nodes: [`LANES`]
/// components from the one numbered `first` on, node by node.
pub(super) fn by_nodal_normals(number: Dual<3>, slave: &Nodal<f64>, first: usize) -> Active {
    let mut out = Active::constant(number.value);
    for lane in 0..LANES.min((3 * slave.len()).saturating_sub(first)) {
        let (node, c) = ((first + lane) / 3, (first + lane) % 3);
        out.gradient[lane] = slave[node] * number.gradient[c];
    }
    out
}

/// L at local coordinates of the facet. Sub-facets are parallelograms and triangles there.
fn linear_functions<T: Real>(shape: &FacetShape, piece: &[usize], xi: [T; 2]) -> [T; PIECE] {
    let corner = |n: usize| shape.corner(piece[n]);
    let apart = |a: [f64; 2], b: [f64; 2]| [b[0] - a[0], b[1] - a[1]];
    let (first, from) = (apart(corner(0), corner(1)), corner(0).map(T::constant));
    let way = [xi[0] - from[0], xi[1] - from[1]];
    let mut out = [T::zero(); PIECE];
    if piece.len() == 2 {
        out[1] = way[0] / first[0];
        out[0] = T::one() - out[1];
        return out;
    }
    let last = apart(corner(0), corner(piece.len() - 1));
    let whole = 1.0 / (first[0] * last[1] - first[1] * last[0]);
    let a = (way[0] * last[1] - way[1] * last[0]) * whole;
    let b = (way[1] * first[0] - way[0] * first[1]) * whole;
    if piece.len() == 3 {
        [T::one() - a - b, a, b, T::zero()]
    } else {
        let rest = [T::one() - a, T::one() - b];
        [rest[0] * rest[1], a * rest[1], a * b, rest[0] * b]
    }
}

/// L of all nodes of a slave at one of its points: the share of the point that each node has. Of a slave of first order its
/// shape functions.
pub fn nodal_shares<T: Real>(shape: &FacetShape, point: &Point<T>) -> Nodal<T> {
    if !shape.curved {
        return point.slave;
    }
    // The sub-facet that the point is in, or least outside.
    let least = |functions: &[T]| functions.iter().map(|f| f.value()).fold(f64::INFINITY, f64::min);
    let of_piece = |piece: &'static [usize]| (piece, linear_functions(shape, piece, point.local));
    let pieces = shape.pieces.iter().map(|piece| of_piece(piece));
    let found = pieces.max_by(|(a, of_a), (b, of_b)| least(&of_a[..a.len()]).total_cmp(&least(&of_b[..b.len()])));
    let mut out = shape.nodal(|_| T::zero());
    let (piece, functions) = found.expect("a facet has sub-facets");
    piece.iter().zip(functions).for_each(|(&node, own)| out[node] = own);
    out
}

/// Adds D and M of a pair to `out`; gives the length or area that is covered.
pub(super) fn find_operators<T: Real>(
    pair: &PairGeometry<T>,
    settings: &SegmentationSettings,
    out: &mut Operators<T>,
) -> f64 {
    let mut covered = 0.0;
    for at in 0..pair.slave_shape.pieces.len() {
        let sums = Sums::of(pair, settings, at, &mut covered);
        sums.add_to(pair.slave_shape, pair.choices.plain & (1 << at) != 0, out);
    }
    covered
}

/// As [`find_operators`] in space, with derivatives by components of the nodal normals, [`LANES`] of them from the one numbered
/// `first` on.
pub(super) fn find_operators_by_normals(
    pair: &PairGeometry<f64>,
    settings: &SegmentationSettings,
    first: usize,
    out: &mut Operators<Active>,
) -> f64 {
    let mut covered = 0.0;
    for at in 0..pair.slave_shape.pieces.len() {
        let sums = Sums::by_normals(pair, settings, [at, first], &mut covered);
        sums.add_to(pair.slave_shape, pair.choices.plain & (1 << at) != 0, out);
    }
    covered
}

/// The sub-facets of the slave, as bits, on which standard functions stand in for dual ones.
pub(super) fn standard_pieces(pair: &PairGeometry<f64>, settings: &SegmentationSettings) -> u8 {
    let standard = |at: usize| {
        let sums = Sums::of(pair, settings, at, &mut 0.0);
        let covered = sums.me[0][0] > 0.0;
        u8::from(covered && sums.inverse().is_none()) << at
    };
    (0..pair.slave_shape.pieces.len()).map(standard).fold(pair.choices.plain, |all, own| all | own)
}

impl<T: Real> Sums<T> {
    /// Me⁻¹.
    fn inverse(&self) -> Option<[[f64; PIECE]; PIECE]> {
        // The diagonal of nodes that the sub-facet has not keeps the matrix regular and its condition as it is.
        let (count, filler) = (self.nodes.len(), self.me[0][0].value());
        let me = Nodal::new(PIECE, |i| {
            Nodal::new(PIECE, |j| {
                let missing = i >= count || j >= count;
                if missing { if i == j { filler } else { 0.0 } } else { self.me[i][j].value() }
            })
        });
        let inverse = inverse(&me)?;
        Some(std::array::from_fn(|i| std::array::from_fn(|j| inverse[i][j])))
    }

    /// Adds to D and M, with standard functions where that is chosen or there are no dual ones.
    fn add_to(&self, slave: &FacetShape, standard: bool, out: &mut Operators<T>) {
        match Some(self).filter(|_| !standard).and_then(Sums::inverse) {
            Some(inverse) => self.add_dual(slave, &inverse, out),
            None => self.add_standard(slave, out),
        }
    }

    fn add_standard(&self, slave: &FacetShape, out: &mut Operators<T>) {
        for (i, &node) in self.nodes.iter().enumerate() {
            for k in 0..slave.nodes {
                // A slave of first order is its only sub-facet.
                out.d[node][k] += if slave.curved { self.slave[i][k] } else { self.me[i][k] };
            }
            out.m[node].iter_mut().zip(self.master[i].iter()).for_each(|(sum, own)| *sum += *own);
        }
    }

    fn add_dual(&self, slave: &FacetShape, inverse: &[[f64; PIECE]; PIECE], out: &mut Operators<T>) {
        let count = self.nodes.len();
        let de: [T; PIECE] = std::array::from_fn(|i| (0..count).fold(T::zero(), |sum, j| sum + self.me[i][j]));
        if !slave.curved {
            self.nodes.iter().enumerate().for_each(|(i, &node)| out.d[node][node] += de[i]);
        }
        // De Me⁻¹ ∫ L N: on values, then one correction, which brings the derivative.
        let times_dual = |of: &dyn Fn(usize) -> T| -> [T; PIECE] {
            let values: [f64; PIECE] = std::array::from_fn(|i| (0..count).map(|j| inverse[i][j] * of(j).value()).sum());
            let residual: [T; PIECE] = std::array::from_fn(|i| {
                let mut rest = if i < count { of(i) } else { T::zero() };
                (0..count).for_each(|j| rest.add_scaled(self.me[i][j], -values[j]));
                rest
            });
            std::array::from_fn(|i| {
                let mut x = T::constant(values[i]);
                (0..count).for_each(|j| x.add_scaled(residual[j], inverse[i][j]));
                de[i] * x
            })
        };
        for k in 0..if slave.curved { slave.nodes } else { 0 } {
            let found = times_dual(&|i| self.slave[i][k]);
            self.nodes.iter().zip(found).for_each(|(&node, own)| out.d[node][k] += own);
        }
        for l in 0..self.master[0].len() {
            let found = times_dual(&|i| self.master[i][l]);
            self.nodes.iter().zip(found).for_each(|(&node, own)| out.m[node][l] += own);
        }
    }
}
