//! Multigrid for systems with multipliers: these leave by the constraints themselves.
//!
//! Let the multipliers of a node act on its own equations and else on those of masters, as dual multipliers do. Then ([`elimination`])
//! the conditions that hold no multiplier prescribe some motions of the node, `u = T û + u_p`, its equations give its multipliers, and
//! one reduced equation remains for each motion that is not prescribed: `L K T û`. For symmetric systems without friction `L = Tᵀ`, and
//! the matrix stays symmetric and positive definite. Each node keeps its number of unknowns: those prescribed become equations of their
//! own on the diagonal, so that blocks stay of one size.
//!
//! Ranks that share a system do this for the nodes with multipliers of their own and for those beside their rows, whose rows they have,
//! too. So each makes its own rows of the blocks, and only vectors are exchanged.
//!
//! This is a preconditioner of the whole system: neglected entries, such as those of multipliers on other nodes with multipliers, cost
//! iterations and no accuracy.

mod apply;
mod corners;
mod elimination;
mod group;
mod positions;
mod reduced_blocks;

use super::blocks::Blocks;
use super::multigrid_hierarchy::{Corners, Multigrid};
use crate::components::Components;
use crate::ghosts::{Ghosts, Owned};
use crate::parallel;
use crate::system::System;
use group::MultiplierGroup;

const NONE: u32 = u32::MAX;
/// Blocks that a thread takes at a time, at least.
const BLOCKS: usize = 1 << 10;
/// Share of a condition's largest entry from which on its multiplier follows from it.
const DETERMINES: f64 = 1e-8;

/// How a system with multipliers becomes one of node blocks without them.
pub(crate) struct Constrained {
    /// Unknowns of a node block.
    width: usize,
    /// Place of each equation among those of the blocks; multipliers have none.
    place: Vec<u32>,
    /// Equation at each place; places beyond a node's unknowns have none.
    equation: Vec<u32>,
    groups: Vec<MultiplierGroup>,
    /// Group of each own equation and each of its multipliers.
    group_of: Vec<u32>,
    /// Equations of masters with the entries of multipliers in them.
    master_rows: Vec<(u32, Vec<(u32, f64)>)>,
    /// Equations with entries of unknowns that groups prescribe.
    neighbour_rows: Vec<u32>,
    /// Multipliers that follow from their condition alone, with their diagonal.
    inactive: Vec<(u32, f64)>,
    /// Factor of each equation that brings it to the size of forces.
    pub(crate) row_scales: Vec<f64>,
    /// Who has which equations, and which blocks.
    ghosts: Ghosts,
    blocks: Ghosts,
}

/// Who has which blocks, those of own equations before others'; collective.
fn shared_blocks(ghosts: &Ghosts, place: &[u32], equation: &[u32], width: usize, own: usize) -> Ghosts {
    let Some(ranks) = ghosts.ranks() else { return Ghosts::none(own) };
    // The block of each equation, as its owner counts them.
    let mut block: Vec<f64> =
        place.iter().map(|&p| if p == NONE { -1.0 } else { f64::from(p / width as u32) }).collect();
    ghosts.spread(&mut block, 1);
    let mut owned: Vec<Owned> = vec![(0, 0); equation.len() / width - own];
    for &(e, (owner, _)) in ghosts.owned().iter().filter(|(e, _)| place[*e as usize] != NONE) {
        owned[place[e as usize] as usize / width - own] = (owner, block[e as usize] as u32);
    }
    Ghosts::after(ranks.clone(), own, &owned)
}

/// Columns of a row of both parts of a system, zeros among them.
fn columns<'a>(system: &System<'a>, i: usize) -> impl Iterator<Item = u32> + use<'a> {
    let bulk = Some(system.bulk).filter(|bulk| i < bulk.rows);
    [bulk, system.active_coupling()].into_iter().flatten().flat_map(move |matrix| matrix.row(i).0).copied()
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
        let is_placed = |i: usize| !layout.multiplier[i] && !layout.is_inactive(i);
        let mut has_place: Vec<bool> = (0..n).map(|i| is_own[i] && is_placed(i)).collect();
        ghosts.owned().iter().for_each(|&(i, _)| has_place[i as usize] = is_placed(i as usize));
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
            master_rows: Vec::new(),
            neighbour_rows: Vec::new(),
            inactive: Vec::new(),
            row_scales: vec![1.0; n],
            ghosts,
            blocks: of_blocks,
        };
        if layout.multiplier.contains(&true) {
            made.find_groups(system, &block)?;
            made.find_neighbours(system);
            made.find_follows();
        }
        Ok(made)
    }

    /// Eliminates the multipliers of each node.
    fn find_groups(&mut self, system: &System<'_>, block: &[u32]) -> Result<(), usize> {
        let layout = system.layout;
        let mut of_node = std::collections::BTreeMap::<u32, Vec<u32>>::new();
        // Multipliers of other ranks whose rows are not here act on no row that is.
        let is_own = self.ghosts.is_own();
        let is_known = |i: usize| is_own[i] || system.row(i).next().is_some();
        let is_here = |i: usize| layout.multiplier[i] && !layout.is_inactive(i) && is_known(i);
        for i in (0..layout.equations()).filter(|&i| is_here(i)) {
            of_node.entry(layout.node[i]).or_default().push(i as u32);
        }
        // Multipliers that conditions alone determine, multipliers that nothing here determines, and the group of the rest.
        type Found = (Vec<(u32, f64, f64)>, Vec<u32>, Option<Result<MultiplierGroup, usize>>);
        let find = |(node, multipliers): &(u32, Vec<u32>)| -> Found {
            let own: Vec<u32> = match block[*node as usize] {
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
            let (acting, others): (Vec<u32>, Vec<u32>) = multipliers.iter().partition(|&&m| largest > 0.0 && joins(m));
            let (mut inactive, mut lone) = (Vec::new(), Vec::new());
            for m in others {
                let diagonal = entry(system, m as usize, m as usize);
                let size = system.row(m as usize).fold(0.0_f64, |s, (_, v)| s.max(v.abs()));
                match diagonal.abs() > DETERMINES * size {
                    true => inactive.push((m, diagonal, 1.0 / diagonal.abs())),
                    false => lone.push(m),
                }
            }
            let group = (!acting.is_empty()).then(|| self.group(system, own, acting, largest));
            (inactive, lone, group)
        };
        let nodes: Vec<(u32, Vec<u32>)> = of_node.into_iter().collect();
        let found: Vec<Found> = parallel::map(nodes.len(), 16, |at| find(&nodes[at]));
        let mut lone = Vec::new();
        for (inactive, more, group) in found {
            for (m, diagonal, scale) in inactive {
                self.inactive.push((m, diagonal));
                self.row_scales[m as usize] = scale;
            }
            lone.extend(more);
            if let Some(group) = group {
                self.add_group(group?);
            }
        }
        for m in lone {
            if self.ghosts.ranks().is_some() {
                // Its unknown depends on the unknowns of others, which may be on other ranks.
                return Err(m as usize);
            }
            let (master, action) = self.prescribed_unknown(system, m).ok_or(m as usize)?;
            let group = self.group(system, vec![master], vec![m], action)?;
            self.add_group(group);
        }
        Ok(())
    }

    /// The unknown that a multiplier prescribes whose own node is held: of those in no group the one it moves most, and the
    /// size of its entry there.
    fn prescribed_unknown(&self, system: &System<'_>, multiplier: u32) -> Option<(u32, f64)> {
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

    fn add_group(&mut self, group: MultiplierGroup) {
        let at = self.groups.len() as u32;
        group.own.iter().chain(&group.multipliers).for_each(|&e| self.group_of[e as usize] = at);
        for (&m, scale) in group.multipliers.iter().zip(&group.scales) {
            self.row_scales[m as usize] = scale * group.stiffness;
        }
        self.groups.push(group);
    }

    fn group(
        &self,
        system: &System<'_>,
        own: Vec<u32>,
        multipliers: Vec<u32>,
        action: f64,
    ) -> Result<MultiplierGroup, usize> {
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
        let elimination = elimination::eliminate([d, m], &a, &c, &e).ok_or(multipliers[0] as usize)?;
        Ok(MultiplierGroup {
            own,
            multipliers,
            elimination,
            scales,
            action,
            stiffness,
            masters: Vec::new(),
            follows: Vec::new(),
            followed: Vec::new(),
        })
    }

    /// Links between groups and the rest: unknowns of masters in conditions, multipliers in the equations of masters.
    fn find_neighbours(&mut self, system: &System<'_>) {
        let is_own = |e: usize| self.group_of[e] != NONE && !system.layout.multiplier[e];
        let of_group = |group: &MultiplierGroup| {
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
            rows
        };
        let all: Vec<Vec<Vec<(u32, f64)>>> = parallel::map(self.groups.len(), 16, |at| of_group(&self.groups[at]));
        // Patterns are symmetric: an entry of a column is also one of the row.
        let near = |of: fn(&MultiplierGroup) -> &[u32]| -> Vec<u32> {
            let mut is_near = vec![false; system.equations()];
            for &row in self.groups.iter().flat_map(of) {
                columns(system, row as usize).for_each(|j| is_near[j as usize] = true);
            }
            let free = (0..system.equations()).filter(|&j| is_near[j] && !system.layout.is_inactive(j));
            free.map(|j| j as u32).collect()
        };
        let neighbour_rows = near(|group| &group.own);
        let mut master_rows = Vec::new();
        for i in near(|group| &group.multipliers) {
            if system.layout.multiplier[i as usize] || is_own(i as usize) {
                continue;
            }
            let acting: Vec<(u32, f64)> = system
                .row(i as usize)
                .filter(|&(j, _)| system.layout.multiplier[j] && self.group_of[j] != NONE)
                .map(|(j, value)| (j as u32, value))
                .collect();
            if !acting.is_empty() {
                master_rows.push((i, acting));
            }
        }
        self.groups.iter_mut().zip(all).for_each(|(group, rows)| group.masters = rows);
        (self.master_rows, self.neighbour_rows) = (master_rows, neighbour_rows);
    }

    /// Unknowns that the unknowns of groups follow.
    fn find_follows(&mut self) {
        let (place, w) = (&self.place, self.width);
        parallel::each_mut(&mut self.groups, 16, |_, group| {
            let (free, a) = (group.tangential(), group.elimination.prescribed);
            let of_row = |row: usize| {
                let own = (0..free).map(|k| (place[group.own[k] as usize], group.elimination.free[row * free + k]));
                let masters = group.masters.iter().enumerate().flat_map(|(k, masters)| {
                    let factor = -group.elimination.prescribed_motions[row * a + k];
                    masters.iter().map(move |&(e, value)| (place[e as usize], factor * value))
                });
                own.chain(masters).collect()
            };
            group.follows = (0..group.own.len()).map(of_row).collect();
            let mut blocks = std::collections::BTreeMap::<u32, Vec<f64>>::new();
            for (row, follows) in group.follows.iter().enumerate() {
                for &(place, factor) in follows {
                    let factors = blocks.entry(place / w as u32).or_insert_with(|| vec![0.0; group.own.len() * w]);
                    factors[row * w + place as usize % w] += factor;
                }
            }
            group.followed = blocks.into_iter().collect();
        });
    }

    /// Motions prescribed by each group of this rank: its first unknown and how many motions.
    pub(crate) fn prescribed(&self) -> Vec<(u32, u32)> {
        let is_own = self.ghosts.is_own();
        let own = self.groups.iter().filter(|group| is_own[group.own[0] as usize]);
        own.map(|group| (group.own[0], group.elimination.prescribed as u32)).collect()
    }

    /// Who has which equations.
    pub(crate) fn ghosts(&self) -> &Ghosts {
        &self.ghosts
    }

    /// Body of each own block: blocks that elements join, directly or through others, are of one. One for all where elements act alone.
    fn bodies(&self, system: &System<'_>, left: &Blocks) -> Vec<u32> {
        let own = self.blocks.own();
        if system.active_coupling().is_none() {
            return vec![0; own];
        }
        let by_equations = |block: usize| {
            let equations = self.equation[block * self.width..(block + 1) * self.width].iter();
            let first = equations.map(|&e| e as usize).find(|&e| e < system.bulk.rows);
            let columns = first.map_or(&[][..], |e| system.bulk.row(e).0);
            let blocks = columns.iter().map(|&j| self.place[j as usize]).filter(|&place| place != NONE);
            blocks.map(|place| place / self.width as u32)
        };
        // Rows of the bulk alone have its blocks.
        let near = |block: usize| {
            let is_bulk = left.of_bulk[block];
            let blocks = if is_bulk { left.matrix.row(block).0 } else { &[] };
            let others = (!is_bulk).then(|| by_equations(block)).into_iter().flatten();
            blocks.iter().copied().chain(others).map(|near| near as usize).filter(|&near| near < own)
        };
        let components = Components::new(own);
        parallel::ranges(own, BLOCKS, &|blocks| {
            blocks.for_each(|block| near(block).for_each(|next| components.join(block as u32, next as u32)));
        });
        let mut bodies = vec![NONE; own];
        let mut count = 0;
        for block in 0..own {
            let first = components.first(block as u32) as usize;
            if first == block {
                bodies[block] = count;
                count += 1;
            }
            bodies[block] = bodies[first];
        }
        bodies
    }

    /// The hierarchy of the reduced system; collective.
    pub(crate) fn hierarchy(&self, system: &System<'_>, left: &Blocks) -> Multigrid {
        let (bodies, positions) = (self.bodies(system, left), self.positions(system));
        let rows = |block: usize, add: &mut dyn FnMut(usize, u32, f64)| self.interpolate(system, block, add);
        let corners = self.corners(system, &bodies, &positions).map(|space| Corners { space, rows: &rows });
        let (modes, ghosts) = (self.near_null_space(system), self.blocks.clone());
        Multigrid::new(left.matrix.clone(), bodies, positions, modes, ghosts, corners)
    }
}
