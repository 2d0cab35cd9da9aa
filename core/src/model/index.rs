//! Places of nodes and entities by their ids.

use std::sync::OnceLock;

use rustc_hash::FxHashMap;

/// The place of each id in a list, found when it is first asked for.
#[derive(Debug, Clone, Default)]
pub(super) struct Index(OnceLock<FxHashMap<usize, u32>>);

impl Index {
    /// The place of an id among `ids`, whose index this is.
    pub(super) fn find(&self, ids: &[usize], id: usize) -> Option<u32> {
        let places = self.0.get_or_init(|| ids.iter().enumerate().map(|(at, &id)| (id, at as u32)).collect());
        places.get(&id).copied()
    }

    /// An id has been added at a place.
    pub(super) fn push(&mut self, id: usize, at: u32) {
        if let Some(places) = self.0.get_mut() {
            places.insert(id, at);
        }
    }
}

impl PartialEq for Index {
    /// It follows from the list.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
