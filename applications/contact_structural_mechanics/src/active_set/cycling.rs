//! Active sets that come back or do not come to rest: found, said and settled.
//!
//! A set that returns after others is a cycle: Newton's iteration would run through it for ever, because states change before
//! displacements have followed. From then on, and from a limit of iterations on, states change in converged states only: the set is
//! frozen until the iteration has converged with it, then the rules decide on an equilibrium. Where that comes back to a set too, or
//! takes long, open and closed nodes are exchanged by block principal pivoting, which is finite. Stick and slip have no such method:
//! where their sets come back, no set fulfils all conditions at the resolution of the mesh; that one is taken which violates them least,
//! if that is little, and the step fails otherwise.

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::{BlockPivoting, Exchange};

use crate::interface::SlaveIndex;
use crate::law::{Decision, NodeState};

/// Longest cycle that is looked for, in iterations.
const LONGEST: usize = 6;
/// Iterations after which sets that still change are frozen.
const ITERATIONS_BEFORE_FREEZING: usize = 15;
/// Converged states in which a frozen set may change.
const MOST_CHANGES: usize = 30;
/// Converged states of a step in which open and closed nodes are exchanged at most.
const MOST_EXCHANGES: usize = 500;
/// Violation, as a share of the largest pressure, that may stay where no set fulfils all conditions.
pub(crate) const ALLOWED: f64 = 0.01;
/// Nodes that a warning names.
const NAMED: usize = 8;

/// Outcome of a converged state with a frozen set.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum SetOutcome {
    /// The state fulfils the conditions, or nearly so where none does better.
    Done,
    /// States change, and the iteration goes on.
    Change,
    /// No set does.
    Failed(String),
}

/// The sets of a step's iterations.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct CycleGuard {
    #[serde(skip)]
    sets: Vec<Vec<NodeState>>,
    /// Whether states change in converged states only.
    #[serde(skip)]
    frozen: bool,
    /// Sets that have converged, with their violation.
    #[serde(skip)]
    converged: Vec<(Vec<NodeState>, f64)>,
    /// Which open and closed nodes are exchanged.
    #[serde(skip)]
    pivoting: BlockPivoting,
    /// Number of the converged sets when nodes began to be exchanged one by one; `None` while all are.
    #[serde(skip)]
    single_from: Option<usize>,
    warned: bool,
}

impl CycleGuard {
    /// A step begins.
    pub(crate) fn begin_step(&mut self) {
        *self = Self { warned: self.warned, ..Self::default() };
    }

    /// Lets states change in converged states only, or in every iteration.
    pub(crate) fn hold(&mut self, held: bool) {
        self.frozen = held;
    }

    /// Whether states change in converged states only.
    pub(crate) fn holds(&self) -> bool {
        self.frozen
    }

    /// Takes back all changes of a set that is frozen.
    pub(crate) fn restrict(&self, decisions: &mut [(SlaveIndex, Decision)], before: &[NodeState]) {
        if self.frozen {
            decisions.iter_mut().zip(before).for_each(|((_, decision), &was)| decision.stay(was, was));
        }
    }

    /// Keeps the set of an iteration; the warning when a cycle is met for the first time in the run.
    pub(crate) fn keep(
        &mut self,
        decisions: &[(SlaveIndex, Decision)],
        ids: &dyn Fn(SlaveIndex) -> usize,
        step: usize,
    ) -> Option<Diagnostic> {
        if self.frozen {
            return None;
        }
        self.sets.push(decisions.iter().map(|(_, decision)| decision.state).collect());
        let Some(period) = self.period() else {
            self.frozen = self.sets.len() >= ITERATIONS_BEFORE_FREEZING;
            return None;
        };
        self.frozen = true;
        if std::mem::replace(&mut self.warned, true) {
            return None;
        }
        let states = &self.sets[self.sets.len() - period..];
        let cycling = (0..decisions.len()).filter(|&at| states.iter().any(|set| set[at] != states[0][at]));
        let fact = format!(
            "step {step}: the contact states of nodes {} come back every {period} iterations",
            named(cycling.map(|at| ids(decisions[at].0)))
        );
        Some(Diagnostic::warning("contact-cycle", fact).remedy(
            "nothing to do: from here on they change in converged states only; a shorter \"time_step\" may avoid it",
        ))
    }

    /// Outcome of the decisions in a converged state with a frozen set, of which it may take back a part; `before` is
    /// that set, `largest` the largest pressure.
    ///
    /// All states change as they want to, unless that leads back to a set that has converged before. Then open and closed nodes are
    /// exchanged by block principal pivoting; of nodes that stick and slip one changes, that which is violated most of those that lead
    /// to a new set.
    pub(crate) fn settle(
        &mut self,
        decisions: &mut [(SlaveIndex, Decision)],
        before: &[NodeState],
        largest: f64,
        ids: &dyn Fn(SlaveIndex) -> usize,
    ) -> SetOutcome {
        let mut changing: Vec<usize> = (0..before.len()).filter(|&at| decisions[at].1.state != before[at]).collect();
        if changing.is_empty() {
            return SetOutcome::Done;
        }
        changing.sort_by(|&a, &b| decisions[b].1.excess.total_cmp(&decisions[a].1.excess));
        let violation = decisions[changing[0]].1.excess;
        let share = if largest > 0.0 { violation / largest } else { 1.0 };
        self.converged.push((before.to_vec(), share));
        let wanted: Vec<NodeState> = decisions.iter().map(|(_, decision)| decision.state).collect();
        let comes_back = self.has_converged(&wanted, 0);
        if !comes_back && self.converged.len() < MOST_CHANGES {
            return SetOutcome::Change;
        }
        // One node that leaves the state it has just taken, alone, has no state at all.
        let before_last = self.converged.iter().rev().nth(1);
        let is_endless = changing.len() == 1 && before_last.is_some_and(|(set, _)| *set == wanted);
        let opens = |&at: &usize| decisions[at].1.state.is_active() != before[at].is_active();
        if !is_endless && changing.iter().all(opens) && self.exchange(&changing, before, &wanted, decisions) {
            return SetOutcome::Change;
        }
        let single = |&at: &usize| {
            let mut set = before.to_vec();
            set[at] = wanted[at];
            !self.has_converged(&set, 0)
        };
        if let Some(one) = changing.iter().copied().find(single).filter(|_| self.converged.len() < MOST_CHANGES) {
            for at in changing.into_iter().filter(|&at| at != one) {
                decisions[at].1.stay(before[at], before[at]);
            }
            return SetOutcome::Change;
        }
        let best = self.converged.iter().map(|(_, share)| *share).fold(f64::INFINITY, f64::min);
        if share <= best && share <= ALLOWED {
            return SetOutcome::Done;
        }
        if best <= ALLOWED && self.converged.len() < 2 * MOST_CHANGES {
            return SetOutcome::Change;
        }
        let word = if changing.len() == 1 { "node" } else { "nodes" };
        let nodes = named(changing.into_iter().map(|at| ids(decisions[at].0)));
        SetOutcome::Failed(format!(
            "contact at {word} {nodes} does not settle (no consistent active set); violation {share:.2} × the largest pressure"
        ))
    }

    /// Whether a set has converged before, since `from` others had.
    fn has_converged(&self, set: &[NodeState], from: usize) -> bool {
        self.converged[from..].iter().any(|(known, _)| known == set)
    }

    /// Takes back all changes of open and closed nodes but those that block principal pivoting exchanges; `false` where that does not
    /// come to an end.
    fn exchange(
        &mut self,
        changing: &[usize],
        before: &[NodeState],
        wanted: &[NodeState],
        decisions: &mut [(SlaveIndex, Decision)],
    ) -> bool {
        if self.converged.len() >= MOST_EXCHANGES {
            return false;
        }
        if self.pivoting.next(changing.len()) == Exchange::All {
            self.single_from = None;
            return true;
        }
        let last = changing.iter().copied().max().expect("nodes that change");
        let mut set = before.to_vec();
        set[last] = wanted[last];
        let from = *self.single_from.get_or_insert(self.converged.len() - 1);
        // Single exchanges come back to a set where the conditions have no unique solution.
        if self.has_converged(&set, from) {
            return false;
        }
        for &at in changing.iter().filter(|&&at| at != last) {
            decisions[at].1.stay(before[at], before[at]);
        }
        true
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

/// Ids of some nodes, in words.
fn named(ids: impl Iterator<Item = usize>) -> String {
    let ids: Vec<usize> = ids.collect();
    let names: Vec<String> = ids.iter().take(NAMED).map(ToString::to_string).collect();
    format!("{}{}", names.join(" "), if ids.len() > NAMED { " and others" } else { "" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use NodeState::{Inactive, Slip, Stick};

    const IDS: fn(SlaveIndex) -> usize = |slave| slave.place() + 1;

    fn decisions(states: &[NodeState], excess: f64) -> Vec<(SlaveIndex, Decision)> {
        states
            .iter()
            .enumerate()
            .map(|(at, &state)| (SlaveIndex(at as u32), Decision { excess, ..Decision::plain(state) }))
            .collect()
    }

    /// Runs a rule that wants `wants(iteration)`; gives the states after each iteration.
    fn run(guard: &mut CycleGuard, wants: impl Fn(usize) -> Vec<NodeState>, count: usize) -> Vec<Vec<NodeState>> {
        let mut states = wants(0);
        let mut out = Vec::new();
        for iteration in 1..=count {
            let mut list = decisions(&wants(iteration), 0.0);
            guard.restrict(&mut list, &states);
            guard.keep(&list, &IDS, 1);
            states = list.iter().map(|(_, d)| d.state).collect();
            out.push(states.clone());
        }
        out
    }

    #[test]
    fn a_cycle_is_held_and_changes_in_converged_states() {
        let mut guard = CycleGuard::default();
        let wants = |i: usize| vec![[Stick, Slip][i % 2], Slip, Slip];
        let seen = run(&mut guard, wants, 8);
        assert!(guard.holds() && seen[3] == seen[7] && seen[2] != seen[3]);
        let mut wanted = decisions(&[Inactive, Slip, Slip], 1.0);
        assert_eq!(guard.settle(&mut wanted, &seen[7], 1.0, &IDS), SetOutcome::Change);
        assert_eq!(guard.settle(&mut wanted, &[Inactive, Slip, Slip], 1.0, &IDS), SetOutcome::Done);
    }

    #[test]
    fn of_two_sets_that_lead_to_each_other_the_better_is_taken_where_it_is_good() {
        let (one, other) = ([Slip; 3], [Slip, Slip, Inactive]);
        let run = |excess: [f64; 2]| {
            let mut guard = CycleGuard::default();
            let mut turn = |set: &[NodeState], wanted: &[NodeState], excess: f64| {
                guard.settle(&mut decisions(wanted, excess), set, 1.0, &IDS)
            };
            [turn(&one, &other, excess[0]), turn(&other, &one, excess[1]), turn(&one, &other, excess[0])]
        };
        assert_eq!(run([1e-3, 5e-3]), [SetOutcome::Change, SetOutcome::Change, SetOutcome::Done]);
        assert!(matches!(run([0.5, 0.5])[1], SetOutcome::Failed(_)));
    }

    #[test]
    fn several_nodes_that_come_back_together_change_one_by_one() {
        let (one, other) = ([Stick; 3], [Slip, Slip, Stick]);
        let mut guard = CycleGuard::default();
        assert_eq!(guard.settle(&mut decisions(&other, 1.0), &one, 1.0, &IDS), SetOutcome::Change);
        let mut wanted = decisions(&one, 1.0);
        wanted[1].1.excess = 2.0;
        assert_eq!(guard.settle(&mut wanted, &other, 1.0, &IDS), SetOutcome::Change);
        assert_eq!(wanted.iter().map(|(_, d)| d.state).collect::<Vec<_>>(), [Slip, Stick, Stick]);
    }

    /// Lets a guard settle sets, from all nodes open, by what they want; the set at rest and the number of sets, if it comes to rest.
    fn settled(count: usize, wants: impl Fn(&[NodeState]) -> Vec<NodeState>) -> Option<(Vec<NodeState>, usize)> {
        let (mut guard, mut set) = (CycleGuard::default(), vec![Inactive; count]);
        for round in 0.. {
            let mut wanted = decisions(&wants(&set), 1.0);
            match guard.settle(&mut wanted, &set, 1.0, &IDS) {
                SetOutcome::Done => return Some((set, round)),
                SetOutcome::Failed(_) => return None,
                SetOutcome::Change => set = wanted.iter().map(|(_, decision)| decision.state).collect(),
            }
        }
        None
    }

    fn exchanged(state: NodeState) -> NodeState {
        if state.is_active() { Inactive } else { Slip }
    }

    #[test]
    fn nodes_that_change_one_after_the_other_are_followed_to_the_end() {
        let wants = |set: &[NodeState]| {
            let next = set.iter().position(|state| !state.is_active());
            (0..set.len()).map(|at| if Some(at) == next { Slip } else { set[at] }).collect()
        };
        assert_eq!(settled(100, wants), Some((vec![Slip; 100], 100)));
    }

    #[test]
    fn open_and_closed_nodes_that_run_in_circles_come_to_the_set_that_fulfils_all_conditions() {
        // Conditions of w = q + M z: of each set the violated ones, for q = (−1 −3 2), M = (1 1 −2; 0 1 −2; 2 0 1).
        let violated = |set: &[NodeState]| match set {
            [Inactive, Inactive, Inactive] => vec![0, 1],
            [Slip, Inactive, Inactive] => vec![1],
            [Inactive, Slip, Inactive] => vec![],
            [Slip, Slip, Inactive] => vec![0, 2],
            [Inactive, Inactive, Slip] => vec![2],
            [Slip, Inactive, Slip] => vec![0, 1, 2],
            [Inactive, Slip, Slip] => vec![1, 2],
            _ => vec![0],
        };
        let wants = |set: &[NodeState]| {
            let violated = violated(set);
            (0..3).map(|at| if violated.contains(&at) { exchanged(set[at]) } else { set[at] }).collect()
        };
        assert_eq!(settled(3, wants).map(|(set, _)| set), Some(vec![Inactive, Slip, Inactive]));
    }

    #[test]
    fn sets_that_settle_are_no_cycle() {
        let mut guard = CycleGuard::default();
        run(&mut guard, |i| vec![if i < 3 { Stick } else { Slip }; 3], 8);
        assert!(!guard.holds());
        run(&mut guard, |_| vec![Slip; 3], 8);
        assert!(guard.holds(), "held where nothing changes does no harm");
    }
}
