//! Axes in which the functions of a process are written.

use serde::Deserialize;

use crate::diagnostics::{Diagnostic, Result};
use crate::parameters::{Settings, SpaceTime};
use crate::vector3::{dot, sub};

/// An origin and three axes; x_local = A (x − origin) with the axes as rows of A.
///
/// Only positions are mapped, current and initial ones; results are not rotated back.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LocalAxes {
    /// Point with local position zero.
    pub origin: [f64; 3],
    /// The axes, one a row; they are used as they are given.
    pub axes: [[f64; 3]; 3],
}

impl LocalAxes {
    /// Reads `"local_axes"`; `None` when it is empty.
    ///
    /// # Errors
    /// `invalid-local-axes` unless it has an origin and three axes.
    pub fn from_settings(settings: &Settings) -> Result<Option<Self>> {
        let node = settings.get("local_axes")?;
        if node.object()?.is_empty() {
            return Ok(None);
        }
        node.parse("local_axes").map(Some).map_err(|e| {
            let place = settings.key_place("local_axes");
            let remedy = "write {\"origin\": [0, 0, 0], \"axes\": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}";
            let fact = format!("local axes need \"origin\" and \"axes\" and nothing else ({})", plain(&e));
            Diagnostic::error("invalid-local-axes", fact).at(place).remedy(remedy).into()
        })
    }

    /// The same place and time in these axes.
    pub fn map(&self, at: &SpaceTime) -> SpaceTime {
        let local = |x: [f64; 3]| self.axes.map(|axis| dot(axis, sub(x, self.origin)));
        SpaceTime { current: local(at.current), initial: local(at.initial), time: at.time }
    }
}

fn plain(error: &crate::Error) -> String {
    match error {
        crate::Error::Input(problems) => problems.iter().map(|d| d.fact.as_str()).collect::<Vec<_>>().join("; "),
        other => other.to_string(),
    }
}
