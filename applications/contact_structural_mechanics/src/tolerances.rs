//! Smallest lengths and tractions that contact tells apart: the one rule by which all formulations take their decisions.
//!
//! Numbers that are equal in exact arithmetic differ in their last digits, and those depend on the unit system, on the
//! numbers of the nodes and on the order in which ranks add up. A decision that hangs on them makes the iteration go another
//! way each time. So, wherever contact compares:
//!
//! 1. compared quantities have one unit. Gaps and slips count over the area of their node, which makes them lengths, and stand against
//!    tractions with a stiffness by length;
//! 2. lengths within the round-off of positions are none, and tractions differ if they do so by more than the share of the
//!    largest one in contact that a linear solve leaves open;
//! 3. differences below the tolerance decide nothing: the present state stays.

use serde::{Deserialize, Serialize};
use zelus_core::vector3::norm;

/// Round-off of a difference of positions, as a share of the distance from the origin.
const POSITIONS: f64 = 64.0 * f64::EPSILON;
/// Round-off of a sum of forces, as a share of its terms.
const FORCES: f64 = 1024.0 * f64::EPSILON;
/// Error of a solve in a traction that is zero, as a share of the largest.
const TRACTIONS: f64 = 1e-9;

/// Sizes of an interface below which nothing is decided.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Tolerances {
    /// Lengths up to this are none.
    pub length: f64,
    /// Tractions that differ by less are equal.
    pub traction: f64,
}

impl Tolerances {
    /// For points up to `extent` from the origin, tractions up to `traction`, and forces that are differences of others
    /// up to `stressed` an area.
    pub fn of(extent: f64, traction: f64, stressed: f64) -> Self {
        Self { length: POSITIONS * extent, traction: TRACTIONS * traction + FORCES * stressed }
    }

    /// A signed length; one that cannot be told from zero is zero.
    pub fn length_of(self, value: f64) -> f64 {
        if value.abs() > self.length { value } else { 0.0 }
    }

    /// A vector of lengths; one that cannot be told from zero is zero.
    pub fn vector_of(self, vector: [f64; 3]) -> [f64; 3] {
        if norm(vector) > self.length { vector } else { [0.0; 3] }
    }

    /// Whether a traction is above a bound; `present` where they are equal.
    pub fn exceeds(self, traction: f64, bound: f64, present: bool) -> bool {
        let margin = self.traction.max(TRACTIONS * bound.abs());
        if present { traction >= bound - margin } else { traction > bound + margin }
    }
}

/// Whether a number is above another of its unit; not where they are equal.
pub fn is_more(value: f64, than: f64) -> bool {
    value > than + TRACTIONS * than.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_keep_the_present_state_in_all_units() {
        for unit in [1.0, 1e6, 1e-6] {
            let tolerances = Tolerances::of(0.0, 10.0 * unit, 0.0);
            for round_off in [-1e-13, 0.0, 1e-13] {
                for present in [false, true] {
                    assert_eq!(tolerances.exceeds((3.0 + round_off) * unit, 3.0 * unit, present), present);
                    assert_eq!(tolerances.exceeds(round_off * unit, 0.0, present), present);
                }
            }
            assert!(tolerances.exceeds(3.1 * unit, 3.0 * unit, false));
            assert!(!tolerances.exceeds(2.9 * unit, 3.0 * unit, true));
        }
    }

    #[test]
    fn lengths_of_round_off_are_none() {
        let tolerances = Tolerances::of(1e3, 0.0, 0.0);
        assert_eq!((tolerances.length_of(-1e-13), tolerances.length_of(-1e-10)), (0.0, -1e-10));
        assert_eq!(tolerances.vector_of([1e-13, 0.0, -1e-13]), [0.0; 3]);
        assert!(!is_more(1.0 + 1e-14, 1.0) && is_more(1.1, 1.0) && !is_more(0.0, 0.0));
    }
}
