//! The contact of all pairs of a deck: search at step start, gaps and active set in every iteration.

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{
    ActiveSet, Complementary, ComplementaryCondition, Coupling, EntityBlock, FirstIterate, Interaction, Join, Massless,
    MasslessNodes, OuterLoop, PairState, Responses, Retry, SetChange,
};
use zelus_core::model::{DofOwners, ModelPart};
use zelus_core::{Error, Result, State, StateMapper};
use zelus_structural_mechanics::variables::{NORMAL, VELOCITY};

use super::contact_state::{ContactState, RememberedContact};
use super::outer_loops::OuterLoops;
use crate::active_set::{ActivationCriterion, ActiveSetUpdate, activation, forced_points};
use crate::adaptation::{Growth, StablePenalty};
use crate::flags::CONTACT;
use crate::friction;
use crate::friction::slip;
use crate::interface::{Bodies, SlaveIndex, check_nodes, find_nodal_h};
use crate::kratos::FirstIterateTangent;
use crate::law::{Multiplier, NodeState, StepParameters};
use crate::results::{heat, inelastic_heat, joins, pair_states, spring_energy, write_forces};
use crate::safeguards::{FreeBodies, InterfacesInContact, SHORTER, near_nodes, too_deep};
use crate::settings::{ContactSettings, Setup};
use crate::slave_nodes::SlaveState;
use crate::variables::{INITIAL_PENALTY, WEIGHTED_GAP, WEIGHTED_SLIP};

/// Iterations after which the choices of the integration are frozen: most steps have converged by then, as in Kratos.
const SETTLED: usize = 5;
/// Share of the weight k² A/c of multipliers that makes redundant ones regular.
const RELAXATION: f64 = 1e-5;

/// Contact in a model part.
pub struct ContactInteraction {
    contact: ContactState,
    set: ActiveSetUpdate,
    loops: OuterLoops,
    in_contact: InterfacesInContact,
    acting: bool,
    /// How explicit steps stiffen the penalty.
    growth: Option<Growth>,
    stable_penalty: StablePenalty,
    /// Nodes of interfaces without contact that this step has activated because a body was free to move.
    free_bodies: FreeBodies,
    warned_of_friction: bool,
    /// Nodes that contact is near to.
    near_nodes: Vec<u32>,
    /// Count of changes of shape of the bodies that its numbers belong to.
    shape: u64,
}

/// State of contact in a saved run.
#[derive(Serialize, Deserialize)]
struct SavedContact {
    contact: RememberedContact,
    set: ActiveSetUpdate,
    loops: OuterLoops,
    in_contact: InterfacesInContact,
    stable_penalty: StablePenalty,
    near_nodes: Vec<u32>,
    warned_of_friction: bool,
}

#[typetag::serde(name = "contact")]
impl State for SavedContact {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.contact.remap(mapper);
        self.loops.remap(mapper);
        mapper.nodes(&mut self.near_nodes);
    }
}

impl ContactInteraction {
    /// Contact with these settings; the interfaces are built at once, so that a wrong part is named early.
    ///
    /// # Errors
    /// Parts that do not exist or hold no facets.
    pub fn new(settings: ContactSettings, part: &mut ModelPart) -> Result<Self> {
        Ok(Self {
            contact: ContactState::new(settings, part)?,
            set: ActiveSetUpdate::default(),
            loops: OuterLoops::default(),
            in_contact: InterfacesInContact::default(),
            acting: true,
            growth: None,
            stable_penalty: StablePenalty::default(),
            free_bodies: FreeBodies::default(),
            warned_of_friction: false,
            near_nodes: Vec::new(),
            shape: 0,
        })
    }

    /// Finds the bodies behind the facets, where points ask them for tractions.
    ///
    /// # Errors
    /// Bodies that cannot tell.
    fn find_bodies(&mut self, part: &ModelPart) -> Result<()> {
        if self.contact.setup.by_points() {
            let thickness = self.contact.setup.parameters.segmentation.axisymmetric;
            self.contact.pairing.bodies = Arc::new(Bodies::new(part, &self.contact.pairing.interfaces, thickness)?);
        }
        self.shape = part.nodes.reshaped;
        Ok(())
    }

    /// # Errors
    /// An explicit step that leaves a slave node too deep in the master: it has no iterations that could fail.
    fn explicit_depth(&self, part: &ModelPart) -> Result<()> {
        let ContactState { setup: Setup { settings, tolerances, .. }, states, .. } = &self.contact;
        let most = settings.solver.largest_penetration;
        match too_deep(part, states, most, tolerances.length, SHORTER) {
            Some(why) => Err(Error::NotConverged(format!("step {} to time {}: {why}", part.info.step, part.info.time))),
            None => Ok(()),
        }
    }

    /// Whether other nodes carry the mass of those of contact in motion.
    fn takes_mass(&self) -> bool {
        self.acting && !self.contact.setup.settings.solver.keeps_mass
    }

    /// Writes the default output variables of the present state.
    fn write_results(&self, part: &mut ModelPart) -> Result<()> {
        self.contact.write_states(part);
        // explicit steps are many and short: the forces would cost as much as the steps
        match self.contact.setup.settings.explicit {
            None => write_forces(part, &self.contact.pairing.as_entities()),
            Some(_) => Ok(()),
        }
    }
}

impl Interaction for ContactInteraction {
    fn name(&self) -> &str {
        "contact"
    }

    fn drives(&self) -> bool {
        self.contact.overlaps
    }

    fn step_factor(&self, part: &ModelPart) -> f64 {
        if part.info.is(CONTACT) { self.contact.setup.settings.solver.delta_time_factor } else { 1.0 }
    }

    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        let (formulation, explicit) = (self.contact.setup.settings.formulation, self.contact.setup.settings.explicit);
        part.nodes.history.add(&NORMAL);
        part.nodes.history.add(&WEIGHTED_GAP);
        if formulation.frictional() {
            part.nodes.history.add(&WEIGHTED_SLIP);
        }
        let levels = part.nodes.history.levels().max(self.contact.setup.parameters.levels_back + 1);
        part.set_levels(levels);
        find_nodal_h(part);
        part.info.marks.insert(CONTACT, explicit.is_none());
        if !self.contact.setup.updates_normals() {
            FirstIterateTangent::announce(part);
        }
        // Forces of a spring by node have a potential, and keep the energy as long as nothing scales them.
        self.contact.setup.settings.adaptation.dynamic_factor = (explicit.is_some()
            && self.contact.setup.settings.weighted_penalty)
            || (self.contact.setup.settings.solver.dynamic_factor && part.nodes.history.has(VELOCITY.name()));
        self.contact.setup.calibrate(part, &self.contact.pairing.interfaces, &mut self.contact.messages)?;
        self.growth = explicit.map(|explicit| explicit.growth(part));
        self.find_bodies(part)?;
        self.contact.make_states(part);
        self.write_results(part)
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.acting = self.contact.setup.settings.interval.contains(part.info.time);
        if self.shape != part.nodes.reshaped {
            self.find_bodies(part)?;
        }
        self.contact.begin_step(part);
        self.set.begin_step();
        self.free_bodies = FreeBodies::default();
        self.loops.begin_step(part, &mut self.contact);
        self.contact.states.read_friction(&part.nodes, self.contact.setup.settings.friction.law);
        self.contact.join_interfaces(part)?;
        if self.acting {
            let settings = &self.contact.setup.settings;
            if part.info.solver.explicit {
                let (given, weighted) = (settings.given.penalty.is_some(), settings.weighted_penalty);
                let revolution = self.contact.setup.parameters.segmentation.revolution();
                let (states, interfaces) = (&mut self.contact.states, &self.contact.pairing.interfaces);
                let (most, factor) =
                    (1.0 + settings.explicit.map_or(0.0, |explicit| explicit.most), settings.solver.delta_time_factor);
                let said =
                    self.stable_penalty.begin_step(part, states, interfaces, revolution, most, given, weighted, factor);
                self.contact.messages.extend(said);
            }
            self.contact.find_contact(part)?;
        } else {
            self.contact.switch_off(part);
        }
        self.contact.publish(part);
        self.loops.keep_start(&self.contact.states);
        Ok(())
    }

    fn finalize_step(&mut self, part: &mut ModelPart) -> Result<()> {
        if self.acting && part.info.solver.explicit {
            self.explicit_depth(part)?;
        }
        self.contact.states.release_failed();
        self.loops.accept(part, &mut self.contact);
        if self.acting {
            self.in_contact.accept(&self.contact.pairing.slaves_by_interface(), &self.contact.states);
        }
        // Nodes that nothing faces any more have no equation that would drive their multipliers to zero.
        self.contact.end_step(part);
        let (formulation, clears) =
            (self.contact.setup.settings.formulation, self.contact.setup.settings.clear_inactive);
        self.contact.states.for_each(|_, state| {
            if clears && !state.law.active {
                (state.law.pressure, state.law.traction) = (0.0, [0.0; 3]);
            }
        });
        if formulation.frictional() {
            let parameters = &self.contact.setup.parameters;
            let states = &self.contact.states;
            if !states.has_bonds() {
                friction::meet_bounds(&mut part.slave_nodes, states, formulation.multiplier, parameters);
            }
            if !self.warned_of_friction {
                let warning = friction::warn_of_pushing(part, &self.contact.states, formulation.multiplier, parameters);
                self.warned_of_friction = warning.is_some();
                self.contact.messages.extend(warning);
            }
        }
        self.contact.publish(part);
        self.write_results(part)
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(SavedContact {
            contact: self.contact.state(),
            set: self.set.clone(),
            loops: self.loops.clone(),
            in_contact: self.in_contact.clone(),
            stable_penalty: self.stable_penalty.clone(),
            near_nodes: self.near_nodes.clone(),
            warned_of_friction: self.warned_of_friction,
        }))
    }

    fn resume(&mut self, part: &mut ModelPart, state: Box<dyn State>) -> Result<()> {
        let SavedContact { contact, set, loops, in_contact, stable_penalty, near_nodes, warned_of_friction } =
            state.take()?;
        self.in_contact = in_contact;
        self.contact.resume(part, contact)?;
        check_nodes(part.nodes.len(), near_nodes.iter().copied())?;
        loops.check(part.nodes.len())?;
        (self.set, self.loops, self.stable_penalty) = (set, loops, stable_penalty);
        (self.near_nodes, self.warned_of_friction) = (near_nodes, warned_of_friction);
        Ok(())
    }

    /// The ALM values of eq. 4.11.
    fn parameters(&self, part: &ModelPart) -> Vec<(&'static str, f64)> {
        if let Some([least, most]) = self.contact.pairing.bodies.stiffness() {
            let factor = self.contact.setup.settings.nitsche.factor;
            return vec![("least γ", factor * least), ("largest γ", factor * most)];
        }
        let penalty = part.info.value_or(INITIAL_PENALTY.name(), 0.0);
        vec![("penalty ε", penalty), ("scale factor k", self.contact.setup.parameters.scale_factor)]
    }

    fn summary(&self, _part: &ModelPart) -> Vec<(&'static str, f64)> {
        let deepest = self.contact.states.iter().filter_map(|(_, state)| state.gap()).fold(0.0, f64::min);
        let mut out = vec![
            ("pairs", self.contact.pairing.len() as f64),
            ("active nodes", self.contact.states.count_active() as f64),
            ("deepest penetration", deepest.abs()),
        ];
        if self.contact.pairing.moved > 0 {
            out.push(("pairs moved to other ranks", self.contact.pairing.moved as f64));
        }
        if self.contact.setup.parameters.dynamic {
            out.push(("work of contact", self.loops.work.done()));
        }
        if self.contact.setup.settings.formulation.updated {
            out.extend([("multiplier updates", self.loops.uzawa.updates as f64), ("rate", self.loops.uzawa.rate)]);
        }
        out
    }

    fn pairs(&self, part: &ModelPart) -> Vec<PairState> {
        let ContactState { setup: Setup { settings, parameters, tolerances, .. }, pairing, states, .. } = &self.contact;
        let formulation = settings.formulation;
        let multiplier = formulation.multiplier;
        let by_springs = matches!(multiplier, Multiplier::None) && !settings.weighted_penalty;
        let of_node = |slave: SlaveIndex, state: &SlaveState| {
            if let Some(bond) = states.bond(slave) {
                return state.kinematics.area * bond.dissipated();
            }
            let slid = || slip(part, states, slave, multiplier, parameters);
            if by_springs {
                return inelastic_heat(state, slid(), parameters.tangent_factor);
            }
            let slides = state.contact() == NodeState::Slip;
            if slides { heat(state.law.traction, slid(), state.kinematics.area) } else { 0.0 }
        };
        let spring = |state: &SlaveState| spring_energy(state, parameters.tangent_factor);
        let soft = states.iter().any(|(_, state)| state.parameters.soft.is_some());
        let has_springs =
            (by_springs || formulation.regularised && !formulation.updated) && !soft && !states.has_bonds();
        let spring: Option<&dyn Fn(&SlaveState) -> f64> = if has_springs { Some(&spring) } else { None };
        let (parts, frictional) = ((&settings.parts, &settings.slaves), settings.formulation.frictional());
        let slaves = pairing.slaves_by_interface();
        pair_states(&pairing.interfaces, parts, (states, &slaves), frictional, tolerances.length, of_node, spring)
    }

    fn node_state(&self, node: u32) -> Option<&'static str> {
        self.contact.states.word(node)
    }

    fn joins(&self, part: &ModelPart) -> Option<Vec<Join>> {
        joins(part, &self.contact.pairing.interfaces, false, self.contact.setup.settings.formulation.frictional())
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.contact.messages)
    }

    fn last_messages(&self, part: &ModelPart) -> Vec<Diagnostic> {
        let settings = &self.contact.setup.settings;
        self.in_contact.warnings(part, &self.contact.pairing.interfaces, (&settings.parts, &settings.slaves))
    }

    fn coupling(&self) -> Option<&dyn Coupling> {
        Some(self)
    }

    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }

    fn first_iterate(&mut self) -> Option<&mut dyn FirstIterate> {
        Some(self)
    }

    fn massless(&mut self) -> Option<&mut dyn Massless> {
        Some(self)
    }

    fn retry(&mut self) -> Option<&mut dyn Retry> {
        Some(self)
    }
}

impl Coupling for ContactInteraction {
    fn unknowns(&self, part: &ModelPart) -> Vec<DofOwners> {
        let unknowns = self.contact.setup.settings.formulation.multiplier.unknowns(part.info.domain_size);
        let owners = self.contact.states.owners();
        unknowns.into_iter().map(|variable| DofOwners::of_slaves(variable, owners.iter().copied())).collect()
    }

    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.contact.pairing.as_entities()
    }

    fn pair_of(&self, block: usize, at: usize) -> Option<(usize, Range<usize>)> {
        self.contact.pairing.pair_of(block, at)
    }

    fn graph_version(&self) -> u64 {
        self.contact.pairing.graph
    }

    fn inactive_diagonal(&self) -> f64 {
        self.contact.setup.parameters.scale_factor
    }

    fn relaxation(&self) -> Option<f64> {
        let parameters = &self.contact.setup.parameters;
        let largest_area = self.contact.states.iter().map(|(_, state)| state.kinematics.area).fold(0.0, f64::max);
        let weight = parameters.scale_factor.powi(2) * largest_area / parameters.stiffness;
        Some(RELAXATION * if largest_area > 0.0 { weight } else { parameters.scale_factor })
    }
}

impl ActiveSet for ContactInteraction {
    fn after_prediction(&mut self, part: &mut ModelPart) -> Result<()> {
        if self.acting {
            self.contact.integrate(part);
            self.set.follow(part, &mut self.contact.states, &self.contact.setup);
            self.set.find_tangents(part, &mut self.contact.states, &self.contact.setup);
            self.contact.publish(part);
        }
        Ok(())
    }

    fn after_update(&mut self, part: &mut ModelPart, iteration: usize) -> Result<SetChange> {
        if !self.acting {
            return Ok(SetChange::default());
        }
        if iteration == 1 || self.contact.setup.updates_normals() {
            self.contact.find_normals(part);
        }
        if self.contact.setup.updates_normals() {
            self.contact.pairing.refresh_normals(part, true);
        }
        if self.contact.setup.by_points() {
            forced_points::release(&mut self.contact.states);
        }
        let (adaptation, explicit) =
            (self.contact.setup.settings.adaptation, self.contact.setup.settings.explicit.is_some());
        let gaps = adaptation.gaps(&self.contact.states, explicit);
        self.contact.integrate(part);
        // A body that nothing restrains yet moves on to where no pairs are; explicit steps do not iterate.
        let moved = !explicit && {
            let (pairing, states) = (&self.contact.pairing, &self.contact.states);
            let length = activation::stabilization_length(part, states, &pairing.slaves_by_interface());
            self.loops.step_search.has_moved(part, &pairing.nodes(), length)
        };
        if iteration <= SETTLED || moved {
            self.contact.extend_open_roles(part)?;
            let (contact, searched) = ((&self.contact.pairing, &self.contact.states), self.contact.is_searched());
            let missed = self.loops.step_search.on_the_way(part, contact, &self.contact.setup, searched)?;
            if !missed.is_empty() {
                self.contact.take_in(part, missed)?;
            }
        }
        if iteration >= SETTLED && !moved {
            self.contact.pairing.freeze_choices(part, &self.contact.states);
        }
        let change = self.set.update(part, &mut self.contact.states, &self.contact.setup, &mut self.contact.messages);
        let penalty = part.info.value_or(INITIAL_PENALTY.name(), 1.0);
        adaptation.adapt(&part.nodes, &mut self.contact.states, penalty, &gaps, self.growth);
        if explicit {
            part.info.marks.insert(CONTACT, self.contact.states.count_active() > 0);
        }
        self.set.find_tangents(part, &mut self.contact.states, &self.contact.setup);
        self.contact.publish(part);
        Ok(change)
    }

    fn show(&mut self, part: &mut ModelPart) {
        if self.acting {
            self.contact.show(part, &self.set);
        }
    }

    fn after_convergence(&mut self, part: &mut ModelPart) -> Result<OuterLoop> {
        if !self.acting {
            return Ok(OuterLoop::Done);
        }
        let outer = self.loops.judge(part, &mut self.contact, &mut self.set)?;
        self.contact.publish(part);
        // Others that look at the converged state, as heat does, read pressures and slips.
        self.contact.write_states(part);
        Ok(outer)
    }

    fn complementary(&mut self) -> Option<&mut dyn Complementary> {
        if self.acting && ActiveSetUpdate::decides_jointly(&self.contact.setup) { Some(self) } else { None }
    }

    fn restrain_free_bodies(&mut self, part: &mut ModelPart) -> bool {
        if !self.acting || self.contact.setup.settings.explicit.is_some() {
            return false;
        }
        let mut any = self.contact.setup.by_points() && forced_points::hold_active(&mut self.contact.states);
        if !any {
            let slaves = self.contact.pairing.slaves_by_interface();
            let near = self.free_bodies.next(&part.nodes, &self.contact.states, &slaves);
            self.contact.activate(part, ActivationCriterion::Touching(&near));
            if self.contact.setup.by_points() {
                forced_points::hold(&mut self.contact.states, &near);
            }
            self.set.find_tangents(part, &mut self.contact.states, &self.contact.setup);
            any = !near.is_empty();
        }
        self.contact.publish(part);
        any
    }

    fn stabilization_length(&self, part: &ModelPart) -> Option<f64> {
        let slaves = self.contact.pairing.slaves_by_interface();
        (self.acting && self.contact.setup.settings.explicit.is_none())
            .then(|| activation::stabilization_length(part, &self.contact.states, &slaves))
    }
}

impl Complementary for ContactInteraction {
    fn conditions(&self, part: &ModelPart) -> Vec<ComplementaryCondition> {
        ActiveSetUpdate::conditions(part, &self.contact.states, &self.contact.setup)
    }

    fn activate_all(&mut self) {
        let mut all = self.contact.states.clone();
        for slave in ActiveSetUpdate::decided_together(&all) {
            (all[slave].law.active, all[slave].law.slides) = (true, Some(true));
        }
        self.contact.pairing.set_states(&all);
    }

    fn restore_decisions(&mut self) {
        self.contact.pairing.set_states(&self.contact.states);
    }

    fn hold(&mut self, held: bool) {
        self.set.hold(held);
    }

    fn decide_states(&mut self, part: &mut ModelPart, responses: &Responses) -> SetChange {
        let change = self.set.decide_states(part, &mut self.contact.states, &self.contact.setup, responses);
        self.contact.publish(part);
        change
    }

    fn decide_together(
        &mut self,
        part: &mut ModelPart,
        responses: Option<&Responses>,
    ) -> Result<(OuterLoop, Option<String>)> {
        let (states, setup) = (&mut self.contact.states, &self.contact.setup);
        let said = self.set.decide_together(part, states, setup, responses);
        if said.is_none() {
            return Ok((self.after_convergence(part)?, None));
        }
        self.contact.publish(part);
        Ok((OuterLoop::Continue, said))
    }
}

impl FirstIterate for ContactInteraction {
    /// Without updates, normals are those after the first iteration.
    fn moved_first(&self) -> Option<Vec<u32>> {
        (self.acting && !self.contact.setup.updates_normals()).then(|| self.contact.pairing.nodes())
    }

    fn keep(&mut self, part: &mut ModelPart) {
        if self.acting {
            self.contact.find_normals(part);
        }
    }
}

impl Massless for ContactInteraction {
    fn begin_dynamic_step(&mut self, part: &ModelPart) {
        if !self.contact.setup.parameters.dynamic {
            self.contact.setup.parameters =
                Arc::new(StepParameters { dynamic: true, ..(*self.contact.setup.parameters).clone() });
        }
        if self.takes_mass() {
            let (pairing, states) = (&self.contact.pairing, &self.contact.states);
            self.near_nodes =
                near_nodes(part, &pairing.nodes(), states, |slaves| pairing.masters_of(slaves), &self.near_nodes);
        }
    }

    fn massless_nodes(&self) -> MasslessNodes {
        if self.takes_mass() {
            MasslessNodes { surface: self.contact.pairing.nodes(), near: self.near_nodes.clone() }
        } else {
            MasslessNodes::default()
        }
    }
}

impl Retry for ContactInteraction {
    fn save(&mut self) {
        self.contact.save();
    }

    fn restore(&mut self) {
        self.contact.restore();
        self.loops.retry();
    }

    fn has_alternative(&self) -> bool {
        self.loops.has_alternative(&self.contact)
    }
}
