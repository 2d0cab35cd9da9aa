//! The multipliers of one node.

use super::elimination::GroupElimination;

/// The multipliers of one node.
pub(super) struct MultiplierGroup {
    /// Equations of the node's unknowns.
    pub(super) own: Vec<u32>,
    /// Multipliers that act on them.
    pub(super) multipliers: Vec<u32>,
    pub(super) elimination: GroupElimination,
    /// Factor of each condition that brings it to the size of forces by displacements.
    pub(super) scales: Vec<f64>,
    /// Size of a multiplier's entries on its node.
    pub(super) action: f64,
    /// Size of the node's diagonal.
    pub(super) stiffness: f64,
    /// `N₀ C` on the unknowns of masters, for each prescribed motion.
    pub(super) masters: Vec<Vec<(u32, f64)>>,
    /// Places, with factors, that each unknown of the node follows.
    pub(super) follows: Vec<Vec<(u32, f64)>>,
    /// The same by blocks: factors of each unknown of the node, for each slot of the block.
    pub(super) followed: Vec<(u32, Vec<f64>)>,
}

impl MultiplierGroup {
    /// Motions that are not prescribed.
    pub(super) fn tangential(&self) -> usize {
        self.own.len() - self.elimination.prescribed
    }

    /// Equations that multipliers follow from: those of the node, and its conditions that do not prescribe.
    pub(super) fn equations(&self) -> usize {
        self.own.len() + self.multipliers.len() - self.elimination.prescribed
    }

    pub(super) fn slot(&self, equation: u32) -> usize {
        self.own.iter().position(|&e| e == equation).expect("an own equation")
    }

    pub(super) fn slot_of_multiplier(&self, multiplier: u32) -> usize {
        self.multipliers.iter().position(|&m| m == multiplier).expect("a multiplier of the group")
    }

    /// The node's equations and conditions.
    pub(super) fn rows(&self) -> impl Iterator<Item = u32> {
        self.own.iter().chain(&self.multipliers).copied()
    }

    /// The k-th combination of the conditions, of values of the whole system.
    pub(super) fn condition(&self, k: usize, r: &[f64]) -> f64 {
        let m = self.multipliers.len();
        let row = &self.elimination.conditions[k * m..(k + 1) * m];
        row.iter().zip(&self.multipliers).zip(&self.scales).map(|((f, &e), scale)| f * scale * r[e as usize]).sum()
    }

    /// The values that `R` and `L` are applied to.
    pub(super) fn stack(&self, mut of: impl FnMut(u32) -> f64) -> Vec<f64> {
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
    pub(super) fn factors(&self, row: &[f64]) -> Vec<(u32, f64)> {
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
