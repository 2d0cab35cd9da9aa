//! Line search: how much of Newton's increment is taken.
//!
//! The work w(s) = Δ · b(u + s Δ) of the increment on the residual vanishes where the energy is stationary along it. The
//! search looks for an s with |w(s)| ≤ tolerance · |w(0)| by secants, inside a bracket once w has changed its sign.

use crate::diagnostics::Result;
use crate::parameters::{Defaults, Node, Settings};

/// Default settings.
pub(super) const DEFAULTS: &str = include_str!("../../../configs/strategies/line_search.json");

/// Settings of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineSearch {
    iterations: usize,
    first: f64,
    second: f64,
    least: f64,
    most: f64,
    tolerance: f64,
}

/// A factor tried, with the work there; `None` where the state cannot be computed, e.g. an inverted element.
type TrialFactor = (f64, Option<f64>);

impl LineSearch {
    /// From `advanced_settings` of the strategy.
    ///
    /// # Errors
    /// Keys that are not known, values that do not fit.
    pub fn new(advanced: &Node) -> Result<Self> {
        let (settings, _) = Settings::check(advanced, &Defaults::parse("line_search", DEFAULTS)?)?;
        let number = |key: &str| settings.get_f64(key);
        let search = Self {
            iterations: settings.get_usize("max_line_search_iterations")?,
            first: number("first_alpha_value")?,
            second: number("second_alpha_value")?,
            least: number("min_alpha")?,
            most: number("max_alpha")?,
            tolerance: number("line_search_tolerance")?,
        };
        if !(0.0 < search.least && search.least <= search.most) {
            let fact = format!("\"min_alpha\" {} and \"max_alpha\" {} are no range", search.least, search.most);
            return Err(settings
                .error("min_alpha", "line-search", fact)
                .remedy("0.1 and 2.0 are the usual values")
                .into());
        }
        Ok(search)
    }

    /// The best factor found; `work` evaluates w at a factor, `before` is w(0).
    ///
    /// # Errors
    /// As `work`.
    pub fn search(&self, before: f64, mut work: impl FnMut(f64) -> Result<Option<f64>>) -> Result<f64> {
        let enough = self.tolerance * before.abs();
        let size = |tried: &TrialFactor| tried.1.map_or(f64::INFINITY, f64::abs);
        let mut low: TrialFactor = (0.0, Some(before));
        let mut high: TrialFactor = (self.second, work(self.second)?);
        let mut best = high;
        for turn in 0..self.iterations {
            if size(&best) <= enough {
                break;
            }
            let middle = if turn == 0 && high.1.is_none() { self.first } else { 0.5 * (low.0 + high.0) };
            let next = match (low.1, high.1) {
                (Some(a), Some(b)) if (a - b).abs() > 1e-10 * a.abs().max(b.abs()) => {
                    (a * high.0 - b * low.0) / (a - b)
                }
                _ => middle,
            };
            let next = next.clamp(self.least, self.most);
            if next == low.0 || next == high.0 {
                break;
            }
            let tried = (next, work(next)?);
            if size(&tried) < size(&best) {
                best = tried;
            }
            let crossed = |a: &TrialFactor, b: &TrialFactor| a.1.zip(b.1).is_none_or(|(a, b)| a * b < 0.0);
            if tried.1.is_none() || crossed(&low, &tried) {
                high = tried;
            } else if crossed(&tried, &high) && tried.0 < high.0 {
                low = tried;
            } else {
                (low, high) = (high, tried);
            }
        }
        Ok(if best.1.is_some() { best.0 } else { self.least })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search() -> LineSearch {
        LineSearch { iterations: 5, first: 0.5, second: 1.0, least: 0.1, most: 2.0, tolerance: 0.5 }
    }

    #[test]
    fn a_full_step_that_is_good_enough_is_taken_at_once() {
        let mut count = 0;
        let factor = search().search(1.0, |s| {
            count += 1;
            Ok(Some(1.0 - s))
        });
        assert_eq!((factor.unwrap(), count), (1.0, 1));
    }

    #[test]
    fn an_increment_that_is_too_long_or_too_short_is_corrected() {
        for root in [0.3, 1.7] {
            let work = |s: f64| (root - s) * (1.0 + s * s);
            let factor = search().search(work(0.0), |s| Ok(Some(work(s)))).unwrap();
            assert!(work(factor).abs() <= 0.5 * work(0.0).abs(), "{root}: {factor}");
        }
    }

    #[test]
    fn states_that_cannot_be_computed_are_stepped_back_from() {
        let factor = search().search(1.0, |s| Ok((s < 0.4).then_some(0.2))).unwrap();
        assert!(factor < 0.4, "{factor}");
    }
}
