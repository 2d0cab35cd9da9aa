//! How slave nodes follow master facets: u¹ = B u² + offset with B = D⁻¹ M of each pair.
//!
//! Rows of B with negative entries extrapolate, since the node is beside the master, and are left out; the rows that
//! remain at a node are added, each divided by the number of slave facets of the node. On like meshes that is their mean.
//! On unlike meshes more or fewer rows remain, and the weights do not add up to one unless [`Weights::Consistent`] divides
//! by the number of rows. The offset closes the gap of the moment the relation is made; in the first step of a run, as in
//! the reference program, an opening is kept and closes with the second.

use std::collections::BTreeMap;

use zelus_core::entities::MasterSlaveConstraint;
use zelus_core::model::{ModelPart, variables::DISPLACEMENT, variables::NORMAL};
use zelus_core::vector3::{dot, sub};

use crate::interface::{Interface, Roles};
use crate::pairs::FacetPair;

/// Entries of B below this are negative.
const NEGATIVE: f64 = -1e-8;
/// Weights below this are none.
const NEGLIGIBLE: f64 = 1e-12;
/// Component of a unit normal along which a node can be held.
const HOLD: f64 = 0.1;

/// Rows of one pair: which slave nodes follow which masters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PairRelation {
    rows: Vec<Row>,
}

/// One slave node of a pair.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    node: u32,
    weights: Vec<(u32, f64)>,
    offset: [f64; 3],
    opening: [f64; 3],
    normal: [f64; 3],
}

/// A slave node with the sum of its rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NodeRelation {
    /// Master nodes and their weights.
    pub weights: Vec<(u32, f64)>,
    /// What is added to close the gap (length).
    pub offset: [f64; 3],
    /// The part of it that closes an opening.
    pub opening: [f64; 3],
    /// Unit normal of the slave.
    pub normal: [f64; 3],
}

/// By what the rows of a node are divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weights {
    /// The number of slave facets of the node, as in the reference program.
    ByFacets,
    /// The number of rows, so that the weights of a node add up to one.
    Consistent,
}

/// What of a slave node follows its masters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Hold {
    /// The displacement along the normal.
    Normal,
    /// All components, at the offset of the relation.
    All,
    /// All components: along the normal at the offset of the relation, in the tangent where the step began.
    Stick,
}

fn vector(column: &[f64], node: u32) -> [f64; 3] {
    let at = 3 * node as usize;
    [column[at], column[at + 1], column[at + 2]]
}

impl PairRelation {
    /// The rows of a pair in the present configuration.
    pub(super) fn new(part: &ModelPart, interfaces: &[Interface], pair: &FacetPair) -> Self {
        let facets = &interfaces[pair.key.interface as usize].facets;
        let (slave, master) = (&facets[pair.key.slave as usize], &facets[pair.key.master as usize]);
        let displacement = part.nodes.history.values(&DISPLACEMENT, 0);
        let normals = part.nodes.history.values(&NORMAL, 0);
        let mut rows = Vec::new();
        for (j, &node) in slave.nodes.iter().enumerate() {
            let weights = pair.operators.weights(j, slave.nodes.len(), master.nodes.len());
            let weights = &weights[..master.nodes.len()];
            if weights.iter().any(|w| *w < NEGATIVE) || weights.iter().all(|w| *w <= NEGLIGIBLE) {
                continue;
            }
            let normal = vector(normals, node);
            let mut apart = part.nodes.current[node as usize];
            let mut offset = vector(displacement, node);
            for (&other, &weight) in master.nodes.iter().zip(weights) {
                let (x, u) = (part.nodes.current[other as usize], vector(displacement, other));
                (0..3).for_each(|c| apart[c] -= weight * x[c]);
                (0..3).for_each(|c| offset[c] -= weight * u[c]);
            }
            let gap = -dot(normal, apart);
            (0..3).for_each(|c| offset[c] += normal[c] * gap);
            let opening = normal.map(|n| n * gap.max(0.0));
            let kept = master.nodes.iter().copied().zip(weights.iter().copied()).filter(|(_, w)| *w > NEGLIGIBLE);
            rows.push(Row { node, weights: kept.collect(), offset, opening, normal });
        }
        Self { rows }
    }

    /// The slave nodes that follow.
    pub(super) fn nodes(&self) -> impl Iterator<Item = u32> + '_ {
        self.rows.iter().map(|row| row.node)
    }
}

/// The sum of the rows at each slave node, divided as `weights` says; a node in several interfaces follows the first.
pub(super) fn node_relations<'p>(
    pairs: impl Iterator<Item = (u32, &'p PairRelation)>,
    interfaces: &[Interface],
    weights: Weights,
) -> BTreeMap<u32, NodeRelation> {
    let mut rows: BTreeMap<u32, (u32, Vec<&Row>)> = BTreeMap::new();
    for (interface, pair) in pairs {
        for row in &pair.rows {
            let (first, list) = rows.entry(row.node).or_insert((interface, Vec::new()));
            if *first == interface {
                list.push(row);
            }
        }
    }
    let mut facets: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    for (at, interface) in interfaces.iter().enumerate() {
        for node in interface.facets.iter().filter(|f| f.role == Roles::Slave).flat_map(|f| &f.nodes) {
            *facets.entry((at as u32, *node)).or_insert(0) += 1;
        }
    }
    let count = |node: u32, interface: u32, rows: usize| match weights {
        Weights::ByFacets => facets.get(&(interface, node)).copied().unwrap_or(rows),
        Weights::Consistent => rows,
    };
    rows.into_iter().map(|(node, (at, list))| (node, sum(&list, count(node, at, list.len())))).collect()
}

fn sum(rows: &[&Row], count: usize) -> NodeRelation {
    let share = 1.0 / count.max(1) as f64;
    let mut weights: BTreeMap<u32, f64> = BTreeMap::new();
    let (mut offset, mut opening) = ([0.0; 3], [0.0; 3]);
    for row in rows {
        row.weights.iter().for_each(|&(node, w)| *weights.entry(node).or_insert(0.0) += share * w);
        (0..3).for_each(|c| offset[c] += share * row.offset[c]);
        (0..3).for_each(|c| opening[c] += share * row.opening[c]);
    }
    NodeRelation { weights: weights.into_iter().collect(), offset, opening, normal: rows[0].normal }
}

impl NodeRelation {
    /// Whether the node follows more than one master or not quite one, which is so where the meshes are unlike.
    pub(super) fn is_mixed(&self) -> bool {
        !matches!(self.weights[..], [(_, weight)] if (weight - 1.0).abs() < 1e-6)
    }

    /// What the node is ahead of its masters: u¹ − B u², at a time level.
    pub(super) fn lead(&self, part: &ModelPart, node: u32, level: usize) -> [f64; 3] {
        let levels = part.nodes.history.get(DISPLACEMENT.name()).map_or(0, |field| field.levels.len());
        let displacement = part.nodes.history.values(&DISPLACEMENT, level.min(levels.saturating_sub(1)));
        let mut masters = [0.0; 3];
        for &(master, weight) in &self.weights {
            let u = vector(displacement, master);
            (0..3).for_each(|c| masters[c] += weight * u[c]);
        }
        sub(vector(displacement, node), masters)
    }

    /// The constraints that hold `node`; components that supports hold already are left to them.
    pub(super) fn constraints(
        &self,
        part: &ModelPart,
        node: u32,
        hold: Hold,
        next_id: &mut usize,
        out: &mut Vec<MasterSlaveConstraint>,
    ) {
        let dimension = part.info.domain_size;
        let offset = if part.info.step <= 1 { sub(self.offset, self.opening) } else { self.offset };
        let is_free = |c: usize| !part.dofs.is_fixed(DISPLACEMENT.component(c as u8), node);
        let mut push = |component: usize, masters, constant| {
            let slave = (node, DISPLACEMENT.component(component as u8));
            out.push(MasterSlaveConstraint { id: *next_id, slave, masters, constant, active: true });
            *next_id += 1;
        };
        let offset = if hold == Hold::Stick {
            let lead = self.lead(part, node, 1);
            let closing = dot(self.normal, sub(offset, lead));
            std::array::from_fn(|c| lead[c] + self.normal[c] * closing)
        } else {
            offset
        };
        match hold {
            Hold::All | Hold::Stick => {
                for c in (0..dimension).filter(|&c| is_free(c)) {
                    let masters = self.weights.iter().map(|&(m, w)| ((m, DISPLACEMENT.component(c as u8)), w));
                    push(c, masters.collect(), offset[c]);
                }
            }
            Hold::Normal => {
                let n = self.normal;
                let chosen = (0..dimension)
                    .filter(|&c| is_free(c) && n[c].abs() > HOLD)
                    .max_by(|&a, &b| n[a].abs().total_cmp(&n[b].abs()));
                let Some(chosen) = chosen else { return };
                let mut masters = Vec::new();
                for c in (0..dimension).filter(|&c| n[c].abs() > NEGLIGIBLE) {
                    let factor = n[c] / n[chosen];
                    let component = DISPLACEMENT.component(c as u8);
                    masters.extend(self.weights.iter().map(|&(m, w)| ((m, component), w * factor)));
                    if c != chosen {
                        masters.push(((node, component), -factor));
                    }
                }
                push(chosen, masters, dot(n, offset) / n[chosen]);
            }
        }
    }
}
