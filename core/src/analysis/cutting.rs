//! Cutting of steps that do not converge, and growing back.

/// By how much, and how often, a step is shortened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cutting {
    /// Factor by which a step that fails becomes shorter, > 1.
    pub factor: f64,
    /// Cuts of one step before the run ends; 0 for none.
    pub times: u32,
}

impl Default for Cutting {
    /// Six halvings.
    fn default() -> Self {
        Self { factor: 2.0, times: 6 }
    }
}

/// The lengths tried on the way to the end of one of the deck's steps.
///
/// No attempt is shorter than the whole step cut as often as it may be, wherever in the step it stands: a shorter remainder at the end
/// of the step does not count.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lengths {
    factor: f64,
    whole: f64,
    shortest: f64,
    length: f64,
}

impl Lengths {
    /// Starts with a whole step, or with `first` where the step before had to be shortened.
    pub(super) fn new(cutting: Cutting, whole: f64, first: Option<f64>) -> Self {
        let shortest = whole / cutting.factor.powi(cutting.times as i32) * (1.0 - 1e-9);
        Self { factor: cutting.factor, whole, shortest, length: first.map_or(whole, |first| first.min(whole)) }
    }

    /// The end of the next attempt from `from`, and whether that is `target`.
    pub(super) fn next(&self, from: f64, target: f64) -> (f64, bool) {
        let last = self.length >= (target - from) * (1.0 - 1e-12);
        (if last { target } else { from + self.length }, last)
    }

    /// After an accepted attempt: grows back.
    pub(super) fn grow(&mut self) {
        self.length = (self.factor * self.length).min(self.whole);
    }

    /// After an attempt of length `tried` that failed: shortens; `false` when it may not.
    pub(super) fn cut(&mut self, tried: f64) -> bool {
        self.shorten(tried, self.shortest)
    }

    /// After an attempt of length `tried` that converged, but would better be shorter: shortens; `false` when that would leave
    /// no cut for one that fails.
    pub(super) fn refine(&mut self, tried: f64) -> bool {
        self.shorten(tried, self.factor * self.shortest)
    }

    fn shorten(&mut self, tried: f64, shortest: f64) -> bool {
        let length = self.length.min(tried) / self.factor;
        let may = length >= shortest && length < tried;
        if may {
            self.length = length;
        }
        may
    }

    /// The length to begin the next step with, when it should not be the whole one.
    pub(super) fn carry(&self) -> Option<f64> {
        (self.length < self.whole * (1.0 - 1e-9)).then_some(self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_shrink_with_each_failure_and_grow_back() {
        let mut lengths = Lengths::new(Cutting::default(), 1.0, None);
        assert_eq!(lengths.next(0.0, 1.0), (1.0, true));
        assert!(lengths.cut(1.0) && lengths.cut(0.5));
        assert_eq!(lengths.next(0.0, 1.0), (0.25, false));
        lengths.grow();
        assert_eq!(lengths.next(0.25, 1.0), (0.75, false));
        lengths.grow();
        assert_eq!(lengths.next(0.75, 1.0), (1.0, true));
        assert_eq!(lengths.carry(), None);
    }

    #[test]
    fn a_step_that_stayed_short_lets_the_next_begin_short() {
        let mut lengths = Lengths::new(Cutting { factor: 10.0, times: 3 }, 1.0, None);
        assert!(lengths.cut(1.0) && lengths.cut(0.1) && lengths.cut(0.01) && !lengths.cut(0.001));
        let next = Lengths::new(Cutting { factor: 10.0, times: 3 }, 1.0, lengths.carry());
        assert!((next.next(1.0, 2.0).0 - 1.001).abs() < 1e-12);
    }

    #[test]
    fn what_is_left_of_a_step_is_not_cut_without_end() {
        let mut lengths = Lengths::new(Cutting::default(), 1.0, None);
        let (mut time, mut attempts) = (0.0, 0);
        while time < 1.0 {
            attempts += 1;
            assert!(attempts < 1000, "at {time}");
            let (to, _) = lengths.next(time, 1.0);
            if !lengths.refine(to - time) {
                time = to;
                lengths.grow();
            }
        }
        // Each piece of 1/32 is tried at twice its length first, but for the last.
        assert_eq!(attempts, 5 + 32 + 30);
    }
}
