//! Backward differences of order 1 to 5 for velocity and acceleration.
//!
//! v_{n+1} = Σ c_k u_{n+1−k}, a_{n+1} = Σ c_k v_{n+1−k}, k = 0 … order: the derivative at t_{n+1} of the polynomial through
//! the last values, for steps of any lengths. M a_{n+1} + C v_{n+1} + f_int(u_{n+1}) = f_ext. The first
//! steps, which have no such past, are of the order that theirs allows. Orders 1 and 2 are stable for every step; 3 to
//! 5 are not for motion without damping.

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use super::scheme::{Scheme, SchemeFactory, predict_ballistic};
use crate::assembly::{DofTable, Inertia};
use crate::diagnostics::{Result, unfit};
use crate::model::{FIRST, ModelPart, Rates, SECOND};
use crate::register;
use crate::strategies::SchemeEntry;

/// Order, damping, and the times the present weights refer to.
#[derive(Debug, Clone, PartialEq)]
pub struct BdfScheme {
    order: usize,
    rayleigh: [f64; 2],
    /// Ends of the last steps and the beginning of the first, ascending.
    ends: Vec<f64>,
    weights: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct BdfState {
    ends: Vec<f64>,
    weights: Vec<f64>,
}

stored_as_bytes!(BdfState);

#[typetag::serde(name = "bdf")]
impl State for BdfState {
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
}

/// Weights of the values at `times` in the derivative at `times[0]` of the polynomial through them.
fn weights(times: &[f64]) -> Vec<f64> {
    let t = times[0];
    let others = || times[1..].iter();
    let mut out = vec![others().map(|other| 1.0 / (t - other)).sum()];
    for (k, own) in times.iter().enumerate().skip(1) {
        let rest = || times.iter().enumerate().skip(1).filter(|(j, _)| *j != k).map(|(_, other)| *other);
        let above: f64 = rest().map(|other| t - other).product();
        let below: f64 = rest().map(|other| own - other).product();
        out.push(above / (below * (own - t)));
    }
    out
}

impl BdfScheme {
    /// The scheme of an order from 1 to 5.
    pub fn new(order: usize, rayleigh: [f64; 2]) -> Self {
        Self { order, rayleigh, ends: Vec::new(), weights: Vec::new() }
    }
}

impl Scheme for BdfScheme {
    fn takes_first_order(&self) -> bool {
        true
    }

    fn prepare(&self, part: &mut ModelPart) {
        Rates::add(&mut part.nodes.history, &[FIRST, SECOND]);
        let levels = part.nodes.history.levels().max(self.order + 1);
        part.set_levels(levels);
    }

    fn predict(&mut self, part: &mut ModelPart, dofs: &DofTable) -> Result<()> {
        let (time, dt) = (part.info.time, part.info.delta_time);
        let now = time - dt;
        // An attempt that failed left an end after the present time.
        self.ends.retain(|end| *end <= now + 1e-6 * dt);
        if self.ends.is_empty() {
            self.ends.push(now);
        }
        let past = self.ends.len().saturating_sub(self.order);
        self.ends.drain(..past);
        let times: Vec<f64> = std::iter::once(time).chain(self.ends.iter().rev().copied()).collect();
        self.weights = weights(&times);
        self.ends.push(time);
        predict_ballistic(part, dofs);
        Ok(())
    }

    fn update(&self, part: &mut ModelPart) {
        let history = &mut part.nodes.history;
        for (rates, _) in Rates::within(history) {
            let seconds = rates.second.map(|second| (rates.first, second));
            for (from, to) in [Some((rates.unknown, rates.first)), seconds].into_iter().flatten() {
                let mut rate = vec![0.0; history.level(from, 0).len()];
                for (level, weight) in self.weights.iter().enumerate() {
                    rate.iter_mut().zip(history.level(from, level)).for_each(|(sum, value)| *sum += weight * value);
                }
                history.write_level(to, 0, &rate);
            }
        }
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(BdfState { ends: self.ends.clone(), weights: self.weights.clone() }))
    }

    fn resume(&mut self, state: Box<dyn State>) -> Result<()> {
        let BdfState { ends, weights } = state.take()?;
        if ends.len() != weights.len() || ends.len() > self.order + 1 {
            return Err(unfit("the scheme does not remember its last steps"));
        }
        (self.ends, self.weights) = (ends, weights);
        Ok(())
    }

    fn inertia(&self, part: &ModelPart, dofs: &DofTable) -> Option<Inertia> {
        let present = |column| dofs.column(part, column, 0);
        Some(Inertia {
            mass_factor: self.weights[0].powi(2),
            damping_factor: self.weights[0],
            alpha: self.rayleigh[0],
            beta: self.rayleigh[1],
            acceleration: present(SECOND),
            velocity: present(FIRST),
            carried: Vec::new(),
        })
    }
}

macro_rules! register_bdf {
    ($name:literal, $aliases:expr, $order:literal, $about:literal) => {
        register! { SchemeEntry $name,
            aliases: $aliases,
            about: $about,
            source: "v_{n+1} = Σ c_k u_{n+1−k}; Curtiss and Hirschfelder (1952)",
            build: SchemeFactory::Implicit(|request| Ok(Box::new(BdfScheme::new($order, request.rayleigh()?)))),
        }
    };
}

register_bdf!("bdf1", &["backward_euler"], 1, "backward differences of first order: the implicit Euler scheme");
register_bdf!("bdf2", &[], 2, "backward differences of second order, stable for every step");
register_bdf!("bdf3", &[], 3, "backward differences of third order");
register_bdf!("bdf4", &[], 4, "backward differences of fourth order");
register_bdf!("bdf5", &[], 5, "backward differences of fifth order");

#[cfg(test)]
mod tests {
    use super::weights;

    #[test]
    fn weights_differentiate_polynomials_of_their_degree() {
        let times = [1.7, 1.3, 1.2, 0.8, 0.1, -0.2];
        for order in 1..=5 {
            let c = weights(&times[..=order]);
            for degree in 0..=order as i32 {
                let sum: f64 = c.iter().zip(times).map(|(c, t)| c * t.powi(degree)).sum();
                let exact = f64::from(degree) * times[0].powi(degree - 1);
                assert!((sum - exact).abs() < 1e-10, "order {order}, degree {degree}: {sum} {exact}");
            }
        }
    }

    #[test]
    fn equal_steps_give_the_usual_weights() {
        let c = weights(&[0.3, 0.2, 0.1]);
        for (c, usual) in c.iter().zip([15.0, -20.0, 5.0]) {
            assert!((c - usual).abs() < 1e-12);
        }
    }
}
