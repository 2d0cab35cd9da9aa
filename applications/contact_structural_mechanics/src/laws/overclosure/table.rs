//! Overclosure by a table, linear between its rows and beyond the last.

use zelus_core::Result;
use zelus_core::parameters::Settings;
use zelus_core::register;

use crate::law::{Overclosure, OverclosureLaw, OverclosureLawEntry};

struct Table {
    /// Depth and pressure, both growing from row to row; the first without pressure.
    rows: Vec<[f64; 2]>,
}

impl OverclosureLaw for Table {
    fn overclosure(&self, pressure: f64) -> Overclosure {
        let above = self.rows.partition_point(|[_, own]| *own <= pressure).clamp(1, self.rows.len() - 1);
        let ([depth, from], [next, to]) = (self.rows[above - 1], self.rows[above]);
        let compliance = (next - depth) / (to - from);
        Overclosure { depth: depth + (pressure - from) * compliance, compliance }
    }
}

fn build(settings: &Settings) -> Result<Box<dyn OverclosureLaw>> {
    let mut rows = Vec::new();
    for row in settings.items("rows")? {
        rows.push(row.parse::<[f64; 2]>("rows")?);
    }
    let grows = rows.windows(2).all(|pair| (0..2).all(|c| pair[1][c] > pair[0][c]));
    if rows.len() < 2 || !grows || rows[0][1] != 0.0 || rows[0][0] > 0.0 {
        let fact = "\"rows\" must be overclosure and pressure, growing from row to row, from pressure 0 at an overclosure of 0 or less";
        let remedy = "write e.g. [[0.0, 0.0], [0.001, 10.0], [0.002, 50.0]]";
        return Err(settings.error("rows", "invalid-value", fact).remedy(remedy).into());
    }
    Ok(Box::new(Table { rows }))
}

register! { OverclosureLawEntry "table",
    about: "pressure by a table over the overclosure",
    source: "p = p(−g), linear between rows",
    defaults: include_str!("../../../../../configs/overclosure_laws/table.json"),
    build: build,
}
