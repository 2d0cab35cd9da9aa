//! Solves in single precision for right-hand sides in double precision.

use crate::ghosts::Ghosts;
use crate::parallel;
use crate::vector::CHUNK;

/// Replaces `b`, own entries, by the answer of `solve` in single precision, divided by `size`; `solve` sees numbers up to one.
/// Collective.
pub(super) fn in_single(ghosts: &Ghosts, b: &mut [f64], size: f64, solve: impl FnOnce(&mut [f32])) {
    let own = parallel::largest(b.len(), CHUNK, |at| b[at].abs());
    let largest = ghosts.largest(own);
    if largest == 0.0 || !largest.is_finite() {
        return b.fill(0.0);
    }
    let mut single: Vec<f32> = parallel::map(b.len(), CHUNK, |at| (b[at] / largest) as f32);
    solve(&mut single);
    parallel::parts_mut(b, CHUNK, &|first, b| {
        b.iter_mut().zip(&single[first..]).for_each(|(b, x)| *b = f64::from(*x) * largest / size);
    });
}
