//! How far a run has come, in one line for a terminal.

use std::time::Duration;

use zelus_core::strategies::Plan;

/// Shares of a stage below which no time is guessed from them.
const LEAST_SHARE: f64 = 1e-3;

/// Step, share of the stage that is done, and the present phase.
#[derive(Debug, Default)]
pub(super) struct Progress {
    plan: Option<Plan>,
    step: usize,
    /// Time at the end of the last accepted step.
    reached: f64,
    iteration: usize,
    phase: &'static str,
    /// Share that was done when this program began, and when that was.
    base: Option<(f64, Duration)>,
}

impl Progress {
    pub(super) fn begin_stage(&mut self, plan: Plan) {
        *self = Self { plan: Some(plan), reached: plan.start, ..Self::default() };
    }

    /// A step from `reached` begins, `elapsed` after the start of the program.
    pub(super) fn begin_step(&mut self, step: usize, reached: f64, elapsed: Duration) {
        (self.step, self.reached, self.iteration) = (step, reached, 0);
        let share = self.share();
        self.base.get_or_insert((share, elapsed));
    }

    pub(super) fn end_iteration(&mut self, iteration: usize) {
        self.iteration = iteration;
    }

    pub(super) fn end_step(&mut self, reached: f64) {
        self.reached = reached;
    }

    pub(super) fn phase(&mut self, phase: &'static str) {
        self.phase = phase;
    }

    /// Completed share of the stage, from 0 to 1.
    fn share(&self) -> f64 {
        let Some(plan) = self.plan else { return 0.0 };
        ((self.reached - plan.start) / (plan.end - plan.start)).clamp(0.0, 1.0)
    }

    /// How long the rest of the stage takes, if it goes on as it has.
    fn left(&self, elapsed: Duration) -> Option<Duration> {
        let (done, begun) = self.base?;
        let share = self.share();
        let rate = (share - done) / elapsed.checked_sub(begun)?.as_secs_f64();
        (share - done > LEAST_SHARE).then(|| Duration::from_secs_f64((1.0 - share) / rate))
    }

    /// The line, `elapsed` after the start of the program.
    pub(super) fn line(&self, elapsed: Duration) -> String {
        let mut parts = Vec::new();
        if let Some(plan) = self.plan {
            if plan.stages > 1 {
                parts.push(format!("stage {} of {}", plan.stage, plan.stages));
            }
            if self.step > 0 {
                let of = plan.steps.filter(|steps| *steps >= self.step).map(|steps| format!(" of {steps}"));
                parts.push(format!("step {}{}", self.step, of.unwrap_or_default()));
                parts.push(format!("{:.0} %", 100.0 * self.share()));
            }
        }
        parts.extend(self.left(elapsed).map(|left| format!("{} left", words(left))));
        if self.iteration > 0 {
            parts.push(format!("{} iterations", self.iteration));
        }
        if !self.phase.is_empty() {
            parts.push(self.phase.to_owned());
        }
        parts.join(", ")
    }
}

/// A time as people say it.
fn words(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..60 => format!("{seconds} s"),
        seconds @ 60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        seconds => format!("{} h {} min", seconds / 3600, seconds / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAN: Plan = Plan { stage: 2, stages: 3, start: 1.0, end: 2.0, steps: Some(4) };
    const SECOND: Duration = Duration::from_secs(1);

    #[test]
    fn the_line_says_step_share_time_left_and_phase() {
        let mut progress = Progress::default();
        progress.begin_stage(PLAN);
        progress.phase("search");
        assert_eq!(progress.line(SECOND), "stage 2 of 3, search");
        progress.begin_step(1, 1.0, SECOND);
        progress.end_iteration(3);
        assert_eq!(progress.line(SECOND), "stage 2 of 3, step 1 of 4, 0 %, 3 iterations, search");
        progress.end_step(1.25);
        progress.begin_step(2, 1.25, 31 * SECOND);
        progress.phase("solve");
        assert_eq!(progress.line(31 * SECOND), "stage 2 of 3, step 2 of 4, 25 %, 1 min 30 s left, solve");
    }

    #[test]
    fn what_a_run_goes_on_from_took_no_time_of_it() {
        let mut progress = Progress::default();
        progress.begin_stage(Plan { stages: 1, steps: None, ..PLAN });
        progress.begin_step(41, 1.5, SECOND);
        progress.begin_step(42, 1.75, 3 * SECOND);
        assert_eq!(progress.line(3 * SECOND), "step 42, 75 %, 2 s left");
    }

    #[test]
    fn times_are_said_in_words() {
        let said: Vec<String> = [0, 59, 60, 3599, 3600, 7325].map(|s| words(s * SECOND)).into();
        assert_eq!(said, ["0 s", "59 s", "1 min 0 s", "59 min 59 s", "1 h 0 min", "2 h 2 min"]);
    }
}
