//! D and M of two facets, without derivatives: for ties, constraints, mapping.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use zelus_core::geometry::FacetShape;
use zelus_core::model::ModelPart;
use zelus_core::parallel;
use zelus_structural_mechanics::variables::NORMAL;

use super::grouping::PAIRS;
use super::pair::PairKey;
use crate::interface::{Facet, Interface};
use crate::mortar::operators::SLIVER;
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
/// `normals` gives the unit normal at a node of the slave, by its place. Facets of rigid shapes count as flat.
pub fn facet_operators(
    part: &ModelPart,
    slave: &Facet,
    master: &Facet,
    normals: &dyn Fn(usize) -> [f64; 3],
    settings: &SegmentationSettings,
) -> Option<FacetOperators> {
    let normal = |facet: &Facet| Some(facet.normal(part)).filter(|normal| *normal != [0.0; 3]);
    let position = |facet: &Facet, at: usize| part.nodes.current[facet.nodes[at] as usize];
    let (slave_shape, master_shape) = (FacetShape::of(slave.shape)?, FacetShape::of(master.shape)?);
    let geometry = PairGeometry {
        slave_shape,
        master_shape,
        slave: slave_shape.nodal(|j| position(slave, j)),
        master: master_shape.nodal(|l| position(master, l)),
        nodal_normals: slave_shape.nodal(normals),
        slave_normal: normal(slave)?,
        master_normal: normal(master)?,
        exact: None,
        choices: Choices { slivers: settings.slivers, ..Choices::default() },
    };
    let found = match operators(&geometry, settings) {
        Overlap::Cells(found) => found,
        Overlap::Sliver | Overlap::None => return None,
    };
    let mut out = FacetOperators::default();
    for j in 0..slave_shape.nodes {
        out.d[j][..slave_shape.nodes].copy_from_slice(&found.d[j]);
        out.m[j][..master_shape.nodes].copy_from_slice(&found.m[j]);
    }
    let covered: f64 = found.d.iter().flat_map(|row| row.iter()).sum();
    out.sliver = covered < SLIVER * slave_shape.measure(&geometry.slave);
    Some(out)
}

/// The normals of the mesh nodes of a facet, from their column.
pub fn nodal_normals<'a>(part: &'a ModelPart, facet: &'a Facet) -> impl Fn(usize) -> [f64; 3] + use<'a> {
    let column = part.nodes.history.values(&NORMAL, 0);
    move |local| std::array::from_fn(|c| column[3 * facet.nodes[local] as usize + c])
}

/// Pairs that overlap now, ascending, without those `known` already. Slivers are among them where all nodes of their slave have other
/// overlaps; a node that only slivers reach is at the master's edge.
pub fn overlapping_pairs(
    part: &ModelPart,
    interfaces: &[Interface],
    search: &SearchSettings,
    segmentation: &SegmentationSettings,
    normals: &(dyn Fn(PairKey, usize) -> [f64; 3] + Sync),
    known: &(dyn Fn(&PairKey) -> bool + Sync),
) -> Vec<FacetPair> {
    let mut pairs = Vec::new();
    for (at, interface) in interfaces.iter().enumerate() {
        let slave_nodes = |pair: &FacetPair| &interface.facets[pair.key.slave as usize].nodes;
        let near = candidates(part, interface, search);
        let found = parallel::map(near.len(), PAIRS, |place| {
            let Candidate { slave, master, .. } = near[place];
            let key = PairKey { interface: at as u32, slave, master };
            let (slave, master) = (&interface.facets[slave as usize], &interface.facets[master as usize]);
            let own = |local: usize| normals(key, local);
            let operators = if known(&key) { None } else { facet_operators(part, slave, master, &own, segmentation) };
            Some(FacetPair { key, operators: operators? })
        });
        let found: Vec<FacetPair> = found.into_iter().flatten().collect();
        let whole = found.iter().filter(|pair| !pair.operators.sliver);
        let covered: BTreeSet<u32> = whole.flat_map(slave_nodes).copied().collect();
        let counts = |pair: &FacetPair| !pair.operators.sliver || slave_nodes(pair).iter().all(|n| covered.contains(n));
        pairs.extend(found.into_iter().filter(counts));
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::{FacetSource, Roles};
    use crate::search::{GapCheck, SearchDistance, WithinStep};
    use zelus_core::geometry::Shape;
    use zelus_core::model::Nodes;

    /// Warped quadrilaterals and triangles of all sizes, turned about, slaves and masters alternately.
    fn surfaces(count: usize) -> (ModelPart, Interface) {
        let mut state = 11_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / (1_u64 << 30) as f64 - 1.0
        };
        let (mut points, mut facets) = (Vec::new(), Vec::new());
        for at in 0..count {
            let centre = [2.0 * random(), 2.0 * random(), 0.5 * random()];
            let (size, tilt) = (0.1 + 0.4 * random().abs(), [0.6 * random(), 0.6 * random()]);
            let is_slave = at % 2 == 0;
            let corners: &[[f64; 2]] = match at % 3 {
                0 => &[[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]],
                _ => &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
            };
            let mut nodes: Vec<u32> = (0..corners.len()).map(|k| (points.len() + k) as u32).collect();
            for [x, y] in corners {
                let z = tilt[0] * x + tilt[1] * y + 0.1 * random();
                points.push([x, y, &z].map(|c| size * c));
                let last = points.len() - 1;
                (0..3).for_each(|c| points[last][c] += centre[c]);
            }
            if !is_slave {
                nodes.reverse();
            }
            facets.push(Facet {
                shape: if corners.len() == 3 { Shape::Tri3 } else { Shape::Quad4 },
                nodes,
                source: FacetSource::Face(0),
                element: 0,
                properties: 0,
                role: if is_slave { Roles::Slave } else { Roles::Master },
                exact: None,
            });
        }
        let mut part = ModelPart::new("Structure");
        part.info.domain_size = 3;
        part.nodes = Nodes::new((1..=points.len()).collect(), points);
        part.nodes.history.add(&NORMAL);
        for facet in &facets {
            let normal = facet.normal(&part);
            let column = part.nodes.history.values_mut(&NORMAL, 0);
            facet.nodes.iter().for_each(|&n| column[3 * n as usize..3 * n as usize + 3].copy_from_slice(&normal));
        }
        (part, Interface { facets, ..Interface::default() })
    }

    #[test]
    fn facets_that_the_search_leaves_out_share_no_area() {
        let (part, interface) = surfaces(240);
        let search = SearchSettings {
            factor: 1e3,
            distance: SearchDistance::BetweenFacets,
            normal_orientation_threshold: 0.0,
            within_step: WithinStep::Facing,
            check: GapCheck::CheckMapping,
            dynamic: false,
        };
        let of = |role: Roles| (0..240_u32).filter(move |&f| (f % 2 == 0) == (role == Roles::Slave));
        let near: BTreeSet<(u32, u32)> =
            candidates(&part, &interface, &search).into_iter().map(|found| (found.slave, found.master)).collect();
        let (mut overlapping, mut left_out) = (0, 0);
        for (slave, master) in of(Roles::Slave).flat_map(|s| of(Roles::Master).map(move |m| (s, m))) {
            let facets = [slave, master].map(|at| &interface.facets[at as usize]);
            let settings = SegmentationSettings::default();
            let overlaps =
                facet_operators(&part, facets[0], facets[1], &nodal_normals(&part, facets[0]), &settings).is_some();
            assert!(!overlaps || near.contains(&(slave, master)), "facets {slave} and {master}");
            overlapping += usize::from(overlaps);
            left_out += usize::from(!near.contains(&(slave, master)));
        }
        assert!(overlapping > 300 && left_out > 10 * overlapping, "{overlapping} overlap, {left_out} left out");
    }
}
