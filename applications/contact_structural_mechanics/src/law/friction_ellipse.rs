//! Friction whose coefficient depends on the direction: the ellipse of its limit, and the plane in which that is a circle.
//!
//! With the unit vector a and the ratio ρ of the coefficients across and along it, D = ρ² I + (1 − ρ²) a⊗a. Tractions r at the limit b
//! obey r·D⁻¹ r = b², the ellipse with the half axes b and ρ b, and the slip s is normal to it (associated rule), s ∥ D⁻¹ r. In the plane
//! of r̂ = D^(−1/2) r and ŝ = D^(1/2) s both are those of isotropic friction: |r̂| = b, ŝ ∥ r̂, and r̂·ŝ = r·s.
//!
//! Where a is not in the surface, D is P D P with the projection P on the tangent plane.

use zelus_core::scalar::Real;
use zelus_core::vector3::{constant, dot, norm, scale, value};

use crate::mortar::tangential;

/// The ellipse of friction; the default is a circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionEllipse {
    /// Unit vector a.
    pub direction: [f64; 3],
    /// Ratio ρ > 0 of the coefficients across the direction and along it.
    pub ratio: f64,
}

impl Default for FrictionEllipse {
    fn default() -> Self {
        Self { direction: [1.0, 0.0, 0.0], ratio: 1.0 }
    }
}

impl FrictionEllipse {
    /// Whether friction is the same in all directions.
    pub fn is_circle(&self) -> bool {
        self.ratio == 1.0
    }

    /// D v, tangential where the surface has a in it.
    pub fn product<T: Real>(&self, v: [T; 3]) -> [T; 3] {
        let square = self.ratio * self.ratio;
        let along = self.along(v) * (1.0 - square);
        std::array::from_fn(|c| v[c] * square + along * self.direction[c])
    }

    /// v·D v.
    pub fn square<T: Real>(&self, v: [T; 3]) -> T {
        let square = self.ratio * self.ratio;
        let along = self.along(v);
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * square + along * along * (1.0 - square)
    }

    /// D^(1/2) v of a tangential vector: a slip in the plane of the circle, or a traction out of it.
    pub fn root<T: Real>(&self, v: [T; 3], normal: [T; 3]) -> [T; 3] {
        if self.is_circle() { v } else { self.stretched(v, normal, |half_axis| half_axis) }
    }

    /// D^(−1/2) v of a tangential vector: a traction in the plane of the circle.
    pub fn inverse_root<T: Real>(&self, v: [T; 3], normal: [T; 3]) -> [T; 3] {
        if self.is_circle() { v } else { self.stretched(v, normal, T::recip) }
    }

    fn along<T: Real>(&self, v: [T; 3]) -> T {
        v[0] * self.direction[0] + v[1] * self.direction[1] + v[2] * self.direction[2]
    }

    /// A tangential vector with its parts along the half axes in this tangent plane times a function of them.
    fn stretched<T: Real>(&self, v: [T; 3], normal: [T; 3], by: impl Fn(T) -> T) -> [T; 3] {
        let projected = tangential(constant(self.direction), normal);
        let across = by(T::constant(self.ratio));
        if norm(value(projected)) <= f64::EPSILON {
            return scale(v, across);
        }
        let size = norm(projected);
        let axis = scale(projected, size.recip());
        let square = self.ratio * self.ratio;
        let further = by((size * size * (1.0 - square) + square).sqrt()) - across;
        let along = dot(v, axis) * further;
        std::array::from_fn(|c| v[c] * across + axis[c] * along)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::vector3::sub;

    /// ANALYTIC: the roots are those of P D P, whatever the angle of a to the surface.
    #[test]
    fn roots_are_those_of_the_projected_matrix() {
        let normal = [0.0, 0.0, 1.0];
        for direction in [[0.6, 0.8, 0.0], [0.48, 0.64, 0.6], [0.0, 0.0, 1.0]] {
            let ellipse = FrictionEllipse { direction, ratio: 0.4 };
            let v = [0.3, -0.7, 0.0];
            let twice = ellipse.root(ellipse.root(v, normal), normal);
            let right = tangential(ellipse.product(v), normal);
            assert!(norm(sub(twice, right)) < 1e-15, "{direction:?}: {twice:?} {right:?}");
            assert!((dot(v, right) - ellipse.square(v)).abs() < 1e-15);
            assert!(norm(sub(ellipse.inverse_root(ellipse.root(v, normal), normal), v)) < 1e-15);
        }
    }

    /// ANALYTIC: slip at the angle θ to a has the traction b (cos θ, ρ² sin θ)/√(cos² θ + ρ² sin² θ).
    #[test]
    fn slip_is_normal_to_the_ellipse() {
        let (normal, bound, ratio) = ([0.0, 0.0, 1.0], 3.0, 0.5);
        let ellipse = FrictionEllipse { direction: [1.0, 0.0, 0.0], ratio };
        for angle in [0.0, 0.4, 1.3, 2.0_f64] {
            let (sin, cos) = angle.sin_cos();
            let circle = ellipse.root([cos, sin, 0.0], normal);
            let traction = ellipse.root(scale(circle, bound / norm(circle)), normal);
            let size = (cos * cos + ratio * ratio * sin * sin).sqrt();
            let right = [bound * cos / size, bound * ratio * ratio * sin / size, 0.0];
            assert!(norm(sub(traction, right)) < 1e-14, "{angle}: {traction:?} {right:?}");
        }
    }
}
