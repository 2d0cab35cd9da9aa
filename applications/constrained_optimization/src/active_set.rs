//! The active-set strategies of the Lagrange multiplier method (eqs. D.5d, D.5e; of one spring D.18–D.20).
//!
//! 1: g ≤ 0. 2: λ ≤ 0. 3: g ≤ 0 or λ < 0. The third is printed with λ ≤ 0; then λ = 0 would close every wall that was
//! never touched, and Table D.10 would not follow the path of Table D.8.

use serde::Deserialize;

/// Criterion by which a constraint acts: gap or multiplier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "u8")]
pub enum ActiveSetStrategy {
    /// Strategy 1: the gap.
    Gap,
    /// Strategy 2: the multiplier.
    Multiplier,
    /// Strategy 3: either.
    Either,
}

impl ActiveSetStrategy {
    /// Whether a constraint acts; a gap up to `round_off` counts as closed.
    pub fn is_active(self, gap: f64, multiplier: f64, round_off: f64) -> bool {
        match self {
            Self::Gap => gap <= round_off,
            Self::Multiplier => multiplier <= 0.0,
            Self::Either => gap <= round_off || multiplier < 0.0,
        }
    }
}

impl TryFrom<u8> for ActiveSetStrategy {
    type Error = String;

    fn try_from(number: u8) -> Result<Self, String> {
        match number {
            1 => Ok(Self::Gap),
            2 => Ok(Self::Multiplier),
            3 => Ok(Self::Either),
            _ => Err(format!("the active-set strategy is 1, 2 or 3, not {number}")),
        }
    }
}
