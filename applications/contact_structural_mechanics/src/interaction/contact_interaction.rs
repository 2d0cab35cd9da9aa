//! The contact of all pairs of a deck: search at step start, gaps and active set in every iteration.

use std::sync::Arc;

use zelus_core::Result;
use zelus_core::entities::{
    ActiveSet, Coupling, EntityBlock, FirstIterate, Interaction, Massless, MasslessNodes, Outer, Retry, SetChange,
};
use zelus_core::model::flags::{CONTACT, MASTER, SLAVE};
use zelus_core::model::{ModelPart, ScalarVariable, variables::NORMAL, variables::VELOCITY};

use super::activation::{self, Start};
use super::bearable_penalty::BearablePenalty;
use super::contact_settings::ContactSettings;
use super::edges::turn_edges;
use super::friction;
use super::friction_ramp::FrictionRamp;
use super::holding::Holding;
use super::impact::{coarse_impact, near_nodes};
use super::integration::integrate;
use super::pairing::Pairing;
use super::penalty_ramp::PenaltyRamp;
use super::points;
use super::reach::Reach;
use super::set_stage::SetStage;
use super::setup::Setup;
use super::step_parameters::StepParameters;
use super::step_search::StepSearch;
use super::uzawa::Uzawa;
use super::work::ContactWork;
use crate::interface::{Bodies, Roles, add_contact_part, find_nodal_h, interfaces};
use crate::kratos::FirstIterateTangent;
use crate::pairs::{Multiplier, Pair};
use crate::penalty_adaptation::Growth;
use crate::search::{GapCheck, assign_roles};
use crate::slave_states::SlaveStates;
use crate::solver::{AVERAGED_EDGES, COMPUTE_DYNAMIC_FACTOR, ENSURE_CONTACT, KEEP_MASS};
use crate::variables::{INITIAL_PENALTY, WEIGHTED_GAP, WEIGHTED_SLIP};

/// Iterations after which pairs go on as they integrate: most steps have converged by then, as in the reference program.
const SETTLED: usize = 5;
/// Share of the weight k² A/c of multipliers that makes redundant ones regular.
const RELAXATION: f64 = 1e-5;

/// Contact in a model part.
pub struct ContactInteraction {
    setup: Setup,
    pairing: Pairing,
    states: SlaveStates,
    saved: SlaveStates,
    set: SetStage,
    step_search: StepSearch,
    steps_since_search: usize,
    acting: bool,
    uzawa: Uzawa,
    /// How much of the penalty acts, where it is all there is.
    penalty_ramp: PenaltyRamp,
    /// Whether friction waits for contact.
    friction_ramp: FrictionRamp,
    /// How explicit steps stiffen the penalty.
    growth: Option<Growth>,
    bearable: BearablePenalty,
    /// Slave nodes that supports hold.
    holding: Holding,
    /// What open interfaces have taken hold of in this step because a body was free to move.
    reach: Reach,
    warned_of_friction: bool,
    /// Nodes that contact is near to.
    near_nodes: Vec<u32>,
    /// Weighted gaps at the start of the step.
    start_gaps: Vec<f64>,
    /// What the last attempt at the step made of the energy of motion, where that was too much.
    impact_error: f64,
    work: ContactWork,
}

impl ContactInteraction {
    /// Contact with these settings; the interfaces are built at once, so that a wrong part is named early.
    ///
    /// # Errors
    /// Parts that do not exist or hold no facets.
    pub fn new(settings: ContactSettings, part: &mut ModelPart) -> Result<Self> {
        let interfaces = interfaces(part, &settings.parts, &settings.slaves)?;
        add_contact_part(part, &interfaces);
        Ok(Self {
            pairing: Pairing::new(interfaces, part, settings.nodal_normals),
            setup: Setup::new(settings),
            states: SlaveStates::default(),
            saved: SlaveStates::default(),
            set: SetStage::default(),
            step_search: StepSearch::default(),
            steps_since_search: usize::MAX,
            acting: true,
            uzawa: Uzawa::default(),
            penalty_ramp: PenaltyRamp::default(),
            friction_ramp: FrictionRamp::default(),
            growth: None,
            bearable: BearablePenalty::default(),
            holding: Holding::default(),
            reach: Reach::default(),
            warned_of_friction: false,
            near_nodes: Vec::new(),
            start_gaps: Vec::new(),
            impact_error: 0.0,
            work: ContactWork::default(),
        })
    }

    /// Normals of the nodes in the present configuration.
    fn find_normals(&mut self, part: &mut ModelPart) {
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

    fn clear_inactive(&mut self, part: &mut ModelPart, of: &[u32]) {
        activation::clear_inactive(&mut part.nodes, &mut self.states, self.setup.settings.family.multiplier, of);
    }

    /// Recomputes overlaps, weighted gaps and areas in the present configuration.
    fn integrate(&mut self, part: &ModelPart) {
        integrate(part, &mut self.pairing, &mut self.states, &mut self.setup);
    }

    /// Takes in pairs that were found within the step.
    ///
    /// # Errors
    /// Those of making blocks.
    fn take_in(&mut self, part: &mut ModelPart, pairs: Vec<Pair>) -> Result<()> {
        self.pairing.add(pairs, &self.setup)?;
        self.hold(part);
        self.integrate(part);
        Ok(())
    }

    /// Finds the slave nodes that supports hold with what their pairs face.
    fn hold(&mut self, part: &mut ModelPart) {
        if self.setup.settings.mind_supports {
            let keys = self.pairing.keys();
            let facets = keys.iter().map(|&key| (self.pairing.slave(key), self.pairing.master(key)));
            self.holding.hold(part, &mut self.states, self.setup.settings.family, facets);
        }
    }

    /// Ends a stage: the states go to the assembly, and to flags and columns.
    fn publish(&mut self, part: &mut ModelPart) {
        self.pairing.set_states(&self.states);
        self.states.export(&mut part.nodes);
    }

    /// Searches where that is due, and decides which nodes begin the step in contact.
    ///
    /// # Errors
    /// A failed search.
    fn find_contact(&mut self, part: &mut ModelPart) -> Result<()> {
        self.clear_inactive(part, &self.states.slaves());
        if self.setup.settings.mind_supports {
            self.holding.begin_step(part, &self.pairing.interfaces);
            self.pairing.find_patches(part, &self.holding);
        }
        self.find_normals(part);
        self.steps_since_search = self.steps_since_search.saturating_add(1);
        if self.steps_since_search >= self.setup.settings.database_step_update {
            self.assign_open_roles(part);
            self.pairing.search(part, &self.states, &self.setup)?;
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

    /// What follows in a converged state, in the order in which one needs the other.
    ///
    /// # Errors
    /// Those of making blocks; contact that a deck asks for and that is not there.
    fn judge_converged(&mut self, part: &mut ModelPart) -> Result<Outer> {
        let (family, scale_factor) = (self.setup.settings.family, self.setup.parameters.scale_factor);
        if family.updated {
            let outer = self.uzawa.update(&part.nodes, &mut self.states, scale_factor, self.setup.settings.uzawa);
            if outer != Outer::Done {
                return Ok(outer);
            }
        }
        if self.setup.ramps_penalty()
            && self.penalty_ramp.after_convergence(&part.info, &mut self.states) == Outer::Again
        {
            return Ok(Outer::Again);
        }
        let settled = self.set.settle(part, &mut self.states, &self.setup);
        if settled != Outer::Done {
            return Ok(settled);
        }
        let (contact, searched) = ((&self.pairing, &self.states), self.steps_since_search == 0);
        let (missed, outer) = self.step_search.in_converged_state(part, contact, &self.setup, searched)?;
        if !missed.is_empty() {
            self.set.forget_sets();
            self.take_in(part, missed)?;
            self.set.update(part, &mut self.states, &self.setup);
            self.set.find_tangents(part, &mut self.states, &self.setup);
        }
        if outer != Outer::Done {
            return Ok(outer);
        }
        let (law, resolution) = (self.setup.settings.friction.law, self.setup.resolution);
        if self.friction_ramp.after_convergence(part, &mut self.states, law, resolution) == Outer::Again {
            self.set.forget_sets();
            self.set.find_tangents(part, &mut self.states, &self.setup);
            return Ok(Outer::Again);
        }
        // Points in the master press in every state that has converged.
        if !self.setup.by_points()
            && let Some(why) = self.setup.rules().passed_through(&part.nodes, &self.states)
        {
            return Ok(Outer::Failed(why));
        }
        if part.info.is(ENSURE_CONTACT) && self.states.count_active() == 0 {
            return Err(zelus_core::Error::NotConverged(
                "no node is in contact, and \"ensure_contact\" asks for one".to_owned(),
            ));
        }
        self.friction_ramp.solve();
        if self.setup.parameters.dynamic {
            self.work.of_step(part, &self.pairing.as_entities())?;
            if let Some(why) = self.work.too_much(part) {
                return Ok(Outer::Failed(why));
            }
        }
        let slaves = self.states.slaves();
        Ok(coarse_impact(part, &slaves, family, scale_factor, &self.start_gaps, &mut self.impact_error))
    }
}

impl Interaction for ContactInteraction {
    fn name(&self) -> &str {
        "contact"
    }

    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        let (family, explicit) = (self.setup.settings.family, self.setup.settings.explicit);
        part.nodes.history.add(&NORMAL);
        part.nodes.history.add(&WEIGHTED_GAP);
        if family.frictional() {
            part.nodes.history.add(&WEIGHTED_SLIP);
        }
        let levels = part.nodes.history.levels().max(self.setup.parameters.levels_back + 1);
        part.nodes.history.set_levels(levels);
        find_nodal_h(part);
        part.info.marks.insert(CONTACT, explicit.is_none());
        if !self.setup.updates_normals() {
            FirstIterateTangent::announce(part);
        }
        // Forces of a spring by node have a potential, and keep the energy as long as nothing scales them.
        self.setup.settings.adaptation.dynamic_factor = (explicit.is_some() && self.setup.settings.weighted_penalty)
            || (part.info.is(COMPUTE_DYNAMIC_FACTOR) && part.nodes.history.has(VELOCITY.name()));
        self.setup.calibrate(part, &self.pairing.interfaces);
        self.growth = explicit.map(|explicit| explicit.growth(part));
        if self.setup.by_points() {
            let thickness = self.setup.parameters.segmentation.axisymmetric;
            self.pairing.bodies = Arc::new(Bodies::new(part, &self.pairing.interfaces, thickness)?);
        }
        self.pairing.patches.write(part);
        self.states = SlaveStates::of(part, self.pairing.carriers(), family.columns());
        self.states.for_all(|state| state.active = false);
        self.states.set_slaves(self.pairing.slaves());
        self.states.export(&mut part.nodes);
        Ok(())
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.acting = self.setup.settings.interval.contains(part.info.time);
        self.states.begin_step();
        self.set.begin_step();
        self.reach = Reach::default();
        self.step_search.begin_step();
        self.uzawa = Uzawa::default();
        if self.setup.ramps_penalty() {
            self.penalty_ramp.begin_step(&part.info, &mut self.states);
        }
        if self.setup.ramps_friction() {
            self.friction_ramp.begin_step(part, self.setup.settings.friction.law);
        }
        self.states.read_friction(&part.nodes, self.setup.settings.friction.law);
        if self.acting {
            let settings = &self.setup.settings;
            if let Some(explicit) = settings.explicit {
                let (given, weighted) = (settings.manual.is_some(), settings.weighted_penalty);
                let revolution = self.setup.parameters.segmentation.revolution();
                let (states, interfaces) = (&mut self.states, &self.pairing.interfaces);
                self.bearable.begin_step(part, states, interfaces, revolution, 1.0 + explicit.most, given, weighted);
            }
            self.find_contact(part)?;
        } else {
            self.states.for_all(|state| state.active = false);
            self.pairing.clear();
            self.clear_inactive(part, &self.states.slaves());
        }
        self.publish(part);
        part.nodes.history.values(&WEIGHTED_GAP, 0).clone_into(&mut self.start_gaps);
        Ok(())
    }

    fn accept_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.impact_error = 0.0;
        if self.setup.parameters.dynamic {
            let family = self.setup.settings.family;
            let stores = family.compliant || matches!(family.multiplier, Multiplier::None);
            let conserves = !stores && !family.frictional();
            part.messages.extend(self.work.accept(part, conserves));
        }
        self.friction_ramp.accept();
        // Nodes that nothing faces any more have no equation that would drive their multipliers to zero.
        self.clear_inactive(part, &self.states.slaves());
        let (family, clears) = (self.setup.settings.family, self.setup.settings.clear_inactive);
        self.states.for_each(|_, state| {
            if clears && !state.active {
                (state.pressure, state.traction) = (0.0, [0.0; 3]);
            }
        });
        if family.frictional() {
            let parameters = &self.setup.parameters;
            friction::meet_bounds(&mut part.nodes, &self.states, family.multiplier, parameters.scale_factor);
            if !self.warned_of_friction {
                let warning = friction::warn_of_pushing(part, &self.states, family.multiplier, parameters);
                self.warned_of_friction = warning.is_some();
                part.messages.extend(warning);
            }
        }
        self.publish(part);
        Ok(())
    }

    /// The ALM values of eq. 4.11.
    fn parameters(&self, part: &ModelPart) -> Vec<(&'static str, f64)> {
        if let Some([least, most]) = self.pairing.bodies.stiffness() {
            let factor = self.setup.settings.nitsche.factor;
            return vec![("least γ", factor * least), ("largest γ", factor * most)];
        }
        let penalty = part.info.value_or(INITIAL_PENALTY.name(), 0.0);
        vec![("penalty ε", penalty), ("scale factor k", self.setup.parameters.scale_factor)]
    }

    fn summary(&self, _part: &ModelPart) -> Vec<(&'static str, f64)> {
        let deepest = self.states.iter().filter_map(|(_, state)| state.gap()).fold(0.0, f64::min);
        let mut out = vec![
            ("pairs", self.pairing.len() as f64),
            ("active nodes", self.states.count_active() as f64),
            ("deepest penetration", -deepest),
        ];
        if self.pairing.moved > 0 {
            out.push(("pairs moved to other ranks", self.pairing.moved as f64));
        }
        if self.setup.settings.family.updated {
            out.extend([("multiplier updates", self.uzawa.updates as f64), ("rate", self.uzawa.rate)]);
        }
        out
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
    fn unknowns(&self, part: &ModelPart) -> Vec<(ScalarVariable, Vec<u32>)> {
        let unknowns = self.setup.settings.family.multiplier.unknowns(part.info.domain_size);
        unknowns.into_iter().map(|variable| (variable, self.pairing.carriers())).collect()
    }

    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.pairing.as_entities()
    }

    fn graph_version(&self) -> u64 {
        self.pairing.graph
    }

    fn idle_diagonal(&self) -> f64 {
        self.setup.parameters.scale_factor
    }

    fn relaxation(&self) -> Option<f64> {
        let parameters = &self.setup.parameters;
        let largest_area = self.states.iter().map(|(_, state)| state.area).fold(0.0, f64::max);
        let weight = parameters.scale_factor.powi(2) * largest_area / parameters.stiffness;
        Some(RELAXATION * if largest_area > 0.0 { weight } else { parameters.scale_factor })
    }
}

impl ActiveSet for ContactInteraction {
    fn after_prediction(&mut self, part: &mut ModelPart) -> Result<()> {
        if self.acting {
            self.integrate(part);
            self.set.find_tangents(part, &mut self.states, &self.setup);
            self.publish(part);
        }
        Ok(())
    }

    fn after_update(&mut self, part: &mut ModelPart, iteration: usize) -> Result<SetChange> {
        if !self.acting {
            return Ok(SetChange::default());
        }
        if iteration == 1 || self.setup.updates_normals() {
            self.find_normals(part);
        }
        if self.setup.updates_normals() {
            self.pairing.refresh_normals(part, true);
        }
        if self.setup.by_points() {
            points::release(&mut self.states);
        }
        let (adaptation, explicit) = (self.setup.settings.adaptation, self.setup.settings.explicit.is_some());
        let gaps = adaptation.gaps(&self.states, explicit);
        self.integrate(part);
        if iteration <= SETTLED {
            let (contact, searched) = ((&self.pairing, &self.states), self.steps_since_search == 0);
            let missed = self.step_search.on_the_way(part, contact, &self.setup, searched)?;
            if !missed.is_empty() {
                self.take_in(part, missed)?;
            }
        }
        if iteration >= SETTLED {
            self.pairing.freeze_choices(part, &self.states);
        }
        let change = self.set.update(part, &mut self.states, &self.setup);
        let penalty = part.info.value_or(INITIAL_PENALTY.name(), 1.0);
        adaptation.adapt(&part.nodes, &mut self.states, penalty, &gaps, self.growth);
        if explicit {
            part.info.marks.insert(CONTACT, self.states.count_active() > 0);
        }
        self.set.find_tangents(part, &mut self.states, &self.setup);
        self.publish(part);
        Ok(change)
    }

    fn after_convergence(&mut self, part: &mut ModelPart) -> Result<Outer> {
        if !self.acting {
            return Ok(Outer::Done);
        }
        let outer = self.judge_converged(part)?;
        self.publish(part);
        Ok(outer)
    }

    fn restrain_free_bodies(&mut self, part: &mut ModelPart) -> bool {
        if !self.acting || self.setup.settings.explicit.is_some() {
            return false;
        }
        let mut any = self.setup.by_points() && points::hold_active(&mut self.states);
        if !any {
            let near = self.reach.next(&part.nodes, &self.states, &self.pairing.interfaces);
            let rule = self.setup.parameters.slip_rule;
            activation::start(&part.nodes, &mut self.states, Start::Touching(&near), rule);
            if self.setup.by_points() {
                points::hold(&mut self.states, &near);
            }
            self.set.find_tangents(part, &mut self.states, &self.setup);
            any = !near.is_empty();
        }
        self.publish(part);
        any
    }
}

impl FirstIterate for ContactInteraction {
    /// Without updates, normals are those after the first iteration.
    fn moved_first(&self) -> Option<Vec<u32>> {
        (self.acting && !self.setup.updates_normals()).then(|| self.pairing.nodes())
    }

    fn keep(&mut self, part: &mut ModelPart) {
        if self.acting {
            self.find_normals(part);
        }
    }
}

impl Massless for ContactInteraction {
    fn massless_nodes(&mut self, part: &ModelPart) -> MasslessNodes {
        if !self.setup.parameters.dynamic {
            self.setup.parameters = Arc::new(StepParameters { dynamic: true, ..(*self.setup.parameters).clone() });
        }
        if !self.acting || part.info.is(KEEP_MASS) {
            return MasslessNodes::default();
        }
        self.near_nodes = near_nodes(part, &self.pairing, &self.states.slaves(), &self.near_nodes);
        MasslessNodes { surface: self.pairing.nodes(), near: self.near_nodes.clone() }
    }
}

impl Retry for ContactInteraction {
    fn save(&mut self) {
        self.pairing.save();
        self.saved = self.states.clone();
    }

    fn restore(&mut self) {
        self.states = self.saved.clone();
        self.pairing.restore(&self.setup);
        self.penalty_ramp.retry();
        self.friction_ramp.retry();
        self.steps_since_search = usize::MAX;
    }

    fn has_alternative(&self) -> bool {
        self.setup.ramps_friction() && self.friction_ramp.comes_next()
    }
}
