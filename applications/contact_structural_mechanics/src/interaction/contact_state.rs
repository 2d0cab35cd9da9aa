//! What contact is at a moment: interfaces with their pairs, slave nodes with their states, and the numbers of the run.

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::ModelPart;
use zelus_core::{Carrier, Result};

use super::activation::{self, Start};
use super::contact_settings::ContactSettings;
use super::edges::turn_edges;
use super::friction;
use super::holding::Holding;
use super::integration::integrate;
use super::pair_states::settle_all;
use super::pairing::{Pairing, PairingState};
use super::points;
use super::results::write_states;
use super::set_stage::SetStage;
use super::setup::Setup;
use crate::flags::{MASTER, SLAVE};
use crate::interface::{Roles, add_contact_part, interfaces, warnings_of_pairs};
use crate::pairs::Pair;
use crate::resolution::Resolution;
use crate::search::{GapCheck, assign_roles};
use crate::slave_states::SlaveStates;
use crate::solver::AVERAGED_EDGES;

/// Contact at a moment.
pub(super) struct ContactState {
    /// Settings and numbers.
    pub setup: Setup,
    /// The pairs.
    pub pairing: Pairing,
    /// The slave nodes.
    pub states: SlaveStates,
    /// Slave nodes that supports hold.
    holding: Holding,
    steps_since_search: usize,
    saved: SlaveStates,
    /// What the user is to be told.
    pub messages: Vec<Diagnostic>,
}

/// What contact remembers between steps.
#[derive(Serialize, Deserialize)]
pub(super) struct RememberedContact {
    pairing: PairingState,
    states: SlaveStates,
    holding: Holding,
    resolution: Resolution,
    steps_since_search: usize,
}

impl RememberedContact {
    /// See [`State::carry`](zelus_core::State::carry): facets are everywhere the same.
    pub(super) fn carry(&mut self, carrier: &mut dyn Carrier) {
        self.pairing.carry(carrier);
        self.states.carry(carrier);
        self.holding.carry(carrier);
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
        messages.extend(settle_all(part, &interfaces, (&settings.parts, &settings.slaves)));
        Ok(Self {
            messages,
            pairing: Pairing::new(interfaces, part, settings.nodal_normals),
            setup: Setup::new(settings),
            states: SlaveStates::default(),
            holding: Holding::default(),
            steps_since_search: usize::MAX,
            saved: SlaveStates::default(),
        })
    }

    /// Makes the states of all nodes that may carry multipliers, none of them in contact.
    pub(super) fn make_states(&mut self, part: &mut ModelPart) {
        self.pairing.patches.write(part);
        self.states = SlaveStates::of(part, self.pairing.carriers(), self.setup.settings.family.columns());
        self.states.for_all(|state| state.active = false);
        self.states.set_slaves(self.pairing.slaves());
        self.states.export(&mut part.nodes);
    }

    /// Whether the step began with a search.
    pub(super) fn is_searched(&self) -> bool {
        self.steps_since_search == 0
    }

    /// Outside its interval contact carries nothing.
    pub(super) fn switch_off(&mut self, part: &mut ModelPart) {
        self.states.for_all(|state| state.active = false);
        self.pairing.clear();
        self.clear_inactive(part, &self.states.slaves());
    }

    /// Activates these nodes, and keeps those that are in contact.
    pub(super) fn activate(&mut self, part: &ModelPart, start: Start<'_>) {
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
        self.steps_since_search = usize::MAX;
    }

    /// What it remembers between steps.
    pub(super) fn state(&self) -> RememberedContact {
        RememberedContact {
            pairing: self.pairing.state(),
            states: self.states.clone(),
            holding: self.holding.clone(),
            resolution: self.setup.resolution,
            steps_since_search: self.steps_since_search,
        }
    }

    /// Takes up what it remembered of the same interfaces.
    ///
    /// # Errors
    /// Those of making blocks.
    pub(super) fn resume(&mut self, part: &mut ModelPart, state: RememberedContact) -> Result<()> {
        let RememberedContact { pairing, states, holding, resolution, steps_since_search } = state;
        holding.check(part.nodes.len())?;
        (self.holding, self.setup.resolution, self.steps_since_search) = (holding, resolution, steps_since_search);
        self.pairing.resume(part, &self.holding, &self.setup, pairing)?;
        self.states.resume(states)?;
        self.pairing.set_states(&self.states);
        Ok(())
    }

    /// Normals of the nodes in the present configuration.
    pub(super) fn find_normals(&mut self, part: &mut ModelPart) {
        self.pairing.patches.write(part);
        if !part.info.is(AVERAGED_EDGES) {
            turn_edges(part, &mut self.states, &self.pairing);
        }
        self.states.read_normals(&part.nodes);
    }

    /// Self contact: each search decides which facets are slaves.
    fn assign_open_roles(&mut self, part: &mut ModelPart) {
        if self.pairing.interfaces.iter().all(|i| !i.open) {
            return;
        }
        for interface in self.pairing.interfaces.iter_mut().filter(|i| i.open) {
            assign_roles(part, interface, &self.setup.settings.search);
            let slaves = interface.nodes_of(Roles::Slave);
            for &node in &interface.nodes {
                let is_slave = slaves.binary_search(&node).is_ok();
                part.nodes.flags.set(SLAVE, node as usize, is_slave);
                part.nodes.flags.set(MASTER, node as usize, !is_slave);
            }
        }
        self.states.set_slaves(self.pairing.slaves());
        self.clear_inactive(part, &self.states.carriers());
        self.pairing.find_patches(part, &self.holding);
        self.pairing.patches.write(part);
        self.states.read_normals(&part.nodes);
    }

    pub(super) fn clear_inactive(&mut self, part: &mut ModelPart, of: &[u32]) {
        activation::clear_inactive(&mut part.nodes, &mut self.states, self.setup.settings.family.multiplier, of);
    }

    /// Recomputes overlaps, weighted gaps and areas in the present configuration.
    pub(super) fn integrate(&mut self, part: &ModelPart) {
        integrate(part, &mut self.pairing, &mut self.states, &mut self.setup);
    }

    /// Writes pressures, slips and gaps as they are in the present configuration, with the set as it stands, and forgets them.
    pub(super) fn show(&mut self, part: &mut ModelPart, set: &SetStage) {
        let (states, resolution, overlaps) = (self.states.clone(), self.setup.resolution, self.pairing.overlaps());
        self.integrate(part);
        set.find_tractions(part, &mut self.states, &self.setup);
        write_states(&mut part.nodes, &self.states, self.setup.settings.family.frictional());
        (self.states, self.setup.resolution) = (states, resolution);
        self.pairing.set_overlaps(&overlaps);
    }

    /// Takes in pairs that were found within the step.
    ///
    /// # Errors
    /// Those of making blocks.
    pub(super) fn take_in(&mut self, part: &mut ModelPart, pairs: Vec<Pair>) -> Result<()> {
        self.pairing.add(pairs, &self.setup)?;
        self.hold(part);
        self.integrate(part);
        Ok(())
    }

    /// Finds the slave nodes that supports hold with what their pairs face.
    fn hold(&mut self, part: &ModelPart) {
        if self.setup.settings.mind_supports {
            let keys = self.pairing.keys();
            let facets = keys.iter().map(|&key| (self.pairing.slave(key), self.pairing.master(key)));
            let said = self.holding.hold(part, &mut self.states, self.setup.settings.family, facets);
            self.messages.extend(said);
        }
    }

    /// Ends a stage: the states go to the assembly, and to flags and columns.
    pub(super) fn publish(&mut self, part: &mut ModelPart) {
        self.pairing.set_states(&self.states);
        self.states.export(&mut part.nodes);
    }

    /// Searches where that is due, and decides which nodes begin the step in contact.
    ///
    /// # Errors
    /// A failed search.
    pub(super) fn find_contact(&mut self, part: &mut ModelPart) -> Result<()> {
        self.clear_inactive(part, &self.states.slaves());
        if self.setup.settings.mind_supports {
            self.holding.begin_step(part, &self.pairing.interfaces);
            self.pairing.find_patches(part, &self.holding);
        }
        self.find_normals(part);
        self.steps_since_search = self.steps_since_search.saturating_add(1);
        if self.steps_since_search >= self.setup.settings.database_step_update {
            self.assign_open_roles(part);
            let warning = self.pairing.search(part, &self.states, &self.setup)?;
            self.messages.extend(warning);
            self.steps_since_search = 0;
            self.find_normals(part);
        }
        self.hold(part);
        self.integrate(part);
        let settings = &self.setup.settings;
        let start = match settings.search.check {
            GapCheck::DirectCheck => Start::Touching(&self.pairing.touching),
            GapCheck::NoCheck => Start::Reach(f64::MAX),
            GapCheck::CheckMapping if settings.simple_search => Start::ShareOfMeshSize,
            GapCheck::CheckMapping => Start::Reach(self.setup.near()),
        };
        let rule = self.setup.parameters.slip_rule;
        activation::start(&part.nodes, &mut self.states, start, rule);
        if self.setup.by_points() {
            points::hold_open_interfaces(&mut self.states, &self.pairing.interfaces, self.setup.resolution);
        }
        friction::start_in_stick(part.info.step, &mut self.states, rule, &settings.friction);
        self.pairing.refresh_normals(part, self.setup.updates_normals());
        self.pairing.begin_step(part, &self.states, settings.segmentation.slivers);
        Ok(())
    }
}
