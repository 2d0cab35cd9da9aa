//! Loops over threads, compiled once.
//!
//! Generic code is compiled again for every type and closure it meets, and the machinery that shares work out among threads is large.
//! So [`ranges`] alone meets it, behind `&dyn Fn`; the functions around it are a few instructions each.
//!
//! Work over `0..count` is cut into ranges of a fixed length, whatever the number of threads. Sums over a range are therefore the same
//! to the bit on any number of threads, and so is a total of them in the order of ranges. A call through `dyn` costs as much as a
//! few additions: ranges hold enough items to hide it, and their inner loops stand in the closure.

use std::ops::Range;

use rayon::prelude::*;

/// Threads of the pool that the caller runs in.
pub fn threads() -> usize {
    rayon::current_num_threads()
}

/// Runs `work` on all ranges of `length` items of `0..count`, the last of which may be shorter.
///
/// # Panics
/// When `length` is zero, or `work` panics.
pub fn ranges(count: usize, length: usize, work: &(dyn Fn(Range<usize>) + Sync)) {
    let range = |at: usize| work(at * length..(at * length + length).min(count));
    match count.div_ceil(length) {
        0 => (),
        1 => range(0),
        // Ranges may differ in effort: each is a task of its own.
        several => (0..several).into_par_iter().with_max_len(1).for_each(range),
    }
}

/// The start of a slice that several threads write to, each in a range of its own.
struct Start<T>(*mut T);

// SAFETY: `Start` is used in this file alone, where no two threads are given the same items; `T: Send` lets another thread have them.
unsafe impl<T: Send> Sync for Start<T> {}

impl<T> Start<T> {
    fn at(&self, index: usize) -> *mut T {
        // SAFETY: `index` is below the number of items, or equal to it.
        unsafe { self.0.add(index) }
    }
}

/// Runs `work` on all parts of `length` items of a slice: the index of the first item, and the items.
///
/// # Panics
/// As [`ranges`].
pub fn parts_mut<T: Send>(values: &mut [T], length: usize, work: &(dyn Fn(usize, &mut [T]) + Sync)) {
    let start = Start(values.as_mut_ptr());
    ranges(values.len(), length, &|range| {
        // SAFETY: ranges lie within the slice and do not overlap, and the slice is borrowed until all are done.
        let part = unsafe { std::slice::from_raw_parts_mut(start.at(range.start), range.len()) };
        work(range.start, part);
    });
}

/// Runs `work` on each of the successive groups of `size` items of a slice, with its index; `length` groups are a task. Items that
/// fill no group are left alone.
///
/// # Panics
/// As [`ranges`].
#[inline]
pub fn groups_mut<T: Send>(values: &mut [T], size: usize, length: usize, work: impl Fn(usize, &mut [T]) + Sync) {
    let size = size.max(1);
    parts_mut(values, size * length, &|first, part| {
        part.chunks_exact_mut(size).enumerate().for_each(|(at, group)| work(first / size + at, group));
    });
}

/// Runs `work` on each item, `length` of which are a task.
///
/// # Panics
/// As [`ranges`].
#[inline]
pub fn each_mut<T: Send>(items: &mut [T], length: usize, work: impl Fn(usize, &mut T) + Sync) {
    parts_mut(items, length, &|first, part| {
        part.iter_mut().enumerate().for_each(|(at, item)| work(first + at, item));
    });
}

/// `of(i)` for each i in `0..count`, in their order; `length` of them are a task.
///
/// # Panics
/// As [`ranges`]; values made before are then forgotten, not dropped.
#[inline]
pub fn map<T: Send>(count: usize, length: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut out: Vec<T> = Vec::with_capacity(count);
    let start = Start(out.as_mut_ptr());
    ranges(count, length, &|range| {
        for at in range {
            // SAFETY: the memory holds `count` values, and ranges do not overlap.
            unsafe { start.at(at).write(of(at)) };
        }
    });
    // SAFETY: ranges cover `0..count`, so every value has been written.
    unsafe { out.set_len(count) };
    out
}

/// A copy of a slice; `length` items are a task.
///
/// # Panics
/// As [`ranges`].
pub fn copied<T: Copy + Send + Sync>(values: &[T], length: usize) -> Vec<T> {
    let mut out: Vec<T> = Vec::with_capacity(values.len());
    let start = Start(out.as_mut_ptr());
    ranges(values.len(), length, &|range| {
        let from = &values[range.clone()];
        // SAFETY: the memory holds as many values and is not that of the slice, and ranges do not overlap.
        unsafe { std::ptr::copy_nonoverlapping(from.as_ptr(), start.at(range.start), from.len()) };
    });
    // SAFETY: ranges cover all items, so every value has been written.
    unsafe { out.set_len(values.len()) };
    out
}

/// Indices of `0..count` for which `is_so`, ascending; `length` of them are a task.
///
/// # Panics
/// As [`ranges`].
#[inline]
pub fn select(count: usize, length: usize, is_so: impl Fn(usize) -> bool + Sync) -> Vec<u32> {
    select_by(count, length, &|range, out| out.extend(range.filter(|&at| is_so(at)).map(|at| at as u32)))
}

fn select_by(count: usize, length: usize, add: &(dyn Fn(Range<usize>, &mut Vec<u32>) + Sync)) -> Vec<u32> {
    let parts = map(count.div_ceil(length), 1, |part| {
        let mut out = Vec::new();
        add(part * length..(part * length + length).min(count), &mut out);
        out
    });
    parts.concat()
}

/// `of` each range of `length` items of `0..count`, in their order.
///
/// # Panics
/// As [`ranges`].
pub fn of_ranges(count: usize, length: usize, of: &(dyn Fn(Range<usize>) -> f64 + Sync)) -> Vec<f64> {
    map(count.div_ceil(length), 1, |part| of(part * length..(part * length + length).min(count)))
}

/// The largest of `of(i)` for i in `0..count`, at least zero; `length` of them are a task. Entries that are not a number do not count.
///
/// # Panics
/// As [`ranges`].
#[inline]
pub fn largest(count: usize, length: usize, of: impl Fn(usize) -> f64 + Sync) -> f64 {
    of_ranges(count, length, &|range| range.map(&of).fold(0.0, f64::max)).into_iter().fold(0.0, f64::max)
}

/// Threads of their own.
#[derive(Debug)]
pub struct ThreadPool(rayon::ThreadPool);

impl ThreadPool {
    /// So many threads; for zero as many as there are processors.
    ///
    /// # Errors
    /// Why they cannot be started.
    pub fn new(threads: usize) -> Result<Self, String> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.map(Self).map_err(|error| error.to_string())
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.0.current_num_threads()
    }

    /// Does `work` with these threads.
    ///
    /// # Panics
    /// When `work` does.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let (mut work, mut out) = (Some(work), None);
        self.install(&mut || out = work.take().map(|work| work()));
        out.expect("the work has been done")
    }

    fn install(&self, work: &mut (dyn FnMut() + Send)) {
        self.0.install(work);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn every_item_is_met_once_and_results_stand_in_order() {
        for count in [0, 1, 6, 7, 8, 700, 701] {
            let met: Vec<AtomicUsize> = (0..count).map(|_| AtomicUsize::new(0)).collect();
            ranges(count, 7, &|range| {
                assert!(range.start.is_multiple_of(7) && range.len() <= 7 && !range.is_empty());
                range.for_each(|at| _ = met[at].fetch_add(1, Ordering::Relaxed));
            });
            assert!(met.iter().all(|times| times.load(Ordering::Relaxed) == 1), "{count}");
            assert_eq!(map(count, 7, |at| at.to_string()), (0..count).map(|at| at.to_string()).collect::<Vec<_>>());
            assert_eq!(
                select(count, 7, |at| at % 3 == 1),
                (0..count as u32).filter(|at| at % 3 == 1).collect::<Vec<_>>()
            );
            assert_eq!(largest(count, 7, |at| at as f64), count.saturating_sub(1) as f64);
        }
    }

    #[test]
    fn parts_and_groups_cover_a_slice() {
        let mut values = vec![0; 1000];
        parts_mut(&mut values, 64, &|first, part| part.iter_mut().zip(first..).for_each(|(value, at)| *value = at));
        assert_eq!(values, (0..1000).collect::<Vec<_>>());
        groups_mut(&mut values, 3, 5, |at, group| group.fill(at));
        assert!(values[..999].iter().enumerate().all(|(at, value)| *value == at / 3));
        assert_eq!(values[999], 999, "it fills no group");
        each_mut(&mut values, 10, |at, value| *value = 2 * at);
        assert!(values.iter().enumerate().all(|(at, value)| *value == 2 * at));
    }

    #[test]
    fn threads_of_their_own_do_the_work() {
        let pool = ThreadPool::new(3).unwrap();
        assert_eq!((pool.threads(), pool.run(threads)), (3, 3));
    }

    #[test]
    #[should_panic(expected = "item 500")]
    fn a_panic_reaches_the_caller() {
        ranges(1000, 10, &|range| assert!(!range.contains(&500), "item 500"));
    }
}
