//! Shapes of facets: lines in the plane and surfaces in space, with shape functions in any scalar.
//!
//! The number of nodes is known at run time, so that code over facets is compiled once for each scalar. A line a → b has the
//! normal (t_y, −t_x), a surface t_1 × t_2. Local coordinates are `[ξ, η]`; a line has no η.

use std::fmt;

use super::Shape;
use super::nodal::Nodal;
use super::shape_formulas::{barycentric, linear, product, quadratic, quadratic_corner, quadratic_middle, serendipity};
use super::sub_facets::sub_facets;
use crate::scalar::{Dual, Real};
use crate::vector3::{cross, dot, norm, normalised, sub, value};

/// Newton steps of the closest-point search; it is quadratic, three or four are the rule.
const MAX_STEPS: usize = 25;
/// Step of a search in local coordinates after which nothing is left but round-off.
const SETTLED: f64 = 1e-9;

/// The point in which a straight line meets a facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Local coordinates on the facet.
    pub local: [f64; 2],
    /// Way along the line from where it starts, in lengths of its direction.
    pub distance: f64,
    /// ∂ξ/∂x and ∂η/∂x: the change of the local coordinates when the line moves by x (one by length).
    pub rows: [[f64; 3]; 2],
}

/// A shape of facets: the constant facts of its reference cell.
pub struct FacetShape {
    /// Its name among the reference cells.
    pub shape: Shape,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of corners, which are the first of its nodes and follow each other along the rim.
    pub corners: usize,
    /// Dimensions of the space that it bounds a body in: 2 or 3.
    pub space: usize,
    /// Whether its map is affine, so that it is flat and its tangents are constant.
    pub affine: bool,
    /// Whether it is of second order, with nodes beside its corners.
    pub curved: bool,
    /// Whether its last node is an apex beside it, with which points off the facet are combinations of its nodes: those of an
    /// [`ExactFacet`](super::ExactFacet). On the facet itself the shape function of the apex is zero.
    pub apex: bool,
    /// Its linear sub-facets, each by its nodes.
    pub sub_facets: &'static [&'static [usize]],
    /// Local coordinates of its centre.
    pub centre: [f64; 2],
    /// Length or area of the reference cell.
    pub cell_size: f64,
    /// Local coordinates of its nodes.
    points: &'static [[f64; 3]],
}

/// Line with two nodes, ξ ∈ [−1, 1].
pub static LINE_2: FacetShape = FacetShape::new(Shape::Line2);
/// Line with a node in the middle.
pub static LINE_3: FacetShape = FacetShape::new(Shape::Line3);
/// Line with two nodes and an apex.
pub static LINE_2_APEX: FacetShape = FacetShape::with_apex(Shape::Line2);
/// Triangle with three nodes and an apex.
pub static TRIANGLE_3_APEX: FacetShape = FacetShape::with_apex(Shape::Tri3);
/// Triangle with corners (0,0), (1,0), (0,1).
pub static TRIANGLE_3: FacetShape = FacetShape::new(Shape::Tri3);
/// Triangle with nodes in the middle of its edges.
pub static TRIANGLE_6: FacetShape = FacetShape::new(Shape::Tri6);
/// Quadrilateral, ξ, η ∈ [−1, 1].
pub static QUADRILATERAL_4: FacetShape = FacetShape::new(Shape::Quad4);
/// Quadrilateral with nodes in the middle of its edges.
pub static QUADRILATERAL_8: FacetShape = FacetShape::new(Shape::Quad8);
/// Quadrilateral with nodes in the middle of its edges and at its centre.
pub static QUADRILATERAL_9: FacetShape = FacetShape::new(Shape::Quad9);

impl fmt::Debug for FacetShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}{}", self.shape, if self.apex { " with an apex" } else { "" })
    }
}

impl PartialEq for FacetShape {
    fn eq(&self, other: &Self) -> bool {
        (self.shape, self.apex) == (other.shape, other.apex)
    }
}

impl Eq for FacetShape {}

/// The combination Σ Nᵢ vᵢ of nodal vectors.
#[inline]
pub fn interpolate<T: Real, const C: usize>(shape_functions: &[T], nodal: &[[T; C]]) -> [T; C] {
    let mut sum = [T::zero(); C];
    for (shape, vector) in shape_functions.iter().zip(nodal) {
        for c in 0..C {
            sum[c].add_product(*shape, vector[c]);
        }
    }
    sum
}

/// The combination Σ wᵢ vᵢ of nodal vectors with plain weights.
#[inline]
pub fn combine<T: Real, const C: usize>(weights: &[f64], nodal: &[[T; C]]) -> [T; C] {
    let mut sum = [T::zero(); C];
    for (&weight, vector) in weights.iter().zip(nodal) {
        for c in 0..C {
            sum[c].add_scaled(vector[c], weight);
        }
    }
    sum
}

impl FacetShape {
    const fn new(shape: Shape) -> Self {
        let cell = shape.cell();
        let (nodes, corners, space) = (shape.nodes(), cell.corners(), shape.dim() + 1);
        Self {
            shape,
            nodes,
            corners,
            space,
            affine: nodes == space,
            curved: nodes > corners,
            apex: false,
            sub_facets: sub_facets(shape),
            centre: [cell.centre[0], cell.centre[1]],
            cell_size: cell.size(),
            points: cell.points,
        }
    }

    const fn with_apex(shape: Shape) -> Self {
        let own = Self::new(shape);
        Self { nodes: own.nodes + 1, apex: true, ..own }
    }

    /// The same shape with an apex; `None` where facets of an exact surface do not have it.
    pub fn and_apex(&self) -> Option<&'static Self> {
        match self.shape {
            Shape::Line2 => Some(&LINE_2_APEX),
            Shape::Tri3 => Some(&TRIANGLE_3_APEX),
            _ => None,
        }
    }

    /// The facts of a shape; `None` where it is no facet.
    pub fn of(shape: Shape) -> Option<&'static Self> {
        Some(match shape {
            Shape::Line2 => &LINE_2,
            Shape::Line3 => &LINE_3,
            Shape::Tri3 => &TRIANGLE_3,
            Shape::Tri6 => &TRIANGLE_6,
            Shape::Quad4 => &QUADRILATERAL_4,
            Shape::Quad8 => &QUADRILATERAL_8,
            Shape::Quad9 => &QUADRILATERAL_9,
            _ => return None,
        })
    }

    /// All shapes of facets.
    pub fn all() -> [&'static Self; 7] {
        [&LINE_2, &LINE_3, &TRIANGLE_3, &TRIANGLE_6, &QUADRILATERAL_4, &QUADRILATERAL_8, &QUADRILATERAL_9]
    }

    /// The values of a function of the node.
    #[inline(always)]
    pub fn nodal<V: Copy>(&self, of: impl FnMut(usize) -> V) -> Nodal<V> {
        Nodal::new(self.nodes, of)
    }

    /// Shape functions at a local point.
    pub fn values<T: Real>(&self, xi: [T; 2]) -> Nodal<T> {
        let mut out = Nodal::empty();
        self.write_values(xi, &mut out);
        out
    }

    /// Writes the shape functions at a local point to `out`: with derivatives they are too large to be moved about.
    pub fn write_values<T: Real>(&self, xi: [T; 2], out: &mut Nodal<T>) {
        let points = self.points;
        match self.shape {
            Shape::Line2 => {
                out.refill(self.nodes, |i| if i < 2 { product(&points[i], &xi[..1], linear) } else { T::zero() })
            }
            Shape::Line3 => out.refill(3, |i| product(&points[i], &xi[..1], quadratic)),
            Shape::Tri3 => out.refill(self.nodes, |i| if i < 3 { barycentric(&xi, i) } else { T::zero() }),
            Shape::Tri6 => {
                let l: [T; 3] = std::array::from_fn(|i| barycentric(&xi, i));
                out.refill(
                    6,
                    |i| if i < 3 { quadratic_corner(l[i]) } else { quadratic_middle(l[i - 3], l[(i - 2) % 3]) },
                );
            }
            Shape::Quad4 => out.refill(4, |i| product(&points[i], &xi, linear)),
            Shape::Quad8 => out.refill(8, |i| serendipity(&points[i], &xi)),
            _ => out.refill(9, |i| product(&points[i], &xi, quadratic)),
        }
    }

    /// Derivatives of the shape functions by ξ and η at a local point.
    #[inline]
    pub fn gradients(&self, xi: [f64; 2]) -> Nodal<[f64; 2]> {
        self.values([Dual::<2>::variable(xi[0], 0), Dual::variable(xi[1], 1)]).map(|n| n.gradient)
    }

    /// Local coordinates of a node.
    #[inline]
    pub fn corner(&self, n: usize) -> [f64; 2] {
        let [xi, eta, _] = self.points[n];
        [xi, eta]
    }

    /// Tangents ∂x/∂ξ and ∂x/∂η at a local point; that of a line by η is zero.
    #[inline]
    pub fn tangents<T: Real>(&self, nodes: &[[T; 3]], xi: [f64; 2]) -> [[T; 3]; 2] {
        let gradients = self.gradients(xi);
        [0, 1].map(|a| combine(&gradients.map(|g| g[a]), nodes))
    }

    /// Normal whose length is that of a line, or the area of a surface, by the local coordinates.
    #[inline]
    pub fn area_normal<T: Real>(&self, nodes: &[[T; 3]], xi: [f64; 2]) -> [T; 3] {
        self.across(self.tangents(nodes, xi))
    }

    #[inline]
    fn across<T: Real>(&self, [t, s]: [[T; 3]; 2]) -> [T; 3] {
        if self.space == 2 { [t[1], -t[0], T::zero()] } else { cross(t, s) }
    }

    /// Unit normal at a local point.
    #[inline]
    pub fn unit_normal<T: Real>(&self, nodes: &[[T; 3]], xi: [f64; 2]) -> [T; 3] {
        normalised(self.area_normal(nodes, xi))
    }

    /// [`FacetShape::area_normal`] at a local point that moves.
    pub fn area_normal_at<T: Real>(&self, nodes: &[[T; 3]], xi: [T; 2]) -> [T; 3] {
        let at = xi.map(T::value);
        let [mut t, mut s] = self.tangents(nodes, at);
        let [first, mixed, last] = self.bend_at(&Nodal::of(nodes).map(value), at);
        for a in 0..2 {
            let (moved, [by_t, by_s]) = (xi[a] - at[a], [[first, mixed], [mixed, last]][a]);
            for c in 0..3 {
                t[c].add_scaled(moved, by_t[c]);
                s[c].add_scaled(moved, by_s[c]);
            }
        }
        self.across([t, s])
    }

    /// The point in which the straight line through `p` along `n` meets the facet with nodes `x`, extended beyond its edges;
    /// `None` where the search for it does not settle.
    pub fn crossing(&self, x: &[[f64; 3]], p: [f64; 3], n: [f64; 3], guess: [f64; 2]) -> Option<Crossing> {
        let (mut local, mut distance) = (guess, 0.0);
        for _ in 0..MAX_STEPS {
            let at = self.values([Dual::<2>::variable(local[0], 0), Dual::variable(local[1], 1)]);
            let (mut apart, mut t, mut s) = ([0.0; 3], [0.0; 3], [0.0; 3]);
            for (shape, x) in at.iter().zip(x) {
                for c in 0..3 {
                    apart[c] += shape.value * x[c];
                    t[c] += shape.gradient[0] * x[c];
                    s[c] += shape.gradient[1] * x[c];
                }
            }
            (0..3).for_each(|c| apart[c] -= p[c] + distance * n[c]);
            let columns = [t, if self.space == 2 { [0.0, 0.0, 1.0] } else { s }, n.map(|n| -n)];
            let [a, b, d] = solve(&columns, apart);
            local = [local[0] - a, local[1] - b];
            distance -= d;
            // The error after a step is about the square of the step.
            if a.abs().max(b.abs()) < SETTLED {
                return Some(Crossing { local, distance, rows: rows(&columns) });
            }
        }
        None
    }

    /// Local coordinates of the point in which the straight line through `point` along `direction` meets the facet, extended
    /// beyond its edges; `None` where the search for it does not settle.
    ///
    /// As in [`FacetShape::closest_point`] it runs on values, and one correction gives the derivative.
    pub fn point_along<T: Real>(
        &self,
        nodes: &[[T; 3]],
        point: [T; 3],
        direction: [T; 3],
        guess: [f64; 2],
    ) -> Option<[T; 2]> {
        let (x, p, n) = (Nodal::of(nodes).map(value), value(point), value(direction));
        let found = self.crossing(&x, p, n, guess)?;
        let on = combine(&self.values(found.local), nodes);
        let apart: [T; 3] = std::array::from_fn(|c| on[c] - point[c] - direction[c] * found.distance);
        let mut local = found.local.map(T::constant);
        for a in 0..self.space - 1 {
            (0..3).for_each(|c| local[a].add_scaled(apart[c], -found.rows[a][c]));
        }
        Some(local)
    }

    /// Length of a line, or area of a surface, as it is at the centre.
    #[inline]
    pub fn measure(&self, nodes: &[[f64; 3]]) -> f64 {
        norm(self.area_normal(nodes, self.centre)) * self.cell_size
    }

    /// Local coordinates of the point of a facet closest to `point`, which need not lie on it.
    ///
    /// The search runs on values; one correction with the inverse Hessian at the solution then gives the exact derivative
    /// (implicit function theorem on `∂ₐx·(x(ξ) − p) = 0`).
    pub fn closest_point<T: Real>(&self, nodes: &[[T; 3]], point: [T; 3], guess: [f64; 2]) -> [T; 2] {
        let x = Nodal::of(nodes).map(value);
        let p = value(point);
        let (xi, state) = self.closest(&x, p, guess);
        if !T::DIFFERENTIATES {
            return xi.map(T::constant);
        }
        // d(∂ₐx·(x − p)) at a fixed ξ: the motion of the gap along the tangents, and that of the tangents along the gap.
        let (shape, gradient) = (self.values(xi), self.gradients(xi));
        let mut residual = [T::zero(); 2];
        for c in 0..3 {
            for n in 0..self.nodes {
                let moved = nodes[n][c] - x[n][c];
                for a in 0..2 {
                    residual[a].add_scaled(moved, shape[n] * state.tangent[a][c] + gradient[n][a] * state.gap[c]);
                }
            }
            (0..2).for_each(|a| residual[a].add_scaled(point[c] - p[c], -state.tangent[a][c]));
        }
        let inverse = [state.solve([1.0, 0.0]), state.solve([0.0, 1.0])];
        let mut local = xi.map(T::constant);
        for a in 0..2 {
            local[a].add_scaled(residual[0], -inverse[0][a]);
            local[a].add_scaled(residual[1], -inverse[1][a]);
        }
        local
    }

    /// Whether the second derivatives are the same everywhere on the facet.
    pub fn has_constant_bend(&self) -> bool {
        matches!(self.shape, Shape::Line3 | Shape::Tri6) || !self.curved
    }

    /// The search of [`FacetShape::closest_point`]: local coordinates and the derivatives there.
    fn closest(&self, x: &[[f64; 3]], p: [f64; 3], guess: [f64; 2]) -> ([f64; 2], HalfSquare) {
        let mut xi = guess;
        let mut bend = self.bend_at(x, xi);
        let mut state = HalfSquare::new(self, x, p, xi, &bend);
        for _ in 0..MAX_STEPS {
            let step = state.solve([dot(state.tangent[0], state.gap), dot(state.tangent[1], state.gap)]);
            xi = [xi[0] - step[0], xi[1] - step[1]];
            // So short a step changes no derivative.
            if step[0].abs().max(step[1].abs()) < 1e-13 {
                break;
            }
            if !self.has_constant_bend() {
                bend = self.bend_at(x, xi);
            }
            state = HalfSquare::new(self, x, p, xi, &bend);
        }
        (xi, state)
    }

    /// ∂²x/∂ξ², ∂²x/∂ξ∂η and ∂²x/∂η². No shape function is of higher degree than two in one coordinate, where central
    /// differences are exact; of bilinear ones, the mixed derivative is that of their values at the corners.
    pub fn bend_at(&self, x: &[[f64; 3]], [xi, eta]: [f64; 2]) -> [[f64; 3]; 3] {
        if self.affine {
            return [[0.0; 3]; 3];
        }
        if self.nodes == self.corners {
            let mixed = combine(&self.nodal(|n| 0.25 * self.corner(n)[0] * self.corner(n)[1]), x);
            return [[0.0; 3], mixed, [0.0; 3]];
        }
        let difference = |after: [f64; 2], before: [f64; 2]| {
            let (after, before) = (self.tangents(x, after), self.tangents(x, before));
            [0, 1].map(|a| sub(after[a], before[a]).map(|d| 0.5 * d))
        };
        let [first, mixed] = difference([xi + 1.0, eta], [xi - 1.0, eta]);
        let [_, last] = difference([xi, eta + 1.0], [xi, eta - 1.0]);
        [first, mixed, last]
    }
}

/// The factors of three vectors that add up to another, by Cramer's rule.
pub(super) fn solve([a, b, c]: &[[f64; 3]; 3], sum: [f64; 3]) -> [f64; 3] {
    let whole = 1.0 / dot(*a, cross(*b, *c));
    [dot(sum, cross(*b, *c)) * whole, dot(*a, cross(sum, *c)) * whole, dot(*a, cross(*b, sum)) * whole]
}

/// The first two rows of the inverse of the matrix with these columns.
pub(super) fn rows([a, b, c]: &[[f64; 3]; 3]) -> [[f64; 3]; 2] {
    let (first, second) = (cross(*b, *c), cross(*c, *a));
    let whole = 1.0 / dot(*a, first);
    [first.map(|x| x * whole), second.map(|x| x * whole)]
}

/// First and second derivatives of half the squared distance, at one local point.
struct HalfSquare {
    tangent: [[f64; 3]; 2],
    gap: [f64; 3],
    hessian: [f64; 3],
}

impl HalfSquare {
    fn new(facet: &FacetShape, x: &[[f64; 3]], p: [f64; 3], xi: [f64; 2], bend: &[[f64; 3]; 3]) -> Self {
        let at = facet.values([Dual::<2>::variable(xi[0], 0), Dual::variable(xi[1], 1)]);
        let (mut gap, mut tangent) = (p.map(|p| -p), [[0.0; 3]; 2]);
        for (n, x) in at.iter().zip(x) {
            for c in 0..3 {
                gap[c] += n.value * x[c];
                tangent[0][c] += n.gradient[0] * x[c];
                tangent[1][c] += n.gradient[1] * x[c];
            }
        }
        let [t, s] = tangent;
        let mut hessian = [dot(t, t), dot(t, s), if facet.space == 2 { dot(t, t) } else { dot(s, s) }];
        if !facet.affine {
            let determinant = |[a, b, c]: [f64; 3]| a * c - b * b;
            let full: [f64; 3] = std::array::from_fn(|k| hessian[k] + dot(gap, bend[k]));
            // Far off a bent facet the distance need not be convex; then the Gauss–Newton matrix leads back.
            if full[0] > 0.0 && determinant(full) > 1e-3 * determinant(hessian) {
                hessian = full;
            }
        }
        Self { tangent, gap, hessian }
    }

    #[inline]
    fn solve(&self, rhs: [f64; 2]) -> [f64; 2] {
        let [a, b, c] = self.hessian;
        let inverse = 1.0 / (a * c - b * b);
        [(c * rhs[0] - b * rhs[1]) * inverse, (a * rhs[1] - b * rhs[0]) * inverse]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shape_functions;

    fn check(shape: &FacetShape, mut noise: impl FnMut() -> f64) {
        // Nodes of the reference cell, bent a little; local points inside it.
        let nodes: Nodal<[f64; 3]> = shape.nodal(|n| {
            let [x, y] = shape.corner(n);
            [x + 0.05 * noise(), y + 0.05 * noise(), if shape.space == 3 { 0.05 * noise() } else { 0.0 }]
        });
        let inside = std::array::from_fn(|c| {
            0.6 * shape.centre[c] + if shape.space - 1 > c { 0.15 * (1.0 + noise()) } else { 0.0 }
        });
        let mut values = vec![0.0; shape.nodes];
        shape_functions(shape.shape, [inside[0], inside[1], 0.0], &mut values);
        let typed: Nodal<f64> = shape.values(inside);
        assert!((0..shape.nodes).all(|n| (typed[n] - values[n]).abs() < 1e-15), "{typed:?} {values:?}");
        let on = combine(&typed, &nodes);
        let found = shape.closest_point(&nodes, on, shape.centre);
        assert!(
            (0..shape.space - 1).all(|c| (found[c] - inside[c]).abs() < 1e-13),
            "{:?}: {found:?} {inside:?}",
            shape.shape
        );

        // The derivative of a point off the facet, by the motion of a node and by its own.
        let normal = shape.unit_normal(&nodes, inside);
        let off: [f64; 3] = std::array::from_fn(|c| on[c] + 0.2 * normal[c]);
        for variable in 0..6 {
            let at = |h: f64| {
                let (mut nodes, mut off) = (nodes, off);
                if variable < 3 {
                    nodes[1][variable] += h
                } else {
                    off[variable - 3] += h
                }
                shape.closest_point(&nodes, off, shape.centre)
            };
            let mut moving = nodes.map(|x| x.map(Dual::<6>::constant));
            (0..3).for_each(|c| moving[1][c].gradient[c] = 1.0);
            let dual =
                shape.closest_point(&moving, std::array::from_fn(|c| Dual::variable(off[c], 3 + c)), shape.centre);
            let (plus, minus) = (at(1e-6), at(-1e-6));
            for a in 0..shape.space - 1 {
                let slope = (plus[a] - minus[a]) / 2e-6;
                assert!(
                    (slope - dual[a].gradient[variable]).abs() < 1e-8,
                    "{:?}: {slope} {}",
                    shape.shape,
                    dual[a].gradient[variable]
                );
            }
        }

        // The point along a slanted line, the normal there, and how both move with a node.
        let slanted: [f64; 3] =
            std::array::from_fn(|c| normal[c] + if shape.space > c { 0.2 * (c as f64 - 0.5) } else { 0.0 });
        let off: [f64; 3] = std::array::from_fn(|c| on[c] - 0.3 * slanted[c]);
        let at = |nodes: &Nodal<[f64; 3]>| {
            let xi = shape.point_along(nodes, off, slanted, shape.centre).unwrap();
            let [x, y, z] = shape.area_normal(nodes, xi);
            assert_eq!(shape.area_normal_at(nodes, xi), [x, y, z]);
            [xi[0], xi[1], x, y, z]
        };
        let found = at(&nodes);
        assert!((0..shape.space - 1).all(|c| (found[c] - inside[c]).abs() < 1e-12), "{:?}: {found:?}", shape.shape);
        for c in 0..shape.space {
            let mut moving = nodes.map(|x| x.map(Dual::<1>::constant));
            moving[1][c].gradient[0] = 1.0;
            let xi =
                shape.point_along(&moving, off.map(Dual::constant), slanted.map(Dual::constant), shape.centre).unwrap();
            let normal = shape.area_normal_at(&moving, xi);
            let dual = [xi[0], xi[1], normal[0], normal[1], normal[2]].map(|d| d.gradient[0]);
            let moved = |h: f64| {
                let mut nodes = nodes;
                nodes[1][c] += h;
                at(&nodes)
            };
            let (plus, minus) = (moved(1e-6), moved(-1e-6));
            for k in (0..5).filter(|&k| shape.space == 3 || k != 1) {
                let slope = (plus[k] - minus[k]) / 2e-6;
                assert!((slope - dual[k]).abs() < 1e-8, "{:?} {k}: {slope} {}", shape.shape, dual[k]);
            }
        }
    }

    #[test]
    fn closest_points_and_their_derivatives() {
        let mut state = 1_u64;
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for _ in 0..5 {
            FacetShape::all().into_iter().for_each(|shape| check(shape, &mut noise));
        }
    }
}
