//! Numbers of one time level.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::vector::copied;

/// Numbers of a column at one time level, in the order of its items; copies are the same memory until one of them is changed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Level(Arc<Vec<f64>>);

impl Level {
    /// So many zeros, which take no memory until something is written.
    pub(super) fn zeros(count: usize) -> Self {
        Self(Arc::new(vec![0.0; count]))
    }

    /// The numbers, copied only where there is another copy.
    pub fn into_vec(self) -> Vec<f64> {
        Arc::unwrap_or_clone(self.0)
    }

    /// Lengthens it by zeros.
    pub(super) fn grow(&mut self, count: usize) {
        match self.is_empty() {
            true => *self = Self::zeros(count),
            false => Arc::make_mut(&mut self.0).resize(count, 0.0),
        }
    }

    /// Takes the numbers of another as its own.
    pub(super) fn take_over(&mut self, other: &Self) {
        match Arc::get_mut(&mut self.0) {
            // Memory that is there costs less than new memory would once one of both changes.
            Some(own) => own.copy_from_slice(other),
            None => *self = other.clone(),
        }
    }
}

impl Deref for Level {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.0
    }
}

impl DerefMut for Level {
    fn deref_mut(&mut self) -> &mut [f64] {
        if Arc::get_mut(&mut self.0).is_none() {
            self.0 = Arc::new(copied(&self.0));
        }
        Arc::get_mut(&mut self.0).expect("a copy of its own")
    }
}

impl From<Vec<f64>> for Level {
    fn from(values: Vec<f64>) -> Self {
        Self(Arc::new(values))
    }
}

impl FromIterator<f64> for Level {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        values.into_iter().collect::<Vec<f64>>().into()
    }
}

impl Serialize for Level {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Level {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Vec::deserialize(deserializer)?.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_are_one_until_one_changes() {
        let mut level: Level = vec![1.0, 2.0].into();
        let saved = level.clone();
        assert_eq!(level.as_ptr(), saved.as_ptr());
        level[1] = 3.0;
        assert_eq!((&level[..], &saved[..]), (&[1.0, 3.0][..], &[1.0, 2.0][..]));

        let own = level.as_ptr();
        level.take_over(&saved);
        assert_eq!((&level[..], level.as_ptr()), (&saved[..], own));
        let kept = level.clone();
        level.take_over(&saved);
        assert_eq!(level.as_ptr(), saved.as_ptr());
        assert_eq!(&kept[..], &saved[..]);
    }
}
