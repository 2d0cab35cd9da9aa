//! The contact of all pairs of a deck: search at step start, gaps and active set in every iteration.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use zelus_core::Result;
use zelus_core::communication::world;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{EntityBlock, Interaction, MasslessNodes, NORMALS_OF_FIRST_ITERATION, Outer, SetChange};
use zelus_core::model::flags::{ACTIVE, CONTACT, ISOLATED, MASTER, SLAVE};
use zelus_core::model::{ModelPart, ScalarVariable, variables::NORMAL, variables::VELOCITY};

use super::activation::{self, Start};
use super::bearable_penalty::BearablePenalty;
use super::calibration::{calibrate, limit};
use super::contact_settings::ContactSettings;
use super::coverage;
use super::cycling::{CycleGuard, Settled};
use super::edges::turn_edges;
use super::friction;
use super::friction_ramp::FrictionRamp;
use super::holding::{Holding, held_at};
use super::impact::{coarse_impact, near_nodes};
use super::late_pairs::{Late, Wanted, farthest_motion, late_pairs};
use super::pairing::{Pairing, add_up_nodes};
use super::penalty_ramp::PenaltyRamp;
use super::points;
use super::reach::Reach;
use super::sliding;
use super::step_parameters::{NormalVariation, StepParameters};
use super::uzawa::Uzawa;
use super::work::ContactWork;
use crate::active_set::SlipRule;
use crate::formulations::Augmentation;
use crate::formulations::held::along_free_tangents;
use crate::interface::{Bodies, Interface, Roles, add_contact_part, find_nodal_h, interfaces};
use crate::mortar::SegmentationSettings;
use crate::pairs::Multiplier;
use crate::penalty_adaptation::Growth;
use crate::resolution::Resolution;
use crate::search::{GapCheck, WithinStep, assign_roles, warn_of_late_pairs};
use crate::solver::{AVERAGED_EDGES, COMPUTE_DYNAMIC_FACTOR, ENSURE_CONTACT, KEEP_MASS, SIMPLIFIED_SEMI_SMOOTH_NEWTON};
use crate::variables::{
    AUGMENTED_NORMAL_CONTACT_PRESSURE, AUGMENTED_TANGENT_CONTACT_PRESSURE, CARRIED_TRACTION, INITIAL_PENALTY,
    MEAN_WEIGHTED_GAP, NODAL_AREA, NODAL_H, TRIAL_TRACTION, WEIGHTED_GAP, WEIGHTED_SLIP,
};

/// Contact in a model part.
pub struct ContactInteraction {
    settings: ContactSettings,
    pairing: Pairing,
    slaves: Vec<u32>,
    parameters: Arc<StepParameters>,
    /// Gap below which nodes and facets count as near, before factors (length).
    threshold: f64,
    steps_since_search: usize,
    acting: bool,
    warned_of_friction: bool,
    /// What is too small to decide on in the present state.
    resolution: Resolution,
    uzawa: Uzawa,
    /// How much of the penalty acts, where it is all there is.
    ramp: PenaltyRamp,
    /// Whether friction waits for contact.
    friction_ramp: FrictionRamp,
    /// How explicit steps stiffen the penalty.
    growth: Option<Growth>,
    bearable: BearablePenalty,
    /// Largest area that a slave node integrates.
    largest_area: f64,
    /// Overlapping pairs of every node.
    pair_counts: Vec<u32>,
    cycles: CycleGuard,
    /// Slave nodes that supports hold.
    holding: Holding,
    /// How often nodes that always slide have turned back in this step.
    reversals: BTreeMap<u32, usize>,
    /// Nodes that were pushed along their motion in this step and stick since.
    released: BTreeSet<u32>,
    /// What open interfaces have taken hold of in this step because a body was free to move.
    reach: Reach,
    /// Searches in converged states of this step.
    searches: usize,
    warned_of_late_pairs: bool,
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
        let parameters = Arc::new(StepParameters {
            segmentation: SegmentationSettings::default(),
            scale_factor: 1.0,
            stiffness: 1.0,
            tangent_factor: settings.tangent_factor,
            weighted_penalty: settings.weighted_penalty,
            levels_back: if settings.explicit.is_some() { 2 } else { 1 },
            operator_threshold: settings.operator_threshold,
            friction_law: settings.friction.law,
            slip_rule: SlipRule::Pure,
            normal_variation: settings.normal_variation,
            augmentation: settings.augmentation,
            compliant: settings.family.compliant,
            dynamic: false,
            nitsche: settings.nitsche,
        });
        Ok(Self {
            pairing: Pairing::new(interfaces, part, settings.nodal_normals),
            settings,
            slaves: Vec::new(),
            parameters,
            threshold: f64::INFINITY,
            steps_since_search: usize::MAX,
            acting: true,
            warned_of_friction: false,
            resolution: Resolution::default(),
            uzawa: Uzawa::default(),
            ramp: PenaltyRamp::default(),
            friction_ramp: FrictionRamp::default(),
            growth: None,
            bearable: BearablePenalty::default(),
            largest_area: 0.0,
            pair_counts: Vec::new(),
            cycles: CycleGuard::default(),
            holding: Holding::default(),
            reversals: BTreeMap::new(),
            released: BTreeSet::new(),
            reach: Reach::default(),
            searches: 0,
            warned_of_late_pairs: false,
            near_nodes: Vec::new(),
            start_gaps: Vec::new(),
            impact_error: 0.0,
            work: ContactWork::default(),
        })
    }

    /// Meshes of very different sizes need a longer reach: both factors grow with the ratio of the sizes.
    fn adapt_search(&mut self, part: &ModelPart) {
        if !self.settings.adapt_search {
            return;
        }
        let own = part.nodes.values.values(&NODAL_H, 0).iter().copied().filter(|h| *h > 0.0 && *h < f64::MAX);
        let own = own.fold([f64::INFINITY, 0.0_f64], |[least, most], h| [least.min(h), most.max(h)]);
        let sizes = world().gather_numbers(&own).concat().into_iter().filter(|h| h.is_finite() && *h > 0.0);
        let (least, most) = sizes.fold((f64::INFINITY, 0.0_f64), |(least, most), h| (least.min(h), most.max(h)));
        if most > 0.0 {
            self.settings.search.factor *= most / least;
            self.settings.active_check_factor *= most / least;
        }
    }

    /// Whether a stiff penalty that nothing else changes may begin soft.
    fn ramps(&self) -> bool {
        let constant = self.settings.adaptation.rule.is_none() && self.settings.explicit.is_none();
        constant && matches!(self.settings.family.multiplier, Multiplier::None)
    }

    /// Whether integration points decide on contact.
    fn by_points(&self) -> bool {
        matches!(self.settings.family.multiplier, Multiplier::Body)
    }

    /// Whether friction may join contact later: where forces are multipliers alone.
    fn may_wait_for_contact(&self) -> bool {
        let bounded = matches!(self.parameters.slip_rule, SlipRule::Bounded(_));
        bounded
            && self.settings.explicit.is_none()
            && self.settings.augmentation == Augmentation::Node
            && matches!(self.settings.family.multiplier, Multiplier::Vector(_))
    }

    /// Normals of the nodes in the present configuration.
    fn find_normals(&self, part: &mut ModelPart) {
        self.pairing.patches.write(part);
        if !part.info.is(AVERAGED_EDGES) {
            turn_edges(part, &self.pairing);
        }
    }

    fn updates_normals(&self) -> bool {
        self.settings.normal_variation != NormalVariation::None
    }

    /// Self contact: each search decides which facets are slaves.
    fn assign_open_roles(&mut self, part: &mut ModelPart) {
        if self.pairing.interfaces.iter().all(|i| !i.open) {
            return;
        }
        for interface in self.pairing.interfaces.iter_mut().filter(|i| i.open) {
            assign_roles(part, interface, &self.settings.search);
            for &node in &interface.nodes {
                part.nodes.flags.set(SLAVE, node as usize, false);
                part.nodes.flags.set(MASTER, node as usize, true);
            }
            for node in interface.nodes_of(Roles::Slave) {
                part.nodes.flags.set(SLAVE, node as usize, true);
                part.nodes.flags.set(MASTER, node as usize, false);
            }
        }
        self.slaves = self.pairing.slaves();
        for node in self.pairing.interfaces.iter().flat_map(Interface::carriers) {
            if self.slaves.binary_search(&node).is_err() {
                part.nodes.flags.set(ACTIVE, node as usize, false);
            }
        }
        activation::clear_inactive_multipliers(part, self.settings.family.multiplier, &self.pairing.carriers());
        self.pairing.find_patches(part, &self.holding);
        self.pairing.patches.write(part);
    }

    /// Recomputes overlaps, weighted gaps and areas in the present configuration.
    fn integrate(&mut self, part: &mut ModelPart) {
        let (integrals, meetings) = self.pairing.integrals(part);
        let mut meetings = meetings.into_iter();
        let count = part.nodes.len();
        let (mut gap, mut area, mut mean) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        let (mut slip, mut trial, mut carried) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        let mut pairs = vec![0_u32; count];
        for (block, integrals) in self.pairing.blocks.iter_mut().zip(&integrals) {
            for (at, integral) in integrals.iter().enumerate() {
                let overlaps = meetings.next().is_some_and(|meeting| meeting.overlapping);
                let pair = &mut block.pairs_mut()[at];
                (pair.overlapping, pair.area) = (overlaps, integral.area);
                if !overlaps {
                    continue;
                }
                for (local, &node) in block.slave_nodes(at).iter().enumerate() {
                    let node = node as usize;
                    pairs[node] += 1;
                    gap[node] += integral.gap[local];
                    mean[node] += integral.gap[local] * integral.area[local];
                    area[node] += integral.area[local];
                    (0..3).for_each(|c| slip[node][c] += integral.slip[local][c]);
                    (0..3).for_each(|c| trial[node][c] += integral.trial[local][c]);
                    (0..3).for_each(|c| carried[node][c] += integral.carried[local][c]);
                }
            }
        }
        let columns = [(1, &mut gap[..]), (1, &mut area[..]), (1, &mut mean[..])];
        let vectors = [(3, slip.as_flattened_mut()), (3, trial.as_flattened_mut()), (3, carried.as_flattened_mut())];
        add_up_nodes(part, &self.slaves, &mut columns.into_iter().chain(vectors).collect::<Vec<_>>());
        let beside = {
            let around = self.parameters.segmentation.revolution();
            let weight = |n: u32| around.map_or(1.0, |per_radius| per_radius * part.nodes.current[n as usize][0]);
            let active = |n: u32| part.nodes.flags.is(ACTIVE, n as usize);
            coverage::beside(part, &self.pairing.interfaces, &area, self.settings.least_coverage, weight, active)
        };
        for &node in &self.slaves {
            let at = node as usize;
            part.nodes.flags.set(ISOLATED, at, pairs[at] == 0 || beside[at]);
        }
        self.pair_counts = pairs;
        self.largest_area = self.slaves.iter().map(|&n| area[n as usize]).fold(0.0, f64::max);
        mean.iter_mut().zip(&area).for_each(|(mean, area)| *mean = if *area > 0.0 { *mean / area } else { 0.0 });
        part.nodes.values.values_mut(&MEAN_WEIGHTED_GAP, 0).copy_from_slice(&mean);
        part.nodes.history.values_mut(&WEIGHTED_GAP, 0).copy_from_slice(&gap);
        part.nodes.values.values_mut(&NODAL_AREA, 0).copy_from_slice(&area);
        if self.settings.family.frictional() {
            for &node in &self.slaves {
                let (at, held) = (node as usize, held_at(part, node as usize));
                let normal = part.nodes.history.get(NORMAL.name()).map_or([0.0; 3], |field| field.vector(0, at));
                if held.iter().any(|held| held.is_still()) {
                    slip[at] = along_free_tangents(slip[at], normal, held);
                }
            }
            part.nodes.history.values_mut(&WEIGHTED_SLIP, 0).copy_from_slice(slip.as_flattened());
        }
        if self.settings.family.frictional() || self.by_points() {
            let by_area =
                |(trial, area): ([f64; 3], &f64)| if *area > 0.0 { trial.map(|t| t / area) } else { [0.0; 3] };
            let trial: Vec<[f64; 3]> = trial.into_iter().zip(&area).map(by_area).collect();
            part.nodes.values.values_mut(&TRIAL_TRACTION, 0).copy_from_slice(trial.as_flattened());
            if let Some(field) = part.nodes.history.get_mut(CARRIED_TRACTION.name()) {
                let carried: Vec<[f64; 3]> = carried.into_iter().zip(&area).map(by_area).collect();
                field.levels[0].copy_from_slice(carried.as_flattened());
            }
        }
        activation::weigh_multipliers(part, &self.slaves, self.settings.family, &self.parameters);
        let family = self.settings.family;
        self.resolution = activation::resolution(part, &self.pairing.nodes(), &self.slaves, family, &self.parameters);
    }

    /// Distance within which nodes start in contact, and depth beyond which facets are in each other (length).
    fn near(&self) -> f64 {
        self.settings.active_check_factor * self.threshold
    }

    /// Lets the rules of the active set decide in the present state.
    fn update_active_set(&mut self, part: &mut ModelPart) -> SetChange {
        let family = self.settings.family;
        // What points decide they decide in each evaluation of forces: nodes only tell of it.
        if self.by_points() {
            let (mut decisions, before) =
                activation::decide(part, &self.slaves, family, &self.parameters, self.resolution, &mut self.released);
            if family.frictional() {
                points::hold_turned(part, &mut decisions, &before, self.resolution);
            }
            return activation::apply(part, &decisions, &before, family, &self.parameters);
        }
        let (mut decisions, before) =
            activation::decide(part, &self.slaves, family, &self.parameters, self.resolution, &mut self.released);
        self.cycles.restrict(&mut decisions, &before);
        part.messages.extend(self.cycles.keep(&decisions, &part.nodes.ids, part.info.step));
        activation::apply(part, &decisions, &before, family, &self.parameters)
    }

    /// Lets the rules decide in a converged state, where the set was held.
    fn settle(&mut self, part: &mut ModelPart) -> Outer {
        let family = self.settings.family;
        let (mut decisions, before) =
            activation::decide(part, &self.slaves, family, &self.parameters, self.resolution, &mut self.released);
        let largest = decisions.iter().map(|(_, decision)| -decision.pressure).fold(0.0, f64::max);
        match self.cycles.settle(&mut decisions, &before, largest, &part.nodes.ids) {
            Settled::Done => Outer::Done,
            Settled::Failed(why) => Outer::Failed(why),
            Settled::Change => {
                activation::apply(part, &decisions, &before, family, &self.parameters);
                self.write_tangents(part);
                Outer::Again
            }
        }
    }

    /// Facets that matter now and are no pair.
    ///
    /// # Errors
    /// Those of making blocks.
    fn late_pairs(&self, part: &ModelPart) -> Result<Late> {
        let still =
            self.steps_since_search == 0 && farthest_motion(part, &self.pairing.nodes()) <= self.resolution.length;
        if still || !self.threshold.is_finite() {
            return Ok(Late::default());
        }
        let limit = limit(&self.settings, self.threshold);
        let wanted = match self.settings.search.within_step {
            WithinStep::Facing => Wanted::facing(self.resolution),
            WithinStep::Lost => Wanted::lost(self.near(), self.searches > 0),
        };
        late_pairs(part, &self.pairing, &self.settings, &self.parameters, limit, wanted)
    }

    /// Takes in what bodies have come to face on their way, so that the iteration need not begin again for it at its end.
    ///
    /// # Errors
    /// Those of making blocks.
    fn search_on_the_way(&mut self, part: &mut ModelPart, iteration: usize) -> Result<()> {
        let looks = self.settings.search.within_step == WithinStep::Facing && self.settings.explicit.is_none();
        if iteration > SETTLED || !looks {
            return Ok(());
        }
        let missed = self.late_pairs(part)?.missed;
        if !missed.is_empty() {
            self.pairing.add(missed, &self.settings, &self.parameters)?;
            self.hold(part);
            self.integrate(part);
        }
        Ok(())
    }

    /// Looks at a converged state: where nodes have come to face facets they had no pair with, the iteration goes on.
    ///
    /// # Errors
    /// Those of making blocks.
    fn search_again(&mut self, part: &mut ModelPart) -> Result<Outer> {
        let late = self.late_pairs(part)?;
        if late.missed.is_empty() {
            return Ok(Outer::Done);
        }
        let why = match late.nodes.iter().take(6).map(|&n| part.nodes.ids[n as usize].to_string()).collect::<Vec<_>>() {
            ids if ids.is_empty() => format!("{} pairs more are found where the nodes have come to", late.missed.len()),
            ids => format!("nodes {} came through facets they had no pair with", ids.join(" ")),
        };
        if self.searches == MOST_SEARCHES {
            if !late.nodes.is_empty() {
                return Ok(Outer::Failed(format!("{why}, after {MOST_SEARCHES} searches within the step")));
            }
            if !std::mem::replace(&mut self.warned_of_late_pairs, true) {
                part.messages.push(warn_of_late_pairs(late.missed.len(), MOST_SEARCHES));
            }
            return Ok(Outer::Done);
        }
        self.searches += 1;
        self.pairing.add(late.missed, &self.settings, &self.parameters)?;
        self.hold(part);
        self.cycles.begin_step();
        self.integrate(part);
        self.update_active_set(part);
        self.write_tangents(part);
        Ok(Outer::Widened(why))
    }

    /// Finds the slave nodes that supports hold with what their pairs face.
    fn hold(&mut self, part: &mut ModelPart) {
        if self.settings.mind_supports {
            let keys = self.pairing.keys();
            let facets = keys.iter().map(|&key| (self.pairing.slave(key), self.pairing.master(key)));
            self.holding.write(part, self.settings.family, facets);
        }
    }

    fn write_tangents(&mut self, part: &mut ModelPart) {
        if self.settings.family.frictional() && !self.by_points() {
            let (family, keeps) = (self.settings.family, self.settings.friction.keeps_direction);
            let (resolution, counts) = (self.resolution, &self.pair_counts);
            let reversals = &mut self.reversals;
            sliding::write_tangents(part, &self.slaves, family, &self.parameters, resolution, counts, keeps, reversals);
        }
    }

    fn switch_off(&mut self, part: &mut ModelPart) {
        for &node in self.pairing.interfaces.iter().flat_map(|i| &i.nodes) {
            part.nodes.flags.set(ACTIVE, node as usize, false);
        }
        self.pairing.clear();
        activation::clear_inactive_multipliers(part, self.settings.family.multiplier, &self.slaves);
    }
}

/// Iterations after which pairs go on as they integrate: most steps have converged by then, as in the reference program.
const SETTLED: usize = 5;
/// Share of the weight k² A/c of multipliers that makes redundant ones regular.
const RELAXATION: f64 = 1e-5;

/// Searches in converged states of a step after which it counts as not converged.
const MOST_SEARCHES: usize = 5;

impl Interaction for ContactInteraction {
    fn name(&self) -> &str {
        "contact"
    }

    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        part.nodes.history.add(&NORMAL);
        part.nodes.history.add(&WEIGHTED_GAP);
        if self.settings.family.frictional() {
            part.nodes.history.add(&WEIGHTED_SLIP);
        }
        let levels = part.nodes.history.levels().max(self.parameters.levels_back + 1);
        part.nodes.history.set_levels(levels);
        find_nodal_h(part);
        self.adapt_search(part);
        part.info.marks.insert(CONTACT, self.settings.explicit.is_none());
        if !self.updates_normals() {
            part.info.marks.insert(NORMALS_OF_FIRST_ITERATION, true);
        }
        // Forces of a spring by node have a potential, and keep the energy as long as nothing scales them.
        self.settings.adaptation.dynamic_factor = (self.settings.explicit.is_some() && self.settings.weighted_penalty)
            || (part.info.is(COMPUTE_DYNAMIC_FACTOR) && part.nodes.history.has(VELOCITY.name()));
        if part.info.is(SIMPLIFIED_SEMI_SMOOTH_NEWTON) {
            let fact =
                "\"simplified_semi_smooth_newton\" is not followed: the active set is updated in every iteration";
            part.messages.push(
                Diagnostic::warning("simplified-newton", fact)
                    .remedy("nothing to do: the converged state is the same; leave the setting out to silence this"),
            );
        }
        let (threshold, parameters) = calibrate(part, &self.pairing.interfaces, &self.settings, &self.parameters);
        (self.threshold, self.parameters) = (threshold, Arc::new(parameters));
        self.growth = self.settings.explicit.map(|explicit| explicit.growth(part));
        if self.by_points() {
            let thickness = self.parameters.segmentation.axisymmetric;
            self.pairing.bodies = Arc::new(Bodies::new(part, &self.pairing.interfaces, thickness)?);
        }
        self.slaves = self.pairing.slaves();
        for node in self.pairing.carriers() {
            part.nodes.flags.set(ACTIVE, node as usize, false);
        }
        self.pairing.patches.write(part);
        Ok(())
    }

    fn unknowns(&self, part: &ModelPart) -> Vec<(ScalarVariable, Vec<u32>)> {
        let unknowns = self.settings.family.multiplier.unknowns(part.info.domain_size);
        unknowns.into_iter().map(|variable| (variable, self.pairing.carriers())).collect()
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.acting = self.settings.interval.contains(part.info.time);
        self.cycles.begin_step();
        self.released.clear();
        self.reversals.clear();
        self.reach = Reach::default();
        self.searches = 0;
        self.uzawa = Uzawa::default();
        if self.ramps() {
            self.ramp.begin_step(part);
        }
        if self.may_wait_for_contact() {
            self.friction_ramp.begin_step(part, self.settings.friction.law);
        }
        if !self.acting {
            self.switch_off(part);
            return Ok(());
        }
        if let Some(explicit) = self.settings.explicit {
            let (given, weighted) = (self.settings.manual.is_some(), self.settings.weighted_penalty);
            let (interfaces, revolution) = (&self.pairing.interfaces, self.parameters.segmentation.revolution());
            self.bearable.begin_step(part, interfaces, revolution, 1.0 + explicit.most, given, weighted);
        }
        activation::clear_inactive_multipliers(part, self.settings.family.multiplier, &self.slaves);
        if self.settings.mind_supports {
            self.holding.begin_step(part, &self.pairing.interfaces);
            self.pairing.find_patches(part, &self.holding);
        }
        self.find_normals(part);
        self.steps_since_search = self.steps_since_search.saturating_add(1);
        if self.steps_since_search >= self.settings.database_step_update {
            self.assign_open_roles(part);
            self.pairing.search(part, &self.settings, &self.parameters, limit(&self.settings, self.threshold))?;
            self.steps_since_search = 0;
            self.find_normals(part);
        }
        self.hold(part);
        self.integrate(part);
        part.nodes.history.values(&WEIGHTED_GAP, 0).clone_into(&mut self.start_gaps);
        let start = match self.settings.search.check {
            GapCheck::DirectCheck => Start::Touching(&self.pairing.touching),
            GapCheck::NoCheck => Start::Reach(f64::MAX),
            GapCheck::CheckMapping if self.settings.simple_search => Start::ShareOfMeshSize,
            GapCheck::CheckMapping => Start::Reach(self.near()),
        };
        let friction = (self.parameters.friction_law, self.parameters.slip_rule);
        activation::start(part, &self.slaves, start, friction);
        if self.by_points() {
            points::hold_open_interfaces(part, &self.pairing.interfaces, self.resolution);
        }
        friction::start_in_stick(part, &self.slaves, self.parameters.slip_rule, &self.settings.friction);
        self.pairing.refresh_normals(part, self.updates_normals());
        self.pairing.begin_step(part, &self.slaves, self.settings.segmentation.slivers);
        Ok(())
    }

    fn after_prediction(&mut self, part: &mut ModelPart) -> Result<()> {
        if self.acting {
            self.integrate(part);
            self.write_tangents(part);
        }
        Ok(())
    }

    fn keep_first_iterate(&mut self, part: &mut ModelPart) {
        if self.acting {
            self.find_normals(part);
        }
    }

    fn after_update(&mut self, part: &mut ModelPart, iteration: usize) -> Result<SetChange> {
        if !self.acting {
            return Ok(SetChange::default());
        }
        if iteration == 1 || self.updates_normals() {
            self.find_normals(part);
        }
        if self.updates_normals() {
            self.pairing.refresh_normals(part, true);
        }
        if self.by_points() {
            points::release(part);
        }
        let adaptation = self.settings.adaptation;
        let gaps = adaptation.gaps(part, &self.slaves, self.settings.explicit.is_some());
        self.integrate(part);
        self.search_on_the_way(part, iteration)?;
        if iteration >= SETTLED {
            self.pairing.keep_habits(part);
        }
        let change = self.update_active_set(part);
        let penalty = part.info.value_or(INITIAL_PENALTY.name(), 1.0);
        adaptation.adapt(part, &self.slaves, penalty, &gaps, self.growth);
        if self.settings.explicit.is_some() {
            let touching = self.slaves.iter().any(|&n| part.nodes.flags.is(ACTIVE, n as usize));
            part.info.marks.insert(CONTACT, touching);
        }
        self.write_tangents(part);
        Ok(change)
    }

    fn after_convergence(&mut self, part: &mut ModelPart) -> Result<Outer> {
        if !self.acting {
            return Ok(Outer::Done);
        }
        if self.settings.family.updated {
            let (scale_factor, settings) = (self.parameters.scale_factor, self.settings.uzawa);
            let outer = self.uzawa.update(part, &self.slaves, scale_factor, settings);
            if outer != Outer::Done {
                return Ok(outer);
            }
        }
        if self.ramps() && self.ramp.after_convergence(part) == Outer::Again {
            return Ok(Outer::Again);
        }
        if self.cycles.holds() {
            let settled = self.settle(part);
            if settled != Outer::Done {
                return Ok(settled);
            }
        }
        let outer = self.search_again(part)?;
        if outer != Outer::Done {
            return Ok(outer);
        }
        let law = self.settings.friction.law;
        if self.friction_ramp.after_convergence(part, &self.slaves, law, self.resolution) == Outer::Again {
            self.cycles.begin_step();
            self.write_tangents(part);
            return Ok(Outer::Again);
        }
        let family = self.settings.family;
        // Points in the master press in every state that has converged.
        if !self.by_points()
            && let Some(why) = activation::passed_through(part, &self.slaves, family, &self.parameters, self.resolution)
        {
            return Ok(Outer::Failed(why));
        }
        let touches = self.slaves.iter().any(|&n| part.nodes.flags.is(ACTIVE, n as usize));
        if part.info.is(ENSURE_CONTACT) && !touches {
            return Err(zelus_core::Error::NotConverged(
                "no node is in contact, and \"ensure_contact\" asks for one".to_owned(),
            ));
        }
        self.friction_ramp.solve();
        if self.parameters.dynamic {
            self.work.of_step(part, &self.pairing.as_entities())?;
            if let Some(why) = self.work.too_much(part) {
                return Ok(Outer::Failed(why));
            }
        }
        let (family, scale_factor) = (self.settings.family, self.parameters.scale_factor);
        Ok(coarse_impact(part, &self.slaves, family, scale_factor, &self.start_gaps, &mut self.impact_error))
    }

    fn reach_out(&mut self, part: &mut ModelPart) -> bool {
        if !self.acting || self.settings.explicit.is_some() {
            return false;
        }
        if self.by_points() && points::hold_active(part, &self.slaves) {
            return true;
        }
        let near = self.reach.next(part, &self.pairing.interfaces);
        let friction = (self.parameters.friction_law, self.parameters.slip_rule);
        activation::start(part, &self.slaves, Start::Touching(&near), friction);
        if self.by_points() {
            points::hold(part, &near);
        }
        self.write_tangents(part);
        !near.is_empty()
    }

    fn accept_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.impact_error = 0.0;
        if self.parameters.dynamic {
            let family = self.settings.family;
            let stores = family.compliant || matches!(family.multiplier, Multiplier::None);
            let conserves = !stores && !family.frictional();
            part.messages.extend(self.work.accept(part, conserves));
        }
        self.friction_ramp.accept();
        // Nodes that nothing faces any more have no equation that would drive their multipliers to zero.
        activation::clear_inactive_multipliers(part, self.settings.family.multiplier, &self.slaves);
        let cleared = |n: u32| self.settings.clear_inactive && !part.nodes.flags.is(ACTIVE, n as usize);
        let inactive: Vec<u32> = self.slaves.iter().copied().filter(|&n| cleared(n)).collect();
        let pressure = part.nodes.values.values_mut(&AUGMENTED_NORMAL_CONTACT_PRESSURE, 0);
        inactive.iter().for_each(|&n| pressure[n as usize] = 0.0);
        if self.settings.family.frictional() {
            let traction = part.nodes.values.values_mut(&AUGMENTED_TANGENT_CONTACT_PRESSURE, 0);
            inactive.iter().for_each(|&n| traction[3 * n as usize..3 * n as usize + 3].fill(0.0));
            let (multiplier, law) = (self.settings.family.multiplier, self.settings.friction.law);
            friction::meet_bounds(part, &self.slaves, multiplier, law, self.parameters.scale_factor);
            if !self.warned_of_friction {
                let warning = friction::warn_of_pushing(part, &self.slaves, multiplier, &self.parameters);
                self.warned_of_friction = warning.is_some();
                part.messages.extend(warning);
            }
        }
        Ok(())
    }

    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.pairing.as_entities()
    }

    fn graph_version(&self) -> u64 {
        self.pairing.graph
    }

    /// Without updates, normals are those after the first iteration.
    fn led_nodes(&self) -> Option<Vec<u32>> {
        (self.acting && !self.updates_normals()).then(|| self.pairing.nodes())
    }

    fn idle_diagonal(&self) -> f64 {
        self.parameters.scale_factor
    }

    fn relaxation(&self) -> Option<f64> {
        let weight = self.parameters.scale_factor.powi(2) * self.largest_area / self.parameters.stiffness;
        Some(RELAXATION * if self.largest_area > 0.0 { weight } else { self.parameters.scale_factor })
    }

    fn massless_nodes(&mut self, part: &ModelPart) -> MasslessNodes {
        if !self.parameters.dynamic {
            self.parameters = Arc::new(StepParameters { dynamic: true, ..(*self.parameters).clone() });
        }
        if !self.acting || part.info.is(KEEP_MASS) {
            return MasslessNodes::default();
        }
        self.near_nodes = near_nodes(part, &self.pairing, &self.slaves, &self.near_nodes);
        MasslessNodes { surface: self.pairing.nodes(), near: self.near_nodes.clone() }
    }

    fn has_another_way(&self) -> bool {
        self.may_wait_for_contact() && self.friction_ramp.comes_next()
    }

    fn save(&mut self) {
        self.pairing.save();
    }

    fn restore(&mut self) {
        self.pairing.restore(&self.settings, &self.parameters);
        self.ramp.retry();
        self.friction_ramp.retry();
        self.steps_since_search = usize::MAX;
    }

    /// The ALM values of eq. 4.11.
    fn parameters(&self, part: &ModelPart) -> Vec<(&'static str, f64)> {
        if let Some([least, most]) = self.pairing.bodies.stiffness() {
            let factor = self.settings.nitsche.factor;
            return vec![("least γ", factor * least), ("largest γ", factor * most)];
        }
        let penalty = part.info.value_or(INITIAL_PENALTY.name(), 0.0);
        vec![("penalty ε", penalty), ("scale factor k", self.parameters.scale_factor)]
    }

    fn summary(&self, part: &ModelPart) -> Vec<(&'static str, f64)> {
        let active = self.slaves.iter().filter(|&&n| part.nodes.flags.is(ACTIVE, n as usize)).count();
        let gaps = part.nodes.history.values(&WEIGHTED_GAP, 0);
        let areas = part.nodes.values.values(&NODAL_AREA, 0);
        let deepest = self.slaves.iter().map(|&n| n as usize).filter(|&n| areas.get(n).is_some_and(|a| *a > 0.0));
        let deepest = deepest.map(|n| gaps[n] / areas[n]).fold(0.0, f64::min);
        let mut out = vec![
            ("pairs", self.pairing.len() as f64),
            ("active nodes", active as f64),
            ("deepest penetration", -deepest),
        ];
        if self.pairing.moved > 0 {
            out.push(("pairs moved to other ranks", self.pairing.moved as f64));
        }
        if self.settings.family.updated {
            out.extend([("multiplier updates", self.uzawa.updates as f64), ("rate", self.uzawa.rate)]);
        }
        out
    }
}
