//! A value that a deck gives as a number, a function of space and time, or a table over time.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use serde::Deserialize;

use super::time_table::TimeTable;
use crate::diagnostics::{Diagnostic, Place, Result};
use crate::model::Table;
use crate::parameters::{Defaults, Expression, Interval, Node, Settings, SpaceTime};

/// One number, possibly varying in space and time.
#[derive(Debug, Clone)]
pub enum ScalarValue {
    /// Always the same.
    Number(f64),
    /// A function of position and time.
    Expression(Expression),
    /// Linear between points over TIME, continued with the end slopes.
    Table(Table),
    /// The product of two.
    Product(Box<[ScalarValue; 2]>),
}

#[derive(Deserialize)]
struct CsvSettings {
    filename: String,
    delimiter: String,
    skiprows: usize,
    first_column_id: usize,
    second_column_id: usize,
    na_replace: f64,
}

static CSV_DEFAULTS: LazyLock<Result<Defaults>> = LazyLock::new(|| {
    let text = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/csv_table.json"));
    Ok(Defaults::parse("csv_table", text)?.require(&["filename"]))
});

impl ScalarValue {
    /// Reads a number, a function as a string, or an object that names a file of comma-separated values.
    ///
    /// The file is looked for beside the deck.
    ///
    /// # Errors
    /// `wrong-type`, `invalid-expression`, and for files `unreadable-file` and `invalid-table`.
    pub fn from_node(node: &Node) -> Result<Self> {
        if let Some(number) = node.as_f64() {
            return Ok(Self::Number(number));
        }
        if node.as_str().is_some() {
            return Ok(Self::Expression(Expression::from_node(node)?));
        }
        if node.as_object().is_some() {
            return read_csv(node).map(|csv| Self::Table(csv.table));
        }
        let fact = format!("a value must be a number, a function or a table, found {} ({node})", node.value.kind());
        let remedy = "write e.g. 1.0 or \"2.0*t\" or {\"name\": \"csv_table\", \"filename\": \"load.csv\"}";
        Err(Diagnostic::error("wrong-type", fact).at(node.place()).remedy(remedy).into())
    }

    /// The value at a place and time.
    pub fn value(&self, at: &SpaceTime) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::Expression(expression) => expression.value(at),
            Self::Table(table) => table.value(at.time),
            Self::Product(factors) => factors[0].value(at) * factors[1].value(at),
        }
    }

    /// Whether it is zero everywhere and always, as far as numbers say.
    pub fn is_zero(&self) -> bool {
        match self {
            Self::Number(number) => *number == 0.0,
            Self::Product(factors) => factors.iter().any(Self::is_zero),
            Self::Expression(_) | Self::Table(_) => false,
        }
    }

    /// Whether the value depends on the position.
    pub fn uses_space(&self) -> bool {
        match self {
            Self::Number(_) | Self::Table(_) => false,
            Self::Expression(expression) => expression.uses_space(),
            Self::Product(factors) => factors.iter().any(Self::uses_space),
        }
    }
}

/// The tables that the values of a deck name, as far as they name one.
pub(crate) fn tables_of(deck: &Node, files: &mut Vec<PathBuf>) {
    if deck.get("name").and_then(Node::as_str) == Some("csv_table")
        && let Some(name) = deck.get("filename").and_then(Node::as_str)
    {
        files.push(table_file(deck, name));
    }
    let members = deck.as_object().into_iter().flat_map(|members| members.iter().map(|member| &member.node));
    members.chain(deck.as_array().into_iter().flatten()).for_each(|inner| tables_of(inner, files));
}

/// The tables over time that the values of the processes below `deck` name and that can be read, each with the interval of its process.
pub(crate) fn time_tables_of(deck: &Node, interval: Interval, tables: &mut Vec<TimeTable>) {
    let own = deck.get("interval").and_then(|node| Interval::from_node(node).ok()).unwrap_or(interval);
    if deck.get("name").and_then(Node::as_str) == Some("csv_table")
        && let Some(name) = deck.get("filename").and_then(Node::as_str)
        && let Ok(CsvTable { table, missing, fault }) = read_csv(deck)
    {
        let place = deck.key_place("filename");
        let fault = fault.map(|fault| fault.at(place.clone()));
        let used = TimeTable::new(name, place, &table, own);
        tables.extend(used.map(|used| TimeTable { missing, fault, ..used }));
    }
    let members = deck.as_object().into_iter().flat_map(|members| members.iter().map(|member| &member.node));
    members.chain(deck.as_array().into_iter().flatten()).for_each(|inner| time_tables_of(inner, own, tables));
}

/// The file of a table, whose name is relative to the folder of the deck.
fn table_file(node: &Node, name: &str) -> PathBuf {
    node.place().file.parent().unwrap_or(Path::new("")).join(name)
}

/// A table of a file.
struct CsvTable {
    table: Table,
    /// Cells that are empty, and count as the default of `na_replace`.
    missing: usize,
    /// The warning that its rows are not in order.
    fault: Option<Diagnostic>,
}

fn read_csv(node: &Node) -> Result<CsvTable> {
    let defaults = match &*CSV_DEFAULTS {
        Ok(defaults) => defaults,
        Err(problem) => return Err(Diagnostic::error("invalid-json", problem.to_string()).into()),
    };
    let settings = Settings::check(node, defaults)?.0;
    let csv: CsvSettings = settings.parse()?;
    let replaces_nan = settings.is_given("na_replace");
    let path = table_file(node, &csv.filename);
    let unreadable = |e: std::io::Error| {
        Diagnostic::error("unreadable-file", format!("cannot read the table {}: {e}", path.display()))
            .at(settings.key_place("filename"))
            .remedy("the name is taken relative to the deck")
    };
    parse_csv(&std::fs::read_to_string(&path).map_err(unreadable)?, &csv, replaces_nan, &path)
}

/// Entries of a table that stand for a missing value.
const NOT_AVAILABLE: [&str; 4] = ["", "n/a", "na", "-"];

/// A table of two columns; "nan" is a missing value only where the deck says by what it is replaced.
fn parse_csv(text: &str, csv: &CsvSettings, replaces_nan: bool, path: &Path) -> Result<CsvTable> {
    let mut missing = 0;
    let mut number = |cell: &str, row: usize| {
        let cell = cell.trim().trim_matches('"');
        match cell.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ if NOT_AVAILABLE.iter().any(|word| word.eq_ignore_ascii_case(cell)) => {
                missing += usize::from(!replaces_nan);
                Ok(csv.na_replace)
            }
            Ok(number) if number.is_nan() && replaces_nan => Ok(csv.na_replace),
            Ok(number) => Err(Diagnostic::error("invalid-table", format!("\"{cell}\" in the table is {number}"))
                .at(Place::at(path, row as u32 + 1, 0))
                .remedy("write a finite number; \"na_replace\" gives the number in place of nan")),
            _ => Err(Diagnostic::error("invalid-table", format!("\"{cell}\" is not a number"))
                .at(Place::at(path, row as u32 + 1, 0))
                .remedy("a value that is missing is written N/A; \"skiprows\" leaves out the head")),
        }
    };
    let mut points = Vec::new();
    for (row, line) in text.lines().enumerate().skip(csv.skiprows).filter(|(_, line)| !line.trim().is_empty()) {
        let cells: Vec<&str> = line.split(csv.delimiter.as_str()).collect();
        let (Some(x), Some(y)) = (cells.get(csv.first_column_id), cells.get(csv.second_column_id)) else {
            let fact = format!(
                "the row has {} columns, wanted are {} and {}",
                cells.len(),
                csv.first_column_id,
                csv.second_column_id
            );
            let problem = Diagnostic::error("invalid-table", fact).at(Place::at(path, row as u32 + 1, 0));
            return Err(problem.remedy("columns count from 0; check \"delimiter\" and \"skiprows\"").into());
        };
        points.push([number(x, row)?, number(y, row)?]);
    }
    if points.is_empty() {
        let problem = Diagnostic::error("invalid-table", "the table has no rows").at(Place::file(path));
        return Err(problem.remedy("give at least one row \"time, value\"").into());
    }
    let fault = Table::fault(&csv.filename, &points);
    Ok(CsvTable { table: Table::new(points), missing, fault })
}
