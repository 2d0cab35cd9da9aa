//! Errors that all ranks know of before any of them stops.
//!
//! Work that a rank does alone may fail there alone; [`Ranks::agree`] makes it fail everywhere. Errors that every rank meets alike need
//! no agreement. Any other failure ends all ranks, see [`Ranks::end_after_failure`].

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::Ranks;
use crate::diagnostics::{Diagnostic, Error, Place, Result, Severity};

/// Time that a failed rank waits for the failure of rank 0, before it prints its own message.
const PATIENCE: Duration = Duration::from_secs(3);
/// How long it then waits for rank 0 to close its files and end the run.
const CLOSING: Duration = Duration::from_secs(600);

impl Ranks {
    /// Whether this rank writes files and speaks to the user.
    pub fn is_root(&self) -> bool {
        self.rank() == 0
    }

    /// Keeps an error of this rank for the next [`Ranks::agree`], so that it goes on up to there.
    pub fn defer(&self, error: Error) {
        self.deferred_error().lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }

    /// The error that was kept, if any; no later agreement knows of it.
    ///
    /// # Errors
    /// The error that [`Ranks::defer`] was given.
    pub fn deferred(&self) -> Result<()> {
        self.deferred_error().lock().unwrap_or_else(PoisonError::into_inner).take().map_or(Ok(()), Err)
    }

    /// Runs on rank 0 an action that only one rank may do, such as writing a file.
    ///
    /// # Errors
    /// As `act`; with several ranks the error is kept until they next agree.
    pub fn on_root(&self, act: impl FnOnce() -> Result<()>) -> Result<()> {
        if !self.is_root() {
            return Ok(());
        }
        let done = act();
        if self.size() > 1 {
            done.err().into_iter().for_each(|error| self.defer(error));
            return Ok(());
        }
        done
    }

    /// The result, or the error of any rank; collective.
    ///
    /// # Errors
    /// Problems of the input of all ranks together, or else the error of the first rank that has one.
    pub fn agree<T>(&self, result: Result<T>) -> Result<T> {
        if self.size() == 1 {
            return result;
        }
        let (value, own) = match result {
            Ok(value) => (Some(value), self.deferred().err()),
            Err(error) => (None, Some(error)),
        };
        self.agree_on(own).map(|()| value.expect("a rank without a value has an error"))
    }

    /// Agrees that no rank has an error; collective.
    fn agree_on(&self, own: Option<Error>) -> Result<()> {
        if !self.any(own.is_some()) {
            return Ok(());
        }
        let all = self.gather_bytes(&own.as_ref().map(encode).unwrap_or_default());
        let mut errors = all.iter().filter(|text| !text.is_empty()).map(|text| decode(text));
        let Some(first) = errors.next() else { return own.map_or(Ok(()), Err) };
        let mut problems = match first {
            Error::Input(problems) => problems,
            other => return Err(other),
        };
        for error in errors {
            let Error::Input(more) = error else { continue };
            problems.extend(more.into_iter().filter(|d| !problems.contains(d)).collect::<Vec<_>>());
        }
        Err(Error::Input(problems))
    }

    /// Whether any rank says so; collective.
    pub fn any(&self, flag: bool) -> bool {
        let mut flags = [flag];
        self.any_of(&mut flags);
        flags[0]
    }

    /// Sets each flag that is set on any rank; collective.
    pub fn any_of(&self, flags: &mut [bool]) {
        if self.size() > 1 && !flags.is_empty() {
            let mut all: Vec<u8> = flags.iter().map(|&flag| u8::from(flag)).collect();
            self.or(&mut all);
            flags.iter_mut().zip(all).for_each(|(flag, any)| *flag = any != 0);
        }
    }

    /// Adds up the values of the ranks, in their order; collective.
    pub fn sum(&self, values: &mut [f64]) {
        if self.size() > 1 && !values.is_empty() {
            let all = self.gather_counted(values, &vec![values.len(); self.size()]);
            values.fill(0.0);
            for of_rank in all.chunks_exact(values.len()) {
                values.iter_mut().zip(of_rank).for_each(|(sum, value)| *sum += value);
            }
        }
    }

    /// The sum of one number of each rank; collective.
    pub fn total(&self, own: f64) -> f64 {
        let mut sum = [own];
        self.sum(&mut sum);
        sum[0]
    }

    /// Lists to exchange so that rank 0 gets `own`, and the others nothing.
    pub fn for_root<T>(&self, own: Vec<T>) -> Vec<Vec<T>> {
        let others = (1..self.size()).map(|_| Vec::new());
        std::iter::once(own).chain(others).collect()
    }

    /// The numbers of every rank, by rank, on rank 0; nothing on the others. Collective.
    pub fn to_root(&self, own: Vec<f64>) -> Vec<Vec<f64>> {
        if self.size() == 1 {
            return vec![own];
        }
        let received = self.exchange_numbers(&self.for_root(own));
        if self.is_root() { received } else { Vec::new() }
    }

    /// The lines of all ranks, one after another; collective.
    pub fn lines_of_all(&self, own: Vec<String>) -> Vec<String> {
        if self.size() == 1 || !self.any(!own.is_empty()) {
            return own;
        }
        let all = self.gather_bytes(own.join("\n").as_bytes());
        all.iter()
            .flat_map(|text| String::from_utf8_lossy(text).lines().map(str::to_owned).collect::<Vec<_>>())
            .collect()
    }

    /// The text of the first rank that has one; collective.
    pub fn first_to_say(&self, own: Option<String>) -> Option<String> {
        if self.size() == 1 || !self.any(own.is_some()) {
            return own;
        }
        let all = self.gather_bytes(own.unwrap_or_default().as_bytes());
        all.iter().find(|text| !text.is_empty()).map(|text| String::from_utf8_lossy(text).into_owned())
    }

    /// The problems of all ranks, each once; collective.
    pub fn problems_of_all(&self, own: Vec<Diagnostic>) -> Vec<Diagnostic> {
        if self.size() == 1 || !self.any(!own.is_empty()) {
            return own;
        }
        let text = Value::from(own.iter().map(encode_problem).collect::<Vec<_>>()).to_string();
        let mut out: Vec<Diagnostic> = Vec::new();
        for text in self.gather_bytes(text.as_bytes()) {
            let problems = serde_json::from_slice::<Value>(&text).unwrap_or_default();
            for problem in problems.as_array().into_iter().flatten().map(decode_problem) {
                if !out.contains(&problem) {
                    out.push(problem);
                }
            }
        }
        out
    }

    /// Whether all ranks give the same number; collective.
    pub fn is_same(&self, number: u64) -> bool {
        let own = number.to_le_bytes();
        self.size() == 1 || self.gather_equal_bytes(&own).chunks_exact(own.len()).all(|other| *other == own)
    }

    /// The last act of a failed run on several ranks: rank 0 prints `message`, and all end with `code`.
    ///
    /// Another rank speaks only when rank 0 does not know of the failure.
    pub fn end_after_failure(&self, message: &str, code: u8) -> ! {
        if self.is_root() {
            self.announce_failure();
            eprintln!("{message}");
            self.abort(code);
        }
        if self.hears_of_failure() {
            std::thread::sleep(CLOSING);
        }
        eprintln!("rank {}: {message}", self.rank());
        self.abort(code)
    }

    /// Whether rank 0 says in time that the run has failed.
    fn hears_of_failure(&self) -> bool {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if self.failure_is_announced() {
                return true;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        false
    }
}

fn encode(error: &Error) -> Vec<u8> {
    let value = match error {
        Error::Input(problems) => Value::from(problems.iter().map(encode_problem).collect::<Vec<_>>()),
        Error::NotConverged(text) => json!({ "not converged": text }),
        Error::System(text) => json!({ "system": text }),
    };
    value.to_string().into_bytes()
}

fn encode_problem(problem: &Diagnostic) -> Value {
    let place = problem.place.as_ref().map(|p| json!([p.file.to_string_lossy(), p.line, p.column]));
    json!([problem.severity as u8, problem.code, place, problem.fact, problem.remedy])
}

fn decode(text: &[u8]) -> Error {
    let value: Value = serde_json::from_slice(text).unwrap_or_default();
    if let Value::Array(problems) = value {
        return Error::Input(problems.iter().map(decode_problem).collect());
    }
    let text = |key: &str| value.get(key).and_then(Value::as_str).map(str::to_owned);
    match text("not converged") {
        Some(text) => Error::NotConverged(text),
        None => Error::System(text("system").unwrap_or_else(|| "a rank failed and could not say why".to_owned())),
    }
}

fn decode_problem(value: &Value) -> Diagnostic {
    let text = |at: usize| value[at].as_str().map(str::to_owned);
    let number = |at: usize| value[2][at].as_u64().unwrap_or(0) as u32;
    let severity = [Severity::Note, Severity::Warning].into_iter().find(|&s| value[0].as_u64() == Some(s as u64));
    Diagnostic {
        severity: severity.unwrap_or(Severity::Error),
        code: known_code(text(1).unwrap_or_default()),
        place: value[2][0].as_str().map(|file| Place::at(file, number(1), number(2))),
        fact: text(3).unwrap_or_default(),
        remedy: text(4),
    }
}

/// A code that lasts as long as the program; there are few.
fn known_code(code: String) -> &'static str {
    static CODES: Mutex<Vec<&'static str>> = Mutex::new(Vec::new());
    let mut codes = CODES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = codes.iter().find(|known| **known == code) {
        return known;
    }
    codes.push(Box::leak(code.into_boxed_str()));
    codes[codes.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_survive_the_way_between_ranks() {
        let problem = Diagnostic::error("entity", "inverted").at(Place::at("a.json", 3, 4)).remedy("mend it");
        let warning = Diagnostic::warning("old", "x");
        for error in [
            Error::Input(vec![problem, warning]),
            Error::NotConverged("step 3".into()),
            Error::System("disk full".into()),
        ] {
            let back = decode(&encode(&error));
            assert_eq!((back.to_string(), back.exit_code()), (error.to_string(), error.exit_code()));
        }
    }
}
