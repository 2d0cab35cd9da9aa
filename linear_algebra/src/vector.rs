//! Vector kernels whose sums are cut at fixed places, so that threads do not change the bits.

use rayon::prelude::*;

/// Entries summed by one task.
const CHUNK: usize = 1 << 14;

/// Inner product of `a` and `b`.
///
/// # Panics
/// When the lengths differ.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "vectors of one length");
    if a.len() <= CHUNK {
        return dot_chunk(a, b);
    }
    let partial: Vec<f64> = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(|(a, b)| dot_chunk(a, b)).collect();
    partial.iter().sum()
}

/// Eight running sums, which the compiler keeps in vector registers.
fn dot_chunk(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a_blocks, b_blocks) = (a.chunks_exact(8), b.chunks_exact(8));
    let tail: f64 = a_blocks.remainder().iter().zip(b_blocks.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a_blocks.zip(b_blocks) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + tail
}

/// Euclidean norm of `a`; not a number when an entry is not finite.
pub fn norm(a: &[f64]) -> f64 {
    let plain = dot(a, a);
    if plain.is_finite() && plain > 1e-290 {
        return plain.sqrt();
    }
    let largest = a.iter().fold(0.0_f64, |m, x| if x.is_finite() { m.max(x.abs()) } else { f64::NAN });
    if largest == 0.0 || largest.is_nan() {
        return largest;
    }
    let scaled: f64 = a.iter().map(|x| (x / largest).powi(2)).sum();
    largest * scaled.sqrt()
}

/// `y += factor * x`.
///
/// # Panics
/// When the lengths differ.
pub fn add_scaled(factor: f64, x: &[f64], y: &mut [f64]) {
    assert_eq!(x.len(), y.len(), "vectors of one length");
    y.par_iter_mut().zip(x).with_min_len(CHUNK).for_each(|(y, x)| *y += factor * x);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_survive_extremes() {
        assert!((norm(&[3e200, 4e200]) / 5e200 - 1.0).abs() < 1e-15);
        assert!((norm(&[3e-200, 4e-200]) / 5e-200 - 1.0).abs() < 1e-15);
        assert_eq!(norm(&[]), 0.0);
        assert!(norm(&[f64::NAN, 1.0]).is_nan());
    }
}
