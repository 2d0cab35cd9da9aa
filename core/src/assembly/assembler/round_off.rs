//! Round-off of the residual: the accuracy below which no balance can be measured.

use zelus_linear_algebra::parallel;
use zelus_linear_algebra::vector::{scale_by, zeros};

use super::Assembler;
use crate::assembly::System;
use crate::assembly::rows::ROWS;
use crate::assembly::runaway_bound::runaway_bound;
use crate::model::ModelPart;

/// Largest stiffness of an interaction, relative to that of the bodies, that counts in round-off: a stiff penalty adds to the round-off
/// of forces.
const STIFFEST: f64 = 100.0;

impl Assembler {
    /// The round-off of each entry of a residual, from the sizes of the terms that it is a sum of.
    ///
    /// Terms of constant blocks scale with displacements, those of all others with positions. No term is larger than
    /// stiffness times [`runaway_bound`]: bodies that have gone farther, and multipliers that push farther, measure no accuracy.
    pub fn round_off(&self, part: &ModelPart, system: &System) -> Vec<f64> {
        let runaway_bound = runaway_bound(part, &system.dofs, self.equations.map());
        let before = system.dofs.gather(part, 1);
        let values = self.values(part, system);
        let dofs = system.dofs.dofs();
        // Of every unknown: its displacement, its position, its size as a multiplier, and how far it may go.
        let sizes = |n: usize| match values[n].abs() {
            value if dofs[n].multiplier => [0.0, 0.0, value, 0.0],
            value if system.dofs.moves_mesh(n) => {
                let (node, c) = (dofs[n].node as usize, dofs[n].variable.offset());
                let held = value.min(before[n].abs() + runaway_bound);
                let farthest = part.nodes.initial[node][c].abs() + held;
                [held, part.nodes.current[node][c].abs().min(farthest).max(held), 0.0, runaway_bound]
            }
            value => [value, value, 0.0, 0.0],
        };
        let [displacement, position, multiplier, farthest] =
            [0, 1, 2, 3].map(|i| parallel::map(dofs.len(), ROWS, |n| sizes(n)[i]));
        let bulk = if self.bulk.traits().variable_elements { &position } else { &displacement };
        let [mut out, mut bodies, mut coupled, mut pushed, mut gaps] = std::array::from_fn(|_| zeros(dofs.len()));
        let coupling = self.coupling.matrix();
        let of_coupling = [&mut coupled[..], &mut pushed, &mut gaps];
        coupling.add_products_of_sizes(&coupling.values, [&position, &multiplier, &farthest], of_coupling);
        // Gaps are integrated over facets: a node at the origin is as accurate as its neighbours, no more.
        for (n, _) in dofs.iter().enumerate().filter(|(_, dof)| dof.multiplier) {
            let (columns, values) = coupling.row(n);
            // Rows with multipliers are no gaps alone.
            if columns.iter().zip(values).any(|(column, v)| *v != 0.0 && dofs[*column as usize].multiplier) {
                continue;
            }
            let motions = || columns.iter().zip(values).filter(|(column, _)| !dofs[**column as usize].multiplier);
            let [sum, count] =
                motions().fold([0.0, 0.0], |[s, c], (&column, _)| [s + position[column as usize], c + 1.0]);
            let mean = if count > 0.0 { sum / count } else { 0.0 };
            coupled[n] =
                motions().map(|(&column, value)| value.abs() * position[column as usize].max(mean)).sum::<f64>();
        }
        if let Some(values) = self.bulk.entries_in_use() {
            self.bulk.matrix().add_products_of_sizes(values, [bulk, &farthest], [&mut out, &mut bodies]);
        }
        parallel::each_mut(&mut out, ROWS, |n, out| {
            // Multipliers stand in the tangent of turning normals, too: forces are bounded by the bodies alone.
            *out += match dofs[n].multiplier {
                true => coupled[n] + pushed[n].min(gaps[n]),
                false => (coupled[n] + pushed[n]).min(STIFFEST * bodies[n]),
            };
        });
        self.parallel.sum(&mut out);
        // Unknowns that others follow are as accurate as the sum of the forces that these hand on.
        let equations = self.equations.map();
        if equations.has_slaves() {
            for (slave, own) in out.clone().into_iter().enumerate() {
                equations.hands_on(slave).for_each(|(master, share)| out[master as usize] += share.abs() * own);
            }
        }
        scale_by(f64::EPSILON, &mut out);
        out
    }
}
