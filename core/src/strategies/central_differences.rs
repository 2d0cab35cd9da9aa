//! Central differences, explicit in time with a diagonal mass.
//!
//! a_n = M⁻¹ (f_ext(t_{n+1}) − f_int(u_n) − C v_{n−1}), v_n = v_{n−½} + Δt_n/2 a_n, v_{n+½} = v_n + Δt_{n+1}/2 a_n,
//! u_{n+1} = u_n + Δt_{n+1} v_{n+½}. In the first step v_n is the initial velocity. The columns of v and a are those of
//! t_n, one step behind that of u. Stable while Δt < 2/ω of the highest frequency ω.

use serde::{Deserialize, Serialize};

use crate::assembly::{DofTable, impose_constraints};
use crate::model::{ColumnOf, FIRST, ModelPart, Rates, SECOND, UNKNOWN};

/// The first derivative half a step later.
const MIDDLE: ColumnOf = |rates| rates.middle;

/// The update of central differences, and the half step it carries over.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct CentralDifferences {
    /// Time from the middle of the last step to its end; 0 before the first.
    half_before: f64,
    begun: bool,
}

impl CentralDifferences {
    /// Variables with history it needs on the nodes.
    pub fn prepare(&self, part: &mut ModelPart) {
        Rates::add(&mut part.nodes.history, &[FIRST, SECOND, MIDDLE]);
    }

    /// Time from the middle of the last step to its end; `None` before the first.
    pub fn half_before(&self) -> Option<f64> {
        self.begun.then_some(self.half_before)
    }

    /// Moves the unknowns by the step under `acceleration` (one number an unknown).
    ///
    /// Unknowns for which `target` gives a value go there, and those that a constraint `follows` go with their masters; their rates
    /// follow the motion.
    pub fn advance(
        &mut self,
        part: &mut ModelPart,
        dofs: &DofTable,
        acceleration: &[f64],
        target: impl Fn(usize) -> Option<f64>,
        follows: impl Fn(usize) -> bool,
    ) {
        let delta_time = part.info.delta_time;
        if !self.begun {
            let fields = &mut part.nodes.history;
            for (rates, _) in Rates::within(fields) {
                let initial = fields.level(rates.first, 0).to_vec();
                rates.middle.into_iter().for_each(|middle| fields.write_level(middle, 0, &initial));
            }
            self.begun = true;
        }
        let half = 0.5 * delta_time;
        let before = dofs.column(part, MIDDLE, 0);
        let start = dofs.column(part, UNKNOWN, 0);
        let mut u = start.clone();
        let mut rates = [FIRST, SECOND, MIDDLE].map(|_| vec![0.0; dofs.len()]);
        // Of a motion to a value.
        let rates_to = |n: usize, value: f64| {
            let (middle, next) = (before[n], (value - start[n]) / delta_time);
            let acceleration = (next - middle) / (self.half_before + half);
            [middle + self.half_before * acceleration, acceleration, next]
        };
        for n in 0..dofs.len() {
            let new = match target(n) {
                Some(value) => {
                    u[n] = value;
                    rates_to(n, value)
                }
                None => {
                    let velocity = before[n] + self.half_before * acceleration[n];
                    let next = velocity + half * acceleration[n];
                    u[n] += delta_time * next;
                    [velocity, acceleration[n], next]
                }
            };
            rates.iter_mut().zip(new).for_each(|(column, value)| column[n] = value);
        }
        dofs.write_column(part, UNKNOWN, 0, &u);
        if !part.constraints.is_empty() {
            impose_constraints(part);
            let followed = dofs.column(part, UNKNOWN, 0);
            for n in (0..dofs.len()).filter(|&n| follows(n)) {
                rates.iter_mut().zip(rates_to(n, followed[n])).for_each(|(column, value)| column[n] = value);
            }
        }
        for (column, values) in [FIRST, SECOND, MIDDLE].into_iter().zip(&rates) {
            dofs.write_column(part, column, 0, values);
        }
        self.half_before = half;
    }
}
