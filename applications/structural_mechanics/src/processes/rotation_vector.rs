//! Rotation by a rotation vector θ: R = exp [θ]×, and the spin δω = T δθ of a change of θ.
//!
//! R = I + sin t/t [θ]× + (1 − cos t)/t² [θ]×², T = I + (1 − cos t)/t² [θ]× + (t − sin t)/t³ [θ]×², with t = |θ|. A rotated arm R r
//! changes by δω × R r.

use zelus_core::vector3::{add, cross, dot, scale};

/// Angle below which series are exact to round-off.
const SMALL: f64 = 1e-3;

/// sin t/t, (1 − cos t)/t², (t − sin t)/t³.
fn factors(theta: [f64; 3]) -> [f64; 3] {
    let square = dot(theta, theta);
    if square < SMALL * SMALL {
        let [one, two] = [square, square * square];
        return [1.0 - one / 6.0 + two / 120.0, 0.5 - one / 24.0 + two / 720.0, 1.0 / 6.0 - one / 120.0 + two / 5040.0];
    }
    let t = square.sqrt();
    [t.sin() / t, 2.0 * (0.5 * t).sin().powi(2) / square, (t - t.sin()) / (square * t)]
}

/// a v + b θ × v + c θ × (θ × v).
fn series(theta: [f64; 3], v: [f64; 3], b: f64, c: f64) -> [f64; 3] {
    let first = cross(theta, v);
    add(v, add(scale(first, b), scale(cross(theta, first), c)))
}

/// R v.
pub(super) fn rotated(theta: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    let [sine, cosine, _] = factors(theta);
    series(theta, v, sine, cosine)
}

/// T v.
pub(super) fn spin(theta: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    let [_, cosine, sine] = factors(theta);
    series(theta, v, cosine, sine)
}

#[cfg(test)]
mod tests {
    use zelus_core::vector3::{norm, sub};

    use super::*;

    #[test]
    fn rotations_keep_lengths_and_follow_their_vector() {
        let half = rotated([0.0, 0.0, std::f64::consts::FRAC_PI_2], [2.0, 0.0, 1.0]);
        assert!(norm(sub(half, [0.0, 2.0, 1.0])) < 1e-15, "{half:?}");
        for size in [1e-8, 0.9 * SMALL, 1.1 * SMALL, 0.7, 3.0, 6.0] {
            let theta = scale([2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], size);
            let v = [0.3, -1.1, 0.7];
            assert!((norm(rotated(theta, v)) - norm(v)).abs() < 1e-15 * 4.0);
            let turned = rotated(scale(theta, -1.0), rotated(theta, v));
            assert!(norm(sub(turned, v)) < 1e-14, "{turned:?}");
        }
    }

    /// The change of a rotated arm against differences of fourth order.
    #[test]
    fn spins_are_derivatives() {
        let v = [0.3, -1.1, 0.7];
        for size in [0.0, 0.9 * SMALL, 1.1 * SMALL, 0.7, 3.0, 6.0] {
            let theta = scale([2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], size);
            for c in 0..3 {
                let way: [f64; 3] = std::array::from_fn(|d| f64::from(u8::from(c == d)));
                let at = |h: f64| rotated(add(theta, scale(way, h)), v);
                let pair = |h: f64| scale(sub(at(h), at(-h)), 0.5 / h);
                let h = 1e-3;
                let difference = sub(scale(pair(h), 4.0 / 3.0), scale(pair(2.0 * h), 1.0 / 3.0));
                let exact = cross(spin(theta, way), rotated(theta, v));
                assert!(norm(sub(difference, exact)) < 1e-11, "{size} {c}: {difference:?} {exact:?}");
            }
        }
    }
}
