//! Rows of a sparse pattern, filled side by side.

use std::ops::Range;

use zelus_linear_algebra::parallel;

/// Rows of a task.
pub(super) const ROWS: usize = 1024;

/// The entries of ranges of rows that follow each other; `starts` says where those of each row begin among all, and where the last end.
pub(super) fn parts_of_rows<'a, T>(
    starts: &[usize],
    entries: &'a mut [T],
    ranges: impl Iterator<Item = Range<usize>>,
) -> Vec<(Range<usize>, &'a mut [T])> {
    let mut rest = entries;
    let mut passed = 0;
    let part = |rows: Range<usize>| {
        let [begin, end] = [rows.start, rows.end].map(|row| starts[row] - passed);
        let (now, later) = std::mem::take(&mut rest)[begin..].split_at_mut(end - begin);
        (rest, passed) = (later, passed + end);
        (rows, now)
    };
    ranges.map(part).collect()
}

/// Lets `fill` write the entries of each row; `starts` says where each begins among all, and where the last ends.
pub(super) fn fill_rows<T: Send>(starts: &[usize], entries: &mut [T], fill: impl Fn(usize, &mut [T]) + Sync) {
    let rows = starts.len() - 1;
    let ranges = (0..rows).step_by(ROWS).map(|first| first..(first + ROWS).min(rows));
    parallel::each_mut(&mut parts_of_rows(starts, entries, ranges), 1, |_, (own, rest)| {
        let mut rest = &mut **rest;
        for row in own.clone() {
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
