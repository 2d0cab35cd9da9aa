//! Extremes of the results of a part over its nodes, with their places.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::gauss::scalars_at_nodes;
use super::quantity::GaussQuantity;
use super::usual::{history, values};
use crate::assembly::System;
use crate::io::results::Column;
use crate::model::{ModelPart, UsualResults};

/// A result at the node where it is largest or smallest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Extreme {
    /// Value there: of vectors the size.
    pub value: f64,
    /// Id of the node; of several the first.
    pub node: usize,
    /// Initial position of the node.
    pub place: [f64; 3],
}

/// Extremes by the names of results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Extremes {
    /// The largest size of each default output variable, and the largest value of scalars of the stress.
    pub largest: BTreeMap<String, Extreme>,
    /// The smallest value of scalars of which that is asked for, e.g. a safety factor.
    pub smallest: BTreeMap<String, Extreme>,
}

impl Extremes {
    /// Extremes of a part over all ranks; collective.
    pub fn of(part: &ModelPart, system: &System) -> Self {
        let nodes: Vec<u32> = (0..part.nodes.len() as u32).collect();
        let size = |column: &Column, row: usize| {
            let components = column.components.max(1);
            let entries = (row * components..(row + 1) * components).map(|at| column.values.get(at));
            entries.map(|x| x * x).sum::<f64>().sqrt()
        };
        let unknowns = history(part).into_iter().map(|quantity| quantity.gather(&part.nodes.history, &nodes));
        let found = values(part).into_iter().map(|quantity| quantity.gather(&part.nodes.values, &nodes));
        let mut out = Self::default();
        for column in unknowns.chain(found) {
            let found = extreme(part, 1.0, |node| Some(size(&column, node)));
            out.largest.extend(found.map(|found| (column.name.clone(), found)));
        }
        let mut of_stress =
            |names: Vec<&'static str>, sign: f64, into: fn(&mut Self) -> &mut BTreeMap<String, Extreme>| {
                for quantity in names.into_iter().filter_map(|name| GaussQuantity::new(name).ok()) {
                    let at_nodes = scalars_at_nodes(part, system, &quantity);
                    let found = extreme(part, sign, |node| at_nodes[node]);
                    into(&mut out).extend(found.map(|found| (quantity.name.clone(), found)));
                }
            };
        of_stress(UsualResults::largest(), 1.0, |own| &mut own.largest);
        of_stress(UsualResults::smallest(), -1.0, |own| &mut own.smallest);
        out
    }
}

/// The node with the largest of `sign` times a value, of several the first by id; `None` where no node has one. Collective.
fn extreme(part: &ModelPart, sign: f64, value: impl Fn(usize) -> Option<f64>) -> Option<Extreme> {
    let mut best: Option<(f64, usize)> = None;
    for node in (0..part.nodes.len()).filter(|&node| part.owns_node(node)) {
        let Some(value) = value(node) else { continue };
        if best.is_none_or(|(other, _)| sign * value > sign * other) {
            best = Some((value, node));
        }
    }
    let own = best.map(|(value, node)| {
        let [x, y, z] = part.nodes.initial[node];
        vec![value, part.nodes.ids[node] as f64, x, y, z]
    });
    let all = part.ranks.gather_numbers(&own.unwrap_or_default()).concat();
    let found = all.chunks_exact(5).map(|own| Extreme {
        value: own[0],
        node: own[1] as usize,
        place: [own[2], own[3], own[4]],
    });
    found.reduce(|best, other| {
        let is_before = sign * other.value > sign * best.value || other.value == best.value && other.node < best.node;
        if is_before { other } else { best }
    })
}
