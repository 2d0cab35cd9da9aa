//! `zelus run DECK --sweep TABLE`: a parametric study, each row of a table a run in a folder of its own.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::Mutex;
use std::time::SystemTime;

use serde_json::{Value, json};
use zelus_core::analysis::RunReport;
use zelus_core::communication::Ranks;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::io::Mark;
use zelus_core::strategies::StepRecord;
use zelus_core::{Error, Result};

use super::report::{check_output, made_folder};
use super::run_arguments::RunArguments;
use super::say::{plural, say};
use super::stop::Stop;
use super::table::{MARK, Table};

/// Names of files in the folder of a row.
const REPORT: &str = "report.json";
const LOG: &str = "log.txt";
const ROW: &str = "row.json";

/// Largest results that the table on the terminal shows.
const LOOKED_AT: [&str; 4] = ["DISPLACEMENT", "VON_MISES_STRESS", "CONTACT_PRESSURE", "TEMPERATURE"];

/// The study: its arguments, table and folder.
struct Sweep<'a> {
    arguments: &'a RunArguments,
    table: Table,
    folder: PathBuf,
    /// Threads of a row.
    threads: usize,
    stop: Stop,
}

/// How a row ended.
struct RowEnd {
    row: usize,
    code: u8,
    report: Option<RunReport>,
    /// Output of the run where it left no report.
    said: String,
    /// Whether it was done before.
    kept: bool,
}

/// Runs all rows; the exit code is the largest of theirs.
///
/// # Errors
/// A table that cannot be read, or folders that cannot be made; the outcome of a row stands in its row of the results.
pub(super) fn run(arguments: &RunArguments, table: &Path, ranks: &Ranks) -> Result<ExitCode> {
    if ranks.size() > 1 {
        let problem = Diagnostic::error("sweep", "a sweep shares out whole runs, and was started on several ranks");
        return Err(problem.remedy("start it without mpirun; -j says how many rows run at a time").into());
    }
    let folder = arguments.output.clone().unwrap_or_else(|| table.with_extension(""));
    let table = Table::read(table)?;
    check_keys(&table)?;
    let results = folder.join("results.csv");
    made_folder(&folder)?;
    check_output("the table of results", &results, &[], Mark::Holds(MARK))?;
    let machine = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let cores = arguments.threads.unwrap_or_else(machine);
    let jobs = arguments.jobs.unwrap_or(cores).clamp(1, table.rows.len());
    let sweep = Sweep { arguments, folder, threads: (cores / jobs).max(1), stop: Stop::listen(false)?, table };
    let rows = sweep.table.rows.len();
    let tell = |text: &str| {
        if !arguments.quiet {
            say(text);
        }
    };
    tell(&format!(
        "{rows} row{}, {jobs} at a time with {} thread{} each",
        plural(rows),
        sweep.threads,
        plural(sweep.threads)
    ));
    let (next, done) = (Mutex::new(0..rows), Mutex::new(Vec::<RowEnd>::new()));
    let work = || -> Result<()> {
        loop {
            let row = next.lock().expect("no thread panics").next();
            let Some(row) = row.filter(|_| !sweep.stop.is_asked()) else { return Ok(()) };
            let ended = sweep.row(row)?;
            let mut done = done.lock().expect("no thread panics");
            if !arguments.quiet || ended.code != 0 {
                say(&sweep.line(&ended));
            }
            done.push(ended);
            done.sort_by_key(|ended| ended.row);
            sweep.results(&done).write(&results)?;
        }
    };
    std::thread::scope(|scope| {
        let all: Vec<_> = (0..jobs).map(|_| scope.spawn(work)).collect();
        all.into_iter().try_for_each(|one| one.join().expect("no thread panics"))
    })?;
    let done = done.into_inner().expect("no thread panics");
    tell(sweep.summary(&done).aligned().trim_end());
    let failed = done.iter().filter(|ended| ended.code != 0).count();
    let left = rows - done.len();
    tell(&format!("{} of {rows} rows done, {failed} failed, {left} not begun", done.len() - failed));
    tell(&format!("results: {}", results.display()));
    let worst = done.iter().map(|ended| ended.code).max().unwrap_or(0);
    Ok(ExitCode::from(if left > 0 { worst.max(5) } else { worst }))
}

/// Refuses heads that are no keys.
fn check_keys(table: &Table) -> Result<()> {
    let mut seen = BTreeSet::new();
    for head in &table.heads {
        let wrong = if head.is_empty() || head.contains('=') {
            "is no key of a deck"
        } else if !seen.insert(head) {
            "stands twice"
        } else {
            continue;
        };
        let problem = Diagnostic::error("table", format!("the head {head:?} {wrong}"));
        return Err(problem.remedy("write each key once, as --set takes it, e.g. problem_data.end_time").into());
    }
    Ok(())
}

impl Sweep<'_> {
    fn folder_of(&self, row: usize) -> PathBuf {
        self.folder.join(format!("row_{}", row + 1))
    }

    /// The arguments of `--set` for a row; an empty cell keeps the value of the deck.
    fn changes(&self, row: usize) -> Vec<String> {
        let cells = self.table.heads.iter().zip(&self.table.rows[row]).filter(|(_, cell)| !cell.is_empty());
        let own = cells.map(|(head, cell)| format!("{head}={cell}"));
        self.arguments.set.iter().cloned().chain(own).collect()
    }

    /// Inputs on which the results of a row depend, beside its files.
    fn identity(&self, row: usize) -> Value {
        let RunArguments { file, like, .. } = self.arguments;
        json!({ "version": env!("CARGO_PKG_VERSION"), "deck": file, "like": like, "set": self.changes(row) })
    }

    /// The report of a row that is done, where neither its values nor a file that it read have changed since.
    fn done_before(&self, row: usize) -> Option<RunReport> {
        let folder = self.folder_of(row);
        let own: Value = serde_json::from_slice(&std::fs::read(folder.join(ROW)).ok()?).ok()?;
        let report = read_report(&folder)?;
        let age = |path: &Path| -> Option<SystemTime> { path.metadata().ok()?.modified().ok() };
        let written = age(&folder.join(REPORT))?;
        let as_it_was = report.inputs.iter().all(|input| age(input).is_some_and(|age| age < written));
        (own == self.identity(row) && report.exit_code == 0 && as_it_was).then_some(report)
    }

    /// Runs a row in a process of its own: the end of one does not end the others.
    fn row(&self, row: usize) -> Result<RowEnd> {
        let RunArguments { file, like, resume, .. } = self.arguments;
        if *resume && let Some(report) = self.done_before(row) {
            return Ok(RowEnd { row, code: 0, report: Some(report), said: String::new(), kept: true });
        }
        let folder = self.folder_of(row);
        made_folder(&folder)?;
        let failed = |error: std::io::Error| Error::System(format!("{}: {error}", folder.display()));
        let identity = format!("{:#}\n", self.identity(row));
        let same = std::fs::read_to_string(folder.join(ROW)).is_ok_and(|earlier| earlier == identity);
        std::fs::write(folder.join(ROW), identity).map_err(failed)?;
        let _ = std::fs::remove_file(folder.join(REPORT));
        let mut command = Command::new(std::env::current_exe().map_err(failed)?);
        command.arg("run").arg(file).arg("--quiet").args(["--threads", &self.threads.to_string()]);
        command
            .arg("--output")
            .arg(&folder)
            .arg("--report")
            .arg(folder.join(REPORT))
            .arg("--log")
            .arg(folder.join(LOG));
        command.args(like.iter().flat_map(|like| ["--like", like]));
        command.args(self.changes(row).iter().flat_map(|change| ["--set", change]));
        if *resume && same {
            command.arg("--resume");
        }
        let output = command.stdin(Stdio::null()).output().map_err(failed)?;
        let code = output.status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(4);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        Ok(RowEnd { row, code, report: read_report(&folder), said, kept: false })
    }

    /// The line of a row that has ended.
    fn line(&self, ended: &RowEnd) -> String {
        let head = format!("row {} of {}", ended.row + 1, self.table.rows.len());
        match (&ended.report, ended.kept) {
            (Some(report), true) => {
                format!("{head}: done before, {} step{}", report.converged_steps, plural(report.converged_steps))
            }
            (Some(report), _) if ended.code == 0 => format!(
                "{head}: {} step{} converged in {} iteration{}, {:.2} s",
                report.converged_steps,
                plural(report.converged_steps),
                report.iterations,
                plural(report.iterations),
                seconds(report)
            ),
            _ => format!("{head}: exit code {}: {}", ended.code, ended.why()),
        }
    }

    /// All that is known of each row.
    fn results(&self, done: &[RowEnd]) -> Table {
        let mut columns = vec![
            Column::new("row", |ended| (ended.row + 1).to_string()),
            Column::new("exit_code", |ended| ended.code.to_string()),
        ];
        columns.extend(self.table.heads.iter().enumerate().map(|(at, head)| self.given(head, at)));
        columns.extend([
            Column::of_report("steps", |report| report.converged_steps.to_string()),
            Column::of_report("iterations", |report| report.iterations.to_string()),
            Column::of_report("unknowns", |report| report.sizes.unknowns.to_string()),
            Column::of_report("warnings", |report| report.warnings.len().to_string()),
            Column::of_report("seconds", |report| format!("{:.3}", seconds(report))),
        ]);
        columns.extend(names(done, |report| &report.largest).into_iter().map(|name| {
            Column::of_report(format!("largest {name}"), move |report| number(report.largest.get(&name).copied()))
        }));
        let smallest = names(done, |report| &report.smallest);
        columns.extend(smallest.into_iter().map(|name| {
            Column::of_report(format!("smallest {name}"), move |report| number(report.smallest.get(&name).copied()))
        }));
        for (pair, axis) in pairs(done).iter().flat_map(|pair| (0..3).map(move |axis| (pair.clone(), axis))) {
            let head = format!("force {} on {pair}", ["x", "y", "z"][axis]);
            columns.push(Column::new(head, move |ended| number(ended.force(&pair).map(|force| force[axis]))));
        }
        columns.push(Column::new("folder", |ended| self.folder_of(ended.row).display().to_string()));
        columns.push(Column::new("error", |ended| if ended.code == 0 { String::new() } else { ended.why() }));
        table(&columns, done)
    }

    /// Columns that fit on a terminal: keys by their last word, the main results first.
    fn summary(&self, done: &[RowEnd]) -> Table {
        let short = |head: &String| {
            let words: Vec<&str> = head.split('.').collect();
            let from = words.iter().rposition(|word| word.parse::<usize>().is_err()).unwrap_or(0);
            words[from..].join(".")
        };
        let size = |value: Option<f64>| value.map(|value| format!("{value:.3e}")).unwrap_or_default();
        let mut columns = vec![
            Column::new("row", |ended| (ended.row + 1).to_string()),
            Column::new("exit", |ended| ended.code.to_string()),
        ];
        columns.extend(self.table.heads.iter().enumerate().map(|(at, head)| self.given(&short(head), at)));
        columns.extend([
            Column::of_report("steps", |report| report.converged_steps.to_string()),
            Column::of_report("iterations", |report| report.iterations.to_string()),
            Column::of_report("seconds", |report| format!("{:.2}", seconds(report))),
        ]);
        let known = names(done, |report| &report.largest);
        for name in LOOKED_AT.into_iter().filter(|name| known.contains(*name)) {
            columns.push(Column::of_report(name, move |report| size(report.largest.get(name).copied())));
        }
        for pair in pairs(done) {
            let head = format!("force {}", pair.split(':').next().unwrap_or(&pair));
            columns.push(Column::new(head, move |ended| size(ended.force(&pair).as_ref().map(norm))));
        }
        table(&columns, done)
    }

    /// The column of a key of the deck.
    fn given(&self, head: &str, at: usize) -> Column<'_> {
        Column::new(head, move |ended| self.table.rows[ended.row][at].clone())
    }
}

/// A column of a table of runs.
struct Column<'a> {
    head: String,
    cell: Box<dyn Fn(&RowEnd) -> String + 'a>,
}

impl<'a> Column<'a> {
    fn new(head: impl Into<String>, cell: impl Fn(&RowEnd) -> String + 'a) -> Self {
        Self { head: head.into(), cell: Box::new(cell) }
    }

    /// Column of a number in the report; empty where a run has left none.
    fn of_report(head: impl Into<String>, cell: impl Fn(&RunReport) -> String + 'a) -> Self {
        Self::new(head, move |ended| ended.report.as_ref().map(&cell).unwrap_or_default())
    }
}

fn table(columns: &[Column<'_>], done: &[RowEnd]) -> Table {
    Table {
        heads: columns.iter().map(|column| column.head.clone()).collect(),
        rows: done.iter().map(|ended| columns.iter().map(|column| (column.cell)(ended)).collect()).collect(),
    }
}

/// Names of the extremes of all runs.
fn names(done: &[RowEnd], of: fn(&RunReport) -> &BTreeMap<String, f64>) -> BTreeSet<String> {
    done.iter().filter_map(|row| row.report.as_ref()).flat_map(|report| of(report).keys().cloned()).collect()
}

/// Names of the pairs of all runs.
fn pairs(done: &[RowEnd]) -> BTreeSet<String> {
    done.iter().flat_map(RowEnd::forces).map(|(pair, _)| pair).collect()
}

impl RowEnd {
    /// Forces on the slave side of each pair, at the end of the last step that converged.
    fn forces(&self) -> Vec<(String, [f64; 3])> {
        let steps = self.report.iter().flat_map(|report| report.steps.iter().rev());
        let balance = steps.filter(|step: &&StepRecord| step.converged).find_map(|step| step.balance.as_ref());
        balance.iter().flat_map(|balance| &balance.pairs).map(|pair| (pair.name.clone(), pair.force)).collect()
    }

    /// Force on the slave side of one pair.
    fn force(&self, pair: &str) -> Option<[f64; 3]> {
        self.forces().into_iter().find(|(own, _)| own == pair).map(|(_, force)| force)
    }

    /// Why it ended early: the first line of its error, whatever was warned of before.
    fn why(&self) -> String {
        if self.code == 5 {
            return "stopped by a signal, and saved".to_owned();
        }
        let told = self.report.as_ref().map_or(Vec::new(), |report| report.errors.clone());
        let lines = || told.iter().flat_map(|text| text.lines()).chain(self.said.lines()).map(str::trim);
        let is_other = |line: &str| line.is_empty() || ["warning[", "note["].iter().any(|word| line.starts_with(word));
        let error = lines().find(|line| line.starts_with("error[")).or_else(|| lines().find(|line| !is_other(line)));
        error.unwrap_or("it has left no report").to_owned()
    }
}

fn read_report(folder: &Path) -> Option<RunReport> {
    serde_json::from_slice(&std::fs::read(folder.join(REPORT)).ok()?).ok()
}

fn seconds(report: &RunReport) -> f64 {
    report.seconds.get("total").copied().unwrap_or_default()
}

fn norm(force: &[f64; 3]) -> f64 {
    force.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn number(value: Option<f64>) -> String {
    value.map(|value| format!("{value:e}")).unwrap_or_default()
}
