//! The first coarse space on meshes of second order: that of the linear cells of their corners.

use super::{Constrained, NONE};
use crate::parallel;
use crate::precondition::aggregation::{self, Tentative};
use crate::system::System;

/// Largest share of the blocks at corners; where most nodes are corners, their cells are no coarse ones.
const LARGEST_SHARE: f64 = 0.5;

impl Constrained {
    /// Entries of the row of an equation in the interpolation from corners.
    fn interpolation<'a>(&self, system: &System<'a>, equation: u32) -> (&'a [u32], &'a [f64]) {
        let matrix = &system.layout.corner_interpolation;
        if (equation as usize) < matrix.rows { matrix.row(equation as usize) } else { (&[], &[]) }
    }

    /// The coarse space of corners, which have all unknowns of their nodes, with the near-null space on them, a body for each and their positions;
    /// `None` where few nodes lie between corners. Collective.
    pub(super) fn corners(&self, system: &System<'_>, bodies: &[u32], positions: &[[f64; 3]]) -> Option<Tentative> {
        let (w, matrix) = (self.width, &system.layout.corner_interpolation);
        if !self.ghosts.any(matrix.rows > 0) {
            return None;
        }
        let is_corner = |block: usize| {
            let equations = &self.equation[block * w..(block + 1) * w];
            let mut known = equations.iter().filter(|&&e| (e as usize) < matrix.rows);
            known.all(|&e| *matrix.row(e as usize).0 == [e])
        };
        let own = self.blocks.own();
        let is_corner: Vec<bool> = parallel::map(own, super::BLOCKS, is_corner);
        let mut aggregate = vec![aggregation::NONE; own];
        let corners: Vec<usize> = (0..own).filter(|&block| is_corner[block]).collect();
        corners.iter().enumerate().for_each(|(number, &block)| aggregate[block] = number as u32);
        let [count, all] = [corners.len(), own].map(|blocks| self.blocks.total(blocks as f64));
        if count > LARGEST_SHARE * all {
            return None;
        }
        let of_corners =
            |vector: &Vec<f64>| corners.iter().flat_map(|&b| &vector[b * w..(b + 1) * w]).copied().collect();
        let modes = self.rigid_body_modes(system).iter().map(of_corners).collect();
        let bodies = corners.iter().map(|&block| bodies[block]).collect();
        let positions = corners.iter().filter_map(|&block| positions.get(block)).copied().collect();
        Some(Tentative { aggregate, aggregates: corners.len(), bodies, positions, values: Vec::new(), modes })
    }

    /// Calls `add` with a slot of an own block, the place of an unknown at a corner and its factor, for all of them.
    pub(super) fn interpolate(&self, system: &System<'_>, block: usize, add: &mut dyn FnMut(usize, u32, f64)) {
        let w = self.width;
        let equations = self.equation[block * w..(block + 1) * w].iter().enumerate().filter(|(_, e)| **e != NONE);
        for (slot, &e) in equations {
            let group = self.group_of[e as usize];
            let (columns, values) = self.interpolation(system, e);
            let corners =
                columns.iter().map(|&j| self.place[j as usize]).zip(values).filter(|(place, _)| *place != NONE);
            for (place, &value) in corners {
                if group == NONE {
                    add(slot, place, value);
                    continue;
                }
                // Unknowns of a node with multipliers are its motions that these leave.
                let group = &self.groups[group as usize];
                let (row, free) = (group.slot(e), group.tangential());
                for k in 0..free {
                    let at = self.place[group.own[k] as usize] as usize % w;
                    add(at, place, value * group.elimination.free[row * free + k]);
                }
            }
        }
    }
}
