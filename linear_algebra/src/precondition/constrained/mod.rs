//! Multigrid for systems with multipliers: these leave by the constraints themselves.
//!
//! Let the multipliers of a node act on its own equations and else on those of masters, as dual multipliers do. Then
//! ([`group`]) the conditions that hold no multiplier prescribe some motions of the node, `u = T û + u_p`, its equations
//! give its multipliers, and what is left of them is one equation for each motion that is not prescribed: `L K T û`.
//! For symmetric systems without friction `L = Tᵀ`, and the matrix stays symmetric and positive definite. Each node keeps
//! its number of unknowns: those prescribed become equations of their own on the diagonal, so that blocks stay of one size.
//!
//! Processes that share a system do this for the nodes with multipliers of their own and for those beside their rows, whose
//! rows they have, too; so each makes its own rows of the blocks, and what is left to exchange are vectors.
//!
//! This is a preconditioner of the whole system: what it leaves out, such as entries of multipliers on other nodes with
//! multipliers, costs iterations and no accuracy.

mod group;

use std::sync::Arc;

use rayon::prelude::*;

use super::block_matrix::{BlockMatrix, BlockRow, Sums};
use super::blocks::Blocks;
use super::multigrid::Multigrid;
use crate::ghosts::{Ghosts, Owned};
use crate::memory;
use crate::system::System;
use group::GroupElimination;

const NONE: u32 = u32::MAX;
/// Share of a condition's largest entry from which on its multiplier follows from it.
const DETERMINES: f64 = 1e-8;

/// The multipliers of one node.
struct Group {
    /// Equations of the node's unknowns.
    own: Vec<u32>,
    /// Multipliers that act on them.
    multipliers: Vec<u32>,
    elimination: GroupElimination,
    /// Factor of each condition that brings it to the size of forces by displacements.
    scales: Vec<f64>,
    /// Size of a multiplier's entries on its node.
    action: f64,
    /// Size of the node's diagonal.
    stiffness: f64,
    /// `N₀ C` on the unknowns of masters, for each prescribed motion.
    masters: Vec<Vec<(u32, f64)>>,
}

/// How a system with multipliers becomes one of node blocks without them.
pub(crate) struct Constrained {
    /// Unknowns of a node block.
    width: usize,
    /// Place of each equation among those of the blocks; multipliers have none.
    place: Vec<u32>,
    /// Equation at each place; places beyond a node's unknowns have none.
    equation: Vec<u32>,
    groups: Vec<Group>,
    /// Group of each own equation and each of its multipliers.
    group_of: Vec<u32>,
    /// Equations of masters with the entries of multipliers in them.
    loads: Vec<(u32, Vec<(u32, f64)>)>,
    /// Equations with entries of unknowns that groups prescribe.
    beside: Vec<u32>,
    /// Multipliers that follow from their condition alone, with their diagonal.
    idle: Vec<(u32, f64)>,
    /// Factor of each equation that brings it to the size of forces.
    pub(crate) row_scales: Vec<f64>,
    /// Who has which equations, and which blocks.
    ghosts: Ghosts,
    blocks: Ghosts,
}

/// Who has which blocks, those of own equations before others'; collective.
fn shared_blocks(ghosts: &Ghosts, place: &[u32], equation: &[u32], width: usize, own: usize) -> Ghosts {
    let Some(processes) = ghosts.processes() else { return Ghosts::none(own) };
    // The block of each equation, as its owner counts them.
    let mut block: Vec<f64> =
        place.iter().map(|&p| if p == NONE { -1.0 } else { f64::from(p / width as u32) }).collect();
    ghosts.spread(&mut block, 1);
    let mut owned: Vec<Owned> = vec![(0, 0); equation.len() / width - own];
    for &(e, (owner, _)) in ghosts.owned().iter().filter(|(e, _)| place[*e as usize] != NONE) {
        owned[place[e as usize] as usize / width - own] = (owner, block[e as usize] as u32);
    }
    Ghosts::after(processes.clone(), own, &owned)
}

/// Columns of a row of both parts of a system, zeros among them.
fn pattern(system: &System<'_>, i: usize) -> Vec<u32> {
    let bulk = Some(system.bulk).filter(|bulk| i < bulk.rows);
    let mut columns = bulk.map_or(Vec::new(), |bulk| bulk.row(i).0.to_vec());
    columns.extend(system.active_coupling().into_iter().flat_map(|coupling| coupling.row(i).0));
    columns
}

/// Terms with the factors of equal indices added up, ascending.
fn summed(mut terms: Vec<(u32, f64)>) -> Vec<(u32, f64)> {
    terms.sort_by_key(|(at, _)| *at);
    terms.dedup_by(|(at, value), (kept, sum)| {
        let is_same = at == kept;
        if is_same {
            *sum += *value;
        }
        is_same
    });
    terms
}

/// Sum of the entries of a row in one column.
fn entry(system: &System<'_>, i: usize, j: usize) -> f64 {
    let bulk = if i < system.bulk.rows { system.bulk.get(i, j) } else { 0.0 };
    bulk + system.active_coupling().map_or(0.0, |coupling| coupling.get(i, j))
}

impl Constrained {
    /// The blocks of a system; collective.
    ///
    /// # Errors
    /// The equation of a multiplier that neither a node nor its condition determines, here.
    pub(crate) fn new(system: &System<'_>) -> Result<Self, usize> {
        let layout = system.layout;
        let n = layout.equations();
        let nodes = layout.node.iter().max().map_or(0, |&node| node as usize + 1);
        let mut count = vec![0_u32; nodes];
        let mut slot = vec![NONE; n];
        let ghosts = system.ghosts();
        // Own nodes come first, then those of ghosts; nothing is known of others.
        let is_own = ghosts.is_own();
        let mut has_place: Vec<bool> = (0..n).map(|i| is_own[i] && !layout.multiplier[i]).collect();
        ghosts.owned().iter().for_each(|&(i, _)| has_place[i as usize] = !layout.multiplier[i as usize]);
        let mut owns = vec![false; nodes];
        for i in (0..n).filter(|&i| has_place[i]) {
            slot[i] = count[layout.node[i] as usize];
            count[layout.node[i] as usize] += 1;
            owns[layout.node[i] as usize] |= is_own[i];
        }
        let width = ghosts.largest(f64::from(count.iter().max().copied().unwrap_or(0).max(1))) as usize;
        let mut block = vec![NONE; nodes];
        let mut blocks = 0;
        let mut own_blocks = 0;
        for own in [true, false] {
            for node in (0..nodes).filter(|&node| count[node] > 0 && owns[node] == own) {
                block[node] = blocks;
                blocks += 1;
            }
            own_blocks = if own { blocks } else { own_blocks };
        }
        let mut equation = vec![NONE; blocks as usize * width];
        let mut place = vec![NONE; n];
        for i in (0..n).filter(|&i| has_place[i]) {
            place[i] = block[layout.node[i] as usize] * width as u32 + slot[i];
            equation[place[i] as usize] = i as u32;
        }
        let of_blocks = shared_blocks(&ghosts, &place, &equation, width, own_blocks as usize);
        let mut made = Self {
            width,
            place,
            equation,
            groups: Vec::new(),
            group_of: vec![NONE; n],
            loads: Vec::new(),
            beside: Vec::new(),
            idle: Vec::new(),
            row_scales: vec![1.0; n],
            ghosts,
            blocks: of_blocks,
        };
        if layout.multiplier.contains(&true) {
            made.find_groups(system, &block)?;
            made.find_neighbours(system);
        }
        Ok(made)
    }

    /// Eliminates the multipliers of each node.
    fn find_groups(&mut self, system: &System<'_>, block: &[u32]) -> Result<(), usize> {
        let layout = system.layout;
        let mut of_node = std::collections::BTreeMap::<u32, Vec<u32>>::new();
        // Those of others whose rows are not here act on none that are.
        let is_own = self.ghosts.is_own();
        let is_known = |i: usize| is_own[i] || system.row(i).next().is_some();
        for i in (0..layout.equations()).filter(|&i| layout.multiplier[i] && is_known(i)) {
            of_node.entry(layout.node[i]).or_default().push(i as u32);
        }
        let mut lone = Vec::new();
        for (node, multipliers) in of_node {
            let own: Vec<u32> = match block[node as usize] {
                NONE => Vec::new(),
                b => {
                    (0..self.width).map(|k| self.equation[b as usize * self.width + k]).filter(|&e| e != NONE).collect()
                }
            };
            let action = |m: u32| own.iter().fold(0.0_f64, |s, &e| s.max(entry(system, e as usize, m as usize).abs()));
            let largest = multipliers.iter().fold(0.0_f64, |s, &m| s.max(action(m)));
            // One that acts on nothing belongs to those whose conditions know it.
            let is_known_to = |m: u32, n: u32| m != n && entry(system, n as usize, m as usize) != 0.0;
            let joins = |m: u32| action(m) > 1e-10 * largest || multipliers.iter().any(|&n| is_known_to(m, n));
            let (acting, idle): (Vec<u32>, Vec<u32>) = multipliers.iter().partition(|&&m| largest > 0.0 && joins(m));
            for m in idle {
                let diagonal = entry(system, m as usize, m as usize);
                let size = system.row(m as usize).fold(0.0_f64, |s, (_, v)| s.max(v.abs()));
                if diagonal.abs() > DETERMINES * size {
                    self.idle.push((m, diagonal));
                    self.row_scales[m as usize] = 1.0 / diagonal.abs();
                } else {
                    lone.push(m);
                }
            }
            if acting.is_empty() {
                continue;
            }
            let group = self.group(system, own, acting, largest)?;
            self.add_group(group);
        }
        for m in lone {
            if self.ghosts.processes().is_some() {
                // What carries it depends on what carries others, which may be elsewhere.
                return Err(m as usize);
            }
            let (master, action) = self.carrier(system, m).ok_or(m as usize)?;
            let group = self.group(system, vec![master], vec![m], action)?;
            self.add_group(group);
        }
        Ok(())
    }

    /// The unknown that a multiplier prescribes whose own node is held: of those in no group the one it moves most, and the
    /// size of its entry there.
    fn carrier(&self, system: &System<'_>, multiplier: u32) -> Option<(u32, f64)> {
        let m = multiplier as usize;
        let mut best: Option<(u32, f64, f64)> = None;
        for (j, c) in system.row(m).filter(|&(j, _)| !system.layout.multiplier[j] && self.group_of[j] == NONE) {
            let action = entry(system, j, m).abs();
            if best.is_none_or(|(_, _, most)| action * c.abs() > most) && action > 0.0 {
                best = Some((j as u32, action, action * c.abs()));
            }
        }
        best.map(|(j, action, _)| (j, action))
    }

    fn add_group(&mut self, group: Group) {
        let at = self.groups.len() as u32;
        group.own.iter().chain(&group.multipliers).for_each(|&e| self.group_of[e as usize] = at);
        for (&m, scale) in group.multipliers.iter().zip(&group.scales) {
            self.row_scales[m as usize] = scale * group.stiffness;
        }
        self.groups.push(group);
    }

    fn group(&self, system: &System<'_>, own: Vec<u32>, multipliers: Vec<u32>, action: f64) -> Result<Group, usize> {
        let (d, m) = (own.len(), multipliers.len());
        let of = |i: u32, j: u32| entry(system, i as usize, j as usize);
        let stiffness = own.iter().fold(0.0_f64, |s, &e| s.max(of(e, e).abs()));
        let stiffness = if stiffness > 0.0 { stiffness } else { 1.0 };
        let a: Vec<f64> = (0..d * m).map(|at| of(own[at / m], multipliers[at % m]) / action).collect();
        // A displacement of one makes forces of the size `stiffness`, a multiplier of one those of `action`.
        let mut scales = Vec::with_capacity(m);
        let (mut c, mut e) = (vec![0.0; m * d], vec![0.0; m * m]);
        for (p, &condition) in multipliers.iter().enumerate() {
            (0..d).for_each(|j| c[p * d + j] = of(condition, own[j]) / stiffness);
            (0..m).for_each(|j| e[p * m + j] = of(condition, multipliers[j]) / action);
            let (c, e) = (&mut c[p * d..(p + 1) * d], &mut e[p * m..(p + 1) * m]);
            let size = c.iter().chain(e.iter()).fold(0.0_f64, |s, v| s.max(v.abs()));
            if size == 0.0 {
                return Err(condition as usize);
            }
            c.iter_mut().chain(e.iter_mut()).for_each(|v| *v /= size);
            scales.push(1.0 / (size * stiffness));
        }
        // Conditions now read per displacement and per multiplier times action / stiffness.
        let elimination = group::eliminate([d, m], &a, &c, &e).ok_or(multipliers[0] as usize)?;
        Ok(Group { own, multipliers, elimination, scales, action, stiffness, masters: Vec::new() })
    }

    /// What links groups with the rest: unknowns of masters in conditions, multipliers in the equations of masters.
    fn find_neighbours(&mut self, system: &System<'_>) {
        let is_own = |e: usize| self.group_of[e] != NONE && !system.layout.multiplier[e];
        let mut all = Vec::with_capacity(self.groups.len());
        for group in &self.groups {
            let m = group.multipliers.len();
            let mut rows = Vec::new();
            for row in 0..group.elimination.prescribed {
                let mut terms = std::collections::BTreeMap::<u32, f64>::new();
                for (p, &condition) in group.multipliers.iter().enumerate() {
                    let factor = group.elimination.conditions[row * m + p] * group.scales[p];
                    for (j, value) in system.row(condition as usize) {
                        if !system.layout.multiplier[j] && !is_own(j) {
                            *terms.entry(j as u32).or_default() += factor * value;
                        }
                    }
                }
                rows.push(terms.into_iter().collect());
            }
            all.push(rows);
        }
        // Patterns are symmetric: what stands in a column stands in the row, too.
        let near = |of: &dyn Fn(&Group) -> Vec<u32>| {
            let rows = self.groups.iter().flat_map(of);
            let mut near: Vec<u32> = rows.flat_map(|e| pattern(system, e as usize)).collect();
            near.sort_unstable();
            near.dedup();
            near
        };
        let beside = near(&|group| group.own.clone());
        let mut loads = Vec::new();
        for i in near(&|group| group.multipliers.clone()) {
            if system.layout.multiplier[i as usize] || is_own(i as usize) {
                continue;
            }
            let acting: Vec<(u32, f64)> = system
                .row(i as usize)
                .filter(|&(j, _)| system.layout.multiplier[j] && self.group_of[j] != NONE)
                .map(|(j, value)| (j as u32, value))
                .collect();
            if !acting.is_empty() {
                loads.push((i, acting));
            }
        }
        self.groups.iter_mut().zip(all).for_each(|(group, rows)| group.masters = rows);
        (self.loads, self.beside) = (loads, beside);
    }

    /// Factors of the equations in what gives a multiplier.
    fn recovery(&self, multiplier: u32) -> Vec<(u32, f64)> {
        let group = &self.groups[self.group_of[multiplier as usize] as usize];
        let at = group.slot_of_multiplier(multiplier);
        let s = group.equations();
        let row = &group.elimination.recovery[at * s..(at + 1) * s];
        group.factors(row).into_iter().map(|(e, f)| (e, f / group.action)).collect()
    }

    /// Equations, with factors, whose sum stands at a place; `recovery` gives those that a multiplier follows from.
    fn left<'a>(
        &self,
        place: usize,
        load: Option<&[(u32, f64)]>,
        recovery: impl Fn(u32) -> &'a [(u32, f64)],
    ) -> Vec<(u32, f64)> {
        let equation = self.equation[place];
        let group = self.group_of[equation as usize];
        if group == NONE {
            let mut sum = vec![(equation, 1.0)];
            for &(multiplier, value) in load.unwrap_or_default() {
                sum.extend(recovery(multiplier).iter().map(|&(e, factor)| (e, -value * factor)));
            }
            return summed(sum);
        }
        let group = &self.groups[group as usize];
        let s = group.equations();
        let k = group.slot(equation);
        if k >= group.tangential() {
            return Vec::new();
        }
        group.factors(&group.elimination.left[k * s..(k + 1) * s])
    }

    /// Places, with factors, that an unknown follows.
    fn right(&self, equation: u32) -> Vec<(u32, f64)> {
        if self.place[equation as usize] == NONE {
            return Vec::new();
        }
        let group = self.group_of[equation as usize];
        if group == NONE {
            return vec![(self.place[equation as usize], 1.0)];
        }
        let group = &self.groups[group as usize];
        let (row, free, a) = (group.slot(equation), group.tangential(), group.elimination.prescribed);
        let mut terms: Vec<(u32, f64)> =
            (0..free).map(|k| (self.place[group.own[k] as usize], group.elimination.free[row * free + k])).collect();
        for (k, masters) in group.masters.iter().enumerate() {
            let factor = -group.elimination.held[row * a + k];
            terms.extend(masters.iter().map(|&(e, value)| (self.place[e as usize], factor * value)));
        }
        terms
    }

    /// What is left, the matrix over its largest diagonal entry; `earlier` is of the same bulk. Collective.
    pub(crate) fn left_blocks(&self, system: &System<'_>, earlier: Option<&Blocks>) -> Blocks {
        let largest = (0..system.equations())
            .filter(|&i| !system.layout.multiplier[i] && i < system.bulk.rows)
            .fold(0.0_f64, |m, i| m.max(system.bulk.get(i, i).abs()));
        let largest = self.ghosts.largest(largest);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let mut loads: Vec<Option<&[(u32, f64)]>> = vec![None; system.equations()];
        self.loads.iter().for_each(|(e, load)| loads[*e as usize] = Some(load));
        let mut plain = vec![true; system.equations()];
        self.beside.iter().for_each(|&e| plain[e as usize] = false);
        self.loads.iter().for_each(|(e, _)| plain[*e as usize] = false);
        let (w, inverse) = (self.width, 1.0 / largest);
        let at: Vec<(u32, u32)> = self
            .place
            .iter()
            .map(|&place| if place == NONE { (NONE, 0) } else { (place / w as u32, place % w as u32) })
            .collect();
        let coupled = |i: usize| {
            let rows = system.active_coupling().into_iter().map(move |coupling| coupling.row(i));
            rows.flat_map(|(columns, values)| columns.iter().zip(values))
                .filter(|(_, value)| **value != 0.0)
                .map(|(&j, &value)| (j as usize, value))
        };
        let add = |row: &mut BlockRow, k: usize, place: u32, value: f64| {
            row.block(place / w as u32)[place as usize % w * w + k] += (value * inverse) as f32;
        };
        let follows = |group: &Group| group.own.iter().map(|&e| self.right(e)).collect::<Vec<_>>();
        let follows: Vec<_> = self.groups.par_iter().map(follows).collect();
        let recovery = |group: &Group| group.multipliers.iter().map(|&m| self.recovery(m)).collect::<Vec<_>>();
        let recoveries: Vec<_> = self.groups.par_iter().map(recovery).collect();
        let recovery = |m: u32| {
            let group = self.group_of[m as usize] as usize;
            &recoveries[group][self.groups[group].slot_of_multiplier(m)][..]
        };
        let of_bulk = |b: usize| {
            let mut equations = self.equation[b * w..(b + 1) * w].iter().filter(|&&e| e != NONE).map(|&e| e as usize);
            equations.all(|i| plain[i] && self.group_of[i] == NONE && coupled(i).next().is_none())
        };
        let of_bulk: Vec<bool> = (0..self.blocks.own()).map(of_bulk).collect();
        let earlier = earlier.filter(|earlier| self.blocks.processes().is_none() && earlier.size == largest);
        let fill = |b: usize, row: &mut BlockRow, sums: &mut Sums| {
            if let Some(earlier) = earlier.filter(|earlier| of_bulk[b] && earlier.of_bulk[b]) {
                return row.copy(earlier.matrix.row(b));
            }
            let equations = &self.equation[b * w..(b + 1) * w];
            if of_bulk[b] && !equations.contains(&NONE) {
                let rows: Vec<(&[u32], &[f64])> = equations.iter().map(|&e| system.bulk.row(e as usize)).collect();
                if rows.iter().all(|(columns, _)| *columns == rows[0].0) {
                    // Unknowns of a node stand side by side.
                    let (mut block, mut start) = (NONE, 0);
                    for (c, (of, slot)) in rows[0].0.iter().map(|&j| at[j as usize]).enumerate() {
                        if of == NONE {
                            continue;
                        }
                        if of != block {
                            (block, start) = (of, row.start(of));
                        }
                        let entries = &mut row.entries()[start + slot as usize * w..][..w];
                        entries.iter_mut().zip(&rows).for_each(|(to, (_, values))| *to = (values[c] * inverse) as f32);
                    }
                    return;
                }
            }
            row.block(b as u32);
            // One bit for each unknown that the node does not have or whose motion is prescribed.
            let mut idle = 0_u64;
            for k in 0..w {
                let equation = self.equation[b * w + k];
                if equation == NONE {
                    idle |= 1 << k;
                    continue;
                }
                let i = equation as usize;
                if plain[i] && self.group_of[i] == NONE {
                    let (columns, values) = system.bulk.row(i);
                    // Unknowns of a node stand side by side.
                    let (mut block, mut start) = (NONE, 0);
                    let filled = columns.iter().zip(values).filter(|(_, value)| **value != 0.0);
                    for ((of, slot), value) in filled.map(|(&j, value)| (at[j as usize], value)) {
                        if of != block && of != NONE {
                            (block, start) = (of, row.start(of));
                        }
                        if of != NONE {
                            row.entries()[start + slot as usize * w + k] += (value * inverse) as f32;
                        }
                    }
                    for (j, value) in coupled(i).filter(|&(j, _)| self.place[j] != NONE) {
                        add(row, k, self.place[j], value);
                    }
                    continue;
                }
                let mut spread = |j: u32, value: f64| {
                    let (place, group) = (self.place[j as usize], self.group_of[j as usize]);
                    if place != NONE && group != NONE {
                        let follows = &follows[group as usize][self.groups[group as usize].slot(j)];
                        follows.iter().for_each(|&(place, weight)| add(row, k, place, value * weight));
                    } else if place != NONE {
                        add(row, k, place, value);
                    }
                };
                if self.group_of[i] == NONE && loads[i].is_none() {
                    system.row(i).for_each(|(j, value)| spread(j as u32, value));
                    continue;
                }
                let left = self.left(b * w + k, loads[i], recovery);
                idle |= u64::from(left.is_empty()) << k;
                for (e, factor) in left {
                    system.row(e as usize).for_each(|(j, value)| sums.add(j, factor * value));
                }
                sums.drain(spread);
            }
            let own = row.block(b as u32);
            let diagonal = (0..w).fold(0.0_f32, |m, k| m.max(own[k * w + k].abs()));
            for k in (0..w).filter(|&k| idle >> k & 1 == 1) {
                own[k * w + k] = if diagonal > 0.0 { diagonal } else { 1.0 };
            }
        };
        let shape = [self.blocks.own(), self.equation.len() / w];
        let sums = || Sums::new(system.equations());
        let matrix = Arc::new(BlockMatrix::from_rows_with(shape, [w; 2], sums, fill));
        if self.blocks.processes().is_some() {
            memory::give_back();
        }
        Blocks { matrix, size: largest, of_bulk, ghosts: self.blocks.clone() }
    }

    /// The near-null space of the layout on own blocks; translations where it has none.
    fn near_null_space(&self, system: &System<'_>) -> Vec<Vec<f64>> {
        let mut on_blocks: Vec<Vec<f64>> = if system.layout.near_null_space.is_empty() {
            let alike = |k: usize| {
                let is_set = |at: usize| at % self.width == k && self.equation[at] != NONE;
                (0..self.equation.len()).map(|at| f64::from(u8::from(is_set(at)))).collect()
            };
            (0..self.width).map(alike).collect()
        } else {
            let of = |vector: &Vec<f64>| {
                self.equation.iter().map(|&e| if e == NONE { 0.0 } else { vector[e as usize] }).collect()
            };
            system.layout.near_null_space.iter().map(of).collect()
        };
        for vector in &mut on_blocks {
            for group in &self.groups {
                let free = group.tangential();
                let motion: Vec<f64> = group.own.iter().map(|&e| vector[self.place[e as usize] as usize]).collect();
                for (k, &e) in group.own.iter().enumerate() {
                    vector[self.place[e as usize] as usize] = if k < free {
                        motion.iter().enumerate().map(|(i, v)| group.elimination.free[i * free + k] * v).sum()
                    } else {
                        0.0
                    };
                }
            }
            vector.truncate(self.blocks.own() * self.width);
        }
        on_blocks
    }

    /// What each group of this process prescribes: its first unknown and how many motions.
    pub(crate) fn prescribed(&self) -> Vec<(u32, u32)> {
        let is_own = self.ghosts.is_own();
        let own = self.groups.iter().filter(|group| is_own[group.own[0] as usize]);
        own.map(|group| (group.own[0], group.elimination.prescribed as u32)).collect()
    }

    /// Who has which equations.
    pub(crate) fn ghosts(&self) -> &Ghosts {
        &self.ghosts
    }

    /// The hierarchy of what is left; collective.
    pub(crate) fn hierarchy(&self, system: &System<'_>, left: &Blocks) -> Multigrid {
        Multigrid::new(left.matrix.clone(), self.near_null_space(system), self.blocks.clone())
    }

    /// Replaces the residual `r` of the whole system by an approximation of its solution; both are right at own equations.
    /// `solve` does the same for what is left, own entries. Collective.
    pub(crate) fn apply(&self, system: &System<'_>, solve: impl FnOnce(&mut [f64]), r: &mut [f64]) {
        self.ghosts.spread(r, 1);
        let mut z = vec![0.0; r.len()];
        let mut prescribes = false;
        for group in &self.groups {
            let a = group.elimination.prescribed;
            let values: Vec<f64> = (0..a).map(|k| group.condition(k, r)).collect();
            prescribes |= values.iter().any(|v| *v != 0.0);
            for (row, &e) in group.own.iter().enumerate() {
                z[e as usize] = (0..a).map(|k| group.elimination.held[row * a + k] * values[k]).sum();
            }
        }
        let idle_rows: Vec<f64> = self.idle.iter().map(|&(m, _)| r[m as usize]).collect();
        let kept: Vec<Vec<f64>> =
            self.groups.iter().map(|group| group.rows().map(|e| r[e as usize]).collect()).collect();
        if prescribes {
            // Only unknowns that groups prescribe differ from zero.
            let changes: Vec<f64> =
                self.beside.iter().map(|&e| system.row(e as usize).map(|(j, v)| v * z[j]).sum()).collect();
            self.beside.iter().zip(changes).for_each(|(&e, change)| r[e as usize] -= change);
        }
        self.ghosts.spread(r, 1);
        let mut b: Vec<f64> = self.equation.iter().map(|&e| if e == NONE { 0.0 } else { r[e as usize] }).collect();
        let mut multipliers = vec![0.0; if self.groups.is_empty() { 0 } else { r.len() }];
        for group in &self.groups {
            let s = group.equations();
            let known = group.stack(|e| r[e as usize]);
            let times = |row: &[f64]| row.iter().zip(&known).map(|(a, b)| a * b).sum::<f64>();
            for (k, &m) in group.multipliers.iter().enumerate() {
                multipliers[m as usize] = times(&group.elimination.recovery[k * s..(k + 1) * s]) / group.action;
            }
            for (k, &e) in group.own.iter().enumerate() {
                b[self.place[e as usize] as usize] =
                    if k < group.tangential() { times(&group.elimination.left[k * s..(k + 1) * s]) } else { 0.0 };
            }
        }
        for (e, load) in &self.loads {
            b[self.place[*e as usize] as usize] -= load.iter().map(|&(m, v)| v * multipliers[m as usize]).sum::<f64>();
        }
        solve(&mut b[..self.blocks.own() * self.width]);
        self.blocks.spread(&mut b, self.width);
        for (&e, value) in self.equation.iter().zip(&b).filter(|(e, _)| **e != NONE) {
            if self.group_of[e as usize] == NONE {
                z[e as usize] = *value;
            }
        }
        for group in &self.groups {
            for &e in &group.own {
                let follows: f64 = self.right(e).iter().map(|&(place, factor)| factor * b[place as usize]).sum();
                z[e as usize] += follows;
            }
        }
        multipliers.fill(0.0);
        for (group, kept) in self.groups.iter().zip(&kept) {
            let mut kept = kept.iter();
            let known = group.stack(|e| {
                let known = kept.next().expect("as many as the group has rows");
                known - system.row(e as usize).map(|(j, v)| v * z[j]).sum::<f64>()
            });
            let s = group.equations();
            for (k, &m) in group.multipliers.iter().enumerate() {
                let row = &group.elimination.recovery[k * s..(k + 1) * s];
                multipliers[m as usize] = row.iter().zip(&known).map(|(a, b)| a * b).sum::<f64>() / group.action;
            }
        }
        for group in &self.groups {
            group.multipliers.iter().for_each(|&m| z[m as usize] = multipliers[m as usize]);
        }
        for (&(m, diagonal), value) in self.idle.iter().zip(idle_rows) {
            let others: f64 = system.row(m as usize).map(|(j, v)| v * z[j]).sum();
            z[m as usize] = (value - others) / diagonal;
        }
        r.copy_from_slice(&z);
    }
}

impl Group {
    /// Motions that are not prescribed.
    fn tangential(&self) -> usize {
        self.own.len() - self.elimination.prescribed
    }

    /// Equations that multipliers follow from: those of the node, and its conditions that do not prescribe.
    fn equations(&self) -> usize {
        self.own.len() + self.multipliers.len() - self.elimination.prescribed
    }

    fn slot(&self, equation: u32) -> usize {
        self.own.iter().position(|&e| e == equation).expect("an own equation")
    }

    fn slot_of_multiplier(&self, multiplier: u32) -> usize {
        self.multipliers.iter().position(|&m| m == multiplier).expect("a multiplier of the group")
    }

    /// The node's equations and conditions.
    fn rows(&self) -> impl Iterator<Item = u32> {
        self.own.iter().chain(&self.multipliers).copied()
    }

    /// The k-th combination of the conditions, of values of the whole system.
    fn condition(&self, k: usize, r: &[f64]) -> f64 {
        let m = self.multipliers.len();
        let row = &self.elimination.conditions[k * m..(k + 1) * m];
        row.iter().zip(&self.multipliers).zip(&self.scales).map(|((f, &e), scale)| f * scale * r[e as usize]).sum()
    }

    /// The values that `R` and `L` are applied to.
    fn stack(&self, mut of: impl FnMut(u32) -> f64) -> Vec<f64> {
        let m = self.multipliers.len();
        let mut known: Vec<f64> = self.own.iter().map(|&e| of(e)).collect();
        let conditions: Vec<f64> =
            self.multipliers.iter().zip(&self.scales).map(|(&e, scale)| scale * self.stiffness * of(e)).collect();
        for row in self.elimination.prescribed..m {
            let factors = &self.elimination.conditions[row * m..(row + 1) * m];
            known.push(factors.iter().zip(&conditions).map(|(f, c)| f * c).sum());
        }
        known
    }

    /// A row over the stack as equations with factors.
    fn factors(&self, row: &[f64]) -> Vec<(u32, f64)> {
        let (d, m) = (self.own.len(), self.multipliers.len());
        let mut terms: Vec<(u32, f64)> = self.own.iter().zip(row).map(|(&e, &f)| (e, f)).collect();
        for (p, &e) in self.multipliers.iter().enumerate() {
            let factor: f64 = (self.elimination.prescribed..m)
                .map(|k| row[d + k - self.elimination.prescribed] * self.elimination.conditions[k * m + p])
                .sum();
            if factor != 0.0 {
                terms.push((e, factor * self.scales[p] * self.stiffness));
            }
        }
        terms
    }
}
