//! What contact knows of its slave nodes: one typed state a node, owned by the interaction that decides on it.
//!
//! Multipliers, displacements and normals of facets are fields of the model; all else that a decision, a pair or an output
//! needs of a slave node stands here. A retried step restores it whole. [`SlaveStates::export`] is the only place that writes it
//! into nodal columns and flags, for output, criteria and the next stage; [`SlaveStates::of`] the only one that reads it back.

use std::ops::{Index, IndexMut};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::flags::{ISOLATED, SLIP};
use zelus_core::Carrier;
use zelus_core::Result;
use zelus_core::diagnostics::unfit;
use zelus_core::model::flags::ACTIVE;
use zelus_core::model::{ModelPart, Nodes, Variable};
use zelus_core::vector3::cross;
use zelus_structural_mechanics::variables::NORMAL;

use crate::friction_law::{Bound, FrictionLaw};
use crate::node_state::{Held, NodeState, Turning};
use crate::variables::{
    AUGMENTED_NORMAL_CONTACT_PRESSURE, AUGMENTED_TANGENT_CONTACT_PRESSURE, DYNAMIC_FACTOR, INITIAL_PENALTY,
    KEPT_CONTACT_PRESSURE, MULTIPLIER_WEIGHT, NODAL_AREA, NORMAL_GAP, TANGENT_ETA, TANGENT_XI, WEIGHTED_GAP,
    WEIGHTED_SLIP,
};

/// One slave node.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SlaveState {
    /// Whether it is in contact.
    pub active: bool,
    /// Whether it slides, while it is in contact or was last; `None` before.
    pub slides: Option<bool>,
    /// Whether it faces nothing that could bear on it.
    pub isolated: bool,
    /// Unit normal out of the slave body.
    pub normal: [f64; 3],
    /// Whether that is the normal of what it meets, and does not turn with its own facets: nodes on sharp edges.
    pub normal_of_master: bool,
    /// Pairs that overlap at it.
    pub pairs: u32,
    /// Area that belongs to it, over its pairs.
    pub area: f64,
    /// Weighted gap g̃ over its pairs, negative in penetration (length times area).
    pub weighted_gap: f64,
    /// Weighted gaps of its pairs, averaged by their areas (length times area).
    pub mean_weighted_gap: f64,
    /// Weighted slip of the step over its pairs (length times area).
    pub weighted_slip: [f64; 3],
    /// Tangential traction before the law of friction limits it; where points decide, their mean traction (force per area).
    pub trial: [f64; 3],
    /// Tangential traction carried from step to step, in families that do (force per area).
    pub carried: [f64; 3],
    /// Normal pressure that Uzawa's iteration keeps between updates, negative in compression (force per area).
    pub kept_pressure: f64,
    /// Penalty ε.
    pub penalty: f64,
    /// Factor of contact forces in the step in which a gap closes.
    pub dynamic_factor: f64,
    /// Limit of the tangential traction.
    pub friction: Bound,
    /// What becomes of each component of its multiplier; of a scalar one the first.
    pub held: [Held; 3],
    /// Weight of its multiplier's equation where that states a traction (force times area).
    pub multiplier_weight: f64,
    /// Unit tangent τ: the direction of sliding.
    pub tangent: [f64; 3],
    /// How that direction turns with the unknowns.
    pub turning: Turning,
    /// Whether points around it are in contact until the next solve, whatever their pressure.
    pub pressed: bool,
    /// Whether points in contact around it stick until the next solve, whatever their traction.
    pub stuck: bool,
    /// Gap with which it began the step near the master, else 0 (length).
    pub start_gap: f64,
    /// Normal traction for output, compression negative.
    pub pressure: f64,
    /// Tangential traction for output.
    pub traction: [f64; 3],
    /// What it was in the last accepted state.
    pub last: Accepted,
}

/// What of a slave node is compared with its last accepted state.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Accepted {
    /// Weighted gap.
    pub weighted_gap: f64,
    /// Carried traction.
    pub carried: [f64; 3],
}

impl SlaveState {
    /// Whether the node is in contact, and how.
    pub fn contact(&self) -> NodeState {
        match (self.active, self.slides) {
            (false, _) => NodeState::Inactive,
            (true, Some(true)) => NodeState::Slip,
            (true, _) => NodeState::Stick,
        }
    }

    /// Gap g̃/A (length); `None` where nothing overlaps.
    pub fn gap(&self) -> Option<f64> {
        (self.area > 0.0).then(|| self.weighted_gap / self.area)
    }
}

/// What of the states has nodal columns.
#[derive(Clone, Copy, Default)]
pub struct Columns {
    /// Whether penalties and tractions do.
    pub tractions: bool,
    /// Whether directions, slips and tractions of friction do.
    pub friction: bool,
    /// The column of tractions that are carried from step to step, in families that do.
    pub carried: Option<&'static Variable<[f64; 3]>>,
}

/// The states of all nodes that may carry multipliers.
#[derive(Clone, Default, Serialize, Deserialize)]
pub struct SlaveStates {
    #[serde(skip)]
    carriers: Arc<[u32]>,
    slaves: Arc<[u32]>,
    /// By node index; [`NONE`] for nodes without state.
    #[serde(skip)]
    slots: Arc<[u32]>,
    states: Vec<SlaveState>,
    #[serde(skip)]
    columns: Columns,
}

const NONE: u32 = u32::MAX;

impl Index<u32> for SlaveStates {
    type Output = SlaveState;

    fn index(&self, node: u32) -> &SlaveState {
        &self.states[self.slots[node as usize] as usize]
    }
}

impl IndexMut<u32> for SlaveStates {
    fn index_mut(&mut self, node: u32) -> &mut SlaveState {
        &mut self.states[self.slots[node as usize] as usize]
    }
}

impl SlaveStates {
    /// The states that flags and columns of a part hold, of `carriers` (ascending); all of them count as slaves.
    pub fn of(part: &ModelPart, carriers: Vec<u32>, columns: Columns) -> Self {
        let nodes = &part.nodes;
        let mut slots = vec![NONE; nodes.len()];
        carriers.iter().enumerate().for_each(|(slot, &node)| slots[node as usize] = slot as u32);
        let states = carriers.iter().map(|&node| imported(nodes, node as usize, columns)).collect();
        let carriers: Arc<[u32]> = carriers.into();
        Self { slaves: carriers.clone(), carriers, slots: slots.into(), states, columns }
    }

    /// Nodes that may carry multipliers, ascending.
    pub fn carriers(&self) -> Arc<[u32]> {
        self.carriers.clone()
    }

    /// Nodes on slave facets, ascending.
    pub fn slaves(&self) -> Arc<[u32]> {
        self.slaves.clone()
    }

    /// See [`State::carry`](zelus_core::State::carry): every rank has all carriers, in the same order.
    pub fn carry(&mut self, carrier: &mut dyn Carrier) {
        let mut slaves = self.slaves.to_vec();
        carrier.nodes(&mut slaves);
        self.slaves = slaves.into();
    }

    /// Takes up the states of the same carriers from a saved run.
    ///
    /// # Errors
    /// The states of others.
    pub fn resume(&mut self, saved: Self) -> Result<()> {
        let carries = |node: &u32| self.carriers.binary_search(node).is_ok();
        let ascend = saved.slaves.windows(2).all(|pair| pair[0] < pair[1]);
        if saved.states.len() != self.states.len() || !ascend || !saved.slaves.iter().all(carries) {
            return Err(unfit("the states of contact that it remembers are of other nodes"));
        }
        (self.slaves, self.states) = (saved.slaves, saved.states);
        Ok(())
    }

    /// Sets which carriers are on slave facets; the others are not in contact.
    pub fn set_slaves(&mut self, slaves: Vec<u32>) {
        self.slaves = slaves.into();
        for (node, state) in self.carriers.iter().zip(&mut self.states) {
            state.active &= self.slaves.binary_search(node).is_ok();
        }
    }

    /// The slave nodes with their states.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &SlaveState)> + Clone {
        self.slaves.iter().map(|&node| (node, &self[node]))
    }

    /// Changes the state of every slave node.
    pub fn for_each(&mut self, mut change: impl FnMut(u32, &mut SlaveState)) {
        for &node in &*self.slaves() {
            change(node, &mut self[node]);
        }
    }

    /// Changes the state of every carrier.
    pub fn for_all(&mut self, change: impl FnMut(&mut SlaveState)) {
        self.states.iter_mut().for_each(change);
    }

    /// Whether a node has a state and is in contact.
    pub fn is_active(&self, node: u32) -> bool {
        self.slots.get(node as usize).is_some_and(|&slot| slot != NONE && self.states[slot as usize].active)
    }

    /// The state of a slave node in a word; `None` for other nodes.
    pub fn word(&self, node: u32) -> Option<&'static str> {
        self.slaves.binary_search(&node).ok()?;
        Some(match self[node].contact() {
            NodeState::Inactive => "is open",
            NodeState::Stick => "is in contact and does not slide",
            NodeState::Slip => "is in contact and slides",
        })
    }

    /// Slave nodes in contact.
    pub fn count_active(&self) -> usize {
        self.iter().filter(|(_, state)| state.active).count()
    }

    /// Step start: what was accepted last is what the step compares with.
    pub fn begin_step(&mut self) {
        for state in &mut self.states {
            state.last = Accepted { weighted_gap: state.weighted_gap, carried: state.carried };
        }
    }

    /// Takes the normals from the model.
    pub fn read_normals(&mut self, nodes: &Nodes) {
        let Some(field) = nodes.history.get(NORMAL.name()) else { return };
        for (&node, state) in self.carriers.iter().zip(&mut self.states) {
            state.normal = field.vector(0, node as usize);
        }
    }

    /// Takes the bounds of friction from the numbers of a law at the nodes.
    pub fn read_friction(&mut self, nodes: &Nodes, law: &FrictionLaw) {
        for (&node, state) in self.carriers.iter().zip(&mut self.states) {
            state.friction = law.bound_at(nodes, node as usize);
        }
    }

    /// Writes flags and columns of the carriers.
    pub fn export(&self, nodes: &mut Nodes) {
        for (&node, state) in self.carriers.iter().zip(&self.states) {
            let at = node as usize;
            nodes.flags.set(ACTIVE, at, state.active);
            match state.slides {
                Some(slides) => nodes.flags.set(SLIP, at, slides),
                None => nodes.flags.undefine(SLIP, at),
            }
        }
        self.slaves.iter().for_each(|&node| nodes.flags.set(ISOLATED, node as usize, self[node].isolated));
        let Nodes { values, history, .. } = nodes;
        self.put(values.values_mut(&NODAL_AREA, 0), |state| [state.area]);
        self.put(values.values_mut(&NORMAL_GAP, 0), |state| [state.start_gap]);
        self.put(history.values_mut(&WEIGHTED_GAP, 0), |state| [state.weighted_gap]);
        if let Some(field) = history.get_mut(KEPT_CONTACT_PRESSURE.name()) {
            self.put(&mut field.levels[0], |state| [state.kept_pressure]);
        }
        if let Some(field) = self.columns.carried.and_then(|variable| history.get_mut(variable.name())) {
            self.put(&mut field.levels[0], |state| state.carried);
        }
        if self.columns.friction {
            self.put(history.values_mut(&WEIGHTED_SLIP, 0), |state| state.weighted_slip);
        }
        if !self.columns.tractions {
            return;
        }
        self.put(values.values_mut(&INITIAL_PENALTY, 0), |state| [state.penalty]);
        self.put(values.values_mut(&DYNAMIC_FACTOR, 0), |state| [state.dynamic_factor]);
        self.put(values.values_mut(&AUGMENTED_NORMAL_CONTACT_PRESSURE, 0), |state| [state.pressure]);
        if self.columns.friction {
            self.put(values.values_mut(&MULTIPLIER_WEIGHT, 0), |state| [state.multiplier_weight]);
            self.put(values.values_mut(&TANGENT_XI, 0), |state| state.tangent);
            self.put(values.values_mut(&TANGENT_ETA, 0), |state| cross(state.normal, state.tangent));
            self.put(values.values_mut(&AUGMENTED_TANGENT_CONTACT_PRESSURE, 0), |state| state.traction);
        }
    }

    fn put<const C: usize>(&self, column: &mut [f64], of: impl Fn(&SlaveState) -> [f64; C]) {
        for (&node, state) in self.carriers.iter().zip(&self.states) {
            column[C * node as usize..C * node as usize + C].copy_from_slice(&of(state));
        }
    }
}

fn imported(nodes: &Nodes, at: usize, columns: Columns) -> SlaveState {
    let (values, history) = (&nodes.values, &nodes.history);
    let scalar = |variable| values.values(variable, 0).get(at).copied().unwrap_or(0.0);
    let past = |name: &str| history.get(name).map_or(0.0, |field| field.levels[0][at]);
    let vector = |column: &[f64]| column.get(3 * at..3 * at + 3).map_or([0.0; 3], |v| [v[0], v[1], v[2]]);
    let vector_of = |name: &str, level: usize| {
        history.get(name).map_or([0.0; 3], |field| field.vector(level.min(field.levels.len() - 1), at))
    };
    let carried = |level| columns.carried.map_or([0.0; 3], |variable| vector_of(variable.name(), level));
    SlaveState {
        active: nodes.flags.is(ACTIVE, at),
        slides: nodes.flags.get(SLIP, at),
        isolated: nodes.flags.is(ISOLATED, at),
        normal: vector_of(NORMAL.name(), 0),
        area: scalar(&NODAL_AREA),
        weighted_gap: past(WEIGHTED_GAP.name()),
        weighted_slip: vector_of(WEIGHTED_SLIP.name(), 0),
        carried: carried(0),
        kept_pressure: past(KEPT_CONTACT_PRESSURE.name()),
        penalty: scalar(&INITIAL_PENALTY),
        dynamic_factor: scalar(&DYNAMIC_FACTOR),
        tangent: vector(values.values(&TANGENT_XI, 0)),
        pressure: scalar(&AUGMENTED_NORMAL_CONTACT_PRESSURE),
        traction: vector(values.values(&AUGMENTED_TANGENT_CONTACT_PRESSURE, 0)),
        last: Accepted { carried: carried(1), ..Accepted::default() },
        ..SlaveState::default()
    }
}
