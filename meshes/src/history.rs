//! A quantity over the time of an analysis.

/// Values at instants, linear between them, constant before the first and after the last.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    points: Vec<[f64; 2]>,
}

impl Default for History {
    fn default() -> Self {
        Self::constant(0.0)
    }
}

impl History {
    /// The same value at all times.
    pub fn constant(value: f64) -> Self {
        Self { points: vec![[0.0, value]] }
    }

    /// From 0 at time 0 to `value` at `time`.
    pub fn ramp(time: f64, value: f64) -> Self {
        Self::of(vec![[0.0, 0.0], [time, value]])
    }

    /// The history through these points: time, which does not fall, and value. Without any it is zero.
    pub fn of(points: Vec<[f64; 2]>) -> Self {
        if points.is_empty() { Self::default() } else { Self { points } }
    }

    /// Time and value of each point.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// The value of all times, where it is one.
    pub fn as_constant(&self) -> Option<f64> {
        let first = self.points[0][1];
        self.points.iter().all(|point| point[1] == first).then_some(first)
    }

    /// The value at a time.
    pub fn at(&self, time: f64) -> f64 {
        let after = self.points.partition_point(|point| point[0] < time);
        match (after.checked_sub(1).map(|at| self.points[at]), self.points.get(after)) {
            (Some([t0, v0]), Some(&[t1, v1])) => v0 + (v1 - v0) * (time - t0) / (t1 - t0),
            (Some([_, value]), None) | (None, Some(&[_, value])) => value,
            (None, None) => 0.0,
        }
    }

    /// The same up to `start`, then these points.
    #[must_use]
    pub fn then(&self, start: f64, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let mut all: Vec<[f64; 2]> = self.points.iter().copied().filter(|point| point[0] < start).collect();
        all.push([start, self.at(start)]);
        all.extend(points);
        Self { points: all }
    }

    /// Its values times a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self { points: self.points.iter().map(|[time, value]| [*time, value * factor]).collect() }
    }

    /// The sum of both.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let mut times: Vec<f64> = self.points.iter().chain(&other.points).map(|point| point[0]).collect();
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        Self { points: times.into_iter().map(|time| [time, self.at(time) + other.at(time)]).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_linear_between_points_and_constant_beyond() {
        let history = History::of(vec![[1.0, 2.0], [3.0, 6.0]]);
        assert_eq!([0.0, 1.0, 2.0, 3.0, 9.0].map(|time| history.at(time)), [2.0, 2.0, 4.0, 6.0, 6.0]);
        let sum = history.plus(&History::ramp(2.0, 10.0).scaled(-1.0));
        assert_eq!([0.0, 1.0, 2.0, 3.0].map(|time| sum.at(time)), [2.0, -3.0, -6.0, -4.0]);
    }

    #[test]
    fn a_later_step_goes_on_from_the_value_of_the_one_before() {
        let history = History::ramp(1.0, 4.0).then(1.0, [[2.0, 0.0]]);
        assert_eq!([0.5, 1.0, 1.5, 2.0].map(|time| history.at(time)), [2.0, 4.0, 2.0, 0.0]);
        assert_eq!((History::default().as_constant(), history.as_constant()), (Some(0.0), None));
    }
}
