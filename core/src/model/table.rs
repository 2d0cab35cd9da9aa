//! Piecewise-linear tables.

use serde::{Deserialize, Serialize};

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
}
