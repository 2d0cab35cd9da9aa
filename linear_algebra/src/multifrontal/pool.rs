//! Buffers that pass from front to front, since fresh memory costs a page fault every 512 numbers.

use std::sync::Mutex;

/// Shorter buffers are left to the allocator.
const SMALL: usize = 1 << 13;

/// Buffers waiting for their next use.
#[derive(Default)]
pub(crate) struct Pool {
    free: Mutex<Vec<Vec<f64>>>,
}

impl Pool {
    /// A buffer of at least `len` numbers of any value.
    pub(crate) fn take(&self, len: usize) -> Vec<f64> {
        if len >= SMALL {
            let mut free = self.free.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            let fitting = (0..free.len()).filter(|&at| free[at].len() >= len && free[at].len() < 4 * len);
            if let Some(best) = fitting.min_by_key(|&at| free[at].len()) {
                return free.swap_remove(best);
            }
        }
        vec![0.0; len]
    }

    /// Takes a buffer back.
    pub(crate) fn give(&self, buffer: Vec<f64>) {
        if buffer.len() >= SMALL {
            self.free.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(buffer);
        }
    }
}
