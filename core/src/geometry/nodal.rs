//! Arrays of one value a node of a facet, of fixed capacity and with a number of nodes that is known at run time.

use std::fmt;
use std::mem::MaybeUninit;
use std::ops::{Deref, DerefMut};

/// Number of nodes of the largest facet.
pub const MOST_FACET_NODES: usize = 9;

/// One value a node of a facet, by value; a slice of as many entries as the facet has nodes.
#[derive(Clone, Copy)]
pub struct Nodal<V: Copy> {
    len: usize,
    /// The first `len` are initialised.
    items: [MaybeUninit<V>; MOST_FACET_NODES],
}

impl<V: Copy> Nodal<V> {
    /// The values of a function of the node.
    ///
    /// # Panics
    /// If there are more than [`MOST_FACET_NODES`].
    #[inline(always)]
    pub fn new(len: usize, mut of: impl FnMut(usize) -> V) -> Self {
        assert!(len <= MOST_FACET_NODES, "a facet has at most {MOST_FACET_NODES} nodes");
        let mut items = [const { MaybeUninit::uninit() }; MOST_FACET_NODES];
        for (n, item) in items[..len].iter_mut().enumerate() {
            item.write(of(n));
        }
        Self { len, items }
    }

    /// The values of a slice.
    ///
    /// # Panics
    /// If there are more than [`MOST_FACET_NODES`].
    #[inline]
    pub fn of(values: &[V]) -> Self {
        Self::new(values.len(), |n| values[n])
    }

    /// No values, where there is room for them.
    #[inline(always)]
    pub fn empty() -> Self {
        Self { len: 0, items: [const { MaybeUninit::uninit() }; MOST_FACET_NODES] }
    }

    /// Takes the values of a function of the node in place of those there are.
    ///
    /// # Panics
    /// If there are more than [`MOST_FACET_NODES`].
    #[inline(always)]
    pub fn refill(&mut self, len: usize, mut of: impl FnMut(usize) -> V) {
        for (n, item) in self.items[..len].iter_mut().enumerate() {
            item.write(of(n));
        }
        self.len = len;
    }

    /// Makes room for so many values, each first made by `of` and then changed in place by `change`: large values are not moved.
    ///
    /// # Panics
    /// If there are more than [`MOST_FACET_NODES`].
    #[inline(always)]
    pub fn refill_in_place(&mut self, len: usize, of: impl Fn() -> V, mut change: impl FnMut(usize, &mut V)) {
        for (n, item) in self.items[..len].iter_mut().enumerate() {
            change(n, item.write(of()));
        }
        self.len = len;
    }

    /// The values of a function of these ones.
    #[inline(always)]
    pub fn map<W: Copy>(&self, mut of: impl FnMut(V) -> W) -> Nodal<W> {
        Nodal::new(self.len, |n| of(self[n]))
    }
}

impl<V: Copy> Deref for Nodal<V> {
    type Target = [V];

    #[inline(always)]
    fn deref(&self) -> &[V] {
        // SAFETY: `len` is at most the capacity, and `new` has written that many items.
        unsafe { std::slice::from_raw_parts(self.items.as_ptr().cast(), self.len) }
    }
}

impl<V: Copy> DerefMut for Nodal<V> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [V] {
        // SAFETY: as in `deref`, and the borrow is exclusive.
        unsafe { std::slice::from_raw_parts_mut(self.items.as_mut_ptr().cast(), self.len) }
    }
}

impl<V: Copy + fmt::Debug> fmt::Debug for Nodal<V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl<V: Copy + PartialEq> PartialEq for Nodal<V> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<V: Copy, const N: usize> From<[V; N]> for Nodal<V> {
    #[inline]
    fn from(values: [V; N]) -> Self {
        Self::of(&values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodal_values_are_a_slice_of_their_length() {
        let mut values = Nodal::new(3, |n| n as f64);
        values[1] = 5.0;
        assert_eq!(*values, [0.0, 5.0, 2.0]);
        assert_eq!(*values.map(|x| 2.0 * x), [0.0, 10.0, 4.0]);
        assert_eq!(values, Nodal::from([0.0, 5.0, 2.0]));
        assert_ne!(values, Nodal::of(&[0.0, 5.0]));
        assert_eq!(format!("{values:?}"), "[0.0, 5.0, 2.0]");
        values.refill(2, |n| 3.0 * n as f64);
        assert_eq!(*values, [0.0, 3.0]);
        let mut rows: Nodal<Nodal<f64>> = Nodal::empty();
        rows.refill_in_place(2, Nodal::empty, |j, row| row.refill(3, |k| (3 * j + k) as f64));
        assert_eq!(format!("{rows:?}"), "[[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]");
    }
}
