//! Values over time as a deck writes them: numbers, functions of t, or tables in files of their own.

use zelus_meshes::history::History;

/// Points of a history that a function states; more become a table.
const PIECES: usize = 6;
/// Relative distance from a line below which a point adds nothing.
const STRAIGHT: f64 = 1e-12;

/// Texts of histories, and the tables that they name.
pub(super) struct Histories {
    /// End of the run.
    end: f64,
    /// Name and content of each table.
    pub files: Vec<(String, String)>,
}

impl Histories {
    pub(super) fn new(end: f64) -> Self {
        Self { end, files: Vec::new() }
    }

    /// A history as a value of a process.
    pub(super) fn value(&mut self, history: &History) -> String {
        let points = straightened(history.points());
        match &points[..] {
            [] => "0.0".to_owned(),
            [[_, value]] => format!("{value:?}"),
            [[t0, v0], [t1, v1]] if *t0 == 0.0 && *v0 == 0.0 && *t1 >= self.end * (1.0 - STRAIGHT) => {
                format!("\"{:?}*t\"", v1 / t1)
            }
            pieces if pieces.len() <= PIECES => format!("\"{}\"", self.function(pieces)),
            pieces => self.table(pieces),
        }
    }

    /// A history as a function of t, without quotation marks.
    pub(super) fn expression(&self, history: &History) -> String {
        match &straightened(history.points())[..] {
            [] => "0.0".to_owned(),
            [[_, value]] => format!("{value:?}"),
            pieces => self.function(pieces),
        }
    }

    /// `first piece if t <= its end else (the others)`.
    fn function(&self, points: &[[f64; 2]]) -> String {
        let &[_, last] = points.last().unwrap_or(&[0.0, 0.0]);
        let reaches = points.last().is_some_and(|point| point[0] >= self.end * (1.0 - STRAIGHT));
        let mut pieces: Vec<(f64, String)> = points.windows(2).map(|two| (two[1][0], piece(two[0], two[1]))).collect();
        if points[0][0] > 0.0 {
            pieces.insert(0, (points[0][0], format!("{:?}", points[0][1])));
        }
        if !reaches {
            pieces.push((self.end, format!("{last:?}")));
        }
        let Some((_, mut text)) = pieces.pop() else { return "0.0".to_owned() };
        for (until, piece) in pieces.into_iter().rev() {
            text = format!("({piece}) if t <= {until:?} else ({text})");
        }
        text
    }

    fn table(&mut self, points: &[[f64; 2]]) -> String {
        let mut rows: String = points.iter().map(|[time, value]| format!("{time:?},{value:?}\n")).collect();
        let beyond = points.last().filter(|point| point[0] < self.end);
        if let Some([time, value]) = beyond {
            // tables go on with their last slope: a row at the end of the run holds the value
            let next = time + 1e-9 * self.end;
            rows += &format!("{next:?},{value:?}\n{:?},{value:?}\n", self.end);
        }
        let known = self.files.iter().find(|(_, text)| *text == rows).map(|(name, _)| name.clone());
        let name = known.unwrap_or_else(|| {
            self.files.push((format!("history_{}.csv", self.files.len() + 1), rows));
            self.files[self.files.len() - 1].0.clone()
        });
        format!("{{\"name\": \"csv_table\", \"filename\": \"{name}\"}}")
    }
}

/// Points that change the slope.
fn straightened(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut out: Vec<[f64; 2]> = Vec::new();
    for (at, &point) in points.iter().enumerate() {
        if out.last().is_some_and(|last| last[0] == point[0]) {
            out.pop();
        }
        let is_on_line = match (out.last(), points.get(at + 1)) {
            (Some(&[t0, v0]), Some(&[t1, v1])) if t1 > t0 => {
                let on_line = v0 + (v1 - v0) * (point[0] - t0) / (t1 - t0);
                (on_line - point[1]).abs() <= STRAIGHT * (v0.abs() + v1.abs())
            }
            (Some(&[_, v0]), None) => v0 == point[1],
            _ => false,
        };
        if !is_on_line {
            out.push(point);
        }
    }
    out
}

/// The line through two points.
fn piece([t0, v0]: [f64; 2], [t1, v1]: [f64; 2]) -> String {
    let slope = (v1 - v0) / (t1 - t0);
    let sign = if slope < 0.0 { '-' } else { '+' };
    let run = if t0 == 0.0 { "t".to_owned() } else { format!("(t - {t0:?})") };
    match (slope == 0.0, v0 == 0.0) {
        (true, _) => format!("{v0:?}"),
        (_, true) => format!("{slope:?}*{run}"),
        _ => format!("{v0:?} {sign} {:?}*{run}", slope.abs()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_histories_are_functions_and_long_ones_tables() {
        let mut all = Histories::new(1.0);
        assert_eq!(all.value(&History::default()), "0.0");
        assert_eq!(all.value(&History::ramp(1.0, 4.0)), "\"4.0*t\"");
        let triangle = History::of(vec![[0.0, 0.0], [0.25, 1.0], [0.5, 2.0], [1.0, 0.0]]);
        assert_eq!(all.value(&triangle), "\"(4.0*t) if t <= 0.5 else (2.0 - 4.0*(t - 0.5))\"");
        assert_eq!(all.value(&History::ramp(0.5, 4.0)), "\"(8.0*t) if t <= 0.5 else (4.0)\"");
        let saw = History::of((0..20).map(|i| [0.04 * f64::from(i), f64::from(i % 2)]).collect());
        assert_eq!(all.value(&saw), "{\"name\": \"csv_table\", \"filename\": \"history_1.csv\"}");
        assert_eq!(all.value(&saw), "{\"name\": \"csv_table\", \"filename\": \"history_1.csv\"}");
        assert!(all.files[0].1.ends_with("1.0,1.0\n"), "{}", all.files[0].1);
    }
}
