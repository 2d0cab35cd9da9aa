//! Vectors of three components over any [`Real`]; planar problems leave the third at zero.

use crate::scalar::Real;

/// `a + b`.
#[inline]
pub fn add<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`.
#[inline]
pub fn sub<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `factor * a`.
#[inline]
pub fn scale<T: Real>(a: [T; 3], factor: T) -> [T; 3] {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}

/// Scalar product.
#[inline]
pub fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    let mut sum = a[0] * b[0];
    sum.add_product(a[1], b[1]);
    sum.add_product(a[2], b[2]);
    sum
}

/// Vector product, right-handed.
#[inline]
pub fn cross<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Euclidean length.
#[inline]
pub fn norm<T: Real>(a: [T; 3]) -> T {
    dot(a, a).sqrt()
}

/// `a` divided by its length; not finite for the zero vector.
#[inline]
pub fn normalised<T: Real>(a: [T; 3]) -> [T; 3] {
    scale(a, norm(a).recip())
}

/// The vector as constants of another scalar.
#[inline]
pub fn constant<T: Real>(a: [f64; 3]) -> [T; 3] {
    a.map(T::constant)
}

/// The vector without derivatives.
#[inline]
pub fn value<T: Real>(a: [T; 3]) -> [f64; 3] {
    a.map(T::value)
}
