//! Items that share a group with each item, as the nodes of elements do.

use zelus_linear_algebra::parallel;

use super::rows::starts;

/// Items of a task.
const ITEMS: usize = 512;

/// Lists of items, one an item, each ascending.
#[derive(Debug, Clone, Default)]
pub(super) struct Neighbours {
    /// Where the list of each item begins in all of them, and the end.
    pub starts: Vec<usize>,
    /// All lists, one after the other.
    pub list: Vec<u32>,
}

impl Neighbours {
    /// Items that are together in one of `groups`, each among its own; an item of none has itself where `keeps` says so.
    pub(super) fn new(items: usize, groups: &[&[u32]], keeps: impl Fn(usize) -> bool + Sync) -> Self {
        // The groups of each item.
        let mut ends = vec![0_usize; items + 1];
        groups.iter().copied().flatten().for_each(|&a| ends[a as usize + 1] += 1);
        (0..items).for_each(|a| ends[a + 1] += ends[a]);
        let mut of_items = vec![0_u32; ends[items]];
        for (group, members) in groups.iter().enumerate() {
            for &a in *members {
                let at = &mut ends[a as usize];
                of_items[*at] = group as u32;
                *at += 1;
            }
        }
        let task = |task: usize| {
            let own = task * ITEMS..((task + 1) * ITEMS).min(items);
            let (mut counts, mut list, mut of_item) = (Vec::with_capacity(own.len()), Vec::new(), Vec::new());
            let mut before: Option<&[u32]> = None;
            for a in own {
                let (keeps, own) = (keeps(a), &of_items[a.checked_sub(1).map_or(0, |before| ends[before])..ends[a]]);
                // The unknowns of a node are together in all groups.
                if before.replace(own) != Some(own) || keeps {
                    of_item.clear();
                    of_item.extend(keeps.then_some(a as u32));
                    own.iter().for_each(|&group| of_item.extend_from_slice(groups[group as usize]));
                    of_item.sort_unstable();
                    of_item.dedup();
                    before = before.filter(|_| !keeps);
                }
                counts.push(of_item.len());
                list.extend_from_slice(&of_item);
            }
            (counts, list)
        };
        // Items that have lists may stand together.
        let parts: Vec<(Vec<usize>, Vec<u32>)> = parallel::map(items.div_ceil(ITEMS), 1, task);
        let starts = starts(parts.iter().flat_map(|(counts, _)| counts.iter().copied()));
        let mut list = Vec::with_capacity(starts[items]);
        parts.iter().for_each(|(_, part)| list.extend_from_slice(part));
        Self { starts, list }
    }

    /// Neighbours of an item.
    pub(super) fn of(&self, item: usize) -> &[u32] {
        &self.list[self.starts[item]..self.starts[item + 1]]
    }
}
