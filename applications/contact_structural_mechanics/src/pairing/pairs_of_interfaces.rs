//! The pairs of all interfaces of a deck: found by the search, kept in blocks of like shapes, integrated together.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, unfit};
use zelus_core::entities::{EntityBlock, require_kind};
use zelus_core::model::{EntityRole, ModelPart, bodies_of_nodes};
use zelus_core::parallel;
use zelus_core::vector3::dot;

use crate::interface::{
    Bodies, Facet, FixedDirections, Interface, NodalNormals, NormalPatches, Patches, Roles, SlaveIndex, set_sides,
    sides,
};
use crate::law::{Multiplier, NormalVariation, StepParameters};
use crate::mortar::{Choices, MOST_NODES, SegmentationSettings};
use crate::pairs::{
    ContactBlock, Integral, IntegrationState, PAIRS, Pair, PairKey, PairRequest, check_pairs, condition_name,
    group_by_shapes, group_by_surroundings,
};
use crate::search::{
    Candidate, FACING, GapCheck, candidates, predicted_positions, touching_nodes, warn_of_search_radius,
};
use crate::settings::{ContactSettings, Setup};
use crate::slave_nodes::{SlaveStates, SlaveSums, SlaveTable};

/// Pairs of facets and the blocks that evaluate them.
pub(crate) struct Pairing {
    /// The interfaces the facets belong to.
    pub interfaces: Vec<Interface>,
    /// The elements behind slaves, where the formulation takes tractions from them.
    pub bodies: Arc<Bodies>,
    /// The patches of slave facets.
    pub patches: Patches,
    /// Owners of the unknowns of slave nodes; none before they are made.
    owners: Vec<u32>,
    /// The facets that make the normals of slave nodes.
    pub normals: Arc<NormalPatches>,
    /// The pairs, by shape of slave and master and by the number of nodes around them.
    pub blocks: Vec<Box<dyn ContactBlock>>,
    /// Slave nodes that the direct check found on a master.
    pub touching: BTreeSet<SlaveIndex>,
    /// Number of the present set of pairs.
    pub graph: u64,
    /// The states that blocks evaluate with.
    states: Arc<SlaveStates>,
    /// Pairs that another rank evaluates than the owner of their slave.
    pub moved: usize,
    saved: Vec<Pair>,
    warned_of_reach: bool,
}

/// The part of the pairs that lasts between steps.
#[derive(Serialize, Deserialize)]
pub(crate) struct PairingState {
    sides: Vec<Vec<Roles>>,
    pairs: Vec<Pair>,
    touching: BTreeSet<SlaveIndex>,
    graph: u64,
    warned_of_reach: bool,
}

/// Overlap of the facets of a pair.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairOverlap {
    /// They share an area that is integrated.
    pub overlapping: bool,
    /// They share an area, be it a sliver.
    pub facing: bool,
}

impl Pairing {
    /// No pairs yet between the facets of these interfaces.
    pub(crate) fn new(interfaces: Vec<Interface>, normals: NodalNormals) -> Self {
        Self {
            normals: Arc::new(NormalPatches::new(0, &[], normals)),
            patches: Patches::default(),
            owners: Vec::new(),
            interfaces,
            bodies: Arc::default(),
            blocks: Vec::new(),
            touching: BTreeSet::new(),
            graph: 1,
            states: Arc::default(),
            moved: 0,
            saved: Vec::new(),
            warned_of_reach: false,
        }
    }

    /// Makes the patches, and their slave nodes owners of unknowns in a model part; names of their sets begin with `name`.
    ///
    /// `angle` is the feature angle at which patches end; see [`Patches::new`].
    pub(crate) fn make_patches(
        &mut self,
        part: &mut ModelPart,
        angle: Option<f64>,
        name: &str,
        multiplier: Multiplier,
    ) -> SlaveTable {
        self.patches = Patches::new(part, &self.interfaces, angle);
        self.normals = Arc::new(NormalPatches::of_slaves(&self.patches, &self.interfaces, self.normals.weights()));
        let table = SlaveTable::of_patches(part, &self.patches, name, multiplier);
        self.owners.clone_from(&table.owners);
        table
    }

    /// Finds the facets around slave nodes anew, after the sides of facets or supports have changed; `planes` are the directions
    /// that the normals of nodes on planes of symmetry lack.
    pub(crate) fn find_normal_patches(&mut self, planes: &BTreeMap<u32, FixedDirections>) {
        let normals = NormalPatches::of_slaves(&self.patches, &self.interfaces, self.normals.weights());
        let normals = normals.on_planes(planes.clone());
        if normals != *self.normals {
            self.normals = Arc::new(normals);
            self.graph += 1;
        }
    }

    /// Nodes of all interfaces, ascending.
    pub(crate) fn nodes(&self) -> Vec<u32> {
        self.ascending(|interface| interface.nodes.clone())
    }

    /// Nodes of the master facets that overlap a slave facet with one of these mesh nodes.
    pub(crate) fn masters_of(&self, slaves: &BTreeSet<u32>) -> BTreeSet<u32> {
        let pairs = self.blocks.iter().flat_map(|block| block.pairs()).filter(|pair| pair.overlapping);
        let of_them = pairs.filter(|pair| self.slave(pair.key).nodes.iter().any(|node| slaves.contains(node)));
        of_them.flat_map(|pair| self.master(pair.key).nodes_with_apex()).collect()
    }

    /// Slave nodes of slave facets, ascending.
    pub(crate) fn slaves(&self) -> Vec<SlaveIndex> {
        self.patches.slaves(&self.interfaces)
    }

    /// Slave nodes of the slave facets of an interface, ascending.
    pub(crate) fn slaves_of(&self, interface: usize) -> Vec<SlaveIndex> {
        self.patches.slaves_of(&self.interfaces, interface)
    }

    /// Slave nodes of the slave facets of each interface.
    pub(crate) fn slaves_by_interface(&self) -> Vec<Vec<SlaveIndex>> {
        (0..self.interfaces.len()).map(|at| self.slaves_of(at)).collect()
    }

    /// For each slave node, by place, whether its body is in contact with a body that it faces. Collective.
    pub(crate) fn of_bodies_in_contact(&self, part: &ModelPart, states: &SlaveStates) -> Vec<bool> {
        let (bodies, keys) = (bodies_of_nodes(part), self.keys());
        let of_pair = |key: PairKey| {
            let mut both = [self.slave(key), self.master(key)].map(|facet| bodies[facet.nodes[0] as usize]);
            both.sort_unstable();
            both
        };
        let touches = |key: PairKey| self.slaves_of_pair(key).iter().any(|&slave| states[slave].law.active);
        let touching: BTreeSet<_> = keys.iter().filter(|&&key| touches(key)).map(|&key| of_pair(key)).collect();
        let mut found = vec![false; self.patches.len()];
        for &key in keys.iter().filter(|&&key| touching.contains(&of_pair(key))) {
            self.slaves_of_pair(key).iter().for_each(|slave| found[slave.place()] = true);
        }
        found
    }

    /// Slave nodes of the slave facet of a pair.
    pub(crate) fn slaves_of_pair(&self, key: PairKey) -> &[SlaveIndex] {
        self.patches.of_facet(key.interface, key.slave, self.slave(key).nodes.len())
    }

    fn ascending(&self, of: impl Fn(&Interface) -> Vec<u32>) -> Vec<u32> {
        let mut nodes: Vec<u32> = self.interfaces.iter().flat_map(of).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Number of pairs.
    pub(crate) fn len(&self) -> usize {
        self.blocks.iter().map(|block| block.pairs().len()).sum()
    }

    fn pairs(&self) -> Vec<Pair> {
        self.blocks.iter().flat_map(|block| block.pairs().iter().cloned()).collect()
    }

    pub(crate) fn keys(&self) -> Vec<PairKey> {
        self.blocks.iter().flat_map(|block| block.pairs().iter().map(|pair| pair.key)).collect()
    }

    /// The interface of a pair of a block, and which of the block's nodes are its masters.
    pub(crate) fn pair_of(&self, block: usize, at: usize) -> Option<(usize, Range<usize>)> {
        let block = self.blocks.get(block)?;
        let key = block.pairs().get(at)?.key;
        let slaves = block.nodes(at).len() - block.slaves(at).len();
        Some((key.interface as usize, slaves - self.master(key).nodes_with_apex().count()..slaves))
    }

    fn facet(&self, interface: u32, facet: u32) -> &Facet {
        &self.interfaces[interface as usize].facets[facet as usize]
    }

    pub(crate) fn slave(&self, key: PairKey) -> &Facet {
        self.facet(key.interface, key.slave)
    }

    pub(crate) fn master(&self, key: PairKey) -> &Facet {
        self.facet(key.interface, key.master)
    }

    /// Candidates of this configuration together with the pairs that are there already; those without overlap go.
    ///
    /// Lines behind each other by more than the limit of the setup are not taken for a pair: they may be the far sides of a thin body.
    /// Existing pairs stay so until the next search, however deep an iterate presses them in. Surfaces must not be farther apart than
    /// that.
    ///
    /// # Errors
    /// A condition for these shapes that is not registered.
    pub(crate) fn search(
        &mut self,
        part: &mut ModelPart,
        states: &SlaveStates,
        setup: &Setup,
    ) -> Result<Option<Diagnostic>> {
        let Setup { settings, parameters, .. } = setup;
        let still = predicted_positions(part, settings.search.dynamic);
        let sides = |key: PairKey| (self.slave(key).role, self.master(key).role);
        let of_these_sides = |pair: &Pair| sides(pair.key) == (Roles::Slave, Roles::Master);
        let edges = settings.solver.feature_angle.is_some();
        let known = self.pairs().into_iter().filter(of_these_sides).filter(|pair| !edges || self.meet(part, pair.key));
        let mut known: BTreeMap<PairKey, Pair> = known.map(|pair| (pair.key, pair)).collect();
        let (mut beyond, mut touching) = (BTreeSet::new(), BTreeSet::new());
        for (key, within_reach) in self.candidates(part, settings) {
            if settings.search.check == GapCheck::DirectCheck {
                let nodes = touching_nodes(part, self.slave(key), self.master(key), settings.active_check_factor);
                if !within_reach || (nodes.is_empty() && !known.contains_key(&key)) {
                    continue;
                }
                let own = self.slave(key).nodes.iter().zip(self.slaves_of_pair(key));
                touching.extend(own.filter(|(node, _)| nodes.contains(node)).map(|(_, slave)| *slave));
            } else if !within_reach && !known.contains_key(&key) {
                beyond.insert(key);
            }
            if let Entry::Vacant(place) = known.entry(key) {
                place.insert(self.pair(part, key));
            }
        }
        if let Some(still) = still {
            part.nodes.current = still;
        }
        let before = self.keys();
        self.set(known.into_values().collect(), settings, &searching(parameters, setup.limit()))?;
        let found: Vec<(Pair, PairOverlap)> = self.pairs().into_iter().zip(self.integrals(part, states).1).collect();
        let lost = found.iter().filter(|(pair, i)| i.overlapping && beyond.contains(&pair.key)).count();
        let warns = lost > 0 && !std::mem::replace(&mut self.warned_of_reach, true);
        // Slivers too: within the step they may grow to overlaps.
        let kept = found.into_iter().filter(|(pair, i)| i.facing && !beyond.contains(&pair.key));
        self.set(kept.map(|(pair, _)| pair).collect(), settings, parameters)?;
        if before != self.keys() {
            self.graph += 1;
        }
        self.share_out(part);
        self.touching = touching;
        Ok(warns.then(|| warn_of_search_radius(lost)))
    }

    /// On several ranks: lets ranks with few pairs evaluate some of those with many.
    fn share_out(&mut self, part: &mut ModelPart) {
        let Some(mut share) = part.share.take() else { return };
        let before = share.pairs.clone();
        let blocks = self.as_entities();
        let last = blocks.iter().flat_map(|block| (0..block.len()).filter_map(|at| block.nodes(at).last().copied()));
        self.moved = share.balance_pairs(last);
        if before != share.pairs {
            self.graph += 1;
        }
        part.share = Some(share);
    }

    /// Pairs that are near each other, and whether their centres are within the search radius.
    pub(crate) fn candidates(&self, part: &ModelPart, settings: &ContactSettings) -> Vec<(PairKey, bool)> {
        let of_interface = |(at, interface): (usize, &Interface)| {
            let found = candidates(part, interface, &settings.search).into_iter();
            found.map(move |Candidate { slave, master, within_reach }| {
                (PairKey { interface: at as u32, slave, master }, within_reach)
            })
        };
        let all: Vec<(PairKey, bool)> = self.interfaces.iter().enumerate().flat_map(of_interface).collect();
        if settings.solver.feature_angle.is_none() {
            return all;
        }
        let meeting = parallel::select(all.len(), PAIRS, |at| self.meet(part, all[at].0));
        meeting.into_iter().map(|at| all[at as usize]).collect()
    }

    /// Whether the facets face each other. A facet across an edge of the slave is at right angles to the master: its overlap is
    /// that of a projection, not of a surface.
    fn meet(&self, part: &ModelPart, key: PairKey) -> bool {
        dot(self.slave(key).normal(part), self.master(key).normal(part)) < -FACING
    }

    pub(crate) fn pair(&self, part: &ModelPart, key: PairKey) -> Pair {
        Pair::new(key, [self.slave(key), self.master(key)].map(|facet| facet.normal(part)))
    }

    fn set(&mut self, pairs: Vec<Pair>, settings: &ContactSettings, parameters: &Arc<StepParameters>) -> Result<()> {
        self.blocks.clear();
        self.blocks = self.blocks_of(pairs, settings, parameters)?;
        Ok(())
    }

    pub(crate) fn blocks_of(
        &self,
        pairs: Vec<Pair>,
        settings: &ContactSettings,
        parameters: &Arc<StepParameters>,
    ) -> Result<Vec<Box<dyn ContactBlock>>> {
        let stem = settings.condition_stem();
        let groups = group_by_shapes(&self.interfaces, pairs, true, |pair| pair.key);
        let mut blocks = Vec::new();
        for ((slave, master, _), (pairs, nodes)) in groups {
            let name = condition_name(&stem, slave, master);
            let entry = require_kind(EntityRole::Condition, &name)?;
            let exact = parameters.normal_variation == NormalVariation::Exact;
            let around = |pair: &Pair| {
                let mut around = self.bodies.nodes([pair.key.interface, pair.key.slave]).to_vec();
                if exact {
                    let slaves = self.slaves_of_pair(pair.key).iter();
                    around.extend(slaves.flat_map(|slave| self.normals.neighbours(slave.0)));
                }
                around
            };
            for (around, (pairs, nodes)) in group_by_surroundings(&around, pairs, &nodes) {
                let (bodies, patches, parameters) = (self.bodies.clone(), self.normals.clone(), parameters.clone());
                let slaves: Vec<SlaveIndex> =
                    pairs.iter().flat_map(|pair| self.slaves_of_pair(pair.key)).copied().collect();
                let has_owners = settings.formulation.multiplier.is_unknown();
                let owners = slaves.iter().filter(|_| has_owners).map(|slave| self.owners[slave.place()]).collect();
                let states = self.states.clone();
                let exact = pairs.iter().filter_map(|pair| self.master(pair.key).exact.clone()).collect();
                blocks.push((settings.formulation.block)(PairRequest {
                    entry,
                    slave,
                    master,
                    exact,
                    pairs,
                    nodes,
                    slaves,
                    owners,
                    around,
                    bodies,
                    patches,
                    parameters,
                    states,
                }));
            }
        }
        Ok(blocks)
    }

    /// Takes all pairs away.
    pub(crate) fn clear(&mut self) {
        if !self.blocks.is_empty() {
            self.blocks.clear();
            self.graph += 1;
        }
    }

    /// The integrals of the pairs of this rank, and of all pairs how they meet.
    pub(crate) fn integrals(
        &mut self,
        part: &ModelPart,
        states: &SlaveStates,
    ) -> (Vec<Vec<Integral>>, Vec<PairOverlap>) {
        let integrals = integrals(&mut self.blocks, part, states);
        let mut flags: Vec<bool> = integrals.iter().flatten().flat_map(|i| [i.overlapping, i.facing]).collect();
        if part.share.is_some() {
            part.ranks.any_of(&mut flags);
        }
        let overlaps =
            flags.chunks_exact(2).map(|pair| PairOverlap { overlapping: pair[0], facing: pair[1] }).collect();
        (integrals, overlaps)
    }

    /// Result of the last integration of each pair: whether it overlaps, and the areas at its nodes.
    pub(crate) fn overlaps(&self) -> Vec<(bool, [f64; MOST_NODES])> {
        self.blocks.iter().flat_map(|block| block.pairs()).map(|pair| (pair.overlapping, pair.area)).collect()
    }

    /// Restores the overlaps of an earlier integration.
    pub(crate) fn set_overlaps(&mut self, overlaps: &[(bool, [f64; MOST_NODES])]) {
        let pairs = self.blocks.iter_mut().flat_map(|block| block.pairs_mut());
        pairs.zip(overlaps).for_each(|(pair, of_pair)| (pair.overlapping, pair.area) = *of_pair);
    }

    /// Takes the normals of masters, and of `slaves` too, from the present configuration.
    pub(crate) fn refresh_normals(&mut self, part: &ModelPart, slaves: bool) {
        let mut blocks = std::mem::take(&mut self.blocks);
        for pair in blocks.iter_mut().flat_map(|block| block.pairs_mut()) {
            pair.master_normal = self.master(pair.key).normal(part);
            if slaves {
                pair.slave_normal = self.slave(pair.key).normal(part);
            }
        }
        self.blocks = blocks;
    }

    /// Step start: keeps the operators against which slip is measured, and forgets the choices of the last step. Slivers count where
    /// `slivers` holds and the nodes of their slave have other overlaps; a node that only slivers reach is at the master's edge.
    pub(crate) fn begin_step(&mut self, part: &ModelPart, states: &SlaveStates, slivers: bool) {
        self.blocks.iter_mut().flat_map(|block| block.pairs_mut()).for_each(|pair| pair.choices = Choices::default());
        if slivers {
            let mut area = SlaveSums::<f64>::new(states);
            let (integrals, _) = self.integrals(part, states);
            for (block, integrals) in self.blocks.iter().zip(&integrals) {
                for (at, integral) in integrals.iter().enumerate() {
                    for (local, &slave) in block.slaves(at).iter().enumerate() {
                        area[slave] += integral.area[local];
                    }
                }
            }
            area.over_ranks(part, states);
            for block in &mut self.blocks {
                let covered = |at: usize| block.slaves(at).iter().all(|&slave| area[slave] > 0.0);
                let covered: Vec<bool> = (0..block.len()).map(covered).collect();
                block.pairs_mut().iter_mut().zip(covered).for_each(|(pair, covered)| pair.choices.slivers = covered);
            }
        }
        let own = |nodes: &[u32]| part.evaluates_pair(nodes);
        let present = IntegrationState { view: &part.view(), states, own: &own };
        self.blocks.iter_mut().for_each(|block| block.keep_operators(present));
    }

    /// Freezes the choices of the integration of all pairs until the step ends.
    pub(crate) fn freeze_choices(&mut self, part: &ModelPart, states: &SlaveStates) {
        let own = |nodes: &[u32]| part.evaluates_pair(nodes);
        let present = IntegrationState { view: &part.view(), states, own: &own };
        self.blocks.iter_mut().for_each(|block| block.freeze_choices(present));
    }

    /// Gives blocks the states with which the assembly evaluates them.
    pub(crate) fn set_states(&mut self, states: &SlaveStates) {
        self.states = Arc::new(states.clone());
        self.blocks.iter_mut().for_each(|block| block.set_states(self.states.clone()));
    }

    /// Takes more pairs in, within a step.
    ///
    /// # Errors
    /// Errors of making blocks.
    pub(crate) fn add(&mut self, pairs: Vec<Pair>, setup: &Setup) -> Result<()> {
        let all = self.pairs().into_iter().chain(pairs).collect();
        self.graph += 1;
        self.set(all, &setup.settings, &setup.parameters)
    }

    /// Keeps the pairs of an accepted state.
    pub(crate) fn save(&mut self) {
        self.saved = self.pairs();
    }

    /// Goes back to the pairs kept last.
    pub(crate) fn restore(&mut self, setup: &Setup) {
        let saved = std::mem::take(&mut self.saved);
        // The same shapes were made into blocks before.
        let _ = self.set(saved, &setup.settings, &setup.parameters);
        self.graph += 1;
    }

    /// The part that lasts between steps.
    pub(crate) fn state(&self) -> PairingState {
        PairingState {
            sides: sides(&self.interfaces),
            pairs: self.pairs(),
            touching: self.touching.clone(),
            graph: self.graph,
            warned_of_reach: self.warned_of_reach,
        }
    }

    /// Restores its state of the same interfaces; `planes` are those of [`Pairing::find_normal_patches`].
    ///
    /// # Errors
    /// Errors of making blocks.
    pub(crate) fn resume(
        &mut self,
        planes: &BTreeMap<u32, FixedDirections>,
        setup: &Setup,
        state: PairingState,
    ) -> Result<()> {
        set_sides(&mut self.interfaces, state.sides)?;
        check_pairs(&self.interfaces, state.pairs.iter().map(|pair| pair.key))?;
        if state.touching.last().is_some_and(|last| last.place() >= self.patches.len()) {
            return Err(unfit("contact remembers nodes that touch and are no slaves"));
        }
        self.find_normal_patches(planes);
        self.set(state.pairs, &setup.settings, &setup.parameters)?;
        (self.touching, self.graph, self.warned_of_reach) = (state.touching, state.graph, state.warned_of_reach);
        Ok(())
    }

    /// The blocks as the assembly sees them.
    pub(crate) fn as_entities(&self) -> Vec<&dyn EntityBlock> {
        self.blocks.iter().map(|block| block.as_entities()).collect()
    }
}

/// The parameters of blocks that give no tangent: no nodes around their pairs are looked for.
pub(crate) fn without_tangent(parameters: &StepParameters) -> StepParameters {
    StepParameters { normal_variation: NormalVariation::Update, ..parameters.clone() }
}

/// The parameters of a search that limits distances.
pub(crate) fn searching(parameters: &StepParameters, limit: f64) -> Arc<StepParameters> {
    let segmentation = SegmentationSettings { distance_threshold: limit, ..parameters.segmentation };
    Arc::new(StepParameters { segmentation, ..without_tangent(parameters) })
}

/// The integrals of the pairs of this rank.
pub(crate) fn integrals(
    blocks: &mut [Box<dyn ContactBlock>],
    part: &ModelPart,
    states: &SlaveStates,
) -> Vec<Vec<Integral>> {
    let own = |nodes: &[u32]| part.evaluates_pair(nodes);
    let present = IntegrationState { view: &part.view(), states, own: &own };
    let integrals = blocks.iter_mut().map(|block| {
        block.find_operators(present);
        block.integrate(present)
    });
    integrals.collect()
}
