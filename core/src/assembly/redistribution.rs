//! Mass taken off nodes and handed on to the nodes below them.
//!
//! Forces that come and go at once, as those of contact, make velocities of nodes with mass jump, and time integration makes
//! energy of the jumps. Without mass such nodes follow in balance, and the motion is one of smooth forces (Khenous, Laborde,
//! Renard 2008; Hager, Hüeber, Wohlmuth 2008). Velocities there are those of the nodes below, extrapolated,
//!
//! v = P w, v_c = Σ w_ci v_i with Σ w_ci = 1 and Σ w_ci x_i = x_c, M_r = Pᵀ M P,
//!
//! so that mass, centre, inertia tensor, linear and angular momentum and kinetic energy of M_r and w are those of M and P w.

use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};
use zelus_linear_algebra::Csr;

use super::dof_table::DofTable;
use super::supports::supports;
use crate::StateMapper;
use crate::entities::MasslessNodes;
use crate::model::{ModelPart, Owner};

/// Massless nodes and unknowns, and the inertial nodes that carry their mass.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Redistribution {
    /// The nodes asked for.
    wanted: MasslessNodes,
    /// Nodes that are massless for the whole run.
    lasting: Vec<(u32, Vec<(u32, f64)>)>,
    /// Massless nodes, with the nodes below them and their weights.
    nodes: Vec<(u32, Vec<(u32, f64)>)>,
    /// Massless unknowns, with those below them and their weights.
    unknowns: Vec<(u32, Vec<(u32, f64)>)>,
    /// The rows of the massless unknowns in this rank's M.
    #[serde(skip)]
    rows: Vec<Vec<(u32, f64)>>,
}

impl Redistribution {
    /// Takes the mass off those of the `wanted` nodes that have enough other nodes below them; whether anything changes.
    ///
    /// Nodes of a surface need others below that are no part of it, and on two levels; those near contact make do with all that
    /// have mass now.
    pub(super) fn choose(&mut self, part: &ModelPart, wanted: &MasslessNodes) -> bool {
        if self.wanted == *wanted {
            return false;
        }
        if self.wanted.surface != wanted.surface {
            self.lasting = supports(part, &wanted.surface, &wanted.surface, true);
        }
        self.wanted = wanted.clone();
        let lasts = |node: &u32| self.lasting.binary_search_by_key(node, |(node, _)| *node).is_ok();
        let near: Vec<u32> = wanted.near.iter().copied().filter(|node| !lasts(node)).collect();
        let mut massless: Vec<u32> = self.lasting.iter().map(|(node, _)| *node).chain(near.iter().copied()).collect();
        massless.sort_unstable();
        let mut nodes = supports(part, &near, &massless, false);
        nodes.extend(self.lasting.iter().cloned());
        nodes.sort_by_key(|(node, _)| *node);
        let changed = nodes != self.nodes;
        self.nodes = nodes;
        changed
    }

    /// Whether it can be that of as many nodes and unknowns.
    pub(super) fn is_of(&self, nodes: usize, unknowns: usize) -> bool {
        let known = |count: usize, list: &[(u32, Vec<(u32, f64)>)]| {
            let below = list.iter().flat_map(|(_, below)| below.iter().map(|(item, _)| *item));
            below.chain(list.iter().map(|(item, _)| *item)).all(|item| (item as usize) < count)
        };
        let MasslessNodes { surface, near } = &self.wanted;
        surface.iter().chain(near).all(|&node| (node as usize) < nodes)
            && known(nodes, &self.lasting)
            && known(nodes, &self.nodes)
            && known(unknowns, &self.unknowns)
    }

    /// See [`State::remap`](crate::State::remap): the nodes are near surfaces, which all ranks have; unknowns are found anew.
    pub(super) fn remap(&mut self, mapper: &mut dyn StateMapper) {
        mapper.nodes(&mut self.wanted.surface);
        mapper.nodes(&mut self.wanted.near);
        for (node, below) in self.lasting.iter_mut().chain(&mut self.nodes) {
            mapper.nodes(std::slice::from_mut(node));
            mapper.node_list(below);
        }
        self.unknowns.clear();
    }

    /// Takes the mass off the unknowns of the massless nodes that are not prescribed (`free`); whether anything changes.
    pub(super) fn choose_unknowns(&mut self, dofs: &DofTable, free: impl Fn(usize) -> bool) -> bool {
        let mut unknowns = Vec::new();
        let of_node: FxHashMap<u32, &Vec<(u32, f64)>> = self.nodes.iter().map(|(node, list)| (*node, list)).collect();
        if !of_node.is_empty() {
            for (number, dof) in dofs.dofs().iter().enumerate().filter(|(_, dof)| !dof.multiplier) {
                let Some(below) = of_node.get(&dof.node).filter(|_| free(number)) else { continue };
                let numbers =
                    below.iter().map(|&(node, w)| Some((dofs.number_of(dof.variable, Owner::Node(node))?, w)));
                if let Some(list) = numbers.collect::<Option<Vec<_>>>() {
                    unknowns.push((number as u32, list));
                }
            }
        }
        let changed = unknowns != self.unknowns;
        self.unknowns = unknowns;
        changed
    }

    /// Whether all nodes have their own mass.
    pub(super) fn is_empty(&self) -> bool {
        self.unknowns.is_empty()
    }

    /// Nodes that carry a mass together, beside those of elements.
    pub(super) fn groups(&self, part: &ModelPart) -> Vec<Vec<u32>> {
        let below: FxHashMap<u32, &Vec<(u32, f64)>> = self.nodes.iter().map(|(node, list)| (*node, list)).collect();
        let mut out = Vec::new();
        for at in 0..part.elements.len() as u32 {
            let nodes = part.elements.nodes(at);
            if nodes.iter().any(|node| below.contains_key(node)) {
                let mut group = nodes.to_vec();
                let massless = nodes.iter().filter_map(|node| below.get(node));
                massless.for_each(|list| group.extend(list.iter().map(|(node, _)| *node)));
                group.sort_unstable();
                group.dedup();
                out.push(group);
            }
        }
        out
    }

    /// M becomes M_r = Pᵀ M P.
    pub(super) fn apply(&mut self, pattern: &Csr, values: &mut [f64]) {
        let below: FxHashMap<u32, &Vec<(u32, f64)>> = self.unknowns.iter().map(|(n, list)| (*n, list)).collect();
        self.rows.clear();
        for &(number, _) in &self.unknowns {
            let row = &values[pattern.row_starts[number as usize]..];
            let entries = pattern.columns_of(number as usize).iter().zip(row).map(|(&j, &value)| (j, value));
            let entries = entries.filter(|(_, value)| *value != 0.0);
            self.rows.push(entries.collect());
        }
        let at = |i: u32, j: u32| pattern.find(i as usize, j as usize).expect("the pattern holds the groups");
        for ((number, own), row) in self.unknowns.iter().zip(&self.rows) {
            for &(column, value) in row {
                values[at(*number, column)] = 0.0;
                match below.get(&column) {
                    Some(others) => own.iter().for_each(|&(i, weight)| {
                        others.iter().for_each(|&(j, other)| values[at(i, j)] += value * weight * other);
                    }),
                    None => {
                        values[at(column, *number)] = 0.0;
                        for &(i, weight) in own {
                            values[at(i, column)] += value * weight;
                            values[at(column, i)] += value * weight;
                        }
                    }
                }
            }
        }
    }

    /// v_c = Σ w_ci v_i: values of the massless unknowns from those below.
    pub(super) fn extrapolate(&self, values: &mut [f64]) {
        for (number, below) in &self.unknowns {
            values[*number as usize] = below.iter().map(|&(i, weight)| weight * values[i as usize]).sum();
        }
    }

    /// Pᵀ M (v − P v): the momentum of the excess of massless unknowns over the extrapolated values, handed on.
    pub(super) fn excess(&self, values: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; values.len()];
        for ((number, below), row) in self.unknowns.iter().zip(&self.rows) {
            let extrapolated: f64 = below.iter().map(|&(i, weight)| weight * values[i as usize]).sum();
            let excess = values[*number as usize] - extrapolated;
            row.iter().for_each(|&(column, mass)| out[column as usize] += mass * excess);
        }
        self.redistribute_forces(&mut out);
        out
    }

    /// Pᵀ f: forces on massless unknowns handed on to those below.
    pub(super) fn redistribute_forces(&self, forces: &mut [f64]) {
        for (number, below) in &self.unknowns {
            let force = std::mem::take(&mut forces[*number as usize]);
            below.iter().for_each(|&(i, weight)| forces[i as usize] += weight * force);
        }
    }
}

/// The diagonal of a matrix with this pattern; zero where it has none.
pub(super) fn diagonal(pattern: &Csr, values: &[f64]) -> Vec<f64> {
    (0..pattern.rows).map(|row| pattern.find(row, row).map_or(0.0, |at| values[at])).collect()
}
