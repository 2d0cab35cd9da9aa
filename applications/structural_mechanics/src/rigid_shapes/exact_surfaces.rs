//! The exact surfaces of turned and extruded lines and arcs, as functions that are zero on them.
//!
//! With r = √(x² + y²): cone n_r r + n_z z = d, of which n_r = 1 is a cylinder about z; torus √((r − R)² + (z − c)²) = ρ; sphere
//! √(x² + y² + (z − c)²) = R; cylinder along z √((x − a)² + (y − b)²) = ρ. Gradients are unit vectors.

use zelus_core::geometry::ExactSurface;

/// Share of a length below which a radius is zero: there the direction of r is taken as zero.
const ON_AXIS: f64 = 1e-14;

/// x/r and y/r, and r.
fn polar(x: [f64; 3]) -> ([f64; 2], f64) {
    let r = x[0].hypot(x[1]);
    if r > ON_AXIS * (1.0 + x[2].abs()) { ([x[0] / r, x[1] / r], r) } else { ([0.0; 2], r) }
}

/// A cone about z with the unit normal (n_r, n_z), at a distance from the origin along it.
pub(super) fn cone(normal: [f64; 2], distance: f64) -> ExactSurface {
    ExactSurface {
        name: "cone",
        level: |&[nr, nz, d, _], x| {
            let ([cos, sin], r) = polar(x);
            (nr * r + nz * x[2] - d, [nr * cos, nr * sin, nz])
        },
        numbers: [normal[0], normal[1], distance, 0.0],
    }
}

/// A torus about z: a circle whose centre is at (r, z).
pub(super) fn torus([r, z]: [f64; 2], radius: f64) -> ExactSurface {
    ExactSurface {
        name: "torus",
        level: |&[centre, height, radius, _], x| {
            let ([cos, sin], r) = polar(x);
            let (across, along) = (r - centre, x[2] - height);
            let size = across.hypot(along);
            (size - radius, [across / size * cos, across / size * sin, along / size])
        },
        numbers: [r, z, radius, 0.0],
    }
}

/// A sphere about a point of the z axis.
pub(super) fn sphere(z: f64, radius: f64) -> ExactSurface {
    ExactSurface {
        name: "sphere",
        level: |&[height, radius, ..], x| {
            let along = x[2] - height;
            let size = x[0].hypot(x[1]).hypot(along);
            (size - radius, [x[0] / size, x[1] / size, along / size])
        },
        numbers: [z, radius, 0.0, 0.0],
    }
}

/// A cylinder along z, in the plane a circle.
pub(super) fn cylinder([x, y]: [f64; 2], radius: f64) -> ExactSurface {
    ExactSurface {
        name: "cylinder",
        level: |&[a, b, radius, _], x| {
            let (across, along) = (x[0] - a, x[1] - b);
            let size = across.hypot(along);
            (size - radius, [across / size, along / size, 0.0])
        },
        numbers: [x, y, radius, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::vector3::norm;

    /// Gradients against central differences, and of unit length.
    #[test]
    fn gradients_match_differences() {
        let all = [cone([0.6, 0.8], 0.3), torus([2.0, 0.4], 0.7), sphere(0.3, 1.5), cylinder([0.2, -0.1], 1.2)];
        for surface in all {
            let x = [0.9, -0.7, 0.6];
            let (_, gradient) = (surface.level)(&surface.numbers, x);
            assert!((norm(gradient) - 1.0).abs() < 1e-14, "{surface:?}");
            for c in 0..3 {
                let at = |h: f64| {
                    let mut x = x;
                    x[c] += h;
                    (surface.level)(&surface.numbers, x).0
                };
                let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!((slope - gradient[c]).abs() < 1e-9, "{surface:?}: {slope} {}", gradient[c]);
            }
        }
    }
}
