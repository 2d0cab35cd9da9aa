//! Shape functions of the facets, told apart by their node count, and the closest point on a facet.
//!
//! Two nodes: line, ξ ∈ [−1, 1]. Three: triangle, corners (0,0), (1,0), (0,1). Four: quadrilateral, ξ, η ∈ [−1, 1].

use zelus_core::scalar::Real;
use zelus_core::vector3::{cross, dot, normalised, sub, value};

/// Local coordinates of the nodes of a quadrilateral.
const QUAD_CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
/// Newton steps of the closest-point search; it is quadratic, three or four are the rule.
const MAX_STEPS: usize = 25;

/// Shape functions at a local point.
#[inline]
pub fn values<T: Real, const N: usize>(xi: [T; 2]) -> [T; N] {
    let mut shape = [T::zero(); N];
    match N {
        2 => {
            shape[0] = (-xi[0] + 1.0) * 0.5;
            shape[1] = (xi[0] + 1.0) * 0.5;
        }
        3 => {
            shape[0] = -(xi[0] + xi[1]) + 1.0;
            shape[1] = xi[0];
            shape[2] = xi[1];
        }
        4 => {
            let product = xi[0] * xi[1];
            for (n, [a, b]) in QUAD_CORNERS.iter().enumerate() {
                shape[n] = T::constant(0.25);
                shape[n].add_scaled(xi[0], 0.25 * a);
                shape[n].add_scaled(xi[1], 0.25 * b);
                shape[n].add_scaled(product, 0.25 * a * b);
            }
        }
        _ => unreachable!("facets have two, three or four nodes"),
    }
    shape
}

/// Derivatives of the shape functions by ξ and η at a local point; a line has no η.
#[inline]
pub fn gradients<const N: usize>(xi: [f64; 2]) -> [[f64; 2]; N] {
    let mut gradient = [[0.0; 2]; N];
    match N {
        2 => {
            gradient[0][0] = -0.5;
            gradient[1][0] = 0.5;
        }
        3 => {
            gradient[0] = [-1.0, -1.0];
            gradient[1] = [1.0, 0.0];
            gradient[2] = [0.0, 1.0];
        }
        4 => {
            for (n, [a, b]) in QUAD_CORNERS.iter().enumerate() {
                gradient[n] = [0.25 * a * (1.0 + b * xi[1]), 0.25 * b * (1.0 + a * xi[0])];
            }
        }
        _ => unreachable!("facets have two, three or four nodes"),
    }
    gradient
}

/// Local coordinates of node `n` of a facet with `N` nodes.
#[inline]
pub fn corner<const N: usize>(n: usize) -> [f64; 2] {
    match N {
        2 => [[-1.0, 0.0], [1.0, 0.0]][n],
        3 => [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]][n],
        _ => QUAD_CORNERS[n],
    }
}

/// Local coordinates of a point inside a facet with `N` nodes, one near each node `n`: those of the Gauss rule with as many.
#[inline]
pub fn inner_point<const N: usize>(n: usize) -> [f64; 2] {
    let corner = corner::<N>(n);
    if N == 3 { corner.map(|x| 0.5 * x + 1.0 / 6.0) } else { corner.map(|x| x / 3.0_f64.sqrt()) }
}

/// The functions of the facet's space that are one at one of its [`inner_point`]s and zero at the others.
#[inline]
pub fn inner_values<T: Real, const N: usize>(xi: [T; 2]) -> [T; N] {
    values(if N == 3 { xi.map(|x| x * 2.0 - 1.0 / 3.0) } else { xi.map(|x| x * 3.0_f64.sqrt()) })
}

/// Length or area of a facet by its local coordinates at a local point.
pub fn density<T: Real, const N: usize>(nodes: &[[T; 3]; N], xi: [f64; 2]) -> T {
    let gradient = gradients::<N>(xi);
    let along = |c: usize| combine(&gradient.map(|g| g[c]), nodes);
    zelus_core::vector3::norm(if N == 2 { along(0) } else { cross(along(0), along(1)) })
}

/// Local coordinates of the centre of a facet with `N` nodes.
#[inline]
pub fn centre<const N: usize>() -> [f64; 2] {
    if N == 3 { [1.0 / 3.0, 1.0 / 3.0] } else { [0.0, 0.0] }
}

/// The combination Σ Nᵢ vᵢ of nodal vectors.
#[inline]
pub fn interpolate<T: Real, const N: usize, const C: usize>(shape: &[T; N], nodal: &[[T; C]; N]) -> [T; C] {
    let mut sum = [T::zero(); C];
    for n in 0..N {
        for c in 0..C {
            sum[c].add_product(shape[n], nodal[n][c]);
        }
    }
    sum
}

/// The combination Σ wᵢ vᵢ of nodal vectors with plain weights.
#[inline]
pub fn combine<T: Real, const N: usize, const C: usize>(weights: &[f64; N], nodal: &[[T; C]; N]) -> [T; C] {
    let mut sum = [T::zero(); C];
    for n in 0..N {
        for c in 0..C {
            sum[c].add_scaled(nodal[n][c], weights[n]);
        }
    }
    sum
}

/// Unit normal of a facet at a local point.
/// A line a→b in the plane has (t_y, −t_x); a surface has the vector product of its tangents.
pub fn unit_normal<T: Real, const N: usize>(nodes: &[[T; 3]; N], xi: [f64; 2]) -> [T; 3] {
    if N == 2 {
        let t = sub(nodes[1], nodes[0]);
        return normalised([t[1], -t[0], T::zero()]);
    }
    let gradient = gradients::<N>(xi);
    let along = |c: usize| combine(&gradient.map(|g| g[c]), nodes);
    normalised(cross(along(0), along(1)))
}

/// Length of a line, or area of a surface taken at its centre for quadrilaterals.
pub fn measure<const N: usize>(nodes: &[[f64; 3]; N]) -> f64 {
    match N {
        2 => norm(sub(nodes[1], nodes[0])),
        3 => 0.5 * norm(cross(sub(nodes[1], nodes[0]), sub(nodes[2], nodes[0]))),
        _ => 0.5 * norm(cross(sub(nodes[2], nodes[0]), sub(nodes[3], nodes[1]))),
    }
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Local coordinates of the point of a facet closest to `point`, which need not lie on it.
///
/// The search runs on values; one correction with the inverse Hessian at the solution then gives the exact derivative
/// (implicit function theorem on `∂ₐx·(x(ξ) − p) = 0`).
pub fn closest_point<T: Real, const N: usize>(nodes: &[[T; 3]; N], point: [T; 3], guess: [f64; 2]) -> [T; 2] {
    let x = nodes.map(value);
    let p = value(point);
    let mut xi = guess;
    let mut state = Tangents::new(&x, p, xi);
    for _ in 0..MAX_STEPS {
        let step = state.solve([dot(state.tangent[0], state.gap), dot(state.tangent[1], state.gap)]);
        xi = [xi[0] - step[0], xi[1] - step[1]];
        state = Tangents::new(&x, p, xi);
        if step[0].abs().max(step[1].abs()) < 1e-13 {
            break;
        }
    }
    let gap = sub(combine(&values::<f64, N>(xi), nodes), point);
    let mut residual = [T::zero(); 2];
    for a in 0..2 {
        for c in 0..3 {
            residual[a].add_scaled(gap[c], state.tangent[a][c]);
        }
    }
    // The turning of the tangents matters only for a point off the facet.
    if dot(state.gap, state.gap) > 1e-24 * dot(state.tangent[0], state.tangent[0]) {
        let gradient = gradients::<N>(xi);
        for a in 0..2 {
            for c in 0..3 {
                for n in 0..N {
                    residual[a].add_scaled(nodes[n][c] - x[n][c], gradient[n][a] * state.gap[c]);
                }
            }
        }
    }
    let inverse = [state.solve([1.0, 0.0]), state.solve([0.0, 1.0])];
    let mut local = xi.map(T::constant);
    for a in 0..2 {
        local[a].add_scaled(residual[0], -inverse[0][a]);
        local[a].add_scaled(residual[1], -inverse[1][a]);
    }
    local
}

/// First and second derivatives of half the squared distance, at one local point.
struct Tangents {
    tangent: [[f64; 3]; 2],
    gap: [f64; 3],
    hessian: [f64; 3],
}

impl Tangents {
    #[inline]
    fn new<const N: usize>(x: &[[f64; 3]; N], p: [f64; 3], xi: [f64; 2]) -> Self {
        let gap = sub(combine(&values::<f64, N>(xi), x), p);
        let gradient = gradients::<N>(xi);
        let tangent = [combine(&gradient.map(|g| g[0]), x), combine(&gradient.map(|g| g[1]), x)];
        let (first, mut last) = (dot(tangent[0], tangent[0]), dot(tangent[1], tangent[1]));
        let mut mixed = dot(tangent[0], tangent[1]);
        if N == 2 {
            last = first;
        }
        if N == 4 {
            let twist = combine(&[0.25, -0.25, 0.25, -0.25], &[x[0], x[1], x[2], x[N - 1]]);
            let full = mixed + dot(gap, twist);
            // Far off a warped facet the distance need not be convex; then the Gauss–Newton matrix leads back.
            if first * last - full * full > 1e-3 * (first * last - mixed * mixed) {
                mixed = full;
            }
        }
        Self { tangent, gap, hessian: [first, mixed, last] }
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
    use zelus_core::scalar::Dual;

    fn round_trip<const N: usize>(nodes: [[f64; 3]; N], xi: [f64; 2]) {
        let point = combine(&values::<f64, N>(xi), &nodes);
        let found = closest_point(&nodes, point, centre::<N>());
        assert!((found[0] - xi[0]).abs() < 1e-14 && (found[1] - xi[1]).abs() < 1e-14, "{found:?} {xi:?}");
    }

    #[test]
    fn closest_point_inverts_the_map() {
        round_trip([[0.1, 0.2, 0.0], [1.3, -0.4, 0.0]], [0.37, 0.0]);
        round_trip([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.1, 1.0, -0.3]], [0.2, 0.5]);
        round_trip([[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [1.2, 1.1, -0.3], [-0.1, 0.9, 0.1]], [-0.7, 0.4]);
    }

    #[test]
    fn inner_functions_are_one_at_their_points() {
        fn check<const N: usize>() {
            for g in 0..N {
                let found: [f64; N] = inner_values(inner_point::<N>(g));
                assert!((0..N).all(|k| (found[k] - f64::from(u8::from(k == g))).abs() < 1e-14), "{found:?}");
            }
        }
        check::<2>();
        check::<3>();
        check::<4>();
    }

    #[test]
    fn derivative_of_a_point_off_a_warped_facet() {
        let nodes = [[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [1.2, 1.1, -0.1], [-0.1, 0.9, 0.1]];
        let point = [0.45, 0.6, 0.3];
        let dual = closest_point(
            &std::array::from_fn::<_, 4, _>(|n| std::array::from_fn(|c| Dual::<15>::variable(nodes[n][c], 3 * n + c))),
            std::array::from_fn(|c| Dual::variable(point[c], 12 + c)),
            [0.0; 2],
        );
        for variable in 0..15 {
            let at = |h: f64| {
                let (mut nodes, mut point) = (nodes, point);
                if variable < 12 {
                    nodes[variable / 3][variable % 3] += h;
                } else {
                    point[variable - 12] += h;
                }
                closest_point(&nodes, point, [0.0; 2])
            };
            let (plus, minus) = (at(1e-6), at(-1e-6));
            for a in 0..2 {
                let slope = (plus[a] - minus[a]) / 2e-6;
                assert!((slope - dual[a].gradient[variable]).abs() < 1e-8, "{slope} {}", dual[a].gradient[variable]);
            }
        }
    }
}
