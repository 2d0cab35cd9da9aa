//! Laws of friction: how large the tangential traction of a node in contact may become.
//!
//! A law is a function of the numbers that materials give at a node, and of how the node slides. The laws are in `laws/friction`, one a file.

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::{Nodes, Variable};
use zelus_core::registered_kind;
use zelus_core::registry;
use zelus_core::scalar::Real;

/// Coefficients below this count as none.
const NOTHING: f64 = f64::EPSILON;

/// Limit c − μ p of a node's tangential traction (force per area).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Bound {
    /// μ ≥ 0: the part that grows with the pressure.
    pub coefficient: f64,
    /// c ≥ 0: the part that does not (force per area).
    pub threshold: f64,
}

impl Bound {
    /// The limit under a normal pressure, which is negative in compression.
    #[inline]
    pub fn at<T: Real>(self, pressure: T) -> T {
        pressure * -self.coefficient + self.threshold
    }

    /// Whether there is no friction at all.
    pub fn is_smooth(self) -> bool {
        self.coefficient < NOTHING && self.threshold <= 0.0
    }
}

registered_kind! {
    /// A friction law, by the name of `frictional_law`.
    pub struct FrictionLawEntry("friction_law", "unknown-name") {
        build: FrictionLaw;
    }
}

/// How a node in contact slides, and its temperature.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sliding {
    /// Normal pressure, 0 or negative (force per area).
    pub pressure: f64,
    /// Slip of the step over its time (length per time).
    pub speed: f64,
    /// Temperature of contact: the mean of both surfaces; 0 where the law does not ask for it.
    pub temperature: f64,
}

/// Most numbers of a law.
const MOST_NUMBERS: usize = 4;

/// A law of friction.
pub struct FrictionLaw {
    /// Strengths at a node, from 0, read from properties or nodes under these names: friction doubles where all of them do, and without
    /// the first there is none.
    pub strengths: &'static [&'static Variable<f64>],
    /// Further numbers, from 0, read in the same way.
    pub constants: &'static [&'static Variable<f64>],
    /// Temperatures, of any sign, read in the same way: a law with any depends on the temperature of contact.
    pub temperatures: &'static [&'static Variable<f64>],
    /// Whether these numbers fit together; why they do not.
    pub check: fn(&[f64]) -> Result<(), &'static str>,
    /// The bound by these numbers, strengths first, temperatures last, and by how the node slides: a tangent at its pressure.
    pub bound: fn(&[f64], Sliding) -> Bound,
    /// Whether the bound is more than a number times the pressure, or changes with the speed or the temperature.
    pub depends_on_sliding: bool,
    /// Whether `friction_coefficients` of the process stands in for the first number where properties say nothing.
    pub by_coefficients: bool,
}

impl FrictionLaw {
    /// The first strength.
    pub fn variable(&self) -> &'static Variable<f64> {
        self.strengths[0]
    }

    /// Whether the bound depends on the temperature of contact.
    pub fn depends_on_temperature(&self) -> bool {
        !self.temperatures.is_empty()
    }

    /// All its numbers, strengths first, temperatures last.
    pub fn variables(&self) -> impl Iterator<Item = &'static Variable<f64>> {
        self.strengths.iter().chain(self.constants).chain(self.temperatures).copied()
    }

    /// The bound at a node whose numbers are written.
    pub fn bound_at(&self, nodes: &Nodes, at: usize, sliding: Sliding) -> Bound {
        let (numbers, count) = self.numbers_at(nodes, at);
        (self.bound)(&numbers[..count], sliding)
    }

    /// Whether the numbers that are written at a node fit together; why they do not.
    ///
    /// # Errors
    /// The reason.
    pub fn check_at(&self, nodes: &Nodes, at: usize) -> Result<(), &'static str> {
        let (numbers, count) = self.numbers_at(nodes, at);
        (self.check)(&numbers[..count])
    }

    /// The numbers that are written at a node, and how many.
    fn numbers_at(&self, nodes: &Nodes, at: usize) -> ([f64; MOST_NUMBERS], usize) {
        let (mut numbers, mut count) = ([0.0; MOST_NUMBERS], 0);
        for (number, variable) in numbers.iter_mut().zip(self.variables()) {
            *number = nodes.values.values(variable, 0).get(at).copied().unwrap_or(0.0);
            count += 1;
        }
        (numbers, count)
    }
}

impl std::fmt::Debug for FrictionLaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "friction law by {}", self.variable().name())
    }
}

impl PartialEq for FrictionLaw {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

/// The law of a `frictional_law`.
///
/// # Errors
/// A name that no law has.
pub fn find_friction_law(name: &str) -> Result<&'static FrictionLaw, Diagnostic> {
    registry::require::<FrictionLawEntry>(name).map(|entry| &entry.build)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_laws_are_refused_with_a_suggestion() {
        let Err(error) = find_friction_law("Coulom") else { panic!("there is no such law") };
        let error = error.to_string();
        assert!(error.contains("Coulom") && error.contains("\"Coulomb\""), "{error}");
        assert!(find_friction_law("Tresca").is_ok());
    }
}
