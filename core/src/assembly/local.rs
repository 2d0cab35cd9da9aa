//! Local systems of many entities, computed side by side in chunks of fixed size.

use std::ops::Range;

use rayon::prelude::*;

use crate::entities::{EntityBlock, EntityError, LocalSystems, StepView, Want};

/// Entities whose local systems are held at a time.
pub(super) const BATCH: usize = 2048;
/// Entities of one task; fixed, so that results do not depend on the number of threads.
const CHUNK: usize = 64;

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
fn evaluate_runs(
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

/// Those of `count` entities that are evaluated here, in runs of at most [`CHUNK`].
pub(super) fn own_runs(count: usize, is_own: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for at in (0..count).filter(|&at| is_own(at)) {
        match runs.last_mut() {
            Some(run) if run.end == at && run.len() < CHUNK => run.end += 1,
            _ => runs.push(at..at + 1),
        }
    }
    runs
}

/// Evaluates the entities of `runs` and hands the number of each, its tangent and its right-hand side on, in their order.
pub(super) fn each_of_runs(
    block: &dyn EntityBlock,
    view: &StepView<'_>,
    runs: &[Range<usize>],
    want: Want,
    mut add: impl FnMut(usize, &[f64], &[f64]),
) -> Result<(), EntityError> {
    let compute = |range, out: &mut LocalSystems| block.local_systems(view, range, want, out);
    for batch in runs.chunks(BATCH / CHUNK) {
        for (run, mut systems) in batch.iter().zip(evaluate_runs(batch, block.unknowns().len(), want, &compute)?) {
            for (slot, at) in run.clone().enumerate() {
                let (lhs, rhs) = systems.entity(slot);
                add(at, lhs, rhs);
            }
        }
    }
    Ok(())
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
