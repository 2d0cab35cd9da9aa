//! Contact and ties by linear constraints: slave nodes follow the master surface while they press on it.
//!
//! An active node is held along its normal (without friction, or sliding) or in all components (sticking, tied). It is
//! released when the constraint would have to pull, and held again when it penetrates. A node sticks while the tangential
//! force of its constraint is below Coulomb's bound; beyond, that bound acts on it and on its masters instead.

use std::collections::{BTreeMap, BTreeSet};

use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{EntityBlock, Interaction, MasterSlaveConstraint, SetChange};
use zelus_core::model::flags::{ACTIVE, CONTACT, ISOLATED, SLIP};
use zelus_core::model::{ModelPart, ScalarVariable, variables::DISPLACEMENT, variables::NORMAL, variables::REACTION};
use zelus_core::parameters::Interval;
use zelus_core::registry::{self, Kind};
use zelus_core::vector3::{dot, norm, scale, sub};

use super::activation;
use super::friction::{self, FrictionSettings};
use super::mpc_relation::{Hold, NodeRelation, PairRelation, Weights, node_relations};
use super::nodal_forces::NodalForces;
use crate::active_set::SlipRule;
use crate::interface::{Interface, add_contact_part, find_nodal_h, interfaces, nodal_normals, slave_nodes};
use crate::mortar::SegmentationSettings;
use crate::pairs::{FacetPair, Friction, PairKey, condition_name, facet_operators, overlapping_pairs};
use crate::resolution::is_more;
use crate::search::SearchSettings;
use crate::solver::UPDATE_EACH_ITERATION;
use crate::variables::{NODAL_AREA, NODAL_H, WEIGHTED_GAP, WEIGHTED_SLIP};

/// Penetration, in mesh sizes, below which a free node stays free: round-off of positions.
const PENETRATION: f64 = 1e-12;

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
    /// By what the rows of a node are divided.
    pub weights: Weights,
}

/// Contact by constraints in a model part.
pub struct MpcInteraction {
    settings: MpcSettings,
    interfaces: Vec<Interface>,
    slaves: Vec<u32>,
    pairs: BTreeMap<PairKey, PairRelation>,
    nodes: BTreeMap<u32, NodeRelation>,
    friction: Option<NodalForces>,
    slip_rule: SlipRule,
    update_each_iteration: bool,
    release: f64,
    first_id: usize,
    version: u64,
    steps_since_search: usize,
    acting: bool,
    warned: bool,
    saved: BTreeMap<PairKey, PairRelation>,
    saved_forces: Vec<[f64; 3]>,
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
            friction: None,
            slip_rule: SlipRule::Pure,
            update_each_iteration: false,
            release: 0.0,
            first_id: 0,
            version: 0,
            steps_since_search: usize::MAX,
            acting: false,
            warned: false,
            saved: BTreeMap::new(),
            saved_forces: Vec::new(),
        })
    }

    fn tying(&self) -> bool {
        self.settings.kind == MpcKind::MeshTying
    }

    /// Relations of the pairs that overlap; those that hold a node stay as they were made, unless they are to be renewed.
    fn search(&mut self, part: &mut ModelPart) {
        let holds = |relation: &PairRelation| relation.nodes().any(|n| part.nodes.flags.is(ACTIVE, n as usize));
        let keep = !self.settings.update_relations;
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

    fn relate(&mut self, part: &ModelPart, pairs: &[FacetPair]) {
        for pair in pairs {
            self.pairs.insert(pair.key, PairRelation::new(part, &self.interfaces, pair));
        }
        let pairs = self.pairs.iter().map(|(key, relation)| (key.interface, relation));
        self.nodes = node_relations(pairs, &self.interfaces, self.settings.weights);
    }

    /// Nodes that follow several masters pass forces on wrongly, unless the master is held.
    fn warn_of_unlike_meshes(&mut self, part: &mut ModelPart) {
        if self.warned {
            return;
        }
        let dimension = part.info.domain_size as u8;
        let deforms = |node: u32| (0..dimension).any(|c| !part.dofs.is_fixed(DISPLACEMENT.component(c), node));
        let mixed = self.nodes.values().filter(|relation| relation.is_mixed()).count();
        if mixed > 0 && self.nodes.values().flat_map(|n| &n.weights).any(|&(node, _)| deforms(node)) {
            self.warned = true;
            let fact = format!(
                "constraints join unlike meshes of deformable bodies at {mixed} slave nodes: stresses there are wrong"
            );
            part.messages.push(Diagnostic::warning("mpc-unlike-meshes", fact).remedy(
                "use alm_contact_process or mesh_tying_process; \"consistent_weights\" at least keeps rigid motions",
            ));
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
                let node = node as usize;
                let normal = part.nodes.history.get(NORMAL.name()).map_or([0.0; 3], |f| f.vector(0, node));
                gap[node] -= dot(normal, operators.jump(j, &of_slave, &of_master));
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
                    MpcKind::Frictionless => Hold::Normal,
                    MpcKind::Frictional if part.nodes.flags.is(SLIP, node as usize) => Hold::Normal,
                    MpcKind::Frictional => Hold::Stick,
                    MpcKind::MeshTying => Hold::All,
                };
                relation.constraints(part, node, hold, &mut next_id, &mut constraints);
            }
        }
        part.constraints = constraints;
        self.version += 1;
    }

    fn clear_forces(&mut self) {
        if let Some(friction) = &mut self.friction {
            friction.forces.fill([0.0; 3]);
        }
    }

    fn switch_off(&mut self, part: &mut ModelPart) {
        self.slaves.iter().for_each(|&node| part.nodes.flags.set(ACTIVE, node as usize, false));
        self.pairs.clear();
        self.nodes.clear();
        self.clear_forces();
        self.write_constraints(part);
    }

    /// Contact opens where a constraint pulls and closes where a free node penetrates.
    fn update_contact(&self, part: &mut ModelPart, change: &mut SetChange) {
        for &node in &self.slaves {
            let at = node as usize;
            let Some(relation) = self.nodes.get(&node) else { continue };
            let area = part.nodes.values.values(&NODAL_AREA, 0)[at];
            let was = part.nodes.flags.is(ACTIVE, at);
            let gap = part.nodes.history.values(&WEIGHTED_GAP, 0)[at];
            let penetrates = gap < -PENETRATION * part.nodes.values.values(&NODAL_H, 0)[at] * area;
            let presses = was && dot(reaction(part, node), relation.normal) < -self.release * area;
            let now = area > 0.0 && (presses || penetrates);
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

    /// Coulomb's law at the active nodes: which of them slide, and the forces on those that do.
    fn update_friction(&mut self, part: &mut ModelPart, change: &mut SetChange) {
        let Some(forces) = &mut self.friction else { return };
        let before = std::mem::replace(&mut forces.forces, vec![[0.0; 3]; part.nodes.len()]);
        let mut slips = vec![[0.0; 3]; part.nodes.len()];
        let resolved = activation::resolved_length(part, &self.slaves);
        for (&node, relation) in &self.nodes {
            let at = node as usize;
            if !part.nodes.flags.is(ACTIVE, at) {
                continue;
            }
            let n = relation.normal;
            let tangential = |v: [f64; 3]| sub(v, scale(n, dot(v, n)));
            let moved = tangential(sub(relation.lead(part, node, 0), relation.lead(part, node, 1)));
            let area = part.nodes.values.values(&NODAL_AREA, 0)[at];
            slips[at] = scale(moved, area);
            let held = reaction(part, node);
            let bound = self.settings.friction.law.bound_at(&part.nodes, at).at(dot(held, n).min(0.0));
            let sliding = part.nodes.flags.is(SLIP, at);
            // A sliding node keeps the direction in which it began, a node that began to slide without one goes against
            // its motion.
            let kept = norm(before[at]) > 0.0;
            let wanted = match (sliding, kept) {
                (true, true) => tangential(before[at]),
                (true, false) => scale(moved, -1.0),
                (false, _) => tangential(held),
            };
            // A node that slides along with its friction would gain energy: it sticks.
            let slides = if self.slip_rule == SlipRule::Pure {
                true
            } else if sliding {
                bound <= 0.0 || dot(moved, before[at]) <= resolved * norm(before[at])
            } else {
                is_more(norm(wanted), bound)
            };
            if slides != sliding {
                part.nodes.flags.set(SLIP, at, slides);
                change.stick_slip.push(part.nodes.ids[at]);
            }
            let size = norm(wanted);
            if !slides || size == 0.0 || (sliding && !kept && size <= resolved) {
                continue;
            }
            let force = scale(wanted, bound / size);
            (0..3).for_each(|c| forces.forces[at][c] += force[c]);
            for &(master, weight) in &relation.weights {
                (0..3).for_each(|c| forces.forces[master as usize][c] -= weight * force[c]);
            }
        }
        part.nodes.history.values_mut(&WEIGHTED_SLIP, 0).copy_from_slice(slips.as_flattened());
    }
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
        let young = self.interfaces.iter().flat_map(|i| &i.facets).filter_map(|facet| {
            part.properties.get(&facet.properties).and_then(|properties| properties.number("YOUNG_MODULUS"))
        });
        self.release = self.settings.reaction_check_stiffness_factor * young.fold(0.0, f64::max);
        if self.settings.kind == MpcKind::Frictional {
            part.nodes.history.add(&WEIGHTED_SLIP);
            let friction = if self.settings.pure_slip { Friction::PureSlip } else { Friction::Coulomb };
            self.slip_rule = friction::prepare(part, &self.interfaces, &self.settings.friction, friction);
            let facet = &self.interfaces[0].facets[0];
            let name = condition_name("MPCMortarContactCondition", facet.shape, facet.shape);
            let entry = registry::require(Kind::Condition, &name)?;
            let mut nodes: Vec<u32> = self.interfaces.iter().flat_map(|i| i.nodes.iter().copied()).collect();
            nodes.sort_unstable();
            nodes.dedup();
            self.friction = Some(NodalForces::new(entry, nodes, part.nodes.len(), part.info.domain_size));
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
        self.steps_since_search = self.steps_since_search.saturating_add(1);
        if self.steps_since_search >= self.settings.database_step_update {
            self.search(part);
            self.steps_since_search = 0;
        }
        self.integrate(part);
        if self.tying() {
            let nodes: Vec<u32> = self.nodes.keys().copied().collect();
            nodes.iter().for_each(|&node| part.nodes.flags.set(ACTIVE, node as usize, true));
        } else {
            let friction = (self.settings.friction.law, self.slip_rule);
            activation::start(part, &self.slaves, activation::Start::ShareOfMeshSize, &BTreeSet::new(), friction);
            friction::start_in_stick(part, &self.slaves, self.slip_rule, &self.settings.friction);
        }
        self.write_constraints(part);
        Ok(())
    }

    fn after_prediction(&mut self, _part: &mut ModelPart) -> Result<()> {
        Ok(())
    }

    fn after_update(&mut self, part: &mut ModelPart, _iteration: usize) -> Result<SetChange> {
        let mut change = SetChange::default();
        if !self.acting {
            return Ok(change);
        }
        if self.update_each_iteration {
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
        if self.update_each_iteration || change.count() > 0 {
            self.write_constraints(part);
        }
        Ok(change)
    }

    fn accept_step(&mut self, _part: &mut ModelPart) -> Result<()> {
        Ok(())
    }

    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.friction.iter().map(|forces| forces as &dyn EntityBlock).collect()
    }

    fn graph_version(&self) -> u64 {
        1
    }

    fn constraints_version(&self) -> u64 {
        self.version
    }

    fn needs_reactions(&self) -> bool {
        !self.tying()
    }

    fn save(&mut self) {
        self.saved = self.pairs.clone();
        self.saved_forces = self.friction.as_ref().map(|friction| friction.forces.clone()).unwrap_or_default();
    }

    fn restore(&mut self) {
        self.pairs = std::mem::take(&mut self.saved);
        if let Some(friction) = &mut self.friction {
            friction.forces = std::mem::take(&mut self.saved_forces);
        }
        self.steps_since_search = usize::MAX;
    }

    fn summary(&self, part: &ModelPart) -> Vec<(&'static str, f64)> {
        let active = self.slaves.iter().filter(|&&n| part.nodes.flags.is(ACTIVE, n as usize)).count();
        vec![("pairs", self.pairs.len() as f64), ("active nodes", active as f64)]
    }
}
