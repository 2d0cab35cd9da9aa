//! Places of nodes and entities by their ids.

use std::sync::OnceLock;

use rustc_hash::FxHashMap;

/// The place of each id in a list, found when it is first asked for; a copy finds it anew.
#[derive(Debug, Default)]
pub(super) struct Index(OnceLock<IdTable>);

/// No place.
const NONE: u32 = u32::MAX;
/// Ids up to so many times the number of items, and this many more, have their places in a list.
const DENSE: (usize, usize) = (4, 1024);

#[derive(Debug, Default)]
struct IdTable {
    count: usize,
    /// By id, or [`NONE`].
    listed: Vec<u32>,
    /// Ids that were too large for the list when they came.
    others: FxHashMap<usize, u32>,
}

impl IdTable {
    fn insert(&mut self, id: usize, at: u32) {
        self.count += 1;
        if id >= DENSE.0 * self.count + DENSE.1 {
            self.others.insert(id, at);
            return;
        }
        if id >= self.listed.len() {
            self.listed.resize(id + 1, NONE);
        }
        self.listed[id] = at;
    }

    fn find(&self, id: usize) -> Option<u32> {
        let listed = self.listed.get(id).copied().filter(|&at| at != NONE);
        listed.or_else(|| self.others.get(&id).copied())
    }
}

impl Index {
    /// The place of an id among `ids`, whose index this is.
    pub(super) fn find(&self, ids: &[usize], id: usize) -> Option<u32> {
        let places = self.0.get_or_init(|| {
            let mut places = IdTable::default();
            ids.iter().enumerate().for_each(|(at, &id)| places.insert(id, at as u32));
            places
        });
        places.find(id)
    }

    /// An id has been added at a place.
    pub(super) fn push(&mut self, id: usize, at: u32) {
        if let Some(places) = self.0.get_mut() {
            places.insert(id, at);
        }
    }
}

impl Clone for Index {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for Index {
    /// It follows from the list.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_near_and_far_are_found() {
        let mut ids = vec![7, 1_000_000_000_000, 3, 6000];
        let mut index = Index::default();
        let check = |index: &Index, ids: &[usize]| {
            for (at, &id) in ids.iter().enumerate() {
                assert_eq!(index.find(ids, id), Some(at as u32), "{id}");
                assert_eq!(index.find(ids, id + 1), None, "{id}");
            }
        };
        check(&index, &ids);
        // Ids that were far are near once there are many.
        for id in (20..20_000).step_by(2).filter(|&id| id != 6000) {
            index.push(id, ids.len() as u32);
            ids.push(id);
        }
        check(&index, &ids);
        check(&index.clone(), &ids);
    }
}
