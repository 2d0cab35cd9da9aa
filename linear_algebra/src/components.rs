//! Connected components of items.

use std::sync::atomic::{AtomicU32, Ordering};

/// Sets of items that join by pairs, whatever the order and by how many threads.
///
/// Each item knows an earlier one of its set, the first of all itself: a set is a tree, and the first item its root.
#[derive(Debug)]
pub struct Components {
    earlier: Vec<AtomicU32>,
}

impl Components {
    /// So many items, each alone.
    pub fn new(items: usize) -> Self {
        Self { earlier: (0..items as u32).map(AtomicU32::new).collect() }
    }

    /// Makes one set of those of two items.
    ///
    /// # Panics
    /// For items that there are not.
    pub fn join(&self, a: u32, b: u32) {
        let (mut a, mut b) = (a, b);
        loop {
            (a, b) = (self.first(a), self.first(b));
            if a == b {
                return;
            }
            let (low, high) = (a.min(b), a.max(b));
            // Another thread may have joined the later one to a set of its own.
            let joined = self.earlier[high as usize].compare_exchange(high, low, Ordering::AcqRel, Ordering::Acquire);
            if joined.is_ok() {
                return;
            }
        }
    }

    /// The first item of the set of `item`.
    ///
    /// # Panics
    /// For an item that there is not.
    pub fn first(&self, item: u32) -> u32 {
        let mut at = item;
        loop {
            let before = self.earlier[at as usize].load(Ordering::Acquire);
            if before == at {
                return at;
            }
            let first = self.earlier[before as usize].load(Ordering::Acquire);
            if first != before {
                // Shortens the way for those who come later; where another thread has, its way is as good.
                let _ = self.earlier[at as usize].compare_exchange(before, first, Ordering::AcqRel, Ordering::Relaxed);
            }
            at = first;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel;

    #[test]
    fn items_that_join_have_one_first_item_whatever_the_order() {
        // Chains of every seventh item, joined from their ends inwards.
        let items = 70_000_u32;
        let components = Components::new(items as usize);
        parallel::ranges(items as usize - 7, 1, &|range| {
            let item = items - 8 - range.start as u32;
            components.join(item + 7, item);
        });
        assert!((0..items).all(|item| components.first(item) == item % 7));
        components.join(3, items - 1);
        assert_eq!(components.first(6), 3_u32.min((items - 1) % 7));
        assert_eq!(components.first(5), 5);
    }
}
