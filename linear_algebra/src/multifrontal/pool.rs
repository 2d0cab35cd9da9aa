//! Buffers that pass from front to front, since fresh memory costs page faults.

use std::sync::{Mutex, PoisonError};

/// Shorter buffers are left to the allocator.
const SMALL: usize = 1 << 13;
/// Share of the requested length by which a buffer may be longer.
const LOOSE: f64 = 0.25;
/// Numbers that may wait in buffers of half as many and more, which the allocator gives back to the system.
const WAITING: usize = 1 << 23;

/// Buffers waiting for their next use, shortest first.
#[derive(Debug, Default)]
pub(crate) struct BufferPool {
    free: Mutex<Vec<Vec<f64>>>,
}

impl BufferPool {
    /// A buffer of at least `len` numbers of any value.
    ///
    /// Where no waiting buffer is suitable, as many numbers as are asked for go back to the system before, so that waiting buffers
    /// never add to the peak.
    pub(crate) fn take(&self, len: usize) -> Vec<f64> {
        if len >= SMALL {
            let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
            let at = free.partition_point(|buffer| buffer.len() < len);
            if free.get(at).is_some_and(|buffer| buffer.len() as f64 <= (1.0 + LOOSE) * len as f64) {
                return free.remove(at);
            }
            let mut given = 0;
            let useless = free.iter().take_while(|buffer| {
                let more = given < len;
                given += buffer.len();
                more
            });
            let useless = useless.count();
            free.drain(..useless);
        }
        vec![0.0; len]
    }

    /// Gives all that waits back to the system.
    pub(crate) fn clear(&self) {
        self.free.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// Takes a buffer back; long ones go on to the system when too many numbers wait.
    pub(crate) fn give(&self, buffer: Vec<f64>) {
        if buffer.len() >= SMALL {
            let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
            let at = free.partition_point(|other| other.len() < buffer.len());
            free.insert(at, buffer);
            let long = free.partition_point(|buffer| buffer.len() < WAITING / 2);
            let mut waiting: usize = free[long..].iter().map(Vec::len).sum();
            while waiting > WAITING {
                waiting -= free.pop().map_or(0, |longest| longest.len());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_serves_again_only_what_it_can_hold() {
        let pool = BufferPool::default();
        let first = pool.take(10_000);
        let address = first.as_ptr();
        pool.give(first);
        let again = pool.take(9_000);
        assert!(again.as_ptr() == address && again.len() == 10_000);
        pool.give(again);
        assert_eq!(pool.take(20_000).len(), 20_000);
        assert!(pool.free.lock().unwrap().is_empty(), "the shorter one gave way");
        pool.give(vec![0.0; 10_000]);
        pool.give(vec![0.0; WAITING / 2 + 1]);
        pool.give(vec![0.0; WAITING]);
        let waiting: Vec<usize> = pool.free.lock().unwrap().iter().map(Vec::len).collect();
        assert_eq!(waiting, [10_000, WAITING / 2 + 1], "more than may wait goes back");
        assert_eq!(pool.take(12).len(), 12);
    }
}
