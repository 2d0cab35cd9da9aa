//! A whole run between two steps, as a file holds it.
//!
//! Contents of the deck, and objects made from them at the start of a stage (numbers of unknowns, blocks, geometry of interfaces), are
//! made again from the deck; the file holds all later changes, the fields bitwise. A stage is made from the model that the stages
//! before have left, so the file holds that model, too.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, Unknowns};

use super::contents::Contents;
use super::deck::StageDeck;
use super::rank_layout::RankLayout;
use super::report::RunReport;
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Result};
use crate::entities::{EntityBlock, repartition};
use crate::model::{Field, Fields, MeshShare, Model, ModelPart};
use crate::parameters::{Node, Value};

/// States of participants of one kind, in their order.
pub(super) type States = Vec<Option<Box<dyn State>>>;

/// The contents of the file: written from references, read into values.
#[derive(Serialize, Deserialize)]
pub(super) struct SavedRun<M, R> {
    /// Fingerprint of the deck, see [`fingerprint`].
    pub deck: u32,
    /// Stages that are over.
    pub over: usize,
    /// The part of the present or the last stage.
    pub root: String,
    /// The model as the present stage found it; `None` in the first.
    pub before: Option<M>,
    /// The model now.
    pub model: M,
    /// States of the elements of earlier stages, by root part.
    pub systems: BTreeMap<String, States>,
    /// State of the stage under way.
    pub stage: Option<SavedStage>,
    /// The report so far.
    pub report: R,
    /// The mesh file that the first stage names.
    pub mesh: Option<String>,
}

/// State of a stage.
#[derive(Serialize, Deserialize)]
pub(super) struct SavedStage {
    pub begun: bool,
    /// Digests of the files that it has read beside deck and mesh.
    pub contents: Contents,
    pub first_length: Option<f64>,
    /// Layout of the unknowns to which the states of the strategy refer.
    pub unknowns: Unknowns,
    pub strategy: Option<Box<dyn State>>,
    pub elements: States,
    pub conditions: States,
    pub interactions: States,
    pub processes: States,
}

/// A run that was read.
pub(super) type LoadedRun = SavedRun<Model, RunReport>;

impl LoadedRun {
    /// # Errors
    /// A run of another deck, or one that cannot be.
    pub(super) fn check(&self, deck: u32, stages: usize) -> Result<()> {
        if self.deck != deck {
            return Err(other_deck("it was saved by a run of another deck"));
        }
        if self.over > stages || (self.over == stages) && self.stage.is_some() {
            return Err(other_deck(format!("{} stages of {stages} are over", self.over)));
        }
        let models = self.before.iter().chain([&self.model]);
        models.flat_map(|model| model.parts.values()).try_for_each(|part| {
            part.check().map_err(|fact| other_deck(format!("its model part {} is none: {fact}", part.name)))
        })
    }

    /// Nodes and unknowns of the rank in the stage under way.
    pub(super) fn layout_of(&self, rank: usize) -> Option<RankLayout> {
        Some(RankLayout::new(self.model.parts.get(&self.root)?, rank, self.stage.as_ref()?.unknowns.clone()))
    }
}

/// Settings that may change at a restart: they extend the run, or change its messages.
const FREE: [&str; 5] = [
    "problem_data.end_time",
    "problem_data.autosave_minutes",
    "problem_data.echo_level",
    "problem_data.parallel_type",
    // The contents of the mesh are compared themselves.
    "solver_settings.model_import_settings",
];

/// A number that decks share that say the same, however they are written.
pub(super) fn fingerprint(stages: &[StageDeck], like: Option<&str>) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(like.unwrap_or_default().as_bytes());
    for stage in stages {
        hasher.update(stage.name.as_bytes());
        add(&stage.settings, "", &mut hasher);
        stage.modelers.iter().for_each(|modeler| add(modeler, "", &mut hasher));
    }
    hasher.finalize()
}

fn add(node: &Node, path: &str, hasher: &mut crc32fast::Hasher) {
    let mut word = |kind: u8, bytes: &[u8]| {
        hasher.update(&[kind]);
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    };
    match &node.value {
        Value::Null => word(0, &[]),
        Value::Bool(value) => word(1, &[u8::from(*value)]),
        // A deck may write 1 or 1.0.
        Value::Integer(value) => word(2, &(*value as f64).to_le_bytes()),
        Value::Double(value) => word(2, &value.to_le_bytes()),
        Value::String(text) => word(3, text.as_bytes()),
        Value::Array(items) => {
            word(4, &(items.len() as u64).to_le_bytes());
            items.iter().for_each(|item| add(item, path, hasher));
        }
        Value::Object(members) => {
            hasher.update(&[5]);
            for member in members.iter() {
                let inner = if path.is_empty() { member.key.clone() } else { format!("{path}.{}", member.key) };
                if !FREE.contains(&inner.as_str()) {
                    hasher.update(member.key.as_bytes());
                    add(&member.node, &inner, hasher);
                }
            }
        }
    }
}

/// States of the blocks.
pub(super) fn states_of(blocks: &[Box<dyn EntityBlock>]) -> States {
    blocks.iter().map(|block| block.state()).collect()
}

/// Gives each of as many participants its state; `what` they are.
///
/// # Errors
/// Another number of them, or a state of another kind.
pub(super) fn resume_each<T>(
    to: &mut [T],
    states: States,
    what: &str,
    mut resume: impl FnMut(&mut T, Box<dyn State>) -> Result<()>,
) -> Result<()> {
    if to.len() != states.len() {
        let fact = format!("the saved run has {} {what}, this one {}", states.len(), to.len());
        return Err(other_deck(fact));
    }
    to.iter_mut().zip(states).try_for_each(|(own, state)| state.map_or(Ok(()), |state| resume(own, state)))
}

/// Restores the states of the blocks.
///
/// # Errors
/// States of other blocks.
pub(super) fn resume_blocks(blocks: &mut [Box<dyn EntityBlock>], states: States) -> Result<()> {
    resume_each(blocks, states, "blocks of entities", |block, state| block.resume(state))
}

/// The elements of an earlier stage on a part, with their states: `states` of this rank, or of all earlier ranks where it is
/// `repartitioned`.
///
/// # Errors
/// States of other elements.
pub(super) fn earlier_system(part: &ModelPart, mut states: Vec<States>, repartitioned: bool) -> Result<System> {
    let mut system = System::default();
    system.make_blocks(part)?;
    let states = if repartitioned { repartition(&system.elements, states)? } else { states.swap_remove(0) };
    resume_blocks(&mut system.elements, states)?;
    Ok(System { elements: system.elements, ..System::default() })
}

/// # Errors
/// Another mesh than that of the saved run, or values and shares that cannot be of it.
pub(super) fn check_mesh(saved: &ModelPart, read: &ModelPart) -> Result<()> {
    let same = saved.nodes.ids == read.nodes.ids
        && (saved.nodes.reshaped > 0 || saved.nodes.initial == read.nodes.initial)
        && saved.info.domain_size == read.info.domain_size
        && [(&saved.elements, &read.elements), (&saved.conditions, &read.conditions)].into_iter().all(|(a, b)| {
            a.ids == b.ids
                && a.kinds == b.kinds
                && a.properties == b.properties
                && (0..a.len() as u32).all(|at| a.nodes(at) == b.nodes(at))
        });
    if !same {
        return Err(other_deck(format!("the mesh of {} is another than that of the saved run", read.name)));
    }
    let has_columns = |saved: &Fields, read: &Fields| {
        let same = |(name, field): (&str, &Field)| {
            saved
                .get(name)
                .is_some_and(|own| own.components == field.components && own.levels.len() >= field.levels.len())
        };
        read.iter().all(same)
    };
    let shares = match (&saved.share, &read.share) {
        (None, None) => true,
        (Some(a), Some(b)) => {
            MeshShare { pairs: Vec::new(), ..a.clone() } == MeshShare { pairs: Vec::new(), ..b.clone() }
        }
        _ => false,
    };
    let fits = shares
        && saved.slave_nodes.is_alike(&read.slave_nodes)
        && read.properties.keys().all(|id| saved.properties.contains_key(id))
        && has_columns(&saved.nodes.history, &read.nodes.history)
        && has_columns(&saved.nodes.values, &read.nodes.values)
        && has_columns(&saved.slave_nodes.history, &read.slave_nodes.history)
        && has_columns(&saved.elements.data, &read.elements.data)
        && has_columns(&saved.conditions.data, &read.conditions.data);
    if fits { Ok(()) } else { Err(other_deck(format!("its part {} does not fit the deck", read.name))) }
}

/// The models of all ranks as one that has everything, of which a stage takes its share; that of one rank as it is.
///
/// # Errors
/// Models that do not make up a whole.
pub(super) fn whole(mut models: Vec<Model>) -> Result<Model> {
    if models.len() == 1 {
        return Ok(models.swap_remove(0));
    }
    let mut by_name: BTreeMap<String, Vec<ModelPart>> = BTreeMap::new();
    for (name, part) in models.into_iter().flat_map(|model| model.parts) {
        by_name.entry(name).or_default().push(part);
    }
    let joined = |(name, shares)| Ok((name, ModelPart::merged(shares).map_err(other_deck)?));
    Ok(Model { parts: by_name.into_iter().map(joined).collect::<Result<_>>()?, ..Model::default() })
}

/// Error: a saved run does not belong to the deck.
pub(super) fn other_deck(fact: impl Into<String>) -> crate::diagnostics::Error {
    Diagnostic::error("saved-run", fact)
        .remedy("restart with the deck and mesh that it was saved by, or run this deck from its start")
        .into()
}
