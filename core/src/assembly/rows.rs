//! Rows of a sparse pattern, filled side by side.

use rayon::prelude::*;

/// Rows of a task.
pub(super) const ROWS: usize = 1024;

/// Lets `fill` write the entries of each row; `starts` says where each begins among all, and where the last ends.
pub(super) fn fill_rows<T: Send>(starts: &[usize], entries: &mut [T], fill: impl Fn(usize, &mut [T]) + Sync) {
    let rows = starts.len() - 1;
    let mut parts = Vec::with_capacity(rows.div_ceil(ROWS));
    let mut rest = entries;
    for first in (0..rows).step_by(ROWS) {
        let own = first..(first + ROWS).min(rows);
        let (now, later) = rest.split_at_mut(starts[own.end] - starts[own.start]);
        parts.push((own, now));
        rest = later;
    }
    parts.into_par_iter().for_each(|(own, mut rest)| {
        for row in own {
            let (now, later) = rest.split_at_mut(starts[row + 1] - starts[row]);
            fill(row, now);
            rest = later;
        }
    });
}

/// Starts of rows of these lengths, and where the last ends.
pub(super) fn starts(lengths: impl IntoIterator<Item = usize>) -> Vec<usize> {
    let mut starts = vec![0];
    let mut end = 0;
    starts.extend(lengths.into_iter().map(|length| {
        end += length;
        end
    }));
    starts
}
