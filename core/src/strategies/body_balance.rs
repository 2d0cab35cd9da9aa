//! Equilibrium of each body: its residual against the forces that act on it.
//!
//! A criterion over all unknowns refers to the residual at the start of the step, which may be that of a far stiffer body. So
//! each body b (connected elements) and unknown is looked at by itself, once the criterion is satisfied:
//!
//! ‖r‖_b ≤ tol · max(‖f_ext‖_b, ‖f_int‖_b, ‖f_contact‖_b, ‖f_inertia‖_b), and |Σ r|_b ≤ tol · max Σ|f|_b
//!
//! with the forces of supported unknowns among those of the right-hand side. Residuals no larger than round-off pass: of the terms
//! in the present state, or of the residual at the start of the step, which a body that is let go loses whole.

use super::account::Forces;
use super::criterion::is_round_off;
use super::whereabouts::body_of;
use crate::assembly::{Assembler, System};
use crate::model::{ModelPart, Rates, bodies_of_nodes};
use crate::vector3::norm;

/// Kinds of forces that act: loads, elements, interactions, inertia.
const KINDS: usize = 4;
/// Sums of a group: r², Σ r by component, f² by kind, Σ|f| by kind, r² at the start of the step.
const SUMS: usize = 5 + 2 * KINDS;
/// Place of the last of them.
const START: usize = SUMS - 1;
/// Share of the residual at the start of the step that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// A body that is out of balance.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Imbalance {
    /// The body, in words.
    body: String,
    /// The unknown, e.g. DISPLACEMENT.
    unknown: &'static str,
    /// Residual by the largest of the forces.
    pub ratio: f64,
    /// Largest ratio that is accepted.
    pub tolerance: f64,
}

impl Imbalance {
    /// The fact, in words.
    pub fn fact(&self) -> String {
        let Self { body, unknown, ratio, tolerance } = self;
        let kind = match Rates::of(unknown) {
            Some(rates) if rates.moves_mesh => "forces",
            _ => "flows",
        };
        format!(
            "{kind} of {unknown} on {body} are out of balance by {ratio:.1e} of the largest of them (tol {tolerance:.0e})"
        )
    }
}

/// The bodies of a part; alike on all ranks but for `of_node`.
pub(super) struct Bodies {
    /// Place of the body of each node; those behind the last for nodes of none.
    of_node: Vec<usize>,
    /// Id of the first node of each body.
    names: Vec<usize>,
}

impl Bodies {
    /// The bodies of connected elements; collective.
    pub fn of(part: &ModelPart) -> Self {
        let found = bodies_of_nodes(part);
        let mut own: Vec<usize> = found.iter().copied().flatten().collect();
        own.sort_unstable();
        own.dedup();
        let flat: Vec<f64> = own.iter().map(|&name| name as f64).collect();
        let mut names: Vec<usize> =
            part.ranks.gather_numbers(&flat).concat().iter().map(|&name| name as usize).collect();
        names.sort_unstable();
        names.dedup();
        let place = |name: Option<usize>| name.and_then(|name| names.binary_search(&name).ok());
        let of_node = found.into_iter().map(|name| place(name).unwrap_or(names.len())).collect();
        Self { of_node, names }
    }

    /// The body that is farthest out of balance beyond `tolerance`; `None` where each is in balance. Residuals are those that the
    /// equations see, now and at the start of the step. Collective.
    pub fn imbalance(
        &self,
        part: &ModelPart,
        system: &System,
        assembler: &Assembler,
        [balanced, start]: [&[f64]; 2],
        forces: &Forces,
        tolerance: f64,
    ) -> Option<Imbalance> {
        let mut columns: Vec<&'static str> = system.dofs.variables().map(|variable| variable.column).collect();
        columns.dedup();
        let group = |n: usize| {
            let dof = &system.dofs.dofs()[n];
            let body = if dof.multiplier { None } else { Some(self.of_node[dof.node as usize]) };
            let column = columns.iter().position(|column| *column == dof.variable.column).expect("one of them");
            body.filter(|_| assembler.counts(n)).map(|body| (body * columns.len() + column, dof.variable.offset()))
        };
        let groups: Vec<Option<(usize, usize)>> = (0..system.dofs.len()).map(group).collect();
        let count = (self.names.len() + 1) * columns.len();
        let mut sums = vec![0.0; count * SUMS];
        for (n, &(group, _)) in groups.iter().enumerate().filter_map(|(n, group)| Some((n, group.as_ref()?))) {
            let own = &mut sums[group * SUMS..][..SUMS];
            for (kind, of_kind) in forces[..KINDS].iter().enumerate() {
                own[4 + kind] += of_kind[n] * of_kind[n];
                own[4 + KINDS + kind] += of_kind[n].abs();
            }
        }
        for &n in assembler.equations().unknowns() {
            let Some((group, component)) = groups[n as usize] else { continue };
            let own = &mut sums[group * SUMS..][..SUMS];
            own[0] += balanced[n as usize] * balanced[n as usize];
            own[1 + component] += balanced[n as usize];
            own[START] += start[n as usize] * start[n as usize];
        }
        part.ranks.sum(&mut sums);
        let ratio = |own: &[f64]| {
            let largest = |terms: &[f64]| terms.iter().copied().fold(0.0, f64::max);
            let by_norm = own[0].sqrt() / largest(&own[4..4 + KINDS]).sqrt().max(f64::MIN_POSITIVE);
            let by_sum = norm([own[1], own[2], own[3]]) / largest(&own[4 + KINDS..START]).max(f64::MIN_POSITIVE);
            by_norm.max(by_sum)
        };
        let mut beyond: Vec<(usize, f64)> = sums.chunks_exact(SUMS).map(ratio).enumerate().collect();
        let falls = |group: usize| sums[group * SUMS] <= ROUND_OFF * ROUND_OFF * sums[group * SUMS + START];
        beyond.retain(|&(group, ratio)| ratio > tolerance && !falls(group));
        if beyond.is_empty() {
            return None;
        }
        let round_off = self.round_off(part, system, assembler, &groups, count);
        beyond.retain(|&(group, _)| !is_round_off(sums[group * SUMS].sqrt(), round_off[group]));
        let (group, ratio) = beyond.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let body = self.name(part, group / columns.len());
        Some(Imbalance { body, unknown: columns[group % columns.len()], ratio, tolerance })
    }

    /// Norm of the round-off of the residuals of each group; collective.
    fn round_off(
        &self,
        part: &ModelPart,
        system: &System,
        assembler: &Assembler,
        groups: &[Option<(usize, usize)>],
        count: usize,
    ) -> Vec<f64> {
        let mut squares = vec![0.0; count];
        let sizes = assembler.round_off(part, system);
        for &n in assembler.equations().unknowns() {
            if let Some((group, _)) = groups[n as usize] {
                squares[group] += sizes[n as usize] * sizes[n as usize];
            }
        }
        part.ranks.sum(&mut squares);
        squares.into_iter().map(f64::sqrt).collect()
    }

    /// The body in words: its smallest part and first node. Collective.
    fn name(&self, part: &ModelPart, body: usize) -> String {
        let Some(&id) = self.names.get(body) else { return "nodes without elements".to_owned() };
        let node = part.nodes.find(id).filter(|&node| part.owns_node(node as usize));
        let said = node.map(|node| match body_of(&part.tree, node) {
            Some(name) => format!("the body of part {name} with node {id}"),
            None => format!("the body of node {id}"),
        });
        part.ranks.first_to_say(said).unwrap_or_else(|| format!("the body of node {id}"))
    }
}
