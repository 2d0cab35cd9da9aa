//! Contact and ties by linear constraints: slave nodes follow the master surface while they press on it.
//!
//! An active node is held along its normal (without friction, or sliding) or in all components (sticking, tied). It is
//! released when the constraint would have to pull, and held again when it penetrates. A node sticks while the tangential
//! force of its constraint is below the bound of friction; beyond, a force of that size acts on it and on its masters instead,
//! against the slip ([`slider_forces`](super::slider_forces)).

use std::collections::BTreeMap;
use zelus_core::entities::require_kind;
use zelus_core::model::EntityKind;
use zelus_core::model::Role;

use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{EntityBlock, Interaction, SetChange};
use zelus_core::model::flags::{ACTIVE, CONTACT, ISOLATED, MASTER, SLAVE, SLIP};
use zelus_core::model::{
    MasterSlaveConstraint, ModelPart, ScalarVariable, variables::DISPLACEMENT, variables::NORMAL, variables::REACTION,
};
use zelus_core::parameters::Interval;
use zelus_core::vector3::{dot, norm, scale, sub};

use super::activation;
use super::friction::{self, FrictionSettings};
use super::mpc_relation::{Hold, NodeRelation, PairRelation, Weights, can_follow, node_relations};
use super::reach::Reach;
use super::slider_forces::{Slider, SliderForces};
use crate::active_set::SlipRule;
use crate::friction_law::Bound;
use crate::interface::{Interface, Roles, add_contact_part, find_nodal_h, interfaces, nodal_normals, slave_nodes};
use crate::mortar::{IntegrationOrder, SegmentationSettings, tangential};
use crate::pairs::{FacetPair, Friction, PairKey, condition_name, facet_operators, overlapping_pairs};
use crate::resolution::is_more;
use crate::search::SearchSettings;
use crate::solver::UPDATE_EACH_ITERATION;
use crate::variables::{NODAL_AREA, NODAL_H, WEIGHTED_GAP, WEIGHTED_SLIP};

/// Stiffness of the trial force, in those of the body: large, so that its direction is that of the slip.
const DIRECTION: f64 = 1e3;
/// Gauss rule that tells the functions of every facet apart, so that dual ones exist wherever there is area.
const FINE: usize = 4;

/// Iterations in which relations follow every motion: without sliders, and with them.
const SETTLED: [usize; 2] = [15, 5];
/// Motion since relations were made, in mesh sizes, up to which they are those of the iterate.
const STILL: f64 = 1e-9;
/// Motion, in mesh sizes, after which they are renewed in any iteration.
const FAR: f64 = 1e-2;

/// What constraints enforce.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MpcKind {
    /// Contact without friction.
    Frictionless,
    /// Contact with Coulomb friction.
    Frictional,
    /// All overlaps are tied for good.
    MeshTying,
}

/// What a deck chooses about contact by constraints.
pub struct MpcSettings {
    /// Parts of the interfaces by key.
    pub parts: BTreeMap<String, Vec<String>>,
    /// Parts on the slave side by key.
    pub slaves: BTreeMap<String, Vec<String>>,
    /// What the constraints enforce.
    pub kind: MpcKind,
    /// Whether contact always slides.
    pub pure_slip: bool,
    /// Friction.
    pub friction: FrictionSettings,
    /// Times in which the constraints act.
    pub interval: Interval,
    /// Which facets are looked at.
    pub search: SearchSettings,
    /// Steps between searches.
    pub database_step_update: usize,
    /// How overlaps are cut and integrated.
    pub segmentation: SegmentationSettings,
    /// Pressure, in Young's moduli, below which an active node is released.
    pub reaction_check_stiffness_factor: f64,
    /// Whether relations are made anew at each step.
    pub update_relations: bool,
    /// How the rows of a node make up its relation.
    pub weights: Weights,
    /// Whether openings stay as they are in the first step of a run.
    pub keeps_first_opening: bool,
    /// Whether sides are exchanged where supports hold all slaves of an interface.
    pub swaps_held_slaves: bool,
}

/// Contact by constraints in a model part.
pub struct MpcInteraction {
    settings: MpcSettings,
    interfaces: Vec<Interface>,
    slaves: Vec<u32>,
    pairs: BTreeMap<PairKey, PairRelation>,
    nodes: BTreeMap<u32, NodeRelation>,
    /// Where the nodes of the interfaces were when relations were made.
    places: Vec<[f64; 3]>,
    sliders: Vec<SliderForces>,
    entry: Option<&'static EntityKind>,
    directions: BTreeMap<u32, [f64; 3]>,
    graph: u64,
    slip_rule: SlipRule,
    update_each_iteration: bool,
    young: f64,
    first_id: usize,
    version: u64,
    steps_since_search: usize,
    acting: bool,
    sided: bool,
    reach: Reach,
    warned: bool,
    warned_of_held: bool,
    saved: BTreeMap<PairKey, PairRelation>,
    saved_directions: BTreeMap<u32, [f64; 3]>,
}

impl MpcInteraction {
    /// Contact with these settings; the interfaces are built at once, so that a wrong part is named early.
    ///
    /// # Errors
    /// Parts that do not exist or hold no facets.
    pub fn new(settings: MpcSettings, part: &mut ModelPart) -> Result<Self> {
        let interfaces = interfaces(part, &settings.parts, &settings.slaves)?;
        add_contact_part(part, &interfaces);
        Ok(Self {
            settings,
            slaves: slave_nodes(&interfaces),
            interfaces,
            pairs: BTreeMap::new(),
            nodes: BTreeMap::new(),
            places: Vec::new(),
            sliders: Vec::new(),
            entry: None,
            directions: BTreeMap::new(),
            graph: 1,
            slip_rule: SlipRule::Pure,
            update_each_iteration: false,
            young: 0.0,
            first_id: 0,
            version: 0,
            steps_since_search: usize::MAX,
            acting: false,
            sided: false,
            reach: Reach::default(),
            warned: false,
            warned_of_held: false,
            saved: BTreeMap::new(),
            saved_directions: BTreeMap::new(),
        })
    }

    fn tying(&self) -> bool {
        self.settings.kind == MpcKind::MeshTying
    }

    /// Exchanges the sides of interfaces whose slaves are all held by supports: constraints move slaves, and these cannot move.
    fn take_sides(&mut self, part: &mut ModelPart) {
        if std::mem::replace(&mut self.sided, true) || !self.settings.swaps_held_slaves {
            return;
        }
        for interface in self.interfaces.iter_mut().filter(|interface| !interface.open) {
            let [slaves, masters] = [Roles::Slave, Roles::Master].map(|role| interface.nodes_of(role));
            let held = |nodes: &[u32]| nodes.iter().all(|&node| !can_follow(part, node, normal(part, node)));
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
            part.messages.push(Diagnostic::warning("mpc-held-slaves", fact).remedy(remedy));
        }
        self.slaves = slave_nodes(&self.interfaces);
    }

    /// Names nodes in contact that supports hold along their normals, while their masters are free: nothing holds those there.
    fn warn_of_held(&mut self, part: &mut ModelPart) {
        if self.warned_of_held || self.tying() {
            return;
        }
        let presses = |node: u32, relation: &NodeRelation| {
            let at = node as usize;
            let n = relation.normal;
            part.nodes.flags.is(ACTIVE, at)
                && !can_follow(part, node, n)
                && relation.weights.iter().any(|&(master, _)| can_follow(part, master, n))
        };
        let resolved = activation::resolved_length(part, &self.slaves);
        let held = self.nodes.iter().filter(|(node, relation)| presses(**node, relation));
        let (weighted, areas) = (part.nodes.history.values(&WEIGHTED_GAP, 0), part.nodes.values.values(&NODAL_AREA, 0));
        let depths: Vec<(u32, f64)> = held
            .map(|(&node, _)| (node, -weighted[node as usize] / areas[node as usize]))
            .filter(|of| of.1 > resolved)
            .collect();
        let Some(&(node, depth)) = depths.iter().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))) else { return };
        self.warned_of_held = true;
        let fact = format!(
            "supports hold {} slave nodes in contact along their normals: constraints cannot hold the masters there, and node \
             {} is {depth:.1e} inside the other body",
            depths.len(),
            part.nodes.ids[node as usize]
        );
        let remedy = "make the other side the slave, or use alm_contact_process";
        part.messages.push(Diagnostic::warning("mpc-held-nodes", fact).remedy(remedy));
    }

    /// Relations of the pairs that overlap; those that hold a node stay as they were made, unless they are to be renewed.
    fn search(&mut self, part: &mut ModelPart) {
        let holds = |relation: &PairRelation| relation.nodes().any(|n| part.nodes.flags.is(ACTIVE, n as usize));
        let keep = !self.settings.update_relations || self.tying();
        let (interfaces, segmentation) = (&self.interfaces, &self.settings.segmentation);
        self.pairs.retain(|key, relation| {
            let facets = &interfaces[key.interface as usize].facets;
            let (slave, master) = (&facets[key.slave as usize], &facets[key.master as usize]);
            keep && holds(relation) && facet_operators(part, slave, master, segmentation).is_some()
        });
        let known = |key: &PairKey| self.pairs.contains_key(key);
        let found = overlapping_pairs(part, interfaces, &self.settings.search, segmentation, &known);
        self.relate(part, &found);
        self.warn_of_unlike_meshes(part);
    }

    /// Normals and relations of this iterate, where nodes have moved since they were made.
    ///
    /// The tangent does not know how they change, which slows iterations whose sliders hardly slide: later ones change them
    /// only where nodes have moved far.
    fn follow(&mut self, part: &mut ModelPart, iteration: usize) {
        let settled = SETTLED[usize::from(!self.sliders.is_empty())];
        let least = if iteration <= settled { STILL } else { FAR };
        if self.farthest(part) > least {
            nodal_normals(part, &self.interfaces);
            self.search(part);
        }
    }

    /// How far nodes of the interfaces are from where they were when relations were made, in mesh sizes.
    fn farthest(&self, part: &ModelPart) -> f64 {
        let sizes = part.nodes.values.values(&NODAL_H, 0);
        let nodes = self.interfaces.iter().flat_map(|interface| &interface.nodes).map(|&node| node as usize);
        let ratio = |(at, before): (usize, &[f64; 3])| {
            let moved = norm(sub(part.nodes.current[at], *before));
            if sizes[at] > 0.0 { moved / sizes[at] } else { moved }
        };
        nodes.zip(&self.places).map(ratio).fold(0.0, f64::max)
    }

    fn relate(&mut self, part: &ModelPart, pairs: &[FacetPair]) {
        for pair in pairs {
            let facets = &self.interfaces[pair.key.interface as usize].facets;
            let (slave, master) = (&facets[pair.key.slave as usize], &facets[pair.key.master as usize]);
            let finer = || {
                let integration_order = IntegrationOrder::new(FINE)?.max(self.settings.segmentation.integration_order);
                let segmentation = SegmentationSettings { integration_order, ..self.settings.segmentation };
                facet_operators(part, slave, master, &segmentation)
            };
            let relation = PairRelation::new(part, &self.interfaces, pair, self.settings.weights, finer);
            self.pairs.insert(pair.key, relation);
        }
        let nodes = self.interfaces.iter().flat_map(|interface| &interface.nodes);
        self.places = nodes.map(|&node| part.nodes.current[node as usize]).collect();
        let pairs = self.pairs.iter().map(|(key, relation)| (key.interface, relation));
        self.nodes = node_relations(pairs, &self.interfaces, self.settings.weights);
    }

    /// With weights that do not add up to one nodes that follow several masters pass forces on wrongly, unless the master is
    /// held.
    fn warn_of_unlike_meshes(&mut self, part: &mut ModelPart) {
        if self.warned || self.settings.weights == Weights::Consistent {
            return;
        }
        let dimension = part.info.domain_size as u8;
        let deforms = |node: u32| (0..dimension).any(|c| !part.nodes.is_fixed(DISPLACEMENT.component(c), node));
        let mixed = self.nodes.values().filter(|relation| relation.is_mixed()).count();
        if mixed > 0 && self.nodes.values().flat_map(|n| &n.weights).any(|&(node, _)| deforms(node)) {
            self.warned = true;
            let fact = format!(
                "constraints join unlike meshes of deformable bodies at {mixed} slave nodes: stresses there are wrong"
            );
            part.messages.push(
                Diagnostic::warning("mpc-unlike-meshes", fact).remedy(
                    "leave \"consistent_weights\" at true: forces are then passed on as by alm_contact_process",
                ),
            );
        }
    }

    /// Writes WEIGHTED_GAP and NODAL_AREA in the present configuration.
    fn integrate(&self, part: &mut ModelPart) {
        let count = part.nodes.len();
        let (mut gap, mut area) = (vec![0.0; count], vec![0.0; count]);
        for key in self.pairs.keys() {
            let facets = &self.interfaces[key.interface as usize].facets;
            let (slave, master) = (&facets[key.slave as usize], &facets[key.master as usize]);
            let Some(operators) = facet_operators(part, slave, master, &self.settings.segmentation) else { continue };
            let origin = part.nodes.current[slave.nodes[0] as usize];
            let place = |n: &u32| sub(part.nodes.current[*n as usize], origin);
            let of_slave: Vec<[f64; 3]> = slave.nodes.iter().map(place).collect();
            let of_master: Vec<[f64; 3]> = master.nodes.iter().map(place).collect();
            for (j, &node) in slave.nodes.iter().enumerate() {
                let n = normal(part, node);
                let node = node as usize;
                gap[node] -= dot(n, operators.jump(j, &of_slave, &of_master));
                area[node] += operators.d[j][..slave.nodes.len()].iter().sum::<f64>();
            }
        }
        for &node in &self.slaves {
            part.nodes.flags.set(ISOLATED, node as usize, !self.nodes.contains_key(&node));
        }
        part.nodes.history.values_mut(&WEIGHTED_GAP, 0).copy_from_slice(&gap);
        part.nodes.values.values_mut(&NODAL_AREA, 0).copy_from_slice(&area);
    }

    /// Puts the constraints of the active nodes into the model part.
    fn write_constraints(&mut self, part: &mut ModelPart) {
        let first = self.first_id;
        let own = |c: &MasterSlaveConstraint| c.id >= first && self.slaves.binary_search(&c.slave.0).is_ok();
        let mut constraints = std::mem::take(&mut part.constraints);
        constraints.retain(|c| !own(c));
        let mut next_id = constraints.iter().map(|c| c.id + 1).max().unwrap_or(1).max(first);
        for (&node, relation) in &self.nodes {
            if part.nodes.flags.is(ACTIVE, node as usize) {
                let hold = match self.settings.kind {
                    MpcKind::Frictionless => Hold::Normal { push: [0.0; 3] },
                    MpcKind::Frictional if part.nodes.flags.is(SLIP, node as usize) => {
                        let bound = self.settings.friction.law.bound_at(&part.nodes, node as usize);
                        let direction = self.directions.get(&node).copied().unwrap_or_default();
                        Hold::Normal { push: scale(direction, bound.coefficient) }
                    }
                    MpcKind::Frictional => Hold::Stick,
                    MpcKind::MeshTying if self.settings.weights == Weights::Consistent => Hold::Tied,
                    MpcKind::MeshTying => Hold::Closed,
                };
                let keeps = self.settings.keeps_first_opening && part.info.step <= 1;
                let relation = if keeps { &relation.keeping_opening() } else { relation };
                relation.constraints(part, node, hold, &mut next_id, &mut constraints);
            }
        }
        part.constraints = constraints;
        self.version += 1;
    }

    fn switch_off(&mut self, part: &mut ModelPart) {
        self.slaves.iter().for_each(|&node| part.nodes.flags.set(ACTIVE, node as usize, false));
        self.pairs.clear();
        self.nodes.clear();
        self.set_sliders(Vec::new(), part.info.domain_size);
        self.write_constraints(part);
    }

    /// Contact opens where a constraint pulls and closes where a free node penetrates: the sign of the force that holds a
    /// node and of its depth times a stiffness together, so that a depth of round-off holds nothing.
    fn update_contact(&self, part: &mut ModelPart, change: &mut SetChange) {
        let release = self.settings.reaction_check_stiffness_factor * self.young;
        for &node in &self.slaves {
            let at = node as usize;
            let Some(relation) = self.nodes.get(&node) else {
                if part.nodes.flags.is(ACTIVE, at) {
                    part.nodes.flags.set(ACTIVE, at, false);
                    change.deactivated.push(part.nodes.ids[at]);
                }
                continue;
            };
            let area = part.nodes.values.values(&NODAL_AREA, 0)[at];
            let was = part.nodes.flags.is(ACTIVE, at);
            let held = if was { dot(reaction(part, node), relation.normal) } else { 0.0 };
            let depth = part.nodes.history.values(&WEIGHTED_GAP, 0)[at].min(0.0);
            let now = area > 0.0 && held + self.stiffness(part, at) * depth < -release * area;
            if was != now {
                part.nodes.flags.set(ACTIVE, at, now);
                if now && self.settings.kind == MpcKind::Frictional {
                    let smooth = self.settings.friction.law.bound_at(&part.nodes, at).is_smooth();
                    part.nodes.flags.set(SLIP, at, smooth || self.slip_rule == SlipRule::Pure);
                }
                let list = if now { &mut change.activated } else { &mut change.deactivated };
                list.push(part.nodes.ids[at]);
            }
        }
    }

    /// Stiffness of the body behind a node (force by volume).
    fn stiffness(&self, part: &ModelPart, at: usize) -> f64 {
        let size = part.nodes.values.values(&NODAL_H, 0)[at];
        if size > 0.0 { self.young / size } else { self.young }
    }

    /// Friction at the active nodes: which of them slide, and the forces on those that do.
    fn update_friction(&mut self, part: &mut ModelPart, change: &mut SetChange) {
        if self.settings.kind != MpcKind::Frictional {
            return;
        }
        let before = std::mem::take(&mut self.directions);
        let mut slips = vec![[0.0; 3]; part.nodes.len()];
        let mut sliders = Vec::new();
        let resolved = activation::resolved_length(part, &self.slaves);
        for (&node, relation) in &self.nodes {
            let at = node as usize;
            if !part.nodes.flags.is(ACTIVE, at) {
                continue;
            }
            let n = relation.normal;
            let moved = tangential(sub(relation.lead(part, node, 0), relation.lead(part, node, 1)), n);
            let moved = if norm(moved) > resolved { moved } else { [0.0; 3] };
            let area = part.nodes.values.values(&NODAL_AREA, 0)[at];
            slips[at] = scale(moved, area);
            let held = reaction(part, node);
            let Bound { coefficient, threshold } = self.settings.friction.law.bound_at(&part.nodes, at);
            let constant = threshold * area;
            let bound = Bound { coefficient, threshold: constant }.at(dot(held, n).min(0.0));
            let sliding = part.nodes.flags.is(SLIP, at);
            let stiffness = self.stiffness(part, at) * area;
            // The friction of a sliding node keeps the direction it had but for what the slip turns it.
            let kept = direction_along(before.get(&node), n);
            // A node that slides along with its friction would gain energy: it sticks, or turns where it slides far.
            let near = stiffness * norm(moved) < 2.0 * bound;
            let slides = match (self.slip_rule, sliding) {
                (SlipRule::Pure, _) => true,
                (_, true) => !near || dot(moved, kept) <= 0.0,
                (_, false) => is_more(norm(tangential(held, n)), bound),
            };
            let stiffness = DIRECTION * stiffness;
            let trial = if sliding { sub(scale(kept, bound), scale(moved, stiffness)) } else { tangential(held, n) };
            if slides != sliding {
                part.nodes.flags.set(SLIP, at, slides);
                change.stick_slip.push(part.nodes.ids[at]);
            }
            if slides {
                sliders.push(Slider::new(node, relation.weights.clone(), n, trial, [bound, constant], stiffness));
            }
        }
        part.nodes.history.values_mut(&WEIGHTED_SLIP, 0).copy_from_slice(slips.as_flattened());
        self.set_sliders(sliders, part.info.domain_size);
    }

    fn set_sliders(&mut self, sliders: Vec<Slider>, dimension: usize) {
        self.directions = sliders.iter().map(|slider| (slider.node, slider.direction)).collect();
        let Some(entry) = self.entry else { return };
        let blocks = SliderForces::blocks(entry, sliders, dimension);
        if !blocks.iter().map(SliderForces::all_nodes).eq(self.sliders.iter().map(SliderForces::all_nodes)) {
            self.graph += 1;
        }
        self.sliders = blocks;
    }

    /// Nodes that slide from the step before begin in the direction they had.
    fn slide_on(&mut self, part: &ModelPart) {
        let before = std::mem::take(&mut self.directions);
        let flags = &part.nodes.flags;
        let slides = |at: usize| flags.is(ACTIVE, at) && flags.is(SLIP, at);
        let sliders = self.nodes.iter().filter(|(node, _)| slides(**node as usize)).map(|(&node, relation)| {
            let direction = direction_along(before.get(&node), relation.normal);
            let area = part.nodes.values.values(&NODAL_AREA, 0)[node as usize];
            let constant = self.settings.friction.law.bound_at(&part.nodes, node as usize).threshold * area;
            Slider::new(node, relation.weights.clone(), relation.normal, direction, [constant; 2], 0.0)
        });
        let sliders = sliders.collect();
        self.set_sliders(sliders, part.info.domain_size);
    }
}

/// The unit vector of the part of a direction in the tangent of a normal; none where there is none.
fn direction_along(direction: Option<&[f64; 3]>, normal: [f64; 3]) -> [f64; 3] {
    let along = direction.map_or([0.0; 3], |direction| tangential(*direction, normal));
    let size = norm(along);
    if size > 0.0 { scale(along, size.recip()) } else { along }
}

fn normal(part: &ModelPart, node: u32) -> [f64; 3] {
    part.nodes.history.get(NORMAL.name()).map_or([0.0; 3], |field| field.vector(0, node as usize))
}

fn reaction(part: &ModelPart, node: u32) -> [f64; 3] {
    part.nodes.history.get(REACTION.name()).map_or([0.0; 3], |field| field.vector(0, node as usize))
}

impl Interaction for MpcInteraction {
    fn name(&self) -> &str {
        "contact by constraints"
    }

    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        part.nodes.history.add(&NORMAL);
        part.nodes.history.add(&WEIGHTED_GAP);
        part.nodes.history.add(&REACTION);
        find_nodal_h(part);
        part.info.marks.insert(CONTACT, true);
        self.update_each_iteration = part.info.is(UPDATE_EACH_ITERATION);
        self.first_id = part.constraints.iter().map(|c| c.id + 1).max().unwrap_or(1);
        let largest = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, f64::max);
        let young = |id| part.properties.get(id).and_then(|properties| properties.number("YOUNG_MODULUS"));
        let facets = self.interfaces.iter().flat_map(|i| &i.facets);
        self.young = largest(&mut facets.filter_map(|facet| young(&facet.properties)));
        if self.young == 0.0 {
            self.young = largest(&mut part.properties.keys().filter_map(young));
        }
        if self.settings.kind == MpcKind::Frictional {
            part.nodes.history.add(&WEIGHTED_SLIP);
            let friction = if self.settings.pure_slip { Friction::PureSlip } else { Friction::Coulomb };
            self.slip_rule = friction::prepare(part, &self.interfaces, &self.settings.friction, friction);
            let facet = &self.interfaces[0].facets[0];
            let name = condition_name("MPCMortarContactCondition", facet.shape, facet.shape);
            self.entry = Some(require_kind(Role::Condition, &name)?);
        }
        nodal_normals(part, &self.interfaces);
        Ok(())
    }

    fn unknowns(&self, _part: &ModelPart) -> Vec<(ScalarVariable, Vec<u32>)> {
        Vec::new()
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.acting = self.settings.interval.contains(part.info.time);
        if !self.acting {
            self.switch_off(part);
            return Ok(());
        }
        nodal_normals(part, &self.interfaces);
        self.take_sides(part);
        self.reach = Reach::default();
        self.steps_since_search = self.steps_since_search.saturating_add(1);
        if self.tying() && self.settings.weights == Weights::Consistent && !self.pairs.is_empty() {
            self.relate(part, &[]);
        } else if self.steps_since_search >= self.settings.database_step_update {
            self.search(part);
            self.steps_since_search = 0;
        }
        self.integrate(part);
        if self.tying() {
            let nodes: Vec<u32> = self.nodes.keys().copied().collect();
            nodes.iter().for_each(|&node| part.nodes.flags.set(ACTIVE, node as usize, true));
        } else {
            let friction = (self.settings.friction.law, self.slip_rule);
            activation::start(part, &self.slaves, activation::Start::ShareOfMeshSize, friction);
            friction::start_in_stick(part, &self.slaves, self.slip_rule, &self.settings.friction);
            self.slide_on(part);
        }
        self.write_constraints(part);
        Ok(())
    }

    fn after_prediction(&mut self, _part: &mut ModelPart) -> Result<()> {
        Ok(())
    }

    fn after_update(&mut self, part: &mut ModelPart, iteration: usize) -> Result<SetChange> {
        let mut change = SetChange::default();
        if !self.acting {
            return Ok(change);
        }
        if self.update_each_iteration && !self.tying() && self.settings.update_relations {
            self.follow(part, iteration);
        } else if self.update_each_iteration && !(self.tying() && self.settings.weights == Weights::Consistent) {
            nodal_normals(part, &self.interfaces);
            let keys: Vec<PairKey> = self.pairs.keys().copied().collect();
            let pairs: Vec<FacetPair> = keys
                .into_iter()
                .filter_map(|key| {
                    let facets = &self.interfaces[key.interface as usize].facets;
                    let (slave, master) = (&facets[key.slave as usize], &facets[key.master as usize]);
                    let operators = facet_operators(part, slave, master, &self.settings.segmentation)?;
                    Some(FacetPair { key, operators })
                })
                .collect();
            self.relate(part, &pairs);
        }
        self.integrate(part);
        if !self.tying() {
            self.update_contact(part, &mut change);
            self.update_friction(part, &mut change);
        }
        if self.update_each_iteration || change.count() > 0 || !self.directions.is_empty() {
            self.write_constraints(part);
        }
        Ok(change)
    }

    fn reach_out(&mut self, part: &mut ModelPart) -> bool {
        if !self.acting || self.tying() {
            return false;
        }
        let near = self.reach.next(part, &self.interfaces);
        let friction = (self.settings.friction.law, self.slip_rule);
        activation::start(part, &self.slaves, activation::Start::Touching(&near), friction);
        self.write_constraints(part);
        !near.is_empty()
    }

    fn accept_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.warn_of_held(part);
        Ok(())
    }

    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.sliders.iter().map(|forces| forces as &dyn EntityBlock).collect()
    }

    fn graph_version(&self) -> u64 {
        self.graph
    }

    fn constraints_version(&self) -> u64 {
        self.version
    }

    fn needs_reactions(&self) -> bool {
        !self.tying()
    }

    fn save(&mut self) {
        self.saved = self.pairs.clone();
        self.saved_directions = self.directions.clone();
    }

    fn restore(&mut self) {
        self.pairs = std::mem::take(&mut self.saved);
        self.directions = std::mem::take(&mut self.saved_directions);
        self.steps_since_search = usize::MAX;
    }

    fn summary(&self, part: &ModelPart) -> Vec<(&'static str, f64)> {
        let active = self.slaves.iter().filter(|&&n| part.nodes.flags.is(ACTIVE, n as usize)).count();
        vec![("pairs", self.pairs.len() as f64), ("active nodes", active as f64)]
    }
}
