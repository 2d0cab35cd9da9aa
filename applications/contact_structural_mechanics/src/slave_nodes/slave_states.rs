//! States of slave nodes: one typed state each, owned by the interaction that decides on it.
//!
//! Multipliers, displacements and normals of facets are fields of the model; all else that a decision, a pair or an output
//! needs of a slave node stands here. A retried step restores it whole. [`SlaveStates::export`] is the only place that writes it
//! into nodal columns and flags, for output, criteria and the next stage; [`SlaveStates::of`] the only one that reads it back.

use std::ops::{Index, IndexMut, Range};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::flags::{ISOLATED, SLIP};
use zelus_core::Result;
use zelus_core::diagnostics::unfit;
use zelus_core::model::flags::ACTIVE;
use zelus_core::model::{ModelPart, Nodes, Variable};
use zelus_core::vector3::{cross, norm};
use zelus_structural_mechanics::variables::NORMAL;

use super::following_multipliers;
use super::slave_bond::SlaveBond;
use super::slave_state::{Accepted, SlaveKinematics, SlaveLawState, SlaveParameters, SlaveState};
use crate::interface::{NormalPatches, Patches, SlaveIndex};
use crate::law::{FrictionLaw, Multiplier, NodeState, Sliding};
use crate::variables::{
    AUGMENTED_NORMAL_CONTACT_PRESSURE, AUGMENTED_TANGENT_CONTACT_PRESSURE, DYNAMIC_FACTOR, INITIAL_PENALTY,
    KEPT_CONTACT_PRESSURE, MULTIPLIER_WEIGHT, NODAL_AREA, NORMAL_GAP, TANGENT_ETA, TANGENT_XI, WEIGHTED_GAP,
    WEIGHTED_SLIP,
};

/// The nodal columns that states are exported to.
#[derive(Clone, Copy, Default)]
pub struct SlaveColumns {
    /// Whether penalties and tractions do.
    pub tractions: bool,
    /// Whether directions, slips and tractions of friction do.
    pub friction: bool,
    /// The column of history tractions, in formulations that have them.
    pub history_traction: Option<&'static Variable<[f64; 3]>>,
}

/// The slave nodes of an interaction: where they stand, and which owners of unknowns they are.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SlaveTable {
    /// Mesh node of each, ascending.
    pub nodes: Vec<u32>,
    /// Index of each among the [`SlaveNodes`](zelus_core::model::SlaveNodes) of the model part; none where the interaction has
    /// no multipliers there.
    pub owners: Vec<u32>,
}

impl SlaveTable {
    /// The slave nodes of patches, whose names begin with `name`, as owners of unknowns in a model part.
    pub fn of_patches(part: &mut ModelPart, patches: &Patches, name: &str, multiplier: Multiplier) -> Self {
        let names: Vec<String> = (0..patches.count()).map(|patch| set_name(name, patch as u32)).collect();
        for (patch, name) in names.iter().enumerate() {
            part.slave_nodes.set(name, &patches.nodes_of(patch as u32));
        }
        following_multipliers::constrain(part, patches, &names, multiplier);
        let owner = |slave: SlaveIndex| {
            let name = &names[patches.patch(slave) as usize];
            part.slave_nodes.find(name, patches.mesh_node(slave)).expect("a set that was just made")
        };
        Self {
            nodes: patches.all().map(|slave| patches.mesh_node(slave)).collect(),
            owners: patches.all().map(owner).collect(),
        }
    }

    /// One slave node at each of these mesh nodes (ascending), which owns no unknowns.
    pub fn of_nodes(nodes: Vec<u32>) -> Self {
        Self { nodes, owners: Vec::new() }
    }

    /// Slave nodes at a mesh node.
    fn at(&self, node: u32) -> Range<usize> {
        let first = self.nodes.partition_point(|&own| own < node);
        first..first + self.nodes[first..].partition_point(|&own| own == node)
    }
}

/// Name of the set of the slave nodes of a patch; `name` is that of the interaction.
pub fn set_name(name: &str, patch: u32) -> String {
    format!("{name}, patch {patch}")
}

/// The states of all slave nodes of an interaction.
#[derive(Clone, Default, Serialize, Deserialize)]
pub struct SlaveStates {
    #[serde(skip)]
    table: Arc<SlaveTable>,
    slaves: Arc<[SlaveIndex]>,
    states: Vec<SlaveState>,
    /// Bonds of all slave nodes; empty where no bond gives the tractions.
    #[serde(default)]
    bonds: Vec<SlaveBond>,
    /// Whether they may hold, and their damage is a result.
    #[serde(default)]
    shows_damage: bool,
    /// Iterations of the step in which bonds were found.
    #[serde(skip)]
    iterations: usize,
    #[serde(skip)]
    columns: SlaveColumns,
}

impl Index<SlaveIndex> for SlaveStates {
    type Output = SlaveState;

    fn index(&self, slave: SlaveIndex) -> &SlaveState {
        &self.states[slave.place()]
    }
}

impl IndexMut<SlaveIndex> for SlaveStates {
    fn index_mut(&mut self, slave: SlaveIndex) -> &mut SlaveState {
        &mut self.states[slave.place()]
    }
}

impl SlaveStates {
    /// Mesh nodes and owners of the slave nodes.
    pub fn table(&self) -> &SlaveTable {
        &self.table
    }

    /// The states that flags and columns of a part hold at the mesh nodes of a table; all of them count as slaves.
    pub fn of(part: &ModelPart, table: SlaveTable, columns: SlaveColumns) -> Self {
        let states = table.nodes.iter().map(|&node| imported(&part.nodes, node as usize, columns)).collect();
        let slaves = (0..table.nodes.len() as u32).map(SlaveIndex).collect();
        Self { slaves, table: Arc::new(table), states, bonds: Vec::new(), shows_damage: false, iterations: 0, columns }
    }

    /// Number of slave nodes, whether they are on slave facets or not.
    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// All slave nodes, also those that are on no slave facet now.
    pub fn all(&self) -> impl Iterator<Item = SlaveIndex> + use<> {
        (0..self.states.len() as u32).map(SlaveIndex)
    }

    /// Slave nodes on slave facets, ascending.
    pub fn slaves(&self) -> Arc<[SlaveIndex]> {
        self.slaves.clone()
    }

    /// Mesh node of a slave node.
    pub fn mesh_node(&self, slave: SlaveIndex) -> u32 {
        self.table.nodes[slave.place()]
    }

    /// Mesh nodes of the slave nodes on slave facets, ascending, each once.
    pub fn mesh_nodes(&self) -> Vec<u32> {
        let mut nodes: Vec<u32> = self.slaves.iter().map(|&slave| self.mesh_node(slave)).collect();
        nodes.dedup();
        nodes
    }

    /// Slave nodes at a mesh node.
    pub fn at(&self, node: u32) -> impl Iterator<Item = SlaveIndex> + Clone + use<> {
        self.table.at(node).map(|place| SlaveIndex(place as u32))
    }

    /// The slave nodes of each mesh node that has several.
    pub fn at_corners(&self) -> Vec<Range<usize>> {
        let own = self.table.nodes.chunk_by(|a, b| a == b).scan(0, next_range);
        own.filter(|range| range.len() > 1).collect()
    }

    /// The only slave node at a mesh node, of interactions that have one at each.
    ///
    /// # Panics
    /// Where there is none.
    pub fn only_at(&self, node: u32) -> SlaveIndex {
        self.at(node).next().expect("a slave node")
    }

    /// Owner of the unknowns of a slave node among the [`SlaveNodes`](zelus_core::model::SlaveNodes) of the model part.
    pub fn owner(&self, slave: SlaveIndex) -> u32 {
        self.table.owners[slave.place()]
    }

    /// Owners of the unknowns of all slave nodes.
    pub fn owners(&self) -> &[u32] {
        &self.table.owners
    }

    /// Takes up the states of the same slave nodes from a saved run.
    ///
    /// # Errors
    /// The states of others.
    pub fn resume(&mut self, saved: Self) -> Result<()> {
        let ascend = saved.slaves.windows(2).all(|pair| pair[0] < pair[1]);
        let known = saved.slaves.last().is_none_or(|last| last.place() < self.states.len());
        let unlike = saved.states.len() != self.states.len() || saved.bonds.len() != self.bonds.len();
        if unlike || !ascend || !known {
            return Err(unfit("the states of contact that it remembers are of other slave nodes"));
        }
        (self.slaves, self.states, self.bonds) = (saved.slaves, saved.states, saved.bonds);
        Ok(())
    }

    /// Sets which slave nodes are on slave facets; the others are not in contact.
    pub fn set_slaves(&mut self, slaves: Vec<SlaveIndex>) {
        self.slaves = slaves.into();
        for (place, state) in self.states.iter_mut().enumerate() {
            state.law.active &= self.slaves.binary_search(&SlaveIndex(place as u32)).is_ok();
        }
    }

    /// The slave nodes on slave facets with their states.
    pub fn iter(&self) -> impl Iterator<Item = (SlaveIndex, &SlaveState)> + Clone {
        self.slaves.iter().map(|&slave| (slave, &self[slave]))
    }

    /// Changes the state of every slave node on a slave facet.
    pub fn for_each(&mut self, mut change: impl FnMut(SlaveIndex, &mut SlaveState)) {
        for &slave in &*self.slaves() {
            change(slave, &mut self[slave]);
        }
    }

    /// Changes the state of every slave node.
    pub fn for_all(&mut self, change: impl FnMut(&mut SlaveState)) {
        self.states.iter_mut().for_each(change);
    }

    /// The state of the slave nodes at a mesh node in a word, of one in contact where there are several; `None` without any.
    pub fn word(&self, node: u32) -> Option<&'static str> {
        let own = self.at(node).filter(|slave| self.slaves.binary_search(slave).is_ok());
        let state = own.map(|slave| self[slave].contact()).max_by_key(|state| state.is_active())?;
        Some(match state {
            NodeState::Inactive => "is open",
            NodeState::Stick => "is in contact and does not slide",
            NodeState::Slip => "is in contact and slides",
        })
    }

    /// Slave nodes in contact.
    pub fn count_active(&self) -> usize {
        self.iter().filter(|(_, state)| state.law.active).count()
    }

    /// Step start: the last accepted state becomes the reference of the step.
    pub fn begin_step(&mut self) {
        for state in &mut self.states {
            state.last =
                Accepted { weighted_gap: state.kinematics.weighted_gap, history_traction: state.law.history_traction };
            state.law.joined = state.law.active;
        }
        self.bonds.iter_mut().for_each(|bond| bond.last = bond.state);
    }

    /// Gives every slave node a bond, on which the first contact decides; whether there is a law by which bonds hold.
    pub fn add_bonds(&mut self, shows_damage: bool) {
        self.shows_damage = shows_damage;
        self.bonds = vec![SlaveBond::default(); self.states.len()];
    }

    /// Begins to count the iterations of a step.
    pub(super) fn restart_iterations(&mut self) {
        self.iterations = 0;
    }

    /// Counts an iteration of the step.
    pub fn count_iteration(&mut self) {
        self.iterations += 1;
    }

    /// Number of the iteration.
    pub(super) fn iteration(&self) -> usize {
        self.iterations
    }

    /// Whether the damage of bonds is a result.
    pub fn shows_damage(&self) -> bool {
        self.shows_damage
    }

    /// Whether bonds give the tractions of slave nodes.
    pub fn has_bonds(&self) -> bool {
        !self.bonds.is_empty()
    }

    /// The bond of a slave node, where bonds give the tractions.
    pub fn bond(&self, slave: SlaveIndex) -> Option<&SlaveBond> {
        self.bonds.get(slave.place())
    }

    /// The bond of a slave node, to change.
    pub(super) fn bond_mut(&mut self, slave: SlaveIndex) -> &mut SlaveBond {
        &mut self.bonds[slave.place()]
    }

    /// Sets the accepted state of a bond.
    #[cfg(test)]
    pub(crate) fn set_accepted(&mut self, slave: SlaveIndex, state: crate::law::BondState) {
        self.bond_mut(slave).last = state;
    }

    /// Takes the tangential openings of bonds (length) from integrals over pairs.
    pub fn open_bonds(&mut self, sliding: &dyn Fn(SlaveIndex) -> [f64; 3]) {
        for (place, bond) in self.bonds.iter_mut().enumerate() {
            bond.sliding = sliding(SlaveIndex(place as u32));
        }
    }

    /// Whether a slave node has a bond that has not failed.
    pub fn holds(&self, slave: SlaveIndex) -> bool {
        self.bond(slave).is_some_and(|bond| bond.state.holds())
    }

    /// Takes the normals from the model.
    pub fn read_normals(&mut self, nodes: &Nodes) {
        let Some(field) = nodes.history.get(NORMAL.name()) else { return };
        for (&node, state) in self.table.nodes.iter().zip(&mut self.states) {
            state.kinematics.normal = field.vector(0, node as usize);
        }
    }

    /// Takes the normals of patches; a slave node whose facets have no area keeps its normal.
    pub fn take_normals(&mut self, patches: &NormalPatches, places: &[[f64; 3]]) {
        for (place, state) in self.states.iter_mut().enumerate() {
            let sum = patches.sum(place as u32, places);
            let size = norm(sum);
            if size > 0.0 {
                state.kinematics.normal = sum.map(|x| x / size);
            }
        }
    }

    /// Takes the bounds of friction from the numbers of a law at the nodes, of nodes at rest and without pressure.
    pub fn read_friction(&mut self, nodes: &Nodes, law: &FrictionLaw) {
        for (&node, state) in self.table.nodes.iter().zip(&mut self.states) {
            let sliding = Sliding { temperature: state.parameters.temperature, ..Sliding::default() };
            state.parameters.friction = law.bound_at(nodes, node as usize, sliding);
        }
    }

    /// Marks slave nodes whose contact does not open again; the first of them that has friction, which tension leaves no bound.
    pub fn join(&mut self, slaves: &[SlaveIndex]) -> Option<SlaveIndex> {
        for &slave in slaves {
            self[slave].parameters.no_separation = true;
        }
        slaves.iter().copied().find(|&slave| !self[slave].parameters.friction.is_smooth())
    }

    /// Writes flags and columns of the mesh nodes: those of their slave node, or the sum over several.
    pub fn export(&self, nodes: &mut Nodes) {
        for own in self.table.nodes.chunk_by(|a, b| a == b).scan(0, next_range) {
            let at = self.table.nodes[own.start] as usize;
            let states = &self.states[own];
            nodes.flags.set(ACTIVE, at, states.iter().any(|state| state.law.active));
            // Of a node in contact, else of the first.
            let slides = states.iter().find(|state| state.law.active).unwrap_or(&states[0]).law.slides;
            match slides {
                Some(slides) => nodes.flags.set(SLIP, at, slides),
                None => nodes.flags.undefine(SLIP, at),
            }
        }
        for &node in &self.mesh_nodes() {
            let isolated = self.at(node).all(|slave| self[slave].kinematics.isolated);
            nodes.flags.set(ISOLATED, node as usize, isolated);
        }
        let Nodes { values, history, .. } = nodes;
        self.put(values.values_mut(&NODAL_AREA, 0), NodalCombination::Sum, |state| [state.kinematics.area]);
        self.put(values.values_mut(&NORMAL_GAP, 0), NodalCombination::Mean, |state| [state.kinematics.start_gap]);
        self.put(history.values_mut(&WEIGHTED_GAP, 0), NodalCombination::Sum, |state| [state.kinematics.weighted_gap]);
        if history.has(NORMAL.name()) {
            self.put(history.values_mut(&NORMAL, 0), NodalCombination::Direction, |state| state.kinematics.normal);
        }
        if let Some(field) = history.get_mut(KEPT_CONTACT_PRESSURE.name()) {
            self.put(&mut field.levels[0], NodalCombination::Mean, |state| [state.law.uzawa_pressure]);
        }
        if let Some(field) = self.columns.history_traction.and_then(|variable| history.get_mut(variable.name())) {
            self.put(&mut field.levels[0], NodalCombination::Mean, |state| state.law.history_traction);
        }
        if self.columns.friction {
            self.put(history.values_mut(&WEIGHTED_SLIP, 0), NodalCombination::Sum, |state| {
                state.kinematics.weighted_slip
            });
        }
        if !self.columns.tractions {
            return;
        }
        self.put(values.values_mut(&INITIAL_PENALTY, 0), NodalCombination::Mean, |state| [state.parameters.penalty]);
        self.put(values.values_mut(&DYNAMIC_FACTOR, 0), NodalCombination::Mean, |state| {
            [state.parameters.dynamic_factor]
        });
        self.put(values.values_mut(&AUGMENTED_NORMAL_CONTACT_PRESSURE, 0), NodalCombination::Mean, |state| {
            [state.law.pressure]
        });
        if self.columns.friction {
            self.put(values.values_mut(&MULTIPLIER_WEIGHT, 0), NodalCombination::Mean, |state| {
                [state.law.multiplier_weight]
            });
            self.put(values.values_mut(&TANGENT_XI, 0), NodalCombination::Direction, |state| state.law.tangent);
            self.put(values.values_mut(&TANGENT_ETA, 0), NodalCombination::Direction, |state| {
                cross(state.kinematics.normal, state.law.tangent)
            });
            self.put(values.values_mut(&AUGMENTED_TANGENT_CONTACT_PRESSURE, 0), NodalCombination::Mean, |state| {
                state.law.traction
            });
        }
    }

    /// Writes a column at the mesh nodes: the number of the only slave node there, or the combination of several.
    pub fn put<const C: usize>(
        &self,
        column: &mut [f64],
        shown: NodalCombination,
        of: impl Fn(&SlaveState) -> [f64; C],
    ) {
        for own in self.table.nodes.chunk_by(|a, b| a == b).scan(0, next_range) {
            let node = self.table.nodes[own.start] as usize;
            let value = match &self.states[own] {
                [only] => of(only),
                several => shown.combined(several.iter().map(|state| (of(state), state.kinematics.area))),
            };
            column[C * node..C * node + C].copy_from_slice(&value);
        }
    }
}

/// The range of the next chunk, whose length is that of `chunk`.
fn next_range(first: &mut usize, chunk: &[u32]) -> Option<Range<usize>> {
    let start = *first;
    *first += chunk.len();
    Some(start..*first)
}

/// Combination of the numbers of several slave nodes at one mesh node, for columns of mesh nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NodalCombination {
    /// Forces, areas and numbers weighted by them.
    Sum,
    /// Pressures and tractions: the mean by area.
    Mean,
    /// Unit vectors: the direction of the mean by area.
    Direction,
}

impl NodalCombination {
    /// The combination of numbers with areas; all count alike where none has an area.
    pub fn combined<const C: usize>(self, of: impl Iterator<Item = ([f64; C], f64)> + Clone) -> [f64; C] {
        let total: f64 = of.clone().map(|(_, area)| area.max(0.0)).sum();
        let count = of.clone().count() as f64;
        let weight = |area: f64| match self {
            Self::Sum => 1.0,
            _ if total > 0.0 => area.max(0.0) / total,
            _ => 1.0 / count,
        };
        let mut sum = [0.0; C];
        for (numbers, area) in of {
            (0..C).for_each(|c| sum[c] += weight(area) * numbers[c]);
        }
        let size = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
        if self == Self::Direction && size > 0.0 { sum.map(|x| x / size) } else { sum }
    }
}

fn imported(nodes: &Nodes, at: usize, columns: SlaveColumns) -> SlaveState {
    let (values, history) = (&nodes.values, &nodes.history);
    let scalar = |variable| values.values(variable, 0).get(at).copied().unwrap_or(0.0);
    let past = |name: &str| history.get(name).map_or(0.0, |field| field.levels[0][at]);
    let vector = |column: &[f64]| column.get(3 * at..3 * at + 3).map_or([0.0; 3], |v| [v[0], v[1], v[2]]);
    let vector_of = |name: &str, level: usize| {
        history.get(name).map_or([0.0; 3], |field| field.vector(level.min(field.levels.len() - 1), at))
    };
    let history_traction =
        |level| columns.history_traction.map_or([0.0; 3], |variable| vector_of(variable.name(), level));
    SlaveState {
        kinematics: SlaveKinematics {
            isolated: nodes.flags.is(ISOLATED, at),
            normal: vector_of(NORMAL.name(), 0),
            area: scalar(&NODAL_AREA),
            weighted_gap: past(WEIGHTED_GAP.name()),
            weighted_slip: vector_of(WEIGHTED_SLIP.name(), 0),
            ..SlaveKinematics::default()
        },
        law: SlaveLawState {
            active: nodes.flags.is(ACTIVE, at),
            slides: nodes.flags.get(SLIP, at),
            history_traction: history_traction(0),
            uzawa_pressure: past(KEPT_CONTACT_PRESSURE.name()),
            tangent: vector(values.values(&TANGENT_XI, 0)),
            pressure: scalar(&AUGMENTED_NORMAL_CONTACT_PRESSURE),
            traction: vector(values.values(&AUGMENTED_TANGENT_CONTACT_PRESSURE, 0)),
            ..SlaveLawState::default()
        },
        parameters: SlaveParameters {
            penalty: scalar(&INITIAL_PENALTY),
            dynamic_factor: scalar(&DYNAMIC_FACTOR),
            ..SlaveParameters::default()
        },
        last: Accepted { history_traction: history_traction(1), ..Accepted::default() },
    }
}
