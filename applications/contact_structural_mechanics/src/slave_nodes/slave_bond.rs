//! The bond of a slave node.

use serde::{Deserialize, Serialize};

use crate::law::{Bond, BondNumbers, BondState, BondTangent};
use crate::mortar::tangential;

/// The bond of a slave node.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SlaveBond {
    /// Its present state.
    pub state: BondState,
    /// Its state that was accepted last.
    pub last: BondState,
    /// Its present tangential opening (length).
    pub sliding: [f64; 3],
    /// Its tractions at the present opening; `None` before they are known.
    pub tangent: Option<BondTangent>,
    /// Normal traction that the surface would have if it were closed (force per area).
    closed: f64,
    /// Whether the surface has failed, is closed and slides.
    slides: bool,
    /// Energy by area that friction has dissipated since the last accepted state.
    heat: f64,
}

impl SlaveBond {
    /// Its numbers for the decision on the node, with the normal of which.
    pub fn numbers(&self, normal: [f64; 3]) -> Option<BondNumbers> {
        let tangent = self.tangent?;
        let along = tangential(tangent.tangential, normal);
        Some(BondNumbers {
            normal: tangent.normal,
            closed: self.closed,
            tangential: along,
            holds: self.last.holds(),
            slides: self.slides,
        })
    }

    /// Takes up the bond at the present opening.
    pub(super) fn take(&mut self, found: &Bond) {
        (self.state, self.tangent, self.heat) = (found.state, Some(found.tangent), found.heat);
        (self.closed, self.slides) = (found.closed, found.slides);
    }

    /// Whether it has failed in the step, and the surfaces are apart.
    pub(super) fn has_parted(&self) -> bool {
        self.last.holds() && !self.state.holds() && self.closed > 0.0
    }

    /// Energy by area that damage and friction have dissipated since the last accepted state.
    pub fn dissipated(&self) -> f64 {
        self.state.dissipated - self.last.dissipated + self.heat
    }
}
