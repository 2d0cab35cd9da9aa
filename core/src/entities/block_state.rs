//! State of the entities of a block, as it stands in a saved run: by the ids of the entities.

use rustc_hash::FxHashMap;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, packed, stored_as_bytes};

use super::block::EntityBlock;
use crate::diagnostics::{Diagnostic, Result};

/// State of entities of one kind.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct BlockState {
    kind: String,
    /// Ids of its entities.
    ids: Vec<usize>,
    /// Where the bytes of each entity end.
    ends: Vec<usize>,
    /// As the kernel writes them, one entity after the other.
    #[serde(with = "serde_bytes")]
    bytes: Vec<u8>,
}

stored_as_bytes!(BlockState);

#[typetag::serde(name = "entities")]
impl State for BlockState {
    /// Entities go to other ranks by their ids.
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
}

impl BlockState {
    /// State of entities of a kind.
    pub(super) fn of(kind: &str, ids: &[usize], states: &[impl Serialize]) -> Self {
        let (mut bytes, mut ends) = (Vec::new(), Vec::with_capacity(states.len()));
        for state in states {
            packed::append(state, &mut bytes).expect("numbers can be written");
            ends.push(bytes.len());
        }
        Self { kind: kind.to_owned(), ids: ids.to_vec(), ends, bytes }
    }

    /// The states of these entities of a kind.
    ///
    /// # Errors
    /// Other entities, or states of other materials.
    pub(super) fn states<T: DeserializeOwned>(self, kind: &str, ids: &[usize]) -> Result<Vec<T>> {
        let fits = self.kind == kind && self.ids == ids && self.ends.len() == ids.len();
        let states = self.of_entities().take(if fits { usize::MAX } else { 0 });
        let states: Vec<T> = states.map_while(|bytes| packed::from_bytes(bytes?).ok()).collect();
        if fits && states.len() == ids.len() {
            return Ok(states);
        }
        let fact = format!("what {} {} remember does not fit {} {kind}", self.ids.len(), self.kind, ids.len());
        Err(Diagnostic::error("saved-state", fact)
            .remedy("it was saved by a run with another mesh or other materials")
            .into())
    }

    /// The bytes of each entity; `None` where there are none.
    fn of_entities(&self) -> impl Iterator<Item = Option<&[u8]>> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| self.bytes.get(start..end))
    }
}

/// States of `blocks` (as they begin), from the states of the earlier blocks of all ranks.
///
/// # Errors
/// Entities that no rank had; blocks whose state goes by no ids.
pub(crate) fn repartition(
    blocks: &[Box<dyn EntityBlock>],
    of_ranks: Vec<Vec<Option<Box<dyn State>>>>,
) -> Result<Vec<Option<Box<dyn State>>>> {
    let known: Vec<BlockState> =
        of_ranks.into_iter().flatten().flatten().map(|state| state.take()).collect::<Result<_, _>>()?;
    let mut pool: FxHashMap<(&str, usize), &[u8]> = FxHashMap::default();
    for state in &known {
        let of_entities = state.ids.iter().zip(state.of_entities());
        pool.extend(of_entities.filter_map(|(&id, bytes)| Some(((state.kind.as_str(), id), bytes?))));
    }
    let of_block = |block: &dyn EntityBlock| {
        let Some(state) = block.state() else { return Ok(None) };
        let BlockState { kind, ids, mut ends, mut bytes } = state.take()?;
        ends.clear();
        bytes.clear();
        for &id in &ids {
            let found = pool.get(&(kind.as_str(), id)).ok_or_else(|| {
                let fact = format!("the history of {kind} {id} is not in the saved run");
                Diagnostic::error("saved-state", fact).remedy("restart with the mesh and deck that it was saved by")
            })?;
            bytes.extend_from_slice(found);
            ends.push(bytes.len());
        }
        let state: Box<dyn State> = Box::new(BlockState { kind, ids, ends, bytes });
        Ok(Some(state))
    };
    blocks.iter().map(|block| of_block(block.as_ref())).collect()
}
