//! Decides whether Newton's iteration converges linearly (extend it) or oscillates between two states (cut the step).

use super::records::IterationRecord;

/// Largest ratio of two measures, one iteration apart, of a steady convergence.
const RATE: f64 = 0.7;

/// Whether `more` iterations, at the convergence rate of the last two, take every measure to its tolerance. All measures above their
/// tolerance fell by [`RATE`] or better in both, and no interaction changed state in them.
pub(super) fn converges_linearly(records: &[IterationRecord], more: usize) -> bool {
    let [.., first, second, last] = records else { return false };
    if [second, last].iter().any(|record| record.active_set_changes + record.stick_slip_changes > 0) {
        return false;
    }
    let checks = last.checks.iter().zip(&second.checks).zip(&first.checks);
    checks.filter(|((last, _), _)| !last.converged).all(|((last, second), first)| {
        let rate = (last.ratio / second.ratio).max(second.ratio / first.ratio);
        rate <= RATE && last.ratio * rate.powi(more as i32) <= last.ratio_tolerance
    })
}

/// Most iterations of a step whose contact zone advances.
pub(super) const LONGEST_ADVANCE: usize = 500;
/// Iterations whose largest measures are compared with those of as many before, and the ratio that is an advance.
const WINDOW: usize = 5;
const ADVANCE: f64 = 0.9;

/// Whether a contact zone opens or closes node by node: states changed in the last [`WINDOW`] iterations, and the largest value of every measure
/// above its tolerance fell by [`ADVANCE`] or better beside that of the iterations before.
pub(super) fn advances(records: &[IterationRecord]) -> bool {
    let Some(first) = records.len().checked_sub(2 * WINDOW) else { return false };
    let (before, last) = records[first..].split_at(WINDOW);
    let largest = |records: &[IterationRecord], check: usize| {
        records.iter().map(|record| record.checks.get(check).map_or(f64::INFINITY, |own| own.ratio)).fold(0.0, f64::max)
    };
    let falls = |check: usize| largest(last, check) <= ADVANCE * largest(before, check);
    let open = last[WINDOW - 1].checks.iter().enumerate().filter(|(_, check)| !check.converged);
    last.iter().any(|record| record.active_set_changes > 0) && open.map(|(check, _)| check).all(falls)
}

/// Largest relative change of a measure over two iterations that counts as oscillation.
const SAME: f64 = 0.02;

/// Whether the iteration oscillates between two states while no interaction changes its own: points that yield in the one and not in
/// the other.
pub(super) fn oscillates(records: &[IterationRecord]) -> bool {
    let [.., a, b, c, d] = records else { return false };
    if [a, b, c, d].iter().any(|record| record.active_set_changes + record.stick_slip_changes > 0) {
        return false;
    }
    let back = |(before, now): (&IterationRecord, &IterationRecord)| {
        let mut open = before.checks.iter().zip(&now.checks).filter(|(_, now)| !now.converged).peekable();
        open.peek().is_some() && open.all(|(before, now)| (now.ratio - before.ratio).abs() <= SAME * before.ratio)
    };
    [(a, c), (b, d)].into_iter().all(back)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strategies::ConvergenceCheck;

    fn records<const N: usize>(ratios: [f64; N], changes: usize) -> Vec<IterationRecord> {
        let record = |(at, ratio): (usize, f64)| IterationRecord {
            iteration: at,
            checks: vec![ConvergenceCheck {
                label: "residual",
                ratio,
                ratio_tolerance: 1e-4,
                absolute: 1.0,
                absolute_tolerance: 0.0,
                converged: ratio <= 1e-4,
            }],
            active_set_changes: changes,
            stick_slip_changes: 0,
            changed_nodes: Vec::new(),
            linear_residual: 0.0,
            linear_iterations: 0,
            engine: String::new(),
            condition_number: None,
        };
        ratios.into_iter().enumerate().map(record).collect()
    }

    #[test]
    fn steady_convergence_goes_on_if_that_is_enough() {
        let steady = records([0.1, 0.03, 0.009], 0);
        assert!(converges_linearly(&steady, 4) && !converges_linearly(&steady, 3), "0.009 * 0.3^4 = 7e-5");
        assert!(!converges_linearly(&records([0.1, 0.03, 0.009], 1), 4), "states still change");
        assert!(!converges_linearly(&records([0.1, 0.3, 0.009], 0), 4), "up and down");
        assert!(!converges_linearly(&records([0.1, 0.09, 0.081], 0), 100), "too slow");
        assert!(!converges_linearly(&steady[1..], 4), "two are no rate");
    }

    #[test]
    fn a_zone_that_opens_node_by_node_goes_on() {
        let falling = [0.1, 0.08, 0.09, 0.07, 0.075, 0.06, 0.065, 0.05, 0.055, 0.04];
        assert!(advances(&records(falling, 2)));
        assert!(!advances(&records(falling, 0)), "states are settled");
        assert!(!advances(&records(falling, 2)[1..]), "too few");
        assert!(!advances(&records([0.1, 0.1, 0.1, 0.1, 0.1, 0.09, 0.08, 0.07, 0.095, 0.01], 2)), "too slow");
    }

    #[test]
    fn two_states_in_turn_are_no_progress() {
        assert!(oscillates(&records([0.1, 0.3688, 0.3837, 0.3690, 0.3838], 0)));
        assert!(!oscillates(&records([0.3688, 0.3837, 0.3690], 0)), "once is not to and fro");
        assert!(!oscillates(&records([0.3688, 0.3837, 0.3690, 0.3838], 1)), "states still change");
        assert!(!oscillates(&records([0.4, 0.3, 0.2, 0.1], 0)) && !oscillates(&records([0.1, 0.1, 1e-5, 1e-5], 0)));
    }
}
