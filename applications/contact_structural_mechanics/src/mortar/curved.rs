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
use super::geometry::PairGeometry;
use super::operators::{Operators, inverse};
use super::points::Point;
use super::segmentation_2d;
use super::segmentation_3d::Polygon;
use super::settings::SegmentationSettings;
use zelus_core::geometry::{FacetShape, Line2, Quadrilateral4, ShapeTable, Triangle3};
use zelus_core::scalar::Real;
use zelus_core::vector3::{dot, norm, normalised, value};

/// Gauss rule of cells: exact for functions of the fourth degree, as those of quadrilaterals with nine nodes are.
const RULE: usize = 4;
/// Nodes of the largest piece.
const PIECE: usize = 4;
/// Share of a triangle's area below which a cell is skipped.
const LEAST_CELL: f64 = 1e-13;

/// A visitor of points, each with the number of the slave's piece that it lies on.
type Visitor<'v, T, S, M> = &'v mut dyn FnMut(usize, &Point<T, S, M>);

/// Visits the points of the overlap; gives its length or area, without the turn about an axis.
pub(super) fn for_each_point<T: Real, S: FacetShape, M: FacetShape>(
    pair: &PairGeometry<T, S, M>,
    settings: &SegmentationSettings,
    visit: Visitor<'_, T, S, M>,
) -> f64 {
    Curved::<T, S, M>::WALK(&Curved { pair, settings }, visit)
}

/// A pair that is walked.
struct Curved<'a, T: Real, S: FacetShape, M: FacetShape> {
    pair: &'a PairGeometry<T, S, M>,
    settings: &'a SegmentationSettings,
}

/// The triangles that a surface is cut by, with the number of their piece: local coordinates of their corners.
///
/// Of a piece with four nodes they are those around its centre, so that nothing depends on where its nodes begin.
fn triangles<F: FacetShape>() -> impl Iterator<Item = (usize, [[f64; 2]; 3])> {
    F::PIECES.iter().enumerate().flat_map(|(at, piece)| {
        let corner = move |n: usize| F::corner(piece[n % piece.len()]);
        let centre: [f64; 2] = std::array::from_fn(|c| piece.iter().map(|&n| 0.25 * F::corner(n)[c]).sum());
        let count = if piece.len() == 3 { 1 } else { 4 };
        let third = move || if count == 1 { corner(2) } else { centre };
        (0..count).map(move |n| (at, [corner(n), corner(n + 1), third()]))
    })
}

/// The point of a facet at plain local coordinates.
fn at<T: Real, F: FacetShape>(nodes: &F::Nodal<[T; 3]>, xi: [f64; 2]) -> [T; 3] {
    F::combine(&F::values(xi), nodes)
}

impl<T: Real, S: FacetShape, M: FacetShape> Curved<'_, T, S, M> {
    /// A constant, so that only what the space needs is compiled.
    const WALK: fn(&Self, Visitor<'_, T, S, M>) -> f64 =
        if S::SPACE == 2 { Self::along_lines } else { Self::over_surfaces };

    /// Points of two lines.
    fn along_lines(&self, visit: Visitor<'_, T, S, M>) -> f64 {
        let pair = self.pair;
        let mut covered = 0.0;
        for (piece, own) in S::PIECES.iter().enumerate() {
            for other in M::PIECES {
                let slave = Line2::nodal(|n| pair.slave[own[n]]);
                let master = Line2::nodal(|n| pair.master[other[n]]);
                let chords = PairGeometry::<T, Line2, Line2> {
                    slave,
                    master,
                    nodal_normals: Line2::nodal(|n| pair.nodal_normals[own[n]]),
                    slave_normal: Line2::unit_normal(&slave, Line2::CENTRE),
                    master_normal: Line2::unit_normal(&master, Line2::CENTRE),
                    choices: Choices::default(),
                };
                if let Some(ends) = segmentation_2d::interval(&chords, self.settings) {
                    let [a, b] = [0, 1].map(|n| S::corner(own[n])[0]);
                    let ends = ends.map(|xi| (xi + 1.0) * (0.5 * (b - a)) + a);
                    covered += self.of_interval(ends, &mut |point| visit(piece, point));
                }
            }
        }
        covered
    }

    /// Points between two local coordinates of the slave; gives the length.
    fn of_interval(&self, ends: [T; 2], visit: &mut dyn FnMut(&Point<T, S, M>)) -> f64 {
        let share = (ends[1] - ends[0]) * (1.0 / Line2::SHAPE.cell().size());
        let mut covered = 0.0;
        let rule = ShapeTable::get(Line2::SHAPE, self.settings.integration_order.get().max(RULE));
        for (weights, point) in rule.n::<{ Line2::NODES }>().iter().zip(rule.points()) {
            let local = [ends[0] * weights[0] + ends[1] * weights[1], T::zero()];
            let length = norm(S::area_normal_at(&self.pair.slave, local)) * share * point.weight;
            covered += length.value();
            self.visit(local, length, visit);
        }
        covered
    }

    /// Points of two surfaces.
    fn over_surfaces(&self, visit: Visitor<'_, T, S, M>) -> f64 {
        let pair = self.pair;
        let mut covered = 0.0;
        for (piece, own) in triangles::<S>() {
            for (_, other) in triangles::<M>() {
                let linear = PairGeometry::<T, Triangle3, Triangle3> {
                    slave: own.map(|xi| at::<T, S>(&pair.slave, xi)),
                    master: other.map(|xi| at::<T, M>(&pair.master, xi)),
                    nodal_normals: [pair.slave_normal; 3],
                    slave_normal: pair.slave_normal,
                    master_normal: pair.master_normal,
                    choices: Choices { origin: Some(Triangle3::corner(0)), ..Choices::default() },
                };
                if let Some(polygon) = Polygon::new(&linear, self.settings) {
                    let centre = Triangle3::combine(&[1.0 / 3.0; 3], &own);
                    let whole = Triangle3::measure(&linear.slave.map(value));
                    covered += self.of_polygon(&polygon, centre, whole, &mut |point| visit(piece, point));
                }
            }
        }
        covered
    }

    /// Points of a polygon, whose local coordinates on the slave are near `centre`; gives the area. `whole` is that of what
    /// has been cut.
    fn of_polygon(
        &self,
        polygon: &Polygon<T, Triangle3, Triangle3>,
        centre: [f64; 2],
        whole: f64,
        visit: &mut dyn FnMut(&Point<T, S, M>),
    ) -> f64 {
        let slave = &self.pair.slave;
        let flat = S::map(slave, |x| polygon.flattened(x));
        let vertices = polygon.vertices();
        let rule = ShapeTable::get(Triangle3::SHAPE, self.settings.integration_order.get().max(RULE));
        let mut covered = 0.0;
        for ends in vertices[1..].windows(2) {
            let [a, b, c] = [vertices[0], ends[0], ends[1]].map(|vertex| polygon.place(vertex));
            let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) * 0.5;
            if area.value() <= LEAST_CELL * whole {
                continue;
            }
            let area = area * (1.0 / Triangle3::SHAPE.cell().size());
            for (barycentric, point) in rule.n::<{ Triangle3::NODES }>().iter().zip(rule.points()) {
                let place = Triangle3::combine(barycentric, &[a, b, c]);
                let local = S::closest_point(&flat, [place[0], place[1], T::zero()], centre);
                let normal = normalised(S::area_normal_at(slave, local));
                let own = area * point.weight / dot(normal, self.pair.slave_normal).abs();
                covered += own.value();
                self.visit(local, own, visit);
            }
        }
        covered
    }

    /// The point at local coordinates of the slave that stands for `measure`.
    fn visit(&self, local: [T; 2], measure: T, visit: &mut dyn FnMut(&Point<T, S, M>)) {
        let pair = self.pair;
        let slave = S::values(local);
        let x = S::interpolate(&slave, &pair.slave);
        let weight = self.settings.revolution().map_or(measure, |per_radius| measure * x[0] * per_radius);
        let direction = S::interpolate(&slave, &pair.nodal_normals);
        let along = M::point_along(&pair.master, x, direction, M::CENTRE);
        let master = M::values(along.unwrap_or_else(|| M::closest_point(&pair.master, x, M::CENTRE)));
        visit(&Point { local, slave, master, weight });
    }
}

/// Integrals over the overlap of a piece of the slave: Me, ∫ L⊗N¹ and ∫ L⊗N².
struct Sums<T: Real, S: FacetShape, M: FacetShape> {
    me: [[T; PIECE]; PIECE],
    slave: [S::Nodal<T>; PIECE],
    master: [M::Nodal<T>; PIECE],
}

/// Integrals over the pieces of the slave, and the length or area covered.
fn sums<T: Real, S: FacetShape, M: FacetShape>(
    pair: &PairGeometry<T, S, M>,
    settings: &SegmentationSettings,
) -> (Vec<Sums<T, S, M>>, f64) {
    let zero = T::zero();
    let none =
        || Sums { me: [[zero; PIECE]; PIECE], slave: [S::nodal(|_| zero); PIECE], master: [M::nodal(|_| zero); PIECE] };
    let mut sums: Vec<Sums<T, S, M>> = S::PIECES.iter().map(|_| none()).collect();
    let covered = for_each_point(pair, settings, &mut |piece, point| {
        let (count, sums) = (S::PIECES[piece].len(), &mut sums[piece]);
        let linear = linear_functions::<T, S>(S::PIECES[piece], point.local);
        for i in 0..count {
            let weighted = linear[i] * point.weight;
            (0..count).for_each(|j| sums.me[i][j].add_product(weighted, linear[j]));
            // Of a slave of first order these are Me.
            if S::CURVED {
                (0..S::NODES).for_each(|k| sums.slave[i][k].add_product(weighted, point.slave[k]));
            }
            (0..M::NODES).for_each(|l| sums.master[i][l].add_product(weighted, point.master[l]));
        }
    });
    (sums, covered)
}

/// L at local coordinates of the facet. Pieces are parallelograms and triangles there.
fn linear_functions<T: Real, S: FacetShape>(piece: &[usize], xi: [T; 2]) -> [T; PIECE] {
    let corner = |n: usize| S::corner(piece[n]);
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

/// L of all nodes of the slave at a point: what its nodes have of it. Of a slave of first order its shape functions.
pub fn nodal_shares<T: Real, S: FacetShape, M: FacetShape>(point: &Point<T, S, M>) -> S::Nodal<T> {
    if !S::CURVED {
        return point.slave;
    }
    // The piece that the point is in, or least outside.
    let least = |functions: &[T]| functions.iter().map(|f| f.value()).fold(f64::INFINITY, f64::min);
    let of_piece = |piece: &'static [usize]| (piece, linear_functions::<T, S>(piece, point.local));
    let pieces = S::PIECES.iter().map(|piece| of_piece(piece));
    let found = pieces.max_by(|(a, of_a), (b, of_b)| least(&of_a[..a.len()]).total_cmp(&least(&of_b[..b.len()])));
    let mut out = S::nodal(|_| T::zero());
    if let Some((piece, functions)) = found {
        piece.iter().zip(functions).for_each(|(&node, function)| out[node] = function);
    }
    out
}

/// D and M of a pair, and the length or area that it covers.
pub(super) fn operators<T: Real, S: FacetShape, M: FacetShape>(
    pair: &PairGeometry<T, S, M>,
    settings: &SegmentationSettings,
) -> (Operators<T, S, M>, f64) {
    let (sums, covered) = sums(pair, settings);
    let mut operators = Operators::zero();
    for (at, (piece, sums)) in S::PIECES.iter().zip(sums).enumerate() {
        let plain = pair.choices.plain & (1 << at) != 0;
        match Some(&sums).filter(|_| !plain).and_then(|sums| sums.inverse(piece.len())) {
            Some(inverse) => sums.add_dual(piece, &inverse, &mut operators),
            None => sums.add_plain(piece, &mut operators),
        }
    }
    (operators, covered)
}

/// The pieces of the slave, as bits, on which plain functions stand in for dual ones.
pub(super) fn plain_pieces<S: FacetShape, M: FacetShape>(
    pair: &PairGeometry<f64, S, M>,
    settings: &SegmentationSettings,
) -> u8 {
    let (sums, _) = sums(pair, settings);
    let plain = |(at, sums): (usize, &Sums<f64, S, M>)| {
        let covered = sums.me[0][0] > 0.0;
        u8::from(covered && sums.inverse(S::PIECES[at].len()).is_none()) << at
    };
    sums.iter().enumerate().map(plain).fold(pair.choices.plain, |all, own| all | own)
}

impl<T: Real, S: FacetShape, M: FacetShape> Sums<T, S, M> {
    /// Me⁻¹ of a piece with `count` nodes.
    fn inverse(&self, count: usize) -> Option<[[f64; PIECE]; PIECE]> {
        // The diagonal of nodes that the piece has not keeps the matrix regular and its condition as it is.
        let filler = self.me[0][0].value();
        let me = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let missing = i >= count || j >= count;
                if missing { if i == j { filler } else { 0.0 } } else { self.me[i][j].value() }
            })
        });
        inverse::<Quadrilateral4>(&me)
    }

    fn add_plain(&self, piece: &[usize], out: &mut Operators<T, S, M>) {
        for (i, &node) in piece.iter().enumerate() {
            (0..S::NODES).for_each(|k| out.d[node][k] += if S::CURVED { self.slave[i][k] } else { self.me[i][k] });
            (0..M::NODES).for_each(|l| out.m[node][l] += self.master[i][l]);
        }
    }

    fn add_dual(&self, piece: &[usize], inverse: &[[f64; PIECE]; PIECE], out: &mut Operators<T, S, M>) {
        let count = piece.len();
        let de: [T; PIECE] = std::array::from_fn(|i| (0..count).fold(T::zero(), |sum, j| sum + self.me[i][j]));
        if !S::CURVED {
            piece.iter().enumerate().for_each(|(i, &node)| out.d[node][node] += de[i]);
        }
        let mut add = |of: &dyn Fn(usize) -> T, at: &mut dyn FnMut(&mut Operators<T, S, M>, usize) -> &mut T| {
            // Me⁻¹ ∫ L N on values, then one correction, which brings the derivative.
            let values: [f64; PIECE] = std::array::from_fn(|i| (0..count).map(|j| inverse[i][j] * of(j).value()).sum());
            let residual: [T; PIECE] = std::array::from_fn(|i| {
                let mut rest = if i < count { of(i) } else { T::zero() };
                (0..count).for_each(|j| rest.add_scaled(self.me[i][j], -values[j]));
                rest
            });
            for (i, &node) in piece.iter().enumerate() {
                let mut x = T::constant(values[i]);
                (0..count).for_each(|j| x.add_scaled(residual[j], inverse[i][j]));
                *at(out, node) += de[i] * x;
            }
        };
        for k in 0..if S::CURVED { S::NODES } else { 0 } {
            add(&|i| self.slave[i][k], &mut |out, node| &mut out.d[node][k]);
        }
        for l in 0..M::NODES {
            add(&|i| self.master[i][l], &mut |out, node| &mut out.m[node][l]);
        }
    }
}
