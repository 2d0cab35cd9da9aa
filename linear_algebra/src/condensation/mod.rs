//! Multipliers eliminated node by node, which leaves a system of the other unknowns that iterative engines can solve.
//!
//! In `K [u; λ] = b` let the multipliers of a node act on the equations of that node, its own and its conditions, and
//! otherwise only on equations of nodes without multipliers: dual multipliers do, whose D is diagonal by node. With the
//! rows `K_S u + G λ_j = b_S` of node j (`node.rs`) and `L = R⁻¹ Q₁ᵀ`
//!
//! - `λ_j = L (b_S − K_S u)`, the recovery;
//! - `W K_S u = W b_S` in place of the node's own equations: the part of its equations without its multipliers, and its conditions;
//! - `(K_i − Σ_j B_ij L_j K_Sj) u = b_i − Σ_j B_ij L_j b_Sj` for the rows i of masters, which see multipliers by `B_ij`.
//!
//! Multipliers that do not act on their own node, as those of inactive ones, follow from their conditions alone: that node
//! counts as one without multipliers and keeps its equations. The system that is left is square and
//! in general not symmetric. Nothing is lumped: entries of multipliers on other nodes' equations are measured against
//! those on their own, and beyond a tolerance the condensation is refused; smaller ones are left out of the system, and
//! correction steps on the whole matrix make up for it.

mod node;
mod row;

use crate::csr::Csr;
use crate::system::{Layout, Symmetry, System};
use node::NodeElimination;
use row::SparseRow;

/// When multipliers may be condensed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CondensationSettings {
    /// Largest entry of a multiplier on other nodes with multipliers, relative to that on its own node.
    pub off_node: f64,
    /// Share of a multiplier's largest entry that its own node must see to determine it.
    pub zero_row: f64,
    /// Whether the whole system is solved where they may not; an error otherwise.
    pub fallback: bool,
}

impl Default for CondensationSettings {
    fn default() -> Self {
        Self { off_node: 1e-6, zero_row: 1e-12, fallback: true }
    }
}

/// Why multipliers cannot be condensed, with the equations to blame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NotCondensable {
    /// A multiplier acts on the equation of another node with multipliers.
    OffNode {
        /// Equation of the multiplier.
        multiplier: usize,
        /// The equation of the other node.
        equation: usize,
        /// Size of the entry relative to the largest one on the multiplier's own node.
        share: f64,
    },
    /// The equations of its node do not determine a multiplier, as where its displacement is prescribed.
    Undetermined {
        /// Equation of the multiplier.
        multiplier: usize,
        /// Share of its largest entry that the node sees.
        share: f64,
    },
}

impl std::fmt::Display for NotCondensable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::OffNode { multiplier, equation, share } => {
                write!(
                    f,
                    "multiplier {multiplier} acts on equation {equation} of another node ({share:.1e} of its own)"
                )
            }
            Self::Undetermined { multiplier, share } => {
                write!(f, "its node does not determine multiplier {multiplier} ({share:.1e} of its largest entry)")
            }
        }
    }
}

/// A system whose multipliers are eliminated, and the way back.
#[derive(Debug, Clone, PartialEq)]
pub struct Condensation {
    matrix: Csr,
    layout: Layout,
    symmetry: Symmetry,
    /// Equation of the whole system of each equation left.
    kept: Vec<u32>,
    groups: Vec<NodeGroup>,
    /// Entries of multipliers in the equations of nodes without: equation left, multiplier, value.
    master_couplings: Vec<(u32, u32, f64)>,
    stamp: u64,
}

/// The equations of a node with multipliers.
#[derive(Debug, Clone, PartialEq)]
struct NodeGroup {
    /// Equations of the whole system, its own before those of its multipliers.
    equations: Vec<u32>,
    /// Number of its own; none where the multipliers do not act on them.
    own: usize,
    elimination: NodeElimination,
    /// `L K_S` of each multiplier: equations left and values.
    recovery: Vec<Vec<(u32, f64)>>,
}

const NONE: u32 = u32::MAX;

/// Where each equation is.
struct EquationPlaces {
    /// Number among the equations left; [`NONE`] for a multiplier.
    left: Vec<u32>,
    /// Group of each equation; [`NONE`] where no multiplier of its node acts.
    group: Vec<u32>,
}

impl Condensation {
    /// Eliminates the multipliers of `system`; `stamp` tells it from condensations of other matrices.
    ///
    /// # Errors
    /// The worst entry of a multiplier on other nodes, else the first multiplier that its node does not determine.
    pub fn new(system: &System<'_>, settings: &CondensationSettings, stamp: u64) -> Result<Self, NotCondensable> {
        let layout = system.layout;
        let n = system.equations();
        let (lists, group) = groups(system);
        let mut left = vec![NONE; n];
        let kept: Vec<u32> = (0..n as u32).filter(|&i| !layout.multiplier[i as usize]).collect();
        kept.iter().enumerate().for_each(|(at, &i)| left[i as usize] = at as u32);
        let places = EquationPlaces { left, group };
        let largest = columns_of_multipliers(system, &places, settings.off_node)?;
        let mut row = SparseRow::new(kept.len());
        let mut found = Vec::with_capacity(lists.len());
        for equations in lists {
            found.push(eliminate(system, &places, &largest, settings.zero_row, equations, &mut row)?);
        }
        let mut master_couplings = Vec::new();
        let mut matrix = Csr::empty(kept.len());
        matrix.columns.reserve(system.bulk.entries());
        matrix.values.reserve(system.bulk.entries());
        let mut touched = couples(system);
        for (at, &equation) in kept.iter().enumerate() {
            let i = equation as usize;
            if places.group[i] == NONE {
                if copy(system, i, &places.left, &mut matrix) {
                    continue;
                }
                let first = master_couplings.len();
                row.add_equation(system, i, 1.0, &places.left, |multiplier, value| {
                    master_couplings.push((at as u32, multiplier as u32, value));
                });
                for &(_, multiplier, value) in &master_couplings[first..] {
                    touched = true;
                    let group = &found[places.group[multiplier as usize] as usize];
                    row.add(&group.recovery[group.place(multiplier)], -value);
                }
            } else {
                touched = true;
                let group = &found[places.group[i] as usize];
                for (&e, &factor) in group.equations.iter().zip(group.row(equation)) {
                    row.add_equation(system, e as usize, factor, &places.left, |_, _| {});
                }
            }
            row.finish(&mut matrix, at);
        }
        Ok(Self {
            matrix,
            layout: Layout {
                node: kept.iter().map(|&i| layout.node[i as usize]).collect(),
                multiplier: vec![false; kept.len()],
                near_null_space: layout
                    .near_null_space
                    .iter()
                    .map(|vector| kept.iter().map(|&i| vector[i as usize]).collect())
                    .collect(),
                ..Layout::default()
            },
            symmetry: if touched { Symmetry::General } else { system.bulk_symmetry },
            kept,
            groups: found,
            master_couplings,
            stamp,
        })
    }

    /// The system that is left.
    pub fn system(&self) -> System<'_> {
        let plain = System::bulk(&self.layout, &self.matrix, self.symmetry);
        System { bulk_graph: self.stamp, bulk_values: self.stamp, ..plain }
    }

    /// Equation of the whole system of each equation left, ascending.
    pub fn equations(&self) -> &[u32] {
        &self.kept
    }

    /// Right-hand side of the system that is left, for one of the whole system.
    ///
    /// # Panics
    /// When `rhs` has not one entry for each equation of the whole system.
    pub fn reduce(&self, rhs: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> = self.kept.iter().map(|&i| rhs[i as usize]).collect();
        let mut multipliers = vec![0.0; rhs.len()];
        for group in &self.groups {
            group.recover(rhs, |_| 0.0, &mut multipliers);
            for &equation in &group.equations[..group.own] {
                let at = self.kept.partition_point(|&i| i < equation);
                out[at] = group.times(group.row(equation), rhs);
            }
        }
        for &(at, multiplier, value) in &self.master_couplings {
            out[at as usize] -= value * multipliers[multiplier as usize];
        }
        out
    }

    /// Solution of the whole system with right-hand side `rhs`, for one of the system that is left.
    ///
    /// # Panics
    /// When a length does not fit.
    pub fn expand(&self, rhs: &[f64], left: &[f64], x: &mut [f64]) {
        self.kept.iter().zip(left).for_each(|(&i, value)| x[i as usize] = *value);
        for group in &self.groups {
            let of = |m: usize| group.recovery[m].iter().map(|&(at, l)| l * left[at as usize]).sum();
            group.recover(rhs, of, x);
        }
    }
}

impl NodeGroup {
    fn place(&self, multiplier: u32) -> usize {
        self.equations[self.own..].iter().position(|&e| e == multiplier).expect("a multiplier of the group")
    }

    /// Factors of the group's equations in the one that replaces `equation`.
    fn row(&self, equation: u32) -> &[f64] {
        let own = self.equations[..self.own].iter().position(|&e| e == equation).expect("an own equation");
        let s = self.equations.len();
        &self.elimination.equations[own * s..(own + 1) * s]
    }

    fn times(&self, factors: &[f64], rhs: &[f64]) -> f64 {
        factors.iter().zip(&self.equations).map(|(factor, &e)| factor * rhs[e as usize]).sum()
    }

    /// Writes `L b_S` less `of` each multiplier.
    fn recover(&self, rhs: &[f64], of: impl Fn(usize) -> f64, x: &mut [f64]) {
        let s = self.equations.len();
        for (m, &multiplier) in self.equations[self.own..].iter().enumerate() {
            let known = self.times(&self.elimination.recovery[m * s..(m + 1) * s], rhs);
            x[multiplier as usize] = known - of(m);
        }
    }
}

/// Equations of each node with multipliers, its own first where these act on them, and the group of each equation.
fn groups(system: &System<'_>) -> (Vec<Vec<u32>>, Vec<u32>) {
    let layout = system.layout;
    let n = layout.equations();
    let mut of_node = std::collections::BTreeMap::new();
    for i in (0..n).filter(|&i| layout.multiplier[i]) {
        let next = of_node.len();
        of_node.entry(layout.node[i]).or_insert(next);
    }
    let mut acts = vec![false; of_node.len()];
    for i in (0..n).filter(|&i| !layout.multiplier[i]) {
        if let Some(&at) = of_node.get(&layout.node[i]) {
            acts[at] |= system.row(i).any(|(j, _)| layout.multiplier[j] && layout.node[j] == layout.node[i]);
        }
    }
    let mut group = vec![NONE; n];
    let mut lists = vec![Vec::new(); of_node.len()];
    for multipliers in [false, true] {
        for i in (0..n).filter(|&i| layout.multiplier[i] == multipliers) {
            if let Some(&at) = of_node.get(&layout.node[i])
                && (multipliers || acts[at])
            {
                lists[at].push(i as u32);
                group[i] = at as u32;
            }
        }
    }
    (lists, group)
}

/// Copies an equation of the bulk alone that has its diagonal; `false`, and nothing done, for any other.
fn copy(system: &System<'_>, i: usize, left: &[u32], matrix: &mut Csr) -> bool {
    let (columns, values) = system.bulk.row(i);
    let is_plain = system.active_coupling().is_none_or(|coupling| coupling.row(i).0.is_empty());
    if !is_plain || columns.binary_search(&(i as u32)).is_err() || columns.iter().any(|&j| left[j as usize] == NONE) {
        return false;
    }
    matrix.columns.extend(columns.iter().map(|&j| left[j as usize]));
    matrix.values.extend_from_slice(values);
    matrix.row_starts[left[i] as usize + 1] = matrix.columns.len();
    true
}

/// Whether the coupling has entries among unknowns that are no multipliers.
fn couples(system: &System<'_>) -> bool {
    let is_multiplier = |i: usize| system.layout.multiplier[i];
    system.active_coupling().is_some_and(|coupling| {
        (0..coupling.rows).filter(|&i| !is_multiplier(i)).any(|i| {
            let (columns, values) = coupling.row(i);
            columns.iter().zip(values).any(|(&j, value)| *value != 0.0 && !is_multiplier(j as usize))
        })
    })
}

/// Largest entry of each multiplier's column, once no multiplier acts on other nodes with multipliers.
fn columns_of_multipliers(
    system: &System<'_>,
    places: &EquationPlaces,
    tolerance: f64,
) -> Result<Vec<f64>, NotCondensable> {
    let n = system.equations();
    let mut largest = vec![0.0_f64; n];
    let mut own = vec![0.0_f64; n];
    let mut off: Vec<(f64, u32)> = vec![(0.0, NONE); n];
    for i in 0..n {
        for (j, value) in system.row(i).filter(|&(j, _)| system.layout.multiplier[j]) {
            let size = value.abs();
            largest[j] = largest[j].max(size);
            if places.group[i] == places.group[j] {
                own[j] = own[j].max(size);
            } else if places.group[i] != NONE && size > off[j].0 {
                off[j] = (size, i as u32);
            }
        }
    }
    let share = |j: usize| if own[j] > 0.0 { off[j].0 / own[j] } else { f64::INFINITY };
    let worst = (0..n).filter(|&j| off[j].0 > tolerance * own[j]).max_by(|&a, &b| share(a).total_cmp(&share(b)));
    match worst {
        Some(j) => Err(NotCondensable::OffNode { multiplier: j, equation: off[j].1 as usize, share: share(j) }),
        None => Ok(largest),
    }
}

fn eliminate(
    system: &System<'_>,
    places: &EquationPlaces,
    largest: &[f64],
    zero_row: f64,
    equations: Vec<u32>,
    row: &mut SparseRow,
) -> Result<NodeGroup, NotCondensable> {
    let own = equations.iter().filter(|&&e| !system.layout.multiplier[e as usize]).count();
    let (s, m) = (equations.len(), equations.len() - own);
    let (mut g, mut h) = (vec![0.0; s * m], vec![0.0; s * own]);
    let mut alpha = 0.0_f64;
    for (p, &e) in equations.iter().enumerate() {
        for (j, value) in system.row(e as usize).filter(|&(j, _)| places.group[j] == places.group[e as usize]) {
            let at = equations.iter().position(|&e| e as usize == j).expect("an equation of the group");
            if at < own {
                h[p * own + at] += value;
            } else {
                g[p * m + at - own] += value;
            }
        }
        if p < own {
            alpha = alpha.max(h[p * own + p].abs());
        }
    }
    let alpha = if alpha > 0.0 { alpha } else { 1.0 };
    let size: Vec<f64> = equations[own..].iter().map(|&e| largest[e as usize]).collect();
    let elimination = node::eliminate(&g, &h, [own, m], &size, alpha, zero_row)
        .map_err(|(at, share)| NotCondensable::Undetermined { multiplier: equations[own + at] as usize, share })?;
    let recovery = (0..m)
        .map(|at| {
            for (&e, &factor) in equations.iter().zip(&elimination.recovery[at * s..(at + 1) * s]) {
                row.add_equation(system, e as usize, factor, &places.left, |_, _| {});
            }
            row.take()
        })
        .collect();
    Ok(NodeGroup { equations, own, elimination, recovery })
}
