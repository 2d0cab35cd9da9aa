//! Piecewise-linear tables.

use serde::{Deserialize, Serialize};

use crate::diagnostics::Diagnostic;

/// A piecewise-linear function given by points of ascending abscissa; ends continue with their slopes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Points (x, y), x ascending.
    pub points: Vec<[f64; 2]>,
}

impl Table {
    /// A table from its points, sorted by abscissa.
    pub fn new(mut points: Vec<[f64; 2]>) -> Self {
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Self { points }
    }

    /// The warning that rows of the table `name` are no function as they stand: there are none, some come before one of a smaller
    /// abscissa, or more than two share one (two are a jump).
    pub fn fault(name: &str, rows: &[[f64; 2]]) -> Option<Diagnostic> {
        let falls = rows.windows(2).position(|pair| pair[1][0] < pair[0][0]);
        let shared = rows.windows(3).find(|three| three[0][0] == three[2][0]);
        let fact = match (falls, shared) {
            _ if rows.is_empty() => "has no rows: its value is 0".to_owned(),
            (Some(at), _) => {
                format!("goes back from {} to {} in row {}: its rows are sorted", rows[at][0], rows[at + 1][0], at + 2)
            }
            (None, Some(three)) => format!("has more than two rows at {}", three[0][0]),
            (None, None) => return None,
        };
        let problem = Diagnostic::warning("table-rows", format!("the table {name} {fact}"));
        Some(problem.remedy("write rows in ascending order, two at one place for a jump"))
    }

    /// The value at `x`: linear between points, continued beyond both ends with the end slopes; 0 for an empty table.
    pub fn value(&self, x: f64) -> f64 {
        match self.points.as_slice() {
            [] => 0.0,
            [only] => only[1],
            points => {
                let [x0, y0] = points[self.right_of(x) - 1];
                y0 + self.slope(x) * (x - x0)
            }
        }
    }

    /// The derivative at `x`, at a point that on its left; 0 where two points stand above each other.
    pub fn slope(&self, x: f64) -> f64 {
        if self.points.len() < 2 {
            return 0.0;
        }
        let right = self.right_of(x);
        let ([x0, y0], [x1, y1]) = (self.points[right - 1], self.points[right]);
        if x1 == x0 { 0.0 } else { (y1 - y0) / (x1 - x0) }
    }

    /// The point at the right end of the piece that `x` is on.
    fn right_of(&self, x: f64) -> usize {
        self.points.partition_point(|p| p[0] < x).clamp(1, self.points.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_and_continues_with_end_slopes() {
        let table = Table::new(vec![[1.0, 2.0], [0.0, 0.0], [2.0, 3.0]]);
        assert_eq!([-1.0, 0.0, 0.5, 1.5, 4.0].map(|x| table.value(x)), [-2.0, 0.0, 1.0, 2.5, 5.0]);
    }

    #[test]
    fn rows_without_order_are_told() {
        let said = |rows: &[f64]| {
            let rows: Vec<[f64; 2]> = rows.iter().map(|&x| [x, 1.0]).collect();
            Table::fault("t", &rows).map(|fault| fault.fact)
        };
        assert_eq!(said(&[0.0, 1.0, 1.0, 2.0]), None);
        assert_eq!(said(&[]).unwrap(), "the table t has no rows: its value is 0");
        assert_eq!(said(&[0.0, 2.0, 1.0]).unwrap(), "the table t goes back from 2 to 1 in row 3: its rows are sorted");
        assert_eq!(said(&[1.0, 1.0, 1.0]).unwrap(), "the table t has more than two rows at 1");
    }
}
