//! Meshes that do not match, tied by multipliers: D and M of a pair are those of the moment it is made.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{Coupling, EntityBlock, Interaction, Join, PairState, require_kind};
use zelus_core::model::flags::ACTIVE;
use zelus_core::model::{
    DofOwners, EntityRole, MasterSlaveConstraint, ModelPart, ScalarVariable, SupportedComponent, reduce_supports,
};
use zelus_core::parameters::Interval;
use zelus_core::vector3::norm;
use zelus_core::{Result, State, StateMapper};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::tying_block::{TyingBlock, TyingRequest};
use crate::active_set::{FacetsOfPair, SupportedNodes};
use crate::flags::CONTACT;
use crate::interface::{
    FixedDirections, Interface, NodalNormals, NormalPatches, Patches, Roles, SlaveIndex, add_contact_part,
    alm_parameters, find_nodal_h, interfaces, nodal_normals, slaves_without_master, unlike_sections, warnings_of_pairs,
};
use crate::mortar::SegmentationSettings;
use crate::pairs::{
    FacetOperators, FacetPair, PairKey, TyingFormulation, check_pairs, condition_name, group_by_shapes,
    overlapping_pairs,
};
use crate::results::{InterfaceSurfaces, TiedColumns, joins, name};
use crate::search::SearchSettings;
use crate::slave_nodes::{SlaveTable, multiplier_columns, owners_name, set_name};

/// Settings of a tie.
pub struct TyingSettings {
    /// Parts of the interfaces by key.
    pub parts: BTreeMap<String, Vec<String>>,
    /// Parts on the slave side by key.
    pub slaves: BTreeMap<String, Vec<String>>,
    /// The multipliers.
    pub formulation: &'static TyingFormulation,
    /// The tied unknowns, one a multiplier.
    pub tied: Vec<ScalarVariable>,
    /// Times in which the tie holds.
    pub interval: Interval,
    /// Settings of the search for pairs.
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
    /// Angle between the normals of two slave facets, in degrees, at which their patch ends; `None` where no edge ends it.
    pub feature_angle: Option<f64>,
}

/// Share of the scale factor that makes redundant multipliers regular.
const RELAXATION: f64 = 1e-8;
/// Share of masters that are not fixed below which nothing is left to tie: round-off.
const LEAST_FREE: f64 = 1e-6;

/// Ties in a model part.
pub struct TyingInteraction {
    settings: TyingSettings,
    interfaces: Vec<Interface>,
    /// The patches of slave facets, and their slave nodes as owners of unknowns; made at the start.
    patches: Patches,
    table: SlaveTable,
    /// Normals of the slave nodes at the last search.
    normals: Vec<[f64; 3]>,
    pairs: BTreeMap<PairKey, FacetOperators>,
    blocks: Vec<Box<dyn EntityBlock>>,
    /// Facets of the entities of each block.
    keys: Vec<Vec<PairKey>>,
    scale_factor: f64,
    graph: u64,
    supported_nodes: SupportedNodes,
    /// Changes with the constraints on multipliers.
    constrained: u64,
    steps_since_search: Option<usize>,
    /// The surfaces of the interfaces in results.
    surfaces: InterfaceSurfaces,
    messages: Vec<Diagnostic>,
}

/// State of ties in a saved run.
#[derive(Serialize, Deserialize)]
struct SavedTie {
    pairs: BTreeMap<PairKey, FacetOperators>,
    /// Whether the tie holds now.
    holds: bool,
    supported_nodes: SupportedNodes,
    graph: u64,
    constrained: u64,
    steps_since_search: Option<usize>,
}

#[typetag::serde(name = "mesh_tying")]
impl State for SavedTie {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.supported_nodes.remap(mapper);
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
        let mut messages = warnings_of_pairs(part, &settings.slaves, &interfaces);
        messages.extend(unlike_sections(part, &interfaces));
        Ok(Self {
            messages,
            settings,
            patches: Patches::default(),
            table: SlaveTable::default(),
            normals: Vec::new(),
            interfaces,
            pairs: BTreeMap::new(),
            blocks: Vec::new(),
            keys: Vec::new(),
            scale_factor: 1.0,
            graph: 1,
            supported_nodes: SupportedNodes::default(),
            constrained: 0,
            steps_since_search: None,
            surfaces: InterfaceSurfaces::default(),
        })
    }

    fn search(&mut self, part: &mut ModelPart) {
        let all = NormalPatches::new(part.nodes.len(), &self.interfaces, NodalNormals::ByFacets);
        all.on_planes(self.supported_nodes.planes().clone()).write(part);
        self.normals = self.present_normals(part);
        let known = |key: &PairKey| self.pairs.contains_key(key);
        let normals = |key: PairKey, local: usize| self.normals[self.slaves_of(key)[local].place()];
        let found = overlapping_pairs(
            part,
            &self.interfaces,
            &self.settings.search,
            &self.settings.segmentation,
            &normals,
            &known,
        );
        self.pairs.extend(found.into_iter().map(|pair| (pair.key, pair.operators)));
        if self.steps_since_search.is_none() {
            self.messages.extend(self.untied(part));
        }
    }

    /// Warning of slave nodes that face no master.
    fn untied(&self, part: &ModelPart) -> Option<Diagnostic> {
        let mut tied = vec![false; self.patches.len()];
        for key in self.pairs.keys() {
            self.slaves_of(*key).iter().for_each(|slave| tied[slave.place()] = true);
        }
        let without: Vec<u32> = self
            .patches
            .all()
            .filter(|slave| !tied[slave.place()])
            .map(|slave| self.patches.mesh_node(slave))
            .collect();
        slaves_without_master(part, &without, tied.len())
    }

    /// Normals of the slave nodes in the present configuration.
    fn present_normals(&self, part: &ModelPart) -> Vec<[f64; 3]> {
        let patches = NormalPatches::of_slaves(&self.patches, &self.interfaces, NodalNormals::ByFacets);
        let patches = patches.on_planes(self.supported_nodes.planes().clone());
        let unit = |sum: [f64; 3]| {
            let size = norm(sum);
            sum.map(|x| if size > 0.0 { x / size } else { 0.0 })
        };
        self.patches.all().map(|slave| unit(patches.sum(slave.0, &part.nodes.current))).collect()
    }

    /// Slave nodes of the slave facet of a pair.
    fn slaves_of(&self, key: PairKey) -> &[SlaveIndex] {
        let facet = &self.interfaces[key.interface as usize].facets[key.slave as usize];
        self.patches.of_facet(key.interface, key.slave, facet.nodes.len())
    }

    /// Multipliers of a slave node, one an unknown.
    fn unknowns(&self, part: &ModelPart) -> Vec<ScalarVariable> {
        self.settings.formulation.multiplier.unknowns(part.info.domain_size)
    }

    fn make_blocks(&mut self, part: &ModelPart) -> Result<()> {
        let multipliers = self.settings.formulation.multiplier.unknowns(part.info.domain_size);
        let pairs = self.pairs.iter().map(|(&key, &operators)| FacetPair { key, operators });
        let groups = group_by_shapes(&self.interfaces, pairs, false, |pair| pair.key);
        self.blocks.clear();
        self.keys.clear();
        for ((slave, master, _), (pairs, nodes)) in groups {
            self.keys.push(pairs.iter().map(|pair| pair.key).collect());
            let slaves = pairs.iter().flat_map(|pair| self.slaves_of(pair.key));
            let owners = slaves.map(|slave| self.table.owners[slave.place()]).collect();
            let name = condition_name("MeshTyingMortarCondition", slave, master);
            let request = TyingRequest {
                entry: require_kind(EntityRole::Condition, &name)?,
                pairs,
                nodes,
                owners,
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
        for &owner in &self.table.owners {
            self.settings.formulation.multiplier.set(&mut part.slave_nodes, owner, [0.0; 3]);
        }
        self.mark(part, false);
    }

    /// Lets multipliers without equation follow those of their neighbours, or vanish on planes of symmetry.
    ///
    /// Where supports hold both sides nothing is left to tie. The dual functions of such nodes are shared out, which keeps the
    /// system symmetric.
    fn hold(&mut self, part: &mut ModelPart) {
        let (unknowns, name) = (self.unknowns(part), self.owners_name());
        let own = |c: &MasterSlaveConstraint| c.set.as_ref().is_some_and(|set| set.starts_with(&name));
        let (old, mut constraints): (Vec<_>, Vec<_>) = std::mem::take(&mut part.constraints).into_iter().partition(own);
        let facet = |interface: u32, facet: u32| &self.interfaces[interface as usize].facets[facet as usize];
        let pairs = self.pairs.keys().map(|key| FacetsOfPair {
            slave: facet(key.interface, key.slave),
            slaves: self.slaves_of(*key),
            master: facet(key.interface, key.master),
        });
        let normal = |slave: SlaveIndex| self.normals.get(slave.place()).copied().unwrap_or([0.0; 3]);
        let supported =
            if self.blocks.is_empty() { BTreeMap::new() } else { self.supported_nodes.nodes(part, &normal, pairs) };
        let mut dropped: BTreeMap<u32, FixedDirections> = BTreeMap::new();
        let mut new = Vec::new();
        for (&slave, how) in &supported {
            let node = self.patches.mesh_node(slave);
            let multipliers: [Option<ScalarVariable>; 3] = std::array::from_fn(|c| {
                let tied = unknowns.iter().zip(&self.settings.tied);
                let is_own = |tied: &ScalarVariable| {
                    tied.column == DISPLACEMENT.name() && tied.component.map(usize::from) == Some(c)
                };
                tied.filter(|(_, tied)| is_own(tied)).map(|(&multiplier, _)| multiplier).next()
            });
            // Axes of the multipliers' components without an equation, with the neighbours that they follow.
            let mut along = Vec::new();
            for c in (0..3).filter(|&c| how.components[c]) {
                let axis = how.axes.0[c];
                if (0..3).any(|d| axis[d] != 0.0 && multipliers[d].is_none()) {
                    continue;
                }
                let free = |n| !supported.get(&n).is_some_and(|other| other.fixes(how.axes, c));
                let masters = if how.symmetric { Vec::new() } else { self.neighbours(slave, free) };
                if masters.is_empty()
                    && !how.symmetric
                    && self.ties_free_masters(slave, |n| self.supported_nodes.fixes(n, axis))
                {
                    continue;
                }
                along.push((axis, masters));
                let own = FixedDirections { axes: how.axes, ..FixedDirections::default() };
                dropped.entry(node).or_insert(own).fixed[c] = true;
            }
            let set = Some(set_name(&name, self.patches.patch(slave)));
            let of = |n: SlaveIndex| self.patches.mesh_node(n);
            let followed = following(node, &along, &multipliers, part.info.domain_size, of);
            new.extend(followed.into_iter().map(|own| MasterSlaveConstraint { set: set.clone(), ..own }));
        }
        self.constrained += u64::from(old != new);
        constraints.extend(new);
        part.constraints = constraints;
        self.messages.extend(self.supported_nodes.say(part, &dropped, false));
    }

    /// Name of the sets of its slave nodes: that of the parts of its pairs.
    fn owners_name(&self) -> String {
        owners_name("tie", &self.settings.slaves, &self.settings.parts)
    }

    /// Whether the equation of a slave node ties masters that are not fixed.
    fn ties_free_masters(&self, slave: SlaveIndex, fixed: impl Fn(u32) -> bool) -> bool {
        let facet = |interface: u32, facet: u32| &self.interfaces[interface as usize].facets[facet as usize].nodes;
        let (mut all, mut free) = (0.0, 0.0);
        for (key, operators) in &self.pairs {
            let Some(j) = self.slaves_of(*key).iter().position(|&own| own == slave) else { continue };
            for (&master, weight) in facet(key.interface, key.master).iter().zip(operators.m[j]) {
                all += weight.abs();
                free += if fixed(master) { 0.0 } else { weight.abs() };
            }
        }
        free > LEAST_FREE * all
    }

    /// The nearest slave nodes of the same patch, by facets, that are wanted.
    fn neighbours(&self, slave: SlaveIndex, wanted: impl Fn(SlaveIndex) -> bool) -> Vec<SlaveIndex> {
        let facets = || {
            self.interfaces.iter().enumerate().flat_map(|(i, interface)| {
                let own = interface.facets.iter().enumerate();
                own.map(move |(f, facet)| self.patches.of_facet(i as u32, f as u32, facet.nodes.len()))
            })
        };
        let mut reached = BTreeSet::from([slave]);
        loop {
            let beside = facets().filter(|own| own.iter().any(|n| reached.contains(n))).flatten();
            let more: BTreeSet<SlaveIndex> = beside.copied().collect();
            let found: Vec<SlaveIndex> = more.iter().copied().filter(|&n| wanted(n)).collect();
            if !found.is_empty() || more.len() == reached.len() {
                return found;
            }
            reached = more;
        }
    }

    /// Areas of the slave nodes over the pairs that are tied now: sums of the rows of D.
    fn areas(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.patches.len()];
        for (key, operators) in self.pairs.iter().filter(|_| !self.blocks.is_empty()) {
            let rows = self.slaves_of(*key).iter().zip(&operators.d);
            rows.for_each(|(slave, row)| areas[slave.place()] += row.iter().sum::<f64>());
        }
        areas
    }

    /// Brings the columns of the surfaces of interfaces up to date.
    fn write_surfaces(&self, part: &mut ModelPart) {
        let columns = TiedColumns {
            multiplier: self.settings.formulation.multiplier,
            owners: &self.table.owners,
            normals: &self.present_normals(part),
            areas: &self.areas(),
            holds: !self.blocks.is_empty(),
        };
        self.surfaces.write_ties(part, &columns);
    }

    fn mark(&self, part: &mut ModelPart, active: bool) {
        self.table.nodes.iter().for_each(|&node| part.nodes.flags.set(ACTIVE, node as usize, active));
    }
}

impl Interaction for TyingInteraction {
    fn name(&self) -> &str {
        "mesh tying"
    }

    fn drives(&self) -> bool {
        false
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
        self.patches = Patches::new(part, &self.interfaces, self.settings.feature_angle);
        self.table =
            SlaveTable::of_patches(part, &self.patches, &self.owners_name(), self.settings.formulation.multiplier);
        if let Some((name, components)) = self.settings.formulation.multiplier.column() {
            part.slave_nodes.history.add_named(name, components);
        }
        self.normals = self.present_normals(part);
        let parts = (&self.settings.parts, &self.settings.slaves);
        self.surfaces = InterfaceSurfaces::add(part, "tie", &self.interfaces, &self.patches, parts);
        self.write_surfaces(part);
        Ok(())
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        if !self.settings.interval.contains(part.info.time) {
            self.switch_off(part);
            self.hold(part);
            return Ok(());
        }
        if self.settings.mind_supports {
            self.supported_nodes.begin_step(part, &self.interfaces);
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

    fn finalize_step(&mut self, part: &mut ModelPart) -> Result<()> {
        multiplier_columns::export(part, &self.table, &|_| 0.0, self.settings.formulation.multiplier);
        self.write_surfaces(part);
        Ok(())
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(SavedTie {
            pairs: self.pairs.clone(),
            holds: !self.blocks.is_empty(),
            supported_nodes: self.supported_nodes.clone(),
            graph: self.graph,
            constrained: self.constrained,
            steps_since_search: self.steps_since_search,
        }))
    }

    fn resume(&mut self, part: &mut ModelPart, state: Box<dyn State>) -> Result<()> {
        let SavedTie { pairs, holds, supported_nodes, graph, constrained, steps_since_search } = state.take()?;
        check_pairs(&self.interfaces, pairs.keys().copied())?;
        supported_nodes.check(part.nodes.len())?;
        (self.pairs, self.supported_nodes, self.steps_since_search) = (pairs, supported_nodes, steps_since_search);
        if holds {
            self.make_blocks(part)?;
        }
        (self.graph, self.constrained) = (graph, constrained);
        self.write_surfaces(part);
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
    fn unknowns(&self, part: &ModelPart) -> Vec<DofOwners> {
        let unknowns = self.settings.formulation.multiplier.unknowns(part.info.domain_size);
        let owners = &self.table.owners;
        unknowns.into_iter().map(|variable| DofOwners::of_slaves(variable, owners.iter().copied())).collect()
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

    fn inactive_diagonal(&self) -> f64 {
        self.scale_factor
    }

    fn relaxation(&self) -> Option<f64> {
        Some(RELAXATION * self.scale_factor)
    }
}

/// Constraints by which components of a node's multiplier along axes are the means of those of other nodes; zero without any.
fn following(
    node: u32,
    along: &[([f64; 3], Vec<SlaveIndex>)],
    multipliers: &[Option<ScalarVariable>; 3],
    dimension: usize,
    of: impl Fn(SlaveIndex) -> u32,
) -> Vec<MasterSlaveConstraint> {
    // Solved with the mean of each axis as the only value.
    let solved: Vec<_> = (0..along.len())
        .filter_map(|only| {
            let rows = along.iter().enumerate().map(|(at, (axis, _))| (*axis, Some(f64::from(u8::from(at == only)))));
            let rows: Vec<_> = rows.collect();
            reduce_supports(&rows, [SupportedComponent::Free; 3], dimension).ok()
        })
        .collect();
    let Some(first) = solved.first() else { return Vec::new() };
    let mut out = Vec::new();
    for (at, form) in first.iter().enumerate() {
        let Some((slave, Some(own))) = form.as_ref().map(|form| (form, multipliers[form.0])) else {
            continue;
        };
        let mut masters: Vec<_> =
            slave.1.iter().filter_map(|&(m, weight)| Some(((node, multipliers[m]?), weight))).collect();
        for ((axis, neighbours), solved) in along.iter().zip(&solved) {
            let factor = solved[at].as_ref().map_or(0.0, |(_, _, constant)| *constant) / neighbours.len().max(1) as f64;
            for &neighbour in neighbours.iter().filter(|_| factor != 0.0) {
                let parts = (0..3).filter(|&d| axis[d] != 0.0);
                masters.extend(parts.filter_map(|d| Some(((of(neighbour), multipliers[d]?), factor * axis[d]))));
            }
        }
        out.push(MasterSlaveConstraint::new((node, own), masters));
    }
    out
}
