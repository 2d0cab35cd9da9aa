//! Facets of surfaces that a formula gives exactly: flat facets whose points are moved onto the surface.
//!
//! A point X_f = Σ N_l(ξ) X_l of the flat facet goes to the surface along the ray from an apex A beside it:
//! X = A + ρ (X_f − A), where F(X) = 0. So X = Σ w_l X_l + w_A A with w_l = ρ N_l and w_A = 1 − ρ, which add up to one: these are the
//! shape functions of a curved facet whose nodes are the corners and the apex. They depend on ξ alone and move with a rigid body
//! like those of any facet. Derivatives follow from ∂ρ/∂ξ = −ρ ∇F·∂X_f/∂ξ / ∇F·(X_f − A).

use std::fmt;

use super::facet_shape::{Crossing, FacetShape, rows, solve};
use super::nodal::Nodal;
use crate::scalar::{Dual, Real};
use crate::vector3::{add, dot, scale, value};

/// Steps of Newton's method for a point of the surface.
const MAX_STEPS: usize = 30;
/// Step in local coordinates, or change of ρ, after which nothing is left but round-off.
const SETTLED: f64 = 1e-12;
/// Bounds of ρ: beyond them the ray misses the part of the surface that the facet stands for.
const NEAR: [f64; 2] = [0.2, 5.0];

/// A function that is zero on a surface: its value and its gradient at a point, by up to four numbers of the surface.
pub type Level = fn(&[f64; 4], [f64; 3]) -> (f64, [f64; 3]);

/// A surface, as the zeros of a function in its own axes.
#[derive(Clone, Copy)]
pub struct ExactSurface {
    /// Name of the kind of surface.
    pub name: &'static str,
    /// The function.
    pub level: Level,
    /// Its numbers.
    pub numbers: [f64; 4],
}

impl fmt::Debug for ExactSurface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:?}", self.name, self.numbers)
    }
}

impl PartialEq for ExactSurface {
    fn eq(&self, other: &Self) -> bool {
        (self.name, self.numbers) == (other.name, other.numbers)
    }
}

/// A facet of an exact surface, in the axes of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExactFacet {
    /// The surface.
    pub surface: ExactSurface,
    /// Corners of the flat facet; a line has two, and its third is not used.
    pub corners: [[f64; 3]; 3],
    /// The apex.
    pub apex: [f64; 3],
}

/// Shape functions of a facet at a point of the surface: values, and derivatives by ξ and η.
pub struct ExactFunctions {
    /// Values.
    pub values: Nodal<f64>,
    /// By ξ and by η.
    pub gradients: [Nodal<f64>; 2],
}

impl ExactFacet {
    /// Shape functions at local coordinates; those of the flat facet where the ray through the point misses the surface.
    ///
    /// `shape` is the one with an apex.
    pub fn functions(&self, shape: &FacetShape, local: [f64; 2]) -> ExactFunctions {
        let flat = shape.values([Dual::<2>::variable(local[0], 0), Dual::variable(local[1], 1)]);
        let (mut arm, mut by) = (self.apex.map(|x| -x), [[0.0; 3]; 2]);
        for (n, x) in flat.iter().zip(&self.corners[..shape.corners]) {
            arm = add(arm, scale(*x, n.value));
            (0..2).for_each(|a| by[a] = add(by[a], scale(*x, n.gradient[a])));
        }
        let (ratio, slopes) = self.ratio(arm).map_or((1.0, [0.0; 2]), |(ratio, gradient)| {
            let along = dot(gradient, arm);
            (ratio, by.map(|by| -ratio * dot(gradient, by) / along))
        });
        let apex = shape.corners;
        ExactFunctions {
            values: Nodal::new(shape.nodes, |l| if l < apex { ratio * flat[l].value } else { 1.0 - ratio }),
            gradients: [0, 1].map(|a| {
                let own = |l: usize| slopes[a] * flat[l].value + ratio * flat[l].gradient[a];
                Nodal::new(shape.nodes, |l| if l < apex { own(l) } else { -slopes[a] })
            }),
        }
    }

    /// ρ of the ray with this way from the apex to the flat facet, and the gradient of the function where it meets the surface.
    fn ratio(&self, arm: [f64; 3]) -> Option<(f64, [f64; 3])> {
        let mut ratio = 1.0;
        for _ in 0..MAX_STEPS {
            let (level, gradient) = (self.surface.level)(&self.surface.numbers, add(self.apex, scale(arm, ratio)));
            let step = level / dot(gradient, arm);
            ratio -= step;
            if !(NEAR[0]..NEAR[1]).contains(&ratio) {
                return None;
            }
            if step.abs() < SETTLED {
                let at = add(self.apex, scale(arm, ratio));
                return Some((ratio, (self.surface.level)(&self.surface.numbers, at).1));
            }
        }
        None
    }

    /// The point in which the straight line through `p` along `n` meets the surface of a facet with nodes `x`, as
    /// [`FacetShape::crossing`] says.
    pub fn crossing(&self, shape: &FacetShape, x: &[[f64; 3]], p: [f64; 3], n: [f64; 3]) -> Option<Crossing> {
        let flat = shape.crossing(x, p, n, shape.centre)?;
        let (mut local, mut distance) = (flat.local, flat.distance);
        for _ in 0..MAX_STEPS {
            let at = self.functions(shape, local);
            let (mut apart, mut t, mut s) = ([0.0; 3], [0.0; 3], [0.0; 3]);
            for (l, x) in x.iter().enumerate() {
                apart = add(apart, scale(*x, at.values[l]));
                t = add(t, scale(*x, at.gradients[0][l]));
                s = add(s, scale(*x, at.gradients[1][l]));
            }
            (0..3).for_each(|c| apart[c] -= p[c] + distance * n[c]);
            let columns = [t, if shape.space == 2 { [0.0, 0.0, 1.0] } else { s }, n.map(|n| -n)];
            let [a, b, d] = solve(&columns, apart);
            local = [local[0] - a, local[1] - b];
            distance -= d;
            if !(a.is_finite() && b.is_finite()) {
                return None;
            }
            if a.abs().max(b.abs()) < SETTLED {
                return Some(Crossing { local, distance, rows: rows(&columns) });
            }
        }
        None
    }

    /// Writes the shape functions where the straight line through `point` along `direction` meets the surface of a facet with these
    /// nodes; `false`, and nothing written, where it misses the surface. One correction at the solution gives the derivatives.
    pub fn write_along<T: Real>(
        &self,
        shape: &FacetShape,
        nodes: &[[T; 3]],
        point: [T; 3],
        direction: [T; 3],
        out: &mut Nodal<T>,
    ) -> bool {
        let x = Nodal::of(nodes).map(value);
        let Some(found) = self.crossing(shape, &x, value(point), value(direction)) else { return false };
        let at = self.functions(shape, found.local);
        let mut along = [T::zero(); 2];
        if T::DIFFERENTIATES {
            for c in 0..3 {
                let mut apart = -(point[c] + direction[c] * found.distance);
                nodes.iter().zip(at.values.iter()).for_each(|(x, w)| apart.add_scaled(x[c], *w));
                (0..shape.space - 1).for_each(|a| along[a].add_scaled(apart, -found.rows[a][c]));
            }
        }
        out.refill(shape.nodes, |l| {
            let mut own = T::constant(at.values[l]);
            (0..shape.space - 1).for_each(|a| own.add_scaled(along[a], at.gradients[a][l]));
            own
        });
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{LINE_2_APEX, TRIANGLE_3_APEX, combine, interpolate};
    use crate::vector3::{norm, sub};

    /// |X| = R: in the plane a circle.
    const SPHERE: ExactSurface = ExactSurface {
        name: "sphere",
        level: |numbers, x| (norm(x) - numbers[0], scale(x, norm(x).recip())),
        numbers: [2.0, 0.0, 0.0, 0.0],
    };

    fn facet(space: usize) -> (&'static FacetShape, ExactFacet) {
        let corners = [[1.9, 0.2, 0.5], [1.7, 0.9, 0.4], [1.6, 0.5, 0.9]];
        let flat = |x: [f64; 3]| if space == 2 { [x[0], x[1], 0.0] } else { x };
        let facet = ExactFacet { surface: SPHERE, corners: corners.map(flat), apex: flat([0.1, -0.1, 0.2]) };
        (if space == 2 { &LINE_2_APEX } else { &TRIANGLE_3_APEX }, facet)
    }

    fn nodes(shape: &FacetShape, facet: &ExactFacet) -> Nodal<[f64; 3]> {
        shape.nodal(|l| if l < shape.corners { facet.corners[l] } else { facet.apex })
    }

    /// ANALYTIC: points lie on the sphere, shape functions add up to one; to round-off. Derivatives against central differences.
    #[test]
    fn shape_functions_give_points_of_the_surface() {
        for space in [2, 3] {
            let (shape, facet) = facet(space);
            let x = nodes(shape, &facet);
            let local = [0.3, if space == 2 { 0.0 } else { 0.25 }];
            let at = facet.functions(shape, local);
            assert!((norm(combine(&at.values, &x)) - 2.0).abs() < 1e-14);
            assert!((at.values.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for a in 0..space - 1 {
                let moved = |h: f64| {
                    let mut local = local;
                    local[a] += h;
                    facet.functions(shape, local).values
                };
                let (plus, minus) = (moved(1e-5), moved(-1e-5));
                for l in 0..shape.nodes {
                    let slope = (plus[l] - minus[l]) / 2e-5;
                    assert!((slope - at.gradients[a][l]).abs() < 1e-9, "{slope} {}", at.gradients[a][l]);
                }
            }
        }
    }

    /// ANALYTIC: the line along x meets the sphere at x² = R² − y² − z², with the facet where it is or moved as a rigid body. Derivatives
    /// by nodes, point and direction against central differences.
    #[test]
    fn lines_meet_the_surface_and_the_place_moves_with_nodes_and_line() {
        for space in [2, 3] {
            let (shape, facet) = facet(space);
            let base = nodes(shape, &facet);
            let (point, direction) = ([3.0, 0.5, if space == 2 { 0.0 } else { 0.6 }], [-1.1, 0.1, 0.0]);
            let place = |x: &[[f64; 3]], p: [f64; 3], n: [f64; 3]| {
                let mut out = Nodal::empty();
                assert!(facet.write_along(shape, x, p, n, &mut out));
                interpolate(&out, x)
            };
            let found = place(&base, point, direction);
            assert!((norm(found) - 2.0).abs() < 1e-13, "{found:?}");
            let shift = |x: [f64; 3]| add([-x[1], x[0], x[2]], [4.0, 1.0, 0.0]);
            let turn = |x: [f64; 3]| [-x[1], x[0], x[2]];
            let moved = place(&base.map(shift), shift(point), turn(direction));
            assert!(norm(sub(moved, shift(found))) < 1e-13, "{moved:?}");
            let count = shape.nodes;
            for variable in 0..3 * (count + 2) {
                let (at, c) = (variable / 3, variable % 3);
                if c >= space {
                    continue;
                }
                let moved = |h: f64| {
                    let (mut x, mut p, mut n) = (base, point, direction);
                    match at {
                        at if at < count => x[at][c] += h,
                        at if at == count => p[c] += h,
                        _ => n[c] += h,
                    }
                    place(&x, p, n)
                };
                let (plus, minus) = (moved(1e-6), moved(-1e-6));
                let mut x = base.map(|x| x.map(Dual::<1>::constant));
                let (mut p, mut n) = (point.map(Dual::<1>::constant), direction.map(Dual::<1>::constant));
                match at {
                    at if at < count => x[at][c].gradient[0] = 1.0,
                    at if at == count => p[c].gradient[0] = 1.0,
                    _ => n[c].gradient[0] = 1.0,
                }
                let mut out = Nodal::empty();
                assert!(facet.write_along(shape, &x, p, n, &mut out));
                let dual = interpolate(&out, &x);
                for k in 0..space {
                    let slope = (plus[k] - minus[k]) / 2e-6;
                    assert!((slope - dual[k].gradient[0]).abs() < 1e-8, "{variable} {k}: {slope} {dual:?}");
                }
            }
        }
    }
}
