//! Active sets that come back: found, said and broken.
//!
//! A set that returns after others is a cycle: Newton's iteration would run through it for ever. It is broken by the first
//! of these that helps, before the step is cut:
//!
//! 1. nodes of the cycle that stick and slide in turn are kept sliding until nothing else changes;
//! 2. from then on one node a time changes, the first by place (least x, then y, then z) of those that want to.

use std::collections::BTreeSet;

use zelus_core::diagnostics::Diagnostic;

use crate::active_set::Decision;
use crate::formulations::NodeState;

/// Longest cycle that is looked for, in iterations.
const LONGEST: usize = 6;
/// Nodes that a warning names.
const NAMED: usize = 8;

/// What is done about cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Remedy {
    Nothing,
    KeepSliding,
    OneByOne,
}

/// The sets of a step's iterations.
#[derive(Debug, Clone)]
pub(super) struct CycleGuard {
    sets: Vec<Vec<NodeState>>,
    remedy: Remedy,
    held: BTreeSet<u32>,
    warned: bool,
}

impl Default for CycleGuard {
    fn default() -> Self {
        Self { sets: Vec::new(), remedy: Remedy::Nothing, held: BTreeSet::new(), warned: false }
    }
}

impl CycleGuard {
    /// A step begins.
    pub(super) fn begin_step(&mut self) {
        *self = Self { warned: self.warned, ..Self::default() };
    }

    /// Takes back what the remedy in force does not allow to change.
    ///
    /// `places` are the initial positions of all nodes: an order by them does not depend on numbers.
    pub(super) fn restrict(&mut self, decisions: &mut [(u32, Decision)], before: &[NodeState], places: &[[f64; 3]]) {
        let changes = |(_, decision): &(u32, Decision), was: NodeState| decision.state != was;
        if !self.held.is_empty() {
            let quiet = decisions.iter().zip(before).all(|(d, &was)| !changes(d, was) || self.held.contains(&d.0));
            if quiet {
                self.held.clear();
                self.remedy = Remedy::OneByOne;
            }
            for ((node, decision), &was) in decisions.iter_mut().zip(before) {
                if self.held.contains(node) && decision.state.is_active() && was.is_active() {
                    decision.stay(NodeState::Slip, was);
                }
            }
        }
        if self.remedy == Remedy::OneByOne {
            let changing: Vec<usize> = (0..decisions.len()).filter(|&at| changes(&decisions[at], before[at])).collect();
            let place = |at: usize| places[decisions[at].0 as usize];
            let by_place = |a: &[f64; 3], b: &[f64; 3]| {
                (0..3).map(|c| a[c].total_cmp(&b[c])).find(|order| order.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
            };
            let first = changing.iter().copied().min_by(|&a, &b| by_place(&place(a), &place(b)));
            for at in changing.into_iter().filter(|&at| Some(at) != first) {
                decisions[at].1.stay(before[at], before[at]);
            }
        }
    }

    /// Keeps the set of an iteration; the warning when a cycle is met for the first time in the run.
    pub(super) fn keep(&mut self, decisions: &[(u32, Decision)], ids: &[usize], step: usize) -> Option<Diagnostic> {
        self.sets.push(decisions.iter().map(|(_, decision)| decision.state).collect());
        if self.remedy == Remedy::OneByOne || !self.held.is_empty() {
            return None;
        }
        let period = self.period()?;
        let states = &self.sets[self.sets.len() - period..];
        let cycling: Vec<usize> =
            (0..decisions.len()).filter(|&at| states.iter().any(|set| set[at] != states[0][at])).collect();
        let turns = |at: &usize| states.iter().all(|set| set[*at].is_active());
        self.held = cycling.iter().copied().filter(turns).map(|at| decisions[at].0).collect();
        self.remedy = if self.held.is_empty() { Remedy::OneByOne } else { Remedy::KeepSliding };
        if std::mem::replace(&mut self.warned, true) {
            return None;
        }
        let names: Vec<String> =
            cycling.iter().take(NAMED).map(|&at| ids[decisions[at].0 as usize].to_string()).collect();
        let more = if cycling.len() > NAMED { " and others" } else { "" };
        let fact = format!(
            "step {step}: the contact states of nodes {}{more} come back every {period} iterations",
            names.join(" ")
        );
        Some(Diagnostic::warning("contact-cycle", fact).remedy(
            "nothing to do: they are kept sliding, then changed one by one, and the step is cut if neither helps; a shorter \
             \"time_step\" may avoid it",
        ))
    }

    /// Iterations after which the sets repeat, seen twice over.
    fn period(&self) -> Option<usize> {
        let sets = &self.sets;
        let last = sets.len();
        (2..=LONGEST.min(last / 2)).find(|&period| {
            (0..period).all(|back| sets[last - 1 - back] == sets[last - 1 - back - period])
                && sets[last - period..].windows(2).any(|pair| pair[0] != pair[1])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use NodeState::{Inactive, Slip, Stick};

    fn decisions(states: &[NodeState]) -> Vec<(u32, Decision)> {
        states.iter().enumerate().map(|(at, &state)| (at as u32, Decision::plain(state))).collect()
    }

    /// Runs a rule that wants `wants(iteration)`; gives the states after each iteration.
    fn run(
        guard: &mut CycleGuard,
        wants: impl Fn(usize, &[NodeState]) -> Vec<NodeState>,
        count: usize,
    ) -> Vec<Vec<NodeState>> {
        let mut states = wants(0, &[]);
        let mut out = Vec::new();
        for iteration in 1..=count {
            let mut list = decisions(&wants(iteration, &states));
            guard.restrict(&mut list, &states, &[[0.0; 3], [1.0; 3], [2.0; 3]]);
            guard.keep(&list, &[1, 2, 3], 1);
            states = list.iter().map(|(_, d)| d.state).collect();
            out.push(states.clone());
        }
        out
    }

    #[test]
    fn nodes_that_stick_and_slide_in_turn_are_kept_sliding() {
        let mut guard = CycleGuard::default();
        let wants = |i: usize, _: &[NodeState]| match i % 2 {
            0 => vec![Stick, Slip, Inactive],
            _ => vec![Slip, Slip, Slip],
        };
        let seen = run(&mut guard, wants, 6);
        assert_eq!((seen[1][0], seen[5][0]), (Stick, Slip));
        assert_eq!(guard.remedy, Remedy::KeepSliding);
    }

    #[test]
    fn then_nodes_change_one_by_one() {
        let mut guard = CycleGuard::default();
        let flip = |s: NodeState| if s == Inactive { Slip } else { Inactive };
        let wants = |i: usize, now: &[NodeState]| {
            if i == 0 { vec![Inactive; 3] } else { now.iter().map(|s| flip(*s)).collect() }
        };
        let seen = run(&mut guard, wants, 6);
        assert_eq!(guard.remedy, Remedy::OneByOne);
        let changed = (0..3).filter(|&n| seen[4][n] != seen[5][n]).count();
        assert_eq!(changed, 1);
    }

    #[test]
    fn sets_that_settle_are_no_cycle() {
        let mut guard = CycleGuard::default();
        run(&mut guard, |i, _| vec![if i < 3 { Stick } else { Slip }; 3], 8);
        assert_eq!(guard.remedy, Remedy::Nothing);
    }
}
