//! Vector kernels whose sums are cut at fixed places, so that threads do not change the bits.

use std::ops::AddAssign;

use rayon::prelude::*;

/// Entries summed by one task.
const CHUNK: usize = 1 << 14;

/// A number in single or double precision.
pub trait Number: Copy + Default + Send + Sync + AddAssign + Into<f64> + 'static {
    /// The nearest one to `value`.
    fn from_f64(value: f64) -> Self;

    /// `self + factor x`.
    fn plus(self, factor: Self, x: Self) -> Self;
}

impl Number for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }

    fn plus(self, factor: Self, x: Self) -> Self {
        self + factor * x
    }
}

impl Number for f32 {
    fn from_f64(value: f64) -> Self {
        value as Self
    }

    fn plus(self, factor: Self, x: Self) -> Self {
        self + factor * x
    }
}

/// Inner product of `a` and `b`, summed in double precision.
///
/// # Panics
/// When the lengths differ.
pub fn dot<T: Number>(a: &[T], b: &[T]) -> f64 {
    assert_eq!(a.len(), b.len(), "vectors of one length");
    if a.len() <= CHUNK {
        return dot_chunk(a, b);
    }
    let partial: Vec<f64> = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(|(a, b)| dot_chunk(a, b)).collect();
    partial.iter().sum()
}

/// Eight running sums, which the compiler keeps in vector registers.
fn dot_chunk<T: Number>(a: &[T], b: &[T]) -> f64 {
    let mut sums = [0.0; 8];
    let (a_blocks, b_blocks) = (a.chunks_exact(8), b.chunks_exact(8));
    let tail: f64 = a_blocks.remainder().iter().zip(b_blocks.remainder()).map(|(&a, &b)| a.into() * b.into()).sum();
    for (a, b) in a_blocks.zip(b_blocks) {
        for lane in 0..8 {
            sums[lane] += a[lane].into() * b[lane].into();
        }
    }
    sums.iter().sum::<f64>() + tail
}

/// Euclidean norm of `a`; not a number when an entry is not finite.
pub fn norm<T: Number>(a: &[T]) -> f64 {
    let plain = dot(a, a);
    if plain.is_finite() && plain > 1e-290 {
        return plain.sqrt();
    }
    let values = || a.iter().map(|&x| -> f64 { x.into() });
    let largest = values().fold(0.0_f64, |m, x| if x.is_finite() { m.max(x.abs()) } else { f64::NAN });
    if largest == 0.0 || largest.is_nan() {
        return largest;
    }
    let scaled: f64 = values().map(|x| (x / largest).powi(2)).sum();
    largest * scaled.sqrt()
}

/// `y += factor * x`.
///
/// # Panics
/// When the lengths differ.
pub fn add_scaled<T: Number>(factor: f64, x: &[T], y: &mut [T]) {
    assert_eq!(x.len(), y.len(), "vectors of one length");
    let factor = T::from_f64(factor);
    y.par_iter_mut().zip(x).with_min_len(CHUNK).for_each(|(y, &x)| *y = y.plus(factor, x));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_survive_extremes() {
        assert!((norm(&[3e200, 4e200]) / 5e200 - 1.0).abs() < 1e-15);
        assert!((norm(&[3e-200, 4e-200]) / 5e-200 - 1.0).abs() < 1e-15);
        assert_eq!(norm::<f64>(&[]), 0.0);
        assert!(norm(&[f64::NAN, 1.0]).is_nan());
    }
}
