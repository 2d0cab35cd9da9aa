//! Central differences, explicit in time with a diagonal mass.
//!
//! a_n = M⁻¹ (f_ext(t_{n+1}) − f_int(u_n) − C v_{n−1}), v_n = v_{n−½} + Δt_n/2 a_n, v_{n+½} = v_n + Δt_{n+1}/2 a_n,
//! u_{n+1} = u_n + Δt_{n+1} v_{n+½}. In the first step v_n is the initial velocity. VELOCITY and ACCELERATION are those of
//! t_n, one step behind DISPLACEMENT. Stable while Δt < 2/ω of the highest frequency ω.

use super::scheme::{SchemeEntry, SchemeFactory};
use crate::assembly::DofTable;
use crate::model::variables::{ACCELERATION, DISPLACEMENT, MIDDLE_VELOCITY, VELOCITY};
use crate::model::{Fields, ModelPart};
use crate::register;

/// The update of central differences, and the half step it carries over.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CentralDifferences {
    /// Time from the middle of the last step to its end; 0 before the first.
    half_before: f64,
    begun: bool,
}

impl CentralDifferences {
    /// Variables with history it needs on the nodes.
    pub fn prepare(&self, part: &mut ModelPart) {
        for variable in [&VELOCITY, &ACCELERATION, &MIDDLE_VELOCITY] {
            part.nodes.history.add(variable);
        }
    }

    /// Moves the unknowns by a step of `delta_time` under `acceleration` (one number an unknown).
    ///
    /// Unknowns for which `target` gives a value go there; their rates follow the motion.
    pub fn advance(
        &mut self,
        fields: &mut Fields,
        dofs: &DofTable,
        acceleration: &[f64],
        delta_time: f64,
        target: impl Fn(usize) -> Option<f64>,
    ) {
        if !self.begun {
            let initial = fields.values(&VELOCITY, 0).to_vec();
            fields.values_mut(&MIDDLE_VELOCITY, 0).copy_from_slice(&initial);
            self.begun = true;
        }
        let half = 0.5 * delta_time;
        let at = |number: usize| {
            let dof = &dofs.dofs()[number];
            3 * dof.node as usize + dof.variable.offset()
        };
        let numbers = || (0..dofs.len()).filter(|&n| dofs.dofs()[n].variable.column == DISPLACEMENT.name());
        let before = fields.values(&MIDDLE_VELOCITY, 0).to_vec();
        let u = fields.values_mut(&DISPLACEMENT, 0);
        let mut rates = vec![[0.0; 3]; dofs.len()];
        for n in numbers() {
            let middle = before[at(n)];
            rates[n] = match target(n) {
                Some(value) => {
                    let next = (value - u[at(n)]) / delta_time;
                    u[at(n)] = value;
                    let acceleration = (next - middle) / (self.half_before + half);
                    [acceleration, middle + self.half_before * acceleration, next]
                }
                None => {
                    let velocity = middle + self.half_before * acceleration[n];
                    let next = velocity + half * acceleration[n];
                    u[at(n)] += delta_time * next;
                    [acceleration[n], velocity, next]
                }
            };
        }
        for (k, variable) in [&ACCELERATION, &VELOCITY, &MIDDLE_VELOCITY].into_iter().enumerate() {
            let column = fields.values_mut(variable, 0);
            numbers().for_each(|n| column[at(n)] = rates[n][k]);
        }
        self.half_before = half;
    }
}

register! { SchemeEntry "central_differences",
    about: "explicit central differences with a lumped mass, for \"time_integration_method\": \"explicit\"",
    build: SchemeFactory::Explicit(|_| Ok(CentralDifferences::default())),
}
