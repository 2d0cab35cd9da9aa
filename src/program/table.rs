//! Tables of a parametric study: the one that is read, and that of the results.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::io::replace_own_file;
use zelus_core::{Error, Result};

/// Start of the first line of a table of results.
pub(super) const MARK: &str = "row,exit_code,";

/// Rows of cells below their heads.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Table {
    pub heads: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads text of comma-separated values: cells with commas stand between quotation marks, which are doubled within; lines that are
    /// empty or begin with # are left out.
    ///
    /// # Errors
    /// `table` at the line that has another number of cells than the first, or where there is no row.
    pub(super) fn read(path: &Path) -> Result<Self> {
        let missing = |error| Error::from(Diagnostic::error("missing-file", format!("{}: {error}", path.display())));
        let text = std::fs::read_to_string(path).map_err(missing)?;
        let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
        let mut lines = lines.filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
        let heads = lines.next().map(|(_, line)| cells(line)).unwrap_or_default();
        let mut rows = Vec::new();
        for (at, line) in lines {
            let row = cells(line);
            if row.len() != heads.len() {
                let fact = format!("a row of {} cells below {} heads", row.len(), heads.len());
                let problem = Diagnostic::error("table", fact).at(Place::at(path, at as u32 + 1, 1));
                return Err(problem.remedy("put values with commas between quotation marks: \"[0.0, 1.0]\"").into());
            }
            rows.push(row);
        }
        if rows.is_empty() {
            let problem = Diagnostic::error("table", "the table has no row of values").at(Place::file(path));
            let remedy =
                "write the keys into the first line, e.g. problem_data.end_time, and a line of values for each run";
            return Err(problem.remedy(remedy).into());
        }
        Ok(Self { heads, rows })
    }

    /// Writes it, in place of an earlier one.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(super) fn write(&self, path: &Path) -> Result<()> {
        let line = |row: &Vec<String>| row.iter().map(|cell| quoted(cell)).collect::<Vec<_>>().join(",");
        let lines: Vec<String> = std::iter::once(&self.heads).chain(&self.rows).map(line).collect();
        replace_own_file(path, |file| writeln!(file, "{}", lines.join("\n")))
    }

    /// Its columns beside each other, for a terminal.
    pub(super) fn aligned(&self) -> String {
        let all = || std::iter::once(&self.heads).chain(&self.rows);
        let widths: Vec<usize> = (0..self.heads.len())
            .map(|at| all().filter_map(|row| row.get(at)).map(|cell| cell.chars().count()).max().unwrap_or(0))
            .collect();
        let mut text = String::new();
        for row in all() {
            let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:>width$}")).collect();
            let _ = writeln!(text, "{}", cells.join("  "));
        }
        text
    }
}

/// The cells of a line.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let (mut within, mut letters) = (false, line.trim_end().chars().peekable());
    while let Some(letter) = letters.next() {
        match letter {
            '"' if within && letters.peek() == Some(&'"') => {
                letters.next();
                cells.last_mut().expect("one at least").push('"');
            }
            '"' if within || cells.last().is_some_and(|cell| cell.trim().is_empty()) => within = !within,
            ',' if !within => cells.push(String::new()),
            other => cells.last_mut().expect("one at least").push(other),
        }
    }
    cells.iter().map(|cell| cell.trim().to_owned()).collect()
}

fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_told_by_commas_outside_of_quotation_marks() {
        assert_eq!(cells(r#"a, "[0.0, 1.0]",, "say ""so""" ,1e-3*t"#), ["a", "[0.0, 1.0]", "", "say \"so\"", "1e-3*t"]);
        for cell in ["[0.0, 1.0]", "say \"so\"", "plain"] {
            assert_eq!(cells(&quoted(cell)), [cell]);
        }
    }

    #[test]
    fn rows_are_as_long_as_the_first() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        std::fs::write(&path, "# comment\na,b\n1,2\n\n3,\n").unwrap();
        let table = Table::read(&path).unwrap();
        assert_eq!((table.heads.clone(), table.rows.len()), (vec!["a".to_owned(), "b".to_owned()], 2));
        assert_eq!(table.aligned(), "a  b\n1  2\n3   \n");
        table.write(&path).unwrap();
        assert_eq!(Table::read(&path).unwrap(), table);
        std::fs::write(&path, "a,b\n1,2\n1,2,3\n").unwrap();
        assert!(Table::read(&path).unwrap_err().to_string().contains("3:1: a row of 3 cells below 2 heads"));
        std::fs::write(&path, "a,b\n").unwrap();
        assert!(Table::read(&path).unwrap_err().to_string().contains("no row of values"));
    }
}
