//! Meshes that do not match, tied by multipliers: D and M of a pair are those of the moment it is made.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{Coupling, EntityBlock, Interaction, Join, PairState, require_kind};
use zelus_core::model::flags::ACTIVE;
use zelus_core::model::{Carriers, MasterSlaveConstraint, ModelPart, Role, ScalarVariable};
use zelus_core::parameters::Interval;
use zelus_core::{Carrier, Result, State};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::holding::Holding;
use super::pair_states::{joins, name};
use crate::flags::CONTACT;
use crate::interface::{
    Fixed, Interface, NodalNormals, Roles, add_contact_part, alm_parameters, find_nodal_h, interfaces, nodal_normals,
    slave_nodes, warnings_of_pairs,
};
use crate::mortar::SegmentationSettings;
use crate::pairs::{
    FacetOperators, FacetPair, PairKey, TyingBlock, TyingFamily, TyingRequest, check_pairs, condition_name,
    group_by_shapes, overlapping_pairs,
};
use crate::search::SearchSettings;

/// What a deck chooses about a tie.
pub struct TyingSettings {
    /// Parts of the interfaces by key.
    pub parts: BTreeMap<String, Vec<String>>,
    /// Parts on the slave side by key.
    pub slaves: BTreeMap<String, Vec<String>>,
    /// The multipliers.
    pub family: &'static TyingFamily,
    /// What is tied, one number a multiplier.
    pub tied: Vec<ScalarVariable>,
    /// Times in which the tie holds.
    pub interval: Interval,
    /// Which facets are looked at.
    pub search: SearchSettings,
    /// Steps between searches.
    pub database_step_update: usize,
    /// How overlaps are cut and integrated.
    pub segmentation: SegmentationSettings,
    /// Scale factor given by hand.
    pub manual: Option<f64>,
    /// Factor of E/h in eq. 4.11.
    pub stiffness_factor: f64,
    /// Whether normals lie in planes of symmetry, and multipliers that supports leave without equation are dropped.
    pub mind_supports: bool,
}

/// Share of the scale factor that makes redundant multipliers regular.
const RELAXATION: f64 = 1e-8;
/// Share of masters that are not fixed below which nothing is left to tie: round-off.
const LEAST_FREE: f64 = 1e-6;

/// Ties in a model part.
pub struct TyingInteraction {
    settings: TyingSettings,
    interfaces: Vec<Interface>,
    slaves: Vec<u32>,
    pairs: BTreeMap<PairKey, FacetOperators>,
    blocks: Vec<Box<dyn EntityBlock>>,
    /// Of each block, the facets of its entities.
    keys: Vec<Vec<PairKey>>,
    scale_factor: f64,
    graph: u64,
    holding: Holding,
    /// Changes with the constraints on multipliers.
    constrained: u64,
    steps_since_search: Option<usize>,
    messages: Vec<Diagnostic>,
}

/// What ties remember between steps, as it stands in a saved run.
#[derive(Serialize, Deserialize)]
struct SavedTie {
    pairs: BTreeMap<PairKey, FacetOperators>,
    /// Whether the tie holds now.
    holds: bool,
    holding: Holding,
    graph: u64,
    constrained: u64,
    steps_since_search: Option<usize>,
}

#[typetag::serde(name = "mesh_tying")]
impl State for SavedTie {
    fn carry(&mut self, carrier: &mut dyn Carrier) {
        self.holding.carry(carrier);
    }
}

impl TyingInteraction {
    /// Ties with these settings; the interfaces are built at once, so that a wrong part is named early.
    ///
    /// # Errors
    /// Parts that do not exist or hold no facets.
    pub fn new(settings: TyingSettings, part: &mut ModelPart) -> Result<Self> {
        let interfaces = interfaces(part, &settings.parts, &settings.slaves)?;
        add_contact_part(part, &interfaces);
        Ok(Self {
            messages: warnings_of_pairs(part, &settings.slaves, &interfaces),
            settings,
            slaves: slave_nodes(&interfaces),
            interfaces,
            pairs: BTreeMap::new(),
            blocks: Vec::new(),
            keys: Vec::new(),
            scale_factor: 1.0,
            graph: 1,
            holding: Holding::default(),
            constrained: 0,
            steps_since_search: None,
        })
    }

    fn search(&mut self, part: &mut ModelPart) {
        self.holding.patches(part, &self.interfaces, NodalNormals::ByFacets).write(part);
        let known = |key: &PairKey| self.pairs.contains_key(key);
        let found =
            overlapping_pairs(part, &self.interfaces, &self.settings.search, &self.settings.segmentation, &known);
        self.pairs.extend(found.into_iter().map(|pair| (pair.key, pair.operators)));
    }

    fn make_blocks(&mut self, part: &ModelPart) -> Result<()> {
        let multipliers = self.settings.family.multiplier.unknowns(part.info.domain_size);
        let pairs = self.pairs.iter().map(|(&key, &operators)| FacetPair { key, operators });
        let groups = group_by_shapes(&self.interfaces, pairs, |pair| pair.key);
        self.blocks.clear();
        self.keys.clear();
        for ((slave, master), (pairs, nodes)) in groups {
            self.keys.push(pairs.iter().map(|pair| pair.key).collect());
            let name = condition_name("MeshTyingMortarCondition", slave, master);
            let request = TyingRequest {
                entry: require_kind(Role::Condition, &name)?,
                pairs,
                nodes,
                tied: self.settings.tied.clone(),
                multipliers: multipliers.clone(),
                scale_factor: self.scale_factor,
            };
            self.blocks.push(Box::new(TyingBlock::new(slave, master, request)));
        }
        self.graph += 1;
        Ok(())
    }

    /// Outside its interval a tie carries nothing.
    fn switch_off(&mut self, part: &mut ModelPart) {
        if self.blocks.is_empty() {
            return;
        }
        self.blocks.clear();
        self.graph += 1;
        for variable in self.settings.family.multiplier.unknowns(part.info.domain_size) {
            let Some(field) = part.nodes.history.get_mut(variable.column) else { continue };
            for &node in &self.slaves {
                field.levels[0][node as usize * field.components + variable.offset()] = 0.0;
            }
        }
        self.mark(part, false);
    }

    /// Lets multipliers without equation follow those of their neighbours, or vanish on planes of symmetry.
    ///
    /// Where supports hold both sides nothing is left to tie. The dual functions of such nodes are shared out, which keeps the
    /// system symmetric.
    fn hold(&mut self, part: &mut ModelPart) {
        let unknowns = self.settings.family.multiplier.unknowns(part.info.domain_size);
        let own =
            |c: &MasterSlaveConstraint| unknowns.contains(&c.slave.1) && self.slaves.binary_search(&c.slave.0).is_ok();
        let (old, mut constraints): (Vec<_>, Vec<_>) = std::mem::take(&mut part.constraints).into_iter().partition(own);
        let facet = |interface: u32, facet: u32| &self.interfaces[interface as usize].facets[facet as usize];
        let pairs = self.pairs.keys().map(|key| (facet(key.interface, key.slave), facet(key.interface, key.master)));
        let held = if self.blocks.is_empty() { BTreeMap::new() } else { self.holding.nodes(part, pairs) };
        let mut dropped: BTreeMap<u32, Fixed> = BTreeMap::new();
        let mut new = Vec::new();
        for (&node, how) in &held {
            for (&multiplier, tied) in unknowns.iter().zip(&self.settings.tied) {
                let Some(c) = tied.component.map(usize::from).filter(|&c| how.components[c]) else { continue };
                if tied.column != DISPLACEMENT.name() {
                    continue;
                }
                let masters = if how.symmetric {
                    Vec::new()
                } else {
                    self.neighbours(node, |n| !held.get(&n).is_some_and(|other| other.components[c]))
                };
                let weight = 1.0 / masters.len().max(1) as f64;
                if masters.is_empty() && !how.symmetric && self.ties_free_masters(node, |n| self.holding.fixes(n, c)) {
                    continue;
                }
                let masters = masters.into_iter().map(|n| ((n, multiplier), weight)).collect();
                new.push(MasterSlaveConstraint::new((node, multiplier), masters));
                dropped.entry(node).or_default()[c] = true;
            }
        }
        self.constrained += u64::from(old != new);
        constraints.extend(new);
        part.constraints = constraints;
        self.messages.extend(self.holding.say(part, &dropped, false));
    }

    /// Whether the equation of a slave node ties masters that are not fixed.
    fn ties_free_masters(&self, node: u32, fixed: impl Fn(u32) -> bool) -> bool {
        let facet = |interface: u32, facet: u32| &self.interfaces[interface as usize].facets[facet as usize].nodes;
        let (mut all, mut free) = (0.0, 0.0);
        for (key, operators) in &self.pairs {
            let Some(j) = facet(key.interface, key.slave).iter().position(|&n| n == node) else { continue };
            for (&master, weight) in facet(key.interface, key.master).iter().zip(operators.m[j]) {
                all += weight.abs();
                free += if fixed(master) { 0.0 } else { weight.abs() };
            }
        }
        free > LEAST_FREE * all
    }

    /// The nearest slave nodes by facets that are wanted.
    fn neighbours(&self, node: u32, wanted: impl Fn(u32) -> bool) -> Vec<u32> {
        let mut reached = BTreeSet::from([node]);
        loop {
            let facets = self.interfaces.iter().flat_map(|i| &i.facets).filter(|f| f.role == Roles::Slave);
            let beside = facets.filter(|f| f.nodes.iter().any(|n| reached.contains(n))).flat_map(|f| f.nodes.clone());
            let more: BTreeSet<u32> = beside.collect();
            let found: Vec<u32> = more.iter().copied().filter(|&n| wanted(n)).collect();
            if !found.is_empty() || more.len() == reached.len() {
                return found;
            }
            reached = more;
        }
    }

    fn mark(&self, part: &mut ModelPart, active: bool) {
        self.slaves.iter().for_each(|&node| part.nodes.flags.set(ACTIVE, node as usize, active));
    }
}

impl Interaction for TyingInteraction {
    fn name(&self) -> &str {
        "mesh tying"
    }

    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        find_nodal_h(part);
        part.info.marks.insert(CONTACT, true);
        let estimate = alm_parameters(part, &self.interfaces, self.settings.stiffness_factor, 1.0).scale_factor;
        let chosen = self.settings.manual.unwrap_or(estimate);
        self.scale_factor = if chosen <= 0.0 { 1.0 } else { chosen };
        part.info.values.insert("SCALE_FACTOR", self.scale_factor);
        debug_assert!(self.interfaces.iter().all(|i| i.facets.iter().all(|f| f.role != Roles::Open)));
        nodal_normals(part, &self.interfaces);
        Ok(())
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        if !self.settings.interval.contains(part.info.time) {
            self.switch_off(part);
            self.hold(part);
            return Ok(());
        }
        if self.settings.mind_supports {
            self.holding.begin_step(part, &self.interfaces);
        }
        let due = self.steps_since_search.is_none_or(|steps| steps + 1 >= self.settings.database_step_update);
        let before = self.pairs.len();
        if due {
            self.search(part);
            self.steps_since_search = Some(0);
        } else {
            self.steps_since_search = self.steps_since_search.map(|steps| steps + 1);
        }
        if self.pairs.is_empty() {
            let fact = "no pair of facets overlaps: nothing is tied";
            return Err(Diagnostic::error("nothing-tied", fact)
                .remedy("check that the parts of \"mesh_tying_model_part\" meet, and which is named as slave")
                .into());
        }
        if self.blocks.is_empty() || self.pairs.len() != before {
            self.make_blocks(part)?;
            self.mark(part, true);
        }
        if self.settings.mind_supports {
            self.hold(part);
        }
        Ok(())
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(SavedTie {
            pairs: self.pairs.clone(),
            holds: !self.blocks.is_empty(),
            holding: self.holding.clone(),
            graph: self.graph,
            constrained: self.constrained,
            steps_since_search: self.steps_since_search,
        }))
    }

    fn resume(&mut self, part: &mut ModelPart, state: Box<dyn State>) -> Result<()> {
        let SavedTie { pairs, holds, holding, graph, constrained, steps_since_search } = state.take()?;
        check_pairs(&self.interfaces, pairs.keys().copied())?;
        holding.check(part.nodes.len())?;
        (self.pairs, self.holding, self.steps_since_search) = (pairs, holding, steps_since_search);
        if holds {
            self.make_blocks(part)?;
        }
        (self.graph, self.constrained) = (graph, constrained);
        Ok(())
    }

    fn constraints_version(&self) -> u64 {
        self.constrained
    }

    fn summary(&self, _part: &ModelPart) -> Vec<(&'static str, f64)> {
        vec![("tied pairs", if self.blocks.is_empty() { 0.0 } else { self.pairs.len() as f64 })]
    }

    fn pairs(&self, _part: &ModelPart) -> Vec<PairState> {
        let parts = (&self.settings.parts, &self.settings.slaves);
        let of_pair = |interface: &Interface| {
            let nodes = interface.nodes_of(Roles::Slave).len();
            let [open, sticking] = if self.blocks.is_empty() { [nodes, 0] } else { [0, nodes] };
            PairState { name: name(&interface.key, parts), open, sticking, ..PairState::default() }
        };
        self.interfaces.iter().map(of_pair).collect()
    }

    fn joins(&self, part: &ModelPart) -> Option<Vec<Join>> {
        joins(part, &self.interfaces, true, false)
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn coupling(&self) -> Option<&dyn Coupling> {
        Some(self)
    }
}

impl Coupling for TyingInteraction {
    fn unknowns(&self, part: &ModelPart) -> Vec<Carriers> {
        let unknowns = self.settings.family.multiplier.unknowns(part.info.domain_size);
        unknowns.into_iter().map(|variable| Carriers::of_nodes(variable, self.slaves.clone())).collect()
    }

    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.blocks.iter().map(AsRef::as_ref).collect()
    }

    fn pair_of(&self, block: usize, at: usize) -> Option<(usize, Range<usize>)> {
        let key = self.keys.get(block)?.get(at)?;
        Some((
            key.interface as usize,
            0..self.interfaces[key.interface as usize].facets[key.master as usize].nodes.len(),
        ))
    }

    fn graph_version(&self) -> u64 {
        self.graph
    }

    fn idle_diagonal(&self) -> f64 {
        self.scale_factor
    }

    fn relaxation(&self) -> Option<f64> {
        Some(RELAXATION * self.scale_factor)
    }
}
