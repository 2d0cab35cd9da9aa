//! Address space of a process (`ulimit -v`), and the share that a thread reserves.
//!
//! The dense kernels of the library below give each thread that multiplies matrices a workspace of twice the third cache of the
//! whole machine. Most of its pages are never touched, so that it is no memory; but it counts against a limit of addresses, and
//! a process that cannot reserve it is aborted. Threads are therefore counted before they start.

use std::fs;
use std::path::Path;

/// Bytes that a thread reserves beside the workspace: its stack, and the heap that the system's allocator keeps for it.
const STACK_AND_HEAP: u64 = (2 + 64) << 20;
/// The third cache where the system does not say, in bytes.
const UNKNOWN_CACHE: u64 = 64 << 20;

/// Bytes of addresses that this process may still reserve; `None` where there is no limit.
pub fn left() -> Option<u64> {
    let limit = limit_of(&fs::read_to_string("/proc/self/limits").ok()?)?;
    let pages: u64 = fs::read_to_string("/proc/self/statm").ok()?.split_whitespace().next()?.parse().ok()?;
    Some(limit.saturating_sub(pages * 4096))
}

/// Bytes of addresses that one thread of the solvers reserves.
pub fn of_a_thread() -> u64 {
    workspace() + STACK_AND_HEAP
}

/// Bytes of it that the dense kernels take when they first run.
pub(crate) fn workspace() -> u64 {
    2 * third_cache(Path::new("/sys/devices/system/cpu/cpu0/cache")).unwrap_or(UNKNOWN_CACHE)
}

/// The soft limit that /proc/self/limits names.
fn limit_of(limits: &str) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Bytes of the third caches of all cores, from the folder of one core's caches.
fn third_cache(folder: &Path) -> Option<u64> {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get) as u64;
    let text = |index: &Path, name: &str| fs::read_to_string(index.join(name)).ok().map(|text| text.trim().to_owned());
    let indices = fs::read_dir(folder).ok()?.filter_map(|entry| Some(entry.ok()?.path()));
    let third = indices.into_iter().find(|index| text(index, "level").as_deref() == Some("3"))?;
    let size = bytes(&text(&third, "size")?)?;
    Some(size.div_ceil(sharing(&text(&third, "shared_cpu_list")?)) * cores.max(1))
}

/// A size as the system writes it, e.g. `32768K`.
fn bytes(size: &str) -> Option<u64> {
    let digits = size.trim_end_matches(['K', 'M', 'G']);
    let shift =
        [("K", 10), ("M", 20), ("G", 30)].iter().find(|(unit, _)| size.ends_with(unit)).map_or(0, |(_, by)| *by);
    digits.parse::<u64>().ok().map(|number| number << shift)
}

/// How many cores a list such as `0-3,8` names.
fn sharing(list: &str) -> u64 {
    let count = |range: &str| {
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        Some(last.parse::<u64>().ok()?.checked_sub(first.parse().ok()?)? + 1)
    };
    list.split(',').filter_map(count).sum::<u64>().max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_read_as_the_system_writes_them() {
        let limits = "Max stack size   8388608  unlimited  bytes\nMax address space         204800000            unlimited            bytes\n";
        assert_eq!(limit_of(limits), Some(204_800_000));
        assert_eq!(limit_of("Max address space   unlimited  unlimited  bytes"), None);
    }

    #[test]
    fn caches_are_read_as_the_system_writes_them() {
        assert_eq!(
            [bytes("32768K"), bytes("480M"), bytes("7"), bytes("x")],
            [Some(32 << 20), Some(480 << 20), Some(7), None]
        );
        assert_eq!([sharing("0-3"), sharing("0,2-4"), sharing("")], [4, 4, 1]);
    }
}
