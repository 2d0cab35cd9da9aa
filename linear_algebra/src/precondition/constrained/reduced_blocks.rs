//! The reduced system without multipliers, and its distance from the system before.

use std::sync::Arc;

use super::group::MultiplierGroup;
use super::{Constrained, NONE};
use crate::csr::are_same;
use crate::memory;
use crate::parallel;
use crate::precondition::block_matrix::BlockMatrix;
use crate::precondition::block_row::BlockRow;
use crate::precondition::blocks::Blocks;
use crate::precondition::sparse_sums::SparseSums;
use crate::prefetch::ROWS_AHEAD;
use crate::system::System;
use crate::vector::CHUNK;

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

fn add_multiple(sums: &mut [f64], value: f64, vector: &[f64]) {
    sums.iter_mut().zip(vector).for_each(|(sum, v)| *sum += value * v);
}

/// Work space in which the rows of a block are made.
struct Scratch {
    /// Equations with the row of the block that they are added to, and their factor in it.
    terms: Vec<(u32, usize, f64)>,
    /// Factor of one equation in each row of the block.
    factors: Vec<f64>,
    /// Entries of the rows at each equation.
    sums: SparseSums,
    /// The same at the unknowns of each group, one after the other.
    met: SparseSums,
}

impl Constrained {
    /// Factors of the equations in the recovery of a multiplier.
    fn recovery(&self, multiplier: u32) -> Vec<(u32, f64)> {
        let group = &self.groups[self.group_of[multiplier as usize] as usize];
        let at = group.slot_of_multiplier(multiplier);
        let s = group.equations();
        let row = &group.elimination.recovery[at * s..(at + 1) * s];
        group.factors(row).into_iter().map(|(e, f)| (e, f / group.action)).collect()
    }

    /// Equations, with factors, whose sum stands at a place; `recovery` gives those that a multiplier follows from.
    fn reduced_row<'a>(
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

    /// The largest entry on the diagonal of the bulk, one where all are zero; collective.
    fn largest_diagonal(&self, system: &System<'_>) -> f64 {
        let largest = parallel::largest(system.bulk.rows, 1024, |i| {
            if system.layout.multiplier[i] || system.layout.is_inactive(i) {
                return 0.0;
            }
            system.bulk.prefetch_diagonal(i + ROWS_AHEAD);
            system.bulk.get(i, i).abs()
        });
        let largest = self.ghosts.largest(largest);
        if largest > 0.0 { largest } else { 1.0 }
    }

    /// The reduced system, its matrix over its largest diagonal entry; `earlier` is of the same bulk. Collective.
    pub(crate) fn reduced_blocks(&self, system: &System<'_>, earlier: Option<&Blocks>) -> Blocks {
        let earlier = earlier.filter(|_| self.blocks.ranks().is_none());
        let largest = earlier.map_or_else(|| self.largest_diagonal(system), |earlier| earlier.size);
        let mut loads: Vec<Option<&[(u32, f64)]>> = vec![None; system.equations()];
        self.master_rows.iter().for_each(|(e, load)| loads[*e as usize] = Some(load));
        let mut plain = vec![true; system.equations()];
        self.neighbour_rows.iter().for_each(|&e| plain[e as usize] = false);
        self.master_rows.iter().for_each(|(e, _)| plain[*e as usize] = false);
        let (w, inverse) = (self.width, 1.0 / largest);
        // Block and slot of each equation that has one.
        let blocks = self.equation.len() / w;
        let of_place = |place: u32| (place / w as u32, place % w as u32);
        let of_equation = |place: u32| if place == NONE { (NONE, 0) } else { of_place(place) };
        let at: Vec<(u32, u32)> = parallel::map(self.place.len(), CHUNK, |e| of_equation(self.place[e]));
        let coupled = |i: usize| {
            let rows = system.active_coupling().into_iter().map(move |coupling| coupling.row(i));
            rows.flat_map(|(columns, values)| columns.iter().zip(values))
                .filter(|(_, value)| **value != 0.0)
                .map(|(&j, &value)| (j as usize, value))
        };
        let recovery =
            |group: &MultiplierGroup| group.multipliers.iter().map(|&m| self.recovery(m)).collect::<Vec<_>>();
        let recoveries = parallel::map(self.groups.len(), 16, |at| recovery(&self.groups[at]));
        let recovery = |m: u32| {
            let group = self.group_of[m as usize] as usize;
            &recoveries[group][self.groups[group].slot_of_multiplier(m)][..]
        };
        let of_bulk = |b: usize| {
            let mut equations = self.equation[b * w..(b + 1) * w].iter().filter(|&&e| e != NONE).map(|&e| e as usize);
            equations.all(|i| plain[i] && self.group_of[i] == NONE && coupled(i).next().is_none())
        };
        let of_bulk: Vec<bool> = parallel::map(self.blocks.own(), CHUNK, of_bulk);
        let fill = |b: usize, row: &mut BlockRow, scratch: &mut Scratch| {
            let equations = &self.equation[b * w..(b + 1) * w];
            if of_bulk[b] && !equations.contains(&NONE) {
                let rows: Vec<(&[u32], &[f64])> = equations.iter().map(|&e| system.bulk.row(e as usize)).collect();
                if rows.iter().all(|(columns, _)| are_same(columns, rows[0].0)) {
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
            let mut absent = 0_u64;
            let is_plain = |e: u32| e == NONE || (plain[e as usize] && self.group_of[e as usize] == NONE);
            if equations.iter().all(|&e| is_plain(e)) {
                for (k, &equation) in equations.iter().enumerate() {
                    if equation == NONE {
                        absent |= 1 << k;
                        continue;
                    }
                    let (columns, values) = system.bulk.row(equation as usize);
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
                    for (j, value) in coupled(equation as usize).filter(|&(j, _)| self.place[j] != NONE) {
                        let (block, slot) = of_place(self.place[j]);
                        row.block(block)[slot as usize * w + k] += (value * inverse) as f32;
                    }
                }
            } else {
                let Scratch { terms, factors, sums, met } = scratch;
                terms.clear();
                for (k, &equation) in equations.iter().enumerate() {
                    let load = if equation == NONE { None } else { loads[equation as usize] };
                    let row = if equation == NONE { Vec::new() } else { self.reduced_row(b * w + k, load, recovery) };
                    absent |= u64::from(row.is_empty()) << k;
                    terms.extend(row.into_iter().map(|(e, factor)| (e, k, factor)));
                }
                // Rows of a node are mostly made of the same equations.
                terms.sort_by_key(|(e, _, _)| *e);
                for same in terms.chunk_by(|a, b| a.0 == b.0) {
                    factors.fill(0.0);
                    same.iter().for_each(|&(_, k, factor)| factors[k] += factor);
                    system.row(same[0].0 as usize).for_each(|(j, value)| add_multiple(sums.at(j), value, factors));
                }
                sums.drain(|j, values| {
                    let (place, group) = (self.place[j as usize], self.group_of[j as usize]);
                    if place != NONE && group != NONE {
                        let own = &self.groups[group as usize].own;
                        let slot = own.iter().position(|&e| e == j).expect("an own equation");
                        add_multiple(&mut met.at(group as usize)[slot * w..(slot + 1) * w], 1.0, values);
                    } else if place != NONE {
                        let (block, slot) = of_place(place);
                        let entries = &mut row.block(block)[slot as usize * w..][..w];
                        entries.iter_mut().zip(values).for_each(|(to, value)| *to += (value * inverse) as f32);
                    }
                });
                // Entries at unknowns of groups go to the unknowns that these follow.
                met.drain(|group, values| {
                    for (block, factors) in &self.groups[group as usize].followed {
                        let entries = row.block(*block);
                        for (values, factors) in values.chunks_exact(w).zip(factors.chunks_exact(w)) {
                            for (column, factor) in entries.chunks_exact_mut(w).zip(factors) {
                                let factor = factor * inverse;
                                column.iter_mut().zip(values).for_each(|(to, v)| *to += (v * factor) as f32);
                            }
                        }
                    }
                });
            }
            let own = row.block(b as u32);
            let diagonal = (0..w).fold(0.0_f32, |m, k| m.max(own[k * w + k].abs()));
            for k in (0..w).filter(|&k| absent >> k & 1 == 1) {
                own[k * w + k] = if diagonal > 0.0 { diagonal } else { 1.0 };
            }
        };
        let shape = [self.blocks.own(), blocks];
        let scratch = || Scratch {
            terms: Vec::new(),
            factors: vec![0.0; w],
            sums: SparseSums::new(system.equations(), w),
            met: SparseSums::new(self.groups.len(), w * w),
        };
        let keeps = |earlier: &Blocks, b: usize| of_bulk[b] && earlier.of_bulk[b];
        let kept = earlier.map(|earlier| (&*earlier.matrix, move |b: usize| keeps(earlier, b)));
        let matrix = Arc::new(BlockMatrix::from_rows_with(shape, [w; 2], kept, scratch, fill));
        if self.blocks.ranks().is_some() {
            memory::give_back();
        }
        Blocks { matrix, size: largest, of_bulk, ghosts: self.blocks.clone() }
    }

    /// The near-null space of the layout on blocks; translations where it has none.
    pub(super) fn rigid_body_modes(&self, system: &System<'_>) -> Vec<Vec<f64>> {
        if system.layout.near_null_space.is_empty() {
            let alike = |k: usize| {
                let is_set = |at: usize| at % self.width == k && self.equation[at] != NONE;
                parallel::map(self.equation.len(), CHUNK, |at| f64::from(u8::from(is_set(at))))
            };
            return (0..self.width).map(alike).collect();
        }
        let of = |vector: &Vec<f64>| {
            let value = |e: u32| if e == NONE { 0.0 } else { vector[e as usize] };
            parallel::map(self.equation.len(), CHUNK, |at| value(self.equation[at]))
        };
        system.layout.near_null_space.iter().map(of).collect()
    }

    /// The near-null space of the reduced system on own blocks.
    pub(super) fn near_null_space(&self, system: &System<'_>) -> Vec<Vec<f64>> {
        let mut on_blocks = self.rigid_body_modes(system);
        parallel::each_mut(&mut on_blocks, 1, |_, vector| {
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
        });
        on_blocks
    }
}
