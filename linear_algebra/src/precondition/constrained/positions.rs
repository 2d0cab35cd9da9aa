//! Positions of blocks, as rigid-body modes have them.

use super::{Constrained, NONE};
use crate::system::System;

impl Constrained {
    /// Position of each own block, from any origin; coordinates that no unknown of the node tells are not numbers. Empty where there are no
    /// rotations.
    ///
    /// The rotation about the axis `k` moves the unknown along `d` by `(e_k × x)_d`: by `-x_e` for `d` the axis after `k` and `e` the next,
    /// by `x_d` at `e`.
    pub(super) fn positions(&self, system: &System<'_>) -> Vec<[f64; 3]> {
        let layout = system.layout;
        let modes = &layout.near_null_space;
        let (axes, of_axis): (usize, [Option<&Vec<f64>>; 3]) = match &modes[..] {
            [_, _, _, x, y, z, ..] => (3, [Some(x), Some(y), Some(z)]),
            [_, _, turn, ..] => (2, [None, None, Some(turn)]),
            _ => return Vec::new(),
        };
        let nodes = layout.node.iter().max().map_or(0, |&node| node as usize + 1);
        let mut block_of = vec![NONE; nodes];
        for (at, &e) in self.equation[..self.blocks.own() * self.width].iter().enumerate().filter(|(_, e)| **e != NONE)
        {
            block_of[layout.node[e as usize] as usize] = (at / self.width) as u32;
        }
        let mut positions = vec![[f64::NAN; 3]; self.blocks.own()];
        // Held unknowns, which have no place, tell as well.
        for (e, &node) in layout.node.iter().enumerate().filter(|(e, _)| !layout.multiplier[*e]) {
            let (block, along) = (block_of[node as usize], (0..axes).find(|&axis| modes[axis][e] == 1.0));
            if let (Some(position), Some(d)) = (positions.get_mut(block as usize), along) {
                let [next, last] = [(d + 1) % 3, (d + 2) % 3];
                of_axis[last].iter().for_each(|turn| position[next] = -turn[e]);
                of_axis[next].iter().for_each(|turn| position[last] = turn[e]);
            }
        }
        positions
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::csr::Csr;
    use crate::system::{Layout, Symmetry};

    /// ANALYTIC: the places of two nodes from `(e_k × x)_d`. The second has the unknowns along y and z alone, which tell each coordinate;
    /// of the third only that along z is free, and both others are known to the layout or not.
    #[test]
    fn rotations_tell_positions() {
        let at = [[1.0, 2.0, 3.0], [-4.0, 5.0, 0.5], [7.0, -6.0, 8.0]];
        let unknowns = |others: bool| {
            let all = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)];
            all.into_iter().filter(move |&(node, d)| others || node < 2 || d == 2)
        };
        for others_are_known in [true, false] {
            let list: Vec<(usize, usize)> = unknowns(others_are_known).collect();
            let turn = |k: usize, x: [f64; 3], d: usize| match d {
                _ if d == (k + 1) % 3 => -x[(k + 2) % 3],
                _ if d == (k + 2) % 3 => x[(k + 1) % 3],
                _ => 0.0,
            };
            let of = |f: &dyn Fn(usize, usize) -> f64| list.iter().map(|&(node, d)| f(node, d)).collect::<Vec<f64>>();
            let translations = (0..3).map(|k| of(&|_, d| f64::from(u8::from(d == k))));
            let rotations = (0..3).map(|k| of(&|node, d| turn(k, at[node], d)));
            let layout = Layout {
                node: list.iter().map(|&(node, _)| node as u32).collect(),
                multiplier: vec![false; list.len()],
                near_null_space: translations.chain(rotations).collect(),
                inactive: list.iter().map(|&(node, d)| node == 2 && d < 2).collect(),
                ..Layout::default()
            };
            let diagonal: Vec<(usize, usize, f64)> = (0..list.len()).map(|i| (i, i, 1.0)).collect();
            let bulk = Csr::from_triplets(list.len(), &diagonal);
            let system = System::bulk(&layout, &bulk, Symmetry::PositiveDefinite);
            let found = Constrained::new(&system).expect("no multipliers").positions(&system);
            assert_eq!(found[..2], at[..2]);
            assert_eq!(found[2][..2], at[2][..2]);
            assert!(if others_are_known { found[2][2] == at[2][2] } else { found[2][2].is_nan() });
        }
    }
}
