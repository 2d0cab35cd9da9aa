//! Lengths of the steps, as the deck gives them.

use crate::diagnostics::{Diagnostic, Error, Report, Result, did_you_mean};
use crate::model::Table;
use crate::parameters::{Interval, Node};

/// Share of a step that the length of one step may be off by.
const ROUND_OFF: f64 = 1e-9;
/// Share of a step that is more than the round-off of a sum, however many steps there are.
const LEAST_STEP: f64 = 1e-2;
/// Steps beyond which they are not counted ahead.
const MOST_COUNTED: usize = 1_000_000;

/// Steps that no run comes to the end of.
const MOST_STEPS: f64 = 1e10;

/// Length of a step, in lengths of the run, beyond which a deck asks for one whole step: steady states of transient heat by a long step.
const ONE_STEP: f64 = 1e4;

/// Steps of the deck: their lengths, and whether the last one ends at `end_time`.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeStepping {
    rule: StepLength,
    /// Treatment of the last step where it would pass the end time.
    last_step: LastStep,
    /// Whether one step far longer than the run is whole: it stands for the steady state.
    long_step: bool,
}

/// Share of a step beyond the end up to which decks mean the whole step: they write an end a little before that of their last step.
const MEANT: f64 = 0.5 + 1e-6;

/// The end of a run whose steps do not add up to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LastStep {
    /// It is whole where at least half of it is left, or where it is the only one and far longer than the run; it is shortened
    /// otherwise.
    Automatic,
    /// The last step ends there; a remainder of round-off is no step.
    Shortened,
    /// It is whole and goes beyond the end; a remainder of round-off is no step.
    Whole,
    /// There are steps while the time, as a number, is below the end.
    WhileBelow,
}

/// The rule that gives the next step's length from the present time.
#[derive(Debug, Clone, PartialEq)]
enum StepLength {
    /// `time_step`: always the same.
    Constant(f64),
    /// `time_step_table`: piecewise linear in time.
    Table(Table),
    /// `time_step_intervals`: the first interval, by name, that contains the time.
    Intervals(Vec<(Interval, f64)>),
}

impl TimeStepping {
    /// From the deck's `time_stepping` object; keys that nothing reads are warned of.
    ///
    /// # Errors
    /// No rule, or one that cannot be used.
    pub fn from_node(node: &Node, warnings: &mut Report) -> Result<Self> {
        const KEYS: [&str; 4] = ["time_step", "time_step_table", "time_step_intervals", "last_step"];
        for unknown in node.object()?.iter().filter(|member| !KEYS.contains(&member.key.as_str())) {
            let fact = format!("\"time_stepping\" has no key {:?}: nothing reads it", unknown.key);
            let remedy = did_you_mean(&unknown.key, KEYS).unwrap_or_else(|| format!("there is: {}", KEYS.join(", ")));
            let problem = Diagnostic::warning("unknown-key-ignored", fact).at(node.key_place(&unknown.key));
            warnings.push(problem.remedy(remedy));
        }
        let last_step = match node.get("last_step").map(|node| Ok::<_, Error>((node, node.str()?))).transpose()? {
            None | Some((_, "automatic")) => LastStep::Automatic,
            Some((_, "shortened")) => LastStep::Shortened,
            Some((_, "whole")) => LastStep::Whole,
            Some((_, "while_below")) => LastStep::WhileBelow,
            Some((node, word)) => {
                return Err(Diagnostic::error("invalid-value", format!("\"last_step\" is {word:?}"))
                    .at(node.place())
                    .remedy("write \"automatic\", \"shortened\", \"whole\" or \"while_below\"")
                    .into());
            }
        };
        let given: Vec<&str> = KEYS[..3].iter().copied().filter(|key| node.get(key).is_some()).collect();
        if let [acts, .., last] = given[..] {
            let fact = format!("\"time_stepping\" has {acts:?} and {last:?}: {acts:?} alone acts");
            let problem = Diagnostic::warning("time-step", fact).at(node.key_place(last));
            warnings.push(problem.remedy("keep the one that is meant"));
        }
        let rule = StepLength::from_node(node, warnings)?;
        if let Some(fact) = rule.overlap() {
            let problem = Diagnostic::warning("time-step", fact).at(node.key_place("time_step_intervals"));
            warnings.push(problem.remedy("let each interval end where the next begins"));
        }
        Ok(Self { rule, last_step, long_step: true })
    }

    /// The rule for a solver in which a step far longer than the run is not the steady state: it is shortened, with a warning.
    #[must_use]
    pub fn without_long_step(self) -> Self {
        Self { long_step: false, ..self }
    }

    /// End of the step of `length` from `time` in a run from `start` to `end`, and whether that step is shortened.
    pub fn target(&self, time: f64, length: f64, [start, end]: [f64; 2]) -> (f64, bool) {
        let beyond = time + length - end;
        let sums = (1.0 + (time - start) / length) * f64::EPSILON * start.abs().max(end.abs());
        let round_off = sums.clamp(ROUND_OFF * length, LEAST_STEP * length);
        let whole = (time + length, false);
        match self.last_step {
            LastStep::WhileBelow => whole,
            _ if beyond.abs() <= round_off => (end, false),
            LastStep::Whole => whole,
            LastStep::Automatic if beyond <= MEANT * length => whole,
            LastStep::Automatic if self.long_step && time <= start && length > ONE_STEP * (end - start) => whole,
            LastStep::Shortened if beyond <= 0.0 => whole,
            LastStep::Automatic | LastStep::Shortened => (end, true),
        }
    }

    /// Error of steps so short that the run would not end, or warning of one that is longer than twice the run and is
    /// therefore shortened.
    pub fn problem(&self, start: f64, end: f64) -> Option<Diagnostic> {
        let length = self.next(start).ok()?;
        if (end - start) / length > MOST_STEPS {
            let fact =
                format!("steps of {length} from {start} to {end} are more than {MOST_STEPS:e}: the run would not end");
            return Some(Diagnostic::error("time-step", fact).remedy("write a longer \"time_step\""));
        }
        if let Some(fact) = self.never_ends(start, end) {
            let remedy = "let every step be longer than zero up to \"end_time\"; beyond its last row a table goes on along its last line";
            return Some(Diagnostic::error("time-step", fact).remedy(remedy));
        }
        let (_, is_shortened) = self.target(start, length, [start, end]);
        is_shortened.then(|| {
            let fact =
                format!("\"time_step\" is {length}, and the run from {start} to {end} is shorter: one step ends there");
            let remedy = "write a time step that fits between \"start_time\" and \"end_time\"";
            Diagnostic::warning("time-step", fact).remedy(remedy)
        })
    }

    /// The fact that steps of a rule that varies come to nothing before `end`, among the steps that can be counted.
    fn never_ends(&self, start: f64, end: f64) -> Option<String> {
        if matches!(self.rule, StepLength::Constant(_)) {
            return None;
        }
        let mut time = start;
        for _ in 0..MOST_COUNTED {
            if time >= end {
                return None;
            }
            // A time without a step ends the run with its own error.
            let length = self.next(time).ok()?;
            if (end - start) / length > MOST_STEPS {
                return Some(format!(
                    "\"time_stepping\" gives a step of {length:e} at time {time}: the run would not end"
                ));
            }
            time = self.target(time, length, [start, end]).0;
        }
        None
    }

    /// Steps from `start` to `end`, where they can be counted.
    pub fn count(&self, start: f64, end: f64) -> Option<usize> {
        self.times(start, end).map(|times| times.len() - 1)
    }

    /// `start` and the ends of the steps from there to `end`, where they can be counted.
    pub fn times(&self, start: f64, end: f64) -> Option<Vec<f64>> {
        let mut times = vec![start];
        while times[times.len() - 1] < end && times.len() <= MOST_COUNTED {
            let time = times[times.len() - 1];
            times.push(self.target(time, self.next(time).ok()?, [start, end]).0);
        }
        (times[times.len() - 1] >= end).then_some(times)
    }

    /// Length of the step that begins at `time`.
    ///
    /// # Errors
    /// A time that no interval contains, or a table that gives no positive length.
    pub fn next(&self, time: f64) -> Result<f64> {
        self.rule.next(time)
    }
}

impl StepLength {
    fn from_node(node: &Node, warnings: &mut Report) -> Result<Self> {
        if let Some(step) = node.get("time_step") {
            let length = step.f64()?;
            if !(length > 0.0 && length.is_finite()) {
                return Err(Diagnostic::error("time-step", format!("\"time_step\" is {length}, it must be positive"))
                    .at(node.key_place("time_step"))
                    .remedy("write the length of a step, e.g. 0.1")
                    .into());
            }
            return Ok(Self::Constant(length));
        }
        if let Some(table) = node.get("time_step_table") {
            let mut points = Vec::new();
            for row in table.array()? {
                match row.array()? {
                    [time, step] => points.push([time.f64()?, step.f64()?]),
                    _ => {
                        return Err(Diagnostic::error("time-step", "a row of \"time_step_table\" is [time, step]")
                            .at(row.place())
                            .into());
                    }
                }
            }
            if !points.is_empty() {
                let fault = Table::fault("\"time_step_table\"", &points);
                fault.into_iter().for_each(|fault| warnings.push(fault.at(table.place())));
                return Ok(Self::Table(Table::new(points)));
            }
        }
        if let Some(intervals) = node.get("time_step_intervals") {
            let mut rules = Vec::new();
            for member in intervals.object()?.iter() {
                let interval = Interval::from_node(member.node.require("interval")?)?;
                rules.push((interval, member.node.require("time_step")?.f64()?));
            }
            if !rules.is_empty() {
                return Ok(Self::Intervals(rules));
            }
        }
        Err(Diagnostic::error("time-step", "\"time_stepping\" gives no step length")
            .at(node.place())
            .remedy("give \"time_step\", \"time_step_table\" or \"time_step_intervals\"")
            .into())
    }

    /// The fact that two intervals overlap by more than an end, of which the first by name acts.
    fn overlap(&self) -> Option<String> {
        let Self::Intervals(rules) = self else { return None };
        let pairs = rules.iter().enumerate().flat_map(|(at, (a, _))| rules[at + 1..].iter().map(move |(b, _)| (a, b)));
        let (from, to) = pairs
            .map(|(a, b)| (a.begin.max(b.begin), a.end.min(b.end)))
            .find(|(from, to)| to - from > ROUND_OFF * to.abs().max(from.abs()))?;
        Some(format!("two of \"time_step_intervals\" contain the times from {from} to {to}: the first by name acts"))
    }

    fn next(&self, time: f64) -> Result<f64> {
        let length = match self {
            Self::Constant(length) => *length,
            Self::Table(table) => table.value(time),
            Self::Intervals(rules) => {
                let found = rules.iter().find(|(interval, _)| interval.contains(time));
                found.map_or(f64::NAN, |(_, length)| *length)
            }
        };
        if length > 0.0 {
            Ok(length)
        } else {
            Err(Diagnostic::error("time-step", format!("\"time_stepping\" gives no positive step at time {time}"))
                .into())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Document;

    fn ends(stepping: &str, end: f64) -> Vec<f64> {
        let deck = Document::from_str(stepping, "deck.json").expect("JSON").root;
        let stepping = TimeStepping::from_node(&deck, &mut Report::new()).expect("steps");
        stepping.times(0.0, end).expect("a number of steps").split_off(1)
    }

    #[test]
    fn sums_of_steps_meet_the_end() {
        let tenths = ends(r#"{ "time_step": 0.1 }"#, 1.0);
        assert_eq!((tenths.len(), tenths[9]), (10, 1.0));
        let tenths = Document::from_str(r#"{ "time_step": 0.1 }"#, "deck.json").expect("JSON").root;
        let tenths = TimeStepping::from_node(&tenths, &mut Report::new()).expect("steps");
        assert_eq!([tenths.count(0.0, 1.0), tenths.count(0.5, 1.0), tenths.count(0.0, 1e9)], [Some(10), Some(5), None]);
        let many = ends(r#"{ "time_step": 1e-6 }"#, 1.0);
        assert_eq!((many.len(), many[999_999]), (1_000_000, 1.0), "their sum is off by 8e-12");
        let many = ends(r#"{ "time_step": 2e-6, "last_step": "whole" }"#, 1.0);
        assert_eq!((many.len(), many[499_999]), (500_000, 1.0));
    }

    #[test]
    fn the_last_step_is_what_the_deck_says() {
        let thirds = ends(r#"{ "time_step": 0.3 }"#, 1.0);
        assert_eq!((thirds.len(), thirds[3]), (4, 1.0));
        for (step, end, last) in
            [(1.1, 1.0, 1.1), (1e6, 1.0, 1e6), (10.0, 1.0, 1.0), (1.0, 3.99, 4.0), (0.02, 0.19, 0.2), (0.7, 1.0, 1.0)]
        {
            let found = ends(&format!("{{ \"time_step\": {step} }}"), end);
            assert!((found[found.len() - 1] - last).abs() < 1e-12 * last, "{step} to {end}: {found:?}");
        }
        assert_eq!(ends(r#"{ "time_step": 1.1, "last_step": "shortened" }"#, 1.0), [1.0]);
        assert_eq!(ends(r#"{ "time_step": 0.6, "last_step": "shortened" }"#, 1.0), [0.6, 1.0]);
        let thirds = ends(r#"{ "time_step": 0.3, "last_step": "whole" }"#, 1.0);
        assert!(thirds.len() == 4 && thirds[3] > 1.19);
        assert_eq!(ends(r#"{ "time_step": 1.1, "last_step": "whole" }"#, 1.0), [1.1]);
        let beyond = ends(r#"{ "time_step": 0.1, "last_step": "while_below" }"#, 1.0);
        assert!(beyond.len() == 11 && beyond[10] > 1.09, "ten tenths sum up to less than one");
    }

    #[test]
    fn steps_that_come_to_nothing_are_refused() {
        let problem = |table: &str| {
            let deck =
                Document::from_str(&format!(r#"{{ "time_step_table": {table} }}"#), "deck.json").expect("JSON").root;
            let stepping = TimeStepping::from_node(&deck, &mut Report::new()).expect("steps");
            stepping.problem(0.0, 4.0).map(|problem| problem.to_string())
        };
        let said = problem("[[0.0, 0.2], [1.0, 0.1]]").expect("an error");
        assert!(said.contains("at time 1.99") && said.contains("would not end"), "{said}");
        assert_eq!(problem("[[0.0, 0.2], [1.0, 0.1], [4.0, 0.1]]"), None);
    }

    #[test]
    fn steps_that_do_not_fit_the_run_are_named() {
        let problem = |step: &str| {
            let deck = Document::from_str(&format!("{{ \"time_step\": {step} }}"), "deck.json").expect("JSON").root;
            let stepping = TimeStepping::from_node(&deck, &mut Report::new()).expect("steps");
            stepping.problem(0.0, 1.0).map(|problem| problem.to_string())
        };
        assert!(problem("1e-300").is_some_and(|text| text.starts_with("error[time-step]")));
        assert!(problem("10").is_some_and(|text| text.starts_with("warning[time-step]")));
        assert_eq!(["1e-6", "1.0", "1.9", "1e12"].map(problem), [None, None, None, None]);
    }

    #[test]
    fn keys_that_nothing_reads_are_named() {
        let deck = Document::from_str(r#"{ "time_step": 0.1, "time_stepp": 1 }"#, "deck.json").expect("JSON").root;
        let mut warnings = Report::new();
        TimeStepping::from_node(&deck, &mut warnings).expect("steps");
        let warning = warnings.finish().expect("no errors").remove(0).to_string();
        assert!(warning.contains("time_stepp") && warning.contains("deck.json:1:21"), "{warning}");
    }
}
