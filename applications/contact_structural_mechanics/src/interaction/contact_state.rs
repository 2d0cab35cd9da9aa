//! State of contact: interfaces with their pairs, slave nodes with their states, and the numbers of the run.

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::{ModelPart, bodies_of_nodes};
use zelus_core::{Result, StateMapper};

use crate::active_set::activation::{self, ActivationCriterion};
use crate::active_set::{ActiveSetUpdate, FacetsOfPair, SupportedNodes, corner_nodes, forced_points};
use crate::flags::{MASTER, SLAVE};
use crate::friction;
use crate::interface::{
    NormalPatches, Roles, SlaveIndex, add_contact_part, interfaces, unlike_sections, warnings_of_pairs,
};
use crate::law::MultiplierConstraints;
use crate::pairing::{Pairing, PairingState, integrate, take_normals_of_masters};
use crate::pairs::Pair;
use crate::results::{InterfaceSurfaces, write_masters, write_states};
use crate::safeguards::settle_all;
use crate::search::{GapCheck, OpenSides, Renewal, SetAtStart, assign_roles, farthest_motion};
use crate::settings::{ContactSettings, Setup};
use crate::slave_nodes::{SlaveStates, multiplier_columns, owners_name, write_status};
use crate::tolerances::Tolerances;

/// State of contact.
pub(super) struct ContactState {
    /// Settings and numbers.
    pub setup: Setup,
    /// The pairs.
    pub pairing: Pairing,
    /// The slave nodes.
    pub states: SlaveStates,
    /// Slave nodes that supports hold.
    supported_nodes: SupportedNodes,
    steps_since_search: usize,
    /// Length of the last accepted step (time).
    last_length: f64,
    /// Whether the step has failed before.
    repeated: bool,
    saved: SlaveStates,
    /// Whether slave nodes begin inside their masters.
    pub overlaps: bool,
    /// The surfaces of the interfaces in results.
    surfaces: InterfaceSurfaces,
    /// Notes and warnings for the user.
    pub messages: Vec<Diagnostic>,
}

/// The part of the state that lasts between steps.
#[derive(Serialize, Deserialize)]
pub(super) struct RememberedContact {
    pairing: PairingState,
    states: SlaveStates,
    supported_nodes: SupportedNodes,
    tolerances: Tolerances,
    steps_since_search: usize,
    last_length: f64,
}

impl RememberedContact {
    /// See [`State::remap`](zelus_core::State::remap): facets are everywhere the same.
    pub(super) fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.supported_nodes.remap(mapper);
    }
}

impl ContactState {
    /// Contact with these settings; the interfaces are built at once, so that a wrong part is named early.
    ///
    /// # Errors
    /// Parts that do not exist or hold no facets.
    pub(super) fn new(settings: ContactSettings, part: &mut ModelPart) -> Result<Self> {
        let interfaces = interfaces(part, &settings.parts, &settings.slaves)?;
        add_contact_part(part, &interfaces);
        let mut messages = warnings_of_pairs(part, &settings.slaves, &interfaces);
        let parts = (&settings.parts, &settings.slaves);
        let (of_start, overlaps) = settle_all(part, &interfaces, parts, &settings.solver);
        messages.extend(of_start);
        messages.extend(unlike_sections(part, &interfaces));
        Ok(Self {
            messages,
            overlaps,
            pairing: Pairing::new(interfaces, settings.nodal_normals),
            setup: Setup::new(settings),
            states: SlaveStates::default(),
            supported_nodes: SupportedNodes::default(),
            steps_since_search: usize::MAX,
            last_length: f64::MAX,
            repeated: false,
            saved: SlaveStates::default(),
            surfaces: InterfaceSurfaces::default(),
        })
    }

    /// Makes the states of all nodes that may carry multipliers, none of them in contact.
    pub(super) fn make_states(&mut self, part: &mut ModelPart) {
        let angle = self.setup.settings.solver.feature_angle;
        let name = self.owners_name();
        let formulation = self.setup.settings.formulation;
        let table = self.pairing.make_patches(part, angle, &name, formulation.multiplier);
        write_nodal_normals(part, &self.pairing, &self.supported_nodes);
        if let Some((name, components)) = formulation.multiplier.column() {
            part.slave_nodes.history.add_named(name, components);
        }
        self.states = SlaveStates::of(part, table, formulation.columns());
        self.states.for_all(|state| state.law.active = false);
        if let Some(surface) = &self.setup.settings.surface {
            self.states.add_bonds(surface.cohesive.is_some());
        }
        self.states.take_normals(&self.pairing.normals, &part.nodes.current);
        self.states.set_slaves(self.pairing.slaves());
        self.import_multipliers(part);
        self.states.export(&mut part.nodes);
        let (interfaces, settings) = (&self.pairing.interfaces, &self.setup.settings);
        let parts = (&settings.parts, &settings.slaves);
        self.surfaces = InterfaceSurfaces::add(part, "contact", interfaces, &self.pairing.patches, parts);
    }

    /// Name of the sets of its slave nodes: that of the parts of its pairs.
    fn owners_name(&self) -> String {
        owners_name("contact", &self.setup.settings.slaves, &self.setup.settings.parts)
    }

    /// Takes multipliers that the columns of mesh nodes were given from outside, as by a deck.
    fn import_multipliers(&self, part: &mut ModelPart) {
        multiplier_columns::import(part, &self.states, self.setup.settings.formulation.multiplier);
    }

    /// Whether the step began with a search.
    pub(super) fn is_searched(&self) -> bool {
        self.steps_since_search == 0
    }

    /// Outside its interval contact carries nothing.
    pub(super) fn switch_off(&mut self, part: &mut ModelPart) {
        self.states.for_all(|state| state.law.active = false);
        self.pairing.clear();
        self.clear_inactive(part);
    }

    /// Whether a slave node of an interface is in contact.
    pub(super) fn in_contact(&self, interface: usize) -> bool {
        self.pairing.slaves_of(interface).iter().any(|&slave| self.states[slave].law.active)
    }

    /// Activates these nodes, and keeps those that are in contact.
    pub(super) fn activate(&mut self, part: &ModelPart, start: ActivationCriterion<'_>) {
        activation::start(&part.nodes, &mut self.states, start, self.setup.parameters.slip_rule);
    }

    /// Keeps an accepted state.
    pub(super) fn save(&mut self) {
        self.pairing.save();
        self.saved = self.states.clone();
    }

    /// Goes back to the state kept last; the step begins with a search.
    pub(super) fn restore(&mut self) {
        self.states = self.saved.clone();
        self.pairing.restore(&self.setup);
        (self.steps_since_search, self.repeated) = (usize::MAX, true);
    }

    /// The part of the state that lasts between steps.
    pub(super) fn state(&self) -> RememberedContact {
        RememberedContact {
            pairing: self.pairing.state(),
            states: self.states.clone(),
            supported_nodes: self.supported_nodes.clone(),
            tolerances: self.setup.tolerances,
            steps_since_search: self.steps_since_search,
            last_length: self.last_length,
        }
    }

    /// Restores its state of the same interfaces.
    ///
    /// # Errors
    /// Errors of making blocks.
    pub(super) fn resume(&mut self, part: &mut ModelPart, state: RememberedContact) -> Result<()> {
        let RememberedContact { pairing, states, supported_nodes, tolerances, steps_since_search, last_length } = state;
        self.last_length = last_length;
        supported_nodes.check(part.nodes.len())?;
        (self.supported_nodes, self.setup.tolerances, self.steps_since_search) =
            (supported_nodes, tolerances, steps_since_search);
        self.pairing.resume(self.supported_nodes.planes(), &self.setup, pairing)?;
        self.states.resume(states)?;
        self.pairing.set_states(&self.states);
        self.surfaces.write_states(part, &self.states, self.setup.settings.formulation);
        Ok(())
    }

    /// Normals of the nodes in the present configuration.
    pub(super) fn find_normals(&mut self, part: &mut ModelPart) {
        write_nodal_normals(part, &self.pairing, &self.supported_nodes);
        self.states.take_normals(&self.pairing.normals, &part.nodes.current);
        if self.setup.settings.solver.feature_angle.is_some() {
            let planes = self.supported_nodes.planes();
            take_normals_of_masters(part, &mut self.states, &self.pairing, &|node| planes.contains_key(&node));
        }
    }

    /// Open sides: each search decides which facets are slaves.
    fn assign_open_roles(&mut self, part: &mut ModelPart, renewal: Renewal) -> bool {
        if self.pairing.interfaces.iter().all(|i| !i.open) {
            return false;
        }
        let bodies = bodies_of_nodes(part);
        let Pairing { interfaces, patches, .. } = &mut self.pairing;
        let mut changed = false;
        for (at, interface) in interfaces.iter_mut().enumerate().filter(|(_, interface)| interface.open) {
            let known = OpenSides { bodies: &bodies, patches, interface: at as u32 };
            changed |= assign_roles(part, interface, &known, &self.setup.settings.search, renewal);
            let slaves = interface.nodes_of(Roles::Slave);
            for &node in &interface.nodes {
                let is_slave = slaves.binary_search(&node).is_ok();
                part.nodes.flags.set(SLAVE, node as usize, is_slave);
                part.nodes.flags.set(MASTER, node as usize, !is_slave);
            }
        }
        if !changed && renewal == Renewal::Open {
            return false;
        }
        self.states.set_slaves(self.pairing.slaves());
        let (all, multiplier) = (self.states.all(), self.setup.settings.formulation.multiplier);
        activation::clear_inactive(&mut part.slave_nodes, &mut self.states, multiplier, all);
        self.pairing.find_normal_patches(self.supported_nodes.planes());
        write_nodal_normals(part, &self.pairing, &self.supported_nodes);
        self.states.take_normals(&self.pairing.normals, &part.nodes.current);
        true
    }

    /// Within a step: gives facets that have come to face each other sides, where a deck leaves them open. Collective.
    ///
    /// # Errors
    /// Errors of making blocks.
    pub(super) fn extend_open_roles(&mut self, part: &mut ModelPart) -> Result<()> {
        if self.pairing.interfaces.iter().all(|interface| !interface.open) {
            return Ok(());
        }
        let settings = &self.setup.settings;
        let moved = farthest_motion(part, &self.pairing.nodes()) > self.setup.tolerances.length;
        let looks = settings.solver.feature_angle.is_some() && settings.explicit.is_none();
        if looks && part.ranks.any(moved) && self.assign_open_roles(part, Renewal::Open) {
            self.take_in(part, Vec::new())?;
        }
        Ok(())
    }

    /// Sets the multipliers of slave nodes without contact to zero.
    pub(super) fn clear_inactive(&mut self, part: &mut ModelPart) {
        let (slaves, multiplier) = (self.states.slaves(), self.setup.settings.formulation.multiplier);
        activation::clear_inactive(&mut part.slave_nodes, &mut self.states, multiplier, slaves.iter().copied());
    }

    /// Recomputes overlaps, weighted gaps and areas in the present configuration, and temperatures where friction depends on them.
    pub(super) fn integrate(&mut self, part: &ModelPart) {
        integrate(part, &mut self.pairing, &mut self.states, &mut self.setup);
        if self.setup.has_warm_friction() {
            friction::find_temperatures(part, &mut self.states, &self.pairing.blocks);
        }
    }

    /// Writes pressures, slips and gaps as they are in the present configuration, with the set as it stands, and forgets them.
    pub(super) fn show(&mut self, part: &mut ModelPart, set: &ActiveSetUpdate) {
        let (states, tolerances, overlaps) = (self.states.clone(), self.setup.tolerances, self.pairing.overlaps());
        self.integrate(part);
        set.find_tractions(part, &mut self.states, &self.setup);
        self.write_states(part);
        (self.states, self.setup.tolerances) = (states, tolerances);
        self.pairing.set_overlaps(&overlaps);
    }

    /// Writes pressures, slips, gaps and states of slave nodes to columns of mesh nodes and of the surfaces of interfaces.
    pub(super) fn write_states(&self, part: &mut ModelPart) {
        let formulation = self.setup.settings.formulation;
        write_states(&mut part.nodes, &self.states, formulation.frictional());
        // explicit steps are many and short
        if self.setup.settings.explicit.is_none() {
            write_masters(part, &self.states, &self.pairing.blocks, formulation.frictional());
        }
        self.surfaces.write_states(part, &self.states, formulation);
    }

    /// Takes in pairs that were found within the step.
    ///
    /// # Errors
    /// Errors of making blocks.
    pub(super) fn take_in(&mut self, part: &mut ModelPart, pairs: Vec<Pair>) -> Result<()> {
        self.pairing.add(pairs, &self.setup)?;
        self.hold(part);
        self.integrate(part);
        Ok(())
    }

    /// Decides on bonds of slave nodes that contact finds for the first time, and finds their tractions.
    fn make_bonds(&mut self) {
        let Some(surface) = &self.setup.settings.surface else { return };
        let interfaces = self.pairing.interfaces.iter().zip(self.pairing.slaves_by_interface());
        let own = interfaces.filter(|(interface, _)| surface.bonds(&interface.key));
        let mut bonded: Vec<SlaveIndex> = own.flat_map(|(_, slaves)| slaves).collect();
        bonded.sort_unstable();
        self.states.make_bonds(&bonded);
        self.setup.find_bonds(&mut self.states);
    }

    /// Finds the slave nodes that supports hold together with their masters.
    fn hold(&mut self, part: &ModelPart) {
        if self.setup.settings.mind_supports {
            let keys = self.pairing.keys();
            let facets = keys.iter().map(|&key| FacetsOfPair {
                slave: self.pairing.slave(key),
                slaves: self.pairing.slaves_of_pair(key),
                master: self.pairing.master(key),
            });
            let said = self.supported_nodes.constrain(part, &mut self.states, self.setup.settings.formulation, facets);
            self.messages.extend(said);
        }
        // Bonds give: they determine the tractions of all components, whatever supports do.
        if self.states.has_bonds() {
            self.states.for_each(|_, state| state.law.constraints = MultiplierConstraints::default());
        }
    }

    /// Ends a stage: the states go to the assembly, and to flags and columns.
    pub(super) fn publish(&mut self, part: &mut ModelPart) {
        let formulation = self.setup.settings.formulation;
        if formulation.frictional() && formulation.multiplier.is_unknown() && !self.states.has_bonds() {
            corner_nodes::constrain(&mut self.states);
        }
        self.pairing.set_states(&self.states);
        self.states.export(&mut part.nodes);
        let area = |slave: SlaveIndex| self.states[slave].kinematics.area;
        multiplier_columns::export(part, self.states.table(), &area, self.setup.settings.formulation.multiplier);
        if self.setup.settings.formulation.frictional() {
            write_status(part, &self.states);
        }
    }

    /// Step end: what is not in contact keeps no multiplier.
    pub(super) fn end_step(&mut self, part: &mut ModelPart) {
        self.clear_inactive(part);
        (self.last_length, self.repeated) = (part.info.delta_time, false);
    }

    /// Step start: takes up multipliers from outside; the last accepted state becomes the reference of the step.
    pub(super) fn begin_step(&mut self, part: &mut ModelPart) {
        self.import_multipliers(part);
        self.states.begin_step();
    }

    /// Marks the slave nodes of interfaces whose contact does not open again.
    ///
    /// # Errors
    /// Friction there: its bound under tension is none.
    pub(super) fn join_interfaces(&mut self, part: &ModelPart) -> Result<()> {
        if self.setup.settings.no_separation.is_empty() {
            return Ok(());
        }
        for (interface, slaves) in self.pairing.interfaces.iter().zip(self.pairing.slaves_by_interface()) {
            if !self.setup.settings.no_separation.contains(&interface.key) {
                continue;
            }
            if let Some(slave) = self.states.join(&slaves) {
                let node = part.nodes.ids[self.states.mesh_node(slave) as usize];
                let fact =
                    format!("pair \"{}\" has \"no_separation\" and friction, e.g. at node {node}", interface.key);
                let remedy = "take the friction of the pair out, or tie its surfaces by mesh_tying_process";
                return Err(Diagnostic::error("no-separation", fact).remedy(remedy).into());
            }
        }
        Ok(())
    }

    /// Searches where that is due, and decides which nodes begin the step in contact.
    ///
    /// # Errors
    /// A failed search.
    pub(super) fn find_contact(&mut self, part: &mut ModelPart) -> Result<()> {
        self.clear_inactive(part);
        if self.setup.settings.mind_supports {
            self.supported_nodes.begin_step(part, &self.pairing.interfaces);
            self.pairing.find_normal_patches(self.supported_nodes.planes());
        }
        self.find_normals(part);
        self.steps_since_search = self.steps_since_search.saturating_add(1);
        if self.steps_since_search >= self.setup.settings.database_step_update {
            self.assign_open_roles(part, Renewal::All);
            let warning = self.pairing.search(part, &self.states, &self.setup)?;
            self.messages.extend(warning);
            self.steps_since_search = 0;
            self.find_normals(part);
        }
        self.hold(part);
        self.integrate(part);
        let settings = &self.setup.settings;
        let ratio = part.info.delta_time / self.last_length;
        // Few nodes may be too little to restrain a body that rocks; nodes of bodies that bounce do not stay in contact.
        let fails_or_moves = self.repeated || self.setup.parameters.dynamic;
        let by_gaps = settings.search.check == GapCheck::CheckMapping && !settings.simple_search;
        let keeps = by_gaps && settings.set_at_start == SetAtStart::Kept && !fails_or_moves;
        let in_contact = if keeps { self.pairing.of_bodies_in_contact(part, &self.states) } else { Vec::new() };
        let start = match settings.search.check {
            GapCheck::DirectCheck => ActivationCriterion::Touching(&self.pairing.touching),
            GapCheck::NoCheck => ActivationCriterion::GapBelow(f64::MAX),
            GapCheck::CheckMapping if settings.simple_search => ActivationCriterion::ShareOfMeshSize,
            GapCheck::CheckMapping if keeps => ActivationCriterion::Kept {
                range: self.setup.near(),
                in_contact: &in_contact,
                ratio,
                least: self.setup.tolerances.length,
            },
            GapCheck::CheckMapping => ActivationCriterion::GapBelow(self.setup.near()),
        };
        let rule = self.setup.parameters.slip_rule;
        activation::start(&part.nodes, &mut self.states, start, rule);
        self.make_bonds();
        let settings = &self.setup.settings;
        if self.setup.by_points() {
            forced_points::hold_touching(&mut self.states, &self.pairing.slaves_by_interface(), self.setup.tolerances);
        }
        friction::start_in_stick(part.info.step, &mut self.states, rule, &settings.friction);
        self.pairing.refresh_normals(part, self.setup.updates_normals());
        self.pairing.begin_step(part, &self.states, settings.segmentation.slivers);
        Ok(())
    }
}

/// Writes the column NORMAL of all nodes of the interfaces, masters too.
fn write_nodal_normals(part: &mut ModelPart, pairing: &Pairing, supported_nodes: &SupportedNodes) {
    let all = NormalPatches::new(part.nodes.len(), &pairing.interfaces, pairing.normals.weights());
    all.on_planes(supported_nodes.planes().clone()).write(part);
}
