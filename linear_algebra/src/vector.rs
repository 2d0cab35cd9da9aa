//! Vector kernels whose sums are cut at fixed places, so that threads do not change the bits.

use std::ops::AddAssign;

use crate::parallel;

/// Entries of one task.
pub(crate) const CHUNK: usize = 1 << 14;

/// `n` zeros, written by all threads. Addition to memory that nothing has written yet makes the system map it twice, and all processors
/// wait for each other.
pub fn zeros<T: Scalar>(n: usize) -> Vec<T> {
    let mut out = vec![T::default(); n];
    if n > CHUNK {
        clear(&mut out);
    }
    out
}

/// Sets all numbers to zero.
pub fn clear<T: Scalar>(values: &mut [T]) {
    parallel::parts_mut(values, CHUNK, &|_, chunk| chunk.fill(T::default()));
}

/// A copy, written by all threads.
pub fn copied<T: Copy + Send + Sync>(values: &[T]) -> Vec<T> {
    parallel::copied(values, CHUNK)
}

/// Copies all numbers, by all threads.
///
/// # Panics
/// When the lengths differ.
pub fn copy<T: Scalar>(from: &[T], to: &mut [T]) {
    assert_eq!(from.len(), to.len(), "vectors of one length");
    parallel::parts_mut(to, CHUNK, &|first, to| to.copy_from_slice(&from[first..][..to.len()]));
}

/// Gives a vector `n` entries, zeros where it had not as much room; its memory is then written by all threads.
pub(crate) fn set_length<T: Scalar>(values: &mut Vec<T>, n: usize) {
    match values.capacity() < n {
        true => *values = zeros(n),
        false => values.resize(n, T::default()),
    }
}

/// A number in single or double precision.
pub trait Scalar: Copy + Default + Send + Sync + AddAssign + Into<f64> + 'static {
    /// The nearest one to `value`.
    fn from_f64(value: f64) -> Self;

    /// `self + factor x`.
    fn plus(self, factor: Self, x: Self) -> Self;
}

impl Scalar for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }

    fn plus(self, factor: Self, x: Self) -> Self {
        self + factor * x
    }
}

impl Scalar for f32 {
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
pub fn dot<T: Scalar>(a: &[T], b: &[T]) -> f64 {
    assert_eq!(a.len(), b.len(), "vectors of one length");
    if a.len() <= CHUNK {
        return dot_chunk(a, b);
    }
    parallel::of_ranges(a.len(), CHUNK, &|own| dot_chunk(&a[own.clone()], &b[own])).iter().sum()
}

/// Eight running sums, which the compiler keeps in vector registers.
fn dot_chunk<T: Scalar>(a: &[T], b: &[T]) -> f64 {
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
pub fn norm<T: Scalar>(a: &[T]) -> f64 {
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

/// Inner products of each of `basis` with `vector`, summed in double precision.
///
/// # Panics
/// When the lengths differ.
pub fn products<T: Scalar>(basis: &[Vec<T>], vector: &[T]) -> Vec<f64> {
    let partial: Vec<Vec<f64>> = parallel::map(vector.len().div_ceil(CHUNK), 1, |at| {
        let own = at * CHUNK..((at + 1) * CHUNK).min(vector.len());
        basis.iter().map(|v| dot_chunk(&v[own.clone()], &vector[own.clone()])).collect()
    });
    (0..basis.len()).map(|k| partial.iter().map(|of_chunk| of_chunk[k]).sum()).collect()
}

/// `vector -= Σ_k sizes[k] basis[k]`.
///
/// # Panics
/// When the lengths differ.
pub fn subtract_combination<T: Scalar>(basis: &[Vec<T>], sizes: &[f64], vector: &mut [T]) {
    parallel::parts_mut(vector, CHUNK, &|first, chunk| {
        for (v, size) in basis.iter().zip(sizes) {
            let (factor, v) = (T::from_f64(-size), &v[first..][..chunk.len()]);
            chunk.iter_mut().zip(v).for_each(|(y, &x)| *y = y.plus(factor, x));
        }
    });
}

/// `x_i *= factors_i`.
///
/// # Panics
/// When the lengths differ.
pub fn scale_each(factors: &[f64], x: &mut [f64]) {
    assert_eq!(x.len(), factors.len(), "vectors of one length");
    parallel::parts_mut(x, CHUNK, &|first, x| x.iter_mut().zip(&factors[first..]).for_each(|(x, factor)| *x *= factor));
}

/// `x_i /= factors_i`.
///
/// # Panics
/// When the lengths differ.
pub fn divide_each(factors: &[f64], x: &mut [f64]) {
    assert_eq!(x.len(), factors.len(), "vectors of one length");
    parallel::parts_mut(x, CHUNK, &|first, x| x.iter_mut().zip(&factors[first..]).for_each(|(x, factor)| *x /= factor));
}

/// `x *= factor`.
pub fn scale_by<T: Scalar>(factor: f64, x: &mut [T]) {
    parallel::parts_mut(x, CHUNK, &|_, x| x.iter_mut().for_each(|x| *x = T::from_f64((*x).into() * factor)));
}

/// `y = factor * x`.
///
/// # Panics
/// When the lengths differ.
pub fn scale_to<T: Scalar>(factor: f64, x: &[T], y: &mut [T]) {
    assert_eq!(x.len(), y.len(), "vectors of one length");
    parallel::parts_mut(y, CHUNK, &|first, y| {
        y.iter_mut().zip(&x[first..]).for_each(|(y, &x)| *y = T::from_f64(x.into() * factor));
    });
}

/// `y += factor * x`.
///
/// # Panics
/// When the lengths differ.
pub fn add_scaled<T: Scalar>(factor: f64, x: &[T], y: &mut [T]) {
    assert_eq!(x.len(), y.len(), "vectors of one length");
    let factor = T::from_f64(factor);
    parallel::parts_mut(y, CHUNK, &|first, y| {
        y.iter_mut().zip(&x[first..]).for_each(|(y, &x)| *y = y.plus(factor, x));
    });
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
