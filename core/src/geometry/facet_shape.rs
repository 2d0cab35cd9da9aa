//! Facets as types: lines in the plane and surfaces in space, for code that is compiled for their shape and any scalar.
//!
//! A line a → b has the normal (t_y, −t_x), a surface t_1 × t_2. Local coordinates are `[ξ, η]`; a line has no η.

use std::fmt::Debug;
use std::ops::{Index, IndexMut};

use super::Shape;
use super::pieces::pieces;
use super::shape_functions::{barycentric, linear, product, quadratic, quadratic_simplex, serendipity};
use crate::scalar::{Differentiated, Dual, Real};
use crate::vector3::{cross, dot, norm, normalised, sub, value};

/// Newton steps of the closest-point search; it is quadratic, three or four are the rule.
const MAX_STEPS: usize = 25;

/// What can stand at the nodes of a facet.
pub trait NodeValue: Copy + Debug + Send + Sync + 'static {}
impl<V: Copy + Debug + Send + Sync + 'static> NodeValue for V {}

/// An array of one value a node.
pub trait NodeArray<V>: NodeValue + Index<usize, Output = V> + IndexMut<usize> + IntoIterator<Item = V> {
    /// The values.
    fn as_slice(&self) -> &[V];

    /// The values, to change.
    fn as_mut_slice(&mut self) -> &mut [V];

    /// Visits the values.
    fn iter<'a>(&'a self) -> std::slice::Iter<'a, V>
    where
        V: 'a,
    {
        self.as_slice().iter()
    }

    /// Visits the values, to change them.
    fn iter_mut<'a>(&'a mut self) -> std::slice::IterMut<'a, V>
    where
        V: 'a,
    {
        self.as_mut_slice().iter_mut()
    }
}

impl<V: NodeValue, const N: usize> NodeArray<V> for [V; N] {
    #[inline]
    fn as_slice(&self) -> &[V] {
        self
    }

    #[inline]
    fn as_mut_slice(&mut self) -> &mut [V] {
        self
    }
}

/// A shape of facets. Adding one to what facets carry is adding its type here and, for contact, a line to the list of pairs.
pub trait FacetShape: Copy + Debug + Send + Sync + 'static {
    /// Its name among the reference cells.
    const SHAPE: Shape;
    /// Number of nodes.
    const NODES: usize = Self::SHAPE.nodes();
    /// Number of corners, which are the first of its nodes and follow each other along the rim.
    const CORNERS: usize = Self::SHAPE.cell().corners();
    /// Dimensions of the space that it bounds a body in: 2 or 3.
    const SPACE: usize = Self::SHAPE.dim() + 1;
    /// Whether its map is affine, so that it is flat and its tangents are constant.
    const AFFINE: bool = Self::NODES == Self::SPACE;
    /// Whether it is of second order, with nodes beside its corners.
    const CURVED: bool = Self::NODES > Self::CORNERS;
    /// Its linear pieces, each by its nodes.
    const PIECES: &'static [&'static [usize]] = pieces(Self::SHAPE);
    /// Local coordinates of its centre.
    const CENTRE: [f64; 2] = [Self::SHAPE.cell().centre[0], Self::SHAPE.cell().centre[1]];

    /// Numbers with derivatives by one variable a node.
    type ByNode: Differentiated;

    /// An array of one value a node.
    type Nodal<V: NodeValue>: NodeArray<V>;

    /// The array of the values of a function of the node.
    fn nodal<V: NodeValue>(of: impl FnMut(usize) -> V) -> Self::Nodal<V>;

    /// Shape functions at a local point.
    fn values<T: Real>(xi: [T; 2]) -> Self::Nodal<T>;

    /// The array of a function of the values of another.
    #[inline]
    fn map<V: NodeValue, W: NodeValue>(values: &Self::Nodal<V>, mut of: impl FnMut(V) -> W) -> Self::Nodal<W> {
        Self::nodal(|n| of(values[n]))
    }

    /// Derivatives of the shape functions by ξ and η at a local point.
    #[inline]
    fn gradients(xi: [f64; 2]) -> Self::Nodal<[f64; 2]> {
        let at = Self::values([Dual::<2>::variable(xi[0], 0), Dual::variable(xi[1], 1)]);
        Self::map(&at, |n| n.gradient)
    }

    /// Local coordinates of a node.
    #[inline]
    fn corner(n: usize) -> [f64; 2] {
        let [xi, eta, _] = Self::SHAPE.cell().points[n];
        [xi, eta]
    }

    /// The combination Σ Nᵢ vᵢ of nodal vectors.
    #[inline]
    fn interpolate<T: Real, const C: usize>(shape: &Self::Nodal<T>, nodal: &Self::Nodal<[T; C]>) -> [T; C] {
        let mut sum = [T::zero(); C];
        for n in 0..Self::NODES {
            for c in 0..C {
                sum[c].add_product(shape[n], nodal[n][c]);
            }
        }
        sum
    }

    /// The combination Σ wᵢ vᵢ of nodal vectors with plain weights.
    #[inline]
    fn combine<T: Real, const C: usize>(weights: &Self::Nodal<f64>, nodal: &Self::Nodal<[T; C]>) -> [T; C] {
        let mut sum = [T::zero(); C];
        for n in 0..Self::NODES {
            for c in 0..C {
                sum[c].add_scaled(nodal[n][c], weights[n]);
            }
        }
        sum
    }

    /// Tangents ∂x/∂ξ and ∂x/∂η at a local point; that of a line by η is zero.
    #[inline]
    fn tangents<T: Real>(nodes: &Self::Nodal<[T; 3]>, xi: [f64; 2]) -> [[T; 3]; 2] {
        let gradients = Self::gradients(xi);
        [0, 1].map(|a| Self::combine(&Self::map(&gradients, |g| g[a]), nodes))
    }

    /// Normal whose length is that of a line, or the area of a surface, by the local coordinates.
    #[inline]
    fn area_normal<T: Real>(nodes: &Self::Nodal<[T; 3]>, xi: [f64; 2]) -> [T; 3] {
        let [t, s] = Self::tangents(nodes, xi);
        if Self::SPACE == 2 { [t[1], -t[0], T::zero()] } else { cross(t, s) }
    }

    /// Unit normal at a local point.
    #[inline]
    fn unit_normal<T: Real>(nodes: &Self::Nodal<[T; 3]>, xi: [f64; 2]) -> [T; 3] {
        normalised(Self::area_normal(nodes, xi))
    }

    /// [`FacetShape::area_normal`] at a local point that moves.
    fn area_normal_at<T: Real>(nodes: &Self::Nodal<[T; 3]>, xi: [T; 2]) -> [T; 3] {
        let at = xi.map(T::value);
        let [mut t, mut s] = Self::tangents(nodes, at);
        let [first, mixed, last] = bend_at::<Self>(&Self::map(nodes, value), at);
        for a in 0..2 {
            let (moved, [by_t, by_s]) = (xi[a] - at[a], [[first, mixed], [mixed, last]][a]);
            for c in 0..3 {
                t[c].add_scaled(moved, by_t[c]);
                s[c].add_scaled(moved, by_s[c]);
            }
        }
        if Self::SPACE == 2 { [t[1], -t[0], T::zero()] } else { cross(t, s) }
    }

    /// Local coordinates of the point in which the straight line through `point` along `direction` meets the facet, extended
    /// beyond its edges; `None` where the search for it does not settle.
    ///
    /// As in [`FacetShape::closest_point`] it runs on values, and one correction gives the derivative.
    fn point_along<T: Real>(
        nodes: &Self::Nodal<[T; 3]>,
        point: [T; 3],
        direction: [T; 3],
        guess: [f64; 2],
    ) -> Option<[T; 2]> {
        let (x, p, n) = (Self::map(nodes, value), value(point), value(direction));
        let (mut xi, mut distance) = (guess, 0.0);
        let mut settled = false;
        let columns = |xi: [f64; 2]| {
            let [t, s] = Self::tangents(&x, xi);
            [t, if Self::SPACE == 2 { [0.0, 0.0, 1.0] } else { s }, n.map(|n| -n)]
        };
        for _ in 0..MAX_STEPS {
            let on = Self::combine(&Self::values(xi), &x);
            let apart: [f64; 3] = std::array::from_fn(|c| on[c] - p[c] - distance * n[c]);
            let [a, b, d] = solve(&columns(xi), apart);
            xi = [xi[0] - a, xi[1] - b];
            distance -= d;
            settled = a.abs().max(b.abs()) < 1e-13;
            if settled {
                break;
            }
        }
        if !settled {
            return None;
        }
        let on = Self::combine(&Self::values(xi), nodes);
        let apart: [T; 3] = std::array::from_fn(|c| on[c] - point[c] - direction[c] * distance);
        let inverse = [0, 1, 2].map(|c| {
            let unit: [f64; 3] = std::array::from_fn(|k| f64::from(u8::from(k == c)));
            solve(&columns(xi), unit)
        });
        let mut local = xi.map(T::constant);
        for a in 0..Self::SPACE - 1 {
            (0..3).for_each(|c| local[a].add_scaled(apart[c], -inverse[c][a]));
        }
        Some(local)
    }

    /// Length of a line, or area of a surface, as it is at the centre.
    #[inline]
    fn measure(nodes: &Self::Nodal<[f64; 3]>) -> f64 {
        norm(Self::area_normal(nodes, Self::CENTRE)) * Self::SHAPE.cell().size()
    }

    /// Local coordinates of the point of a facet closest to `point`, which need not lie on it.
    ///
    /// The search runs on values; one correction with the inverse Hessian at the solution then gives the exact derivative
    /// (implicit function theorem on `∂ₐx·(x(ξ) − p) = 0`).
    fn closest_point<T: Real>(nodes: &Self::Nodal<[T; 3]>, point: [T; 3], guess: [f64; 2]) -> [T; 2] {
        let x = Self::map(nodes, value);
        let p = value(point);
        let mut xi = guess;
        let mut bend = bend_at::<Self>(&x, xi);
        let mut state = HalfSquare::new::<Self>(&x, p, xi, &bend);
        for _ in 0..MAX_STEPS {
            let step = state.solve([dot(state.tangent[0], state.gap), dot(state.tangent[1], state.gap)]);
            xi = [xi[0] - step[0], xi[1] - step[1]];
            // So short a step changes no derivative.
            if step[0].abs().max(step[1].abs()) < 1e-13 {
                break;
            }
            if Self::CURVED {
                bend = bend_at::<Self>(&x, xi);
            }
            state = HalfSquare::new::<Self>(&x, p, xi, &bend);
        }
        if !T::DIFFERENTIATES {
            return xi.map(T::constant);
        }
        // d(∂ₐx·(x − p)) at a fixed ξ: the motion of the gap along the tangents, and that of the tangents along the gap.
        let (shape, gradient) = (Self::values(xi), Self::gradients(xi));
        let mut residual = [T::zero(); 2];
        for c in 0..3 {
            for n in 0..Self::NODES {
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
}

/// ∂²x/∂ξ², ∂²x/∂ξ∂η and ∂²x/∂η². No shape function is of higher degree than two in one coordinate, where central differences
/// are exact; of bilinear ones, the mixed derivative is that of their values at the corners.
#[inline]
fn bend_at<S: FacetShape>(x: &S::Nodal<[f64; 3]>, [xi, eta]: [f64; 2]) -> [[f64; 3]; 3] {
    if S::AFFINE {
        return [[0.0; 3]; 3];
    }
    if S::NODES == S::CORNERS {
        let mixed = S::combine(&S::nodal(|n| 0.25 * S::corner(n)[0] * S::corner(n)[1]), x);
        return [[0.0; 3], mixed, [0.0; 3]];
    }
    let difference = |after: [f64; 2], before: [f64; 2]| {
        let (after, before) = (S::tangents(x, after), S::tangents(x, before));
        [0, 1].map(|a| sub(after[a], before[a]).map(|d| 0.5 * d))
    };
    let [first, mixed] = difference([xi + 1.0, eta], [xi - 1.0, eta]);
    let [_, last] = difference([xi, eta + 1.0], [xi, eta - 1.0]);
    [first, mixed, last]
}

/// The factors of three vectors that add up to another, by Cramer's rule.
fn solve([a, b, c]: &[[f64; 3]; 3], sum: [f64; 3]) -> [f64; 3] {
    let whole = 1.0 / dot(*a, cross(*b, *c));
    [dot(sum, cross(*b, *c)) * whole, dot(*a, cross(sum, *c)) * whole, dot(*a, cross(*b, sum)) * whole]
}

/// First and second derivatives of half the squared distance, at one local point.
struct HalfSquare {
    tangent: [[f64; 3]; 2],
    gap: [f64; 3],
    hessian: [f64; 3],
}

impl HalfSquare {
    #[inline]
    fn new<S: FacetShape>(x: &S::Nodal<[f64; 3]>, p: [f64; 3], xi: [f64; 2], bend: &[[f64; 3]; 3]) -> Self {
        let at = S::values([Dual::<2>::variable(xi[0], 0), Dual::variable(xi[1], 1)]);
        let (mut gap, mut tangent) = (p.map(|p| -p), [[0.0; 3]; 2]);
        for n in 0..S::NODES {
            for c in 0..3 {
                gap[c] += at[n].value * x[n][c];
                tangent[0][c] += at[n].gradient[0] * x[n][c];
                tangent[1][c] += at[n].gradient[1] * x[n][c];
            }
        }
        let [t, s] = tangent;
        let mut hessian = [dot(t, t), dot(t, s), if S::SPACE == 2 { dot(t, t) } else { dot(s, s) }];
        if !S::AFFINE {
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

/// Facets with their number of nodes and their shape functions: of node `i`, at `xi`.
macro_rules! facet_shapes {
    ($($(#[$doc:meta])* $name:ident, $shape:ident, $nodes:literal: |$i:ident, $xi:ident| $function:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub struct $name;

        impl FacetShape for $name {
            const SHAPE: Shape = Shape::$shape;
            type ByNode = Dual<$nodes>;
            type Nodal<V: NodeValue> = [V; $nodes];

            #[inline(always)]
            fn nodal<V: NodeValue>(mut of: impl FnMut(usize) -> V) -> [V; $nodes] {
                // What `array::from_fn` makes of large values is slower.
                let mut out = [of(0); $nodes];
                for n in 1..$nodes {
                    out[n] = of(n);
                }
                out
            }

            #[inline(always)]
            fn values<T: Real>(xi: [T; 2]) -> [T; $nodes] {
                let $xi = &xi[..Self::SPACE - 1];
                Self::nodal(|$i| $function)
            }
        }
    )*};
}

facet_shapes! {
    /// Line with two nodes, ξ ∈ [−1, 1].
    Line2, Line2, 2: |i, xi| product(&Self::SHAPE.cell().points[i], xi, linear);
    /// Line with a node in the middle.
    Line3, Line3, 3: |i, xi| product(&Self::SHAPE.cell().points[i], xi, quadratic);
    /// Triangle with corners (0,0), (1,0), (0,1).
    Triangle3, Tri3, 3: |i, xi| barycentric(xi, i);
    /// Triangle with nodes in the middle of its edges.
    Triangle6, Tri6, 6: |i, xi| quadratic_simplex(Self::SHAPE.cell(), xi, i);
    /// Quadrilateral, ξ, η ∈ [−1, 1].
    Quadrilateral4, Quad4, 4: |i, xi| product(&Self::SHAPE.cell().points[i], xi, linear);
    /// Quadrilateral with nodes in the middle of its edges.
    Quadrilateral8, Quad8, 8: |i, xi| serendipity(&Self::SHAPE.cell().points[i], xi);
    /// Quadrilateral with nodes in the middle of its edges and at its centre.
    Quadrilateral9, Quad9, 9: |i, xi| product(&Self::SHAPE.cell().points[i], xi, quadratic);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shape_functions;

    fn check<S: FacetShape>(mut noise: impl FnMut() -> f64) {
        // Nodes of the reference cell, bent a little; local points inside it.
        let nodes: S::Nodal<[f64; 3]> = S::nodal(|n| {
            let [x, y] = S::corner(n);
            [x + 0.05 * noise(), y + 0.05 * noise(), if S::SPACE == 3 { 0.05 * noise() } else { 0.0 }]
        });
        let inside =
            std::array::from_fn(|c| 0.6 * S::CENTRE[c] + if S::SPACE - 1 > c { 0.15 * (1.0 + noise()) } else { 0.0 });
        let mut values = vec![0.0; S::NODES];
        shape_functions(S::SHAPE, [inside[0], inside[1], 0.0], &mut values);
        let typed: S::Nodal<f64> = S::values(inside);
        assert!((0..S::NODES).all(|n| (typed[n] - values[n]).abs() < 1e-15), "{typed:?} {values:?}");
        let on = S::combine(&typed, &nodes);
        let found = S::closest_point(&nodes, on, S::CENTRE);
        assert!(
            (0..S::SPACE - 1).all(|c| (found[c] - inside[c]).abs() < 1e-13),
            "{:?}: {found:?} {inside:?}",
            S::SHAPE
        );

        // The derivative of a point off the facet, by the motion of a node and by its own.
        let normal = S::unit_normal(&nodes, inside);
        let off: [f64; 3] = std::array::from_fn(|c| on[c] + 0.2 * normal[c]);
        for variable in 0..6 {
            let at = |h: f64| {
                let (mut nodes, mut off) = (nodes, off);
                if variable < 3 {
                    nodes[1][variable] += h
                } else {
                    off[variable - 3] += h
                }
                S::closest_point(&nodes, off, S::CENTRE)
            };
            let mut moving = S::map(&nodes, |x| x.map(Dual::<6>::constant));
            (0..3).for_each(|c| moving[1][c].gradient[c] = 1.0);
            let dual = S::closest_point(&moving, std::array::from_fn(|c| Dual::variable(off[c], 3 + c)), S::CENTRE);
            let (plus, minus) = (at(1e-6), at(-1e-6));
            for a in 0..S::SPACE - 1 {
                let slope = (plus[a] - minus[a]) / 2e-6;
                assert!(
                    (slope - dual[a].gradient[variable]).abs() < 1e-8,
                    "{:?}: {slope} {}",
                    S::SHAPE,
                    dual[a].gradient[variable]
                );
            }
        }

        // The point along a slanted line, the normal there, and how both move with a node.
        let slanted: [f64; 3] =
            std::array::from_fn(|c| normal[c] + if S::SPACE > c { 0.2 * (c as f64 - 0.5) } else { 0.0 });
        let off: [f64; 3] = std::array::from_fn(|c| on[c] - 0.3 * slanted[c]);
        let at = |nodes: &S::Nodal<[f64; 3]>| {
            let xi = S::point_along(nodes, off, slanted, S::CENTRE).unwrap();
            let [x, y, z] = S::area_normal(nodes, xi);
            assert_eq!(S::area_normal_at(nodes, xi), [x, y, z]);
            [xi[0], xi[1], x, y, z]
        };
        let found = at(&nodes);
        assert!((0..S::SPACE - 1).all(|c| (found[c] - inside[c]).abs() < 1e-12), "{:?}: {found:?}", S::SHAPE);
        for c in 0..S::SPACE {
            let mut moving = S::map(&nodes, |x| x.map(Dual::<1>::constant));
            moving[1][c].gradient[0] = 1.0;
            let xi = S::point_along(&moving, off.map(Dual::constant), slanted.map(Dual::constant), S::CENTRE).unwrap();
            let normal = S::area_normal_at(&moving, xi);
            let dual = [xi[0], xi[1], normal[0], normal[1], normal[2]].map(|d| d.gradient[0]);
            let moved = |h: f64| {
                let mut nodes = nodes;
                nodes[1][c] += h;
                at(&nodes)
            };
            let (plus, minus) = (moved(1e-6), moved(-1e-6));
            for k in (0..5).filter(|&k| S::SPACE == 3 || k != 1) {
                let slope = (plus[k] - minus[k]) / 2e-6;
                assert!((slope - dual[k]).abs() < 1e-8, "{:?} {k}: {slope} {}", S::SHAPE, dual[k]);
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
            check::<Line2>(&mut noise);
            check::<Line3>(&mut noise);
            check::<Triangle3>(&mut noise);
            check::<Triangle6>(&mut noise);
            check::<Quadrilateral4>(&mut noise);
            check::<Quadrilateral8>(&mut noise);
            check::<Quadrilateral9>(&mut noise);
        }
    }
}
