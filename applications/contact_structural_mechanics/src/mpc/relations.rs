//! The relations of all pairs of contact by constraints: made by the search, renewed as nodes move.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use zelus_core::Result;
use zelus_core::StateMapper;
use zelus_core::diagnostics::{Diagnostic, unfit};
use zelus_core::model::ModelPart;
use zelus_core::vector3::{dot, norm, sub};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::mpc_edges::MpcEdges;
use super::mpc_settings::MpcSettings;
use super::node_relation::{NodeRelation, PairRelation, node_relations};
use crate::interface::{Facet, Interface, check_nodes};
use crate::mortar::{IntegrationOrder, SegmentationSettings};
use crate::pairs::{FacetPair, PairKey, check_pairs, facet_operators, nodal_normals, overlapping_pairs};
use crate::slave_nodes::SlaveStates;
use crate::variables::NODAL_H;

/// Gauss rule that tells the functions of every facet apart, so that dual ones exist wherever there is area.
const FINE: usize = 4;

/// Relations by pair and by slave node.
#[derive(Clone, Default, Serialize, Deserialize)]
pub(crate) struct Relations {
    /// By pair.
    pub pairs: BTreeMap<PairKey, PairRelation>,
    /// Relations of slave nodes, over their pairs.
    pub nodes: BTreeMap<u32, NodeRelation>,
    /// Where the nodes of the interfaces were when relations were made.
    places: Vec<[f64; 3]>,
    /// Edges of the slave surfaces.
    #[serde(skip)]
    edges: MpcEdges,
    #[serde(skip)]
    saved: BTreeMap<PairKey, PairRelation>,
    warned: bool,
}

/// The facets of a pair, slave and master.
fn facets(interfaces: &[Interface], key: PairKey) -> (&Facet, &Facet) {
    let facets = &interfaces[key.interface as usize].facets;
    (&facets[key.slave as usize], &facets[key.master as usize])
}

/// Normals at the nodes of slave facets, from the column of the mesh nodes.
fn of_nodes<'a>(
    part: &'a ModelPart,
    interfaces: &'a [Interface],
) -> impl Fn(PairKey, usize) -> [f64; 3] + Sync + use<'a> {
    |key, local| nodal_normals(part, facets(interfaces, key).0)(local)
}

impl Relations {
    /// Finds the edges of slave surfaces, where contact looks at them.
    pub(crate) fn find_edges(&mut self, part: &ModelPart, interfaces: &[Interface], settings: &MpcSettings) {
        if !settings.ties() {
            self.edges = MpcEdges::new(part, interfaces, settings.solver.feature_angle);
        }
    }

    /// Whether they can be those of as many nodes, among them these slaves.
    ///
    /// # Errors
    /// Others.
    pub(crate) fn check(&self, interfaces: &[Interface], nodes: usize, states: &SlaveStates) -> Result<()> {
        check_pairs(interfaces, self.pairs.keys().copied())?;
        let of_pairs = self.pairs.values().flat_map(PairRelation::all_nodes);
        let of_nodes = self.nodes.values().flat_map(|relation| relation.weights.iter().map(|(node, _)| *node));
        check_nodes(nodes, of_pairs.chain(of_nodes))?;
        let mut slaves = self.pairs.values().flat_map(PairRelation::nodes).chain(self.nodes.keys().copied());
        let count: usize = interfaces.iter().map(|interface| interface.nodes.len()).sum();
        if !slaves.all(|node| states.at(node).next().is_some()) || ![0, count].contains(&self.places.len()) {
            return Err(unfit("the relations that it remembers are of other nodes"));
        }
        Ok(())
    }

    /// See [`State::remap`](zelus_core::State::remap).
    pub(crate) fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.pairs.values_mut().for_each(|relation| relation.remap(mapper));
        mapper.node_map(&mut self.nodes);
        self.nodes.values_mut().for_each(|relation| mapper.node_list(&mut relation.weights));
    }

    /// Relations of the pairs that overlap; those that hold a node stay as they were made, unless they are to be renewed.
    pub(crate) fn search(
        &mut self,
        part: &ModelPart,
        interfaces: &[Interface],
        settings: &MpcSettings,
        states: &SlaveStates,
    ) -> Option<Diagnostic> {
        let holds = |relation: &PairRelation| relation.nodes().any(|n| states[states.only_at(n)].law.active);
        let keep = !settings.update_relations || settings.ties();
        let segmentation = &settings.segmentation;
        self.pairs.retain(|key, relation| {
            let (slave, master) = facets(interfaces, *key);
            keep && holds(relation)
                && facet_operators(part, slave, master, &nodal_normals(part, slave), segmentation).is_some()
        });
        let known = |key: &PairKey| self.pairs.contains_key(key);
        let found =
            overlapping_pairs(part, interfaces, &settings.search, segmentation, &of_nodes(part, interfaces), &known);
        self.relate(part, interfaces, settings, &found, states);
        self.warn_of_unlike_meshes(part, settings)
    }

    /// Renews the relations of the pairs there are.
    pub(crate) fn renew(
        &mut self,
        part: &ModelPart,
        interfaces: &[Interface],
        settings: &MpcSettings,
        states: &SlaveStates,
    ) {
        let pair = |key: &PairKey| {
            let (slave, master) = facets(interfaces, *key);
            let operators = facet_operators(part, slave, master, &nodal_normals(part, slave), &settings.segmentation)?;
            Some(FacetPair { key: *key, operators })
        };
        let pairs: Vec<FacetPair> = self.pairs.keys().filter_map(pair).collect();
        self.relate(part, interfaces, settings, &pairs, states);
    }

    /// How far nodes of the interfaces are from where they were when relations were made, in mesh sizes.
    pub(crate) fn farthest(&self, part: &ModelPart, interfaces: &[Interface]) -> f64 {
        let sizes = part.nodes.values.values(&NODAL_H, 0);
        let nodes = interfaces.iter().flat_map(|interface| &interface.nodes).map(|&node| node as usize);
        let ratio = |(at, before): (usize, &[f64; 3])| {
            let moved = norm(sub(part.nodes.current[at], *before));
            if sizes[at] > 0.0 { moved / sizes[at] } else { moved }
        };
        nodes.zip(&self.places).map(ratio).fold(0.0, f64::max)
    }

    /// Makes the relations of these pairs, and those of the nodes.
    pub(crate) fn relate(
        &mut self,
        part: &ModelPart,
        interfaces: &[Interface],
        settings: &MpcSettings,
        pairs: &[FacetPair],
        states: &SlaveStates,
    ) {
        for pair in pairs {
            let (slave, master) = facets(interfaces, pair.key);
            let finer = || {
                let integration_order = IntegrationOrder::new(FINE)?.max(settings.segmentation.integration_order);
                let segmentation = SegmentationSettings { integration_order, ..settings.segmentation };
                facet_operators(part, slave, master, &nodal_normals(part, slave), &segmentation)
            };
            let relation = PairRelation::new(part, interfaces, pair, settings.weights, finer);
            self.pairs.insert(pair.key, relation);
        }
        let nodes = interfaces.iter().flat_map(|interface| &interface.nodes);
        self.places = nodes.map(|&node| part.nodes.current[node as usize]).collect();
        let pairs = self.pairs.iter().map(|(key, relation)| (key.interface, relation));
        let follows_masters = !settings.ties() && settings.solver.feature_angle.is_some();
        let edges = follows_masters.then(|| self.edges.open(interfaces, states));
        self.nodes = node_relations(pairs, interfaces, settings.weights, edges.as_deref());
    }

    /// With weights that do not add up to one nodes that follow several masters pass forces on wrongly, unless the master is
    /// held.
    fn warn_of_unlike_meshes(&mut self, part: &ModelPart, settings: &MpcSettings) -> Option<Diagnostic> {
        if self.warned || settings.consistent() {
            return None;
        }
        let dimension = part.info.domain_size as u8;
        let deforms = |node: u32| (0..dimension).any(|c| !part.nodes.is_fixed(DISPLACEMENT.component(c), node));
        let mixed = self.nodes.values().filter(|relation| relation.is_mixed()).count();
        self.warned = mixed > 0 && self.nodes.values().flat_map(|n| &n.weights).any(|&(node, _)| deforms(node));
        let fact = format!(
            "constraints join unlike meshes of deformable bodies at {mixed} slave nodes: stresses there are wrong"
        );
        let remedy = "leave \"consistent_weights\" at true: forces are then passed on as by alm_contact_process";
        self.warned.then(|| Diagnostic::warning("mpc-unlike-meshes", fact).remedy(remedy))
    }

    /// Finds gaps and areas of the slave nodes in the present configuration.
    pub(crate) fn integrate(
        &self,
        part: &ModelPart,
        interfaces: &[Interface],
        settings: &MpcSettings,
        states: &mut SlaveStates,
    ) {
        states.for_all(|state| (state.kinematics.weighted_gap, state.kinematics.area) = (0.0, 0.0));
        states.read_normals(&part.nodes);
        for (&node, relation) in &self.nodes {
            let own = states.only_at(node);
            states[own].kinematics.normal = relation.normal;
        }
        for key in self.pairs.keys() {
            let (slave, master) = facets(interfaces, *key);
            let normals = nodal_normals(part, slave);
            let Some(operators) = facet_operators(part, slave, master, &normals, &settings.segmentation) else {
                continue;
            };
            let origin = part.nodes.current[slave.nodes[0] as usize];
            let place = |n: &u32| sub(part.nodes.current[*n as usize], origin);
            let of_slave: Vec<[f64; 3]> = slave.nodes.iter().map(place).collect();
            let of_master: Vec<[f64; 3]> = master.nodes.iter().map(place).collect();
            for (j, &node) in slave.nodes.iter().enumerate() {
                let own = states.only_at(node);
                let state = &mut states[own];
                state.kinematics.weighted_gap -= dot(state.kinematics.normal, operators.jump(j, &of_slave, &of_master));
                state.kinematics.area += operators.d[j][..slave.nodes.len()].iter().sum::<f64>();
            }
        }
        let mesh_nodes: Vec<u32> = states.all().map(|slave| states.mesh_node(slave)).collect();
        states
            .for_each(|slave, state| state.kinematics.isolated = !self.nodes.contains_key(&mesh_nodes[slave.place()]));
    }

    /// Nothing is related any more.
    pub(crate) fn clear(&mut self) {
        self.pairs.clear();
        self.nodes.clear();
    }

    /// Keeps the pairs of an accepted state.
    pub(crate) fn save(&mut self) {
        self.saved = self.pairs.clone();
    }

    /// Goes back to the pairs kept last.
    pub(crate) fn restore(&mut self) {
        self.pairs = std::mem::take(&mut self.saved);
    }
}
