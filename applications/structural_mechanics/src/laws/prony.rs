//! Prony series: the generalised Maxwell model of relaxation.
//!
//! The shear stiffness falls as g(t) = 1 − Σ g_i (1 − exp(−t/τ_i)) from that of the elastic constants, which are instantaneous. With the
//! elastic stress S_e of the part that relaxes, each branch carries H_i(t) = g_i ∫ exp(−(t − s)/τ_i) dS_e/ds ds, and
//!
//! S = (1 − Σ g_i) S_e + Σ H_i, H_i ← exp(−x) H_i + g_i ξ(x) (S_e − S_e of the step before), x = Δt/τ_i, ξ = (1 − exp(−x))/x.
//!
//! The recurrence is exact where S_e is linear within each step (Simo and Hughes, Computational Inelasticity, § 10.3). The history of a
//! point is whether a step has been accepted and its TIME, S_e, and H_i, with components xx yy zz xy yz xz.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;

use super::constants::list;
use crate::tensor::{Tensor, stress_tensor, stress_vector};

/// Constants of the series.
pub const CONSTANTS: [&str; 2] = ["PRONY_SHARES", "PRONY_TIMES"];

/// Shares g_i and times τ_i.
#[derive(Debug, Clone, PartialEq)]
pub struct PronySeries {
    branches: Vec<[f64; 2]>,
}

/// The present step of a point: stress is `factor` S_e plus `remembered`.
#[derive(Debug, Clone, Copy)]
pub struct Relaxation {
    /// 1 − Σ g_i + Σ g_i ξ_i.
    pub(super) factor: f64,
    /// Σ exp(−x_i) H_i − g_i ξ_i S_e of the step before.
    pub(super) remembered: Tensor,
}

/// exp(−x) and (1 − exp(−x))/x.
fn decay(x: f64) -> [f64; 2] {
    [(-x).exp(), if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 }]
}

impl PronySeries {
    /// The series of the properties, where they give one.
    ///
    /// # Errors
    /// Lists of different lengths, shares out of range, times that are not positive.
    pub(super) fn of(properties: &Properties) -> Result<Option<Self>> {
        if CONSTANTS.iter().any(|name| properties.values.contains_key(*name)) {
            Self::required(properties).map(Some)
        } else {
            Ok(None)
        }
    }

    /// The series of the properties.
    ///
    /// # Errors
    /// As [`PronySeries::of`], and lists that are missing.
    pub(super) fn required(properties: &Properties) -> Result<Self> {
        let (shares, times) = (list(properties, CONSTANTS[0])?, list(properties, CONSTANTS[1])?);
        let problem = |fact: String, remedy: &str| {
            Diagnostic::error("material-out-of-range", fact).at(properties.place.clone()).remedy(remedy.to_owned())
        };
        if shares.is_empty() || shares.len() != times.len() {
            let fact = format!(
                "properties {} have {} PRONY_SHARES and {} PRONY_TIMES",
                properties.id,
                shares.len(),
                times.len()
            );
            return Err(problem(fact, "give one share and one time for each branch").into());
        }
        let sum: f64 = shares.iter().sum();
        if shares.iter().any(|share| share.is_nan() || *share <= 0.0) || sum >= 1.0 {
            let fact = format!("PRONY_SHARES of properties {} are {shares:?}, their sum {sum}", properties.id);
            return Err(problem(fact, "give positive shares of the instantaneous modulus with a sum below 1").into());
        }
        if times.iter().any(|time| !(*time > 0.0 && time.is_finite())) {
            let fact = format!("PRONY_TIMES of properties {} are {times:?}", properties.id);
            return Err(problem(fact, "give positive times").into());
        }
        Ok(Self { branches: shares.iter().zip(times.iter()).map(|(share, time)| [*share, *time]).collect() })
    }

    /// Numbers of history.
    pub(super) fn history(&self) -> usize {
        8 + 6 * self.branches.len()
    }

    fn duration(history: &[f64], step: [f64; 2], elastic: bool) -> f64 {
        let begin = if history[0] > 0.0 { history[1] } else { step[0] };
        if elastic { 0.0 } else { (step[1] - begin).max(0.0) }
    }

    fn read(history: &[f64]) -> Tensor {
        let values: &[f64; 6] = history.first_chunk().expect("six components");
        stress_tensor(values)
    }

    /// Factor and memory of the step from the history before it; `elastic` as in the state.
    pub(super) fn step(&self, history: &[f64], step: [f64; 2], elastic: bool) -> Relaxation {
        let duration = Self::duration(history, step, elastic);
        let before = Self::read(&history[2..]);
        let mut out = Relaxation { factor: 1.0, remembered: Tensor::zeros() };
        for ([share, time], own) in self.branches.iter().zip(history[8..].chunks_exact(6)) {
            let [kept, mean] = decay(duration / time);
            out.factor -= share * (1.0 - mean);
            out.remembered += kept * Self::read(own) - share * mean * before;
        }
        out
    }

    /// History after the step, at whose end the elastic stress is `stress`.
    pub(super) fn advance(&self, stress: &Tensor, step: [f64; 2], elastic: bool, history: &mut [f64]) {
        if elastic {
            return;
        }
        let duration = Self::duration(history, step, elastic);
        let change = stress - Self::read(&history[2..]);
        for ([share, time], own) in self.branches.iter().zip(history[8..].chunks_exact_mut(6)) {
            let [kept, mean] = decay(duration / time);
            let next = kept * Self::read(own) + share * mean * change;
            own.copy_from_slice(&stress_vector::<6>(&next));
        }
        history[..2].copy_from_slice(&[1.0, step[1]]);
        history[2..8].copy_from_slice(&stress_vector::<6>(stress));
    }
}
