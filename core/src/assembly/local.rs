//! Local systems of many entities, computed side by side in chunks of fixed size.

use std::ops::Range;

use zelus_linear_algebra::parallel;

use super::rows::parts_of_rows;
use crate::entities::{EntityBlock, EntityError, LocalSystems, Request, StepView, together};

/// Entities whose local systems are held at a time.
pub(super) const BATCH: usize = 512;
/// Entities of one task; fixed, so that results do not depend on the number of threads.
const CHUNK: usize = 32;

type Compute<'a> = &'a (dyn Fn(Range<usize>, &mut LocalSystems) -> Result<(), EntityError> + Sync);

/// Local systems of `range`, in chunks of [`CHUNK`] entities; their memory is that of `buffers`, which serve batch after batch.
///
/// # Errors
/// The first entity that cannot be computed.
pub(super) fn evaluate<'a>(
    range: Range<usize>,
    size: usize,
    request: Request,
    compute: Compute<'_>,
    buffers: &'a mut Vec<LocalSystems>,
) -> Result<&'a mut [LocalSystems], EntityError> {
    let chunks: Vec<Range<usize>> =
        range.clone().step_by(CHUNK).map(|begin| begin..(begin + CHUNK).min(range.end)).collect();
    evaluate_runs(&chunks, [size, size], request, compute, buffers)
}

/// Local systems, of so many rows and columns, of each of `runs`, which are no longer than [`CHUNK`].
fn evaluate_runs<'a>(
    runs: &[Range<usize>],
    sizes: [usize; 2],
    request: Request,
    compute: Compute<'_>,
    buffers: &'a mut Vec<LocalSystems>,
) -> Result<&'a mut [LocalSystems], EntityError> {
    buffers.resize_with(buffers.len().max(runs.len()), LocalSystems::default);
    let systems = &mut buffers[..runs.len()];
    let mut done: Vec<(&mut LocalSystems, Result<(), EntityError>)> =
        systems.iter_mut().map(|out| (out, Ok(()))).collect();
    parallel::each_mut(&mut done, 1, |at, (out, result)| {
        *result = together(&mut || {
            out.reset_rows(runs[at].len(), sizes, request);
            compute(runs[at].clone(), out)
        });
    });
    done.into_iter().try_for_each(|(_, result)| result)?;
    Ok(systems)
}

/// Indices of `count` entities that are evaluated here, in runs of at most [`CHUNK`].
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

/// Evaluates the entities of `runs` and hands them on in batches: the number of each with its tangent and its right-hand side, in their
/// order.
pub(super) fn batches_of_runs(
    block: &dyn EntityBlock,
    view: &StepView<'_>,
    runs: &[Range<usize>],
    request: Request,
    mut take: impl FnMut(&[(usize, &[f64], &[f64])]),
) -> Result<(), EntityError> {
    let compute = |range, out: &mut LocalSystems| block.local_systems(view, range, request, out);
    let mut buffers = Vec::new();
    for batch in runs.chunks(BATCH / CHUNK) {
        let sizes = [block.equations(), block.unknowns().len()];
        let systems = evaluate_runs(batch, sizes, request, &compute, &mut buffers)?;
        let mut found = Vec::with_capacity(BATCH);
        for (run, systems) in batch.iter().zip(&*systems) {
            found.extend(run.clone().enumerate().map(|(slot, at)| (at, systems.lhs_of(slot), systems.rhs_of(slot))));
        }
        take(&found);
    }
    Ok(())
}

/// Evaluates the entities of `runs` and hands the number of each, its tangent and its right-hand side on, in their order.
pub(super) fn each_of_runs(
    block: &dyn EntityBlock,
    view: &StepView<'_>,
    runs: &[Range<usize>],
    request: Request,
    mut add: impl FnMut(usize, &[f64], &[f64]),
) -> Result<(), EntityError> {
    batches_of_runs(block, view, runs, request, |batch| batch.iter().for_each(|&(at, lhs, rhs)| add(at, lhs, rhs)))
}

/// Row ranges that are filled side by side.
const ROW_PARTS: usize = 16;

/// Lets `add` fill rows side by side: each task is told which, the place of their first entry and their entries. `touched` are the rows,
/// whose entries begin at `starts`, that need it; entities that stand together touch rows that do.
pub(super) fn side_by_side(
    starts: &[usize],
    values: &mut [f64],
    touched: impl Iterator<Item = u32> + Clone,
    add: impl Fn(Range<usize>, usize, &mut [f64]) + Sync,
) {
    let (Some(first), Some(last)) = (touched.clone().min(), touched.max()) else { return };
    let (first, rows) = (first as usize, (last - first) as usize + 1);
    let bound = |part: usize| first + rows * part / ROW_PARTS;
    let mut parts = parts_of_rows(starts, values, (0..ROW_PARTS).map(|part| bound(part)..bound(part + 1)));
    parallel::each_mut(&mut parts, 1, |_, (rows, values)| add(rows.clone(), starts[rows.start], values));
}

/// Tangent of the `at`-th entity of the evaluated range.
pub(super) fn entity_lhs(chunks: &[LocalSystems], at: usize) -> &[f64] {
    chunks[at / CHUNK].lhs_of(at % CHUNK)
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
