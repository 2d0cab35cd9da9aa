//! The preconditioner: conditions first, then the reduced system, then the multipliers.

use super::{Constrained, NONE};
use crate::parallel;
use crate::system::System;
use crate::vector::{self, CHUNK};

impl Constrained {
    /// Replaces the residual `r` of the whole system by an approximation of its solution; both are right at own equations. `solve` does
    /// the same for the reduced system, own entries. Collective.
    pub(crate) fn apply(&self, system: &System<'_>, solve: impl FnOnce(&mut [f64]), r: &mut [f64]) {
        self.ghosts.spread(r, 1);
        let mut z: Vec<f64> = vector::zeros(r.len());
        let mut prescribes = false;
        for group in &self.groups {
            let a = group.elimination.prescribed;
            let values: Vec<f64> = (0..a).map(|k| group.condition(k, r)).collect();
            prescribes |= values.iter().any(|v| *v != 0.0);
            for (row, &e) in group.own.iter().enumerate() {
                z[e as usize] = (0..a).map(|k| group.elimination.prescribed_motions[row * a + k] * values[k]).sum();
            }
        }
        let inactive_rows: Vec<f64> = self.inactive.iter().map(|&(m, _)| r[m as usize]).collect();
        let kept: Vec<Vec<f64>> =
            self.groups.iter().map(|group| group.rows().map(|e| r[e as usize]).collect()).collect();
        if prescribes {
            // Only unknowns that groups prescribe differ from zero.
            let change = |at: usize| system.row_product(self.neighbour_rows[at] as usize, &z);
            let changes: Vec<f64> = parallel::map(self.neighbour_rows.len(), 64, change);
            self.neighbour_rows.iter().zip(changes).for_each(|(&e, change)| r[e as usize] -= change);
        }
        self.ghosts.spread(r, 1);
        let at_equation = |e: u32| if e == NONE { 0.0 } else { r[e as usize] };
        let mut b: Vec<f64> = parallel::map(self.equation.len(), CHUNK, |at| at_equation(self.equation[at]));
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
        for (e, load) in &self.master_rows {
            b[self.place[*e as usize] as usize] -= load.iter().map(|&(m, v)| v * multipliers[m as usize]).sum::<f64>();
        }
        solve(&mut b[..self.blocks.own() * self.width]);
        self.blocks.spread(&mut b, self.width);
        parallel::parts_mut(&mut z, CHUNK, &|first, z| {
            let places = self.place[first..].iter().zip(&self.group_of[first..]).zip(z);
            let free = places.filter(|((place, group), _)| **place != NONE && **group == NONE);
            free.for_each(|((place, _), z)| *z = b[*place as usize]);
        });
        for group in &self.groups {
            for (&e, follows) in group.own.iter().zip(&group.follows) {
                z[e as usize] += follows.iter().map(|&(place, factor)| factor * b[place as usize]).sum::<f64>();
            }
        }
        let recovered = |at: usize| -> Vec<f64> {
            let (group, mut kept) = (&self.groups[at], kept[at].iter());
            let known = group.stack(|e| {
                let known = kept.next().expect("as many as the group has rows");
                known - system.row_product(e as usize, &z)
            });
            let rows = group.elimination.recovery.chunks_exact(group.equations());
            rows.map(|row| row.iter().zip(&known).map(|(a, b)| a * b).sum::<f64>() / group.action).collect()
        };
        let found: Vec<Vec<f64>> = parallel::map(self.groups.len(), 16, recovered);
        for (group, found) in self.groups.iter().zip(found) {
            group.multipliers.iter().zip(found).for_each(|(&m, value)| z[m as usize] = value);
        }
        for (&(m, diagonal), value) in self.inactive.iter().zip(inactive_rows) {
            z[m as usize] = (value - system.row_product(m as usize, &z)) / diagonal;
        }
        vector::copy(&z, r);
    }
}
