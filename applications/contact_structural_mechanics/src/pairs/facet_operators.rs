//! D and M of two facets, for what does not need their derivatives: ties, constraints, mapping.

use std::collections::BTreeSet;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use zelus_core::model::ModelPart;
use zelus_structural_mechanics::variables::NORMAL;

use super::pair::PairKey;
use crate::interface::{Facet, Interface, centre_normal, positions};
use crate::mortar::operators::SLIVER;
use crate::mortar::shape;
use crate::mortar::shapes::for_shapes;
use crate::mortar::{Choices, Overlap, PairGeometry, SegmentationSettings, operators};
use crate::search::{Candidate, SearchSettings, candidates};

/// D and M of a pair, in the leading rows and columns (area).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct FacetOperators {
    /// D_jk, slave on slave; diagonal where dual functions are in use.
    pub d: [[f64; 4]; 4],
    /// M_jl, slave on master.
    pub m: [[f64; 4]; 4],
    /// Whether the overlap is a sliver.
    pub sliver: bool,
}

impl FacetOperators {
    /// Row `j` of D⁻¹ M for `slaves` and `masters` nodes: the weights with which the master's values reach the slave node.
    /// They add up to one. D counts as diagonal, which it is where dual functions are in use.
    pub fn weights(&self, j: usize, slaves: usize, masters: usize) -> [f64; 4] {
        let d: f64 = self.d[j][..slaves].iter().sum();
        let mut out = [0.0; 4];
        (0..masters).for_each(|l| out[l] = self.m[j][l] / d);
        out
    }

    /// Whether D is diagonal, so that dual functions were in use.
    pub fn is_diagonal(&self) -> bool {
        (0..4).all(|j| (0..4).all(|k| j == k || self.d[j][k] == 0.0))
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
        ($ns:literal, $nm:literal, $nu:literal, $nn:literal, $nv:literal) => {
            of_shapes::<$ns, $nm>(part, slave, master, settings)
        };
    }
    for_shapes!(slave.shape, master.shape, make)?
}

fn of_shapes<const NS: usize, const NM: usize>(
    part: &ModelPart,
    slave: &Facet,
    master: &Facet,
    settings: &SegmentationSettings,
) -> Option<FacetOperators> {
    let normals = part.nodes.history.values(&NORMAL, 0);
    let mut buffer = [[0.0; 3]; 4];
    let position = |facet: &Facet, at: usize| part.nodes.current[facet.nodes[at] as usize];
    let geometry = PairGeometry {
        slave: std::array::from_fn::<_, NS, _>(|j| position(slave, j)),
        master: std::array::from_fn::<_, NM, _>(|l| position(master, l)),
        nodal_normals: std::array::from_fn(|j| std::array::from_fn(|c| normals[3 * slave.nodes[j] as usize + c])),
        slave_normal: centre_normal(slave.shape, positions(slave, part, &mut buffer))?,
        master_normal: centre_normal(master.shape, positions(master, part, &mut buffer))?,
        choices: Choices { slivers: settings.slivers, ..Choices::default() },
    };
    let found = match operators(&geometry, settings) {
        Overlap::Cells(found) => found,
        Overlap::Sliver | Overlap::None => return None,
    };
    let mut out = FacetOperators::default();
    for j in 0..NS {
        out.d[j][..NS].copy_from_slice(&found.d[j]);
        out.m[j][..NM].copy_from_slice(&found.m[j]);
    }
    let covered: f64 = found.d.as_flattened().iter().sum();
    out.sliver = covered < SLIVER * shape::measure(&geometry.slave);
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
