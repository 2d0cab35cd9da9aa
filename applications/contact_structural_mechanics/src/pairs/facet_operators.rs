//! D and M of two facets, for what does not need their derivatives: ties, constraints, mapping.

use std::collections::BTreeSet;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::model::ModelPart;
use zelus_structural_mechanics::variables::NORMAL;

use super::pair::PairKey;
use crate::interface::{Facet, Interface};
use crate::mortar::operators::SLIVER;
use crate::mortar::shapes::for_shapes;
use crate::mortar::{Choices, MOST_NODES, Overlap, PairGeometry, SegmentationSettings, operators};
use crate::search::{Candidate, SearchSettings, candidates};

/// D and M of a pair, in the leading rows and columns (area).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct FacetOperators {
    /// D_jk, slave on slave; diagonal where dual functions are in use.
    pub d: [[f64; MOST_NODES]; MOST_NODES],
    /// M_jl, slave on master.
    pub m: [[f64; MOST_NODES]; MOST_NODES],
    /// Whether the overlap is a sliver.
    pub sliver: bool,
}

impl FacetOperators {
    /// Row `j` of D⁻¹ M for `slaves` and `masters` nodes: the weights with which the master's values reach the slave node.
    /// They add up to one. D counts as diagonal, which it is where dual functions are in use.
    pub fn weights(&self, j: usize, slaves: usize, masters: usize) -> [f64; MOST_NODES] {
        let d: f64 = self.d[j][..slaves].iter().sum();
        let mut out = [0.0; MOST_NODES];
        (0..masters).for_each(|l| out[l] = self.m[j][l] / d);
        out
    }

    /// Whether D is diagonal, so that dual functions were in use.
    pub fn is_diagonal(&self) -> bool {
        (0..MOST_NODES).all(|j| (0..MOST_NODES).all(|k| j == k || self.d[j][k] == 0.0))
    }

    /// (D v¹ − M v²)_j of nodal vectors.
    pub fn jump(&self, j: usize, slave: &[[f64; 3]], master: &[[f64; 3]]) -> [f64; 3] {
        let mut out = [0.0; 3];
        for c in 0..3 {
            let of_slave: f64 = slave.iter().zip(&self.d[j]).map(|(v, d)| d * v[c]).sum();
            let of_master: f64 = master.iter().zip(&self.m[j]).map(|(v, m)| m * v[c]).sum();
            out[c] = of_slave - of_master;
        }
        out
    }
}

/// Two facets that overlap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FacetPair {
    /// Its facets.
    pub key: PairKey,
    /// Its operators at the moment it was made.
    pub operators: FacetOperators,
}

/// The operators of two facets as they stand; `None` when they do not overlap or carry no contact.
///
/// Nodes of the slave must have their NORMAL.
pub fn facet_operators(
    part: &ModelPart,
    slave: &Facet,
    master: &Facet,
    settings: &SegmentationSettings,
) -> Option<FacetOperators> {
    macro_rules! make {
        ($slave:ty, $master:ty, $end:literal) => {
            of_shapes::<$slave, $master>(part, slave, master, settings)
        };
    }
    for_shapes!(slave.shape, master.shape, make)?
}

fn of_shapes<S: FacetShape, M: FacetShape>(
    part: &ModelPart,
    slave: &Facet,
    master: &Facet,
    settings: &SegmentationSettings,
) -> Option<FacetOperators> {
    let normals = part.nodes.history.values(&NORMAL, 0);
    let normal = |facet: &Facet| Some(facet.normal(part)).filter(|normal| *normal != [0.0; 3]);
    let position = |facet: &Facet, at: usize| part.nodes.current[facet.nodes[at] as usize];
    let geometry = PairGeometry::<f64, S, M> {
        slave: S::nodal(|j| position(slave, j)),
        master: M::nodal(|l| position(master, l)),
        nodal_normals: S::nodal(|j| std::array::from_fn(|c| normals[3 * slave.nodes[j] as usize + c])),
        slave_normal: normal(slave)?,
        master_normal: normal(master)?,
        choices: Choices { slivers: settings.slivers, ..Choices::default() },
    };
    let found = match operators(&geometry, settings) {
        Overlap::Cells(found) => found,
        Overlap::Sliver | Overlap::None => return None,
    };
    let mut out = FacetOperators::default();
    for j in 0..S::NODES {
        out.d[j][..S::NODES].copy_from_slice(found.d[j].as_slice());
        out.m[j][..M::NODES].copy_from_slice(found.m[j].as_slice());
    }
    let covered: f64 = found.d.iter().flat_map(|row| row.iter()).sum();
    out.sliver = covered < SLIVER * S::measure(&geometry.slave);
    Some(out)
}

/// Pairs that overlap now, ascending, without those `known` already.
/// Slivers are among them where all nodes of their slave have other overlaps; a node that only slivers reach is beside the
/// master.
pub fn overlapping_pairs(
    part: &ModelPart,
    interfaces: &[Interface],
    search: &SearchSettings,
    segmentation: &SegmentationSettings,
    known: &(dyn Fn(&PairKey) -> bool + Sync),
) -> Vec<FacetPair> {
    let mut pairs = Vec::new();
    for (at, interface) in interfaces.iter().enumerate() {
        let slave_nodes = |pair: &FacetPair| &interface.facets[pair.key.slave as usize].nodes;
        let found = candidates(part, interface, search).into_par_iter().with_min_len(32).filter_map(|candidate| {
            let Candidate { slave, master, .. } = candidate;
            let key = PairKey { interface: at as u32, slave, master };
            let (slave, master) = (&interface.facets[slave as usize], &interface.facets[master as usize]);
            let operators = if known(&key) { None } else { facet_operators(part, slave, master, segmentation) };
            Some(FacetPair { key, operators: operators? })
        });
        let found: Vec<FacetPair> = found.collect();
        let whole = found.iter().filter(|pair| !pair.operators.sliver);
        let covered: BTreeSet<u32> = whole.flat_map(slave_nodes).copied().collect();
        let counts = |pair: &FacetPair| !pair.operators.sliver || slave_nodes(pair).iter().all(|n| covered.contains(n));
        pairs.extend(found.into_iter().filter(counts));
    }
    pairs
}
