//! Contact and ties by linear constraints: slave nodes follow the master surface while they press on it.
//!
//! An active node is held along its normal (without friction, or sliding) or in all components (sticking, tied). It is
//! released when the constraint would have to pull, and held again when it penetrates. A node sticks while the tangential
//! force of its constraint is below the bound of friction; beyond, a force of that size acts on it and on its masters instead,
//! against the slip ([`slider_forces`](super::slider_forces)).

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{
    ActiveSet, Coupling, EntityBlock, Interaction, Join, Massless, MasslessNodes, OuterLoop, PairState, Retry,
    SetChange, require_kind,
};
use zelus_core::model::{EntityRole, MasterSlaveConstraint, ModelPart, Nodes};
use zelus_core::vector3::{dot, norm, scale};
use zelus_core::{Result, State, StateMapper};
use zelus_structural_mechanics::laws::representative_young;
use zelus_structural_mechanics::variables::{NORMAL, REACTION};

use super::mpc_friction::{MpcFriction, reaction};
use super::mpc_impact::MpcImpact;
use super::mpc_kind::MpcKind;
use super::mpc_results::write_results;
use super::mpc_settings::{MpcSettings, refuse_rigid_shapes, require_slaves_of_first_order};
use super::node_relation::{FollowingComponents, NodeRelation, can_follow};
use super::relations::Relations;
use crate::active_set::activation::{self, ActivationCriterion};
use crate::active_set::length_tolerance;
use crate::flags::{CONTACT, MASTER, SLAVE};
use crate::friction;
use crate::interface::{
    Interface, Roles, SlaveIndex, add_contact_part, check_nodes, find_nodal_h, interfaces, nodal_normals, set_sides,
    sides, slave_nodes, slaves_without_master, unlike_sections, warnings_of_pairs,
};
use crate::law::SlipRule;
use crate::pairs::{Friction, condition_name};
use crate::results::{joins, pair_states};
use crate::safeguards::{FreeBodies, InterfacesInContact, settle_all};
use crate::slave_nodes::{SlaveColumns, SlaveState, SlaveStates, SlaveTable};
use crate::variables::{NODAL_H, WEIGHTED_GAP, WEIGHTED_SLIP};

/// Iterations in which relations follow every motion: without sliders, and with them.
const SETTLED: [usize; 2] = [15, 5];
/// Motion since relations were made, in mesh sizes, up to which they are those of the iterate.
const STILL: f64 = 1e-9;
/// Motion, in mesh sizes, after which they are renewed in any iteration.
const FAR: f64 = 1e-2;

/// Contact by constraints in a model part.
pub struct MpcInteraction {
    settings: MpcSettings,
    interfaces: Vec<Interface>,
    /// Whether slave nodes begin inside their masters.
    overlaps: bool,
    states: SlaveStates,
    saved: SlaveStates,
    relations: Relations,
    friction: MpcFriction,
    impact: MpcImpact,
    young: f64,
    first_id: usize,
    version: u64,
    steps_since_search: usize,
    acting: bool,
    sided: bool,
    free_bodies: FreeBodies,
    warned_of_held: bool,
    warned_of_untied: bool,
    in_contact: InterfacesInContact,
    messages: Vec<Diagnostic>,
}

/// State of contact by constraints in a saved run.
#[derive(Serialize, Deserialize)]
struct SavedMpc {
    sides: Vec<Vec<Roles>>,
    states: SlaveStates,
    relations: Relations,
    directions: BTreeMap<u32, [f64; 3]>,
    versions: [u64; 2],
    steps_since_search: usize,
    sided: bool,
    warned_of_held: bool,
    in_contact: InterfacesInContact,
    impact: MpcImpact,
}

#[typetag::serde(name = "mpc_contact")]
impl State for SavedMpc {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.relations.remap(mapper);
        mapper.node_map(&mut self.directions);
        self.impact.remap(mapper);
    }
}

impl MpcInteraction {
    /// Contact with these settings; the interfaces are built at once, so that a wrong part is named early.
    ///
    /// # Errors
    /// Parts that do not exist or hold no facets.
    pub fn new(settings: MpcSettings, part: &mut ModelPart) -> Result<Self> {
        let interfaces = interfaces(part, &settings.parts, &settings.slaves)?;
        require_slaves_of_first_order(part, &interfaces)?;
        refuse_rigid_shapes(&interfaces)?;
        add_contact_part(part, &interfaces);
        let mut messages = warnings_of_pairs(part, &settings.slaves, &interfaces);
        let mut overlaps = false;
        messages.extend(unlike_sections(part, &interfaces));
        if !settings.ties() {
            let parts = (&settings.parts, &settings.slaves);
            let (of_start, inside) = settle_all(part, &interfaces, parts, &settings.solver);
            messages.extend(of_start);
            overlaps = inside;
        }
        Ok(Self {
            messages,
            overlaps,
            settings,
            interfaces,
            states: SlaveStates::default(),
            saved: SlaveStates::default(),
            relations: Relations::default(),
            friction: MpcFriction::default(),
            impact: MpcImpact::default(),
            young: 0.0,
            first_id: 0,
            version: 0,
            steps_since_search: usize::MAX,
            acting: false,
            sided: false,
            free_bodies: FreeBodies::default(),
            warned_of_held: false,
            warned_of_untied: false,
            in_contact: InterfacesInContact::default(),
        })
    }

    /// Exchanges the sides of interfaces whose slaves are all held by supports: constraints move slaves, and these cannot move.
    fn take_sides(&mut self, part: &mut ModelPart) {
        if std::mem::replace(&mut self.sided, true) || !self.settings.swaps_held_slaves {
            return;
        }
        for interface in self.interfaces.iter_mut().filter(|interface| !interface.open) {
            let [slaves, masters] = [Roles::Slave, Roles::Master].map(|role| interface.nodes_of(role));
            let held = |nodes: &[u32]| {
                nodes
                    .iter()
                    .all(|&node| !can_follow(part, node, self.states[self.states.only_at(node)].kinematics.normal))
            };
            if !held(&slaves) || held(&masters) {
                continue;
            }
            for facet in &mut interface.facets {
                facet.role = if facet.role == Roles::Slave { Roles::Master } else { Roles::Slave };
            }
            for (nodes, is_slave) in [(&slaves, false), (&masters, true)] {
                for &node in nodes {
                    part.nodes.flags.set(SLAVE, node as usize, is_slave);
                    part.nodes.flags.set(MASTER, node as usize, !is_slave);
                }
            }
            let fact = format!(
                "supports hold the slave side of contact pair \"{}\", and constraints move slaves: its sides are exchanged",
                interface.key
            );
            let remedy = "name the side that can move as slave";
            self.messages.push(Diagnostic::warning("mpc-held-slaves", fact).remedy(remedy));
        }
        self.set_slaves();
    }

    /// Nodes of slave facets, each with one slave node: constraints hold displacements of mesh nodes.
    fn set_slaves(&mut self) {
        let slaves = slave_nodes(&self.interfaces).into_iter().map(|node| self.states.only_at(node)).collect();
        self.states.set_slaves(slaves);
    }

    /// Slave nodes of each interface.
    fn slaves_by_interface(&self) -> Vec<Vec<SlaveIndex>> {
        let of = |interface: &Interface| {
            interface.nodes_of(Roles::Slave).into_iter().map(|node| self.states.only_at(node)).collect()
        };
        self.interfaces.iter().map(of).collect()
    }

    /// Names nodes in contact that supports hold along their normals, while their masters are free: nothing holds those there.
    fn warn_of_held(&mut self, part: &ModelPart) {
        if self.warned_of_held || self.settings.ties() {
            return;
        }
        let presses = |node: u32, relation: &NodeRelation| {
            let n = relation.normal;
            self.states[self.states.only_at(node)].law.active
                && !can_follow(part, node, n)
                && relation.weights.iter().any(|&(master, _)| can_follow(part, master, n))
        };
        let resolved = length_tolerance(part, &self.states.mesh_nodes());
        let held = self.relations.nodes.iter().filter(|(node, relation)| presses(**node, relation));
        let depth = |node: u32| {
            let state = &self.states[self.states.only_at(node)];
            -state.kinematics.weighted_gap / state.kinematics.area
        };
        let depths = held.map(|(&node, _)| (node, depth(node))).filter(|of| of.1 > resolved);
        let depths: Vec<(u32, f64)> = depths.collect();
        let Some(&(node, depth)) = depths.iter().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))) else { return };
        self.warned_of_held = true;
        let fact = format!(
            "supports hold {} slave nodes in contact along their normals: constraints cannot hold the masters there, and node \
             {} is {depth:.1e} inside the other body",
            depths.len(),
            part.nodes.ids[node as usize]
        );
        let remedy = "make the other side the slave, or use alm_contact_process";
        self.messages.push(Diagnostic::warning("mpc-held-nodes", fact).remedy(remedy));
    }

    /// Normals and relations of this iterate, where nodes have moved since they were made.
    ///
    /// The tangent does not know how they change, which slows iterations whose sliders hardly slide: later ones change them
    /// only where nodes have moved far.
    fn follow(&mut self, part: &mut ModelPart, iteration: usize) {
        let settled = SETTLED[usize::from(!self.friction.sliders.is_empty())];
        let least = if iteration <= settled { STILL } else { FAR };
        if self.relations.farthest(part, &self.interfaces) > least {
            nodal_normals(part, &self.interfaces);
            let warning = self.relations.search(part, &self.interfaces, &self.settings, &self.states);
            self.messages.extend(warning);
        }
    }

    /// Puts the constraints of the active nodes into the model part.
    fn write_constraints(&mut self, part: &mut ModelPart) {
        let (first, slaves) = (self.first_id, self.states.mesh_nodes());
        let own = |c: &MasterSlaveConstraint| c.id >= first && slaves.binary_search(&c.slave.0).is_ok();
        let mut constraints = std::mem::take(&mut part.constraints);
        constraints.retain(|c| !own(c));
        let mut next_id = constraints.iter().map(|c| c.id + 1).max().unwrap_or(1).max(first);
        for (&node, relation) in &self.relations.nodes {
            let state = &self.states[self.states.only_at(node)];
            if state.law.active {
                let hold = match self.settings.kind {
                    MpcKind::Frictionless => FollowingComponents::Normal { push: [0.0; 3] },
                    MpcKind::Frictional if state.law.slides == Some(true) => {
                        let direction = self.friction.directions.get(&node).copied().unwrap_or_default();
                        FollowingComponents::Normal { push: scale(direction, state.parameters.friction.coefficient) }
                    }
                    MpcKind::Frictional => FollowingComponents::Stick,
                    MpcKind::MeshTying if self.settings.consistent() => FollowingComponents::Tied,
                    MpcKind::MeshTying => FollowingComponents::Closed,
                };
                let keeps = self.settings.keeps_first_opening && part.info.step <= 1;
                let relation = if keeps { &relation.keeping_opening() } else { relation };
                relation.constraints(part, node, hold, &mut next_id, &mut constraints);
            }
        }
        part.constraints = constraints;
        self.version += 1;
    }

    /// Contact opens where a constraint pulls and closes where a free node penetrates: the sign of the force that holds a
    /// node and of its depth times a stiffness together, so that a depth of round-off holds nothing.
    fn update_contact(&mut self, part: &ModelPart, change: &mut SetChange) {
        let release = self.settings.reaction_check_stiffness_factor * self.young;
        let stiffness = stiffness(self.young, &part.nodes);
        for &slave in &*self.states.slaves() {
            let node = self.states.mesh_node(slave);
            let id = part.nodes.ids[node as usize];
            let stiffness = stiffness(node);
            let state = &mut self.states[slave];
            let was = state.law.active;
            state.law.active = self.relations.nodes.get(&node).is_some_and(|relation| {
                let held = if was { dot(reaction(part, node), relation.normal) } else { 0.0 };
                let depth = state.kinematics.weighted_gap.min(0.0);
                state.kinematics.area > 0.0 && held + stiffness * depth < -release * state.kinematics.area
            });
            match (was, state.law.active) {
                (false, true) => {
                    if self.settings.kind == MpcKind::Frictional {
                        state.law.slides =
                            Some(state.parameters.friction.is_smooth() || self.friction.rule == SlipRule::Pure);
                    }
                    change.activated.push(id);
                }
                (true, false) => change.deactivated.push(id),
                _ => {}
            }
        }
    }

    fn integrate(&mut self, part: &ModelPart) {
        self.relations.integrate(part, &self.interfaces, &self.settings, &mut self.states);
    }
}

/// Stiffness of the body behind a node (force by volume).
fn stiffness(young: f64, nodes: &Nodes) -> impl Fn(u32) -> f64 {
    let sizes = nodes.values.values(&NODAL_H, 0);
    move |node| match sizes[node as usize] {
        size if size > 0.0 => young / size,
        _ => young,
    }
}

impl Interaction for MpcInteraction {
    fn name(&self) -> &str {
        "contact by constraints"
    }

    fn drives(&self) -> bool {
        self.overlaps
    }

    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        part.nodes.history.add(&NORMAL);
        part.nodes.history.add(&WEIGHTED_GAP);
        part.nodes.history.add(&REACTION);
        find_nodal_h(part);
        part.info.marks.insert(CONTACT, true);
        self.first_id = part.constraints.iter().map(|c| c.id + 1).max().unwrap_or(1);
        let largest = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, f64::max);
        let young = |id| part.properties.get(id).and_then(representative_young);
        let facets = self.interfaces.iter().flat_map(|i| &i.facets);
        self.young = largest(&mut facets.filter_map(|facet| young(&facet.properties)));
        if self.young == 0.0 {
            self.young = largest(&mut part.properties.keys().filter_map(young));
        }
        if self.settings.kind == MpcKind::Frictionless {
            let law = self.settings.friction.law;
            self.messages.extend(friction::unread_coefficient(part, &self.interfaces, law));
        }
        if self.settings.kind == MpcKind::Frictional {
            part.nodes.history.add(&WEIGHTED_SLIP);
            let friction = if self.settings.pure_slip { Friction::PureSlip } else { Friction::Coulomb };
            self.friction.rule =
                friction::prepare(part, &self.interfaces, &self.settings.friction, friction, &mut self.messages)?;
            let facet = &self.interfaces[0].facets[0];
            let name = condition_name("MPCMortarContactCondition", facet.shape, facet.shape);
            self.friction.entry = Some(require_kind(EntityRole::Condition, &name)?);
        }
        nodal_normals(part, &self.interfaces);
        let columns = SlaveColumns { friction: self.settings.kind == MpcKind::Frictional, ..SlaveColumns::default() };
        let nodes: BTreeSet<u32> = self.interfaces.iter().flat_map(|i| i.nodes.iter().copied()).collect();
        self.states = SlaveStates::of(part, SlaveTable::of_nodes(nodes.into_iter().collect()), columns);
        self.set_slaves();
        Ok(())
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.acting = self.settings.interval.contains(part.info.time);
        self.states.read_friction(&part.nodes, self.settings.friction.law);
        if !self.acting {
            self.states.for_each(|_, state| state.law.active = false);
            self.relations.clear();
            self.friction.set_sliders(Vec::new(), part.info.domain_size);
            self.write_constraints(part);
            self.states.export(&mut part.nodes);
            return Ok(());
        }
        nodal_normals(part, &self.interfaces);
        self.states.read_normals(&part.nodes);
        self.take_sides(part);
        self.relations.find_edges(part, &self.interfaces, &self.settings);
        self.free_bodies = FreeBodies::default();
        self.steps_since_search = self.steps_since_search.saturating_add(1);
        if self.settings.ties() && self.settings.consistent() && !self.relations.pairs.is_empty() {
            self.relations.relate(part, &self.interfaces, &self.settings, &[], &self.states);
        } else if self.steps_since_search >= self.settings.database_step_update {
            let warning = self.relations.search(part, &self.interfaces, &self.settings, &self.states);
            self.messages.extend(warning);
            self.steps_since_search = 0;
        }
        self.integrate(part);
        if self.settings.ties() {
            for &node in self.relations.nodes.keys() {
                let slave = self.states.only_at(node);
                self.states[slave].law.active = true;
            }
            if !std::mem::replace(&mut self.warned_of_untied, true) {
                let slaves = slave_nodes(&self.interfaces);
                let without: Vec<u32> =
                    slaves.iter().copied().filter(|node| !self.relations.nodes.contains_key(node)).collect();
                self.messages.extend(slaves_without_master(part, &without, slaves.len()));
            }
        } else {
            activation::start(&part.nodes, &mut self.states, ActivationCriterion::ShareOfMeshSize, self.friction.rule);
            friction::start_in_stick(part.info.step, &mut self.states, self.friction.rule, &self.settings.friction);
            self.friction.slide_on(part, &self.relations.nodes, &self.states);
        }
        self.write_constraints(part);
        self.states.export(&mut part.nodes);
        self.impact.keep_start(&self.states);
        Ok(())
    }

    fn finalize_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.warn_of_held(part);
        self.messages.extend(self.impact.accept(part, self.settings.kind == MpcKind::Frictionless));
        if self.acting {
            self.in_contact.accept(&self.slaves_by_interface(), &self.states);
        }
        let sticks = self.settings.kind == MpcKind::Frictional || self.settings.ties();
        write_results(part, &mut self.states, &self.relations.nodes, &self.friction, sticks);
        Ok(())
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(SavedMpc {
            sides: sides(&self.interfaces),
            states: self.states.clone(),
            relations: self.relations.clone(),
            directions: self.friction.directions.clone(),
            versions: [self.version, self.friction.graph],
            steps_since_search: self.steps_since_search,
            sided: self.sided,
            warned_of_held: self.warned_of_held,
            in_contact: self.in_contact.clone(),
            impact: self.impact.clone(),
        }))
    }

    fn resume(&mut self, part: &mut ModelPart, state: Box<dyn State>) -> Result<()> {
        let saved: SavedMpc = state.take()?;
        set_sides(&mut self.interfaces, saved.sides)?;
        self.states.resume(saved.states)?;
        saved.relations.check(&self.interfaces, part.nodes.len(), &self.states)?;
        check_nodes(part.nodes.len(), saved.directions.keys().copied())?;
        saved.impact.check(part.nodes.len())?;
        (self.relations, self.impact) = (saved.relations, saved.impact);
        (self.friction.directions, [self.version, self.friction.graph]) = (saved.directions, saved.versions);
        (self.steps_since_search, self.sided) = (saved.steps_since_search, saved.sided);
        (self.warned_of_held, self.in_contact) = (saved.warned_of_held, saved.in_contact);
        self.warned_of_untied = true;
        Ok(())
    }

    fn constraints_version(&self) -> u64 {
        self.version
    }

    fn summary(&self, _part: &ModelPart) -> Vec<(&'static str, f64)> {
        vec![("pairs", self.relations.pairs.len() as f64), ("active nodes", self.states.count_active() as f64)]
    }

    fn pairs(&self, part: &ModelPart) -> Vec<PairState> {
        let parts = (&self.settings.parts, &self.settings.slaves);
        let friction = self.settings.kind == MpcKind::Frictional;
        let of_node = |slave: SlaveIndex, state: &SlaveState| {
            let node = self.states.mesh_node(slave);
            // Friction adds a force to the constraint that is proportional to the pressure, or the slider's own.
            let bound = state
                .parameters
                .friction
                .at(dot(reaction(part, node), state.kinematics.normal) / state.kinematics.area);
            norm(state.kinematics.weighted_slip) * bound
        };
        let (holds, least) = (friction || self.settings.ties(), length_tolerance(part, &self.states.mesh_nodes()));
        let mut out = pair_states(
            &self.interfaces,
            parts,
            (&self.states, &self.slaves_by_interface()),
            holds,
            least,
            of_node,
            None,
        );
        for (interface, pair) in self.interfaces.iter().zip(&mut out) {
            let held = interface
                .nodes_of(Roles::Slave)
                .into_iter()
                .filter(|&node| self.states[self.states.only_at(node)].law.active);
            pair.constraint_forces = held.map(|node| (node, reaction(part, node))).collect();
        }
        out
    }

    fn node_state(&self, node: u32) -> Option<&'static str> {
        self.states.word(node)
    }

    fn joins(&self, part: &ModelPart) -> Option<Vec<Join>> {
        joins(part, &self.interfaces, self.settings.ties(), self.settings.kind == MpcKind::Frictional)
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn last_messages(&self, part: &ModelPart) -> Vec<Diagnostic> {
        self.in_contact.warnings(part, &self.interfaces, (&self.settings.parts, &self.settings.slaves))
    }

    fn coupling(&self) -> Option<&dyn Coupling> {
        Some(self)
    }

    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }

    fn massless(&mut self) -> Option<&mut dyn Massless> {
        let takes_mass = !self.settings.ties() && self.acting;
        takes_mass.then_some(self as &mut dyn Massless)
    }

    fn retry(&mut self) -> Option<&mut dyn Retry> {
        Some(self)
    }
}

impl Massless for MpcInteraction {
    fn begin_dynamic_step(&mut self, part: &ModelPart) {
        self.impact.begin_dynamic_step(part, &self.interfaces, &self.states, &self.relations);
    }

    fn massless_nodes(&self) -> MasslessNodes {
        if self.settings.solver.keeps_mass {
            MasslessNodes::default()
        } else {
            self.impact.massless_nodes(&self.interfaces)
        }
    }
}

impl Coupling for MpcInteraction {
    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.friction.sliders.iter().map(|forces| forces as &dyn EntityBlock).collect()
    }

    fn pair_of(&self, block: usize, at: usize) -> Option<(usize, Range<usize>)> {
        let (slave, masters) = self.friction.sliders.get(block)?.nodes(at).split_last()?;
        let is_of = |interface: &Interface| interface.nodes_of(Roles::Slave).binary_search(slave).is_ok();
        Some((self.interfaces.iter().position(is_of)?, 0..masters.len()))
    }

    fn graph_version(&self) -> u64 {
        self.friction.graph
    }
}

impl ActiveSet for MpcInteraction {
    fn needs_reactions(&self) -> bool {
        !self.settings.ties()
    }

    fn after_update(&mut self, part: &mut ModelPart, iteration: usize) -> Result<SetChange> {
        let mut change = SetChange::default();
        if !self.acting {
            return Ok(change);
        }
        if self.settings.update_each_iteration && !self.settings.ties() && self.settings.update_relations {
            self.follow(part, iteration);
        } else if self.settings.update_each_iteration && !(self.settings.ties() && self.settings.consistent()) {
            nodal_normals(part, &self.interfaces);
            self.relations.renew(part, &self.interfaces, &self.settings, &self.states);
        }
        self.integrate(part);
        if !self.settings.ties() {
            self.update_contact(part, &mut change);
        }
        if self.settings.kind == MpcKind::Frictional {
            let stiffness = stiffness(self.young, &part.nodes);
            self.friction.update(part, &self.relations.nodes, &mut self.states, stiffness, &mut change);
        }
        if self.settings.update_each_iteration || change.count() > 0 || !self.friction.directions.is_empty() {
            self.write_constraints(part);
        }
        self.states.export(&mut part.nodes);
        Ok(change)
    }

    fn after_convergence(&mut self, part: &mut ModelPart) -> Result<OuterLoop> {
        if !self.acting || self.settings.ties() {
            return Ok(OuterLoop::Done);
        }
        self.impact.judge(part, &mut self.states, &self.relations, &self.friction, &self.settings.solver)
    }

    fn restrain_free_bodies(&mut self, part: &mut ModelPart) -> bool {
        if !self.acting || self.settings.ties() {
            return false;
        }
        let near = self.free_bodies.next(&part.nodes, &self.states, &self.slaves_by_interface());
        activation::start(&part.nodes, &mut self.states, ActivationCriterion::Touching(&near), self.friction.rule);
        self.write_constraints(part);
        self.states.export(&mut part.nodes);
        !near.is_empty()
    }

    fn stabilization_length(&self, part: &ModelPart) -> Option<f64> {
        (self.acting && !self.settings.ties())
            .then(|| activation::stabilization_length(part, &self.states, &self.slaves_by_interface()))
    }
}

impl Retry for MpcInteraction {
    fn save(&mut self) {
        self.relations.save();
        self.friction.save();
        self.saved = self.states.clone();
    }

    fn restore(&mut self) {
        self.relations.restore();
        self.friction.restore();
        self.states = self.saved.clone();
        self.steps_since_search = usize::MAX;
    }
}
