//! Local systems of many entities, computed side by side in chunks of fixed size.

use std::ops::Range;

use rayon::prelude::*;

use crate::entities::{EntityError, LocalSystems, Want};

/// Entities whose local systems are held at a time.
pub(super) const BATCH: usize = 2048;
/// Entities of one task; fixed, so that results do not depend on the number of threads.
pub(super) const CHUNK: usize = 64;

type Compute<'a> = &'a (dyn Fn(Range<usize>, &mut LocalSystems) -> Result<(), EntityError> + Sync);

/// Local systems of `range`, in chunks of [`CHUNK`] entities.
pub(super) fn evaluate(
    range: Range<usize>,
    size: usize,
    want: Want,
    compute: Compute<'_>,
) -> Result<Vec<LocalSystems>, EntityError> {
    let chunks: Vec<Range<usize>> =
        range.clone().step_by(CHUNK).map(|begin| begin..(begin + CHUNK).min(range.end)).collect();
    evaluate_runs(&chunks, size, want, compute)
}

/// Local systems of each of `runs`, which are no longer than [`CHUNK`].
pub(super) fn evaluate_runs(
    runs: &[Range<usize>],
    size: usize,
    want: Want,
    compute: Compute<'_>,
) -> Result<Vec<LocalSystems>, EntityError> {
    runs.par_iter()
        .map(|run| {
            let mut out = LocalSystems::default();
            out.reset(run.len(), size, want);
            compute(run.clone(), &mut out).map(|()| out)
        })
        .collect()
}

/// Tangent of the `at`-th entity of the evaluated range.
pub(super) fn entity_lhs(chunks: &[LocalSystems], at: usize, size: usize) -> &[f64] {
    let within = at % CHUNK;
    &chunks[at / CHUNK].lhs[within * size * size..(within + 1) * size * size]
}

/// Adds all right-hand sides; `begin` is the first entity of the evaluated range.
pub(super) fn add_rhs(chunks: &[LocalSystems], numbers: &[u32], begin: usize, size: usize, rhs: &mut [f64]) {
    for (chunk, systems) in chunks.iter().enumerate() {
        let first = (begin + chunk * CHUNK) * size;
        for (&number, value) in numbers[first..].iter().zip(&systems.rhs) {
            rhs[number as usize] += value;
        }
    }
}
