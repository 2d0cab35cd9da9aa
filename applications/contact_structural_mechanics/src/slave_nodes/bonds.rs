//! Bonds of all slave nodes: who is bonded, and the tractions of each iteration.

use std::ops::Range;

use super::slave_bond::SlaveBond;
use super::slave_states::SlaveStates;
use crate::interface::SlaveIndex;
use crate::law::bond::bond;
use crate::law::{BondOpening, SurfaceLaw, SurfaceNumbers};

/// Iterations of a step in which damage is constant in the tangent.
const SECANTS: Range<usize> = 8..22;

impl SlaveStates {
    /// Finds tractions and states of bonds at the present openings.
    ///
    /// Where some bonds are damaged and others unload, Newton's iteration may run through their branches without end. A number of
    /// iterations with the secants of damaged bonds leads on, as far as to the next equilibrium where a crack jumps; Newton's iteration
    /// ends it.
    pub fn find_bonds(&mut self, law: SurfaceLaw<'_>, tangent_factor: f64) {
        let secant = SECANTS.contains(&self.iteration());
        for &slave in &*self.slaves() {
            let state = &self[slave];
            let Some(own) = self.bond(slave).copied().filter(|_| state.kinematics.area > 0.0) else { continue };
            let at = BondOpening {
                gap: state.kinematics.weighted_gap / state.kinematics.area,
                sliding: own.sliding,
                trial: state.law.trial,
            };
            let penalty = state.parameters.penalty;
            let numbers = SurfaceNumbers {
                friction: state.parameters.friction,
                stiffness: [penalty, tangent_factor * penalty],
                active: state.law.active,
                secant,
            };
            let found = bond(law, &own.last, at, numbers);
            self.bond_mut(slave).take(&found);
        }
    }

    /// Step end: nodes whose bonds have failed, and that are open, leave contact.
    pub fn release_failed(&mut self) {
        for &slave in &*self.slaves() {
            let failed = self.bond(slave).is_some_and(SlaveBond::has_parted);
            self[slave].law.active &= !failed;
        }
    }

    /// Step start: decides on first sight which slave nodes are bonded: those among `of` that are in contact.
    pub fn make_bonds(&mut self, of: &[SlaveIndex]) {
        self.restart_iterations();
        for &slave in &*self.slaves() {
            let (bonded, gap) = (of.binary_search(&slave).is_ok() && self[slave].law.active, self[slave].gap());
            let bond = self.bond_mut(slave);
            if bond.last.bonded.is_none() {
                bond.last.decide(bonded, gap.unwrap_or(0.0));
                bond.state = bond.last;
            }
        }
    }
}
