//! Rotation by a rotation vector θ: R = exp [θ]×, and the spin δω = T δθ of a change of θ.
//!
//! R = I + sin t/t [θ]× + (1 − cos t)/t² [θ]×², T = I + (1 − cos t)/t² [θ]× + (t − sin t)/t³ [θ]×², with t = |θ|. A rotated arm R r
//! changes by δω × R r.
//!
//! T is singular where t = 2π. Beyond half a turn the shorter vector θ (1 − 2π/t) states the same rotation.

use std::f64::consts::{PI, TAU};

use zelus_core::vector3::{add, cross, dot, norm, scale, sub};

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

/// T⁻¹ v = v − θ × v/2 + c θ × (θ × v) with c = (1 − t/2 cot (t/2))/t²; t is below 2π.
pub(super) fn unspin(theta: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    let square = dot(theta, theta);
    let half = 0.5 * square.sqrt();
    let c = if square < SMALL * SMALL { 1.0 / 12.0 + square / 720.0 } else { (1.0 - half / half.tan()) / square };
    series(theta, v, -0.5, c)
}

/// Ṫ v along θ̇ = v: the part of the angular acceleration T θ̈ + Ṫ θ̇ that the rate v gives.
pub(super) fn spin_rate(theta: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    let square = dot(theta, theta);
    let [sine, b, c] = factors(theta);
    let [b_rate, c_rate] = match square < SMALL * SMALL {
        true => [square / 180.0 - 1.0 / 12.0, square / 1260.0 - 1.0 / 60.0],
        false => [(sine - 2.0 * b) / square, (b - 3.0 * c) / square],
    };
    let along = dot(theta, v);
    let first = cross(theta, v);
    let second = cross(theta, first);
    add(add(scale(first, b_rate * along), scale(second, c_rate * along)), scale(cross(v, first), c))
}

/// The same rotation by a vector of half a turn at most.
pub(super) fn within_half_turn(theta: [f64; 3]) -> [f64; 3] {
    let t = norm(theta);
    let turns = ((t - PI) / TAU).ceil().max(0.0);
    if turns > 0.0 { scale(theta, 1.0 - turns * TAU / t) } else { theta }
}

/// The rotation vector of a matrix that is the next to one given: of half a turn, or beyond it by less than another.
pub(super) fn vector_of(rotation: &[[f64; 3]; 3], next_to: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = rotation;
    let twice = [z[1] - y[2], x[2] - z[0], y[0] - x[1]];
    let (sine, cosine) = (0.5 * norm(twice), 0.5 * (x[0] + y[1] + z[2] - 1.0));
    let t = sine.atan2(cosine);
    let axis = if sine > SMALL || cosine > 0.0 {
        let factor = if t < SMALL { 1.0 + t * t / 6.0 } else { t / sine };
        scale(twice, 0.5 * factor)
    } else {
        // Near half a turn R + Rᵀ gives the axis, and the sine its direction.
        let row = (0..3).fold(0, |most, k| if rotation[k][k] > rotation[most][most] { k } else { most });
        let whole = |c: usize| 0.5 * (rotation[row][c] + rotation[c][row]) - if c == row { cosine } else { 0.0 };
        let axis: [f64; 3] = std::array::from_fn(whole);
        scale(axis, t.copysign(dot(axis, twice)) / norm(axis))
    };
    let t = norm(axis);
    let other = if t > 0.0 { scale(axis, 1.0 - TAU / t) } else { axis };
    let distance = |theta: [f64; 3]| norm(sub(theta, next_to));
    if distance(other) < distance(axis) { other } else { axis }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES: [f64; 8] = [0.0, 1e-8, 0.9 * SMALL, 1.1 * SMALL, 0.7, 3.0, 3.1411, 6.0];

    fn along_axis(size: f64) -> [f64; 3] {
        scale([2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], size)
    }

    /// T⁻¹ T v = v, and the rate of T v along v against differences of fourth order.
    #[test]
    fn spins_are_inverted_and_differentiated() {
        let v = [0.3, -1.1, 0.7];
        for size in SIZES {
            let theta = along_axis(size);
            let back = unspin(theta, spin(theta, v));
            assert!(norm(sub(back, v)) < 1e-13, "{size}: {back:?}");
            let at = |h: f64| spin(add(theta, scale(v, h)), v);
            let pair = |h: f64| scale(sub(at(h), at(-h)), 0.5 / h);
            let difference = sub(scale(pair(1e-3), 4.0 / 3.0), scale(pair(2e-3), 1.0 / 3.0));
            let exact = spin_rate(theta, v);
            assert!(norm(sub(difference, exact)) < 1e-10, "{size}: {difference:?} {exact:?}");
        }
    }

    /// The vector of a rotation matrix is the one that gave it, within half a turn and beyond, and the shorter one rotates alike.
    #[test]
    fn vectors_are_found_from_rotations() {
        let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for size in SIZES {
            for theta in [along_axis(size), scale(along_axis(size), -1.0), [0.0, size, 0.0]] {
                let columns = unit.map(|axis| rotated(theta, axis));
                let rows: [[f64; 3]; 3] = std::array::from_fn(|r| columns.map(|column| column[r]));
                let found = vector_of(&rows, theta);
                assert!(norm(sub(found, theta)) < 1e-12, "{size}: {found:?} {theta:?}");
                let short = within_half_turn(theta);
                assert!(
                    norm(short) <= PI
                        && norm(sub(rotated(short, [0.3, -1.1, 0.7]), rotated(theta, [0.3, -1.1, 0.7]))) < 1e-14
                );
            }
        }
        assert!((norm(within_half_turn([0.0, 0.0, 7.5 * PI])) - 0.5 * PI).abs() < 1e-13);
    }

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
