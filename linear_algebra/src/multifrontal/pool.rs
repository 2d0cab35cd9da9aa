//! Buffers that pass from front to front, since fresh memory costs page faults.

use std::sync::{Mutex, PoisonError};

/// Shorter buffers are left to the allocator.
const SMALL: usize = 1 << 13;

/// Buffers waiting for their next use, by the power of two of their length.
#[derive(Debug, Default)]
pub(crate) struct Pool {
    free: Mutex<Vec<Vec<Vec<f64>>>>,
}

impl Pool {
    /// A buffer of at least `len` numbers of any value.
    pub(crate) fn take(&self, len: usize) -> Vec<f64> {
        if len < SMALL {
            return vec![0.0; len];
        }
        let class = len.next_power_of_two();
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        let waiting = free.get_mut(class.ilog2() as usize).and_then(Vec::pop);
        drop(free);
        waiting.unwrap_or_else(|| vec![0.0; class])
    }

    /// Takes a buffer back.
    pub(crate) fn give(&self, buffer: Vec<f64>) {
        if buffer.len() >= SMALL {
            let class = buffer.len().ilog2() as usize;
            let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
            if free.len() <= class {
                free.resize_with(class + 1, Vec::new);
            }
            free[class].push(buffer);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_serves_again_only_what_it_can_hold() {
        let pool = Pool::default();
        let first = pool.take(10_000);
        let address = first.as_ptr();
        pool.give(first);
        let longer = pool.take(20_000);
        assert!(longer.as_ptr() != address && longer.len() >= 20_000);
        let again = pool.take(9_000);
        assert!(again.as_ptr() == address && again.len() >= 9_000);
        assert_eq!(pool.take(12).len(), 12);
    }
}
