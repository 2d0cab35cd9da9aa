//! The contact of all pairs of a deck: search at step start, gaps and active set in every iteration.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use zelus_core::Result;
use zelus_core::communication::world;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{EntityBlock, Interaction, NORMALS_OF_FIRST_ITERATION, Outer, SetChange};
use zelus_core::model::flags::{ACTIVE, CONTACT, ISOLATED, MASTER, SLAVE};
use zelus_core::model::{ModelPart, ScalarVariable, variables::NORMAL, variables::VELOCITY};
use zelus_core::parameters::Interval;
use zelus_core::registry::{self, Kind};
use zelus_core::vector3::norm;

use super::activation::{self, Start};
use super::adaptation::{AdaptationSettings, ExplicitGap};
use super::cycling::CycleGuard;
use super::friction::{self, FrictionSettings};
use super::sliding;
use super::step_parameters::{NormalVariation, StepParameters};
use super::uzawa::{Uzawa, UzawaSettings};
use crate::active_set::SlipRule;
use crate::interface::{
    AlmParameters, Facet, Interface, Roles, add_contact_part, alm_parameters, centre_normal, find_nodal_h, interfaces,
    nodal_normals, positions, slave_nodes,
};
use crate::mortar::SegmentationSettings;
use crate::pairs::{
    ContactBlock, Family, Integral, Multiplier, Pair, PairKey, PairRequest, Previous, condition_name, group_by_shapes,
};
use crate::search::{
    Candidate, GapCheck, SearchSettings, assign_roles, candidates, late_pairs, predicted_positions, touching_nodes,
    warn_of_reach,
};
use crate::solver::{COMPUTE_DYNAMIC_FACTOR, ENSURE_CONTACT, SIMPLIFIED_SEMI_SMOOTH_NEWTON};
use crate::variables::{
    AUGMENTED_NORMAL_CONTACT_PRESSURE, AUGMENTED_TANGENT_CONTACT_PRESSURE, DYNAMIC_FACTOR, INITIAL_PENALTY, NODAL_AREA,
    NODAL_H, WEIGHTED_GAP, WEIGHTED_SLIP,
};

/// What a deck chooses about contact.
#[derive(Clone)]
pub struct ContactSettings {
    /// Parts of the interfaces by key.
    pub parts: BTreeMap<String, Vec<String>>,
    /// Parts on the slave side by key.
    pub slaves: BTreeMap<String, Vec<String>>,
    /// The family of conditions.
    pub family: &'static Family,
    /// Times in which contact acts.
    pub interval: Interval,
    /// When normals follow the iteration.
    pub normal_variation: NormalVariation,
    /// Which facets are looked at.
    pub search: SearchSettings,
    /// Gap, in mesh sizes, below which a node starts active.
    pub active_check_factor: f64,
    /// Whether activation goes by 0.002 of the mesh size instead.
    pub simple_search: bool,
    /// Whether the factors of the search grow with the ratio of the largest and the smallest mesh size.
    pub adapt_search: bool,
    /// Steps between searches.
    pub database_step_update: usize,
    /// Penalty and scale factor given by hand.
    pub manual: Option<AlmParameters>,
    /// Factor of E/h in eq. 4.11, and ratio of scale factor and penalty.
    pub estimate: [f64; 2],
    /// Factor of the estimated penalty; the penalty families need a stiffer spring.
    pub penalty_factor: f64,
    /// Least penalty: what takes its place when the estimate is zero.
    pub least_penalty: f64,
    /// Whether the scale factor is used; otherwise it is 1.
    pub use_scale_factor: bool,
    /// Ratio of tangential and normal penalty.
    pub tangent_factor: f64,
    /// Change of the operators beyond which slip is measured objectively.
    pub operator_threshold: f64,
    /// Coefficients and the rules of stick and slip.
    pub friction: FrictionSettings,
    /// What of the parameters is adapted in every iteration.
    pub adaptation: AdaptationSettings,
    /// Whether augmented pressures of inactive nodes are zero after a step.
    pub clear_inactive: bool,
    /// How far Uzawa's outer loop goes, where the family has one.
    pub uzawa: UzawaSettings,
    /// How explicit steps adapt the penalty; `None` in implicit ones.
    pub explicit: Option<ExplicitGap>,
    /// Multiple of the geometric tolerance.
    pub zero_tolerance_factor: f64,
    /// Gauss rule on the cells.
    pub integration_order: crate::mortar::IntegrationOrder,
    /// Whether the plane is rotated about the y axis.
    pub axisymmetric: bool,
}

/// Contact in a model part.
pub struct ContactInteraction {
    settings: ContactSettings,
    interfaces: Vec<Interface>,
    slaves: Vec<u32>,
    /// Interface nodes that lead slave nodes to their interface.
    blocks: Vec<Box<dyn ContactBlock>>,
    parameters: Arc<StepParameters>,
    graph: u64,
    threshold: f64,
    steps_since_search: usize,
    saved: Vec<Pair>,
    acting: bool,
    warned: bool,
    warned_of_late_pairs: bool,
    warned_of_friction: bool,
    /// Nodes that the direct check found on a master.
    touching: BTreeSet<u32>,
    /// Slave nodes that face the origin of the coordinates, see [`activation::start`].
    at_origin: BTreeSet<u32>,
    /// Weighted gaps averaged over the pairs of a node by area.
    mean_gaps: Vec<f64>,
    uzawa: Uzawa,
    /// Gap at which explicit steps stiffen the penalty; 0 in implicit ones (length).
    max_gap: f64,
    /// Overlapping pairs of every node.
    pair_counts: Vec<u32>,
    cycles: CycleGuard,
    /// Nodes that were pushed along their motion in this step and stick since.
    released: BTreeSet<u32>,
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
            tangent_factor: settings.tangent_factor,
            operator_threshold: settings.operator_threshold,
            friction_law: settings.friction.law,
            slip_rule: SlipRule::Pure,
            normal_variation: settings.normal_variation,
        });
        Ok(Self {
            settings,
            interfaces,
            slaves: Vec::new(),
            blocks: Vec::new(),
            parameters,
            graph: 1,
            threshold: f64::INFINITY,
            steps_since_search: usize::MAX,
            saved: Vec::new(),
            acting: true,
            warned: false,
            warned_of_late_pairs: false,
            warned_of_friction: false,
            touching: BTreeSet::new(),
            at_origin: BTreeSet::new(),
            mean_gaps: Vec::new(),
            uzawa: Uzawa::default(),
            max_gap: 0.0,
            pair_counts: Vec::new(),
            cycles: CycleGuard::default(),
            released: BTreeSet::new(),
        })
    }

    /// Meshes of very different sizes need a longer reach: both factors grow with the ratio of the sizes.
    fn adapt_search(&mut self, part: &ModelPart) {
        if !self.settings.adapt_search {
            return;
        }
        let sizes = part.nodes.values.values(&NODAL_H, 0).iter().copied().filter(|h| *h > 0.0);
        let (least, most) = sizes.fold((f64::INFINITY, 0.0_f64), |(least, most), h| (least.min(h), most.max(h)));
        if most > 0.0 {
            self.settings.search.factor *= most / least;
            self.settings.active_check_factor *= most / least;
        }
    }

    fn pairs(&self) -> Vec<Pair> {
        self.blocks.iter().flat_map(|block| block.pairs().iter().cloned()).collect()
    }

    fn facet(&self, interface: u32, facet: u32) -> &Facet {
        &self.interfaces[interface as usize].facets[facet as usize]
    }

    fn normal(&self, part: &ModelPart, facet: &Facet) -> [f64; 3] {
        centre_normal(facet.shape, positions(facet, part, &mut [[0.0; 3]; 4])).unwrap_or([0.0; 3])
    }

    fn updates_normals(&self) -> bool {
        self.settings.normal_variation != NormalVariation::None
    }

    /// Candidates of this configuration together with the pairs that are there already; those without overlap go.
    fn search(&mut self, part: &mut ModelPart) -> Result<()> {
        self.assign_open_roles(part);
        let still = predicted_positions(part, self.settings.search.dynamic);
        let role = |key: &PairKey, facet: u32| self.facet(key.interface, facet).role;
        let mut known: BTreeMap<PairKey, Pair> = self
            .pairs()
            .into_iter()
            .filter(|pair| {
                role(&pair.key, pair.key.slave) == Roles::Slave && role(&pair.key, pair.key.master) == Roles::Master
            })
            .map(|pair| (pair.key, pair))
            .collect();
        let (mut beyond, mut touching) = (BTreeSet::new(), BTreeSet::new());
        for at in 0..self.interfaces.len() {
            for Candidate { slave, master, within_reach } in
                candidates(part, &self.interfaces[at], &self.settings.search)
            {
                let key = PairKey { interface: at as u32, slave, master };
                if self.settings.search.check == GapCheck::DirectCheck {
                    let facets = (self.facet(key.interface, slave), self.facet(key.interface, master));
                    let nodes = touching_nodes(part, facets.0, facets.1, self.settings.active_check_factor);
                    if !within_reach || (nodes.is_empty() && !known.contains_key(&key)) {
                        continue;
                    }
                    touching.extend(nodes);
                } else if !within_reach && !known.contains_key(&key) {
                    beyond.insert(key);
                }
                if let std::collections::btree_map::Entry::Vacant(place) = known.entry(key) {
                    place.insert(self.pair(part, key));
                }
            }
        }
        if let Some(still) = still {
            part.nodes.current = still;
        }
        let before: Vec<PairKey> = self.pairs().iter().map(|pair| pair.key).collect();
        self.make_blocks(known.into_values().collect())?;
        let found = self.pairs().into_iter().zip(self.integrals(part).1);
        let found: Vec<(Pair, Meeting)> = found.collect();
        let lost = found.iter().filter(|(pair, i)| i.overlapping && beyond.contains(&pair.key)).count();
        warn_of_reach(part, lost, &mut self.warned);
        // Slivers too: within the step they may grow to overlaps.
        let kept = found.into_iter().filter(|(pair, i)| i.facing && !beyond.contains(&pair.key));
        let kept = kept.map(|(pair, _)| pair).collect();
        self.make_blocks(kept)?;
        let after: Vec<PairKey> = self.pairs().iter().map(|pair| pair.key).collect();
        if before != after {
            self.graph += 1;
        }
        self.touching = touching;
        Ok(())
    }

    /// Self contact: each search decides which facets are slaves.
    fn assign_open_roles(&mut self, part: &mut ModelPart) {
        if self.interfaces.iter().all(|i| !i.open) {
            return;
        }
        for interface in self.interfaces.iter_mut().filter(|i| i.open) {
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
        self.slaves = slave_nodes(&self.interfaces);
        for node in self.interfaces.iter().flat_map(Interface::carriers) {
            if self.slaves.binary_search(&node).is_err() {
                part.nodes.flags.set(ACTIVE, node as usize, false);
            }
        }
        activation::clear_inactive_multipliers(part, self.settings.family.multiplier, &self.carriers());
        nodal_normals(part, &self.interfaces);
    }

    fn carriers(&self) -> Vec<u32> {
        let mut nodes: Vec<u32> = self.interfaces.iter().flat_map(Interface::carriers).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Name of the conditions up to the shape.
    fn condition_stem(&self) -> String {
        let stem = self.settings.family.condition;
        if self.settings.axisymmetric { stem.replace("MortarContact", "AxisymMortarContact") } else { stem.to_owned() }
    }

    fn make_blocks(&mut self, pairs: Vec<Pair>) -> Result<()> {
        self.blocks.clear();
        self.blocks = self.blocks_of(pairs)?;
        Ok(())
    }

    fn blocks_of(&self, pairs: Vec<Pair>) -> Result<Vec<Box<dyn ContactBlock>>> {
        let groups = group_by_shapes(&self.interfaces, pairs, |pair| pair.key);
        let mut blocks = Vec::new();
        for ((slave, master), (pairs, nodes)) in groups {
            let name = condition_name(&self.condition_stem(), slave, master);
            let entry = registry::require(Kind::Condition, &name)?;
            let request = PairRequest { entry, pairs, nodes, parameters: self.parameters.clone() };
            let block = (self.settings.family.block)(slave, master, request).ok_or_else(|| {
                Diagnostic::error("contact-shapes", format!("{name}: no pairs of {slave:?} on {master:?}"))
            })?;
            blocks.push(block);
        }
        Ok(blocks)
    }

    fn pair(&self, part: &ModelPart, key: PairKey) -> Pair {
        Pair {
            key,
            slave_normal: self.normal(part, self.facet(key.interface, key.slave)),
            master_normal: self.normal(part, self.facet(key.interface, key.master)),
            overlapping: true,
            previous: Previous::default(),
        }
    }

    /// Says once that facets have come through each other that the step did not look at.
    ///
    /// # Errors
    /// Those of making blocks.
    fn warn_of_late_pairs(&mut self, part: &mut ModelPart) -> Result<()> {
        if self.warned_of_late_pairs || !self.acting || !self.threshold.is_finite() {
            return Ok(());
        }
        let known: BTreeSet<PairKey> = self.pairs().iter().map(|pair| pair.key).collect();
        let near = |at: usize| candidates(part, &self.interfaces[at], &self.settings.search).into_iter();
        let late: Vec<Pair> = (0..self.interfaces.len())
            .flat_map(|at| near(at).map(move |c| PairKey { interface: at as u32, slave: c.slave, master: c.master }))
            .filter(|key| !known.contains(key))
            .map(|key| self.pair(part, key))
            .collect();
        let allowed = self.settings.active_check_factor * self.threshold;
        let own = |nodes: &[u32]| part.evaluates_pair(nodes);
        let through = self
            .blocks_of(late)?
            .iter()
            .flat_map(|block| block.integrate(&part.view(), &own))
            .filter(|i| i.overlapping && i.gap.iter().zip(&i.area).any(|(gap, area)| *gap < -allowed * area.abs()))
            .count();
        let mut of_all = [through as f64];
        if part.partition.is_some() {
            world().sum(&mut of_all);
        }
        let through = of_all[0] as usize;
        self.warned_of_late_pairs = through > 0;
        part.messages.extend((through > 0).then(|| late_pairs(through, allowed)));
        Ok(())
    }

    /// The integrals of the pairs of this rank, and of all pairs how they meet.
    fn integrals(&self, part: &ModelPart) -> (Vec<Vec<Integral>>, Vec<Meeting>) {
        let own = |nodes: &[u32]| part.evaluates_pair(nodes);
        let integrals: Vec<_> = self.blocks.iter().map(|block| block.integrate(&part.view(), &own)).collect();
        let mut flags: Vec<bool> = integrals.iter().flatten().flat_map(|i| [i.overlapping, i.facing]).collect();
        if part.partition.is_some() {
            world().any_of(&mut flags);
        }
        let meetings = flags.chunks_exact(2).map(|pair| Meeting { overlapping: pair[0], facing: pair[1] }).collect();
        (integrals, meetings)
    }

    /// Recomputes overlaps, weighted gaps and areas in the present configuration.
    fn integrate(&mut self, part: &mut ModelPart) {
        let (integrals, meetings) = self.integrals(part);
        let mut meetings = meetings.into_iter();
        let count = part.nodes.len();
        let (mut gap, mut area, mut mean) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        let (mut slip, mut mapped) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        let mut pairs = vec![0_u32; count];
        for (block, integrals) in self.blocks.iter_mut().zip(&integrals) {
            for (at, integral) in integrals.iter().enumerate() {
                let overlaps = meetings.next().is_some_and(|meeting| meeting.overlapping);
                block.pairs_mut()[at].overlapping = overlaps;
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
                    (0..3).for_each(|c| mapped[node][c] += integral.mapped[local][c]);
                }
            }
        }
        if part.partition.is_some() {
            let columns = [(1, &mut gap[..]), (1, &mut area[..]), (1, &mut mean[..])];
            let vectors = [(3, slip.as_flattened_mut()), (3, mapped.as_flattened_mut())];
            add_up_nodes(&self.slaves, &mut columns.into_iter().chain(vectors).collect::<Vec<_>>());
        }
        for &node in &self.slaves {
            part.nodes.flags.set(ISOLATED, node as usize, pairs[node as usize] == 0);
        }
        self.pair_counts = pairs;
        mean.iter_mut().zip(&area).for_each(|(mean, area)| *mean = if *area > 0.0 { *mean / area } else { 0.0 });
        self.mean_gaps = mean;
        let at_origin = |&node: &u32| norm(mapped[node as usize]) <= f64::EPSILON * area[node as usize];
        self.at_origin = self.slaves.iter().copied().filter(at_origin).collect();
        part.nodes.history.values_mut(&WEIGHTED_GAP, 0).copy_from_slice(&gap);
        part.nodes.values.values_mut(&NODAL_AREA, 0).copy_from_slice(&area);
        if self.settings.family.frictional() {
            part.nodes.history.values_mut(&WEIGHTED_SLIP, 0).copy_from_slice(slip.as_flattened());
        }
    }

    fn refresh_pair_normals(&mut self, part: &ModelPart, slaves: bool) {
        let mut blocks = std::mem::take(&mut self.blocks);
        for pair in blocks.iter_mut().flat_map(|block| block.pairs_mut()) {
            pair.master_normal = self.normal(part, self.facet(pair.key.interface, pair.key.master));
            if slaves {
                pair.slave_normal = self.normal(part, self.facet(pair.key.interface, pair.key.slave));
            }
        }
        self.blocks = blocks;
    }

    fn write_tangents(&self, part: &mut ModelPart) {
        if self.settings.family.frictional() {
            let counts = &self.pair_counts;
            sliding::write_tangents(part, &self.slaves, self.settings.family, &self.parameters, counts);
        }
    }

    fn set_parameters(&mut self, part: &mut ModelPart) {
        let settings = &self.settings;
        let estimate = alm_parameters(part, &self.interfaces, settings.estimate[0], settings.estimate[1]);
        let mut chosen = settings.manual.unwrap_or(AlmParameters {
            penalty: estimate.penalty * settings.penalty_factor,
            scale_factor: estimate.scale_factor,
        });
        if chosen.penalty < f64::EPSILON {
            chosen.penalty = settings.least_penalty;
        }
        // Kratos finds no scale factor where no side is named, and falls back to 1; multipliers would differ otherwise.
        let open = self.interfaces.iter().all(|interface| interface.open);
        if !settings.use_scale_factor || chosen.scale_factor < f64::EPSILON || (open && settings.manual.is_none()) {
            chosen.scale_factor = 1.0;
        }
        part.info.values.insert(INITIAL_PENALTY.name(), chosen.penalty);
        part.info.values.insert("SCALE_FACTOR", chosen.scale_factor);
        part.nodes.values.values_mut(&INITIAL_PENALTY, 0).fill(chosen.penalty);
        part.nodes.values.values_mut(&DYNAMIC_FACTOR, 0).fill(1.0);
        let sizes = part.nodes.values.values(&NODAL_H, 0);
        let mean = |role: Roles| {
            let of = |i: &Interface| if i.open { i.nodes.clone() } else { i.nodes_of(role) };
            let nodes: Vec<u32> = self.interfaces.iter().flat_map(of).collect();
            nodes.iter().map(|&n| sizes[n as usize]).sum::<f64>() / nodes.len().max(1) as f64
        };
        self.threshold = mean(Roles::Slave).max(mean(Roles::Master));
        let thickness = || {
            let found = self
                .interfaces
                .iter()
                .flat_map(|i| &i.facets)
                .find_map(|f| part.properties.get(&f.properties)?.number("THICKNESS"));
            found.unwrap_or(1.0)
        };
        self.parameters = Arc::new(StepParameters {
            segmentation: SegmentationSettings {
                distance_threshold: if settings.search.check == GapCheck::CheckMapping { self.threshold } else { FAR },
                zero_tolerance_factor: settings.zero_tolerance_factor,
                integration_order: settings.integration_order,
                axisymmetric: settings.axisymmetric.then(thickness),
            },
            scale_factor: chosen.scale_factor,
            slip_rule: friction::prepare(
                part,
                &self.interfaces,
                &self.settings.friction,
                self.settings.family.friction,
            ),
            ..(*self.parameters).clone()
        });
    }

    fn switch_off(&mut self, part: &mut ModelPart) {
        for &node in self.interfaces.iter().flat_map(|i| &i.nodes) {
            part.nodes.flags.set(ACTIVE, node as usize, false);
        }
        if !self.blocks.is_empty() {
            self.blocks.clear();
            self.graph += 1;
        }
        activation::clear_inactive_multipliers(part, self.settings.family.multiplier, &self.slaves);
    }
}

/// Share of the scale factor that makes redundant multipliers regular.
const RELAXATION: f64 = 1e-8;

/// How the facets of a pair meet.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    overlapping: bool,
    facing: bool,
}

/// Adds up over the ranks what each has at these nodes; each column comes with its number of numbers a node.
fn add_up_nodes(nodes: &[u32], columns: &mut [(usize, &mut [f64])]) {
    let place = |width: usize, node: u32| width * node as usize..width * (node as usize + 1);
    let own = |(width, column): &(usize, &mut [f64])| -> Vec<f64> {
        nodes.iter().flat_map(|&node| column[place(*width, node)].to_vec()).collect()
    };
    let mut values: Vec<f64> = columns.iter().flat_map(own).collect();
    world().sum(&mut values);
    let mut rest = &values[..];
    for (width, column) in columns {
        for &node in nodes {
            let (sums, others) = rest.split_at(*width);
            column[place(*width, node)].copy_from_slice(sums);
            rest = others;
        }
    }
}

/// A distance beyond everything.
const FAR: f64 = 1e24;

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
        find_nodal_h(part);
        self.adapt_search(part);
        part.info.marks.insert(CONTACT, self.settings.explicit.is_none());
        if !self.updates_normals() {
            part.info.marks.insert(NORMALS_OF_FIRST_ITERATION, true);
        }
        self.settings.adaptation.dynamic_factor = self.settings.explicit.is_some()
            || (part.info.is(COMPUTE_DYNAMIC_FACTOR) && part.nodes.history.has(VELOCITY.name()));
        if part.info.is(SIMPLIFIED_SEMI_SMOOTH_NEWTON) {
            let fact =
                "\"simplified_semi_smooth_newton\" is not followed: the active set is updated in every iteration";
            part.messages.push(
                Diagnostic::warning("simplified-newton", fact)
                    .remedy("nothing to do: the converged state is the same; leave the setting out to silence this"),
            );
        }
        self.set_parameters(part);
        self.max_gap = self.settings.explicit.map_or(0.0, |explicit| explicit.threshold(part));
        self.slaves = slave_nodes(&self.interfaces);
        for node in self.carriers() {
            part.nodes.flags.set(ACTIVE, node as usize, false);
        }
        nodal_normals(part, &self.interfaces);
        Ok(())
    }

    fn unknowns(&self, part: &ModelPart) -> Vec<(ScalarVariable, Vec<u32>)> {
        let unknowns = self.settings.family.multiplier.unknowns(part.info.domain_size);
        unknowns.into_iter().map(|variable| (variable, self.carriers())).collect()
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.acting = self.settings.interval.contains(part.info.time);
        self.cycles.begin_step();
        self.uzawa = Uzawa::default();
        self.released.clear();
        if !self.acting {
            self.switch_off(part);
            return Ok(());
        }
        activation::clear_inactive_multipliers(part, self.settings.family.multiplier, &self.slaves);
        nodal_normals(part, &self.interfaces);
        self.steps_since_search = self.steps_since_search.saturating_add(1);
        if self.steps_since_search >= self.settings.database_step_update {
            self.search(part)?;
            self.steps_since_search = 0;
        }
        self.integrate(part);
        let start = match self.settings.search.check {
            GapCheck::DirectCheck => Start::Touching(&self.touching),
            GapCheck::NoCheck => Start::Reach(f64::MAX),
            GapCheck::CheckMapping if self.settings.simple_search => Start::ShareOfMeshSize,
            GapCheck::CheckMapping => Start::Reach(self.settings.active_check_factor * self.threshold),
        };
        let friction = (self.parameters.friction_law, self.parameters.slip_rule);
        activation::start(part, &self.slaves, start, &self.at_origin, friction);
        friction::start_in_stick(part, &self.slaves, self.parameters.slip_rule, &self.settings.friction);
        self.refresh_pair_normals(part, self.updates_normals());
        for block in &mut self.blocks {
            block.keep_operators(&part.view(), &|nodes| part.evaluates_pair(nodes));
        }
        Ok(())
    }

    fn after_prediction(&mut self, part: &mut ModelPart) -> Result<()> {
        if self.acting {
            self.integrate(part);
            self.write_tangents(part);
        }
        Ok(())
    }

    fn after_update(&mut self, part: &mut ModelPart, iteration: usize) -> Result<SetChange> {
        if !self.acting {
            return Ok(SetChange::default());
        }
        if iteration == 1 || self.updates_normals() {
            nodal_normals(part, &self.interfaces);
        }
        if self.updates_normals() {
            self.refresh_pair_normals(part, true);
        }
        let adaptation = self.settings.adaptation;
        let gaps = adaptation.gaps(part, &self.slaves, self.settings.explicit.is_some());
        self.integrate(part);
        let family = self.settings.family;
        let (mut decisions, before) =
            activation::decide(part, &self.slaves, family, &self.parameters, &mut self.released);
        self.cycles.restrict(&mut decisions, &before, &part.nodes.initial);
        part.messages.extend(self.cycles.keep(&decisions, &part.nodes.ids, part.info.step));
        let change = activation::apply(part, &decisions, &before, family, &self.parameters);
        let penalty = part.info.value_or(INITIAL_PENALTY.name(), 1.0);
        adaptation.adapt(part, &self.slaves, penalty, &gaps, self.max_gap);
        if self.settings.explicit.is_some() {
            let touching = self.slaves.iter().any(|&n| part.nodes.flags.is(ACTIVE, n as usize));
            part.info.marks.insert(CONTACT, touching);
        }
        self.write_tangents(part);
        if part.info.is(ENSURE_CONTACT)
            && change.count() == 0
            && !self.slaves.iter().any(|&n| part.nodes.flags.is(ACTIVE, n as usize))
        {
            return Err(zelus_core::Error::NotConverged(
                "no node is in contact, and \"ensure_contact\" asks for one".to_owned(),
            ));
        }
        Ok(change)
    }

    fn after_convergence(&mut self, part: &mut ModelPart) -> Result<Outer> {
        let Multiplier::Outer(variable) = self.settings.family.multiplier else { return Ok(Outer::Done) };
        if !self.acting {
            return Ok(Outer::Done);
        }
        let (scale_factor, settings) = (self.parameters.scale_factor, self.settings.uzawa);
        Ok(self.uzawa.update(part, &self.slaves, variable, &self.mean_gaps, scale_factor, settings))
    }

    fn accept_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.warn_of_late_pairs(part)?;
        let cleared = |n: u32| self.settings.clear_inactive && !part.nodes.flags.is(ACTIVE, n as usize);
        let inactive: Vec<u32> = self.slaves.iter().copied().filter(|&n| cleared(n)).collect();
        let pressure = part.nodes.values.values_mut(&AUGMENTED_NORMAL_CONTACT_PRESSURE, 0);
        inactive.iter().for_each(|&n| pressure[n as usize] = 0.0);
        if self.settings.family.frictional() {
            let traction = part.nodes.values.values_mut(&AUGMENTED_TANGENT_CONTACT_PRESSURE, 0);
            inactive.iter().for_each(|&n| traction[3 * n as usize..3 * n as usize + 3].fill(0.0));
            if !self.warned_of_friction {
                let warning = friction::warn_of_pushing(
                    part,
                    &self.slaves,
                    self.settings.family.multiplier,
                    self.settings.friction.law,
                );
                self.warned_of_friction = warning.is_some();
                part.messages.extend(warning);
            }
        }
        Ok(())
    }

    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.blocks.iter().map(|block| block.as_entities()).collect()
    }

    fn graph_version(&self) -> u64 {
        self.graph
    }

    /// Without updates, normals are those after the first iteration.
    fn led_nodes(&self) -> Option<Vec<u32>> {
        let mut nodes: Vec<u32> = self.interfaces.iter().flat_map(|i| i.nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        (self.acting && !self.updates_normals()).then_some(nodes)
    }

    fn idle_diagonal(&self) -> f64 {
        self.parameters.scale_factor
    }

    fn relaxation(&self) -> Option<f64> {
        Some(RELAXATION * self.parameters.scale_factor)
    }

    fn save(&mut self) {
        self.saved = self.pairs();
    }

    fn restore(&mut self) {
        let saved = std::mem::take(&mut self.saved);
        // The same shapes were made into blocks before.
        let _ = self.make_blocks(saved);
        self.steps_since_search = usize::MAX;
        self.graph += 1;
    }

    fn summary(&self, part: &ModelPart) -> Vec<(&'static str, f64)> {
        let active = self.slaves.iter().filter(|&&n| part.nodes.flags.is(ACTIVE, n as usize)).count();
        let pairs: usize = self.blocks.iter().map(|block| block.pairs().len()).sum();
        let gaps = part.nodes.history.values(&WEIGHTED_GAP, 0);
        let areas = part.nodes.values.values(&NODAL_AREA, 0);
        let deepest = self.slaves.iter().map(|&n| n as usize).filter(|&n| areas.get(n).is_some_and(|a| *a > 0.0));
        let deepest = deepest.map(|n| gaps[n] / areas[n]).fold(0.0, f64::min);
        let mut out = vec![("pairs", pairs as f64), ("active nodes", active as f64), ("deepest penetration", -deepest)];
        if matches!(self.settings.family.multiplier, Multiplier::Outer(_)) {
            out.extend([("multiplier updates", self.uzawa.updates as f64), ("rate", self.uzawa.rate)]);
        }
        out
    }
}
