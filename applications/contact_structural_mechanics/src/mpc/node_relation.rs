//! How slave nodes follow master facets: u¹ = B u² + offset, with the rows of B from the D and M of their pairs.
//!
//! A node follows all its pairs together, u¹ = Σ M u² / Σ D, as the multiplier of a mortar formulation would have it: the weights add
//! up to one, so that no force is lost, and on flat interfaces B takes the masters to the node itself, so that moments are kept and a
//! constant stress passes. On curved interfaces B x² is beside x¹ by the distance of the facets from the surface, and moments are off
//! by that much.
//!
//! The reference program's weights are [`Weights::ByFacets`]: rows of D⁻¹ M of single pairs that have negative entries, since the node
//! is at the master's edge, are left out; the rows that remain are added, each divided by the number of slave facets of the node. On
//! unlike meshes more or fewer rows remain, and the weights do not add up to one.
//!
//! The offset closes the gap of the moment the relation is made. Ties keep it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use zelus_core::StateMapper;
use zelus_core::model::{MasterSlaveConstraint, ModelPart};
use zelus_core::vector3::{add, dot, norm, normalised, scale, sub};
use zelus_structural_mechanics::variables::{DISPLACEMENT, NORMAL};

use crate::interface::{Interface, Roles};
use crate::pairing::{FLAT, NO_COMMON_NORMAL, SHARP};
use crate::pairs::{FacetOperators, FacetPair};

/// Entries of B below this are negative.
const NEGATIVE: f64 = -1e-8;
/// Weights below this are none.
const NEGLIGIBLE: f64 = 1e-12;
/// Component of a unit normal along which a node can be held.
const HOLD: f64 = 0.1;

/// Rows of one pair: which slave nodes follow which masters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PairRelation {
    rows: Vec<Row>,
}

/// One slave node of a pair.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Row {
    node: u32,
    area: f64,
    weights: Vec<(u32, f64)>,
    lead: [f64; 3],
    /// Way from the master to the node.
    apart: [f64; 3],
    normal: [f64; 3],
    /// Normal of the master, turned round.
    opposite: [f64; 3],
    /// Whether the slave facet deviates much from the mean normal.
    sharp: bool,
}

/// A slave node with the sum of its rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct NodeRelation {
    /// Master nodes and their weights.
    pub weights: Vec<(u32, f64)>,
    /// u¹ − B u² where the relation was made (length).
    lead: [f64; 3],
    /// Addition to it that closes the gap (length).
    closing: [f64; 3],
    /// The part of that which closes an opening.
    opening: [f64; 3],
    /// Unit normal of the slave, that of the master turned round at edges.
    pub normal: [f64; 3],
}

/// How the rows of a node make up its relation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weights {
    /// Rows that extrapolate are left out, the others divided by the number of slave facets of the node; a node in several
    /// interfaces follows the first. As in the reference program.
    ByFacets,
    /// All rows, each with its share of the area, so that the weights of a node add up to one.
    Consistent,
}

/// Components of a slave node that follow its masters, and the place they follow to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum FollowingComponents {
    /// The displacement along the normal, until the gap is closed; friction goes with the force, `push` to the unit of pressure.
    Normal { push: [f64; 3] },
    /// All components: along the normal until the gap is closed, in the tangent where the relation was made.
    Closed,
    /// All components where the relation was made.
    Tied,
    /// All components: along the normal until the gap is closed, in the tangent where the step began.
    Stick,
}

fn vector(column: &[f64], node: u32) -> [f64; 3] {
    let at = 3 * node as usize;
    [column[at], column[at + 1], column[at + 2]]
}

impl PairRelation {
    /// Slave and master nodes.
    pub(crate) fn all_nodes(&self) -> impl Iterator<Item = u32> {
        self.rows.iter().flat_map(|row| row.weights.iter().map(|(node, _)| *node).chain([row.node]))
    }

    /// See [`State::remap`](zelus_core::State::remap).
    pub(crate) fn remap(&mut self, mapper: &mut dyn StateMapper) {
        for row in &mut self.rows {
            mapper.nodes(std::slice::from_mut(&mut row.node));
            mapper.node_list(&mut row.weights);
        }
    }

    /// The rows of a pair in the present configuration; `finer` integrates it again where its D is not diagonal.
    pub(crate) fn new(
        part: &ModelPart,
        interfaces: &[Interface],
        pair: &FacetPair,
        weights: Weights,
        finer: impl Fn() -> Option<FacetOperators>,
    ) -> Self {
        let facets = &interfaces[pair.key.interface as usize].facets;
        let (slave, master) = (&facets[pair.key.slave as usize], &facets[pair.key.master as usize]);
        let displacement = part.nodes.history.values(&DISPLACEMENT, 0);
        let normals = part.nodes.history.values(&NORMAL, 0);
        let (own, opposite) = (slave.normal(part), scale(master.normal(part), -1.0));
        let mut rows = Vec::new();
        let diagonal = pair.operators.is_diagonal();
        let operators = match weights {
            Weights::Consistent if !diagonal => finer().filter(FacetOperators::is_diagonal),
            _ => Some(pair.operators),
        };
        let Some(operators) = operators else { return Self { rows } };
        for (j, &node) in slave.nodes.iter().enumerate() {
            let row = operators.weights(j, slave.nodes.len(), master.nodes.len());
            let row = &row[..master.nodes.len()];
            let extrapolates = weights == Weights::ByFacets && row.iter().any(|w| *w < NEGATIVE);
            if extrapolates || row.iter().all(|w| w.abs() <= NEGLIGIBLE) {
                continue;
            }
            let normal = vector(normals, node);
            let mut apart = part.nodes.current[node as usize];
            let mut lead = vector(displacement, node);
            for (&other, &weight) in master.nodes.iter().zip(row) {
                let (x, u) = (part.nodes.current[other as usize], vector(displacement, other));
                (0..3).for_each(|c| apart[c] -= weight * x[c]);
                (0..3).for_each(|c| lead[c] -= weight * u[c]);
            }
            let sharp = dot(own, normal) < SHARP;
            let area = operators.d[j][..slave.nodes.len()].iter().sum();
            let kept = master.nodes.iter().copied().zip(row.iter().copied()).filter(|(_, w)| w.abs() > NEGLIGIBLE);
            rows.push(Row { node, area, weights: kept.collect(), lead, apart, normal, opposite, sharp });
        }
        Self { rows }
    }

    /// The slave nodes that follow.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = u32> + '_ {
        self.rows.iter().map(|row| row.node)
    }
}

/// Whether supports leave a component of a node free along which a constraint can hold it.
pub(crate) fn can_follow(part: &ModelPart, node: u32, normal: [f64; 3]) -> bool {
    let free = |c: &usize| !part.nodes.is_fixed(DISPLACEMENT.component(*c as u8), node);
    (0..part.info.domain_size).filter(free).any(|c| normal[c].abs() > HOLD)
}

/// The relation of each slave node: its rows, weighed as `weights` says; `edges` are nodes that may press as an edge, ascending, where
/// edges follow the normal of the master.
pub(crate) fn node_relations<'p>(
    pairs: impl Iterator<Item = (u32, &'p PairRelation)>,
    interfaces: &[Interface],
    weights: Weights,
    edges: Option<&[u32]>,
) -> BTreeMap<u32, NodeRelation> {
    let mut rows: BTreeMap<u32, (u32, Vec<&Row>)> = BTreeMap::new();
    for (interface, pair) in pairs {
        for row in &pair.rows {
            let (first, list) = rows.entry(row.node).or_insert((interface, Vec::new()));
            if *first == interface || weights == Weights::Consistent {
                list.push(row);
            }
        }
    }
    let along = |node: u32, rows: &[&Row]| {
        let edges = edges?;
        let is_edge = edges.binary_search(&node).is_ok() || rows.iter().any(|row| row.sharp);
        is_edge.then(|| normal_of_masters(rows)).flatten()
    };
    let by_area = |rows: &[&Row]| -> Vec<f64> {
        let whole: f64 = rows.iter().map(|row| row.area).sum();
        rows.iter().map(|row| row.area / whole).collect()
    };
    if weights == Weights::Consistent {
        let of_node =
            |(node, (_, list)): (u32, (u32, Vec<&Row>))| (node, sum(&list, &by_area(&list), along(node, &list)));
        return rows.into_iter().map(of_node).collect();
    }
    let mut facets: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    for (at, interface) in interfaces.iter().enumerate() {
        for node in interface.facets.iter().filter(|f| f.role == Roles::Slave).flat_map(|f| &f.nodes) {
            *facets.entry((at as u32, *node)).or_insert(0) += 1;
        }
    }
    let share = |node, at, rows: &[&Row]| 1.0 / facets.get(&(at, node)).copied().unwrap_or(rows.len()) as f64;
    let of_node = |(node, (at, list)): (u32, (u32, Vec<&Row>))| {
        (node, sum(&list, &vec![share(node, at, &list); list.len()], along(node, &list)))
    };
    rows.into_iter().map(of_node).collect()
}

/// The mean of the masters' normals by area, turned round, where it is one and not that of the slave.
fn normal_of_masters(rows: &[&Row]) -> Option<[f64; 3]> {
    let (mut opposite, mut normal, mut area) = ([0.0; 3], [0.0; 3], 0.0);
    for row in rows {
        opposite = add(opposite, scale(row.opposite, row.area));
        normal = add(normal, scale(row.normal, row.area));
        area += row.area;
    }
    let (opposite_size, opposite) = (norm(opposite), normalised(opposite));
    (opposite_size > NO_COMMON_NORMAL * area && dot(opposite, normalised(normal)) < FLAT.cos()).then_some(opposite)
}

/// The sum of rows with these shares, with gaps `along` a normal or those of the rows.
fn sum(rows: &[&Row], shares: &[f64], along: Option<[f64; 3]>) -> NodeRelation {
    let mut weights: BTreeMap<u32, f64> = BTreeMap::new();
    let [mut lead, mut closing, mut opening, mut normal] = [[0.0; 3]; 4];
    for (row, share) in rows.iter().zip(shares) {
        let n = along.unwrap_or(row.normal);
        let gap = -dot(n, row.apart);
        row.weights.iter().for_each(|&(node, w)| *weights.entry(node).or_insert(0.0) += share * w);
        for c in 0..3 {
            lead[c] += share * row.lead[c];
            closing[c] += share * gap * n[c];
            opening[c] += share * gap.max(0.0) * n[c];
            normal[c] += share * n[c];
        }
    }
    let weights = weights.into_iter().filter(|(_, w)| w.abs() > NEGLIGIBLE).collect();
    NodeRelation { weights, lead, closing, opening, normal: normalised(normal) }
}

impl NodeRelation {
    /// Whether the node follows more than one master or not quite one, which is so where the meshes are unlike.
    pub(crate) fn is_mixed(&self) -> bool {
        !matches!(self.weights[..], [(_, weight)] if (weight - 1.0).abs() < 1e-6)
    }

    /// Lead of the node over its masters: u¹ − B u², at a time level.
    pub(crate) fn lead(&self, part: &ModelPart, node: u32, level: usize) -> [f64; 3] {
        let levels = part.nodes.history.get(DISPLACEMENT.name()).map_or(0, |field| field.levels.len());
        let displacement = part.nodes.history.values(&DISPLACEMENT, level.min(levels.saturating_sub(1)));
        let mut masters = [0.0; 3];
        for &(master, weight) in &self.weights {
            let u = vector(displacement, master);
            (0..3).for_each(|c| masters[c] += weight * u[c]);
        }
        sub(vector(displacement, node), masters)
    }

    /// The relation that leaves an opening as it is.
    pub(crate) fn keeping_opening(&self) -> Self {
        Self { closing: sub(self.closing, self.opening), ..self.clone() }
    }

    /// The constraints that hold `node`; components that supports hold already are left to them.
    pub(crate) fn constraints(
        &self,
        part: &ModelPart,
        node: u32,
        hold: FollowingComponents,
        next_id: &mut usize,
        out: &mut Vec<MasterSlaveConstraint>,
    ) {
        let dimension = part.info.domain_size;
        let is_free = |c: usize| !part.nodes.is_fixed(DISPLACEMENT.component(c as u8), node);
        let mut push = |component: usize, masters, forces, constant| {
            let slave = (node, DISPLACEMENT.component(component as u8));
            let id = *next_id;
            out.push(MasterSlaveConstraint { id, forces, constant, ..MasterSlaveConstraint::new(slave, masters) });
            *next_id += 1;
        };
        let n = self.normal;
        let closed: [f64; 3] = std::array::from_fn(|c| self.lead[c] + self.closing[c]);
        let offset = match hold {
            FollowingComponents::Tied => self.lead,
            FollowingComponents::Normal { .. } | FollowingComponents::Closed => closed,
            FollowingComponents::Stick => {
                let lead = self.lead(part, node, 1);
                let closing = dot(n, sub(closed, lead));
                std::array::from_fn(|c| lead[c] + n[c] * closing)
            }
        };
        let FollowingComponents::Normal { push: along } = hold else {
            for c in (0..dimension).filter(|&c| is_free(c)) {
                let masters = self.weights.iter().map(|&(m, w)| ((m, DISPLACEMENT.component(c as u8)), w));
                push(c, masters.collect(), None, offset[c]);
            }
            return;
        };
        // The slave bears λ (n − push), λ < 0 under pressure. Which component is eliminated changes no answer: the constraint
        // n · (u¹ − B u² − offset) = 0 and the direction of its force are the same.
        let component = |borne: [f64; 3]| {
            let size = move |c: usize| n[c].abs().min(borne[c].abs());
            let free = (0..dimension).filter(|&c| is_free(c) && size(c) > HOLD);
            free.max_by(|&a, &b| size(a).total_cmp(&size(b)))
        };
        let borne = sub(n, along);
        // Where supports leave no component in which the force with its friction acts, the node is wedged.
        let (borne, chosen) = match (component(borne), component(n)) {
            (Some(chosen), _) => (borne, chosen),
            (None, Some(chosen)) => (n, chosen),
            (None, None) => return,
        };
        let (mut masters, mut forces) = (Vec::new(), Vec::new());
        for c in (0..dimension).filter(|&c| n[c].abs().max(borne[c].abs()) > NEGLIGIBLE) {
            let (factor, force) = (n[c] / n[chosen], borne[c] / borne[chosen]);
            let component = DISPLACEMENT.component(c as u8);
            masters.extend(self.weights.iter().map(|&(m, w)| ((m, component), w * factor)));
            forces.extend(self.weights.iter().map(|&(_, w)| w * force));
            if c != chosen {
                masters.push(((node, component), -factor));
                forces.push(-force);
            }
        }
        push(chosen, masters, (borne != n).then_some(forces), dot(n, offset) / n[chosen]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::model::Nodes;

    const NORMAL_OF_FACE: [f64; 3] = [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0];

    fn relation() -> NodeRelation {
        let (weights, lead, closing) = (vec![(1, 0.75), (2, 0.25)], [0.0; 3], [0.1, 0.15, 0.3]);
        NodeRelation { weights, lead, closing, opening: [0.0; 3], normal: NORMAL_OF_FACE }
    }

    /// The constraint of node 0 with some of its components held, and its force on the nodes for a unit at the eliminated one.
    fn held(fixed: &[u8], push: [f64; 3]) -> (MasterSlaveConstraint, [[f64; 3]; 3]) {
        let mut part = ModelPart::new("Structure");
        part.info.domain_size = 3;
        part.nodes = Nodes::new(vec![1, 2, 3], vec![[0.0; 3]; 3]);
        part.nodes.history.add(&DISPLACEMENT);
        fixed.iter().for_each(|&c| part.nodes.set_fixed(DISPLACEMENT.component(c), &[0], true));
        let mut out = Vec::new();
        relation().constraints(&part, 0, FollowingComponents::Normal { push }, &mut 1, &mut out);
        let constraint = out.pop().expect("a constraint");
        let mut force = [[0.0; 3]; 3];
        let weights = constraint.masters.iter().map(|m| m.1).collect();
        let shares = constraint.forces.clone().unwrap_or(weights);
        force[0][usize::from(constraint.slave.1.component.expect("a component"))] = 1.0;
        for (&((node, variable), _), share) in constraint.masters.iter().zip(shares) {
            force[node as usize][usize::from(variable.component.expect("a component"))] = -share;
        }
        (constraint, force)
    }

    /// Whatever component is eliminated, the force is along n − push, on the slave and against it on the masters.
    #[test]
    fn the_component_that_is_eliminated_changes_nothing() {
        for push in [[0.0; 3], [0.15, 0.0, -0.05]] {
            for (fixed, eliminated) in [(&[][..], 2), (&[2], 1), (&[1, 2], 0)] {
                let (constraint, force) = held(fixed, push);
                assert_eq!(constraint.slave.1.component, Some(eliminated));
                let along = sub(NORMAL_OF_FACE, push);
                for c in 0..3 {
                    let expected = along[c] / along[usize::from(eliminated)];
                    assert!((force[0][c] - expected).abs() < 1e-15, "{force:?}");
                    assert!(
                        (force[1][c] + 0.75 * expected).abs() < 1e-15 && (force[2][c] + 0.25 * expected).abs() < 1e-15
                    );
                }
                // n · (u¹ − B u²) = n · offset for any motion.
                let motion = |node: u32, c: usize| f64::from(node + 1) * [0.3, -0.2, 0.5][c];
                let component = |v: zelus_core::model::ScalarVariable| usize::from(v.component.expect("a component"));
                let terms = constraint.masters.iter().map(|&((node, v), w)| w * motion(node, component(v)));
                let followed = terms.sum::<f64>() + constraint.constant;
                let gap: f64 = (0..3)
                    .map(|c| {
                        let own = if c == usize::from(eliminated) { followed } else { motion(0, c) };
                        let masters = 0.75 * motion(1, c) + 0.25 * motion(2, c);
                        NORMAL_OF_FACE[c] * (own - masters - [0.1, 0.15, 0.3][c])
                    })
                    .sum();
                assert!(gap.abs() < 1e-15, "{gap:e}");
            }
        }
    }

    #[test]
    fn a_wedged_node_is_held_without_friction() {
        let (constraint, _) = held(&[1, 2], [0.3, 0.0, -0.1]);
        assert_eq!((constraint.slave.1.component, constraint.forces), (Some(0), None));
    }

    #[test]
    fn rows_count_with_their_area_or_by_facets() {
        let row = |area, node, gap: f64| Row {
            node: 0,
            area,
            weights: vec![(node, 1.0)],
            lead: [0.0; 3],
            apart: [0.0, 0.0, -gap],
            normal: [0.0, 0.0, 1.0],
            opposite: [0.0, 0.6, 0.8],
            sharp: false,
        };
        let pair = PairRelation { rows: vec![row(3.0, 1, 0.2), row(1.0, 2, -0.2)] };
        let nodes = node_relations([(0, &pair), (1, &pair)].into_iter(), &[], Weights::Consistent, None);
        assert_eq!(nodes[&0].weights, [(1, 0.75), (2, 0.25)]);
        assert!((nodes[&0].closing[2] - 0.1).abs() < 1e-16 && nodes[&0].keeping_opening().closing[2] < 0.0);
        let first = node_relations([(0, &pair), (1, &pair)].into_iter(), &[], Weights::ByFacets, None);
        assert_eq!(first[&0].weights, [(1, 0.5), (2, 0.5)]);
        let edge = node_relations([(0, &pair)].into_iter(), &[], Weights::Consistent, Some(&[0]));
        assert_eq!(edge[&0].normal, [0.0, 0.6, 0.8]);
        assert!((edge[&0].closing[2] - 0.1 * 0.8 * 0.8).abs() < 1e-16, "{:?}", edge[&0].closing);
    }
}
