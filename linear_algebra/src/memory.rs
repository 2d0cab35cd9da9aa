//! How much memory there is, and how much engines take.
//!
//! The estimates were fitted to whole runs (docs/performance.md): a factorisation in space fills with the power 4/3 of the
//! equations, in the plane with `n log n`, multigrid with the entries of the matrix.

use std::fs;
use std::path::{Path, PathBuf};

use crate::{address_space, parallel};

/// Entries of a row, on average, from which on factors fill like those of solids in space: linear tetrahedra have 38 and more,
/// elements of the plane at most 32.
const MANY_ENTRIES: usize = 34;
/// Numbers of a factor in space for each `n^(4/3)`.
const FACTOR_IN_SPACE: f64 = 20.0;
/// Numbers of a factor in the plane for each `n log₂ n`.
const FACTOR_IN_PLANE: f64 = 8.0;
/// Bytes of a factorisation for each number of the factor, which is kept in double precision or in single.
const BYTES_A_NUMBER: [f64; 2] = [13.5, 7.0];
/// Bytes of the levels of multigrid, while they are made, for each entry of the matrix.
const LEVELS: u64 = 12;
/// Bytes of incomplete factors for each entry.
const INCOMPLETE: u64 = 12;
/// Bytes of the vectors of an iteration for each equation, and of levels whose blocks are few.
const VECTORS: u64 = 800;

/// Gives memory that this process has freed back to the system, where the C library keeps it: later allocations then do not add to it
/// in the peak.
pub fn give_back() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        unsafe extern "C" {
            fn malloc_trim(pad: usize) -> i32;
        }
        // SAFETY: it takes no pointer, and touches only free memory.
        unsafe { malloc_trim(0) };
    }
}

/// Whether a matrix has rows like those of solids in space.
pub(crate) fn is_dense(equations: usize, entries: usize) -> bool {
    entries > MANY_ENTRIES * equations
}

/// Bytes of a factorisation of a matrix of this size, beside the matrix itself, with factors of `single_from` numbers and more in
/// single precision.
pub(crate) fn factor(equations: usize, entries: usize, single_from: usize) -> u64 {
    let n = equations as f64;
    let numbers = if is_dense(equations, entries) {
        FACTOR_IN_SPACE * n.powf(4.0 / 3.0)
    } else {
        FACTOR_IN_PLANE * n * n.max(2.0).log2()
    };
    (numbers * BYTES_A_NUMBER[usize::from(numbers >= single_from as f64)]) as u64
}

/// Bytes of a multigrid hierarchy and the iteration with it.
pub(crate) fn multigrid(equations: usize, entries: usize) -> u64 {
    LEVELS * entries as u64 + VECTORS * equations as u64
}

/// Bytes of incomplete factors and the iteration with them.
pub(crate) fn incomplete(equations: usize, entries: usize) -> u64 {
    INCOMPLETE * entries as u64 + VECTORS * equations as u64
}

/// Bytes that this process may still take: the free memory of the machine, within the limits of its control groups and of its
/// addresses, of which threads have their share; `None` where the system does not tell.
pub fn available() -> Option<u64> {
    let machine = fs::read_to_string("/proc/meminfo").ok().and_then(|text| free_of_machine(&text));
    let groups = fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
    let limits = folders(&groups).into_iter().filter_map(|folder| free_of_group(&folder));
    let threads = parallel::threads() as u64 * address_space::workspace();
    let addresses = address_space::left().map(|left| left.saturating_sub(threads));
    machine.into_iter().chain(limits).chain(addresses).min()
}

/// Most bytes that this process has held so far; `None` where the system does not say.
pub fn largest() -> Option<u64> {
    kilobytes(&fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Bytes that a line of a file of the system states.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes * 1024)
}

fn free_of_machine(meminfo: &str) -> Option<u64> {
    kilobytes(meminfo, "MemAvailable:")
}

/// The folders of the control groups that bound the memory of a process, from its /proc/self/cgroup.
fn folders(groups: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for line in groups.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
        let root = match controllers {
            "" => Path::new("/sys/fs/cgroup"),
            _ if controllers.split(',').any(|name| name == "memory") => Path::new("/sys/fs/cgroup/memory"),
            _ => continue,
        };
        let own = root.join(path.trim_start_matches('/'));
        found.extend(own.ancestors().take_while(|folder| folder.starts_with(root)).map(Path::to_path_buf));
    }
    found
}

/// Free memory of a control group; pages of files that it can give back count as free.
fn free_of_group(folder: &Path) -> Option<u64> {
    let number = |names: [&str; 2]| {
        let texts = names.into_iter().filter_map(|name| fs::read_to_string(folder.join(name)).ok());
        texts.filter_map(|text| text.trim().parse::<u64>().ok()).next()
    };
    let limit = number(["memory.max", "memory.limit_in_bytes"])?;
    let used = number(["memory.current", "memory.usage_in_bytes"])?;
    let stat = fs::read_to_string(folder.join("memory.stat")).unwrap_or_default();
    let files = stat.lines().find_map(|line| line.strip_prefix("inactive_file ")?.trim().parse::<u64>().ok());
    Some((limit + files.unwrap_or(0)).saturating_sub(used))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_are_those_of_measured_runs() {
        // Blocks of hexahedra (docs/performance.md) and squares of quadrilaterals: millions of bytes of the whole run,
        // of which the matrix and the model are 14 bytes an entry, and the program is 15 million.
        let measured = [
            (21_499, 1_590_000, 223, 84),
            (67_813, 5_200_000, 779, 204),
            (218_599, 17_100_000, 2_103, 569),
            (80_802, 1_450_000, 167, 112),
            (246_402, 4_420_000, 505, 316),
        ];
        for (equations, entries, direct, multigrid) in measured {
            let rest = 15.0 + 14.0 * entries as f64 / 1e6;
            let own =
                [(factor(equations, entries, 1 << 27), direct), (super::multigrid(equations, entries), multigrid)];
            for (own, whole) in own {
                let ratio = (own as f64 / 1e6 + rest) / f64::from(whole);
                assert!((0.8..1.25).contains(&ratio), "{equations}: {ratio}");
            }
        }
    }

    #[test]
    fn free_memory_is_read_as_the_system_writes_it() {
        assert_eq!(free_of_machine("MemTotal: 9 kB\nMemAvailable:    2048 kB\n"), Some(2048 * 1024));
        assert_eq!(free_of_machine("MemTotal: 9 kB\n"), None);
        let found = folders("1:cpu:/other\n4:blkio,memory:/jobs/one\n0::/user\n");
        let names: Vec<&str> = found.iter().filter_map(|folder| folder.to_str()).collect();
        let expected = [
            "/sys/fs/cgroup/memory/jobs/one",
            "/sys/fs/cgroup/memory/jobs",
            "/sys/fs/cgroup/memory",
            "/sys/fs/cgroup/user",
            "/sys/fs/cgroup",
        ];
        assert_eq!(names, expected);
    }

    #[test]
    fn a_group_leaves_its_limit_less_what_it_cannot_give_back() {
        let folder = std::env::temp_dir().join(format!("zelus-memory-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
        write("memory.max", "max\n");
        assert_eq!(free_of_group(&folder), None);
        write("memory.max", "1000\n");
        write("memory.current", "700\n");
        write("memory.stat", "anon 500\ninactive_file 150\n");
        assert_eq!(free_of_group(&folder), Some(450));
        fs::remove_dir_all(&folder).unwrap();
    }
}
